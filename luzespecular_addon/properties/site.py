"""Place and time."""

import bpy

from .kinds import EnumProperty, FloatProperty, IntProperty


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


CLASSES = (LuzSiteSettings,)
