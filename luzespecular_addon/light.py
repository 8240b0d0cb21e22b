"""From the settings of a scene to the solver's light: Sun position, sky, Sun and ground."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass, replace

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .. import core as luz
from ..core import sun
from .materials import as_typed
from .notices import Notice, refuse
from .translations import solver_message


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
    """Return where the Sun stands for a scene's site, date and hour.

    Raises
    ------
    BadInput
        Where there is no such date.
    """
    date = date_of(site)
    midnight = dt.datetime(date.year, date.month, date.day, tzinfo=dt.UTC)
    latitude, longitude, hour = as_typed(site.latitude), as_typed(site.longitude), as_typed(site.hour)
    if site.time_kind == "CLOCK":
        when = midnight + dt.timedelta(hours=hour - as_typed(site.time_zone))
        altitude, azimuth = sun.sun_position(latitude, longitude, when)
    else:
        when = midnight + dt.timedelta(hours=hour - longitude / 15.0)
        altitude, azimuth = sun.sun_position_solar(latitude, sun.declination(when), hour)
    return SunPlace(altitude, azimuth, (azimuth + as_typed(site.north_offset)) % 360.0, date.timetuple().tm_yday)


def date_of(site: bpy.types.PropertyGroup) -> dt.date:
    """Return the date of the settings; raises `BadInput` where there is none such."""
    try:
        return dt.date(site.year, site.month, site.day)
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


def _daylight(sky: bpy.types.PropertyGroup, place: SunPlace) -> luz.Daylight:
    ground = as_typed(sky.ground_reflectance)
    if sky.kind in {"CLEAR", "INTERMEDIATE", "OVERCAST"}:
        light = luz.default_daylight(
            sky.kind.lower(),
            place.altitude,
            place.scene_azimuth,
            day_of_year=place.day_of_year,
            ground_reflectance=ground,
        )
        return light if sky.use_sun else replace(light, sun=None)
    return luz.Daylight(sky=_given_sky(sky, place), sun=_given_sun(sky, place), ground_reflectance=ground)


def _given_sky(sky: bpy.types.PropertyGroup, place: SunPlace) -> luz.CIESky | None:
    illuminance = as_typed(sky.horizontal_illuminance)
    if sky.kind == "NONE" or illuminance == 0.0:
        return None
    # At night a given sky keeps the pattern that it has with the Sun on the horizon.
    return luz.CIESky(
        int(sky.cie_type),
        sun_altitude=max(place.altitude, 0.0),
        sun_azimuth=place.scene_azimuth,
        horizontal_illuminance=illuminance,
    )


def _given_sun(sky: bpy.types.PropertyGroup, place: SunPlace) -> luz.Sun | None:
    illuminance = as_typed(sky.sun_illuminance)
    if not sky.use_sun or not place.is_up or illuminance == 0.0:
        return None
    return luz.Sun(altitude=place.altitude, azimuth=place.scene_azimuth, normal_illuminance=illuminance)
