"""The headless command: what it writes, says and returns, inside Blender and through its Python module."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def saved(bpy, make, tmp_path):
    """A small scene saved under a name with spaces and accents."""
    make.square("Chão", material=make.material("Piso", diffuse_reflectance=0.4))
    make.square("Laje", height=2.0)
    make.quick()
    path = tmp_path / "Área de Trabalho" / "casa à luz.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_solves_hours_and_writes_tables_and_files(addon, bpy, saved, tmp_path, capfd):
    out = tmp_path / "meus resultados"
    before = saved.read_bytes()
    status = addon.commands.main(
        ["solve", "--hours", "9,12:30", "--date", "2026-12-21", "--time", "clock", "--out", str(out)]
    )
    assert status == 0
    assert {path.name for path in out.iterdir()} == {
        "casa à luz_surfaces.csv",
        "casa à luz_2026-12-21_09h00_faces.csv",
        "casa à luz_2026-12-21_09h00.blend",
        "casa à luz_2026-12-21_12h30_faces.csv",
        "casa à luz_2026-12-21_12h30.blend",
    }
    assert saved.read_bytes() == before
    assert Path(bpy.data.filepath) == saved
    rows = table(out / "casa à luz_surfaces.csv")
    assert {(row["moment"], row["surface"], row["side"]) for row in rows} == {
        (moment, name, side)
        for moment in ("2026-12-21 09:00", "2026-12-21 12:30")
        for name in ("Chão", "Laje")
        for side in ("front", "back")
    }
    top = next(row for row in rows if (row["surface"], row["side"]) == ("Laje", "front"))
    assert float(top["mean_lx"]) == pytest.approx(10_000.0, rel=1e-3)
    faces = table(out / "casa à luz_2026-12-21_12h30_faces.csv")
    assert len(faces) == 8
    assert {"x_m", "normal_z", "area_m2", "illuminance_lx", "initial_lx", "sky_direct_lx"} <= set(faces[0])
    said = capfd.readouterr()
    assert "Chão" in said.out
    assert "%" in said.err


def test_the_copy_holds_the_results(addon, bpy, saved, tmp_path):
    assert addon.commands.main(["solve", "--hours", "9", "--out", str(tmp_path / "out"), "--no-faces"]) == 0
    (copy,) = (tmp_path / "out").glob("*.blend")
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    assert "illuminance" in bpy.data.objects["Chão"].data.attributes
    assert addon.results_object.find(bpy.context.scene) is not None
    assert bpy.context.scene.luzespecular.site.hour == 9.0


def test_json_holds_all_hours(addon, bpy, saved, tmp_path):
    out = tmp_path / "saída"
    status = addon.commands.main(["solve", "--hours", "9,12", "--format", "json", "--out", str(out)])
    assert status == 0
    assert [path.name for path in out.iterdir()] == ["casa à luz.json"]
    content = json.loads((out / "casa à luz.json").read_text(encoding="utf-8"))
    assert content["scene"] == "Scene"
    assert [moment["moment"] for moment in content["moments"]] == ["2026-06-22 09:00", "2026-06-22 12:00"]
    noon = content["moments"][1]
    assert noon["time"] == "solar"
    assert noon["sun_altitude"] == pytest.approx(addon.light.sun_place(bpy.context.scene.luzespecular.site).altitude)
    top = next(row for row in noon["surfaces"] if (row["surface"], row["side"]) == ("Laje", "front"))
    assert top["mean_lx"] == pytest.approx(10_000.0, rel=1e-3)
    assert top["sky_direct_mean_lx"] + top["interreflected_mean_lx"] == pytest.approx(top["mean_lx"])
    assert len(noon["faces"]["rows"]) == 8
    assert noon["balance_lm"]["entering"] > 0
    assert addon.commands.main(["solve", "--format", "json", "--no-faces", "--out", str(out)]) == 0
    assert "faces" not in json.loads((out / "casa à luz.json").read_text(encoding="utf-8"))["moments"][0]


def test_pictures_show_legend_and_colours(addon, bpy, saved, tmp_path, monkeypatch):
    monkeypatch.setattr(addon.pictures, "SIZE", (320, 240))
    blocks = {kind: len(getattr(bpy.data, kind)) for kind in ("scenes", "materials", "worlds", "cameras", "curves")}
    assert addon.commands.main(["solve", "--format", "png", "--out", str(tmp_path / "out é")]) == 0
    (picture,) = (tmp_path / "out é").iterdir()
    assert picture.name == "casa à luz_2026-06-22_12h00.png"
    assert {kind: len(getattr(bpy.data, kind)) for kind in blocks} == blocks
    image = bpy.data.images.load(str(picture))
    assert tuple(image.size) == addon.pictures.SIZE
    width, height = image.size
    pixels = np.array(image.pixels[:]).reshape(height, width, 4)[:, :, :3]
    colours = addon.colours
    scale = addon.display.current_scale(bpy.context.scene)
    top = addon.mesh_arrays.read_face_values(bpy.data.objects["Laje"].data, "illuminance", np.float32)[0]
    shown = colours.scale_colours(scale.name, scale.position(top))
    assert (np.abs(pixels - shown).max(axis=2) < 0.02).sum() > 1000  # the slab, in its own colour
    for position in (0.1, 0.5, 0.9):  # and the bar of the legend
        assert (np.abs(pixels - colours.scale_colours(scale.name, position)).max(axis=2) < 0.02).sum() > 4


def test_a_picture_can_be_saved_by_an_operator(addon, bpy, saved, tmp_path):
    with pytest.raises(RuntimeError, match="no results yet"):
        bpy.ops.luzespecular.save_picture(filepath=str(tmp_path / "a.png"))
    bpy.ops.luzespecular.solve()
    assert bpy.ops.luzespecular.save_picture(filepath=str(tmp_path / "a.png"), width=64, height=64) == {"FINISHED"}
    assert tuple(bpy.data.images.load(str(tmp_path / "a.png")).size) == (64, 64)
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RuntimeError, match="could not be"):
        bpy.ops.luzespecular.save_picture(filepath=str(tmp_path / "file" / "a.png"), width=64, height=64)


def test_given_illuminances_are_used_with_every_sky(addon, bpy, saved, tmp_path):
    arguments = "solve --sky clear --sky-illuminance 4000 --sun-illuminance 0 --no-faces --no-blend --out"
    assert addon.commands.main([*arguments.split(), str(tmp_path / "out")]) == 0
    light, _ = addon.light.daylight(bpy.context.scene)
    assert (light.sky_illuminance, light.sun) == (pytest.approx(4000.0), None)


def test_options_reach_the_settings(addon, bpy, saved, tmp_path):
    arguments = "solve --sky cie --cie-type 12 --sky-illuminance 4000 --no-sun --latitude -27 --north 10 --bands 8"
    arguments += " --ground 0.1 --max-area 100 --no-faces --no-blend"
    assert addon.commands.main([*arguments.split(), "--out", str(tmp_path / "out")]) == 0
    settings = bpy.context.scene.luzespecular
    assert (settings.sky.kind, settings.sky.cie_type, settings.sky.use_sun) == ("CIE", "12", False)
    assert settings.sky.horizontal_illuminance == 4000
    assert (settings.site.latitude, settings.site.north_offset) == (-27, 10)
    assert (settings.accuracy.fineness, settings.accuracy.bands) == ("EXPERT", 8)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["casa à luz_surfaces.csv"]


def test_another_scene_can_be_chosen(addon, bpy, saved, tmp_path):
    other = bpy.data.scenes.new("Outra")
    mesh = bpy.data.objects["Chão"].data.copy()
    other.collection.objects.link(bpy.data.objects.new("Pátio", mesh))
    sky = other.luzespecular
    sky.sky.kind, sky.sky.cie_type, sky.accuracy.fineness, sky.accuracy.bands, sky.accuracy.max_area = (
        "CIE",
        "5",
        "EXPERT",
        8,
        9,
    )
    assert addon.commands.main(["solve", "--scene", "Outra", "--out", str(tmp_path / "out"), "--no-blend"]) == 0
    assert {row["surface"] for row in table(tmp_path / "out" / "casa à luz_surfaces.csv")} == {"Pátio"}


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve"],
        [],
        ["solve", "--hours", "25", "--out", "x"],
        ["solve", "--hours", "noon", "--out", "x"],
        ["solve", "--date", "31/12/2026", "--out", "x"],
        ["solve", "--latitude", "91", "--out", "x"],
        ["solve", "--bands", "2", "--out", "x"],
        ["solve", "--sky", "purple", "--out", "x"],
        ["solve", "--format", "doc", "--out", "x"],
    ],
)
def test_wrong_arguments_exit_with_2(addon, bpy, saved, arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        addon.commands.main(arguments)
    assert caught.value.code == 2
    assert "usage" in capsys.readouterr().err


def test_bad_input_exits_with_1_and_writes_nothing(addon, bpy, saved, tmp_path, capsys):
    bpy.data.objects["Laje"].data.vertices[0].co.x = float("nan")
    assert addon.commands.main(["solve", "--out", str(tmp_path / "out")]) == 1
    assert "'Laje'" in capsys.readouterr().err
    assert not any((tmp_path / "out").glob("*"))


def test_one_dark_hour_refuses_all_before_any_is_solved(addon, bpy, saved, tmp_path, capsys):
    assert addon.commands.main(["solve", "--sky", "clear", "--hours", "12,23", "--out", str(tmp_path / "out")]) == 1
    assert "no light at 23:00" in capsys.readouterr().err
    assert not any((tmp_path / "out").glob("*"))


def test_empty_scene_exits_with_1(addon, bpy, tmp_path, capsys):
    assert addon.commands.main(["solve", "--out", str(tmp_path / "out")]) == 1
    assert "no object with faces" in capsys.readouterr().err


def test_unknown_scene_exits_with_1(addon, bpy, saved, tmp_path, capsys):
    assert addon.commands.main(["solve", "--scene", "Nenhuma", "--out", str(tmp_path / "out")]) == 1
    assert "Nenhuma" in capsys.readouterr().err


def test_place_that_cannot_be_written_exits_with_1(addon, bpy, saved, tmp_path, capsys):
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    assert addon.commands.main(["solve", "--out", str(blocked)]) == 1
    assert "file" in capsys.readouterr().err


def test_the_open_file_is_never_overwritten(addon, bpy, saved, capsys):
    moment = saved.with_name("x_2026-06-22_12h00.blend")
    bpy.ops.wm.save_as_mainfile(filepath=str(saved.with_name("x.blend")))
    bpy.ops.wm.save_as_mainfile(filepath=str(moment))
    stem_again = moment.with_name(f"{moment.stem}_2026-06-22_12h00.blend")
    assert addon.commands.main(["solve", "--out", str(saved.parent), "--no-faces"]) == 0
    assert stem_again.exists()
    with pytest.raises(addon.notices.BadInput, match="is the file that is open"):
        addon.commands._save_blend(moment)


def test_interruption_exits_with_130(addon, bpy, saved, tmp_path, monkeypatch):
    def interrupt(self, timeout=0.0):
        raise KeyboardInterrupt

    monkeypatch.setattr(addon.job.Job, "latest", interrupt)
    assert addon.commands.main(["solve", "--out", str(tmp_path / "out")]) == 130
    assert not any((tmp_path / "out").glob("*"))


def test_help_names_every_option(addon, capsys):
    with pytest.raises(SystemExit) as caught:
        addon.commands.main(["solve", "--help"])
    assert caught.value.code == 0
    said = capsys.readouterr().out
    for option in ("--hours", "--out", "--north", "--cie-type", "--max-area", "--no-blend", "--format", "--error"):
        assert option in said


def run(*arguments):
    return subprocess.run(
        [sys.executable, str(ROOT / "luzespecular_addon"), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )


def test_through_the_python_module(saved, tmp_path):
    done = run(saved, "solve", "--out", tmp_path / "out", "--no-blend")
    assert done.returncode == 0, done.stderr
    assert table(tmp_path / "out" / "casa à luz_surfaces.csv")


def test_through_the_python_module_failures(saved, tmp_path):
    missing = run(tmp_path / "não há.blend", "solve", "--out", tmp_path)
    assert missing.returncode == 1
    assert "não há.blend" in missing.stderr
    assert run(saved, "solve").returncode == 2
