"""From the solver back to the user's own meshes: lux per face as attributes, and all that is needed to undo it.

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
from ..core import tables
from . import errors, mesh_arrays, participants, placements
from .choices import QUANTITY_ITEMS
from .export import Export, ExportedSurface, mesh_size
from .notices import Notice, about

ILLUMINANCE = "illuminance"
"""FLOAT attribute of the FACE domain: illuminance of the side that the normal looks to [lx]."""

ILLUMINANCE_BACK = "illuminance_back"
"""The same of the other side, on meshes whose faces are lit on both sides."""

SHOWN = "luzespecular_value"
"""FLOAT attribute of the CORNER domain: the value that is shown, in the unit of the legend."""

COLOURS = "luzespecular"
"""FLOAT_COLOR attribute of the CORNER domain, scene-linear false colours."""


def attribute_of(quantity: str) -> str:
    """Return the name of the FLOAT attribute of the FACE domain that holds a quantity [lx]."""
    return ILLUMINANCE if quantity == ILLUMINANCE else f"{ILLUMINANCE}_{quantity}"


ATTRIBUTES = (*(attribute_of(quantity) for quantity, _, _ in QUANTITY_ITEMS), ILLUMINANCE_BACK, SHOWN, COLOURS)
"""Names of all that is written to a user's mesh."""


@dataclass(frozen=True)
class OwnResults:
    """Results of the faces of one user mesh.

    Attributes
    ----------
    object_name : str
    values : dict of str to (p,) float64
        By attribute [lx], NaN where nothing was computed.
    """

    object_name: str
    values: dict[str, NDArray[np.float64]]


def refusals(objects: Iterable[bpy.types.Object]) -> list[Notice]:
    """Return an error for each mesh that results cannot be written to.

    It holds an attribute of ours by name that we did not write, or it is a work plane's and not its alone.
    """
    notices = []
    for object_ in objects:
        mesh = object_.data
        is_plane = object_.luzespecular.plane.enabled
        if object_.type != "MESH" or not (is_plane or participants.takes_part(object_)):
            continue
        if is_plane and not placements.holds_own_results(object_):
            text = rpt_("Work plane '{name}' shares its mesh or is linked: use Object > Relations > Make Single User")
            notices.append(about(object_.name, "ERROR", text))
        if holds_results(mesh):
            continue
        for name in ATTRIBUTES:
            if name in mesh.attributes:
                text = rpt_("Object '{name}' has an attribute '{attribute}' that results would overwrite: rename it")
                notices.append(about(object_.name, "ERROR", text, attribute=name))
    return notices


def own_results(export: Export, result: luz.Result) -> list[OwnResults]:
    """Return the results of each user mesh that can hold them: means over all that became of a face.

    Objects that are gone or renamed, and meshes that have other faces by now, get none.
    """
    by_object: dict[str, list[ExportedSurface]] = {}
    for surface in export.surfaces:
        as_it_was = surface.own_faces is not None and mesh_size(surface.object_name) == surface.own_count
        if surface.receiver and as_it_was:
            by_object.setdefault(surface.object_name, []).append(surface)
    fronts = {attribute_of(name): values for name, values in quantities(result, "front").items()}
    backs = {} if result.back is None else {ILLUMINANCE_BACK: result.back.illuminance}
    results = []
    for name, surfaces in by_object.items():
        count = surfaces[0].own_count
        values = _means(surfaces, result, fronts, count)
        # Backs that nobody lit are no results.
        values |= {
            key: means for key, means in _means(surfaces, result, backs, count).items() if np.isfinite(means).any()
        }
        results.append(OwnResults(name, values))
    return results


def quantities(result: luz.Result, side: str) -> dict[str, NDArray[np.float64]]:
    """Return all quantities of one side of the faces by name, (n,) [lx] each; errors of fronts, once they are known."""
    if side == "back":
        return tables.quantities(result.back)
    error = errors.known(result)
    return tables.quantities(result.front) | ({} if error is None else {"error": error})


def _means(
    surfaces: list[ExportedSurface], result: luz.Result, quantities_: dict[str, NDArray], count: int
) -> dict[str, NDArray[np.float64]]:
    """Area-weighted means over the solver's faces that come from each of `count` faces; NaN where there are none."""
    if not quantities_:
        return {}
    faces = np.concatenate([result.faces_of(surface.name) for surface in surfaces])
    own = np.concatenate(
        [surface.own_faces[result.source_faces[result.faces_of(surface.name)]] for surface in surfaces]
    )
    known = (own >= 0) & ~np.isnan(next(iter(quantities_.values()))[faces])
    own, faces = own[known], faces[known]
    weights = result.areas[faces]
    area = np.bincount(own, weights, minlength=count)
    scale = np.divide(1.0, area, out=np.full(count, np.nan), where=area > 0.0)
    return {
        name: scale * np.bincount(own, weights * values[faces], minlength=count) for name, values in quantities_.items()
    }


def write(results: OwnResults) -> None:
    """Write the results to the object's mesh and remember what was active on it before."""
    mesh = bpy.data.objects[results.object_name].data
    begin(mesh)
    for name in ATTRIBUTES:
        if name in results.values:
            mesh_arrays.write_face_floats(mesh, name, results.values[name])
        elif name not in (SHOWN, COLOURS):
            mesh_arrays.remove_attribute(mesh, name)


def begin(mesh: bpy.types.Mesh) -> None:
    """Mark a mesh as one that holds results, and remember what is active on it; once, until `clear`."""
    if holds_results(mesh):
        return
    settings, before = mesh.luzespecular, mesh_arrays.active_names(mesh)
    settings.active_attribute_before = before.attribute
    settings.active_colour_before = before.colour
    settings.render_colour_before = before.render_colour
    settings.has_results = True


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
    for name in ATTRIBUTES:
        mesh_arrays.remove_attribute(mesh, name)
    mesh_arrays.restore_active(mesh, before)
    mesh.property_unset("luzespecular")
    mesh.update_tag()
