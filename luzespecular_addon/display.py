"""Showing results: colours on the meshes, which of them the viewport shows, its shading; and undoing all that."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from . import colours, mesh_arrays, results_object, writeback


def show(scene: bpy.types.Scene) -> None:
    """Show the results of a scene at once: colours, objects, viewports."""
    recolour(scene)
    apply_view(scene)


def recolour(scene: bpy.types.Scene) -> None:
    """Colour the fine faces and the user's meshes anew by the scene's display settings; no lux changes."""
    quantity = scene.luzespecular.display.quantity
    fine = _values([object_.data for object_ in results_object.all_of(scene)], quantity)
    own = _values(writeback.written_meshes(scene), writeback.ILLUMINANCE)
    if not fine and not own:
        return
    scale = _scale(scene, fine or own)
    for mesh, values in [*fine, *own]:
        corners = mesh_arrays.corner_counts(mesh)
        mesh_arrays.write_corner_colours(mesh, writeback.COLOURS, colours.corner_colours(values, corners, scale))
        mesh_arrays.make_colour_active(mesh, writeback.COLOURS)
        mesh.update_tag()


def has_results(scene: bpy.types.Scene) -> bool:
    """Whether a scene holds results."""
    return bool(results_object.all_of(scene) or writeback.written_meshes(scene))


def current_scale(scene: bpy.types.Scene) -> colours.ColourScale:
    """Return the scale that the colours now in the meshes were made by."""
    settings, results = scene.luzespecular.display, scene.luzespecular.results
    return colours.ColourScale(settings.scale, results.legend_low, results.legend_high, settings.scaling == "LOG")


def apply_view(scene: bpy.types.Scene) -> None:
    """Show the fine faces in place of the objects they stand for, or those objects themselves, as the settings say."""
    settings = scene.luzespecular.display
    show_fine = settings.view == "RESULTS" and bool(results_object.all_of(scene))
    shown_sides = {"front", "back"} if settings.show_backs else {"front"}
    standing_for = {row.object_name for row in scene.luzespecular.results.rows} if show_fine else set()
    for object_ in scene.objects:
        role = object_.luzespecular
        if role.is_results:
            _set_hidden(scene, object_, not (show_fine and role.results_side in shown_sides))
        elif object_.name in standing_for and not role.hidden_for_results:
            if _set_hidden(scene, object_, True):
                role.hidden_for_results = True
        elif role.hidden_for_results and object_.name not in standing_for:
            _set_hidden(scene, object_, False)
            role.property_unset("hidden_for_results")
    if has_results(scene):
        _shade_viewports(scene, backface_culling=show_fine)


def clear(scene: bpy.types.Scene) -> None:
    """Take away all that results brought: attributes, the fine faces, hidden objects, viewport shading, tables."""
    results_object.remove(scene)
    for mesh in writeback.written_meshes(scene):
        writeback.clear(mesh)
    scene.luzespecular.results.rows.clear()
    apply_view(scene)
    _restore_viewports(scene)
    scene.luzespecular.property_unset("results")


def _values(meshes: list[bpy.types.Mesh], quantity: str) -> list[tuple[bpy.types.Mesh, NDArray]]:
    found = [(mesh, mesh_arrays.read_face_values(mesh, quantity, np.float32)) for mesh in meshes]
    return [(mesh, values) for mesh, values in found if values is not None]


def _scale(scene: bpy.types.Scene, shown: list[tuple[bpy.types.Mesh, NDArray]]) -> colours.ColourScale:
    settings, results = scene.luzespecular.display, scene.luzespecular.results
    logarithmic = settings.scaling == "LOG"
    if settings.use_fixed_range:
        low, high = settings.low, max(settings.high, settings.low * 1.001)
        if logarithmic:
            low = max(low, high * colours.LOWEST_SHARE)
    else:
        values = np.concatenate([values for _, values in shown])
        areas = np.concatenate([mesh_arrays.polygon_areas(mesh) for mesh, _ in shown])
        low, high = colours.automatic_range(values, areas, logarithmic)
    results.legend_low, results.legend_high = low, high
    return colours.ColourScale(settings.scale, low, high, logarithmic)


def _set_hidden(scene: bpy.types.Scene, object_: bpy.types.Object, hidden: bool) -> bool:
    """Hide or show an object in all view layers of a scene; return whether that changed anything."""
    changed = False
    for view_layer in scene.view_layers:
        if object_.name in view_layer.objects and object_.hide_get(view_layer=view_layer) != hidden:
            object_.hide_set(hidden, view_layer=view_layer)
            changed = True
    return changed


def _viewports(scene: bpy.types.Scene):
    for window in bpy.context.window_manager.windows:
        if window.scene == scene:
            for index, area in enumerate(window.screen.areas):
                if area.type == "VIEW_3D":
                    yield window.screen.name, index, area


def _shade_viewports(scene: bpy.types.Scene, backface_culling: bool) -> None:
    """Switch the viewports to flat attribute colours, remembering how they were."""
    remembered = scene.luzespecular.results.shadings
    known = {(entry.name, entry.area) for entry in remembered}
    for screen, index, area in _viewports(scene):
        shading = area.spaces.active.shading
        if (screen, index) not in known:
            entry = remembered.add()
            entry.name, entry.area = screen, index
            entry.type, entry.light, entry.color_type = shading.type, shading.light, shading.color_type
            entry.backface_culling = shading.show_backface_culling
        shading.type, shading.light, shading.color_type = "SOLID", "FLAT", "VERTEX"
        shading.show_backface_culling = backface_culling
        area.tag_redraw()


def _restore_viewports(scene: bpy.types.Scene) -> None:
    remembered = {(entry.name, entry.area): entry for entry in scene.luzespecular.results.shadings}
    for screen, index, area in _viewports(scene):
        entry = remembered.get((screen, index))
        if entry is not None:
            shading = area.spaces.active.shading
            shading.show_backface_culling = entry.backface_culling
            shading.type, shading.color_type = "SOLID", entry.color_type
            shading.light = entry.light
            shading.type = entry.type
        area.tag_redraw()
