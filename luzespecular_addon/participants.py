"""Which objects take part: those that render, whether or not the viewport hides them at the moment."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

MESH_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
"""Object types that Blender turns into faces."""

SURFACELESS_TYPES = {"CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL", "GPENCIL"}
"""Object types that render, but have no faces: the user is told that they are left out."""


def rendered_objects(view_layer: bpy.types.ViewLayer) -> list[bpy.types.Object]:
    """Return the objects of a view layer that render, by their own and their collections' settings, in a fixed order.

    Results of earlier runs and objects with the role *Ignore* are not among them.
    """
    reachable: set[bpy.types.Object] = set()
    for layer_collection in _rendered_layer_collections(view_layer.layer_collection):
        reachable.update(layer_collection.collection.objects)
    return [object_ for object_ in view_layer.objects if object_ in reachable and takes_part(object_)]


def takes_part(object_: bpy.types.Object) -> bool:
    """Whether an object's own settings let it take part."""
    settings = object_.luzespecular
    return not (object_.hide_render or settings.is_results or settings.plane.enabled or settings.role == "IGNORE")


def instanced_objects(collection: bpy.types.Collection) -> set[bpy.types.Object]:
    """Return the objects that an instance of a collection renders, nested collections included."""
    if collection.hide_render:
        return set()
    objects = set(collection.objects)
    for child in collection.children:
        objects |= instanced_objects(child)
    return objects


@contextmanager
def shown(view_layer: bpy.types.ViewLayer, objects: list[bpy.types.Object]) -> Iterator[None]:
    """Show objects in the viewport for a while, since the dependency graph holds no others; then hide them again."""
    hidden = [object_ for object_ in objects if not object_.visible_get(view_layer=view_layer)]
    if not hidden:
        yield
        return
    wanted = set(hidden)
    undo = []
    try:
        for object_ in hidden:
            undo += _show(object_, "hide_viewport")
            if object_.hide_get(view_layer=view_layer):
                object_.hide_set(False, view_layer=view_layer)
                undo.append((object_, None))
        for layer_collection in _rendered_layer_collections(view_layer.layer_collection):
            if wanted.intersection(layer_collection.collection.all_objects):
                undo += _show(layer_collection, "hide_viewport")
                undo += _show(layer_collection.collection, "hide_viewport")
        view_layer.update()
        yield
    finally:
        for owner, attribute in reversed(undo):
            if attribute is None:
                owner.hide_set(True, view_layer=view_layer)
            else:
                setattr(owner, attribute, True)
        view_layer.update()


def _show(owner: bpy.types.bpy_struct, attribute: str) -> list[tuple[bpy.types.bpy_struct, str]]:
    if not getattr(owner, attribute):
        return []
    setattr(owner, attribute, False)
    return [(owner, attribute)]


def _rendered_layer_collections(root: bpy.types.LayerCollection) -> Iterator[bpy.types.LayerCollection]:
    if root.collection.hide_render:
        return
    if not root.exclude:
        yield root
    for child in root.children:
        yield from _rendered_layer_collections(child)
