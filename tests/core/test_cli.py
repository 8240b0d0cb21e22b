"""The console command: what it writes agrees with the solver; bad input is refused by name and writes nothing."""

import csv
import datetime as dt
import json
import signal
import subprocess
import sys
import tomllib
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import luzespecular as luz
from luzespecular import cli, terminal

ROOT = Path(__file__).resolve().parents[2]
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
SCENE = {
    "materials": {"grey": {"diffuse_reflectance": 0.5}, "mirror": {"specular_reflectance": 0.9}},
    "surfaces": [
        {"name": "Chão", "vertices": [[x, y, 0] for x, y in SQUARE], "material": "grey"},
        {"name": "wall", "vertices": [[0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]], "material": "mirror"},
        {"name": "Laje", "vertices": [[x, y, 2] for x, y in SQUARE], "material": "grey", "two_sided": True},
    ],
    "points": [{"name": "desk", "positions": [[0.5, 0.5, 3.0]], "normal": [0, 0, 1]}],
}
SITE = ["--latitude", "-27.6", "--longitude", "-48.55", "--date", "2026-12-21"]
QUICK = ["--bands", "12", "--max-area", "inf"]


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "casa à luz.json"
    path.write_text(json.dumps(SCENE), encoding="utf-8")
    return path


def run(scene, out, *more, site=SITE):
    return cli.main(["solve", str(scene), "--out", str(out), *site, *QUICK, *more])


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def the_same(scene_file, when, **sky):
    """What the command should compute, by the solver itself."""
    scene = luz.Scene()
    materials = {name: luz.Material(**values) for name, values in SCENE["materials"].items()}
    for entry in SCENE["surfaces"]:
        material = materials[entry["material"]]
        scene.add(entry["name"], entry["vertices"], material, two_sided=entry.get("two_sided", False))
    altitude, azimuth = luz.sun_position(-27.6, -48.55, when)
    light = luz.default_daylight("clear", altitude, azimuth + sky.get("north", 0.0), when.timetuple().tm_yday)
    return luz.solve(scene, light, bands=12, max_area=np.inf)


def test_solves_hours_by_the_clock_and_writes_everything(scene, tmp_path, capsys):
    out = tmp_path / "meus resultados"
    assert run(scene, out, "--time-zone", "-3", "--hours", "9,12:30", "--format", "csv,json,npz", "--north", "10") == 0
    assert {path.name for path in out.iterdir()} == {
        "casa à luz_surfaces.csv",
        "casa à luz_points.csv",
        "casa à luz.json",
        "casa à luz_2026-12-21_09h00_faces.csv",
        "casa à luz_2026-12-21_09h00.npz",
        "casa à luz_2026-12-21_12h30_faces.csv",
        "casa à luz_2026-12-21_12h30.npz",
    }
    zone = dt.timezone(dt.timedelta(hours=-3))
    expected = the_same(scene, dt.datetime(2026, 12, 21, 12, 30, tzinfo=zone), north=10.0)

    rows = {
        (row["surface"], row["side"]): row
        for row in table(out / "casa à luz_surfaces.csv")
        if row["moment"] == "2026-12-21 12:30"
    }
    assert set(rows) == {("Chão", "front"), ("wall", "front"), ("Laje", "front"), ("Laje", "back")}
    assert float(rows["Chão", "front"]["mean_lx"]) == pytest.approx(expected.mean("Chão"), rel=1e-6)
    assert {row["time"] for row in rows.values()} == {"clock"}
    floor = rows["Chão", "front"]
    for quantity, values in (("initial", expected.initial), *expected.components.items()):
        faces = expected.faces_of("Chão")
        of_floor, mean = values[faces], np.average(values[faces], weights=expected.areas[faces])
        assert float(floor[f"{quantity}_mean_lx"]) == pytest.approx(mean, rel=1e-6)
        assert float(floor[f"{quantity}_minimum_lx"]) == pytest.approx(of_floor.min(), rel=1e-6)
        assert float(floor[f"{quantity}_maximum_lx"]) == pytest.approx(of_floor.max(), rel=1e-6)

    with np.load(out / "casa à luz_2026-12-21_12h30.npz", allow_pickle=False) as arrays:
        np.testing.assert_allclose(arrays["illuminance"], expected.illuminance, rtol=1e-6)
        np.testing.assert_allclose(arrays["back_illuminance"], expected.back.illuminance, rtol=1e-6)
        assert arrays["surfaces"][arrays["surface"]].tolist() == [
            name for name in expected.surfaces for _ in expected.faces_of(name)
        ]
    faces = table(out / "casa à luz_2026-12-21_12h30_faces.csv")
    assert len(faces) == len(expected.illuminance) + np.isfinite(expected.back.illuminance).sum()
    assert {"surface", "side", "x_m", "normal_z", "area_m2", "illuminance_lx", "sun_specular_lx"} <= set(faces[0])

    (desk,) = [row for row in table(out / "casa à luz_points.csv") if row["moment"].endswith("12:30")]
    assert float(desk["illuminance_lx"]) == pytest.approx(expected.at([[0.5, 0.5, 3]], [[0, 0, 1]])[0], rel=1e-6)

    parts = expected.at([[0.5, 0.5, 3]], [[0, 0, 1]], components=True)
    assert {name: float(desk[f"{name}_lx"]) for name in parts} == pytest.approx(
        {name: values[0] for name, values in parts.items()}, rel=1e-6
    )

    document = json.loads((out / "casa à luz.json").read_text("utf-8"))["moments"][1]
    assert document["point_quantities_lx"]["desk"]["sky_direct"] == pytest.approx(parts["sky_direct"], rel=1e-6)
    assert document["points"]["desk"] == pytest.approx([float(desk["illuminance_lx"])], rel=1e-6)
    assert document["balance_lm"]["entering"] == pytest.approx(expected.balance.entering, rel=1e-6)
    assert len(document["faces"]["rows"]) == len(faces)
    said = capsys.readouterr()
    assert "Chão" in said.out and "wrote" in said.out
    assert "%" in said.err and "%" not in said.out


