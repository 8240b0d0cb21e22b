"""Place, date and hour, and where the Sun stands then."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ... import core as luz
from ...core.terminal import clock
from .. import light
from ..notices import BadInput
from ..translations import solver_message
from .drawing import Sidebar, draw_wrapped
from .presets import LUZESPECULAR_PT_site_presets


class LUZESPECULAR_PT_site(Sidebar, bpy.types.Panel):
    """Place, date and hour."""

    bl_label = "Site & Time"
    bl_description = "Place, date and hour"
    bl_idname = "LUZESPECULAR_PT_site"

    def draw_header_preset(self, _context):
        """Draw the button of cities and presets."""
        LUZESPECULAR_PT_site_presets.draw_panel_header(self.layout)

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_split = True
        site = context.scene.luzespecular.site
        by_light = site.sun_link == "READ"
        column = layout.column(align=True)
        column.active = not by_light
        column.prop(site, "latitude")
        column.prop(site, "longitude")
        column = layout.column(align=True)
        column.prop(site, "day")
        column.prop(site, "month")
        column.prop(site, "year")
        column.prop(site, "days_later")
        row = layout.row(align=True)
        row.active = not by_light
        row.prop(site, "time_kind", expand=True)
        column = layout.column(align=True)
        column.active = not by_light
        column.prop(site, "hour")
        row = column.row()
        row.active = site.time_kind == "CLOCK" and not by_light
        row.prop(site, "time_zone")
        layout.prop(site, "north_offset")
        _draw_sun(layout.box().column(align=True), site, context.region.width)
        row = layout.row()
        row.operator("luzespecular.set_now", icon="TIME")
        row.use_property_decorate = False
        row.prop(site, "show_compass", text="", icon="ORIENTATION_GLOBAL")


class LUZESPECULAR_PT_sun_light(Sidebar, bpy.types.Panel):
    """The Sun light of the scene, read or set."""

    bl_label = "Sun Light"
    bl_description = "The Sun light of the scene, read or set"
    bl_idname = "LUZESPECULAR_PT_sun_light"
    bl_parent_id = "LUZESPECULAR_PT_site"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_decorate = False
        site = context.scene.luzespecular.site
        layout.row().prop(site, "sun_link", expand=True)
        layout.prop(site, "sun_object", text="")
        if site.sun_link == "NONE" or site.sun_object is None:
            layout.operator("luzespecular.add_sun_light", icon="LIGHT_SUN")


def _draw_sun(column: bpy.types.UILayout, site: bpy.types.PropertyGroup, width: float) -> None:
    try:
        place = light.sun_place(site)
        rise, fall = light.sunrise_sunset(site)
    except (BadInput, luz.SceneError) as error:
        draw_wrapped(column, solver_message(error), "ERROR", width)
        return
    text = iface_("Sun: altitude {altitude:.1f}°, azimuth {azimuth:.1f}°")
    column.label(text=text.format(altitude=place.altitude, azimuth=place.azimuth), icon="LIGHT_SUN", translate=False)
    if not place.is_up:
        draw_wrapped(column, iface_("The Sun is below the horizon: only the sky is solved"), "INFO", width)
    if rise is not None and fall is not None:
        text = iface_("Sunrise {rise}, sunset {fall}").format(rise=clock(rise), fall=clock(fall))
        column.label(text=text, icon="BLANK1", translate=False)
    else:
        column.label(text="The Sun neither rises nor sets", icon="BLANK1")


CLASSES = (LUZESPECULAR_PT_site, LUZESPECULAR_PT_sun_light)
