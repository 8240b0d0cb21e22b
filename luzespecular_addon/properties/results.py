"""How results are shown, and what the last run left behind."""

import math
from functools import partial

import bpy
from bpy.props import CollectionProperty, FloatVectorProperty, PointerProperty

from .. import display
from ..choices import CORNER_ITEMS, QUANTITY_ITEMS, SCALE_ITEMS, UNIT_ITEMS
from .kinds import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty


def _recolour(settings: "LuzDisplaySettings", _context: bpy.types.Context) -> None:
    display.recolour(settings.id_data)


def _switch_view(settings: "LuzDisplaySettings", _context: bpy.types.Context) -> None:
    display.switch_view(settings.id_data)


def _switch_renders(settings: "LuzDisplaySettings", _context: bpy.types.Context) -> None:
    display.switch_renders(settings.id_data)


class LuzDisplaySettings(bpy.types.PropertyGroup):
    """How results are shown."""

    view: EnumProperty(
        name="Show On",
        description="What carries the false colours in the viewport",
        items=(
            (
                "RESULTS",
                "Fine Faces",
                "A separate object that holds the solver's own fine faces; your objects are hidden meanwhile",
            ),
            ("OWN", "Own Meshes", "Your own faces, each with its mean illuminance"),
        ),
        default="RESULTS",
        update=_switch_view,
    )
    show_backs: BoolProperty(
        name="Backs",
        description="Show the fine faces of backs; without them one looks through walls from outside into the room",
        default=True,
        update=_switch_view,
    )
    quantity: EnumProperty(
        name="Quantity",
        description="Which part of the light is shown",
        items=QUANTITY_ITEMS,
        default="illuminance",
        update=_recolour,
    )
    unit: EnumProperty(
        name="Unit", description="What the colours stand for", items=UNIT_ITEMS, default="LUX", update=_recolour
    )
    shading: EnumProperty(
        name="Shading",
        description="How colours lie on the faces",
        items=(
            ("FACES", "Faces", "Each face has the colour of its own mean"),
            ("SMOOTH", "Smooth", "Colours run from corner to corner, each the mean of the faces that meet there"),
        ),
        default="FACES",
        update=_recolour,
    )
    scale: EnumProperty(
        name="Scale", description="False-colour scale", items=SCALE_ITEMS, default="VIRIDIS", update=_recolour
    )
    scaling: EnumProperty(
        name="Mapping",
        description="How values are spread over the colours",
        items=(
            ("LOG", "Logarithmic", "Equal ratios are equally far apart, as the eye judges"),
            ("LINEAR", "Linear", "Equal differences are equally far apart"),
        ),
        default="LOG",
        update=_recolour,
    )
    use_fixed_range: BoolProperty(
        name="Fixed Range", description="Keep the ends of the scale instead of fitting them", update=_recolour
    )
    low: FloatProperty(
        name="From (lx)", description="Illuminance at the low end of the scale", min=0.0, default=10.0, update=_recolour
    )
    high: FloatProperty(
        name="To (lx)",
        description="Illuminance at the high end of the scale",
        min=0.001,
        default=10_000.0,
        update=_recolour,
    )
    low_percent: FloatProperty(
        name="From (%)",
        description="Daylight factor at the low end of the scale",
        min=0.0,
        default=0.1,
        update=_recolour,
    )
    high_percent: FloatProperty(
        name="To (%)",
        description="Daylight factor at the high end of the scale",
        min=0.001,
        default=10.0,
        update=_recolour,
    )
    show_lines: BoolProperty(
        name="Iso-lux Lines", description="Draw lines of equal illuminance with their values", update=_recolour
    )
    line_levels: StringProperty(
        name="Levels",
        description="Values to draw lines for, such as 100, 200, 300, 500; empty for those of the legend",
        update=_recolour,
    )
    in_renders: BoolProperty(
        name="In Renders",
        description=(
            "Have EEVEE and Cycles render the false colours: materials are overridden, tone mapping and the depth of "
            "field of cameras are off meanwhile"
        ),
        update=_switch_renders,
    )
    show_legend: BoolProperty(name="Legend", description="Draw the legend in the 3D viewport", default=True)
    legend_in_renders: BoolProperty(
        name="Legend",
        description="Have the legend in renders of the false colours and in saved pictures",
        default=True,
        update=_switch_renders,
    )
    legend_corner: EnumProperty(
        name="Corner",
        description="Corner of the picture that the legend stands in",
        items=CORNER_ITEMS,
        default="BOTTOM_LEFT",
        update=_switch_renders,
    )
    legend_size: FloatProperty(
        name="Size (%)",
        description="Height of the legend, as a share of the picture's",
        min=10.0,
        max=95.0,
        default=45.0,
        precision=0,
        step=500,
        update=_switch_renders,
    )


_Statistics = partial(FloatVectorProperty, size=len(QUANTITY_ITEMS), default=[math.nan] * len(QUANTITY_ITEMS))


class LuzSurfaceRow(bpy.types.PropertyGroup):
    """Statistics of one side of a surface; `name` is the surface, numbers without an s are those of the total."""

    side: StringProperty()
    object_name: StringProperty()
    area: FloatProperty()
    minima: _Statistics()
    means: _Statistics()
    maxima: _Statistics()
    minimum: FloatProperty(get=lambda row: row.minima[0])
    mean: FloatProperty(get=lambda row: row.means[0])
    maximum: FloatProperty(get=lambda row: row.maxima[0])
    uniformity: FloatProperty(get=lambda row: row.minima[0] / row.means[0] if row.means[0] > 0.0 else math.nan)


class LuzNotice(bpy.types.PropertyGroup):
    """A remark about the last solved scene."""

    level: StringProperty()
    text: StringProperty()


class LuzShading(bpy.types.PropertyGroup):
    """Shading of a 3D viewport before it was switched to false colours."""

    area: IntProperty()
    type: StringProperty()
    light: StringProperty()
    color_type: StringProperty()
    backface_culling: BoolProperty()


class LuzScreenSettings(bpy.types.PropertyGroup):
    """What a screen's viewports looked like; with the screen, since that is what an undo leaves as it is."""

    shadings: CollectionProperty(type=LuzShading)


class LuzPin(bpy.types.PropertyGroup):
    """A point on a face whose value stays written beside it; `name` is the object."""

    place: FloatVectorProperty(size=3, subtype="XYZ")
    normal: FloatVectorProperty(size=3, subtype="XYZ")
    face: IntProperty()


class LuzOverride(bpy.types.PropertyGroup):
    """Material override of a view layer before the false colours; `name` is the view layer."""

    material: PointerProperty(type=bpy.types.Material)


class LuzResults(bpy.types.PropertyGroup):
    """What the last run left behind, apart from the meshes."""

    title: StringProperty(description="Date, hour and sky of the results")
    rows: CollectionProperty(type=LuzSurfaceRow)
    active_row: IntProperty()
    notices: CollectionProperty(type=LuzNotice)
    legend_low: FloatProperty()
    legend_high: FloatProperty()
    run: IntProperty()
    sky_illuminance: FloatProperty()
    has_sun: BoolProperty()
    pins: CollectionProperty(type=LuzPin)
    renders: BoolProperty()
    false_colour: PointerProperty(type=bpy.types.Material)
    overrides: CollectionProperty(type=LuzOverride)
    view_transform_before: StringProperty()
    look_before: StringProperty()
    exposure_before: FloatProperty()
    gamma_before: FloatProperty()


CLASSES = (LuzDisplaySettings, LuzSurfaceRow, LuzNotice, LuzShading, LuzScreenSettings, LuzPin, LuzOverride, LuzResults)
