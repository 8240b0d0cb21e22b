"""What is shown and how, and the table of surfaces."""

from __future__ import annotations

import math
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...core import tables
from .. import display, false_colour, isolines, render_legend, results_table
from ..legend import label, title
from ..translations import CONTEXT
from .drawing import Sidebar, draw_notices, draw_wrapped

_MOST_ROWS = 6
"""Of the table, before it scrolls."""


class LUZESPECULAR_UL_surfaces(bpy.types.UIList):
    """Rows of the results table."""

    def draw_item(self, context, layout, _data, item, _icon, _active_data, _active_property, _index):
        """Draw one surface."""
        _draw_columns(layout, _side_name(item), *map(_short, _shown_spread(context.scene, item)))


class LUZESPECULAR_PT_results(Sidebar, bpy.types.Panel):
    """What is shown, and the table of surfaces."""

    bl_label = "Results"
    bl_description = "What is shown, and the table of surfaces"
    bl_idname = "LUZESPECULAR_PT_results"

    def draw(self, context):
        """Draw the panel."""
        layout, scene, width = self.layout, context.scene, context.region.width
        if not display.has_results(scene):
            layout.label(text="No results yet", icon="INFO")
            return
        settings, results = scene.luzespecular.display, scene.luzespecular.results
        layout.label(text=results.title, translate=False)
        layout.row().prop(settings, "view", expand=True)
        if settings.view == "RESULTS" and not display.shows_fine(scene):
            draw_wrapped(layout.column(align=True), iface_("Solve again for the fine faces"), "INFO", width)
        column = _settings_column(layout)
        column.prop(settings, "quantity")
        column.row().prop(settings, "unit", expand=True)
        if settings.unit == "FACTOR":
            _draw_factor(column.column(align=True), results, width)
        row = layout.row(align=True)
        row.operator("luzespecular.probe", icon="EYEDROPPER")
        row.operator("luzespecular.clear_pins", text="", icon="X")
        layout.operator("luzespecular.clear_results", icon="TRASH")
        if len(results.notices):
            draw_notices(layout.box(), results.notices, width)


class _PartOfResults(Sidebar):
    """Where the parts of the results' panel stand."""

    bl_parent_id = "LUZESPECULAR_PT_results"

    @classmethod
    def poll(cls, context):
        """Only with results."""
        return display.has_results(context.scene)


class LUZESPECULAR_PT_colours(_PartOfResults, bpy.types.Panel):
    """Scale, range and shading of the false colours, and their legend."""

    bl_label = "Colours"
    bl_description = "Scale, range and shading of the false colours, and their legend"
    bl_idname = "LUZESPECULAR_PT_colours"

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.luzespecular.display
        column = _settings_column(self.layout)
        column.prop(settings, "scale")
        column.row().prop(settings, "scaling", expand=True)
        column.row().prop(settings, "shading", expand=True)
        column.prop(settings, "use_fixed_range")
        if settings.use_fixed_range:
            ends = column.column(align=True)
            for name in ("low", "high") if settings.unit == "LUX" else ("low_percent", "high_percent"):
                ends.prop(settings, name)
        column.prop(settings, "show_legend")
        row = column.row()
        row.active = display.shows_fine(context.scene)
        row.prop(settings, "show_backs")


