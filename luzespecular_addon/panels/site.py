"""Place, date and hour, and where the Sun stands then."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ... import core as luz
from ...core.terminal import clock
from .. import light
from ..notices import BadInput
from ..translations import solver_message
from .drawing import Sidebar, draw_wrapped


class LUZESPECULAR_PT_site(Sidebar, bpy.types.Panel):
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


CLASSES = (LUZESPECULAR_PT_site,)
