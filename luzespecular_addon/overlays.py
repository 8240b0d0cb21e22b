"""Iso-lux lines with their values, and pinned readings, drawn over the 3D viewport."""

from __future__ import annotations

import bpy
import gpu
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

from . import contours, display, drawing, mesh_arrays, probe
from .legend import label

_HALO, _CORE = (0.0, 0.0, 0.0, 0.55), (1.0, 1.0, 1.0, 0.95)
_HALO_WIDTH, _CORE_WIDTH = 3.0, 1.3
_MARK = 4
_DEPTH_TOLERANCE = 1e-6
_LABEL_ROOM = np.array([56.0, 20.0])
"""Width and height that a label needs [pixels at a resolution scale of 1]."""

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
    if object_ is None or not space.overlay.show_overlays:
        return
    mesh = object_.data
    ends = mesh_arrays.edge_ends(mesh)
    values, labels = (mesh_arrays.read_edge_floats(mesh, name) for name in (contours.VALUE, contours.LABEL))
    if values is None or labels is None:
        return
    chosen = np.flatnonzero(labels)
    places = ends[chosen].mean(axis=1)
    seen = _seen(places)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    drawing.lines(ends, _HALO_WIDTH, _HALO)
    drawing.lines(ends, _CORE_WIDTH, _CORE)
    gpu.state.depth_test_set("NONE")
    with drawing.in_pixels():
        shown = _pixels(places[seen])
        for row in _apart(shown, _LABEL_ROOM * drawing.size()):
            drawing.tag(label(float(values[chosen][seen][row])), *map(float, shown[row]))
    gpu.state.blend_set("NONE")


def _apart(places: np.ndarray, room: np.ndarray) -> list[int]:
    """Return which of the labels at places, (m, 2) pixels, can be written without one covering another."""
    kept: list[int] = []
    for row, place in enumerate(places):
        if not (np.abs(places[kept] - place) < room).all(axis=1).any():
            kept.append(row)
    return kept


def _seen(places: np.ndarray) -> np.ndarray:
    """Whether points in space, (m, 3), are in the view with nothing drawn before them."""
    region = bpy.context.region
    clip = _clip(places)
    inside = (clip[:, 3] > 0.0) & (np.abs(clip[:, :2]) < clip[:, 3:]).all(axis=1)
    if not inside.any():
        return inside
    depths = 0.5 + 0.5 * clip[:, 2] / np.where(inside, clip[:, 3], 1.0)
    buffer = gpu.state.active_framebuffer_get()
    left, bottom = gpu.state.viewport_get()[:2]
    for row in np.flatnonzero(inside):
        x, y = ((0.5 + 0.5 * clip[row, :2] / clip[row, 3]) * (region.width, region.height)).astype(int)
        before = buffer.read_depth(left + int(x), bottom + int(y), 1, 1)
        inside[row] = depths[row] <= np.array(before).item() + _DEPTH_TOLERANCE
    return inside


def _pixels(places: np.ndarray) -> np.ndarray:
    """Return where points in space, (m, 3), stand in the region, (m, 2) pixels."""
    clip, region = _clip(places), bpy.context.region
    return (0.5 + 0.5 * clip[:, :2] / clip[:, 3:]) * (region.width, region.height)


def _clip(places: np.ndarray) -> np.ndarray:
    matrix = np.array(bpy.context.region_data.perspective_matrix)
    return np.column_stack([places, np.ones(len(places))]) @ matrix.T


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
