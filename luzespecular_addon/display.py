"""Showing results: colours on the meshes, which of them the viewport shows, its shading; and undoing all that."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np
from bpy.app.translations import pgettext_iface as iface_
from numpy.typing import NDArray

from .. import core as luz
from . import (
    colours,
    contours,
    errors,
    false_colour,
    mesh_arrays,
    pins,
    results_object,
    results_table,
    session,
    smoothing,
    work_planes,
    writeback,
)
from .export import Export


@dataclass(frozen=True)
class Shown:
    """A mesh that carries false colours, and the values they stand for.

    Attributes
    ----------
    object_ : bpy.types.Object
    values : (p,) float32
        Value of each face in the unit of the legend; NaN where there is none.
    """

    object_: bpy.types.Object
    values: NDArray[np.float32]

    @property
    def mesh(self) -> bpy.types.Mesh:
        """The mesh of the object."""
        return self.object_.data

    @cached_property
    def corner_values(self) -> NDArray[np.float64]:
        """(c,) float: mean of the faces around each corner."""
        mesh = self.mesh
        vertices = mesh_arrays.corner_vertices(mesh)
        if self.object_.luzespecular.is_results:  # triangles apart: those that touch are found by where they stand
            groups = np.repeat(mesh_arrays.read_face_values(mesh, results_object.SURFACE, np.int32), 3)
            points = mesh_arrays.vertex_positions(mesh)
            tolerance = 1e-5 * smoothing.extent(points) or 1.0
            vertices = smoothing.weld(points, groups, tolerance)
        return smoothing.corner_means(
            self.values,
            mesh_arrays.polygon_areas(mesh),
            mesh_arrays.polygon_normals(mesh),
            mesh_arrays.corner_counts(mesh),
            vertices,
        )


def write(
    scene: bpy.types.Scene, export: Export, result: luz.Result, readings: Sequence[work_planes.Reading] | None = ()
) -> None:
    """Write a result to a scene, in place of the one before, and colour it; which objects show is left as it is.

    Work planes keep the values they have where ``readings`` is None.
    """
    results = scene.luzespecular.results
    results.sky_illuminance = result.light.sky_illuminance
    results.has_sun = result.light.sun_illuminance > 0.0
    for own in writeback.own_results(export, result):
        writeback.write(own)
    results.run = session.current.keep_result(scene.name, export, result)
    results_table.fill(scene, export, result)
    if scene.luzespecular.display.view == "RESULTS":
        results_object.write(scene, export, result)
    else:
        results_object.remove(scene)
    if readings is not None:
        work_planes.write(scene, readings)
    recolour(scene)


def show(scene: bpy.types.Scene) -> None:
    """Show the results of a scene at once: colours, objects, viewports."""
    recolour(scene)
    apply_view(scene)


def switch_renders(scene: bpy.types.Scene) -> None:
    """Have renders show what the settings ask for now; viewports stay as they are."""
    false_colour.apply(scene, current_scale(scene))


def switch_view(scene: bpy.types.Scene) -> None:
    """Show what the settings ask for now, making the fine faces if they are asked for and still known."""
    if has_results(scene) and scene.luzespecular.display.view == "RESULTS" and not results_object.all_of(scene):
        kept = kept_result(scene)
        if kept is not None:
            results_object.write(scene, *kept)
    show(scene)


def recolour(scene: bpy.types.Scene) -> None:
    """Colour all that holds results anew by the scene's display settings; no lux changes."""
    shown = shown_meshes(scene)
    if not shown:
        return
    scale = _scale(scene, shown)
    smooth = scene.luzespecular.display.shading == "SMOOTH"
    for one in shown:
        _colour(one, scale, smooth)
    for one in _own(scene) if shows_fine(scene) else []:
        _colour(one, scale, smooth=False)
    contours.update(scene, shown, scale)
    pins.attach(scene, shown)
    false_colour.update(scene, scale)
    if scene.luzespecular.display.quantity == "error":
        errors.find(scene, kept_result, _errors_found)


def _colour(one: Shown, scale: colours.ColourScale, smooth: bool) -> None:
    mesh, counts = one.mesh, mesh_arrays.corner_counts(one.mesh)
    if smooth:
        values = one.corner_values
        rgba = colours.corner_colours(values, 1, scale)
    else:
        values = np.repeat(one.values, counts)
        rgba = colours.corner_colours(one.values, counts, scale)
    mesh_arrays.write_corner_colours(mesh, writeback.COLOURS, rgba)
    mesh_arrays.write_corner_floats(mesh, writeback.SHOWN, false_colour.shader_values(values))
    mesh_arrays.make_colour_active(mesh, writeback.COLOURS)
    mesh.update_tag()


