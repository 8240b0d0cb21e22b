"""What makes an object a work plane, and how new ones are laid out."""

import bpy

from .kinds import BoolProperty, FloatProperty, StringProperty


class LuzWorkPlane(bpy.types.PropertyGroup):
    """A grid of points in mid-air, one for each face of the object."""

    enabled: BoolProperty(
        name="Work Plane", description="Read the illuminance at the middle of each face; the object blocks no light"
    )
    threshold: FloatProperty(
        name="Threshold (lx)",
        description="Illuminance that the share of the area counts from",
        min=0.0,
        default=300.0,
        step=5_000,
        precision=0,
    )
    state: StringProperty(options={"HIDDEN"})


CLASSES = (LuzWorkPlane,)
