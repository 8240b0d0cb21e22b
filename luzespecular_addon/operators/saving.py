"""Tables as files."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as rpt_
from bpy_extras.io_utils import ExportHelper

from ...core import files


class SavesTable(ExportHelper):
    """An operator whose `table` returns header and rows, which go to a CSV file."""

    filename_ext = ".csv"
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})

    def table(self, context: bpy.types.Context) -> tuple[Sequence[str], Iterable[Sequence[str | float]]]:
        """Return header and rows."""
        raise NotImplementedError

    def execute(self, context):
        """Write the file."""
        try:
            files.write_csv(Path(self.filepath), *self.table(context))
        except OSError as error:
            self.report({"ERROR"}, rpt_("The table could not be saved: {error}").format(error=error))
            return {"CANCELLED"}
        return {"FINISHED"}
