"""The run in progress."""

import bpy

from .kinds import BoolProperty, FloatProperty, StringProperty


class LuzProgress(bpy.types.PropertyGroup):
    """State of the run in progress; lives with the window manager, so it is never saved."""

    running: BoolProperty(options={"SKIP_SAVE"})
    fraction: FloatProperty(min=0.0, max=1.0, options={"SKIP_SAVE"})
    stage: StringProperty(options={"SKIP_SAVE"})
    seconds_left: FloatProperty(min=-1.0, default=-1.0, options={"SKIP_SAVE"})
    live_remark: StringProperty(options={"SKIP_SAVE"})
    cancel: BoolProperty(options={"SKIP_SAVE"})


CLASSES = (LuzProgress,)
