"""Sky, Sun and ground."""

from __future__ import annotations

import bpy

from .drawing import Sidebar


class LUZESPECULAR_PT_sky(Sidebar, bpy.types.Panel):
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


CLASSES = (LUZESPECULAR_PT_sky,)
