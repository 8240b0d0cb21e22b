"""The part that objects play."""

from __future__ import annotations

from typing import ClassVar

import bpy

from .. import participants
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
        if object_ is None or object_.luzespecular.is_results or object_.type not in participants.MESH_TYPES:
            layout.label(text="Select an object to set its role")
            layout.operator_menu_enum("luzespecular.select_role", "role", icon="RESTRICT_SELECT_OFF")
            return
        layout.label(text=object_.name, icon="OBJECT_DATA", translate=False)
        layout.prop(object_.luzespecular, "role")
        row = layout.row()
        row.active = object_.luzespecular.role != "IGNORE"
        row.prop(object_.luzespecular, "sides")
        layout.operator("luzespecular.set_role", text="Give to Selected", icon="DUPLICATE")
        layout.operator_menu_enum("luzespecular.select_role", "role", icon="RESTRICT_SELECT_OFF")


CLASSES = (LUZESPECULAR_PT_surfaces,)