def test_solar_hours_need_no_longitude(scene, tmp_path):
    site = ["--latitude", "-27.6", "--date", "2026-12-21"]
    arguments = ["--sky", "none", "--sun-illuminance", "80000", "--ground", "0", "--no-faces"]
    assert run(scene, tmp_path / "out", *arguments, site=site) == 0
    (path,) = (path for path in (tmp_path / "out").iterdir() if "surfaces" in path.name)
    top = next(row for row in table(path) if (row["surface"], row["side"]) == ("Laje", "front"))
    noon_altitude = 90.0 - (27.6 - 23.43)
    assert float(top["mean_lx"]) == pytest.approx(80_000 * np.sin(np.radians(noon_altitude)), rel=1e-3)
    assert top["time"] == "solar"


def test_a_given_sky(scene, tmp_path):
    arguments = ["--cie-type", "5", "--sky-illuminance", "10000", "--no-sun", "--no-faces", "--ground", "0"]
    assert run(scene, tmp_path / "out", *arguments) == 0
    rows = table(tmp_path / "out" / "casa à luz_surfaces.csv")
    top = next(row for row in rows if (row["surface"], row["side"]) == ("Laje", "front"))
    assert float(top["mean_lx"]) == pytest.approx(10_000.0, rel=1e-3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--hours", "12,23"], "no light at 2026-12-21 23:00"),
        (["--latitude", "91"], "latitude is 91"),
        (["--sky", "cie"], "needs --sky-illuminance"),
        (["--sky", "cie", "--sky-illuminance", "1000"], "needs --sun-illuminance"),
        (["--sky", "clear", "--sky-illuminance", "1000"], "--sky-illuminance does not go with --sky clear"),
        (["--sky", "none", "--no-sun", "--sky-illuminance", "1"], "does not go with --sky none"),
        (["--sky", "overcast", "--cie-type", "3"], "--cie-type does not go with --sky overcast"),
        (["--ground", "20"], "ground_reflectance is 20"),
        (["--bands", "1"], "bands must lie between"),
        (["--max-area", "-1"], "max_area must be above 0"),
        (["--cycles", "-1"], "cycles"),
        (["--memory", "1e-9"], "more than"),
    ],
)
def test_bad_input_exits_with_2_and_writes_nothing(scene, tmp_path, capsys, arguments, message):
    assert run(scene, tmp_path / "out", *arguments) == 2
    said = capsys.readouterr()
    assert message in said.err and "luzespecular: failed" in said.err
    assert not any((tmp_path / "out").glob("*"))


def test_the_clock_needs_a_longitude(scene, tmp_path, capsys):
    site = ["--latitude", "-27.6", "--date", "2026-12-21", "--time-zone", "-3"]
    assert run(scene, tmp_path / "out", site=site) == 2
    assert "--longitude" in capsys.readouterr().err


def test_a_cache_is_used_again_and_told(scene, tmp_path, capsys):
    cache = ["--cache", str(tmp_path / "cache.npz")]
    assert run(scene, tmp_path / "a", *cache) == 0
    assert "not there yet" in capsys.readouterr().out
    assert run(scene, tmp_path / "b", *cache) == 0
    assert "taken from" in capsys.readouterr().out
    a, b = (table(tmp_path / name / "casa à luz_surfaces.csv") for name in "ab")
    assert a == b
    assert run(scene, tmp_path / "c", "--cache", str(tmp_path / "none" / "cache.npz")) == 2


def test_wanted_faces_alone(scene, tmp_path):
    assert run(scene, tmp_path / "out", "--receivers", "Chão", "--receivers", "Laje") == 0
    rows = table(tmp_path / "out" / "casa à luz_surfaces.csv")
    assert {row["surface"] for row in rows} == {"Chão", "Laje"}
    assert run(scene, tmp_path / "none", "--receivers", "roof") == 2


