"""From a face after the modifiers back to the face of the user's own mesh.

A whole-number attribute on the faces survives most modifiers (Remesh drops it; faces that a Boolean brings in carry 0),
so each face is numbered for the time of the export and the numbers are taken away again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from numpy.typing import NDArray

from . import mesh_arrays

_ATTRIBUTE = "luzespecular_face"


@contextmanager
def numbered(objects: Iterable[bpy.types.Object]) -> Iterator[None]:
    """Number the faces of the objects' meshes, from 1, while the context lasts; the meshes are as before after it."""
    marked: list[tuple[bpy.types.Mesh, mesh_arrays.ActiveNames]] = []
    try:
        for mesh in {object_.data for object_ in objects}:
            marked.append((mesh, mesh_arrays.active_names(mesh)))
            mesh_arrays.write_face_integers(mesh, _ATTRIBUTE, np.arange(1, len(mesh.polygons) + 1))
        yield
    finally:
        for mesh, active in marked:
            mesh_arrays.remove_attribute(mesh, _ATTRIBUTE)
            mesh_arrays.restore_active(mesh, active)


def read(evaluated_mesh: bpy.types.Mesh) -> NDArray[np.int32] | None:
    """Return the original face of each face, (p,) int32, -1 where there is none; None if the numbers were lost."""
    numbers = mesh_arrays.read_face_values(evaluated_mesh, _ATTRIBUTE, np.int32)
    return None if numbers is None else numbers - np.int32(1)
