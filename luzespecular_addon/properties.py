"""Every setting and stored result of the extension, as properties of Blender's own data blocks.

No postponed annotations here: Blender reads the annotations of property groups as values.
"""

from functools import partial

import bpy
from bpy import props
from bpy.props import CollectionProperty, PointerProperty

from . import display
from .choices import CIE_ITEMS, QUANTITY_ITEMS, SCALE_ITEMS, SKY_ITEMS
from .translations import CONTEXT

# In a context of their own, since Blender's own translation of a word goes first ("Clear" is a verb to it).
BoolProperty = partial(props.BoolProperty, translation_context=CONTEXT)
EnumProperty = partial(props.EnumProperty, translation_context=CONTEXT)
FloatProperty = partial(props.FloatProperty, translation_context=CONTEXT)
IntProperty = partial(props.IntProperty, translation_context=CONTEXT)
ShareProperty = partial(FloatProperty, min=0.0, max=1.0, subtype="FACTOR")
StringProperty = partial(props.StringProperty, translation_context=CONTEXT)


def _recolour(settings: "LuzDisplaySettings", _context: bpy.types.Context) -> None:
    display.recolour(settings.id_data)


def _switch_view(settings: "LuzDisplaySettings", _context: bpy.types.Context) -> None:
    display.apply_view(settings.id_data)
    display.recolour(settings.id_data)


class LuzMaterialSettings(bpy.types.PropertyGroup):
    """Photometric properties of a material."""

    source: EnumProperty(
        name="Values",
        description="Where the photometric values come from",
        items=(
            ("SHADER", "From Shader", "Read the values from the material's shader nodes"),
            ("CUSTOM", "Custom", "Use the values given here"),
        ),
        default="SHADER",
    )
    diffuse_reflectance: ShareProperty(
        name="Diffuse Reflectance",
        description="Share of the light that leaves evenly in all directions",
        default=0.5,
    )
    specular_reflectance: ShareProperty(
        name="Specular Reflectance",
        description="Share of the light that leaves as from a mirror",
        default=0.0,
    )
    regular_transmittance: ShareProperty(
        name="Regular Transmittance",
        description="Share of the light that passes straight through the whole pane at normal incidence",
        default=0.0,
    )
    use_refractive_index: BoolProperty(
        name="Clear Pane",
        description="Let reflection and transmission follow from the refractive index and the angle of incidence",
        default=False,
    )
    refractive_index: FloatProperty(
        name="Refractive Index",
        description="Of the pane; window glass has 1.52",
        min=1.001,
        max=3.0,
        default=1.52,
        precision=3,
    )
    exitance: FloatProperty(
        name="Exitance (lm/m²)",
        description="Luminous exitance that the surface emits by itself",
        min=0.0,
        default=0.0,
    )


