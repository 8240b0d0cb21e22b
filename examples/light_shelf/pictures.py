"""False-colour pictures of solved faces, rendered by Blender on the processor, without a window or graphics card.

What is rendered is the extension's own results: its fine faces with its colour attribute, as light that the faces give
off by themselves, shown by the Standard view transform, so that colours on the picture are those of the legend.
Specular surfaces are hatched in black: between the stripes stands the illuminance that falls on them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np

COLOURS = "luzespecular"
SURFACE = "surface"
STRIPES = (7.0, 0.0, 4.0)  # per metre along x, y, z: upright to the view on all that a room may have for mirrors
SAMPLES = 8


@contextmanager
def studio(
    results: bpy.types.Object, camera: bpy.types.Object, hatched: Collection[int], size: int
) -> Iterator[Callable[[Path], None]]:
    """Set up a passing scene that holds nothing but the results and the camera, and take it down again.

    Parameters
    ----------
    results : bpy.types.Object
        The extension's results object.
    camera : bpy.types.Object
        Where to look from.
    hatched : collection of int
        Rows of the results table whose surfaces are specular.
    size : int
        Width and height of the pictures [pixels].

    Yields
    ------
    callable
        Takes the path of a PNG file and renders the colours as they are now.
    """
    scene = bpy.data.scenes.new("Pictures")
    scene.collection.objects.link(results)
    scene.collection.objects.link(camera)
    scene.camera = camera
    set_up_cycles(scene, size)
    mesh, hidden = results.data, results.hide_render
    faces = np.empty(len(mesh.polygons), np.int32)
    mesh.attributes[SURFACE].data.foreach_get("value", faces)
    materials = [false_colour_material(hatch) for hatch in (False, True)]
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", np.isin(faces, list(hatched)).astype(np.int32))
    results.hide_render = False

    def shoot(path: Path) -> None:
        scene.render.filepath = str(path.resolve())
        with hushed():
            bpy.ops.render.render(scene=scene.name, write_still=True)

    try:
        yield shoot
    finally:
        results.hide_render = hidden
        mesh.materials.clear()
        for material in materials:
            bpy.data.materials.remove(material)
        bpy.data.scenes.remove(scene)


@contextmanager
def hushed() -> Iterator[None]:
    """Drop what Blender itself prints on every frame; it writes past Python's ``sys.stdout``."""
    sys.stdout.flush()
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)


def set_up_cycles(scene: bpy.types.Scene, size: int) -> None:
    """Make a scene render flat colours: no bounces, no tone mapping, clear background."""
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.samples, cycles.max_bounces = SAMPLES, 0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    render.resolution_x = render.resolution_y = size
    render.resolution_percentage = 100
    render.film_transparent = True
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGBA"
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"


def false_colour_material(hatch: bool) -> bpy.types.Material:
    """Return a material that gives off the colour attribute, between black stripes if asked."""
    material = bpy.data.materials.new("False colour, hatched" if hatch else "False colour")
    if material.node_tree is None:  # before Blender 5.0 a new material has no shader yet
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    colour = nodes.new("ShaderNodeVertexColor")
    colour.layer_name = COLOURS
    links.new(colour.outputs["Color"], emission.inputs["Color"])
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    if hatch:
        place, along = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeVectorMath")
        along.operation = "DOT_PRODUCT"
        along.inputs[1].default_value = STRIPES
        links.new(place.outputs["Position"], along.inputs[0])
        part, stripe = nodes.new("ShaderNodeMath"), nodes.new("ShaderNodeMath")
        part.operation, stripe.operation = "FRACT", "LESS_THAN"
        stripe.inputs[1].default_value = 0.5
        links.new(along.outputs["Value"], part.inputs[0])
        links.new(part.outputs[0], stripe.inputs[0])
        links.new(stripe.outputs[0], emission.inputs["Strength"])
    return material
