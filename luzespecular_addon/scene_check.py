"""The scene check: what the extension and the solver find odd, and where in the user's own objects it is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.app.translations import pgettext_iface as iface_
from numpy.typing import NDArray

from .. import core as luz
from . import mesh_arrays, session
from .export import Export
from .notices import Level, Notice
from .translations import solver_message

_ORDER = {"ERROR": 0, "WARNING": 1, "INFO": 2}


@dataclass(frozen=True)
class Place:
    """Faces of one object.

    Attributes
    ----------
    object_name : str
    faces : (k,) int or None
        Of the object's own mesh; None where the whole object is meant, or its faces cannot be told.
    count : int
        Faces that the mesh had when they were found.
    """

    object_name: str
    faces: NDArray[np.int32] | None = field(default=None, compare=False)
    count: int = 0


@dataclass(frozen=True)
class Found:
    """One thing that is odd.

    Attributes
    ----------
    level : "ERROR", "WARNING" or "INFO"
        An error stops a solve.
    kind : str
        What sort of thing it is, in a word or two; empty where the text is short enough.
    name : str
        Surface or object; empty where the whole scene is meant.
    text, remedy : str
        For people; the remedy is empty where the text holds it.
    places : tuple of Place
    """

    level: Level
    kind: str
    name: str
    text: str
    remedy: str
    places: tuple[Place, ...]


def of_notices(notices: Iterable[Notice]) -> list[Found]:
    """Return what was remarked while the scene was read."""
    return [
        Found(notice.level, "", next(iter(notice.objects), ""), notice.text, "", tuple(map(Place, notice.objects)))
        for notice in notices
    ]


def of_solver(exported: Export, findings: Iterable[luz.Finding]) -> list[Found]:
    """Return the solver's findings about a scene in the language of the interface."""
    surfaces = {surface.name: surface for surface in exported.surfaces}
    found = []
    for finding in findings:
        concerned = {finding.surface: finding.faces, **finding.others} if finding.surface else {}
        own: dict[str, list[NDArray | None]] = {}
        for name, faces in concerned.items():
            surface = surfaces[name]
            known = surface.own_faces is not None
            own.setdefault(surface.object_name, []).append(surface.own_faces[faces] if known else None)
        places = tuple(_place(name, parts) for name, parts in own.items())
        text, remedy = solver_message(finding.message), solver_message(finding.remedy)
        found.append(Found(finding.severity.upper(), iface_(finding.kind), finding.surface, text, remedy, places))
    return found


def _place(object_name: str, parts: list[NDArray | None]) -> Place:
    """Join faces of the parts of one object; all of its faces are the object as a whole."""
    mesh = bpy.data.objects[object_name].data
    if any(part is None for part in parts):
        return Place(object_name)
    faces = np.unique(np.concatenate(parts))
    faces = faces[faces >= 0]
    whole = not len(faces) or len(faces) == len(mesh.polygons)
    return Place(object_name, None if whole else faces, len(mesh.polygons))


def show(manager: bpy.types.WindowManager, found: Iterable[Found]) -> None:
    """List findings in the panel, errors first, in place of those before."""
    state, found = manager.luzespecular, sorted(found, key=lambda one: _ORDER[one.level])
    state.checked, state.active_finding = True, 0
    state.findings.clear()
    for one in found:
        entry = state.findings.add()
        for name in ("level", "kind", "name", "text", "remedy"):
            setattr(entry, name, getattr(one, name))
    session.current.places = [one.places for one in found]


def clear(manager: bpy.types.WindowManager) -> None:
    """Empty the list: nothing has been checked."""
    state = manager.luzespecular
    for name in ("findings", "checked", "active_finding"):
        state.property_unset(name)
    session.current.places = []


def places_of(manager: bpy.types.WindowManager, index: int) -> tuple[Place, ...]:
    """Return the places of a finding in the panel; none for those of the whole scene, or of another file."""
    places = session.current.places
    return places[index] if 0 <= index < len(places) == len(manager.luzespecular.findings) else ()


def select(context: bpy.types.Context, places: Iterable[Place]) -> list[str]:
    """Select objects and, where single faces are meant, these in Edit Mode; return the objects that could not be.

    Objects that are hidden are shown; where results stand for them, these are shown on the own meshes instead.
    """
    scene, layer = context.scene, context.view_layer
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for object_ in context.selected_objects:
        object_.select_set(False)
    objects = {place: layer.objects.get(place.object_name) for place in places}
    if any(object_ is not None and object_.luzespecular.hidden_for_results for object_ in objects.values()):
        scene.luzespecular.display.view = "OWN"
    chosen = {place: object_ for place, object_ in objects.items() if object_ is not None and _shown(object_, layer)}
    for object_ in chosen.values():
        object_.select_set(True)
        layer.objects.active = object_
    single = [object_ for place, object_ in chosen.items() if _has_faces_of(place, object_)]
    if single:
        layer.objects.active = single[0]
        for place, object_ in chosen.items():
            if object_.type == "MESH":
                everything = np.arange(len(object_.data.polygons))
                mesh_arrays.select_faces(object_.data, place.faces if object_ in single else everything)
        context.tool_settings.mesh_select_mode = (False, False, True)
        bpy.ops.object.mode_set(mode="EDIT")
    return [place.object_name for place in objects if place not in chosen]


def _has_faces_of(place: Place, object_: bpy.types.Object) -> bool:
    """Whether single faces are meant that can still be told, and selected in Edit Mode."""
    editable = object_.is_editable and object_.data.is_editable
    return place.faces is not None and editable and len(object_.data.polygons) == place.count


def _shown(object_: bpy.types.Object, layer: bpy.types.ViewLayer) -> bool:
    """Show an object that its eye hides; whether it is seen then and can be selected."""
    if object_.hide_get(view_layer=layer):
        object_.hide_set(False, view_layer=layer)
    return object_.visible_get(view_layer=layer) and not object_.hide_select
