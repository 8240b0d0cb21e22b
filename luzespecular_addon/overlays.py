"""Iso-lux lines with their values, and pinned readings, drawn over the 3D viewport."""

from __future__ import annotations

import blf
import bpy
import gpu
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Matrix, Vector

from . import contours, display, drawing, mesh_arrays, probe
from .legend import label

_HALO, _CORE = (0.0, 0.0, 0.0, 0.55), (1.0, 1.0, 1.0, 0.95)
_HALO_WIDTH, _CORE_WIDTH = 3.0, 1.3
_MARK = 4

_handles: list[object] = []


def register() -> None:
    """Begin to draw; without a window there is nothing to draw on."""
    if not bpy.app.background:
        add = bpy.types.SpaceView3D.draw_handler_add
        _handles.append(add(_draw_lines, (), "WINDOW", "POST_VIEW"))
        _handles.append(add(_draw_pins, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def _draw_lines() -> None:
    scene, space = bpy.context.scene, bpy.context.space_data
    object_ = contours.find(scene)
    if object_ is None or not space.overlay.show_overlays or not object_.visible_get():
        return
    mesh = object_.data
    ends = mesh_arrays.edge_ends(mesh)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    drawing.lines(ends, _HALO_WIDTH, _HALO)
    drawing.lines(ends, _CORE_WIDTH, _CORE)
    values, labels = (mesh_arrays.read_edge_floats(mesh, name) for name in (contours.VALUE, contours.LABEL))
    if values is not None and labels is not None:
        for edge in np.flatnonzero(labels):
            _write_in_space(label(float(values[edge])), ends[edge].mean(axis=0))
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _write_in_space(words: str, place: np.ndarray) -> None:
    """Write a text that faces the viewer at a point in space, so that what stands before it hides it."""
    view = bpy.context.region_data
    pixel = _pixel_at(place)
    if pixel <= 0.0:
        return
    size = drawing.size()
    drawing.begin_texts()
    width = drawing.width_of([words])
    towards = view.view_matrix.inverted().to_3x3()
    # A little nearer to the viewer than the line itself.
    lifted = towards @ Vector((0.0, 0.0, 1.0)) * (4.0 * pixel * size)
    matrix = Matrix.Translation(Vector(place) + lifted) @ towards.to_4x4() @ Matrix.Scale(pixel, 4)
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix)
        half, tall = 0.5 * width + 3 * size, 0.75 * drawing.TEXT * size
        drawing.rectangle(-half, -tall, 2 * half, 2 * tall, drawing.PANEL_COLOUR)
        gpu.matrix.translate((0.0, 0.0, 1.0))
        blf.color(drawing.FONT, *drawing.TEXT_COLOUR)
        blf.position(drawing.FONT, -0.5 * width, -0.35 * drawing.TEXT * size, 0.0)
        blf.draw(drawing.FONT, words)


def _pixel_at(place: np.ndarray) -> float:
    """Return how large a pixel is at a point in space; 0 behind the viewer."""
    view, region = bpy.context.region_data, bpy.context.region
    depth = (view.perspective_matrix @ Vector((*place, 1.0))).w
    return max(depth, 0.0) / (0.5 * region.width * view.window_matrix[0][0])


def _draw_pins() -> None:
    scene, space = bpy.context.scene, bpy.context.space_data
    if not space.overlay.show_overlays:
        return
    unit = display.unit_symbol(scene)
    scale = drawing.size()
    for entry in scene.luzespecular.results.pins:
        value = probe.pinned_value(scene, entry)
        where = location_3d_to_region_2d(bpy.context.region, bpy.context.region_data, entry.place)
        if value is None or where is None:
            continue
        x, y = where
        mark = _MARK * scale
        gpu.state.blend_set("ALPHA")
        drawing.rectangle(x - mark, y - mark, 2 * mark, 2 * mark, drawing.PANEL_COLOUR)
        drawing.rectangle(x - mark / 2, y - mark / 2, mark, mark, drawing.TEXT_COLOUR)
        gpu.state.blend_set("NONE")
        drawing.tag(f"{label(value)} {unit}", x, y + 1.6 * drawing.TEXT * scale)
