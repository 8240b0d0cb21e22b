"""Pictures of results with their legend, without a window: rendered on the processor, in a passing scene of their own.

What the viewport would show is rendered with the very colours of the legend: by emission, without any tone mapping,
each side of a face by itself. The user's scene stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..core.writing import complete
from . import colours, display, legend, mesh_arrays, writeback

SIZE = (1280, 960)
_SAMPLES = 8
_BACKGROUND = (0.16, 0.16, 0.16)  # sRGB
_PAPER = (0.08, 0.08, 0.08)
_INK = (0.95, 0.95, 0.95)
_LEGEND_HEIGHT = 0.45  # of the picture
_STEPS = 64


def save(scene: bpy.types.Scene, path: Path, size: tuple[int, int] | None = None) -> Path:
    """Render a scene's results to a PNG file, which appears only when it is complete.

    Parameters
    ----------
    scene : bpy.types.Scene
        With results; seen from its camera, from the south-west above where it has none.
    path : Path
    size : (int, int), optional
        Width and height [pixels]; `SIZE` if not given.

    Raises
    ------
    OSError
        Where the file cannot be written.
    """
    with _stage(scene, size or SIZE) as stage, complete(path) as unfinished:
        stage.render.filepath = str(unfinished.resolve())
        try:
            bpy.ops.render.render(write_still=True, scene=stage.name)
        except RuntimeError as error:  # Blender's own way to say that it could not write
            raise OSError(str(error).strip()) from error
        if not unfinished.exists():
            raise OSError(f"'{path}' could not be written")
    return path


@contextmanager
def _stage(scene: bpy.types.Scene, size: tuple[int, int]) -> Iterator[bpy.types.Scene]:
    """A scene with copies of all that carries colours, camera and legend; all of it is gone afterwards."""
    before = {kind: set(getattr(bpy.data, kind)) for kind in _KINDS}
    stage = bpy.data.scenes.new("LuzEspecular picture")
    try:
        _set_up(stage, size)
        material = _by_attribute()
        shown = [one.object_ for one in display.shown_meshes(scene)]
        points = []
        for object_ in shown:
            if object_.luzespecular.results_side != "back" or scene.luzespecular.display.show_backs:
                copy = bpy.data.objects.new(object_.name, object_.data.copy())
                copy.data.materials.clear()
                copy.data.materials.append(material)
                copy.matrix_world = object_.matrix_world
                stage.collection.objects.link(copy)
            points += [object_.matrix_world @ Vector(corner) for corner in object_.bound_box]
        stage.camera = _camera(stage, scene.camera, points)
        _add_legend(stage, scene)
        yield stage
    finally:
        for kind in _KINDS:  # scenes first: what they hold is free then
            collection = getattr(bpy.data, kind)
            for block in set(collection) - before[kind]:
                collection.remove(block)


_KINDS = ("scenes", "objects", "meshes", "curves", "cameras", "materials", "worlds")


def _set_up(stage: bpy.types.Scene, size: tuple[int, int]) -> None:
    stage.render.engine, stage.cycles.device, stage.cycles.samples = "CYCLES", "CPU", _SAMPLES
    stage.cycles.use_denoising = stage.cycles.use_adaptive_sampling = False
    stage.cycles.max_bounces, stage.cycles.transparent_max_bounces = 0, 1024
    stage.render.resolution_x, stage.render.resolution_y = size
    stage.render.resolution_percentage = 100
    stage.render.image_settings.file_format, stage.render.image_settings.color_mode = "PNG", "RGB"
    stage.render.use_file_extension = False
    view = stage.view_settings
    view.view_transform, view.look, view.exposure, view.gamma = "Standard", "None", 0.0, 1.0
    stage.world = bpy.data.worlds.new("LuzEspecular picture")
    stage.world.color = colours.srgb_to_linear(_BACKGROUND)


def _camera(stage: bpy.types.Scene, given: bpy.types.Object | None, points: list[Vector]) -> bpy.types.Object:
    """A copy of the scene's camera, or one that sees all points from the south-west above."""
    if given is not None and given.type == "CAMERA":
        camera = bpy.data.objects.new("Camera", given.data.copy())
        camera.matrix_world = given.matrix_world
    else:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        way = Vector((-0.55, -0.7, 0.55)).normalized()
        camera.rotation_euler = way.to_track_quat("Z", "Y").to_euler()
        camera.data.shift_x, camera.data.shift_y = -0.05, 0.04  # room for heading and legend
        stage.collection.objects.link(camera)
        stage.view_layers[0].update()
        place, _ = camera.camera_fit_coords(stage.view_layers[0].depsgraph, [x for point in points for x in point])
        distance = max((place - point).length for point in points)
        camera.location = place + 0.08 * distance * way
        camera.data.clip_start, camera.data.clip_end = 1e-3 * distance, 3.0 * distance
        stage.view_layers[0].update()
        return camera
    camera.data.dof.use_dof = False
    stage.collection.objects.link(camera)
    return camera


