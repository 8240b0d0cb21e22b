"""The object *LuzEspecular results*: the solver's fine faces with every quantity; backs are faces that look back."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import core as luz
from . import mesh_arrays, tables
from .export import Export

NAME = "LuzEspecular results"

SURFACE = "surface"
"""INT attribute of the FACE domain: the row of the surface in the results table."""


def find(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """Return the results object of a scene, if there is one."""
    return next((object_ for object_ in scene.objects if object_.luzespecular.is_results), None)


def create(scene: bpy.types.Scene, export: Export, result: luz.Result) -> bpy.types.Object:
    """Make the results object from the receivers' faces; it does not render and never takes part in a run itself."""
    remove(scene)
    parts = list(tables.computed_faces(result, [surface.name for surface in export.surfaces if surface.receiver]))
    corners = [_looking_at(label, result.vertices[faces]) for _, label, _, faces in parts]
    mesh = mesh_arrays.new_triangle_mesh(NAME, np.concatenate([np.empty((0, 3, 3)), *corners]) / export.unit_scale)
    for quantity in tables.quantities(result.front):
        values = [tables.quantities(side)[quantity][faces] for _, _, side, faces in parts]
        mesh_arrays.write_face_floats(mesh, quantity, np.concatenate([np.empty(0), *values]))
    row_of_face = np.repeat(np.arange(len(parts)), [len(faces) for _, _, _, faces in parts])
    mesh_arrays.write_face_integers(mesh, SURFACE, row_of_face)
    object_ = bpy.data.objects.new(NAME, mesh)
    object_.luzespecular.is_results = True
    object_.hide_render = True
    scene.collection.objects.link(object_)
    return object_


def remove(scene: bpy.types.Scene) -> None:
    """Delete the results object of a scene together with its mesh."""
    object_ = find(scene)
    while object_ is not None:
        mesh = object_.data
        bpy.data.objects.remove(object_)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)
        object_ = find(scene)


def _looking_at(side: str, corners: NDArray) -> NDArray:
    """Return triangles (k, 3, 3) whose normals look to a side of the surface."""
    return corners if side == "front" else corners[:, ::-1]
