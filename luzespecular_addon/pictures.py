"""Pictures of results with their legend, without a window: rendered on the processor, in a passing scene of their own.

What the viewport would show is rendered with the very colours of the legend: by emission, without any tone mapping,
each side of a face by itself. The user's scene stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
from mathutils import Vector

from ..core.writing import complete
from . import colours, display, render_legend, writeback

SIZE = (1280, 960)
_SAMPLES = 8
_BESIDE_LEGEND = 1.2  # width of the picture over what is left beside the legend
_BACKGROUND = (0.16, 0.16, 0.16)  # sRGB


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
        stage.camera = _camera(stage, scene.camera, points, scene.luzespecular.display)
        if scene.luzespecular.display.legend_in_renders:
            _add_legend(stage, scene, material)
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


def _camera(
    stage: bpy.types.Scene,
    given: bpy.types.Object | None,
    points: list[Vector],
    settings: bpy.types.PropertyGroup,
) -> bpy.types.Object:
    """A copy of the scene's camera, or one that sees all points from the south-west above, beside the legend."""
    if given is not None and given.type == "CAMERA":
        camera = bpy.data.objects.new("Camera", given.data.copy())
        camera.matrix_world = given.matrix_world
    else:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        way = Vector((-0.55, -0.7, 0.55)).normalized()
        camera.rotation_euler = way.to_track_quat("Z", "Y").to_euler()
        lens = camera.data.lens
        if settings.legend_in_renders:
            camera.data.lens *= _BESIDE_LEGEND  # for the fit alone
        stage.collection.objects.link(camera)
        stage.view_layers[0].update()
        place, _ = camera.camera_fit_coords(stage.view_layers[0].depsgraph, [x for point in points for x in point])
        distance = max((place - point).length for point in points)
        camera.location = place + 0.08 * distance * way
        if settings.legend_in_renders:
            camera.data.lens = lens
            camera.data.shift_x = (
                0.5 * (1.0 / _BESIDE_LEGEND - 1.0) * (1.0 if "LEFT" in settings.legend_corner else -1.0)
            )
        camera.data.clip_start, camera.data.clip_end = 1e-3 * distance, 3.0 * distance
        stage.view_layers[0].update()
        return camera
    camera.data.dof.use_dof = False
    stage.collection.objects.link(camera)
    return camera


def _add_legend(stage: bpy.types.Scene, scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    """Stand the legend before the camera, nearer than all else."""
    scale = display.current_scale(scene)
    made = render_legend.new_mesh(render_legend.Words.of(scene, scale), scale.name)
    made.materials.append(material)
    object_ = bpy.data.objects.new(render_legend.NAME, made)
    stage.collection.objects.link(object_)
    render_legend.stand(object_, stage, scene.luzespecular.display)


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
