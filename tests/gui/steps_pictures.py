"""The pictures of the user guide: the seed room solved, all panels in both languages.

python tools/gui.py --blender … tests/gui/steps_pictures.py --output docs/images
"""

import subprocess
from pathlib import Path

import bpy
from mathutils import Vector

ROOM = Path(__file__).resolve().parents[2] / "examples" / "light_shelf" / "light_shelf.blend"


def steps(window):
    bpy.ops.wm.open_mainfile(filepath=str(ROOM))
    yield 1.0
    yield from window.open_tab()
    scene = bpy.context.scene
    scene.luzespecular.accuracy.fineness = "DRAFT"
    state = bpy.context.window_manager.luzespecular
    with window.override():
        bpy.context.view_layer.objects.active = next(o for o in scene.objects if o.name.startswith("shelf_top"))
        bpy.ops.luzespecular.solve("INVOKE_DEFAULT")
    yield from window.until(lambda: not state.running, 200)
    assert scene.luzespecular.results.rows
    scene.luzespecular.site.hour = 10.0
    yield 4.0
    window.shot("blender")
    _render(scene, window.folder / "render.png")
    yield 1.0

    # The sidebar from its top and to its end, with all panels open, and the panel of materials: in each language.
    yield from _click(window, "north_offset", below=115)  # opens Sun Light
    yield from _click(window, "fineness", below=-59)  # opens Surfaces
    yield from window.scroll(times=15)
    yield from _click(window, "fineness", below=34)  # opens Scene Check
    yield from window.scroll()
    yield from _click(window, "show_backs", below=32)  # opens Renders and Pictures
    yield from window.scroll(down=False)
    properties = window.area("PROPERTIES")
    properties.spaces.active.context = "MATERIAL"
    for language, ending in (("en_US", ""), ("pt_BR", "-pt")):
        view = bpy.context.preferences.view
        try:
            view.language = language
        except TypeError:
            print("this Blender has no", language, flush=True)
            continue
        view.use_translate_interface = True
        yield 1.0
        with window.override():
            bpy.ops.luzespecular.check_scene()  # findings in the language shown
        for name, area, region, down, times in (
            ("sidebar", "VIEW_3D", "UI", False, 60),
            ("sidebar-middle", "VIEW_3D", "UI", True, 15),
            ("sidebar-end", "VIEW_3D", "UI", True, 60),
            ("material", "PROPERTIES", "WINDOW", True, 60),
        ):
            yield from window.scroll(area, region, down, times)
            whole = window.shot("whole")
            _crop(whole, window, window.region(region, area), window.folder / f"{name}{ending}.png")
            whole.unlink()
        yield from window.scroll(down=False)


def _render(scene, path):
    """Render the false colours with their legend by the scene's own engine, smooth, seen from outside."""
    display, render = scene.luzespecular.display, scene.render
    scene.camera.location, scene.camera.data.lens = (5.5, 8.5, 4.2), 45.0
    way = Vector((1.5, 1.4, 1.3)) - scene.camera.location
    scene.camera.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    scene.camera.data.clip_start, scene.camera.data.shift_y = 0.1, 0.0
    display.shading, display.in_renders = "SMOOTH", True
    render.resolution_x, render.resolution_y, render.filepath = 960, 600, str(path)
    bpy.ops.render.render(write_still=True)
    display.shading, display.in_renders = "FACES", False


def _click(window, name, below):
    """Click some pixels below a property of the sidebar: steps."""
    found = []
    yield from window.find(name, found)
    x, y = found[0][0], found[0][1] - below * bpy.context.preferences.system.ui_scale
    window.move(x, y)
    yield 0.2
    window.press("LEFTMOUSE", x, y)
    yield 0.5


def _crop(picture, window, region, path):
    """Cut a region out of a picture of the screen."""
    height = window.window.height
    box = f"{region.width}x{region.height}+{region.x}+{height - region.y - region.height}"
    subprocess.run(["convert", str(picture), "-crop", box, "+repage", "-strip", str(path)], check=True)
