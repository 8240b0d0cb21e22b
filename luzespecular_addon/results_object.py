"""The objects *LuzEspecular results*: the solver's fine faces with every quantity, fronts and backs apart.

Backs are faces that look back, so that a viewport which culls backfaces shows each side's own light, and an outside
that hides the room can be switched off.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import core as luz
from ..core import tables
from . import mesh_arrays
from .export import Export

NAMES = {"front": "LuzEspecular results", "back": "LuzEspecular results (backs)"}

SURFACE = "surface"
"""INT attribute of the FACE domain: the row of the surface in the results table."""


def find(scene: bpy.types.Scene, side: str = "front") -> bpy.types.Object | None:
    """Return the results object of one side, if there is one."""
    return next((object_ for object_ in all_of(scene) if object_.luzespecular.results_side == side), None)


def all_of(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Return the results objects of a scene."""
    return [object_ for object_ in scene.objects if object_.luzespecular.is_results]


def create(scene: bpy.types.Scene, export: Export, result: luz.Result) -> None:
    """Make the results objects from the receivers' faces; they neither render nor take part in a run themselves."""
    remove(scene)
    receivers = [surface.name for surface in export.surfaces if surface.receiver]
    parts = list(enumerate(tables.computed_faces(result, receivers)))
    for label, name in NAMES.items():
        chosen = [(row, side, faces) for row, (_, side_label, side, faces) in parts if side_label == label]
        if not chosen:
            continue
        corners = result.vertices[np.concatenate([faces for _, _, faces in chosen])] / export.unit_scale
        mesh = mesh_arrays.new_triangle_mesh(name, corners if label == "front" else corners[:, ::-1])
        for quantity in tables.quantities(result.front):
            values = [tables.quantities(side)[quantity][faces] for _, side, faces in chosen]
            mesh_arrays.write_face_floats(mesh, quantity, np.concatenate(values))
        rows, counts = [row for row, _, _ in chosen], [len(faces) for _, _, faces in chosen]
        mesh_arrays.write_face_integers(mesh, SURFACE, np.repeat(rows, counts))
        object_ = bpy.data.objects.new(name, mesh)
        object_.luzespecular.is_results, object_.luzespecular.results_side = True, label
        object_.hide_render = True
        scene.collection.objects.link(object_)


def remove(scene: bpy.types.Scene) -> None:
    """Delete the results objects of a scene together with their meshes."""
    for object_ in all_of(scene):
        mesh = object_.data
        bpy.data.objects.remove(object_)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)
