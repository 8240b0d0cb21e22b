"""The objects *LuzEspecular results*: the solver's fine faces with every quantity, fronts and backs apart.

Backs are faces that look back, so that a viewport which culls backfaces shows each side's own light, and an outside
that hides the room can be switched off.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import core as luz
from ..core import tables
from . import mesh_arrays, own_objects, writeback
from .export import Export

NAMES = {"front": "LuzEspecular results", "back": "LuzEspecular results (backs)"}

_THICKNESS = 5e-5
"""How far backs stand behind their fronts, over the extent of all."""

SURFACE = "surface"
"""INT attribute of the FACE domain: the row of the surface in the results table."""


def find(scene: bpy.types.Scene, side: str = "front") -> bpy.types.Object | None:
    """Return the results object of one side, if there is one."""
    return own_objects.find(scene, side)


def all_of(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Return the results objects of a scene."""
    return own_objects.all_of(scene, NAMES)


def write(scene: bpy.types.Scene, export: Export, result: luz.Result) -> None:
    """Write the receivers' faces to the results objects; they neither render nor take part in a run themselves.

    Objects whose faces are the same as before keep them and get new values alone.
    """
    receivers = [surface.name for surface in export.surfaces if surface.receiver]
    parts = list(enumerate(tables.computed_faces(result, receivers)))
    for label in NAMES:
        chosen = [(row, faces) for row, (_, side, _, faces) in parts if side == label]
        object_ = find(scene, label)
        if not chosen:
            own_objects.remove(scene, (label,))
            continue
        faces = np.concatenate([faces for _, faces in chosen])
        corners = result.vertices[faces] / export.unit_scale
        if label == "back":
            corners = _behind(corners)
        positions = corners.reshape(-1, 3).astype(np.float32)
        if object_ is None or not _stands_at(object_.data, positions):
            own_objects.remove(scene, (label,))
            object_ = _new(scene, label, positions)
        for quantity, values in writeback.quantities(result, label).items():
            mesh_arrays.write_face_floats(object_.data, writeback.attribute_of(quantity), values[faces])
        rows = np.repeat([row for row, _ in chosen], [len(faces) for _, faces in chosen])
        mesh_arrays.write_face_integers(object_.data, SURFACE, rows)
        object_.data.update_tag()


def _behind(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return triangles, (n, 3, 3), that look back from just behind, for rays that pass through culled faces."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    extent = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    return corners[:, ::-1] - _THICKNESS * extent * normals[:, None]


def _stands_at(mesh: bpy.types.Mesh, positions: NDArray[np.float32]) -> bool:
    return len(mesh.vertices) == len(positions) and np.array_equal(mesh_arrays.vertex_positions(mesh), positions)


def _new(scene: bpy.types.Scene, label: str, positions: NDArray[np.float32]) -> bpy.types.Object:
    mesh = mesh_arrays.new_triangle_mesh(NAMES[label], positions.reshape(-1, 3, 3))
    object_ = own_objects.new(scene, NAMES[label], label, mesh)
    object_.hide_render = True
    return object_


def remove(scene: bpy.types.Scene) -> None:
    """Delete the results objects of a scene together with their meshes."""
    own_objects.remove(scene, NAMES)