def _add_legend(stage: bpy.types.Scene, scene: bpy.types.Scene) -> None:
    """Stand heading and colour bar upright before the camera, nearer than all else."""
    data, camera = stage.camera.data, stage.camera
    frame = np.array(data.view_frame(scene=stage))
    distance = data.clip_start * 1.002
    if data.type != "ORTHO":
        frame *= distance / -frame[0, 2]
    (left, bottom), (right, top) = frame[:, :2].min(axis=0), frame[:, :2].max(axis=0)
    location, rotation, _ = camera.matrix_world.decompose()
    view = Matrix.LocRotScale(location, rotation, Vector((1.0, 1.0, 1.0)))
    line, ink, paper = 0.03 * (top - bottom), _plain(_INK), _plain(_PAPER)

    def put(name: str, made: bpy.types.Mesh | bpy.types.Curve, x: float, y: float, behind: float = 0.0) -> None:
        object_ = bpy.data.objects.new(name, made)
        object_.matrix_world = view @ Matrix.Translation((x, y, -distance - behind * data.clip_start))
        stage.collection.objects.link(object_)

    def write(text: str, x: float, y: float) -> None:
        curve = bpy.data.curves.new("Text", "FONT")
        curve.body, curve.size = text, line
        curve.materials.append(ink)
        put("Text", curve, x, y)

    def lay(x: float, y: float, width: float, height: float) -> None:
        corners = np.array([(0, 0, 0), (width, 0, 0), (width, height, 0), (0, height, 0)], np.float32)
        mesh = mesh_arrays.new_mesh("Panel", corners, np.arange(4), np.zeros(1, int))
        mesh.materials.append(paper)
        put("Panel", mesh, x, y, behind=0.001)

    scale = display.current_scale(scene)
    headings = [legend.title(scene), *scene.luzespecular.results.title.split("\n")]
    lay(left, top - 1.4 * line * len(headings) - 0.5 * line, right - left, 1.4 * line * len(headings) + 0.5 * line)
    for row, text in enumerate(headings):
        write(text, left + line, top - 1.4 * line * (row + 1))
    ticks = legend.entries(scale)
    height, x, y = _LEGEND_HEIGHT * (top - bottom), left + 1.5 * line, bottom + 1.5 * line
    letters = max(len(text) for _, text in ticks)
    lay(x - 0.7 * line, y - 0.8 * line, (2.6 + 0.6 * letters) * line, height + 1.6 * line)
    bar = _bar(scale, line, height)
    bar.materials.append(_by_attribute())
    put("Bar", bar, x, y)
    for position, text in ticks:
        write(text, x + 1.4 * line, y + position * height - 0.3 * line)


def _bar(scale: colours.ColourScale, width: float, height: float) -> bpy.types.Mesh:
    """An upright bar of the scale's colours, (steps) quads."""
    edges = np.linspace(0.0, height, _STEPS + 1)
    low, high = edges[:-1], edges[1:]
    corners = np.zeros((_STEPS, 4, 3), np.float32)
    corners[:, 1:3, 0] = width
    corners[:, :2, 1], corners[:, 2:, 1] = low[:, None], high[:, None]
    flat = np.arange(4 * _STEPS)
    mesh = mesh_arrays.new_mesh("Bar", corners.reshape(-1, 3), flat, flat[::4])
    rgba = np.ones((_STEPS, 4))
    rgba[:, :3] = colours.srgb_to_linear(colours.scale_colours(scale.name, (np.arange(_STEPS) + 0.5) / _STEPS))
    mesh_arrays.write_corner_colours(mesh, writeback.COLOURS, np.repeat(rgba, 4, axis=0))
    return mesh


def _material(name: str) -> tuple[bpy.types.Material, bpy.types.ShaderNodeTree]:
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes.clear()
    return material, material.node_tree


def _by_attribute() -> bpy.types.Material:
    """A material that shows the colour attribute on fronts and lets backs be looked through."""
    material, tree = _material("LuzEspecular colours")
    nodes, links = tree.nodes, tree.links
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = writeback.COLOURS
    emission, clear = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeBsdfTransparent")
    mix, output = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeOutputMaterial")
    links.new(attribute.outputs["Color"], emission.inputs["Color"])
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs[0])
    links.new(emission.outputs[0], mix.inputs[1])
    links.new(clear.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def _plain(srgb: tuple[float, float, float]) -> bpy.types.Material:
    material, tree = _material("LuzEspecular ink")
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
    emission.inputs["Color"].default_value = (*colours.srgb_to_linear(srgb), 1.0)
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material
