"""Scene files: what they hold, what is refused and how it is named; files appear only when complete."""

import copy
import csv
import json
from pathlib import Path

import numpy as np
import pytest

import luzespecular as luz
from luzespecular import files

FLOOR = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
SOUND = {
    "materials": {"white": {"diffuse_reflectance": 0.6}, "glass": {"regular_transmittance": 0.8}},
    "surfaces": [
        {"name": "chão", "vertices": FLOOR, "material": "white"},
        {
            "name": "fold",
            "vertices": [*FLOOR, [0, 0, 1]],
            "faces": [[0, 1, 2, 3], [0, 1, 4]],
            "two_sided": True,
            "material": "glass",
        },
    ],
    "points": [{"name": "desk", "positions": [[0.5, 0.5, 0.1], [0.6, 0.5, 0.1]], "normal": [0, 0, 2]}],
}


def saved(tmp_path, content, encoding="utf-8"):
    path = tmp_path / "scene.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content, ensure_ascii=False), encoding)
    return path


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_a_scene_file_is_read(tmp_path, encoding):
    given = files.read_scene(saved(tmp_path, SOUND, encoding))
    floor, fold = given.scene.surfaces["chão"], given.scene.surfaces["fold"]
    assert floor.material == luz.Material(diffuse_reflectance=0.6) and not floor.two_sided
    assert fold.material.regular_transmittance == 0.8 and fold.two_sided
    assert fold.source_faces.tolist() in ([0, 1], [1, 0])
    np.testing.assert_array_equal(given.points["desk"].positions, SOUND["points"][0]["positions"])
    np.testing.assert_array_equal(given.points["desk"].normals, [[0, 0, 2], [0, 0, 2]])


def changed(place, value):
    content = copy.deepcopy(SOUND)
    *way, last = place
    entry = content
    for step in way:
        entry = entry[step]
    if value is None:
        del entry[last]
    else:
        entry[last] = value
    return content


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (["surfaces"], None, "The file has no 'surfaces'; add it"),
        (["surfaces"], {}, "'surfaces' must be a list"),
        (["surfaces", 0], "floor", "Entry 0 of 'surfaces' must be an object"),
        (["surfaces", 0, "name"], None, "Entry 0 of 'surfaces' has no 'name'"),
        (["surfaces", 0, "name"], ["a"], "Entry 0 of 'surfaces': name must be a text"),
        (["surfaces", 0, "name"], "fold", "Surface 'fold' is in the scene already"),
        (["surfaces", 0, "material"], "wood", "Surface 'chão': there is no material 'wood'.*'white', 'glass'"),
        (["surfaces", 0, "material"], {"a": 1}, "Surface 'chão': there is no material"),
        (["surfaces", 0, "vertices", 2], [1, 1, 0.5], "Surface 'chão' is not flat"),
        (["surfaces", 0, "vertices", 2], [1, 1, "up"], "Surface 'chão': vertices must be an"),
        (["surfaces", 0, "vertices", 2], [1, 1, 10**400], "vertices must be an"),
        (["surfaces", 0, "vertices", 2], [1, 1, float("nan")], "Surface 'chão': vertex 2 is"),
        (["surfaces", 0, "twosided"], True, "unknown entry 'twosided'; known are: faces, material, name, two_sided"),
        (["surfaces", 1, "two_sided"], "no", "Surface 'fold': two_sided must be true or false"),
        (["surfaces", 1, "faces"], [[0, 1, 9]], "Surface 'fold': face 0 names a vertex outside"),
        (["surfaces", 1, "faces"], [[0, 1, 2.5]], "Surface 'fold': faces must hold whole numbers"),
        (["materials", "white"], 0.6, "Material 'white' must be an object"),
        (["materials", "white", "reflectance"], 0.6, "Material 'white' has an unknown entry 'reflectance'"),
        (["materials", "white", "specular_reflectance"], 0.6, r"Material 'white': diffuse_reflectance \+ .* = 1\.2"),
        (["materials"], [], "'materials' must be an object"),
        (["points", 0, "positions"], [[0, 0]], "Point 'desk': positions must be rows of three finite numbers"),
        (["points", 0, "positions"], [0, 0, 1], "Point 'desk': positions must be rows"),
        (["points", 0, "normal"], [0, 0, 0], "Point 'desk': normal has no length"),
        (["points", 0, "normal"], "up", "Point 'desk': normal must be rows"),
        (["points"], SOUND["points"] * 2, "Point 'desk' is there already"),
        (["sensors"], [], "The file has an unknown entry 'sensors'"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, place, value, message):
    with pytest.raises(luz.SceneError, match=message) as caught:
        files.read_scene(saved(tmp_path, changed(place, value)))
    assert "scene.json" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no JSON file"),
        ("{'surfaces': []}", "no JSON file"),
        ("[" * 100_000, "no JSON file"),
        ("[1]", "The file must be an object"),
        ('{"surfaces": [], "materials": {"a": {}, "a": {}}}', "'a' is there twice"),
        ('{"surfaces": [], "materials": {"a": {"exitance": 1' + "0" * 400 + "}}}", "no JSON file|number"),
    ],
)
def test_what_is_no_scene_file(tmp_path, text, message):
    with pytest.raises(luz.SceneError, match=message):
        files.read_scene(saved(tmp_path, text))


def test_a_file_that_is_no_text(tmp_path):
    (tmp_path / "scene.json").write_bytes(b"\xff\xfe\x00{")
    with pytest.raises(luz.SceneError, match="no JSON file in UTF-8"):
        files.read_scene(tmp_path / "scene.json")


def test_nothing_half_written(tmp_path):
    def rows():
        yield ["floor", 1.0]
        raise RuntimeError("on the way")

    old = files.write_csv(tmp_path / "table.csv", ["surface", "lux"], [["floor", float("nan")]])
    with pytest.raises(RuntimeError):
        files.write_csv(tmp_path / "table.csv", ["surface", "lux"], rows())
    with pytest.raises(TypeError):
        files.write_json(tmp_path / "new.json", {"lux": object()})
    assert [path.name for path in tmp_path.iterdir()] == ["table.csv"]
    with old.open(encoding="utf-8-sig", newline="") as file:
        assert list(csv.reader(file)) == [["surface", "lux"], ["floor", ""]]


def test_json_has_null_for_what_was_not_computed(tmp_path):
    path = files.write_json(tmp_path / "a.json", {"lux": [1.5, float("nan")]})
    assert json.loads(path.read_text("utf-8")) == {"lux": [1.5, None]}


@pytest.mark.parametrize("guide", ["user-guide.md", "guia-do-usuario.md"])
def test_the_guides_show_a_sound_scene(tmp_path, guide):
    text = (Path(__file__).resolve().parents[2] / "docs" / guide).read_text("utf-8")
    given = files.read_scene(saved(tmp_path, text.split("```json\n")[1].split("```")[0]))
    assert list(given.scene.surfaces) == ["floor", "shelf"] and list(given.points) == ["desks"]
