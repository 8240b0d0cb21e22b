"""The demo as a user runs it: real Blender code, tables that agree with the solver, patches in place."""

import csv
import importlib.util
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

if importlib.util.find_spec("bpy") is None:  # not imported here: the demo has a Blender, and a process, of its own
    pytest.skip("Blender's Python module is not installed", allow_module_level=True)

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    """What the demo writes for the mirror shelf at noon."""
    folder = tmp_path_factory.mktemp("Área de Trabalho") / "à luz"
    command = [sys.executable, str(ROOT / "examples/light_shelf/demo.py"), "--output", str(folder)]
    done = subprocess.run([*command, "--variants", "S1", "--hours", "12"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def colours():
    spec = importlib.util.spec_from_file_location("false_colours", ROOT / "luzespecular_addon" / "colours.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_table_agrees_with_the_solver(output, example):
    import luzespecular as luz

    room = example("light_shelf/room.py")
    with (output / "lux_per_surface.csv").open(encoding="utf-8", newline="") as file:
        table = {row["surface"]: row for row in csv.DictReader(file)}
    assert set(table) == set(room.SURFACES)
    result = luz.prepare(room.scene("S1"), max_area=0.02).solve(room.daylight(12.0))
    for name, row in table.items():
        assert float(row["mean_lx"]) == pytest.approx(result.mean(name), rel=0.02), name
        assert float(row["uniformity"]) == pytest.approx(float(row["minimum_lx"]) / float(row["mean_lx"]), rel=1e-3)


def pixel(size, x, y, z, eye_distance=3.6, eye_height=2.1, field=3.1):
    """Column and row of a point of the room in a picture from the north: one-point perspective, east on the left."""
    shrink = eye_distance / (eye_distance + 3.0 - y)
    across, up = (x - 1.5) * shrink, eye_height + (z - eye_height) * shrink - 1.5
    return int(size * (0.5 - across / field)), int(size * (0.5 - up / field))


def test_mirrored_sun_stands_where_it_must_on_the_picture(output, colours):
    with Image.open(output / "S1_12h_initial.png") as picture:
        pixels = np.asarray(picture.convert("RGB"), float) / 255
    altitude = math.radians(39.56)
    scale = colours.ColourScale("VIRIDIS", 200.0, 100_000.0, True)
    patch = scale.srgb([0.9 * 80_000 * math.sin(altitude)])[0]
    for y, lit in ((0.6, False), (0.9, True), (1.4, True), (1.7, False)):
        column, row = pixel(len(pixels), 1.2, y, 3.0)
        near = np.abs(pixels[row, column] - patch).max() < 0.03
        assert near == lit, f"ceiling at y = {y}"


def test_mirrors_are_hatched_and_the_sheet_is_composed(output):
    with Image.open(output / "S1_12h_final.png") as picture:
        pixels = np.asarray(picture.convert("RGB"))
    column, row = pixel(len(pixels), 1.5, 2.8, 1.775)
    line = pixels[row, column - 150 : column + 150].max(axis=1)
    assert 0.3 < np.mean(line < 10) < 0.7  # about half of the mirror is black stripes
    with Image.open(output / "sheet.png") as sheet:
        assert sheet.width > 600 and sheet.height > 400
    assert (output / "light_shelf_solved.blend").stat().st_size > 100_000
