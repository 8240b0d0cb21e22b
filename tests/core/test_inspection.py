"""The scene check: planted faults are found and named with their faces; clean scenes stay without a word."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from builders import UNIFORM, prepare_coarse
from planted_faults import FAULTS, GLASS, GREY, moved, rectangle, room, solid, turned

import luzespecular as luz
from luzespecular import looks

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("fault", list(FAULTS))
def test_a_planted_fault_is_found(fault):
    make, kind, concerned = FAULTS[fault]
    findings = luz.check(make())
    found = [f for f in findings if f.kind == kind and set(concerned) <= {f.surface, *f.others}]
    assert found, [str(f) for f in findings]
    for name, faces in concerned.items():
        listed = found[0].faces if found[0].surface == name else found[0].others[name]
        assert faces is None or listed.tolist() == faces, name
        assert f"'{name}'" in str(found[0]) or len(found[0].others) > 1
    for finding in findings:
        assert finding.severity == ("error" if kind.startswith("endless") or kind == "empty" else "warning") or (
            finding.kind != kind
        )
        assert finding.message and finding.remedy and str(finding) == f"{finding.message}; {finding.remedy}"


def example(name):
    path = ROOT / name
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def clean_scenes():
    shelf = example("examples/light_shelf/room.py")
    for variant in shelf.VARIANTS:
        yield f"light shelf {variant}", shelf.scene(variant)
    pipe = example("examples/mirror_light_pipe.py")
    for ratio in (1, 2, 4):
        yield f"pipe {ratio}", pipe.pipe(ratio * pipe.WIDTH)
    glazed = example("examples/glazed_window.py")
    yield "open window", glazed.room(False)
    yield "glazed window", glazed.room(True)
    yield "factors", example("examples/daylight_factor_grid.py").room()
    scenes = example("benchmarks/scenes.py")
    for name in scenes.NAMES:
        if name != "white_box":  # of reflectance 0.99, which is told
            yield name, scenes.load(name).solver_scene()


def test_clean_scenes_have_no_findings():
    told = {name: [str(f) for f in luz.check(scene)] for name, scene in clean_scenes()}
    assert len(told) > 15
    assert not {name: found for name, found in told.items() if found}


def test_what_is_drawn_well_is_not_blamed():
    scene = room()
    for name, (origin, size) in {
        "neighbour": ([-5, 20, 0], [12, 8, 15]),
        "table": ([1, 1, 0.7], [1.2, 0.8, 0.03]),
        "leg": ([1.2, 1.2, 0], [0.05, 0.05, 0.72]),
        "bookcase": ([3.7, 0.0, 0.0], [0.3, 1, 2]),
    }.items():
        vertices, faces = solid(origin, size)
        scene.add(name, vertices, GREY, faces=faces)
    scene.add("sheet", rectangle((0, 1), (2, 3), 1.0), GREY)
    scene.add("sheet from below", rectangle((0, 1), (2, 3), 1.0)[::-1], GREY)
    scene.add("poster", [[1e-3, 1, 1], [1e-3, 2, 1], [1e-3, 2, 2], [1e-3, 1, 2]], GREY)
    scene.add("curtain", [[2, 2.9, 0.5], [3, 2.9, 0.5], [3, 2.9, 2], [2, 2.9, 2]], GREY, two_sided=True)
    assert [str(f) for f in luz.check(scene)] == []


def test_panes_drawn_well_are_not_blamed():
    """Double glazing, of two surfaces or in one; a showcase of glass; a pane that stands on a wall's edge."""
    sheet = np.array([[0, 3, 0], [4, 3, 0], [4, 3, 2.5], [0, 3, 2.5]])
    for panes in ({"one": sheet, "two": np.add(sheet, [0, 0.02, 0])}, {"one": sheet}):
        assert not luz.check(room(panes, **dict.fromkeys(panes, GLASS)))
    scene = room()
    scene.add(
        "panes", np.concatenate([sheet, np.add(sheet[::-1], [0, 0.02, 0])]), GLASS, faces=[[0, 1, 2, 3], [4, 5, 6, 7]]
    )
    vertices, faces = solid([1, 1, 0.5], [0.6, 0.6, 0.4])
    scene.add("showcase", vertices, GLASS, faces=faces)
    assert not luz.check(scene)


