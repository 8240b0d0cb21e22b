"""The part that objects play."""

from __future__ import annotations

from typing import ClassVar

import bpy

from .drawing import Sidebar


class LUZESPECULAR_PT_surfaces(Sidebar, bpy.types.Panel):
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


CLASSES = (LUZESPECULAR_PT_surfaces,)