class LUZESPECULAR_PT_renders(_PartOfResults, bpy.types.Panel):
    """False colours and their legend in renders and pictures."""

    bl_label = "Renders and Pictures"
    bl_description = "False colours and their legend in renders and pictures"
    bl_idname = "LUZESPECULAR_PT_renders"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Draw the panel."""
        settings, camera = context.scene.luzespecular.display, context.scene.camera
        column = _settings_column(self.layout)
        column.prop(settings, "in_renders")
        column.prop(settings, "legend_in_renders")
        part = column.column()
        part.active = settings.legend_in_renders
        part.prop(settings, "legend_corner")
        part.prop(settings, "legend_size")
        if settings.in_renders and settings.legend_in_renders:
            remark = None
            if camera is None:
                remark = iface_("Renders need a camera: Add > Camera")
            elif camera.type != "CAMERA" or camera.data.type not in render_legend.CAMERA_TYPES:
                remark = iface_("The legend needs a perspective or an orthographic camera")
            if remark:
                draw_wrapped(self.layout.column(align=True), remark, "INFO", context.region.width)
        if (
            settings.in_renders
            and settings.view == "OWN"
            and context.scene.render.engine == false_colour.WITHOUT_OVERRIDE
        ):
            remark = iface_(
                "Before Blender 5.0 EEVEE renders the colours of fine faces alone: show these, or use Cycles"
            )
            draw_wrapped(self.layout.column(align=True), remark, "INFO", context.region.width)
        self.layout.operator("luzespecular.save_picture", icon="IMAGE_DATA")


class LUZESPECULAR_PT_lines(_PartOfResults, bpy.types.Panel):
    """Lines of equal illuminance with their values."""

    bl_label = "Iso-lux Lines"
    bl_description = "Lines of equal illuminance with their values"
    bl_idname = "LUZESPECULAR_PT_lines"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        """Draw the switch."""
        self.layout.prop(context.scene.luzespecular.display, "show_lines", text="")

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.luzespecular.display
        column = _settings_column(self.layout)
        column.active = settings.show_lines
        column.prop(settings, "line_levels")
        try:
            isolines.parse_levels(settings.line_levels)
        except ValueError as error:
            text = iface_("'{word}' is no illuminance: give numbers such as 100, 200, 300")
            draw_wrapped(column.column(align=True), text.format(word=error), "ERROR", context.region.width)


class LUZESPECULAR_PT_table(_PartOfResults, bpy.types.Panel):
    """Minimum, mean, maximum and uniformity of each surface."""

    bl_label = "Table of Surfaces"
    bl_description = "Minimum, mean, maximum and uniformity of each surface"
    bl_idname = "LUZESPECULAR_PT_table"

    def draw(self, context):
        """Draw the panel."""
        _draw_table(self.layout, context.scene)
        self.layout.operator("luzespecular.save_table", icon="FILE_TEXT")


def _settings_column(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column


def _draw_factor(column: bpy.types.UILayout, results: bpy.types.PropertyGroup, width: float) -> None:
    if results.sky_illuminance <= 0.0:
        draw_wrapped(column, iface_("Without a sky there is no daylight factor"), "ERROR", width)
    elif results.has_sun:
        text = iface_("Sunlight counts too: for daylight factors choose an overcast sky without Sun")
        draw_wrapped(column, text, "INFO", width)


def _side_name(row: bpy.types.PropertyGroup) -> str:
    return row.name if row.side == "front" else iface_("{name} (back)").format(name=row.name)


def _shown_spread(scene: bpy.types.Scene, row: bpy.types.PropertyGroup) -> tables.Spread:
    """Return what a row says of the quantity shown, in the unit shown."""
    factor = display.unit_factor(scene)
    return tables.Spread(*(factor * lux for lux in results_table.spread(row, scene.luzespecular.display.quantity)))


def _draw_table(layout: bpy.types.UILayout, scene: bpy.types.Scene) -> None:
    results = scene.luzespecular.results
    layout.label(text=title(scene), translate=False)
    row = layout.row()
    # In our context, since Blender's own words for these are too long for a column.
    heads = (iface_("Min", CONTEXT), iface_("Mean", CONTEXT), iface_("Max", CONTEXT))
    _draw_columns(row, iface_("Surface", CONTEXT), *heads)
    if len(results.rows) > _MOST_ROWS:
        row.label(text="", icon="BLANK1")  # as wide as the list's scroll bar
    else:
        row.separator(factor=0.5)  # as wide as its border
    rows = min(len(results.rows) + 1, _MOST_ROWS)
    layout.template_list("LUZESPECULAR_UL_surfaces", "", results, "rows", results, "active_row", rows=rows)
    if 0 <= results.active_row < len(results.rows):
        chosen = results.rows[results.active_row]
        found = _shown_spread(scene, chosen)
        column = layout.column(align=True)
        text = iface_("{name}: {area:.2f} m², uniformity {uniformity}")
        uniformity = "–" if math.isnan(found.uniformity) else f"{found.uniformity:.2f}"
        text = text.format(name=_side_name(chosen), area=chosen.area, uniformity=uniformity)
        column.label(text=text, translate=False)
        text = iface_("Mean {mean} {unit}, from {minimum} to {maximum}")
        values = {name: "–" if math.isnan(value) else label(value) for name, value in found._asdict().items()}
        column.label(text=text.format(unit=display.unit_symbol(scene), **values), translate=False)


def _draw_columns(layout: bpy.types.UILayout, name: str, *cells: str) -> None:
    split = layout.split(factor=0.43)
    split.label(text=name, translate=False)
    row = split.row(align=True)
    for text in cells:
        cell = row.column()
        cell.alignment = "RIGHT"
        cell.label(text=text, translate=False)


def _short(value: float) -> str:
    """Return a value in the width that a column has."""
    if math.isnan(value):
        return "–"
    if value >= 9_999.5:
        return f"{value / 1000.0:.1f}k"
    return f"{value:.0f}" if value >= 99.95 or value == 0.0 else f"{value:.1f}" if value >= 9.995 else f"{value:.2f}"


CLASSES = (
    LUZESPECULAR_UL_surfaces,
    LUZESPECULAR_PT_results,
    LUZESPECULAR_PT_colours,
    LUZESPECULAR_PT_renders,
    LUZESPECULAR_PT_lines,
    LUZESPECULAR_PT_table,
)
