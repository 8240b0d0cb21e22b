"""From Blender to the solver: parts become surfaces, and whatever stands in the way is told before work starts.

Each surface remembers which faces of the user's own mesh its triangles come from, so that results find their way back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt_
from numpy.typing import NDArray

from .. import core as luz
from . import materials, participants, placements
from .notices import Notice, about, stop_on_errors
from .translations import solver_message

_LEAST_AREA = 1e-12
"""Triangles smaller than this share of their part's largest have no area."""

_NAMES_LISTED = 6


@dataclass(frozen=True)
class ExportedSurface:
    """What became one surface of the solver's scene.

    Attributes
    ----------
    name : str
        The surface's name in the solver's scene.
    object_name : str
        The object that stands for it in the viewport: itself, or the object that makes the instances.
    receiver : bool
        Whether results are wanted.
    own_faces : (t,) int32 or None
        Face of the object's own mesh for each triangle handed over, -1 where there is none; None where the mesh cannot
        hold results of its own.
    own_count : int
        Faces of that mesh.
    """

    name: str
    object_name: str
    receiver: bool
    own_faces: NDArray[np.int32] | None
    own_count: int = 0


@dataclass(frozen=True)
class Export:
    """A Blender scene as the solver sees it.

    Attributes
    ----------
    scene : luz.Scene
        Surfaces, in metres.
    surfaces : tuple of ExportedSurface
        In the order of the solver's scene.
    notices : tuple of Notice
        Warnings and notes; errors have been raised.
    area : float
        Area of all surfaces that scatter light, one side of each [m²].
    luminous : bool
        Whether any surface emits light by itself.
    unit_scale : float
        Metres per Blender unit.
    fingerprint : str
        `placements.fingerprint` of the scene.
    moving : tuple of str
        Objects that keyframes move or change.
    frame : int
        The frame that the scene was read at.
    """

    scene: luz.Scene
    surfaces: tuple[ExportedSurface, ...]
    notices: tuple[Notice, ...]
    area: float
    luminous: bool
    unit_scale: float
    fingerprint: str
    moving: tuple[str, ...]
    frame: int


def export_scene(context: bpy.types.Context) -> Export:
    """Turn all objects that render into a solver scene.

    Raises
    ------
    BadInput
        Where something cannot be solved; it names the objects and the remedies. Nothing has been changed then.
    """
    objects = participants.rendered_objects(context.view_layer)
    stop_on_errors(_in_edit_mode(objects))
    parts = placements.collect(context, objects)
    builder = _Builder()
    for part in parts:
        builder.add(part)
    moving = tuple(object_.name for object_ in objects if object_.type in participants.MESH_TYPES and _moves(object_))
    notices = [*_left_out(objects, context.scene.luzespecular.site), *builder.notices()]
    if moving:
        text = rpt_("Keyframes move or change {names}: the results are those of frame {frame}")
        notices.append(Notice("INFO", text.format(names=_listed(moving), frame=context.scene.frame_current), moving))
    stop_on_errors(notices)
    return Export(
        builder.scene,
        tuple(builder.surfaces),
        tuple(notices),
        builder.area,
        builder.luminous,
        placements.unit_scale(context.scene),
        placements.fingerprint(parts),
        moving,
        context.scene.frame_current,
    )


def current_fingerprint(context: bpy.types.Context) -> str:
    """Return the fingerprint of the scene as it is now."""
    objects = participants.rendered_objects(context.view_layer)
    return placements.fingerprint(placements.collect(context, objects, track_faces=False))


def _moves(object_: bpy.types.Object | None) -> bool:
    """Whether keyframes move an object or one of its parents, or change its shape."""
    if object_ is None:
        return False
    owners = (object_, object_.data, getattr(object_.data, "shape_keys", None))
    animated = (getattr(owner, "animation_data", None) for owner in owners)
    return any(one is not None and (one.action or len(one.nla_tracks)) for one in animated) or _moves(object_.parent)


def _in_edit_mode(objects: list[bpy.types.Object]) -> list[Notice]:
    text = rpt_("Object '{name}' is in Edit Mode: leave Edit Mode (Tab), then solve")
    return [about(object_.name, "ERROR", text) for object_ in objects if object_.mode == "EDIT"]


def _left_out(objects: list[bpy.types.Object], site: bpy.types.PropertyGroup) -> list[Notice]:
    notices = []
    for object_ in objects:
        if object_.type in participants.SURFACELESS_TYPES:
            text = rpt_(
                "Object '{name}' has no mesh data and is left out: convert it to a mesh, or set its role to Ignore"
            )
        elif object_.type == "MESH" and not object_.data.polygons and not object_.modifiers:
            text = rpt_("Object '{name}' has no faces and is left out: give it faces, or set its role to Ignore")
        elif object_.type == "LIGHT" and not (site.sun_link != "NONE" and object_ == site.sun_object):
            text = rpt_("Light '{name}' is left out: the Sun comes from site and time, lamps from luminous materials")
        else:
            continue
        notices.append(about(object_.name, "INFO" if object_.type == "LIGHT" else "WARNING", text))
    return notices


