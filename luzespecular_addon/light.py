"""From the settings of a scene to the solver's light: Sun position, sky, Sun and ground."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .. import core as luz
from ..core import sun
from . import sun_light
from .materials import as_typed
from .notices import Notice, refuse
from .translations import solver_message

_CIE_TYPES = {"CLEAR": 12, "INTERMEDIATE": 10, "OVERCAST": 16}
"""The CIE sky of each preset: that of `luz.default_daylight`."""


@dataclass(frozen=True)
class SunPlace:
    """Where the Sun stands.

    Attributes
    ----------
    altitude : float
        Above the horizon [degrees].
    azimuth : float
        Clockwise from true north [degrees].
    scene_azimuth : float
        Clockwise from the scene's +Y axis [degrees].
    day_of_year : int
        1 on 1 January.
    """

    altitude: float
    azimuth: float
    scene_azimuth: float
    day_of_year: int

    @property
    def is_up(self) -> bool:
        """Whether the Sun stands above the horizon."""
        return self.altitude > 0.0


def sun_place(site: bpy.types.PropertyGroup) -> SunPlace:
    """Return where the Sun stands: for a scene's site, date and hour, or where its Sun light shines from.

    Raises
    ------
    BadInput
        Where there is no such date, or no Sun light to read.
    """
    date, north = date_of(site), as_typed(site.north_offset)
    day = date.timetuple().tm_yday
    if site.sun_link == "READ":
        light = sun_light.chosen(site)
        if light is None:
            raise refuse(rpt_("There is no Sun light to read: choose one in Site & Time, or set Sun Light to Apart"))
        altitude, azimuth = sun_light.read(light)
        return SunPlace(altitude, (azimuth - north) % 360.0, azimuth, day)
    midnight = dt.datetime(date.year, date.month, date.day, tzinfo=dt.UTC)
    latitude, longitude, hour = as_typed(site.latitude), as_typed(site.longitude), as_typed(site.hour)
    if site.time_kind == "CLOCK":
        when = midnight + dt.timedelta(hours=hour - as_typed(site.time_zone))
        altitude, azimuth = sun.sun_position(latitude, longitude, when)
    else:
        when = midnight + dt.timedelta(hours=hour - longitude / 15.0)
        altitude, azimuth = sun.sun_position_solar(latitude, sun.declination(when), hour)
    return SunPlace(altitude, azimuth, (azimuth + north) % 360.0, day)


def date_of(site: bpy.types.PropertyGroup) -> dt.date:
    """Return the date of the settings; raises `BadInput` where there is none such."""
    try:
        return dt.date(site.year, site.month, site.day) + dt.timedelta(days=site.days_later)
    except ValueError:
        text = rpt_("There is no day {day} in month {month} of {year}: set another date")
        raise refuse(text.format(day=site.day, month=site.month, year=site.year)) from None


def sunrise_sunset(site: bpy.types.PropertyGroup) -> tuple[float | None, float | None]:
    """Return the hours of sunrise and sunset in the site's kind of time; None where the Sun does not rise or set."""
    longitude = as_typed(site.longitude)
    events = sun.sunrise_sunset(as_typed(site.latitude), longitude, date_of(site))
    return tuple(None if event is None else _hour_of(event, site, longitude) for event in events)


def _hour_of(instant: dt.datetime, site: bpy.types.PropertyGroup, longitude: float) -> float:
    if site.time_kind == "SOLAR":
        return sun.solar_time(longitude, instant)
    utc = instant.hour + instant.minute / 60.0 + instant.second / 3600.0
    return (utc + as_typed(site.time_zone)) % 24.0


def daylight(scene: bpy.types.Scene) -> tuple[luz.Daylight, list[Notice]]:
    """Return the light that a scene's settings describe, and what the user should know about it.

    The Sun below the horizon is no error: there is then no sunlight, and sky light as far as there is any.

    Raises
    ------
    BadInput
        Where the settings describe no light that can be computed.
    """
    settings = scene.luzespecular
    place = sun_place(settings.site)
    notices = []
    if not place.is_up and settings.sky.use_sun:
        text = rpt_("The Sun is below the horizon ({altitude:.1f}°): there is no sunlight, only the sky is solved")
        notices.append(Notice("INFO", text.format(altitude=place.altitude)))
    try:
        return _daylight(settings.sky, place), notices
    except luz.SceneError as error:
        raise refuse(solver_message(error)) from error


def illuminances(sky: bpy.types.PropertyGroup, place: SunPlace) -> tuple[float, float]:
    """Return what sky settings come to with the Sun at a place.

    Returns
    -------
    sky, sun : float
        By the sky on an open horizontal plane, by the Sun on the plane that faces it [lx]; 0 where there is none.
    """
    if sky.illuminance_from == "MODEL":
        by_sun, by_sky = luz.availability(_condition(sky), place.altitude, place.day_of_year)
    else:
        by_sky, by_sun = as_typed(sky.horizontal_illuminance), as_typed(sky.sun_illuminance)
    shines = sky.use_sun and place.is_up and sky.kind != "OVERCAST"
    return (0.0 if sky.kind == "NONE" else by_sky), (by_sun if shines else 0.0)


def _condition(sky: bpy.types.PropertyGroup) -> str:
    """Return the condition of the availability model that a sky belongs to (CIE types by the standard's own groups)."""
    if sky.kind in _CIE_TYPES:
        return sky.kind.lower()
    if sky.kind == "NONE":
        return "clear"
    number = int(sky.cie_type)
    return "overcast" if number <= 5 or number == 16 else "intermediate" if number <= 10 else "clear"


def _daylight(sky: bpy.types.PropertyGroup, place: SunPlace) -> luz.Daylight:
    by_sky, by_sun = illuminances(sky, place)
    given_sky = given_sun = None
    if by_sky > 0.0:
        # At night a given sky keeps the pattern that it has with the Sun on the horizon.
        given_sky = luz.CIESky(
            _CIE_TYPES.get(sky.kind) or int(sky.cie_type),
            sun_altitude=max(place.altitude, 0.0),
            sun_azimuth=place.scene_azimuth,
            horizontal_illuminance=by_sky,
        )
    if by_sun > 0.0:
        given_sun = luz.Sun(
            altitude=place.altitude, azimuth=place.scene_azimuth, normal_illuminance=by_sun, disc=sky.sun_disc
        )
    return luz.Daylight(sky=given_sky, sun=given_sun, ground_reflectance=as_typed(sky.ground_reflectance))
