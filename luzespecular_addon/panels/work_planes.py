"""Work planes and their statistics."""

from __future__ import annotations

import math
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...core import tables
from .. import placements, work_planes
from ..choices import QUANTITY_ITEMS
from ..legend import label
from ..translations import CONTEXT
from .drawing import Sidebar, draw_wrapped


class LUZESPECULAR_PT_work_planes(Sidebar, bpy.types.Panel):
    """Grids of points in mid-air and what was read on them."""

    bl_label = "Work Planes"
    bl_description = "Grids of points in mid-air and what was read on them"
    bl_idname = "LUZESPECULAR_PT_work_planes"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        planes = work_planes.all_of(context.scene)
        for plane in planes:
            _draw_plane(layout.box(), plane, context.scene, context.region.width)
        layout.operator("luzespecular.add_work_plane", icon="MESH_GRID")
        object_ = context.object
        if object_ is not None and object_.type == "MESH" and not object_.luzespecular.is_results:
            row = layout.row()
            row.prop(object_.luzespecular.plane, "enabled", text=iface_("Use {name}").format(name=object_.name))
        if planes:
            layout.operator("luzespecular.save_work_planes", icon="FILE_TEXT")


def _draw_plane(box: bpy.types.UILayout, plane: bpy.types.Object, scene: bpy.types.Scene, width: float) -> None:
    settings = plane.luzespecular.plane
    row = box.row()
    row.label(text=plane.name, icon="MESH_GRID", translate=False)
    shown = scene.luzespecular.display.quantity
    quantity = shown if shown in tables.QUANTITIES else tables.QUANTITIES[0]  # errors are known of surfaces alone
    found = work_planes.statistics_of(plane, placements.unit_scale(scene), quantity)
    results = scene.luzespecular.results
    if found is None:
        draw_wrapped(box.column(align=True), iface_("Not read yet: solve"), "INFO", width)
        return
    if work_planes.is_stale(plane):
        draw_wrapped(box.column(align=True), iface_("Moved or edited since: solve again"), "ERROR", width)
    title = next(name for key, name, _ in QUANTITY_ITEMS if key == quantity)
    box.label(text=f"{iface_('Illuminance')}: {iface_(title, CONTEXT)}", translate=False)
    rows = [
        (iface_("Minimum"), f"{label(found.minimum)} lx"),
        (iface_("Mean"), f"{label(found.mean)} lx"),
        (iface_("Maximum"), f"{label(found.maximum)} lx"),
        (iface_("Uniformity (min/mean)"), "–" if math.isnan(found.uniformity) else f"{found.uniformity:.2f}"),
        (iface_("Area"), f"{found.area:.2f} m²"),
        (iface_("{threshold} lx or more").format(threshold=label(settings.threshold)), f"{found.share_above:.0%}"),
    ]
    if results.sky_illuminance > 0.0 and not results.has_sun and quantity == "illuminance":
        rows.append((iface_("Mean daylight factor"), f"{100.0 * found.mean / results.sky_illuminance:.2f} %"))
    column = box.column(align=True)
    for name, value in rows:
        split = column.split(factor=0.62)
        split.label(text=name, translate=False)
        cell = split.column()
        cell.alignment = "RIGHT"
        cell.label(text=value, translate=False)
    threshold = box.column()
    threshold.use_property_split = True
    threshold.use_property_decorate = False
    threshold.prop(settings, "threshold")


CLASSES = (LUZESPECULAR_PT_work_planes,)
