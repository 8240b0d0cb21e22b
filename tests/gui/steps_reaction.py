"""How long the window stands still: at rest, while it is redrawn, while solving, while dragging the hour.

The seed room with its mirror shelf at normal fineness. Nothing is asserted of seconds, which are the machine's: median,
95 of 100 and the longest are printed. On a software driver a redraw alone takes most of a tenth of a second.
"""

import importlib
import threading
import time
from pathlib import Path

import bpy
import numpy as np
from driver import PACKAGE
from steps_solve import drag_hour

ROOM = Path(__file__).resolve().parents[2] / "examples" / "light_shelf" / "light_shelf.blend"


def steps(window):
    bpy.ops.wm.open_mainfile(filepath=str(ROOM))
    yield 1.0
    scene = bpy.data.scenes["S1 mirror shelf"]
    window.window.scene = scene
    yield from window.open_tab()
    settings, state = scene.luzespecular, bpy.context.window_manager.luzespecular
    rooms = ("job", "live", "study")
    job, live, study = (importlib.import_module(f"{PACKAGE}.luzespecular_addon.{room}") for room in rooms)

    yield from standing_still(window, "at rest", seconds=3.0)
    yield from standing_still(window, "redrawn all the time", seconds=3.0, redraw=True)

    with window.override():
        assert bpy.ops.luzespecular.solve("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from standing_still(window, "solving", lambda: not state.running)
    print("faces:", sum(len(part.data.polygons) for part in scene.objects if part.luzespecular.is_results), flush=True)
    yield 1.0

    # Each step of a drag, from the setting to the colours in the mesh.
    delays, solved, written = [], [], []
    solve, show = job.Job._solve, study.show
    job.Job._solve = lambda running: with_quick(solve, running, solved)
    study.show = lambda *arguments: timed(show, arguments, written)
    for step in range(20):
        begun = time.perf_counter()
        settings.site.hour = 9.0 + 0.1 * step
        yield from window.until(lambda: settings.results.title == study.title(scene), 30, pause=0.005)
        delays.append(time.perf_counter() - begun)
    tell("a step of the hour, until it is shown", delays)
    tell("  its solution", [seconds for seconds, _, _ in solved])
    tell("    of which the processor worked on it", [work for _, work, _ in solved])
    tell("    of which it waited for a core", [waited for _, _, waited in solved])
    tell("  written to the meshes", written)
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)
    yield from drag_hour(window)
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)
    job.Job._solve, study.show = solve, show


def with_quick(solve, running, seconds):
    """Solve, and note of quick solutions the seconds, those of work, and those that no core was free (Linux)."""
    scheduled = Path(f"/proc/self/task/{threading.get_native_id()}/schedstat")
    before = [1e9 * time.perf_counter(), *map(int, scheduled.read_text().split()[:2])]
    result = solve(running)
    after = [1e9 * time.perf_counter(), *map(int, scheduled.read_text().split()[:2])]
    if running.study.solving.get("quick"):
        seconds.append([(end - begin) / 1e9 for begin, end in zip(before, after, strict=True)])
    return result


def timed(function, arguments, seconds):
    begun = time.perf_counter()
    try:
        return function(*arguments)
    finally:
        seconds.append(time.perf_counter() - begun)


def standing_still(window, what, done=None, seconds=120.0, redraw=False):
    """Tell how long the window stands still at a time until something holds, or some seconds are over: steps."""
    stop_clock = window.clock()
    end = time.monotonic() + seconds
    while time.monotonic() < end and not (done and done()):
        if redraw:
            window.area().tag_redraw()
        yield 0.02
    stop_clock()
    assert done is None or done(), f"waited {seconds} s in vain"
    tell(f"{what}, pauses", window.pauses)
    tell("  work of the main thread", window.work)


def tell(what, seconds):
    """Print median, 95 of 100 and the longest."""
    median, most, longest = np.percentile(seconds, [50, 95, 100])
    print(f"{what}: median {median:.3f} s, 95 % {most:.3f} s, longest {longest:.3f} s ({len(seconds)})", flush=True)
