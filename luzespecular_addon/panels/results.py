"""What is shown, and the table of surfaces."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import display, isolines
from .drawing import Sidebar, draw_notices, draw_wrapped


class LUZESPECULAR_UL_surfaces(bpy.types.UIList):
    """Rows of the results table."""

    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property, _index):
        """Draw one surface."""
        _draw_columns(layout, _side_name(item), *map(_short, (item.minimum, item.mean, item.maximum)))


class LUZESPECULAR_PT_results(Sidebar, bpy.types.Panel):
    """What is shown, and the table of surfaces."""

    bl_label = "Results"
    bl_description = "What is shown, and the table of surfaces"
    bl_idname = "LUZESPECULAR_PT_results"

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        scene = context.scene
        if not display.has_results(scene):
            layout.label(text="No results yet", icon="INFO")
            return
        settings, results = scene.luzespecular.display, scene.luzespecular.results
        layout.label(text=results.title, translate=False)
        layout.row().prop(settings, "view", expand=True)
        if settings.view == "RESULTS" and not display.shows_fine(scene):
            draw_wrapped(
                layout.column(align=True), iface_("Solve again for the fine faces"), "INFO", context.region.width
            )
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        fine = column.column()
        fine.active = display.shows_fine(scene)
        fine.prop(settings, "show_backs")
        column.prop(settings, "quantity")
        column.row().prop(settings, "unit", expand=True)
        if settings.unit == "FACTOR":
            _draw_factor(column.column(align=True), results, context.region.width)
        column.row().prop(settings, "shading", expand=True)
        _draw_scale(column, settings)
        _draw_lines(column, settings)
        column.prop(settings, "in_renders")
        row = layout.row(align=True)
        row.operator("luzespecular.probe", icon="EYEDROPPER")
        row.operator("luzespecular.clear_pins", text="", icon="X")
        _draw_table(layout, results)
        layout.operator("luzespecular.save_table", icon="FILE_TEXT")
        layout.operator("luzespecular.clear_results", icon="TRASH")
        if len(results.notices):
            draw_notices(layout.box(), results.notices, context.region.width)


def _draw_factor(column: bpy.types.UILayout, results: bpy.types.PropertyGroup, width: float) -> None:
    if results.sky_illuminance <= 0.0:
        draw_wrapped(column, iface_("Without a sky there is no daylight factor"), "ERROR", width)
    elif results.has_sun:
        text = iface_("Sunlight counts too: for daylight factors choose an overcast sky without Sun")
        draw_wrapped(column, text, "INFO", width)


def _draw_scale(column: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    column.prop(settings, "scale")
    column.row().prop(settings, "scaling", expand=True)
    column.prop(settings, "use_fixed_range")
    if settings.use_fixed_range:
        ends = column.column(align=True)
        for name in ("low", "high") if settings.unit == "LUX" else ("low_percent", "high_percent"):
            ends.prop(settings, name)
    column.prop(settings, "show_legend")


def _draw_lines(column: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    column.prop(settings, "show_lines")
    if settings.show_lines:
        column.prop(settings, "line_levels")
        try:
            isolines.parse_levels(settings.line_levels)
        except ValueError as error:
            text = iface_("'{word}' is no illuminance: give numbers such as 100, 200, 300")
            column.label(text=text.format(word=error), icon="ERROR", translate=False)


def _side_name(row: bpy.types.PropertyGroup) -> str:
    return row.name if row.side == "front" else iface_("{name} (back)").format(name=row.name)


def _draw_table(layout: bpy.types.UILayout, results: bpy.types.PropertyGroup) -> None:
    _draw_columns(layout, iface_("Surface [lx]"), iface_("Min"), iface_("Mean"), iface_("Max"))
    layout.template_list("LUZESPECULAR_UL_surfaces", "", results, "rows", results, "active_row", rows=5)
    if 0 <= results.active_row < len(results.rows):
        chosen = results.rows[results.active_row]
        column = layout.column(align=True)
        text = iface_("{name}: {area:.2f} m², uniformity {uniformity:.2f}")
        text = text.format(name=_side_name(chosen), area=chosen.area, uniformity=chosen.uniformity)
        column.label(text=text, translate=False)
        text = iface_("Mean {mean:.1f} lx, from {minimum:.1f} to {maximum:.1f}")
        text = text.format(mean=chosen.mean, minimum=chosen.minimum, maximum=chosen.maximum)
        column.label(text=text, translate=False)


def _draw_columns(layout: bpy.types.UILayout, name: str, *cells: str) -> None:
    split = layout.split(factor=0.43)
    split.label(text=name, translate=False)
    row = split.row(align=True)
    for text in cells:
        cell = row.column()
        cell.alignment = "RIGHT"
        cell.label(text=text, translate=False)


def _short(value: float) -> str:
    """Return an illuminance in the width that a column has."""
    return f"{value:.0f}" if value < 9_999.5 else f"{value / 1000.0:.1f}k"


CLASSES = (LUZESPECULAR_UL_surfaces, LUZESPECULAR_PT_results)
