"""What Blender's side adds to a solution, and how quick it answers the hand.

    python benchmarks/blender_side.py [--faces 25000,50000,100000] [--repeats 5]

First seconds to read 100,000 faces and to write their results back: a plane of quads in hills, as it is and with a
modifier, shown as fine faces and on the own mesh, smooth and with iso-lux lines. The solver is left out: what it would
return is made up, with one value per triangle. Then a step of the hour that is dragged, in the light-shelf room of
some 10,800 faces, solver and all; and how long the main thread waits for its turn beside a solver's thread. Times are
medians of wall time, and of processor time where other work disturbs the clock. `tests/gui/steps_reaction.py` measures
the same in a real window.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import statistics
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))
import blender_session

ROOMS = ("display", "job", "live", "session", "study")
ROOM = Path(__file__).resolve().parents[1] / "examples" / "light_shelf" / "light_shelf.blend"
_NAP, _CALLS = 0.002, 2_000  # what the main thread does between waits: sleep, and as many calls as drawing a panel
CASES = {
    "as it is, fine faces": {},
    "with a modifier, fine faces": {"modified": True},
    "as it is, own mesh": {"view": "OWN"},
    "fine faces, smooth": {"shading": "SMOOTH"},
    "fine faces, iso-lux lines": {"lines": True},
}


def grid(faces: int):
    """Add a plane of some `faces` quads in hills to the scene, lit from above."""
    import bpy

    columns = round((1.6 * faces) ** 0.5)
    rows = round(faces / columns)
    x, y = (places.ravel() for places in np.meshgrid(np.arange(columns + 1) / 100, np.arange(rows + 1) / 100))
    points = np.column_stack([x, y, 0.1 * np.sin(3 * x) * np.cos(2 * y)])
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + columns + 2, corner + columns + 1])
    mesh = bpy.data.meshes.new("Hills")
    mesh.from_pydata(points, [], quads.tolist())
    made = bpy.data.objects.new("Hills", mesh)
    made.luzespecular.sides = "FRONT"
    bpy.context.scene.collection.objects.link(made)
    return made


def made_up_result(export):
    """Return what the solver gives back for faces that it leaves as they are, with values of its own."""
    triangles = np.concatenate([surface.pieces[:, :3] for surface in export.scene.surfaces.values()])
    source = np.concatenate([surface.source_faces for surface in export.scene.surfaces.values()])
    values = 10_000.0 * (1.5 + np.sin(triangles[:, 0, 0]) * np.cos(triangles[:, 0, 1]))
    names = ("sky_direct", "sky_specular", "sun_direct", "sun_specular", "emitted", "interreflected")
    edges = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    front = SimpleNamespace(
        illuminance=values,
        initial=values / 2,
        components=dict.fromkeys(names, values / 6),
        areas=0.5 * np.linalg.norm(edges, axis=1),
    )
    every = np.arange(len(triangles))
    return SimpleNamespace(
        front=front,
        back=None,
        vertices=triangles,
        source_faces=source,
        faces_of=lambda name: every,
        illuminance=values,
        areas=front.areas,
        notes=(),
        transfer=SimpleNamespace(findings=()),
        light=SimpleNamespace(sky_illuminance=10_000.0, sun_illuminance=0.0),
    )


class Clock:
    """Wall and processor time since it was made."""

    def __init__(self):
        self.start = time.perf_counter(), time.process_time()

    def read(self) -> tuple[float, float]:
        """Seconds of both."""
        return time.perf_counter() - self.start[0], time.process_time() - self.start[1]


def once(rooms, faces: int, case: dict) -> dict[str, tuple[float, float]]:
    """Read and write one scene; return seconds of wall and processor time for each step."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_session.enable()
    settings = bpy.context.scene.luzespecular
    settings.sky.kind, settings.sky.cie_type = "CIE", "5"
    display = settings.display
    display.view, display.shading = case.get("view", "RESULTS"), case.get("shading", "FACES")
    display.show_lines = case.get("lines", False)
    hills = grid(faces)
    if case.get("modified"):
        hills.modifiers.new("Move", "DISPLACE").strength = 0.0
    bpy.context.view_layer.update()
    clock = Clock()
    study = rooms.study.collect(bpy.context)
    times = {"export": clock.read()}
    result = made_up_result(study.export)
    clock = Clock()
    rooms.study.finish(bpy.context, study, result)
    times["write-back"] = clock.read()
    clock = Clock()
    rooms.display.write(bpy.context.scene, study.export, result)
    times["another hour"] = clock.read()
    return times


