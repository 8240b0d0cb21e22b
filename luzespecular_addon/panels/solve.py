"""Solve, progress and cancel."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .drawing import Sidebar


class LUZESPECULAR_PT_solve(Sidebar, bpy.types.Panel):
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


CLASSES = (LUZESPECULAR_PT_solve,)
