"""Objects of the extension's own that a scene holds with its results: made, found and taken away by their side."""

from __future__ import annotations

from collections.abc import Container

import bpy


def all_of(scene: bpy.types.Scene, sides: Container[str]) -> list[bpy.types.Object]:
    """Return a scene's objects of some sides (`LuzObjectSettings.results_side`)."""
    return [object_ for object_ in scene.objects if object_.luzespecular.results_side in sides]


def find(scene: bpy.types.Scene, side: str) -> bpy.types.Object | None:
    """Return a scene's object of one side, if there is one."""
    return next(iter(all_of(scene, (side,))), None)


def new(scene: bpy.types.Scene, name: str, side: str, mesh: bpy.types.Mesh) -> bpy.types.Object:
    """Add an object to a scene; it takes no part in a run."""
    object_ = bpy.data.objects.new(name, mesh)
    object_.luzespecular.is_results, object_.luzespecular.results_side = True, side
    scene.collection.objects.link(object_)
    return object_


def hide(scene: bpy.types.Scene, object_: bpy.types.Object) -> None:
    """Hide an object from all viewports."""
    for view_layer in scene.view_layers:
        object_.hide_set(True, view_layer=view_layer)


def remove(scene: bpy.types.Scene, sides: Container[str]) -> None:
    """Delete a scene's objects of some sides together with their meshes."""
    for object_ in all_of(scene, sides):
        mesh = object_.data
        bpy.data.objects.remove(object_)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)
