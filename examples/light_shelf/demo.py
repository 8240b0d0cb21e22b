"""Solve the light-shelf room in Blender, in three variants and at three hours, and draw the paper's figures 8 to 12.

    make demo        or        python examples/light_shelf/demo.py --output build/demo

The extension is built and installed in a Blender of its own (the ``bpy`` module, with user files in a passing folder);
its operators do the work, as they would behind the window. Printed and saved as CSV: lux per surface. Saved as well:
false-colour pictures, initial and final, one sheet of all of them, and the solved .blend.
"""

from __future__ import annotations

import argparse
import csv
import logging
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "tools")]

import blender_session  # noqa: E402
import room  # noqa: E402

SIZE = 720
QUANTITIES = {"initial": "initial", "final": "illuminance"}

FIGURES = {  # of the paper, by variant, hour and quantity
    ("D", 10.0, "final"): "7 b",
    ("D", 12.0, "final"): "8 b",
    ("S1", 9.0, "initial"): "9 a",
    ("S1", 9.0, "final"): "9 b",
    ("S1", 12.0, "initial"): "10 a",
    ("S1", 12.0, "final"): "10 b",
    ("S2", 9.0, "initial"): "11 a",
    ("S2", 9.0, "final"): "11 b",
    ("S2", 12.0, "initial"): "12 a",
    ("S2", 12.0, "final"): "12 b",
}

HEADER = ("variant", "hour", "surface", "minimum_lx", "mean_lx", "maximum_lx", "uniformity")


def main() -> int:
    """Read the command line and run everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=Path("build/demo"), help="folder for tables and pictures")
    parser.add_argument(
        "--variants", nargs="+", choices=room.VARIANTS, default=list(room.VARIANTS), help="which to solve"
    )
    parser.add_argument("--hours", nargs="+", type=float, default=list(room.HOURS), help="solar time")
    parser.add_argument("--no-pictures", action="store_true", help="print and save the tables only")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    with blender_session.session():
        run(arguments.output, arguments.variants, arguments.hours, pictures=not arguments.no_pictures)
    return 0


def run(output: Path, variants: list[str], hours: list[float], pictures: bool) -> None:
    """Solve and draw variants and hours with the running Blender."""
    import bpy

    start = time.perf_counter()
    bpy.ops.wm.open_mainfile(filepath=str(HERE / "light_shelf.blend"))
    table = []
    for variant in map(room.VARIANTS.get, variants):
        scene = bpy.data.scenes[f"{variant.key} {variant.title}"]
        bpy.context.window.scene = scene
        for hour in hours:
            begin = time.perf_counter()
            scene.luzespecular.site.hour = hour
            bpy.ops.luzespecular.solve()
            seconds = time.perf_counter() - begin
            rows = [(row.name.split(".")[0], row) for row in scene.luzespecular.results.rows]
            table += [
                (variant.key, hour, name, row.minimum, row.mean, row.maximum, row.uniformity) for name, row in rows
            ]
            print_table(f"{variant.key} ({variant.title}), {hour:g} h, clear sky and Sun: {seconds:.2f} s", rows)
            if pictures:
                hatched = [i for i, (name, _) in enumerate(rows) if name in variant.specular]
                draw(scene, output, stem(variant.key, hour), hatched)
    write_table(output / "lux_per_surface.csv", table)
    bpy.ops.wm.save_as_mainfile(filepath=str((output / "light_shelf_solved.blend").resolve()), copy=True)
    if pictures:
        write_sheet(output, variants, hours)
    print(f"\n{time.perf_counter() - start:.1f} s in all; tables, pictures and the solved .blend are in {output}")
    if pictures:
        print(f"look at {output / 'sheet.png'} first")


def print_table(title: str, rows) -> None:
    """Print lux per surface."""
    print(f"\n{title}\n{'lux':<14}{'minimum':>10}{'mean':>10}{'maximum':>10}{'uniformity':>12}")
    for name, row in rows:
        print(f"{name:<14}{row.minimum:>10,.0f}{row.mean:>10,.0f}{row.maximum:>10,.0f}{row.uniformity:>12.3f}")


def write_table(path: Path, table) -> None:
    """Save lux per surface of all runs as CSV."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(HEADER)
        writer.writerows((*row[:3], *(f"{value:.6g}" for value in row[3:])) for row in table)


def stem(variant: str, hour: float) -> str:
    """Return how the pictures of a run are called."""
    return f"{variant}_{hour:04.1f}h".replace(".0h", "h")


def draw(scene, output: Path, name: str, hatched: list[int]) -> None:
    """Render the fine faces, before and after the diffuse cycles."""
    import pictures

    results = next(obj for obj in scene.objects if obj.luzespecular.is_results)
    with pictures.studio(results, scene.camera, hatched, SIZE) as shoot:
        for state, quantity in QUANTITIES.items():
            scene.luzespecular.display.quantity = quantity
            shoot(output / f"{name}_{state}.png")


def write_sheet(output: Path, variants: list[str], hours: list[float]) -> None:
    """Compose all pictures with captions and legend."""
    import importlib

    import bpy
    import sheet

    colours = importlib.import_module(f"{blender_session.PACKAGE}.luzespecular_addon.colours")
    display = bpy.data.scenes[0].luzespecular.display
    scale = colours.ColourScale(display.scale, display.low, display.high, display.scaling == "LOG")
    legend = sheet.Legend(scale.low, scale.high, scale.logarithmic, scale.ticks(9), scale.position, scale.srgb)
    rows = []
    for variant in map(room.VARIANTS.get, variants):
        cells = []
        for hour in hours:
            for name in QUANTITIES:
                figure = FIGURES.get((variant.key, hour, name))
                path = output / f"{stem(variant.key, hour)}_{name}.png"
                cells.append(sheet.Cell(path, f"{hour:g} h, {name}", f"fig. {figure}" if figure else ""))
        rows.append((f"{variant.key}: {variant.title}", cells))
    notes = [
        "Room of 3 x 3 x 3 m, open to the north between 1.0 and 2.5 m, latitude 27° south, 22 June, solar time. "
        "View from the north face inwards: east is on the left.",
        "CIE clear sky (type 12) of 10,000 lx and Sun of 80,000 lx on its normal at every hour. "
        "Initial: before any diffuse reflection; final: with all of them.",
        "Black hatching: specular surface; between the stripes, the illuminance that falls on it. "
        "Numbers of figures: the paper's.",
    ]
    sheet.compose(rows, legend, "Light-shelf room of Claro & Pereira: illuminance", notes).save(output / "sheet.png")


if __name__ == "__main__":
    logging.basicConfig(level=logging.WARNING)
    raise SystemExit(main())
