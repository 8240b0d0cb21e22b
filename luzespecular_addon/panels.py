"""The sidebar (3D View, tab LuzEspecular) and the panels of materials and objects. Nothing is computed here."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import core as luz
from ..core.terminal import clock
from . import display, light, materials
from .notices import BadInput
from .translations import solver_message

_LEVEL_ICONS = {"ERROR": "ERROR", "WARNING": "ERROR", "INFO": "INFO"}


class _Sidebar:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "LuzEspecular"


class LUZESPECULAR_PT_solve(_Sidebar, bpy.types.Panel):
    """Solve, progress and cancel."""

    bl_label = "LuzEspecular"
    bl_description = "Solve, progress and cancel"
    bl_idname = "LUZESPECULAR_PT_solve"

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        state = context.window_manager.luzespecular
        if state.running:
            row = layout.row(align=True)
            row.progress(factor=state.fraction, text=f"{100.0 * state.fraction:.0f} %  {iface_(state.stage)}")
            row.operator("luzespecular.cancel", text="", icon="CANCEL")
        else:
            row = layout.row()
            row.scale_y = 1.4
            row.operator("luzespecular.solve", icon="LIGHT_SUN")
        layout.use_property_split = True
        layout.use_property_decorate = False
        accuracy = context.scene.luzespecular.accuracy
        layout.prop(accuracy, "fineness")
        if accuracy.fineness == "EXPERT":
            layout.prop(accuracy, "bands")
            layout.prop(accuracy, "max_area")


class LUZESPECULAR_PT_site(_Sidebar, bpy.types.Panel):
    """Place, date and hour."""

    bl_label = "Site & Time"
    bl_description = "Place, date and hour"
    bl_idname = "LUZESPECULAR_PT_site"

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_split = True
        site = context.scene.luzespecular.site
        column = layout.column(align=True)
        column.prop(site, "latitude")
        column.prop(site, "longitude")
        column = layout.column(align=True)
        column.prop(site, "day")
        column.prop(site, "month")
        column.prop(site, "year")
        layout.row().prop(site, "time_kind", expand=True)
        column = layout.column(align=True)
        column.prop(site, "hour")
        row = column.row()
        row.active = site.time_kind == "CLOCK"
        row.prop(site, "time_zone")
        layout.prop(site, "north_offset")
        _draw_sun(layout.box().column(align=True), site, context.region.width)


class LUZESPECULAR_PT_sky(_Sidebar, bpy.types.Panel):
    """Sky, Sun and ground."""

    bl_label = "Sky"
    bl_description = "Sky, Sun and ground"
    bl_idname = "LUZESPECULAR_PT_sky"

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_split = True
        sky = context.scene.luzespecular.sky
        layout.prop(sky, "kind")
        if sky.kind == "CIE":
            layout.prop(sky, "cie_type")
            layout.prop(sky, "horizontal_illuminance")
        layout.prop(sky, "use_sun")
        if sky.kind in {"CIE", "NONE"}:
            row = layout.row()
            row.active = sky.use_sun
            row.prop(sky, "sun_illuminance")
        row = layout.row()
        row.use_property_split = False  # the slider shows its long name inside
        row.prop(sky, "ground_reflectance")


class LUZESPECULAR_PT_surfaces(_Sidebar, bpy.types.Panel):
    """The part the active object plays."""

    bl_label = "Surfaces"
    bl_description = "The part the active object plays"
    bl_idname = "LUZESPECULAR_PT_surfaces"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        object_ = context.object
        if object_ is None or object_.luzespecular.is_results:
            layout.label(text="Select an object to set its role")
            return
        layout.label(text=object_.name, icon="OBJECT_DATA", translate=False)
        layout.prop(object_.luzespecular, "role")
        row = layout.row()
        row.active = object_.luzespecular.role != "IGNORE"
        row.prop(object_.luzespecular, "sides")


class LUZESPECULAR_UL_surfaces(bpy.types.UIList):
    """Rows of the results table."""

    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property, _index):
        """Draw one surface."""
        _draw_columns(layout, _side_name(item), *map(_short, (item.minimum, item.mean, item.maximum)))


class LUZESPECULAR_PT_results(_Sidebar, bpy.types.Panel):
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
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        fine = column.column()
        fine.active = settings.view == "RESULTS"
        fine.prop(settings, "show_backs")
        fine.prop(settings, "quantity")
        column.prop(settings, "scale")
        column.row().prop(settings, "scaling", expand=True)
        column.prop(settings, "use_fixed_range")
        if settings.use_fixed_range:
            column.prop(settings, "low")
            column.prop(settings, "high")
        column.prop(settings, "show_legend")
        _draw_table(layout, results)
        layout.operator("luzespecular.save_table", icon="FILE_TEXT")
        layout.operator("luzespecular.clear_results", icon="TRASH")
        if len(results.notices):
            box = layout.box().column(align=True)
            for notice in results.notices:
                _draw_wrapped(box, notice.text, _LEVEL_ICONS[notice.level], context.region.width)


class LUZESPECULAR_PT_material(bpy.types.Panel):
    """Photometric values of the active material."""

    bl_label = "LuzEspecular"
    bl_description = "Photometric values of the active material"
    bl_idname = "LUZESPECULAR_PT_material"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        """Only with a material."""
        return context.material is not None

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        material = context.material
        settings = material.luzespecular
        layout.row().prop(settings, "source", expand=True)
        column = layout.column(align=True)
        optics = materials.read(material)
        if settings.source == "CUSTOM":
            column.prop(settings, "use_refractive_index")
            if settings.use_refractive_index:
                column.prop(settings, "regular_transmittance")
                column.prop(settings, "refractive_index")
            else:
                column.prop(settings, "diffuse_reflectance")
                column.prop(settings, "specular_reflectance")
                column.prop(settings, "regular_transmittance")
            column.prop(settings, "exitance")
        else:
            _draw_optics(column.column(align=True), optics)
        for notice in materials.notices(material, optics):
            _draw_wrapped(layout.column(align=True), notice.text, _LEVEL_ICONS[notice.level], context.region.width)
        layout.label(text=iface_("Not absorbed: {share:.3f} of 1").format(share=optics.total), translate=False)
        layout.operator("luzespecular.values_from_shader", icon="COPYDOWN")


def _side_name(row: bpy.types.PropertyGroup) -> str:
    return row.name if row.side == "front" else iface_("{name} (back)").format(name=row.name)


def _draw_sun(column: bpy.types.UILayout, site: bpy.types.PropertyGroup, width: float) -> None:
    try:
        place = light.sun_place(site)
        rise, fall = light.sunrise_sunset(site)
    except (BadInput, luz.SceneError) as error:
        _draw_wrapped(column, solver_message(error), "ERROR", width)
        return
    text = iface_("Sun: altitude {altitude:.1f}°, azimuth {azimuth:.1f}°")
    column.label(text=text.format(altitude=place.altitude, azimuth=place.azimuth), icon="LIGHT_SUN", translate=False)
    if not place.is_up:
        _draw_wrapped(column, iface_("The Sun is below the horizon: only the sky is solved"), "INFO", width)
    if rise is not None and fall is not None:
        text = iface_("Sunrise {rise}, sunset {fall}").format(rise=clock(rise), fall=clock(fall))
        column.label(text=text, icon="BLANK1", translate=False)
    else:
        column.label(text="The Sun neither rises nor sets", icon="BLANK1")


def _draw_optics(column: bpy.types.UILayout, optics: materials.Optics) -> None:
    rows = (
        ("Diffuse Reflectance", optics.diffuse_reflectance),
        ("Specular Reflectance", optics.specular_reflectance),
        ("Regular Transmittance", optics.regular_transmittance),
        ("Refractive Index", optics.refractive_index),
        ("Exitance (lm/m²)", optics.exitance),
    )
    for name, value in rows:
        if value:
            column.label(text=f"{iface_(name)}: {value:.4g}", translate=False)
    if not any(value for _, value in rows):
        column.label(text="Black: absorbs all light")


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


def _draw_wrapped(column: bpy.types.UILayout, text: str, icon: str, width: float) -> None:
    """Draw a text on as many lines as the region's width asks for, since labels do not wrap."""
    size = bpy.context.preferences.system.ui_scale or 1.0  # 0 without a window
    letters = max(int(width / (7.0 * size)) - 6, 20)
    line = ""
    for word in text.split():
        if line and len(line) + 1 + len(word) > letters:
            column.label(text=line, icon=icon, translate=False)
            line, icon = "", "BLANK1"
        line = f"{line} {word}".strip()
    column.label(text=line, icon=icon, translate=False)


_CLASSES = (
    LUZESPECULAR_PT_solve,
    LUZESPECULAR_PT_site,
    LUZESPECULAR_PT_sky,
    LUZESPECULAR_PT_surfaces,
    LUZESPECULAR_UL_surfaces,
    LUZESPECULAR_PT_results,
    LUZESPECULAR_PT_material,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