class LuzObjectSettings(bpy.types.PropertyGroup):
    """The part an object plays."""

    role: EnumProperty(
        name="Role",
        description="The part this object plays in the daylight calculation",
        items=(
            ("RECEIVER", "Receiver", "Blocks and reflects light, and gets results"),
            ("OBSTRUCTION", "Obstruction", "Blocks and reflects light, but gets no results"),
            ("IGNORE", "Ignore", "Takes no part"),
        ),
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
    hidden_for_results: BoolProperty(options={"HIDDEN"})


class LuzMeshSettings(bpy.types.PropertyGroup):
    """What was written to a mesh, so that it can be taken away without a trace."""

    has_results: BoolProperty(options={"HIDDEN"})
    active_attribute_before: StringProperty(options={"HIDDEN"})
    active_colour_before: StringProperty(options={"HIDDEN"})
    render_colour_before: StringProperty(options={"HIDDEN"})


class LuzSiteSettings(bpy.types.PropertyGroup):
    """Place and time."""

    latitude: FloatProperty(
        name="Latitude",
        description="Degrees, north positive",
        min=-90.0,
        max=90.0,
        default=-27.6,
        precision=3,
    )
    longitude: FloatProperty(
        name="Longitude",
        description="Degrees, east positive",
        min=-180.0,
        max=180.0,
        default=-48.55,
        precision=3,
    )
    time_zone: FloatProperty(
        name="Time Zone",
        description="Hours that clocks are ahead of UTC, summer time included",
        min=-12.0,
        max=14.0,
        default=-3.0,
        step=50,
        precision=2,
    )
    day: IntProperty(name="Day", description="Day of the month", min=1, max=31, default=22)
    month: IntProperty(name="Month", description="Month of the year", min=1, max=12, default=6)
    year: IntProperty(name="Year", description="Year of the date", min=1900, max=2199, default=2026)
    time_kind: EnumProperty(
        name="Time",
        description="What the hour means",
        items=(
            ("SOLAR", "Solar", "At 12 the Sun stands highest"),
            ("CLOCK", "Clock", "Local clock time of the time zone"),
        ),
        default="SOLAR",
    )
    hour: FloatProperty(
        name="Hour",
        description="Hour of the day, with decimals: 9.5 is half past nine",
        min=0.0,
        max=24.0,
        default=12.0,
        step=25,
        precision=2,
    )
    north_offset: FloatProperty(
        name="North Offset",
        description="Angle in degrees from the +Y axis to true north, clockwise seen from above",
        min=-360.0,
        max=360.0,
        default=0.0,
        precision=2,
    )


class LuzSkySettings(bpy.types.PropertyGroup):
    """The light that comes from outside."""

    kind: EnumProperty(name="Sky", description="Sky and its illuminance", items=SKY_ITEMS, default="CLEAR")
    cie_type: EnumProperty(
        name="CIE Type", description="Type of the CIE standard general sky (ISO 15469)", items=CIE_ITEMS, default="12"
    )
    horizontal_illuminance: FloatProperty(
        name="Sky Illuminance (lx)",
        description="Diffuse illuminance of the sky alone on an open horizontal plane",
        min=0.0,
        default=10_000.0,
        step=10_000,
        precision=0,
    )
    use_sun: BoolProperty(name="Sun", description="Let the Sun shine", default=True)
    sun_illuminance: FloatProperty(
        name="Sun Illuminance (lx)",
        description="Illuminance by the Sun on a plane that faces it",
        min=0.0,
        default=80_000.0,
        step=100_000,
        precision=0,
    )
    ground_reflectance: ShareProperty(
        name="Ground Reflectance",
        description="Reflectance of the open ground around the scene: 0.2 for grass or soil, 0 for no light from below",
        default=0.2,
    )


class LuzAccuracySettings(bpy.types.PropertyGroup):
    """How finely to calculate."""

    fineness: EnumProperty(
        name="Fineness",
        description="How finely surfaces and sky are divided",
        items=(
            ("DRAFT", "Draft", "A first look: a quarter of the faces, a coarser globe"),
            ("NORMAL", "Normal", "Faces chosen for the scene, a globe of 60 bands"),
            ("FINE", "Fine", "Four times the faces, a globe of 90 bands"),
            ("EXPERT", "Expert", "The numbers given here"),
        ),
        default="NORMAL",
    )
    bands: IntProperty(
        name="Bands",
        description="Bands of the globe from zenith to nadir; 60 make 5,902 parcels",
        min=6,
        max=360,
        default=60,
    )
    max_area: FloatProperty(
        name="Largest Face (m²)",
        description="Faces are divided until none is larger; 0 lets the solver choose",
        min=0.0,
        default=0.0,
        precision=4,
    )


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
        description="Which part of the light the fine faces show",
        items=QUANTITY_ITEMS,
        default="illuminance",
        update=_recolour,
    )
    scale: EnumProperty(
        name="Scale", description="False-colour scale", items=SCALE_ITEMS, default="VIRIDIS", update=_recolour
    )
    scaling: EnumProperty(
        name="Steps",
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
    show_legend: BoolProperty(name="Legend", description="Draw the legend in the 3D viewport", default=True)


class LuzSurfaceRow(bpy.types.PropertyGroup):
    """Statistics of one side of a surface; `name` is the surface."""

    side: StringProperty()
    object_name: StringProperty()
    area: FloatProperty()
    minimum: FloatProperty()
    mean: FloatProperty()
    maximum: FloatProperty()
    uniformity: FloatProperty()


class LuzNotice(bpy.types.PropertyGroup):
    """A remark about the last solved scene."""

    level: StringProperty()
    text: StringProperty()


class LuzShading(bpy.types.PropertyGroup):
    """Shading of a 3D viewport before it was switched to false colours; `name` is the screen."""

    area: IntProperty()
    type: StringProperty()
    light: StringProperty()
    color_type: StringProperty()
    backface_culling: BoolProperty()


class LuzResults(bpy.types.PropertyGroup):
    """What the last run left behind, apart from the meshes."""

    title: StringProperty(description="Date, hour and sky of the results")
    rows: CollectionProperty(type=LuzSurfaceRow)
    active_row: IntProperty()
    notices: CollectionProperty(type=LuzNotice)
    shadings: CollectionProperty(type=LuzShading)
    legend_low: FloatProperty()
    legend_high: FloatProperty()


class LuzSceneSettings(bpy.types.PropertyGroup):
    """All settings of a scene."""

    site: PointerProperty(type=LuzSiteSettings)
    sky: PointerProperty(type=LuzSkySettings)
    accuracy: PointerProperty(type=LuzAccuracySettings)
    display: PointerProperty(type=LuzDisplaySettings)
    results: PointerProperty(type=LuzResults)


class LuzProgress(bpy.types.PropertyGroup):
    """State of the run in progress; lives with the window manager, so it is never saved."""

    running: BoolProperty(options={"SKIP_SAVE"})
    fraction: FloatProperty(min=0.0, max=1.0, options={"SKIP_SAVE"})
    stage: StringProperty(options={"SKIP_SAVE"})
    cancel: BoolProperty(options={"SKIP_SAVE"})


_CLASSES = (
    LuzMaterialSettings,
    LuzObjectSettings,
    LuzMeshSettings,
    LuzSiteSettings,
    LuzSkySettings,
    LuzAccuracySettings,
    LuzDisplaySettings,
    LuzSurfaceRow,
    LuzNotice,
    LuzShading,
    LuzResults,
    LuzSceneSettings,
    LuzProgress,
)

_POINTERS = (
    (bpy.types.Material, LuzMaterialSettings),
    (bpy.types.Object, LuzObjectSettings),
    (bpy.types.Mesh, LuzMeshSettings),
    (bpy.types.Scene, LuzSceneSettings),
    (bpy.types.WindowManager, LuzProgress),
)


def register() -> None:
    """Add the properties to Blender's data blocks."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for owner, cls in _POINTERS:
        owner.luzespecular = PointerProperty(type=cls)


def unregister() -> None:
    """Take the properties away; saved values stay in the file until it is saved without the extension."""
    for owner, _cls in reversed(_POINTERS):
        del owner.luzespecular
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
