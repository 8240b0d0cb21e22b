"""The object *LuzEspecular iso-lux lines*: lines of equal illuminance on all that is shown, and where labels stand."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from . import colours, isolines, mesh_arrays, own_objects, smoothing

if TYPE_CHECKING:
    from .display import Shown

NAME = "LuzEspecular iso-lux lines"
SIDE = "lines"

VALUE = "illuminance"
"""FLOAT attribute of the EDGE domain: the value that the line runs along, in the unit of the legend."""

LABEL = "label"
"""FLOAT attribute of the EDGE domain: 1 where a label stands."""

NORMAL = "normal"
"""FLOAT_VECTOR attribute of the EDGE domain: normal of the face that the line lies on."""

_LIFT = 1e-3
"""How far lines stand off the faces, over the extent of all that is shown."""

_LABELS_APART = 0.06
"""Least distance of places for labels, over the same; which are used depends on the view."""


def find(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """Return the object of the lines, if there is one."""
    return own_objects.find(scene, SIDE)


def levels(scene: bpy.types.Scene, scale: colours.ColourScale) -> list[float]:
    """Return the values that lines are drawn for: the user's own, or the legend's ticks."""
    try:
        own = isolines.parse_levels(scene.luzespecular.display.line_levels)
    except ValueError:
        own = []
    return own or [float(tick) for tick in scale.ticks() if tick > 0.0]


def update(scene: bpy.types.Scene, shown: Iterable[Shown], scale: colours.ColourScale) -> None:
    """Draw the lines anew, or take them away, as the settings say."""
    if not scene.luzespecular.display.show_lines:
        remove(scene)
        return
    chosen = levels(scene, scale)
    carriers = [one for one in shown if _carries_lines(scene, one.object_)]
    parts = [(np.zeros((0, 3, 3)), np.zeros((0, 3))), *(_triangles(one, chosen) for one in carriers)]
    points, values = (np.concatenate(part) for part in zip(*parts, strict=True))
    lines = isolines.trace(points, values, chosen)
    crossed = points[lines.triangles]
    normals = np.cross(crossed[:, 1] - crossed[:, 0], crossed[:, 2] - crossed[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    corners = [one.object_.matrix_world @ Vector(corner) for one in carriers for corner in one.object_.bound_box]
    extent = smoothing.extent(np.array(corners).reshape(-1, 3))
    ends = lines.ends + _LIFT * extent * normals[:, None]
    labels = isolines.label_edges(lines, _LABELS_APART * extent)
    object_ = find(scene) or _new(scene)
    mesh = object_.data
    mesh_arrays.replace_edges(mesh, ends)
    mesh_arrays.write_edge_floats(mesh, VALUE, lines.values)
    mesh_arrays.write_edge_vectors(mesh, NORMAL, normals)
    mesh_arrays.write_edge_floats(mesh, LABEL, np.isin(np.arange(len(ends)), labels))
    mesh.update_tag()


def _carries_lines(scene: bpy.types.Scene, object_: bpy.types.Object) -> bool:
    settings = object_.luzespecular
    if settings.results_side == "back":
        return scene.luzespecular.display.show_backs
    if settings.plane.enabled:
        return not object_.hide_get(view_layer=scene.view_layers[0])
    return not object_.modifiers  # whose faces are elsewhere than those of the mesh


def remove(scene: bpy.types.Scene) -> None:
    """Delete the object of the lines and its mesh."""
    own_objects.remove(scene, (SIDE,))


def _new(scene: bpy.types.Scene) -> bpy.types.Object:
    object_ = own_objects.new(scene, NAME, SIDE, bpy.data.meshes.new(NAME))
    object_.hide_render = True
    own_objects.hide(scene, object_)  # drawn by `overlays`, thicker and on any ground
    return object_


def _triangles(one: Shown, levels_: list[float]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return triangles that levels run through, in world space, (t, 3, 3), and the values at their corners, (t, 3)."""
    mesh = one.mesh
    corners = mesh_arrays.triangle_corners(mesh)
    values = one.corner_values[corners]
    rows = isolines.crossed(values, levels_)
    corners, values = corners[rows], values[rows]
    matrix = np.array(one.object_.matrix_world)
    places = mesh_arrays.vertex_positions(mesh)[mesh_arrays.corner_vertices(mesh)[corners]]
    triangles = places.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        triangles, values = triangles[:, ::-1], values[:, ::-1]
    return triangles, values
