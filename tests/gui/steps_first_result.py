"""As a new user: from Blender's default scene to lux in colours, by keys and clicks alone, as the guides tell it."""

import importlib
import time

import bpy
from driver import PACKAGE, TAB
from steps_solve import drag_hour, press_solve

A_MINUTE = 60.0


def steps(window):
    live = importlib.import_module(f"{PACKAGE}.luzespecular_addon.live")
    begun = time.monotonic()
    window.move(*middle(window))
    yield 0.3
    window.press("N")
    yield from window.until(lambda: window.region("UI").width > 1, 10)
    yield 0.5
    yield from click_tab(window)
    window.shot("first result 1 tab")
    yield from press_solve(window)
    state, results = bpy.context.window_manager.luzespecular, bpy.context.scene.luzespecular.results
    yield from window.until(lambda: len(results.rows) and not state.running, 60)
    yield 0.5
    window.shot("first result 2 solved")
    print(f"first result after {time.monotonic() - begun:.1f} s", flush=True)
    assert time.monotonic() - begun < A_MINUTE
    shading = window.area().spaces.active.shading
    assert (shading.type, shading.color_type) == ("SOLID", "VERTEX")
    (cube,) = results.rows
    assert cube.name == "Cube"
    assert cube.maximum > 10_000.0

    title = results.title
    yield from drag_hour(window)
    yield from window.until(lambda: not bpy.app.timers.is_registered(live._tick), 30)
    assert results.title != title
    window.shot("first result 3 another hour")


def middle(window):
    area = window.area()
    return area.x + area.width // 2, area.y + area.height // 2


def click_tab(window):
    """Click down the tabs beside the sidebar until ours is open: steps."""
    sidebar = window.region("UI")
    x = sidebar.x + sidebar.width - 12 * bpy.context.preferences.system.ui_scale
    for y in range(sidebar.y + sidebar.height - 20, sidebar.y, -25):
        window.move(x, y)
        yield 0.1
        window.press("LEFTMOUSE", x, y)
        yield 0.3
        if sidebar.active_panel_category == TAB:
            return
    raise AssertionError("no tab of ours in sight")
