"""Look at results: a work plane, iso-lux lines, the probe with the mouse, errors, own meshes, renders; then clear.

``probe.png`` is the picture in the user guide.
"""

import importlib
from pathlib import Path

import bpy
from driver import PACKAGE
from mathutils import Vector

ROOM = Path(__file__).resolve().parents[2] / "examples" / "light_shelf" / "light_shelf.blend"
SPOT = Vector((1.0, 0.0, 1.2))  # on the south wall


def steps(window):
    bpy.ops.wm.open_mainfile(filepath=str(ROOM))
    yield 1.0
    scene = bpy.data.scenes["S1 mirror shelf"]
    window.window.scene = scene
    yield 0.5
    yield from window.open_tab()
    room = importlib.import_module(f"{PACKAGE}.luzespecular_addon")
    settings, state = scene.luzespecular, bpy.context.window_manager.luzespecular
    look_into_the_room(window)
    before = blocks()

    # A work plane above the floor, read by solving.
    with window.override():
        assert bpy.ops.luzespecular.add_work_plane(spacing=0.25, border=0.25) == {"FINISHED"}
        bpy.context.object.select_set(False)
        settings.accuracy.fineness = "DRAFT"
        bpy.ops.luzespecular.solve("INVOKE_DEFAULT")
    yield from window.until(lambda: not state.running, 300)
    (plane,) = room.work_planes.all_of(scene)
    found = room.work_planes.statistics_of(plane, 1.0)
    assert found.minimum < found.mean < found.maximum, found
    assert abs(found.area - 6.25) < 1e-3, found
    settings.display.use_fixed_range = False
    yield 0.5
    window.shot("work plane")

    # Lines, smooth colours, and the probe under the mouse, which a click keeps.
    settings.display.shading, settings.display.show_lines = "SMOOTH", True
    settings.display.line_levels = "3000 5000 10000"
    yield 1.0
    window.shot("iso-lux lines")
    with window.override():
        assert bpy.ops.luzespecular.probe("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    x, y = on_screen(window, SPOT)
    for step in (2, 1, 0):
        window.move(x + step, y)
        yield 0.5
    window.shot("probe")
    window.press("LEFTMOUSE", x, y)
    yield from window.until(lambda: len(settings.results.pins) == 1, 10)
    window.press("ESC", x, y)
    yield 0.5
    (pin,) = settings.results.pins
    assert (Vector(pin.place) - SPOT).length < 0.05, tuple(pin.place)
    value = room.probe.pinned_value(scene, pin)
    (expected,) = room.display.kept_result(scene)[1].at([SPOT + Vector((0, 1e-4, 0))], [(0, 1, 0)])
    assert abs(value / expected - 1.0) < 0.1, (value, expected)

    # Another hour: the reading and, once at rest, the work plane follow.
    settings.site.hour = 9.0
    yield from window.until(lambda: bpy.app.timers.is_registered(room.live._tick), 10)
    yield from window.until(lambda: not bpy.app.timers.is_registered(room.live._tick), 60)
    assert room.probe.pinned_value(scene, settings.results.pins[0]) != value
    assert room.work_planes.statistics_of(plane, 1.0) != found
    window.shot("another hour")

    # Errors are estimated while the window lives on.
    stop_clock = window.clock()
    settings.display.quantity = "error"
    part = room.results_object.find(scene)
    yield from window.until(lambda: "illuminance_error" in part.data.attributes, 60)
    stop_clock()
    print(
        "longest pauses while errors are estimated [s]:", [round(p, 3) for p in sorted(window.pauses)[-3:]], flush=True
    )
    yield 0.5
    window.shot("error")

    # Own meshes in daylight factors, a scale for the colour-blind, linear.
    settings.display.quantity, settings.display.unit, settings.display.view = "interreflected", "FACTOR", "OWN"
    settings.display.scale, settings.display.scaling = "CIVIDIS", "LINEAR"
    yield 1.0
    window.shot("own meshes")

    # Renders, and all put back.
    settings.display.view, settings.display.in_renders = "RESULTS", True
    yield 0.5
    assert scene.view_layers[0].material_override is not None
    with window.override():
        assert bpy.ops.luzespecular.clear_results() == {"FINISHED"}
        bpy.data.objects.remove(plane)
    yield 0.5
    bpy.data.orphans_purge(do_local_ids=True, do_linked_ids=True, do_recursive=True)
    assert blocks() == before, (blocks(), before)
    assert scene.view_layers[0].material_override is None
    window.shot("cleared again")


def blocks():
    """Names of all data blocks that results could leave."""
    kinds = ("objects", "meshes", "materials", "node_groups")
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in kinds}


def look_into_the_room(window):
    """Turn the view so that one looks through the open north side."""
    view = window.area().spaces.active.region_3d
    view.view_perspective, view.view_location, view.view_distance = "PERSP", (1.6, 1.5, 1.35), 7.5
    view.view_rotation = (Vector((1.5, 1.4, 1.3)) - Vector((6.0, 9.0, 4.6))).to_track_quat("-Z", "Y")


def on_screen(window, place):
    """Pixel of the window where a point of the scene is seen."""
    region = window.region("WINDOW")
    matrix = window.area().spaces.active.region_3d.perspective_matrix
    clip = matrix @ place.to_4d()
    return (
        region.x + (0.5 + 0.5 * clip.x / clip.w) * region.width,
        region.y + (0.5 + 0.5 * clip.y / clip.w) * region.height,
    )
