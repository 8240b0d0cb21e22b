"""Place and time."""

import bpy
from bpy.props import PointerProperty

from .. import following, sun_light
from ..translations import CONTEXT
from .kinds import BoolProperty, EnumProperty, FloatProperty, IntProperty


def _changed(settings: "LuzSiteSettings", _context: bpy.types.Context) -> None:
    following.settings_changed(settings.id_data)


def _is_sun(_settings: "LuzSiteSettings", object_: bpy.types.Object) -> bool:
    return sun_light.is_sun(object_)


class LuzSiteSettings(bpy.types.PropertyGroup):
    """Place and time."""

    latitude: FloatProperty(
        name="Latitude",
        description="Degrees, north positive",
        min=-90.0,
        max=90.0,
        default=-27.6,
        precision=3,
        update=_changed,
    )
    longitude: FloatProperty(
        name="Longitude",
        description="Degrees, east positive",
        min=-180.0,
        max=180.0,
        default=-48.55,
        precision=3,
        update=_changed,
    )
    time_zone: FloatProperty(
        name="Time Zone",
        description="Hours that clocks are ahead of UTC, summer time included",
        min=-12.0,
        max=14.0,
        default=-3.0,
        step=50,
        precision=2,
        update=_changed,
    )
    day: IntProperty(name="Day", description="Day of the month", min=1, max=31, default=22, update=_changed)
    month: IntProperty(name="Month", description="Month of the year", min=1, max=12, default=6, update=_changed)
    year: IntProperty(name="Year", description="Year of the date", min=1900, max=2199, default=2026, update=_changed)
    days_later: IntProperty(
        name="Days Later",
        description="Days to add to the date: keyframe it to run through months and years",
        min=-3660,
        max=3660,
        default=0,
        update=_changed,
    )
    time_kind: EnumProperty(
        name="Time",
        description="What the hour means",
        items=(
            ("SOLAR", "Solar", "At 12 the Sun stands highest"),
            ("CLOCK", "Clock", "Local clock time of the time zone"),
        ),
        default="SOLAR",
        update=_changed,
    )
    hour: FloatProperty(
        name="Hour",
        description="Hour of the day, with decimals: 9.5 is half past nine",
        min=0.0,
        max=24.0,
        default=12.0,
        step=25,
        precision=2,
        update=_changed,
    )
    north_offset: FloatProperty(
        name="North Offset",
        description="Angle in degrees from the +Y axis to true north, clockwise seen from above",
        min=-360.0,
        max=360.0,
        default=0.0,
        precision=2,
        update=_changed,
    )
    show_compass: BoolProperty(
        name="Compass",
        description="Draw north and the Sun in the 3D viewport, with results or while this tab is open",
        default=True,
    )
    sun_link: EnumProperty(
        name="Sun Light",
        description="What the chosen Sun light of the scene has to do with the Sun of the calculation",
        items=(
            ("NONE", "Apart", "Nothing: the Sun follows from site, date and hour, and the light stays as it is"),
            ("READ", "Read", "The Sun stands where the light shines from, whatever site, date and hour say"),
            ("SET", "Set", "The light is turned to where the Sun stands at the site, date and hour"),
        ),
        default="NONE",
        update=_changed,
    )
    sun_object: PointerProperty(
        name="Sun Light",
        description="A light of type Sun",
        type=bpy.types.Object,
        poll=_is_sun,
        update=_changed,
        translation_context=CONTEXT,
    )


CLASSES = (LuzSiteSettings,)
