"""Clear the results, save their table."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_rpt as rpt_
from bpy_extras.io_utils import ExportHelper

from ...core import files, tables
from .. import display
from .polls import NeedsResults


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


class LUZESPECULAR_OT_save_table(bpy.types.Operator, ExportHelper):
    """Save the table of surfaces as a CSV file."""

    bl_idname = "luzespecular.save_table"
    bl_label = "Save Table"
    bl_description = "Save the table of surfaces as a CSV file"

    filename_ext = ".csv"
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        """Grey without results."""
        if len(context.scene.luzespecular.results.rows):
            return True
        cls.poll_message_set("There are no results yet: solve first")
        return False

    def execute(self, context):
        """Write the file."""
        rows = (
            tables.surface_row(
                tables.SurfaceStatistics(row.name, row.side, row.area, row.minimum, row.mean, row.maximum)
            )
            for row in context.scene.luzespecular.results.rows
        )
        try:
            files.write_csv(Path(self.filepath), tables.SURFACE_HEADER, rows)
        except OSError as error:
            self.report({"ERROR"}, rpt_("The table could not be saved: {error}").format(error=error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_clear_results, LUZESPECULAR_OT_save_table)
