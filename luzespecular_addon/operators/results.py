"""Clear the results, save their table."""

from typing import ClassVar

import bpy

from ...core import tables
from .. import display, results_table
from .polls import NeedsResults
from .saving import SavesTable


class LUZESPECULAR_OT_clear_results(NeedsResults, bpy.types.Operator):
    """Remove all results from the scene: attributes, colours, the fine faces and the tables."""

    bl_idname = "luzespecular.clear_results"
    bl_label = "Clear Results"
    bl_description = "Remove all results from the scene: attributes, colours, the fine faces and the tables"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def execute(self, context):
        """Clear."""
        display.clear(context.scene)
        return {"FINISHED"}


class LUZESPECULAR_OT_save_table(SavesTable, bpy.types.Operator):
    """Save the table of surfaces as a CSV file."""

    bl_idname = "luzespecular.save_table"
    bl_label = "Save Table"
    bl_description = "Save the table of surfaces as a CSV file"

    @classmethod
    def poll(cls, context):
        """Grey without results."""
        if len(context.scene.luzespecular.results.rows):
            return True
        cls.poll_message_set("There are no results yet: solve first")
        return False

    def table(self, context):
        """All quantities of all surfaces."""
        rows = context.scene.luzespecular.results.rows
        return tables.SURFACE_HEADER, map(tables.surface_row, map(results_table.statistics, rows))


CLASSES = (LUZESPECULAR_OT_clear_results, LUZESPECULAR_OT_save_table)
