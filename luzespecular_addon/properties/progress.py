"""The run in progress, and what the last look at the scene found."""

import bpy
from bpy.props import CollectionProperty

from .kinds import BoolProperty, FloatProperty, IntProperty, StringProperty


class LuzFinding(bpy.types.PropertyGroup):
    """One thing that is wrong or odd in the scene; `name` is the surface."""

    level: StringProperty()
    kind: StringProperty()
    text: StringProperty()
    remedy: StringProperty()


class LuzProgress(bpy.types.PropertyGroup):
    """State of the run in progress and findings; lives with the window manager, so it is never saved."""

    running: BoolProperty(options={"SKIP_SAVE"})
    fraction: FloatProperty(min=0.0, max=1.0, options={"SKIP_SAVE"})
    stage: StringProperty(options={"SKIP_SAVE"})
    seconds_left: FloatProperty(min=-1.0, default=-1.0, options={"SKIP_SAVE"})
    live_remark: StringProperty(options={"SKIP_SAVE"})
    cancel: BoolProperty(options={"SKIP_SAVE"})
    checked: BoolProperty(options={"SKIP_SAVE"})
    findings: CollectionProperty(type=LuzFinding, options={"SKIP_SAVE"})
    active_finding: IntProperty(options={"SKIP_SAVE"})


CLASSES = (LuzFinding, LuzProgress)
