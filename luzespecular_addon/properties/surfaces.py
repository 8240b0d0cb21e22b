"""The part that an object plays, and what was written to a mesh."""

import bpy
from bpy.props import PointerProperty

from .kinds import BoolProperty, EnumProperty, StringProperty
from .work_planes import LuzWorkPlane

ROLE_ITEMS = (
    ("RECEIVER", "Receiver", "Blocks and reflects light, and gets results"),
    ("OBSTRUCTION", "Obstruction", "Blocks and reflects light, but gets no results"),
    ("IGNORE", "Ignore", "Takes no part"),
)


class LuzObjectSettings(bpy.types.PropertyGroup):
    """The part an object plays."""

    role: EnumProperty(
        name="Role",
        description="The part this object plays in the daylight calculation",
        items=ROLE_ITEMS,
        default="RECEIVER",
    )
    sides: EnumProperty(
        name="Lit Sides",
        description="Which sides of the faces receive and reflect light; every face blocks light from both sides",
        items=(
            ("AUTO", "Automatic", "Closed meshes: the side that the normals look to; open meshes: both sides"),
            ("FRONT", "Front Only", "The side that the normals look to; the other side is black"),
            ("BOTH", "Both", "Both sides, each by itself"),
        ),
        default="AUTO",
    )
    is_results: BoolProperty(options={"HIDDEN"})
    results_side: StringProperty(options={"HIDDEN"})
    state: StringProperty(options={"HIDDEN"})
    has_fine_faces: BoolProperty(options={"HIDDEN"})
    hidden_for_results: BoolProperty(options={"HIDDEN"})
    in_renders_for_results: BoolProperty(options={"HIDDEN"})
    off_camera_for_results: BoolProperty(options={"HIDDEN"})
    focused_for_results: BoolProperty(options={"HIDDEN"})
    plane: PointerProperty(type=LuzWorkPlane)


class LuzMeshSettings(bpy.types.PropertyGroup):
    """What was written to a mesh, so that it can be taken away without a trace."""

    has_results: BoolProperty(options={"HIDDEN"})
    active_attribute_before: StringProperty(options={"HIDDEN"})
    active_colour_before: StringProperty(options={"HIDDEN"})
    render_colour_before: StringProperty(options={"HIDDEN"})


CLASSES = (LuzObjectSettings, LuzMeshSettings)
