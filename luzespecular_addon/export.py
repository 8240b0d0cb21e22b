"""From Blender to the solver: the evaluated scene as surfaces, one per object and material.

Positions are metres (the scene's unit scale applied) in Blender's axes. Each surface remembers which faces of the user's
own mesh its triangles come from, so that results find their way back.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt_
from numpy.typing import NDArray

from .. import core as luz
from . import face_origins, materials, mesh_arrays, participants
from .notices import Notice, stop_on_errors


_LEAST_AREA = 1e-12
"""Triangles smaller than this share of their surface's largest have no area."""

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
    """

    name: str
    object_name: str
    receiver: bool
    own_faces: NDArray[np.int32] | None


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
        Area of all surfaces that scatter light [m²].
    luminous : bool
        Whether any surface emits light by itself.
    unit_scale : float
        Metres per Blender unit.
    fingerprint : str
        Changes with anything that the solver would see: positions, materials, sides.
    """

    scene: luz.Scene
    surfaces: tuple[ExportedSurface, ...]
    notices: tuple[Notice, ...]
    area: float
    luminous: bool
    unit_scale: float
    fingerprint: str


def export_scene(context: bpy.types.Context, track_faces: bool = True) -> Export:
    """Turn all objects that render into a solver scene.

    Parameters
    ----------
    context : bpy.types.Context
    track_faces : bool
        Follow the user's own faces through the modifiers; without it, results cannot be written back to modified meshes.

    Raises
    ------
    BadInput
        Where something cannot be solved; it names the objects and the remedies. Nothing has been changed then.
    """
    view_layer = context.view_layer
    objects = participants.rendered_objects(view_layer)
    stop_on_errors(_refusals(objects))
    collector = _Collector(unit_scale(context.scene))
    collector.notices += _left_out(objects)
    tracked = _with_modifiers(objects) if track_faces else []
    with participants.shown(view_layer, objects), face_origins.numbered(tracked):
        depsgraph = context.evaluated_depsgraph_get()
        depsgraph.update()
        collector.collect(depsgraph, objects)
    return collector.finish()


def unit_scale(scene: bpy.types.Scene) -> float:
    """Return the metres that one Blender unit stands for."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else float(f"{units.scale_length:.7g}")


def holds_own_results(object_: bpy.types.Object) -> bool:
    """Whether results can be written to the object's own mesh: not where objects share it or a library owns it."""
    mesh = object_.data
    return object_.type == "MESH" and mesh.users - mesh.use_fake_user == 1 and mesh.is_editable


