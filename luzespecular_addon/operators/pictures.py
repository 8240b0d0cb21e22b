"""Save a picture of the results with their legend."""

from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as rpt_
from bpy_extras.io_utils import ExportHelper

from .. import pictures
from .polls import NeedsResults


class LUZESPECULAR_OT_save_picture(NeedsResults, bpy.types.Operator, ExportHelper):
    """Save a picture of the results with their legend, as a PNG file."""

    bl_idname = "luzespecular.save_picture"
    bl_label = "Save Picture"
    bl_description = "Save a picture of the results with their legend as a PNG file, seen from the scene's camera"

    filename_ext = ".png"
    filter_glob: bpy.props.StringProperty(default="*.png", options={"HIDDEN"})
    width: bpy.props.IntProperty(name="Width", description="Pixels", default=pictures.SIZE[0], min=64, max=16384)
    height: bpy.props.IntProperty(name="Height", description="Pixels", default=pictures.SIZE[1], min=64, max=16384)

    def execute(self, context):
        """Render and write the file."""
        try:
            pictures.save(context.scene, Path(self.filepath), (self.width, self.height))
        except OSError as error:
            self.report({"ERROR"}, rpt_("The picture could not be saved: {error}").format(error=error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_save_picture,)
