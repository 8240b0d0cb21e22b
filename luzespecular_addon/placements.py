"""The evaluated scene as plain arrays: what stands where, in metres, one part per object and material.

Modifiers, instances, transforms (mirrored ones too) and the scene's unit scale are applied; nothing is judged here.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt_
from numpy.typing import NDArray

from . import face_origins, materials, mesh_arrays, participants


@dataclass(frozen=True)
class Part:
    """All triangles of one material of one object, or of all its instances of another object.

    Attributes
    ----------
    name : str
        Unique and readable: ``Object``, ``Object/Material``, ``Instancer > Object``.
    object_name : str
        The object that stands for it in the viewport: itself, or the one that makes the instances.
    material : bpy.types.Material or None
        The original material.
    vertices : (v, 3) float64
        [m]
    faces : (t, 3) int
        Triangles, right-handed about the normals that Blender shows.
    polygons : (t,) int32
        Polygon of the evaluated mesh that each triangle was cut from.
    own_faces : (p,) int32 or None
        For each polygon of the evaluated mesh the face of the object's own mesh, -1 where there is none; None where
        that mesh cannot hold results.
    receiver : bool
        Whether results are wanted.
    two_sided : bool
        Whether the backs are lit as well.
    closed : bool
        Whether the mesh encloses a volume.
    kind : str
        Type of the original object.
    """

    name: str
    object_name: str
    material: bpy.types.Material | None
    vertices: NDArray[np.float64]
    faces: NDArray[np.integer]
    polygons: NDArray[np.int32]
    own_faces: NDArray[np.int32] | None
    receiver: bool
    two_sided: bool
    closed: bool
    kind: str


def collect(context: bpy.types.Context, objects: list[bpy.types.Object], track_faces: bool = True) -> list[Part]:
    """Read the parts of all given objects and of what they instance.

    Parameters
    ----------
    context : bpy.types.Context
    objects : list of bpy.types.Object
        Objects of the context's view layer; those that the viewport hides are shown meanwhile.
    track_faces : bool
        Follow the user's own faces through the modifiers.
    """
    tracked = (
        [object_ for object_ in objects if object_.modifiers and holds_own_results(object_)] if track_faces else []
    )
    scale = unit_scale(context.scene)
    with participants.shown(context.view_layer, objects), face_origins.numbered(tracked):
        depsgraph = context.evaluated_depsgraph_get()
        depsgraph.update()
        names: set[str] = set()
        return [part for group in _groups(depsgraph, set(objects)) for part in _parts(group, scale, names)]


def fingerprint(parts: Iterable[Part]) -> str:
    """Return a text that changes with anything that the solver would see: positions, materials, sides."""
    digest = hashlib.blake2b(digest_size=16)
    for part in parts:
        digest.update(np.ascontiguousarray(part.vertices))
        digest.update(np.ascontiguousarray(part.faces))
        digest.update(f"{part.name}|{part.two_sided}|{materials.read(part.material)}".encode())
    return digest.hexdigest()


def unit_scale(scene: bpy.types.Scene) -> float:
    """Return the metres that one Blender unit stands for."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else materials.as_typed(units.scale_length)


def holds_own_results(object_: bpy.types.Object) -> bool:
    """Whether results can be written to the object's own mesh: not where objects share it or a library owns it."""
    mesh = object_.data
    return object_.type == "MESH" and mesh.users - mesh.use_fake_user == 1 and mesh.is_editable


@dataclass
class _Group:
    """All appearances of one evaluated mesh under one carrier."""

    source: bpy.types.Object
    carrier: bpy.types.Object
    mesh: mesh_arrays.TriangulatedMesh
    slots: list[bpy.types.Material | None]
    own_faces: NDArray[np.int32] | None
    matrices: list[NDArray[np.float64]] = field(default_factory=list)