def _with_modifiers(objects: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    return [object_ for object_ in objects if holds_own_results(object_) and object_.modifiers]


def _refusals(objects: list[bpy.types.Object]) -> list[Notice]:
    refused = []
    for object_ in objects:
        if object_.mode == "EDIT":
            text = rpt_("Object '{name}' is in Edit Mode: leave Edit Mode (Tab), then solve")
            refused.append(Notice("ERROR", text.format(name=object_.name)))
    return refused


def _left_out(objects: list[bpy.types.Object]) -> list[Notice]:
    notes = []
    for object_ in objects:
        if object_.type in participants.SURFACELESS_TYPES:
            text = rpt_("Object '{name}' has no mesh data and is left out: convert it to a mesh, or set its role to Ignore")
        elif object_.type == "MESH" and not object_.data.polygons and not object_.modifiers:
            text = rpt_("Object '{name}' has no faces and is left out: give it faces, or set its role to Ignore")
        elif object_.type == "LIGHT":
            text = rpt_("Light '{name}' is left out: the Sun comes from site and time, lamps from luminous materials")
        else:
            continue
        notes.append(Notice("WARNING" if object_.type != "LIGHT" else "INFO", text.format(name=object_.name)))
    return notes


@dataclass
class _Group:
    """All appearances of one mesh that share a surface name and material slots."""

    name: str
    object_name: str
    receiver: bool
    editable: bool
    sides: str
    mesh: mesh_arrays.TriangulatedMesh
    slots: list[bpy.types.Material | None]
    own_faces: NDArray[np.int32] | None
    matrices: list[NDArray[np.float64]] = field(default_factory=list)


class _Collector:
    """Gathers surfaces, notices and the fingerprint of one export."""

    def __init__(self, scale: float):
        self._scale = scale
        self._scene = luz.Scene()
        self._surfaces: list[ExportedSurface] = []
        self._area = 0.0
        self._luminous = False
        self._hash = hashlib.blake2b(digest_size=16)
        self._meshes: dict[int, mesh_arrays.TriangulatedMesh] = {}
        self._optics: dict[str, materials.Optics | None] = {}
        self._names: set[str] = set()
        self._without_material: list[str] = []
        self._sharing: list[str] = []
        self.notices: list[Notice] = []

    def collect(self, depsgraph: bpy.types.Depsgraph, objects: list[bpy.types.Object]) -> None:
        """Read everything while the dependency graph is as it should be; keep no reference to it."""
        for group in self._groups(depsgraph, set(objects)):
            self._add(group)

    def finish(self) -> Export:
        """Return the export, or raise all the errors found."""
        if not self._surfaces and not any(notice.level == "ERROR" for notice in self.notices):
            text = rpt_(
                "There is nothing to light: the scene has no object with faces that renders. "
                "Add one, or enable its render visibility"
            )
            self.notices.append(Notice("ERROR", text))
        self._tell_once(
            self._without_material,
            rpt_("Without material, so a diffuse reflectance of {value:g} is used: {names}"),
            value=materials.REFLECTANCE_WITHOUT_MATERIAL,
        )
        self._tell_once(
            self._sharing,
            rpt_("Instances and objects that share a mesh have results on the fine faces only: {names}"),
        )
        stop_on_errors(self.notices)
        return Export(
            self._scene,
            tuple(self._surfaces),
            tuple(self.notices),
            self._area,
            self._luminous,
            self._scale,
            self._hash.hexdigest(),
        )

    def _tell_once(self, names: list[str], text: str, **values: object) -> None:
        names = list(dict.fromkeys(names))
        if names:
            listed = ", ".join(names[:_NAMES_LISTED]) + (" …" if len(names) > _NAMES_LISTED else "")
            self.notices.append(Notice("INFO", text.format(names=listed, **values)))

    def _groups(self, depsgraph: bpy.types.Depsgraph, allowed: set[bpy.types.Object]) -> Iterator[_Group]:
        groups: dict[tuple, _Group] = {}
        for instance in depsgraph.object_instances:
            # Text, curves and metaballs appear a second time as instances of their mesh: only meshes are read.
            if instance.object.type != "MESH" or not instance.show_self or not len(instance.object.data.polygons):
                continue
            source = instance.object.original
            carrier = instance.parent.original if instance.is_instance else source
            if carrier not in allowed or not _instance_renders(source, carrier):
                continue
            pointer = instance.object.data.as_pointer()
            key = (carrier.as_pointer(), source.as_pointer(), pointer)
            if key not in groups:
                groups[key] = self._group(instance, source, carrier, pointer)
            groups[key].matrices.append(np.array(instance.matrix_world))
        yield from groups.values()

    def _group(self, instance, source: bpy.types.Object, carrier: bpy.types.Object, pointer: int) -> _Group:
        evaluated = instance.object
        if pointer not in self._meshes:
            self._meshes[pointer] = mesh_arrays.read_triangles(evaluated.data)
        mesh = self._meshes[pointer]
        own_faces = None
        if not instance.is_instance and holds_own_results(source):
            own_faces = _own_faces(evaluated.data, source, len(mesh.material_indices))
        elif source.type == "MESH":
            self._sharing.append(carrier.name)
        return _Group(
            name=source.name if carrier == source else f"{carrier.name} > {source.name}",
            object_name=carrier.name,
            receiver=source.luzespecular.role == "RECEIVER" and carrier.luzespecular.role == "RECEIVER",
            editable=source.type == "MESH",
            sides=source.luzespecular.sides,
            mesh=mesh,
            slots=[slot.material for slot in evaluated.material_slots],
            own_faces=own_faces,
        )

    def _add(self, group: _Group) -> None:
        mesh = group.mesh
        if not _finite(mesh, group.matrices):
            text = rpt_(
                "Object '{name}' has vertices or a transform that are not finite numbers (NaN): "
                "mend them, or set its role to Ignore"
            )
            self.notices.append(Notice("ERROR", text.format(name=group.object_name)))
            return
        slots = group.slots or [None]
        # Two slots that hold one material make one surface.
        first_slot = np.array([slots.index(material) for material in slots])
        slot_of_polygon = first_slot[np.clip(mesh.material_indices, 0, len(slots) - 1)]
        slot_of_triangle = slot_of_polygon[mesh.polygons]
        used = np.unique(slot_of_polygon)
        if len(used) == 1:
            self._add_surface(group, group.name, slots[used[0]], mesh.positions, mesh.triangles, mesh.polygons)
            return
        for slot in used:
            material = slots[slot]
            name = f"{group.name}/{material.name if material else rpt_('no material')}"
            chosen = slot_of_triangle == slot
            positions, triangles = _only_used(mesh.positions, mesh.triangles[chosen])
            self._add_surface(group, name, material, positions, triangles, mesh.polygons[chosen])

    def _add_surface(
        self,
        group: _Group,
        name: str,
        material: bpy.types.Material | None,
        positions: NDArray,
        triangles: NDArray,
        polygons: NDArray,
    ) -> None:
        vertices, faces = _placed(positions.astype(float), triangles, group.matrices, self._scale)
        areas = _areas(vertices, faces)
        sound = areas > _LEAST_AREA * areas.max(initial=0.0)
        polygons = np.tile(polygons, len(group.matrices))
        if not sound.all():
            self._tell_flat(group, np.setdiff1d(polygons, polygons[sound]).size, bool(sound.any()))
            faces, areas, polygons = faces[sound], areas[sound], polygons[sound]
        optics = self._material(material, group)
        if optics is None or not len(faces):
            return
        name = self._unique(name)
        two_sided = group.sides == "BOTH" or (group.sides == "AUTO" and not group.mesh.closed)
        solver_material = optics.material()
        try:
            self._scene.add(name, vertices, solver_material, faces=faces, two_sided=two_sided)
        except luz.SceneError as error:
            self.notices.append(Notice("ERROR", str(error)))
            return
        own_faces = None if group.own_faces is None else group.own_faces[polygons]
        self._surfaces.append(ExportedSurface(name, group.object_name, group.receiver, own_faces))
        if optics.diffuse_reflectance > 0.0:
            self._area += float(areas.sum()) * (2.0 if two_sided else 1.0)
        self._luminous |= optics.exitance > 0.0
        for part in (vertices, faces):
            self._hash.update(np.ascontiguousarray(part))
        self._hash.update(f"{name}|{solver_material}|{two_sided}".encode())

    def _tell_flat(self, group: _Group, count: int, some_left: bool) -> None:
        if not some_left:
            text = rpt_(
                "Object '{name}' has no face with an area and is left out: check its scale, or set its role to Ignore"
            )
        elif count and group.editable:
            text = rpt_("Object '{name}': {count} faces without area are left out; Merge by Distance mends it")
        else:  # slivers of polygons that have an area all the same, or of text, which nobody can mend
            return
        self.notices.append(Notice("WARNING", text.format(name=group.object_name, count=count)))

    def _material(self, material: bpy.types.Material | None, group: _Group) -> materials.Optics | None:
        """Return the optics of a material, telling once what is odd about it; None where it cannot be."""
        key = material.name_full if material else ""
        if key not in self._optics:
            optics = materials.read(material)
            notices = materials.notices(material, optics) if material else []
            self.notices += notices
            self._optics[key] = None if any(notice.level == "ERROR" for notice in notices) else optics
        if material is None:
            self._without_material.append(group.object_name)
        optics = self._optics[key]
        if optics is None or optics.refractive_index is None or not group.mesh.closed:
            return optics
        text = rpt_(
            "Object '{name}' is a solid pane: light passes two of its faces, and the glass's mirror reflection is "
            "neglected. Model the pane as single faces for exact results"
        )
        self.notices.append(Notice("WARNING", text.format(name=group.object_name)))
        return optics.shared_by_two_faces()

    def _unique(self, name: str) -> str:
        candidate, number = name, 2
        while candidate in self._names:
            candidate, number = f"{name} ({number})", number + 1
        self._names.add(candidate)
        return candidate


def _instance_renders(source: bpy.types.Object, carrier: bpy.types.Object) -> bool:
    if source == carrier:
        return True
    if not participants.takes_part(source):
        return False
    if carrier.instance_type == "COLLECTION" and carrier.instance_collection is not None:
        return source in participants.instanced_objects(carrier.instance_collection)
    return True


def _own_faces(evaluated: bpy.types.Mesh, source: bpy.types.Object, polygon_count: int) -> NDArray[np.int32] | None:
    if source.modifiers:
        return face_origins.read(evaluated)
    return np.arange(polygon_count, dtype=np.int32) if polygon_count == len(source.data.polygons) else None


def _finite(mesh: mesh_arrays.TriangulatedMesh, matrices: list[NDArray]) -> bool:
    return bool(np.isfinite(mesh.positions).all() and np.isfinite(matrices).all())


def _placed(positions: NDArray, triangles: NDArray, matrices: list[NDArray], scale: float) -> tuple[NDArray, NDArray]:
    """Place a mesh by each matrix; mirrored placements turn their triangles over, so that normals look the same way."""
    transforms = np.array(matrices)
    vertices = positions @ transforms[:, :3, :3].transpose(0, 2, 1) + transforms[:, None, :3, 3]
    faces = triangles + len(positions) * np.arange(len(transforms))[:, None, None]
    mirrored = np.linalg.det(transforms[:, :3, :3]) < 0.0
    faces[mirrored] = faces[mirrored][:, :, ::-1]
    return vertices.reshape(-1, 3) * scale, faces.reshape(-1, 3)


def _only_used(positions: NDArray, triangles: NDArray) -> tuple[NDArray, NDArray]:
    """Leave out the vertices that no triangle uses."""
    used = np.zeros(len(positions), bool)
    used[triangles] = True
    return positions[used], (np.cumsum(used) - 1)[triangles]


def _areas(vertices: NDArray, faces: NDArray) -> NDArray[np.float64]:
    first, second, third = (vertices[faces[:, corner]] for corner in range(3))
    return 0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=1)