class _Builder:
    """Builds the solver's scene part by part and gathers what is to be told."""

    def __init__(self):
        self.scene = luz.Scene()
        self.surfaces: list[ExportedSurface] = []
        self.area = 0.0
        self.luminous = False
        self._notices: list[Notice] = []
        self._optics: dict[bpy.types.Material | None, materials.Optics | None] = {}
        self._of_materials: list[tuple[bpy.types.Material, Notice]] = []
        self._users: dict[bpy.types.Material | None, list[str]] = {}
        self._sharing: list[str] = []

    def add(self, part: placements.Part) -> None:
        """Add a part; where it cannot be, note why."""
        if not np.isfinite(part.vertices).all():
            text = rpt_(
                "Object '{name}' has vertices or a transform that are not finite numbers (NaN): "
                "mend them, or set its role to Ignore"
            )
            self._notices.append(about(part.object_name, "ERROR", text))
            return
        areas = _areas(part.vertices, part.faces)
        sound = areas > _LEAST_AREA * areas.max(initial=0.0)
        if not sound.all():
            self._tell_flat(part, sound)
        optics = self._part_optics(part)
        if optics is None or not sound.any():
            return
        try:
            material = optics.material()
            self.scene.add(part.name, part.vertices, material, faces=part.faces[sound], two_sided=part.two_sided)
        except luz.SceneError as error:
            self._notices.append(Notice("ERROR", solver_message(error), (part.object_name,)))
            return
        own_faces, own_count = None, 0
        if part.own_faces is not None:
            own_faces, own_count = part.own_faces[part.polygons[sound]], mesh_size(part.object_name)
        self.surfaces.append(ExportedSurface(part.name, part.object_name, part.receiver, own_faces, own_count))
        if part.receiver and own_faces is None and part.kind == "MESH":
            self._sharing.append(part.object_name)
        if optics.diffuse_reflectance > 0.0:
            self.area += float(areas[sound].sum())
        self.luminous |= optics.exitance > 0.0

    def notices(self) -> list[Notice]:
        """Return all that is to be told, the same thing about many objects in one."""
        of_materials = [
            replace(notice, objects=tuple(dict.fromkeys(self._users[material])))
            for material, notice in self._of_materials
        ]
        notices = [*of_materials, *dict.fromkeys(self._notices)]
        if not self.surfaces and not any(notice.level == "ERROR" for notice in notices):
            text = rpt_(
                "There is nothing to light: the scene has no object with faces that renders. "
                "Add one, or enable its render visibility"
            )
            notices.append(Notice("ERROR", text))
        for names, text in (
            (
                self._users.get(None, []),
                rpt_("Without material, so a diffuse reflectance of {value:g} is used: {names}"),
            ),
            (
                self._sharing,
                rpt_("Instances and objects that share a mesh have results on the fine faces only: {names}"),
            ),
        ):
            if names:
                value = materials.REFLECTANCE_WITHOUT_MATERIAL
                names = list(dict.fromkeys(names))
                notices.append(Notice("INFO", text.format(names=_listed(names), value=value), tuple(names)))
        return notices

    def _tell_flat(self, part: placements.Part, sound: NDArray[np.bool_]) -> None:
        if not sound.any():
            text = rpt_(
                "Object '{name}' has no face with an area and is left out: check its scale, or set its role to Ignore"
            )
            self._notices.append(about(part.object_name, "WARNING", text))
            return
        # A polygon may have slivers and an area all the same; what text and curves bring along, nobody can mend.
        count = np.setdiff1d(part.polygons, part.polygons[sound]).size
        if count and part.kind == "MESH":
            text = rpt_("Object '{name}': {count} faces without area are left out; Merge by Distance mends it")
            self._notices.append(about(part.object_name, "WARNING", text, count=count))

    def _part_optics(self, part: placements.Part) -> materials.Optics | None:
        """Return the optics of a part, noting once what is odd about its material; None where it cannot be."""
        material = part.material
        if material not in self._optics:
            optics = materials.read(material)
            notices = materials.notices(material, optics) if material else []
            self._of_materials += [(material, notice) for notice in notices]
            self._optics[material] = None if any(notice.level == "ERROR" for notice in notices) else optics
        self._users.setdefault(material, []).append(part.object_name)
        optics = self._optics[material]
        if optics is None or optics.refractive_index is None or not part.closed:
            return optics
        text = rpt_(
            "Object '{name}' is a solid pane: light passes two of its faces, and the glass's mirror reflection is "
            "neglected. Model the pane as single faces for exact results"
        )
        self._notices.append(about(part.object_name, "WARNING", text))
        return optics.shared_by_two_faces()


def mesh_size(object_name: str) -> int:
    """Return the number of faces of an object's own mesh; 0 where it has none, or is gone."""
    object_ = bpy.data.objects.get(object_name)
    return len(object_.data.polygons) if object_ is not None and object_.type == "MESH" else 0


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:_NAMES_LISTED]) + (" …" if len(names) > _NAMES_LISTED else "")


def _areas(vertices: NDArray, faces: NDArray) -> NDArray[np.float64]:
    """Return the area of triangles; written out, since `np.cross` takes several times as long on many."""
    first, second, third = (vertices[faces[:, corner]] for corner in range(3))
    ax, ay, az = (second - first).T
    bx, by, bz = (third - first).T
    return 0.5 * np.sqrt((ay * bz - az * by) ** 2 + (az * bx - ax * bz) ** 2 + (ax * by - ay * bx) ** 2)
