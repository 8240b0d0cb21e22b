"""What is to be read at a point on the surfaces: lux, its components, its error; and points whose value stays shown."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
from bpy.app.translations import pgettext_iface as iface_
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

from . import display, mesh_arrays, results_object, writeback
from .choices import QUANTITY_ITEMS
from .legend import label
from .translations import CONTEXT

_MOST_LAYERS = 64


@dataclass(frozen=True)
class Hit:
    """A face under a ray.

    Attributes
    ----------
    object_name : str
    face : int
        Polygon of the evaluated mesh.
    place, normal : Vector
        World space.
    """

    object_name: str
    face: int
    place: Vector
    normal: Vector


@dataclass(frozen=True)
class Target:
    """An object that rays can hit; holds copies, no references into Blender's data."""

    object_name: str
    tree: BVHTree
    matrix: Matrix


def targets(context: bpy.types.Context) -> list[Target]:
    """Return all that a viewport shows and rays can hit."""
    depsgraph = context.evaluated_depsgraph_get()
    found = []
    for object_ in _visible(context):
        tree = BVHTree.FromObject(object_.evaluated_get(depsgraph), depsgraph)
        if tree is not None:
            found.append(Target(object_.name, tree, object_.matrix_world.copy()))
    return found


def state(context: bpy.types.Context) -> tuple:
    """Return what changes when `targets` would be others."""
    return tuple((object_.name, len(object_.data.polygons)) for object_ in _visible(context))


def _visible(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [object_ for object_ in context.view_layer.objects if object_.type == "MESH" and object_.visible_get()]


def pick(targets_: list[Target], origin: Vector, direction: Vector, culls: bool) -> Hit | None:
    """Return the nearest face on a ray; with `culls` those that look away are passed through, as the viewport does."""
    nearest, least = None, float("inf")
    for target in targets_:
        hit = _pick(target, origin, direction, culls)
        if hit is not None and (hit.place - origin).length < least:
            nearest, least = hit, (hit.place - origin).length
    return nearest


def _pick(target: Target, origin: Vector, direction: Vector, culls: bool) -> Hit | None:
    try:
        inverse = target.matrix.inverted()
    except ValueError:  # flattened to nothing
        return None
    start, along = inverse @ origin, (inverse.to_3x3() @ direction).normalized()
    for _ in range(_MOST_LAYERS):
        place, normal, face, distance = target.tree.ray_cast(start, along)
        if place is None:
            return None
        world = (inverse.to_3x3().transposed() @ normal).normalized()
        if not culls or world.dot(direction) < 0.0:
            return Hit(target.object_name, face, target.matrix @ place, world)
        start = place + along * max(1e-5, 1e-5 * distance)
    return None


def rows(context: bpy.types.Context, hit: Hit) -> tuple[str, list[tuple[str, str]]]:
    """Return the name of the surface under a hit, and names and values of all that is known there."""
    scene = context.scene
    object_ = bpy.data.objects.get(hit.object_name)
    if object_ is None:
        return "", []
    mesh = object_.evaluated_get(context.evaluated_depsgraph_get()).data
    name = _surface_name(scene, object_, mesh, hit.face)
    total = mesh_arrays.face_value(mesh, writeback.ILLUMINANCE, hit.face)
    if total is None:
        return name, [(iface_("not computed"), "")]
    lines = [(iface_("Illuminance"), f"{label(total)} lx")]
    sky = scene.luzespecular.results.sky_illuminance
    if sky > 0.0:
        lines.append((display.factor_name(scene), f"{label(100.0 * total / sky)} %"))
    for quantity, title, _ in QUANTITY_ITEMS[1:]:
        value = mesh_arrays.face_value(mesh, writeback.attribute_of(quantity), hit.face)
        if value is not None and (value > 0.0 or quantity == "initial"):
            lines.append((iface_(title, CONTEXT), f"{'± ' if quantity == 'error' else ''}{label(value)} lx"))
    back = mesh_arrays.face_value(mesh, writeback.ILLUMINANCE_BACK, hit.face)
    if back is not None:
        lines.append((iface_("Other side"), f"{label(back)} lx"))
    return name, lines


def _surface_name(scene: bpy.types.Scene, object_: bpy.types.Object, mesh: bpy.types.Mesh, face: int) -> str:
    side = object_.luzespecular.results_side
    if side not in results_object.NAMES:
        return object_.name
    row = mesh_arrays.face_value(mesh, results_object.SURFACE, face)
    table = scene.luzespecular.results.rows
    if row is None or not 0 <= int(row) < len(table):
        return object_.name
    name = table[int(row)].name
    return name if side == "front" else iface_("{name} (back)").format(name=name)


def pin(scene: bpy.types.Scene, hit: Hit) -> None:
    """Keep the value at a hit shown."""
    entry = scene.luzespecular.results.pins.add()
    entry.name, entry.face = hit.object_name, hit.face
    entry.place, entry.normal = hit.place, hit.normal


def pinned_value(scene: bpy.types.Scene, entry: bpy.types.PropertyGroup) -> float | None:
    """Return the value at a pin in the unit of the legend; None where there is none now."""
    object_ = scene.objects.get(entry.name)
    if object_ is None or object_.type != "MESH":
        return None
    quantity = scene.luzespecular.display.quantity
    value = mesh_arrays.face_value(object_.data, writeback.attribute_of(quantity), entry.face)
    return None if value is None else value * display.unit_factor(scene)