def drag(rooms, repeats: int) -> dict[str, list[tuple[float, float]]]:
    """Drag the hour in the light-shelf room; return seconds of wall and processor time of each part of each step."""
    scene = open_room()
    settings = scene.luzespecular
    times: dict[str, list[tuple[float, float]]] = {}

    def timed(part: str, function):
        clock = Clock()
        found = function()
        times.setdefault(part, []).append(clock.read())
        return found

    import bpy

    with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
        bpy.ops.luzespecular.solve()
        solved = rooms.study.collect(bpy.context)
        for step in range(4 * repeats):
            settings.site.hour = 9.0 + 3.0 * step / (4 * repeats)
            whole = Clock()
            relit = timed("light from the settings", lambda: rooms.study.relit(solved, scene))
            quick = dataclasses.replace(relit, solving={"tolerance": 0.02, "quick": True})
            running = rooms.job.Job(quick, rooms.session.current)
            running.start()
            timed("solution in its thread", running.wait)
            timed("is the scene the same?", lambda: rooms.study.is_current(bpy.context, solved))
            timed(
                "written and coloured",
                lambda quick=quick, job=running: rooms.study.show(scene, quick, job.result, None),
            )
            times.setdefault("the whole step", []).append(whole.read())
    return times


def waits(rooms) -> dict[str, list[float]]:
    """Return by how much the main thread's naps and small work last longer beside a solver's thread, in seconds."""
    scene = open_room()
    import bpy

    found: dict[str, list[float]] = {}
    with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
        planned = rooms.study.collect(bpy.context)
        found["alone"] = [_turn() for _ in range(500)]
        for name, solving in (("beside prepare and solve", {}), ("beside quick solutions", {"quick": True})):
            lasted = found.setdefault(name, [])
            for _ in range(20 if solving else 1):
                running = rooms.job.Job(dataclasses.replace(planned, solving=solving), rooms.session.current)
                running.start()
                while not running.finished:
                    lasted.append(_turn())
                if running.error is not None:
                    raise running.error
    usual = statistics.median(found["alone"])
    return {name: [one - usual for one in lasted] for name, lasted in found.items()}


def _turn() -> float:
    start = time.perf_counter()
    time.sleep(_NAP)
    for _ in range(_CALLS):
        len("a call")
    return time.perf_counter() - start


def open_room():
    """Open the light-shelf room with its mirror shelf, at normal fineness; return its scene."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(ROOM))
    blender_session.enable()
    scene = bpy.data.scenes["S1 mirror shelf"]
    for window in bpy.context.window_manager.windows:
        window.scene = scene
    return scene


def main() -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", default="25000,50000,100000")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    with blender_session.session():
        import bpy

        package = f"{blender_session.PACKAGE}.luzespecular_addon"
        rooms = SimpleNamespace(**{name: importlib.import_module(f"{package}.{name}") for name in ROOMS})
        print(f"Blender {bpy.app.version_string}, NumPy {np.__version__}; seconds of wall time (processor time)\n")
        print("| case | faces | export | write-back | both | another hour |")
        print("|---|---|---|---|---|---|")
        for name, case in CASES.items():
            for faces in map(int, arguments.faces.split(",")):
                runs = [once(rooms, faces, case) for _ in range(arguments.repeats)]
                wall, processor = (
                    {step: statistics.median(run[step][kind] for run in runs) for step in runs[0]} for kind in (0, 1)
                )
                for seconds in (wall, processor):
                    seconds["both"] = seconds["export"] + seconds["write-back"]
                cells = [
                    f"{wall[step]:.3f} ({processor[step]:.3f})"
                    for step in ("export", "write-back", "both", "another hour")
                ]
                print(f"| {name} | {faces:,} | " + " | ".join(cells) + " |", flush=True)
        dragged, waited = drag(rooms, arguments.repeats), waits(rooms)
        print("\n| a step of the hour, light-shelf room | seconds, median | longest |\n|---|---|---|")
        for part, seconds in dragged.items():
            walls, works = zip(*seconds, strict=True)
            cells = [f"{f(walls):.4f} ({f(works):.4f})" for f in (statistics.median, max)]
            print(f"| {part} | " + " | ".join(cells) + " |", flush=True)
        print("\n| the main thread waits, seconds | median | 95 of 100 | longest | number |\n|---|---|---|---|---|")
        for name, lasted in waited.items():
            cells = [f"{value:.4f}" for value in np.percentile(lasted, [50, 95, 100])]
            print(f"| {name} | " + " | ".join(cells) + f" | {len(lasted)} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