def test_a_bad_scene_exits_with_2(scene, tmp_path, capsys):
    scene.write_text(json.dumps({"surfaces": []}), encoding="utf-8")
    assert run(scene, tmp_path / "out") == 2
    assert "no surfaces" in capsys.readouterr().err
    scene.write_text(json.dumps(SCENE).replace("0.9", "1.9"), encoding="utf-8")
    assert run(scene, tmp_path / "out") == 2
    assert "Material 'mirror': specular_reflectance is 1.9" in capsys.readouterr().err


def test_files_that_cannot_be_read_or_written_exit_with_1(scene, tmp_path, capsys):
    assert run(tmp_path / "none.json", tmp_path / "out") == 1
    assert "none.json" in capsys.readouterr().err
    (tmp_path / "blocked").write_text("in the way")
    assert run(scene, tmp_path / "blocked") == 1
    assert "blocked" in capsys.readouterr().err


def test_interruption_exits_with_130_and_writes_nothing(scene, tmp_path, monkeypatch, capsys):
    def interrupt(self, fraction, stage):
        raise KeyboardInterrupt

    monkeypatch.setattr(terminal.Progress, "__call__", interrupt)
    assert run(scene, tmp_path / "out") == 130
    assert "interrupted" in capsys.readouterr().err
    assert not any((tmp_path / "out").iterdir())


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["solve"],
        ["solve", "x.json", "--out", "x"],
        ["sun", "--latitude", "1"],
        ["sun", "--latitude", "1", "--date", "21/12/2026"],
        ["sun", "--latitude", "1", "--date", "2026-12-21", "--hours", "25"],
        ["sun", "--latitude", "1", "--date", "2026-12-21", "--time-zone", "Mars/Olympus"],
        ["sun", "--latitude", "1", "--date", "2026-12-21", "--time-zone", "../etc"],
        ["sun", "--latitude", "1", "--date", "2026-12-21", "--time-zone", "nan"],
        ["sun", "--latitude", "1", "--date", "2026-12-21", "--time-zone", "30"],
        ["solve", "x.json", "--out", "x", "--latitude", "1", "--date", "2026-12-21", "--format", "xls"],
    ],
)
def test_wrong_arguments_exit_with_2(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(arguments)
    assert caught.value.code == 2
    assert "usage" in capsys.readouterr().err


def test_sun_by_the_clock(capsys):
    # Florianópolis, winter solstice: almanac sunrise 07:04, sunset 17:28 (UTC-3)
    assert cli.main(["sun", *SITE[:4], "--date", "2026-06-22", "--time-zone", "-3", "--hours", "9.5"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "sunrise 07:04, sunset 17:28" in lines
    altitude, azimuth = luz.sun_position(-27.6, -48.55, dt.datetime(2026, 6, 22, 12, 30, tzinfo=dt.UTC))
    assert lines[-1].split() == ["09:30", f"{altitude:.2f}", f"{azimuth:.2f}"]


def test_sun_in_solar_time(capsys):
    assert cli.main(["sun", "--latitude", "-27.6", "--date", "2026-06-21"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[4:]] == [f"{hour:02d}:00" for hour in range(7, 18)]
    assert float(lines[9].split()[1]) == pytest.approx(90.0 - 27.6 - 23.44, abs=0.01)  # noon in the solstice
    assert cli.main(["sun", "--latitude", "80", "--date", "2026-06-22"]) == 0
    assert "neither rises nor sets" in capsys.readouterr().out
    assert cli.main(["sun", "--latitude", "95", "--date", "2026-06-22"]) == 2


def test_one_version_everywhere(capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out.strip() == f"luzespecular {luz.__version__}"
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text("utf-8"))
    assert project["version"] == manifest["version"] == luz.__version__
    assert project["scripts"] == {"luzespecular": "luzespecular.cli:main"}


@pytest.mark.parametrize(
    ("hour", "text"), [(9.5, "09:30"), (0.0, "00:00"), (23.999, "24:00"), (24.0, "24:00"), (12.991, "12:59")]
)
def test_hours_read_well(hour, text):
    assert terminal.clock(hour) == text


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for a single process")
def test_control_c_ends_a_run_that_is_under_way(tmp_path):
    room = ROOT / "examples" / "light_shelf" / "light_shelf.json"
    arguments = ["solve", str(room), "--out", str(tmp_path / "out"), *SITE, "--bands", "90"]
    running = subprocess.Popen(
        [sys.executable, "-m", "luzespecular.cli", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        # where the tests run in a shell's background, interrupts are ignored from the start
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )
    try:
        while "visibility" not in running.stderr.readline():
            assert running.poll() is None
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=30)
    finally:
        running.kill()
    assert running.returncode == 130
    assert said.splitlines()[-1] == "luzespecular: failed: interrupted"
    assert not any((tmp_path / "out").iterdir())
