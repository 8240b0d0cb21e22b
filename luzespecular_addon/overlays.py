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
_NEARER = 0.004
"""Of the distance; a pixel is some 0.001 of it wide."""

_LABEL_ROOM = np.array([90.0, 36.0])
"""Least distance of labels across and along the screen [pixels at a resolution scale of 1]."""

_handles: list[object] = []


def register() -> None:
    """Begin to draw; without a window there is nothing to draw on."""
    drawing.begin(_handles, (_draw_lines, "POST_VIEW"), (_draw_pins, "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing."""
    drawing.end(_handles)


def _draw_lines() -> None:
    scene, space = bpy.context.scene, bpy.context.space_data
    object_ = contours.find(scene)
    if object_ is None or not space.overlay.show_overlays:
        return
    mesh = object_.data
    ends = mesh_arrays.edge_ends(mesh)
    values, labels = (mesh_arrays.read_edge_floats(mesh, name) for name in (contours.VALUE, contours.LABEL))
    normals = mesh_arrays.read_edge_vectors(mesh, contours.NORMAL)
    if values is None or labels is None or normals is None:
        return
    if space.shading.show_backface_culling:  # lines go with their faces
        facing = _faces_viewer(ends.mean(axis=1), normals)
        ends, values, labels = ends[facing], values[facing], labels[facing]
    ends = _nearer(ends)
    chosen = np.flatnonzero(labels)
    places, levels = ends[chosen].mean(axis=1), values[chosen]
    labelled = _labelled(places, levels)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    writes_depth = gpu.state.depth_mask_get()
    gpu.state.depth_mask_set(False)  # else halos hide parts of their own cores
    drawing.lines(ends, _HALO_WIDTH, _HALO)
    drawing.lines(ends, _CORE_WIDTH, _CORE)
    gpu.state.depth_mask_set(writes_depth)
    gpu.state.depth_test_set("NONE")
    with drawing.in_pixels():
        for row, (x, y) in labelled:
            drawing.tag(label(float(levels[row])), x, y)
    gpu.state.blend_set("NONE")


def _nearer(ends: np.ndarray) -> np.ndarray:
    """Move lines a little towards the viewer, which none sees: thick lines would dip into faces that lean away."""
    view = bpy.context.region_data
    from_view = view.view_matrix.inverted()
    if view.is_perspective:
        return ends + _NEARER * (np.array(from_view.translation) - ends)
    width = 2.0 / view.window_matrix[0][0]
    return ends + _NEARER * width * np.array(from_view.to_3x3().col[2])


def _faces_viewer(places: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Whether faces at places, (m, 3), show their fronts."""
    view = bpy.context.region_data
    from_view = view.view_matrix.inverted()
    if view.is_perspective:
        towards = np.array(from_view.translation) - places
    else:
        towards = np.array(from_view.to_3x3().col[2])[None]
    return np.einsum("mc,mc->m", np.broadcast_to(towards, normals.shape), normals) > 0.0


def _labelled(places: np.ndarray, levels: np.ndarray) -> list[tuple[int, tuple[float, float]]]:
    """Return which labels are written and at which pixels: those that nothing hides, with room between them."""
    region = bpy.context.region
    clip = _clip(places)
    inside = (clip[:, 3] > 0.0) & (np.abs(clip[:, :2]) < clip[:, 3:]).all(axis=1)
    at = np.zeros((len(places), 3))
    at[inside] = 0.5 + 0.5 * clip[inside, :3] / clip[inside, 3:]
    at[:, :2] *= (region.width, region.height)
    buffer = gpu.state.active_framebuffer_get()
    left, bottom = gpu.state.viewport_get()[:2]
    room = _LABEL_ROOM * drawing.size()
    kept: list[int] = []
    for row in np.flatnonzero(inside):
        # Those of one level keep twice the distance.
        apart = room * np.where(levels[kept] == levels[row], 2.0, 1.0)[:, None]
        if (np.abs(at[kept, :2] - at[row, :2]) < apart).all(axis=1).any():
            continue
        before = buffer.read_depth(left + int(at[row, 0]), bottom + int(at[row, 1]), 1, 1)
        if at[row, 2] <= np.array(before).item() + _DEPTH_TOLERANCE:
            kept.append(int(row))
    return [(row, (float(at[row, 0]), float(at[row, 1]))) for row in kept]


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
