"""Click *Solve*, go on working, cancel; solve, drag the hour, undo, save and load: in the default scene and a room."""

import importlib
from pathlib import Path

import bpy
from driver import PACKAGE

ROOM = Path(__file__).resolve().parents[2] / "examples" / "light_shelf" / "light_shelf.blend"


def steps(window):
    yield from window.open_tab()
    state = lambda: bpy.context.window_manager.luzespecular  # noqa: E731 - Blender moves it when files load
    window.shot("default scene")

    # Solve the default scene by the button itself.
    yield from press_solve(window)
    yield from window.until(lambda: not state().running and bpy.context.scene.luzespecular.results.rows, 60)
    yield 0.5
    window.shot("default scene solved")

    # A room that takes a while: the window stays alive, other work goes on, Esc cancels.
    bpy.ops.wm.open_mainfile(filepath=str(ROOM))
    yield 1.0
    yield from window.open_tab()
    scene = bpy.context.scene
    stop_clock = window.clock()
    yield 2.0
    stop_clock()
    print("longest pauses at rest [s]:", [round(pause, 3) for pause in sorted(window.pauses)[-3:]], flush=True)
    with window.override():
        assert bpy.ops.luzespecular.solve("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    stop_clock = window.clock()
    yield from window.until(lambda: state().fraction > 0.1, 120)
    window.shot("solving")
    with window.override():
        bpy.ops.object.empty_add(location=(0, 0, 5))  # other work: nothing that light meets
    assert state().running
    yield 1.0
    stop_clock()
    worst = sorted(window.pauses)[-3:]
    print("longest pauses while solving [s]:", [round(pause, 3) for pause in worst], flush=True)
    window.press("ESC")
    yield from window.until(lambda: not state().running, 20)
    yield 0.3
    assert not scene.luzespecular.results.rows, "Esc must leave nothing"
    window.shot("cancelled")

    # The geometry changes meanwhile: the results are thrown away.
    scene.luzespecular.accuracy.fineness = "DRAFT"
    with window.override():
        bpy.ops.luzespecular.solve("INVOKE_DEFAULT")
    yield 0.5
    floor = next(object_ for object_ in scene.objects if object_.type == "MESH")
    floor.location.z -= 0.01
    yield from window.until(lambda: not state().running, 120)
    assert not scene.luzespecular.results.rows
    window.shot("thrown away")
    window.press("ESC")  # closes the message, which would keep the mouse to itself
    yield 0.5
    floor.location.z += 0.01
    yield 0.3

    # Solve, then drag the hour with the mouse.
    with window.override():
        bpy.ops.luzespecular.solve("INVOKE_DEFAULT")
    yield from window.until(lambda: not state().running, 120)
    assert scene.luzespecular.results.rows
    yield 0.5
    window.shot("solved")
    live = importlib.import_module(f"{PACKAGE}.luzespecular_addon.live")
    assert live.current.follows(scene)
    yield from drag_hour(window)
    title = scene.luzespecular.results.title
    print("dragged to", round(scene.luzespecular.site.hour, 2), "shown:", title, flush=True)
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)
    window.shot("hour dragged")
    assert scene.luzespecular.results.title != "", title
    hour = scene.luzespecular.site.hour
    assert f"{int(hour):02d}:" in scene.luzespecular.results.title

    # Undo brings hour and results back, redo again.
    with window.override():
        bpy.ops.ed.undo()
    scene = bpy.context.scene
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)
    assert scene.luzespecular.site.hour != hour
    assert f"{int(scene.luzespecular.site.hour):02d}:" in scene.luzespecular.results.title
    window.shot("undone")

    # Undo of the run itself takes results and shading away, redo brings them back.
    shading = lambda: window.area().spaces.active.shading.color_type  # noqa: E731
    steps_back = 0
    while bpy.context.scene.luzespecular.results.rows and steps_back < 6:
        with window.override():
            bpy.ops.ed.undo()
        steps_back += 1
        yield 0.5
    assert not bpy.context.scene.luzespecular.results.rows
    assert shading() != "VERTEX"
    window.shot("run undone")
    for _ in range(steps_back):
        with window.override():
            bpy.ops.ed.redo()
        yield 0.5
    scene = bpy.context.scene
    assert scene.luzespecular.results.rows
    assert shading() == "VERTEX"
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)

    # Saving and loading keeps settings and results.
    path = window.folder / "casa à luz.blend"
    rows = [(row.name, row.mean) for row in scene.luzespecular.results.rows]
    scene.luzespecular.sky.ground_reflectance = 0.25
    yield 1.0
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)
    rows = [(row.name, row.mean) for row in scene.luzespecular.results.rows]
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    yield 1.0
    settings = bpy.context.scene.luzespecular
    assert [(row.name, row.mean) for row in settings.results.rows] == rows
    assert abs(settings.sky.ground_reflectance - 0.25) < 1e-6
    yield from window.open_tab()
    window.shot("loaded")

    # Playing keyframes.
    settings.site.hour = 9.0
    settings.site.keyframe_insert("hour", frame=1)
    settings.site.hour = 15.0
    settings.site.keyframe_insert("hour", frame=21)
    with window.override():
        bpy.ops.luzespecular.solve("INVOKE_DEFAULT")
    yield from window.until(lambda: not state().running, 120)
    titles = set()
    bpy.context.scene.frame_end = 21
    with window.override():
        bpy.ops.screen.animation_play()
    for _ in range(40):
        yield 0.1
        titles.add(settings.results.title)
    with window.override():
        bpy.ops.screen.animation_cancel(restore_frame=False)
    print("hours shown in playback:", len(titles), flush=True)
    assert len(titles) > 3, titles
    window.shot("played")

    # Clear leaves no trace; and the whole in Portuguese.
    with window.override():
        bpy.ops.luzespecular.clear_results()
    yield 0.5
    window.shot("cleared")


def drag_hour(window):
    """Press on the hour, move right in small steps, release."""
    found = []
    yield from window.find("hour", found)
    x, y = found[0]
    window.press("LEFTMOUSE", x, y, "PRESS")
    yield 0.1
    stop_clock = window.clock()
    for step in range(20):
        window.move(x + step + 1, y)
        yield 0.05
    window.press("LEFTMOUSE", x + 20, y, "RELEASE")
    yield 0.1
    stop_clock()
    for what, seconds in (("pauses", window.pauses), ("work of the main thread", window.work)):
        print(f"longest {what} while dragging [s]:", [round(p, 3) for p in sorted(seconds)[-3:]], flush=True)


def press_solve(window):
    """Press the button *Solve*, which stands above *Live*: steps."""
    found = []
    yield from window.find("live", found)
    x, y = found[0]
    height = 30 * bpy.context.preferences.system.ui_scale
    window.move(x, y + height)
    yield 0.2
    window.press("LEFTMOUSE", x, y + height)
    yield 0.3