def _groups(depsgraph: bpy.types.Depsgraph, allowed: set[bpy.types.Object]) -> Iterator[_Group]:
    groups: dict[tuple, _Group] = {}
    meshes: dict[int, mesh_arrays.TriangulatedMesh] = {}
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        # Text, curves and metaballs appear a second time as instances of their mesh: only meshes are read.
        if evaluated.type != "MESH" or not instance.show_self or not len(evaluated.data.polygons):
            continue
        source = evaluated.original
        carrier = instance.parent.original if instance.is_instance else source
        if carrier not in allowed or not _instance_renders(source, carrier):
            continue
        pointer = evaluated.data.as_pointer()
        key = (carrier.as_pointer(), source.as_pointer(), pointer)
        if key not in groups:
            if pointer not in meshes:
                meshes[pointer] = mesh_arrays.read_triangles(evaluated.data)
            own_faces = None if instance.is_instance else _own_faces(evaluated.data, source)
            # Originals, since a change of a setting need not have reached the evaluated copies.
            slots = [slot.material and slot.material.original for slot in evaluated.material_slots]
            groups[key] = _Group(source, carrier, meshes[pointer], slots or [None], own_faces)
        groups[key].matrices.append(np.array(instance.matrix_world))
    yield from groups.values()


def _instance_renders(source: bpy.types.Object, carrier: bpy.types.Object) -> bool:
    if source == carrier:
        return True
    if not participants.takes_part(source):
        return False
    if carrier.instance_type == "COLLECTION" and carrier.instance_collection is not None:
        return source in participants.instanced_objects(carrier.instance_collection)
    return True


def _own_faces(evaluated: bpy.types.Mesh, source: bpy.types.Object) -> NDArray[np.int32] | None:
    if not holds_own_results(source):
        return None
    if source.modifiers:
        return face_origins.read(evaluated)
    count = len(evaluated.polygons)
    return np.arange(count, dtype=np.int32) if count == len(source.data.polygons) else None


def _parts(group: _Group, scale: float, names: set[str]) -> Iterator[Part]:
    mesh, slots = group.mesh, group.slots
    # Two slots that hold one material make one part.
    first_slot = np.array([slots.index(material) for material in slots])
    slot_of_polygon = first_slot[np.clip(mesh.material_indices, 0, len(slots) - 1)]
    used = np.unique(slot_of_polygon)
    if len(used) == 1:
        yield _part(group, slots[used[0]], mesh.positions, mesh.triangles, mesh.polygons, scale, names)
        return
    slot_of_triangle = slot_of_polygon[mesh.polygons]
    for slot in used:
        chosen = slot_of_triangle == slot
        positions, triangles = _only_used(mesh.positions, mesh.triangles[chosen])
        label = slots[slot].name if slots[slot] else rpt_("no material")
        yield _part(group, slots[slot], positions, triangles, mesh.polygons[chosen], scale, names, f"/{label}")


def _part(
    group: _Group,
    material: bpy.types.Material | None,
    positions: NDArray,
    triangles: NDArray,
    polygons: NDArray,
    scale: float,
    names: set[str],
    label: str = "",
) -> Part:
    source, carrier = group.source, group.carrier
    vertices, faces = _placed(positions.astype(float), triangles, group.matrices, scale)
    sides = source.luzespecular.sides
    return Part(
        name=_unique((source.name if carrier == source else f"{carrier.name} > {source.name}") + label, names),
        object_name=carrier.name,
        material=material,
        vertices=vertices,
        faces=faces,
        polygons=np.tile(polygons, len(group.matrices)),
        own_faces=group.own_faces,
        receiver=source.luzespecular.role == "RECEIVER" and carrier.luzespecular.role == "RECEIVER",
        two_sided=sides == "BOTH" or (sides == "AUTO" and not group.mesh.closed),
        closed=group.mesh.closed,
        kind=source.type,
    )


def _unique(name: str, taken: set[str]) -> str:
    candidate, number = name, 2
    while candidate in taken:
        candidate, number = f"{name} ({number})", number + 1
    taken.add(candidate)
    return candidate


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
