"""Sky, Sun and ground."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import light
from ..notices import BadInput
from .drawing import Sidebar
from .presets import LUZESPECULAR_PT_sky_presets


class LUZESPECULAR_PT_sky(Sidebar, bpy.types.Panel):
    """Sky, Sun and ground."""

    bl_label = "Sky"
    bl_description = "Sky, Sun and ground"
    bl_idname = "LUZESPECULAR_PT_sky"

    def draw_header_preset(self, _context):
        """Draw the button of presets."""
        LUZESPECULAR_PT_sky_presets.draw_panel_header(self.layout)

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_split = True
        settings = context.scene.luzespecular
        sky = settings.sky
        layout.prop(sky, "kind")
        if sky.kind == "CIE":
            layout.prop(sky, "cie_type")
        with_sun = sky.kind != "OVERCAST"
        if with_sun:
            layout.prop(sky, "use_sun")
            row = layout.row()
            row.active = sky.use_sun
            row.prop(sky, "sun_disc")
        layout.row().prop(sky, "illuminance_from", expand=True)
        if sky.illuminance_from == "VALUE":
            column = layout.column(align=True)
            if sky.kind != "NONE":
                column.prop(sky, "horizontal_illuminance")
            if with_sun:
                row = column.row()
                row.active = sky.use_sun
                row.prop(sky, "sun_illuminance")
        else:
            _draw_model(layout, settings)
        row = layout.row()
        row.use_property_split = False  # the slider shows its long name inside
        row.prop(sky, "ground_reflectance")


def _draw_model(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    try:
        by_sky, by_sun = light.illuminances(settings.sky, light.sun_place(settings.site))
    except BadInput:
        return  # Site & Time says what is wrong
    column = layout.box().column(align=True)
    for text, value in ((iface_("Sky: {lux:,.0f} lx"), by_sky), (iface_("Sun: {lux:,.0f} lx facing it"), by_sun)):
        column.label(text=text.format(lux=value).replace(",", " "), translate=False)


CLASSES = (LUZESPECULAR_PT_sky,)
