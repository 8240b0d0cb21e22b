"""Write light_shelf.blend: the paper's room as three scenes, one for each variant, ready to be solved.

    make blend          (with the oldest supported Blender, so that every later one opens the file)

Each variant is a Blender scene of its own, since materials, settings and results differ: choose it in the scene menu
at the top of the window. An object is called as its surface, followed by the variant (``floor.S1``). The camera stands
north of the room and clips what is nearer than the opening, so that one looks in through sill and lintel.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "tools")]

import blender_session  # noqa: E402
import room  # noqa: E402

CAMERA_DISTANCE = 3.6  # m from the north face
EYE_HEIGHT = 2.1  # m; above the shelf, whose upper face is thus seen
FIELD = 3.1  # m seen at the north face
LARGEST_FACE = 0.0051  # m², a little above half a square of 0.1 m, which Blender's single precision may exceed


def write(path: Path) -> None:
    """Build the three scenes in the running Blender and save them."""
    import bpy

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    blank = bpy.context.scene
    scenes = {key: add_scene(variant) for key, variant in room.VARIANTS.items()}
    window_scene = scenes["S1"]
    for window in bpy.context.window_manager.windows:
        window.scene = window_scene
    bpy.data.scenes.remove(blank)
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                set_view(area.spaces.active)
    path.parent.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path.resolve()), compress=True, check_existing=False)


def add_scene(variant: room.Variant):
    """Add a scene with the nine surfaces of a variant, the camera, and the settings of its solution."""
    import bpy

    scene = bpy.data.scenes.new(f"{variant.key} {variant.title}")
    collection = bpy.data.collections.new(f"Room {variant.key}")
    scene.collection.children.link(collection)
    for name in room.SURFACES:
        obj = bpy.data.objects.new(f"{name}.{variant.key}", surface_mesh(name, variant))
        obj.luzespecular.sides = "FRONT"
        collection.objects.link(obj)
    scene.camera = camera(variant.key)
    scene.collection.objects.link(scene.camera)
    scene.unit_settings.system = "METRIC"
    scene.render.resolution_x = scene.render.resolution_y = 720
    apply_settings(scene.luzespecular)
    return scene


def surface_mesh(name: str, variant: room.Variant):
    """Return the mesh of a surface, squares of 0.1 m, with its material."""
    import bpy

    points, faces = room.grid(room.SURFACES[name])
    mesh = bpy.data.meshes.new(f"{name}.{variant.key}")
    mesh.from_pydata(points, [], faces)
    mesh.materials.append(material(room.REFLECTANCE[name], name in variant.specular))
    mesh.validate()
    return mesh


def material(reflectance: float, specular: bool):
    """Return the material of a reflectance, grey and diffuse or a mirror, made once for all scenes."""
    import bpy

    name = f"{'mirror' if specular else 'diffuse'} {reflectance:.2f}"
    found = bpy.data.materials.get(name)
    if found is not None:
        return found
    made = bpy.data.materials.new(name)
    if made.node_tree is None:  # before Blender 5.0 a new material has no shader yet
        made.use_nodes = True
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (reflectance, reflectance, reflectance, 1.0)
    shader.inputs["Metallic"].default_value = 1.0 if specular else 0.0
    shader.inputs["Roughness"].default_value = 0.0 if specular else 1.0
    made.diffuse_color = (reflectance, reflectance, reflectance, 1.0)
    made.metallic = 1.0 if specular else 0.0
    photometry = made.luzespecular
    photometry.source = "CUSTOM"
    photometry.diffuse_reflectance = 0.0 if specular else reflectance
    photometry.specular_reflectance = reflectance if specular else 0.0
    return made


def camera(key: str):
    """Return a camera that looks south into the room, square to it, its near end at the north face."""
    import bpy

    data = bpy.data.cameras.new(f"From the north.{key}")
    data.sensor_width = 36.0
    data.lens = data.sensor_width * CAMERA_DISTANCE / FIELD
    data.shift_y = (room.SIZE / 2 - EYE_HEIGHT) / FIELD  # keeps the opening in the middle of the picture
    data.clip_start = CAMERA_DISTANCE + 0.002
    obj = bpy.data.objects.new(data.name, data)
    obj.location = (room.SIZE / 2, room.SIZE + CAMERA_DISTANCE, EYE_HEIGHT)
    obj.rotation_euler = (math.pi / 2, 0.0, math.pi)
    return obj


def apply_settings(settings) -> None:
    """Set place, noon of 22 June, sky, Sun, fineness and colours on a scene's settings of the extension."""
    site, sky, accuracy, display = settings.site, settings.sky, settings.accuracy, settings.display
    site.latitude, site.longitude, site.time_zone = room.LATITUDE, room.LONGITUDE, -3.0
    site.day, site.month, site.year = room.DAY, room.MONTH, 2026
    site.time_kind, site.hour = "SOLAR", 12.0
    sky.kind, sky.cie_type, sky.horizontal_illuminance = "CIE", "12", room.SKY_ILLUMINANCE
    sky.use_sun, sky.sun_illuminance = True, room.SUN_ILLUMINANCE
    sky.ground_reflectance = 0.0  # as in the paper: no light from below
    accuracy.fineness, accuracy.bands, accuracy.max_area = "EXPERT", 60, LARGEST_FACE
    display.use_fixed_range, display.low, display.high = True, 200.0, 100_000.0


def set_view(space) -> None:
    """Show a 3D view through the camera, with the faces' fronts only."""
    space.region_3d.view_perspective = "CAMERA"
    space.shading.type = "SOLID"
    space.shading.show_backface_culling = True
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False


def main() -> int:
    """Read the command line and write the file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=HERE / "light_shelf.blend")
    output = parser.parse_args().output
    with blender_session.session():
        write(output)
    print(output)
    return 0


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    os._exit(status)  # Blender 4.2 as a Python module crashes in its own exit handlers once an extension was loaded