def shown_meshes(scene: bpy.types.Scene) -> list[Shown]:
    """Return what the viewport shows in false colours: the fine faces or the user's own, and the work planes."""
    fine = [_shown(scene, object_) for object_ in results_object.all_of(scene)] if shows_fine(scene) else []
    planes = [object_ for object_ in work_planes.all_of(scene) if writeback.holds_results(object_.data)]
    return (fine or _own(scene)) + [_shown(scene, plane) for plane in planes]


def _own(scene: bpy.types.Scene) -> list[Shown]:
    """Return the user's own meshes that hold results, each once."""
    own = {
        object_.data: object_
        for object_ in scene.objects
        if object_.type == "MESH" and not object_.luzespecular.plane.enabled
    }
    return [_shown(scene, object_) for mesh, object_ in own.items() if writeback.holds_results(mesh)]


def _shown(scene: bpy.types.Scene, object_: bpy.types.Object) -> Shown:
    name = writeback.attribute_of(scene.luzespecular.display.quantity)
    values = mesh_arrays.read_face_values(object_.data, name, np.float32)
    if values is None:
        values = np.full(len(object_.data.polygons), np.nan, np.float32)
    return Shown(object_, values * np.float32(unit_factor(scene)))


def kept_result(scene: bpy.types.Scene) -> tuple[Export, luz.Result] | None:
    """Return the result that a scene shows and what it was solved for, while they are known."""
    return session.current.result_of(scene.name, scene.luzespecular.results.run)


def _errors_found(scene: bpy.types.Scene, kept: tuple[Export, luz.Result]) -> None:
    """Write the errors of the result that is shown, which were still on their way, and show them."""
    for own in writeback.own_results(*kept):
        writeback.write(own)
    results_table.fill(scene, *kept)
    if results_object.all_of(scene):
        results_object.write(scene, *kept)
    recolour(scene)


def shows_fine(scene: bpy.types.Scene) -> bool:
    """Whether the fine faces carry the colours."""
    return scene.luzespecular.display.view == "RESULTS" and bool(results_object.all_of(scene))


def unit_factor(scene: bpy.types.Scene) -> float:
    """Return by what lux are multiplied to be shown; NaN for daylight factors without a sky."""
    if scene.luzespecular.display.unit == "LUX":
        return 1.0
    sky = scene.luzespecular.results.sky_illuminance
    return 100.0 / sky if sky > 0.0 else float("nan")


def unit_symbol(scene: bpy.types.Scene) -> str:
    """Return the symbol of the unit that values are shown in."""
    return "lx" if scene.luzespecular.display.unit == "LUX" else "%"


def factor_name(scene: bpy.types.Scene) -> str:
    """Return what shares of the open sky's illuminance are called: with the Sun they are no daylight factors."""
    return iface_("Share of open sky") if scene.luzespecular.results.has_sun else iface_("Daylight factor")


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
    show_fine = shows_fine(scene)
    shown_sides = {"front", "back"} if settings.show_backs else {"front"}
    for object_ in scene.objects:
        role = object_.luzespecular
        if role.results_side in results_object.NAMES:
            _set_hidden(scene, object_, not (show_fine and role.results_side in shown_sides))
        elif show_fine and role.has_fine_faces and not role.hidden_for_results:
            if _set_hidden(scene, object_, True):
                role.hidden_for_results = True
        elif role.hidden_for_results and not (show_fine and role.has_fine_faces):
            for sharing in object_.users_scene:
                _set_hidden(sharing, object_, False)
            role.property_unset("hidden_for_results")
    if has_results(scene):
        _shade_viewports(scene)
    false_colour.apply(scene, current_scale(scene))


def stand_for(scene: bpy.types.Scene, names: Container[str]) -> None:
    """Mark the objects that the fine faces stand for; marks go with them when they are renamed."""
    for object_ in scene.objects:
        if object_.luzespecular.has_fine_faces != (object_.name in names):
            if object_.name in names:
                object_.luzespecular.has_fine_faces = True
            else:
                object_.luzespecular.property_unset("has_fine_faces")


