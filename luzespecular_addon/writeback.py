"""From the solver back to the user's own meshes: lux per face as an attribute, and all that is needed to undo it.

A face of the user's mesh gets the area-weighted mean of all solver faces that come from it, whether the modifiers cut
it, copied it or left it alone. Faces without a value hold NaN. A mesh that several objects share cannot hold several
results: those objects have theirs on the fine faces only.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt_
from numpy.typing import NDArray

from .. import core as luz
from ..core.result import Side
from . import mesh_arrays, participants
from .export import Export, ExportedSurface
from .notices import Notice

ILLUMINANCE = "illuminance"
"""FLOAT attribute of the FACE domain: illuminance of the side that the normal looks to [lx]."""

ILLUMINANCE_BACK = "illuminance_back"
"""The same of the other side, on meshes whose faces are lit on both sides."""

COLOURS = "luzespecular"
"""FLOAT_COLOR attribute of the CORNER domain, scene-linear false colours."""

_NAMES = (ILLUMINANCE, ILLUMINANCE_BACK, COLOURS)


@dataclass(frozen=True)
class OwnResults:
    """Illuminance of the faces of one user mesh.

    Attributes
    ----------
    object_name : str
    illuminance : (p,) float64
        [lx], NaN where nothing was computed.
    illuminance_back : (p,) float64 or None
        The same of the backs; None where no back was computed.
    """

    object_name: str
    illuminance: NDArray[np.float64]
    illuminance_back: NDArray[np.float64] | None


def refusals(objects: Iterable[bpy.types.Object]) -> list[Notice]:
    """Return an error for each mesh that holds an attribute of ours by name that we did not write."""
    notices = []
    for object_ in objects:
        mesh = object_.data
        if object_.type != "MESH" or holds_results(mesh) or not participants.takes_part(object_):
            continue
        for name in _NAMES:
            if name in mesh.attributes:
                text = rpt_("Object '{name}' has an attribute '{attribute}' that results would overwrite: rename it")
                notices.append(Notice("ERROR", text.format(name=object_.name, attribute=name)))
    return notices


def own_results(export: Export, result: luz.Result) -> list[OwnResults]:
    """Return the illuminance of each user mesh that can hold results: means over all that became of a face."""
    by_object: dict[str, list[ExportedSurface]] = {}
    for surface in export.surfaces:
        if surface.receiver and surface.own_faces is not None:
            by_object.setdefault(surface.object_name, []).append(surface)
    results = []
    for name, surfaces in by_object.items():
        count = len(bpy.data.objects[name].data.polygons)
        front = _means(surfaces, result, result.front, count)
        back = None if result.back is None else _means(surfaces, result, result.back, count)
        results.append(OwnResults(name, front, None if back is None or np.isnan(back).all() else back))
    return results


def _means(surfaces: list[ExportedSurface], result: luz.Result, side: Side, count: int) -> NDArray[np.float64]:
    lumens, area = np.zeros(count), np.zeros(count)
    for surface in surfaces:
        faces = result.faces_of(surface.name)
        own = surface.own_faces[result.source_faces[faces]]
        values, weights = side.illuminance[faces], side.areas[faces]
        known = (own >= 0) & ~np.isnan(values)
        own, values, weights = own[known], values[known], weights[known]
        lumens += np.bincount(own, weights * values, minlength=count)
        area += np.bincount(own, weights, minlength=count)
    return np.divide(lumens, area, out=np.full(count, np.nan), where=area > 0.0)


def write(results: OwnResults) -> None:
    """Write the illuminance to the object's mesh and remember what was active on it before."""
    mesh = bpy.data.objects[results.object_name].data
    settings = mesh.luzespecular
    if not holds_results(mesh):
        before = mesh_arrays.active_names(mesh)
        settings.active_attribute_before = before.attribute
        settings.active_colour_before = before.colour
        settings.render_colour_before = before.render_colour
        settings.has_results = True
    mesh_arrays.write_face_floats(mesh, ILLUMINANCE, results.illuminance)
    if results.illuminance_back is None:
        mesh_arrays.remove_attribute(mesh, ILLUMINANCE_BACK)
    else:
        mesh_arrays.write_face_floats(mesh, ILLUMINANCE_BACK, results.illuminance_back)


def written_meshes(scene: bpy.types.Scene) -> list[bpy.types.Mesh]:
    """Return the user meshes of a scene that hold results."""
    meshes = {object_.data: None for object_ in scene.objects if object_.type == "MESH"}
    return [mesh for mesh in meshes if holds_results(mesh)]


def holds_results(mesh: bpy.types.Mesh) -> bool:
    """Whether we wrote to a mesh; asked so that Blender 4 does not make an empty group of settings by the asking."""
    return mesh.is_property_set("luzespecular") and mesh.luzespecular.has_results


def clear(mesh: bpy.types.Mesh) -> None:
    """Take the results off a mesh; it is then as it was before the first run."""
    settings = mesh.luzespecular
    before = mesh_arrays.ActiveNames(
        settings.active_attribute_before, settings.active_colour_before, settings.render_colour_before
    )
    for name in _NAMES:
        mesh_arrays.remove_attribute(mesh, name)
    mesh_arrays.restore_active(mesh, before)
    mesh.property_unset("luzespecular")
    mesh.update_tag()
