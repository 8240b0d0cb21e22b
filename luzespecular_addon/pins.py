"""Points whose value stays shown: which face each stands on now, whatever was solved or shown since."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import bpy
import numpy as np

from . import mesh_arrays

if TYPE_CHECKING:
    from .display import Shown

_ALIKE = 0.7
"""Least cosine between a pin's normal and that of the face it stands on."""

_OFF_PLANE = 100.0
"""How much more distance from a face's plane counts than distance within it."""


def attach(scene: bpy.types.Scene, shown: Sequence[Shown]) -> None:
    """Put each pin on the face that is now where it was set."""
    pins = scene.luzespecular.results.pins
    if not len(pins):
        return
    names, faces, centres, normals, areas = [], [], [], [], []
    for one in shown:
        mesh, matrix = one.mesh, np.array(one.object_.matrix_world)
        count = len(mesh.polygons)
        names += [one.object_.name] * count
        faces.append(np.arange(count))
        centres.append(mesh_arrays.polygon_centres(mesh) @ matrix[:3, :3].T + matrix[:3, 3])
        normals.append(mesh_arrays.polygon_normals(mesh) @ np.linalg.pinv(matrix[:3, :3]))
        areas.append(mesh_arrays.polygon_areas(mesh))
    faces, areas = np.concatenate(faces), np.concatenate(areas)
    centres, normals = np.concatenate(centres), np.concatenate(normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    for pin in pins:
        offset = np.array(pin.place) - centres
        height = np.einsum("fc,fc->f", offset, normals)
        distance = np.einsum("fc,fc->f", offset, offset) + _OFF_PLANE * height**2
        score = distance / np.maximum(areas, 1e-300)
        score[normals @ np.array(pin.normal) < _ALIKE] = np.inf
        if len(score) and np.isfinite(score.min()):
            best = int(score.argmin())
            pin.name, pin.face = names[best], int(faces[best])
