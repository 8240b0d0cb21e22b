"""Roles of many objects at once."""

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .. import participants
from ..properties.surfaces import ROLE_ITEMS
from .polls import NeedsObjectMode


class LUZESPECULAR_OT_set_role(bpy.types.Operator):
    """Give all selected objects a role."""

    bl_idname = "luzespecular.set_role"
    bl_label = "Set Role"
    bl_description = "Give all selected objects the role of the active one, and its lit sides"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Need an active object and others."""
        if context.object is None or len(context.selected_objects) < 2:
            cls.poll_message_set("Select several objects; the active one's role is given to the others")
            return False
        return True

    def execute(self, context):
        """Set."""
        active = context.object.luzespecular
        others = [object_ for object_ in context.selected_objects if object_ != context.object and object_.is_editable]
        for object_ in others:
            object_.luzespecular.role, object_.luzespecular.sides = active.role, active.sides
        self.report({"INFO"}, rpt_("Role given to {count} objects").format(count=len(others)))
        return {"FINISHED"}


class LUZESPECULAR_OT_select_role(NeedsObjectMode, bpy.types.Operator):
    """Select all objects of a role."""

    bl_idname = "luzespecular.select_role"
    bl_label = "Select by Role"
    bl_description = "Select all visible objects that play this part"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    role: bpy.props.EnumProperty(name="Role", description="The part the objects play", items=ROLE_ITEMS)

    def execute(self, context):
        """Select."""
        for object_ in context.visible_objects:
            settings = object_.luzespecular
            plays = object_.type in participants.MESH_TYPES and not settings.is_results
            object_.select_set(plays and settings.role == self.role)
        return {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_set_role, LUZESPECULAR_OT_select_role)