def settle_objects(scene: bpy.types.Scene) -> None:
    """Show the user's objects again where the fine faces that stood for them were deleted by hand."""
    # Asking what was never set would leave an empty group of settings.
    if scene.luzespecular.is_property_set("results") and not results_object.all_of(scene):
        if any(object_.luzespecular.hidden_for_results for object_ in scene.objects):
            apply_view(scene)


def clear(scene: bpy.types.Scene) -> None:
    """Take away all that results brought: attributes, fine faces, lines, renders, hidden objects, shading, tables."""
    scene.luzespecular.display.property_unset("in_renders")
    results_object.remove(scene)
    contours.remove(scene)
    for mesh in writeback.written_meshes(scene):
        writeback.clear(mesh)
    work_planes.forget_values(scene)
    scene.luzespecular.results.rows.clear()
    stand_for(scene, ())
    apply_view(scene)
    _restore_viewports(scene)
    scene.luzespecular.property_unset("results")
    session.current.forget_result()


def _scale(scene: bpy.types.Scene, shown: list[Shown]) -> colours.ColourScale:
    settings, results = scene.luzespecular.display, scene.luzespecular.results
    logarithmic = settings.scaling == "LOG"
    if settings.use_fixed_range:
        low, high = (
            (settings.low, settings.high) if settings.unit == "LUX" else (settings.low_percent, settings.high_percent)
        )
        high = max(high, low * 1.001)
        if logarithmic:
            low = max(low, high * colours.LOWEST_SHARE)
    else:
        values = np.concatenate([one.values for one in shown])
        areas = np.concatenate([mesh_arrays.polygon_areas(one.mesh) for one in shown])
        low, high = colours.automatic_range(values, areas, logarithmic)
    results.legend_low, results.legend_high = low, high
    return current_scale(scene)


def _set_hidden(scene: bpy.types.Scene, object_: bpy.types.Object, hidden: bool) -> bool:
    """Hide or show an object in all view layers of a scene; return whether that changed anything."""
    changed = False
    for view_layer in scene.view_layers:
        if object_.name in view_layer.objects and object_.hide_get(view_layer=view_layer) != hidden:
            object_.hide_set(hidden, view_layer=view_layer)
            changed = True
    return changed


def settle_viewports(scene: bpy.types.Scene) -> None:
    """Shade the viewports after an undo or a redo, which leave them as they are, by whether a scene has results now."""
    if not has_results(scene):
        _restore_viewports(scene)
    elif not any(len(screen.luzespecular.shadings) for screen, _, _ in _viewports(scene)):
        _shade_viewports(scene)


def _viewports(scene: bpy.types.Scene):
    for window in bpy.context.window_manager.windows:
        if window.scene == scene:
            for index, area in enumerate(window.screen.areas):
                if area.type == "VIEW_3D":
                    yield window.screen, index, area


def _shade_viewports(scene: bpy.types.Scene) -> None:
    """Switch the viewports to flat attribute colours of fronts, remembering how they were."""
    for screen, index, area in _viewports(scene):
        remembered, shading = screen.luzespecular.shadings, area.spaces.active.shading
        if index not in {entry.area for entry in remembered}:
            entry = remembered.add()
            entry.area = index
            entry.type, entry.light, entry.color_type = shading.type, shading.light, shading.color_type
            entry.backface_culling = shading.show_backface_culling
        shading.type, shading.light, shading.color_type = "SOLID", "FLAT", "VERTEX"
        shading.show_backface_culling = True
        _take_along(scene, area.spaces.active)
        area.tag_redraw()


def _take_along(scene: bpy.types.Scene, space: bpy.types.SpaceView3D) -> None:
    """Have our objects in a local view too: what they stand for is hidden there."""
    if space.local_view is not None:
        for object_ in results_object.all_of(scene):
            object_.local_view_set(space, True)


def _restore_viewports(scene: bpy.types.Scene) -> None:
    screens = set()
    for screen, index, area in _viewports(scene):
        screens.add(screen)
        entry = next((entry for entry in screen.luzespecular.shadings if entry.area == index), None)
        if entry is not None:
            shading = area.spaces.active.shading
            shading.show_backface_culling = entry.backface_culling
            shading.type, shading.color_type = "SOLID", entry.color_type
            shading.light = entry.light
            shading.type = entry.type
        area.tag_redraw()
    for screen in screens:
        screen.property_unset("luzespecular")
