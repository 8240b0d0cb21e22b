"""How finely to calculate."""

from __future__ import annotations

import bpy

from .drawing import Sidebar
from .presets import LUZESPECULAR_PT_accuracy_presets


class LUZESPECULAR_PT_accuracy(Sidebar, bpy.types.Panel):
    """How finely to calculate."""

    bl_label = "Accuracy"
    bl_description = "How finely to calculate"
    bl_idname = "LUZESPECULAR_PT_accuracy"

    def draw_header_preset(self, _context):
        """Draw the button of presets."""
        LUZESPECULAR_PT_accuracy_presets.draw_panel_header(self.layout)

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        accuracy = context.scene.luzespecular.accuracy
        layout.prop(accuracy, "fineness")
        if accuracy.fineness == "ERROR":
            layout.prop(accuracy, "error")
        elif accuracy.fineness == "EXPERT":
            layout.use_property_split = False  # names are too long to stand beside the numbers
            column = layout.column(align=True)
            column.prop(accuracy, "bands")
            column.prop(accuracy, "max_area")
            column = layout.column(align=True)
            column.prop(accuracy, "cycles")
            row = column.row()
            row.active = accuracy.cycles < 0
            row.prop(accuracy, "tolerance")
            column = layout.column(align=True)
            column.prop(accuracy, "specular_cutoff")
            column.prop(accuracy, "threads")


CLASSES = (LUZESPECULAR_PT_accuracy,)