def test_a_window_without_a_hole_is_told_what_to_do():
    """Whichever way the pane looks."""
    for turn in (1, -1):
        pane = np.array([[1, 0, 1], [2, 0, 1], [2, 0, 2], [1, 0, 2]], float)[::turn]
        (finding,) = luz.check(room({"pane": pane}, pane=GLASS))
        assert finding.remedy == "cut an opening for 'pane' into 'south', or move them apart"


def test_how_wide_a_gap_is():
    (finding,) = (f for f in luz.check(room(moved("ceiling", (0, 0, 5e-3)))) if "'west'" in f.message)
    assert "5 mm wide and 3 m long" in finding.message
    covered = room(
        {
            **moved("west", (0, 0, 5e-3)),
            "skirting": np.array([[0.01, 0, 0], [0.01, 3, 0], [0.01, 3, 0.1], [0.01, 0, 0.1]]),
        }
    )
    assert not [f for f in luz.check(covered) if f.kind == "gap" and "floor" in (f.surface, *f.others)]


def small_solids(count, turned):
    """A mesh of cubes, none in another's planes, in a room."""
    corners, faces = [], []
    for k in range(count):
        place = [0.05 + 0.32 * (k % 12) + 0.001 * k, 0.05 + 0.3 * (k // 12) + 0.0013 * k, 0.5 + 0.0017 * k]
        own, sides = solid(place, 0.2, turn=k in turned)
        faces += [[corner + 8 * k for corner in side] for side in sides]
        corners.append(own)
    scene = room()
    scene.add("cubes", np.concatenate(corners), GREY, faces=faces)
    return scene


def test_many_small_solids_are_all_looked_at():
    (finding,) = (f for f in luz.check(small_solids(60, (3, 57))) if f.kind == "inverted normals")
    assert set(finding.faces.tolist()) >= {*range(18, 24), *range(342, 348)} - {18, 342}
    assert "were looked at" not in finding.message
    assert not luz.check(small_solids(60, ()))


def test_where_not_all_is_looked_at_it_says_so(monkeypatch):
    monkeypatch.setattr(looks, "_OF_ONE_SURFACE", 10)
    (finding,) = (f for f in luz.check(small_solids(4, range(4))) if f.kind == "inverted normals")
    assert "of its 24 planes the 10 largest were looked at" in finding.message


@pytest.mark.parametrize("scale", [1e-2, 1.0, 20.0])
@pytest.mark.parametrize("shift", [0.0, 1e5])
def test_what_is_found_depends_on_neither_scale_nor_place(scale, shift):
    for fault in ("a wall turned over", "a wall 1 mm above the floor", "a carpet in the floor's plane", "no window"):
        make, kind, _ = FAULTS[fault]
        scene = luz.Scene()
        for surface in make().surfaces.values():
            scene.add(surface.name, surface.pieces[0] * scale + shift, surface.material)
        assert [f.kind for f in luz.check(scene) if f.kind != "unit"] == [f.kind for f in luz.check(make())]
        assert kind in {f.kind for f in luz.check(scene)}


def test_warnings_go_with_the_result_and_errors_stop(caplog):
    scene = room(turned("west"))
    notes = prepare_coarse(scene, elements=40, bands=8).solve(UNIFORM).notes
    assert notes == tuple(str(f) for f in luz.check(scene)) and "'west' has its back to" in notes[0]
    assert notes[0] in caplog.text
    with pytest.raises(luz.SceneError, match="mirrored without end"):
        luz.prepare(FAULTS["a closed box of perfect mirrors"][0]())


def test_what_is_no_scene():
    with pytest.raises(luz.SceneError, match="check needs a luzespecular"):
        luz.check([])


def test_a_mesh_that_random_trials_found():
    """Looks along an axis that meet nothing, while others are mirrored on."""
    vertices = [[-1, 2, 1], [1, -1, 0], [0, 0, 1], [2, -1, -2], [0, 1, -2], [-1, -1, 1], [2, 0, 0]]
    faces = [[0, 4, 3], [0, 2, 3, 3, 1], [0, 5, 0, 6, 5], [2, 5, 3, 4, 3, 3], [3, 3, 0, 3, 6], [0, 5, 3, 1, 3, 2]]
    scene = luz.Scene()
    scene.add("mesh", vertices, luz.Material(diffuse_reflectance=0.5, specular_reflectance=0.4), faces=faces)
    with np.errstate(all="raise"):
        assert "not flat" in {finding.kind for finding in luz.check(scene)}
