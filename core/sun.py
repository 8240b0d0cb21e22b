"""The Sun: as a light, and where it stands by place and time.

Azimuths run clockwise from north, directions are (east, north, up) and point to the Sun; degrees outside, radians
inside.
"""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .checks import checked_array, checked_number
from .disc import moments_above
from .ephemeris import apparent_sun
from .errors import SceneError

HORIZONTAL_PARALLAX = 8.794 / 3600  # degrees, at 1 au
SUNRISE_ALTITUDE = -0.8333  # degrees: upper limb, 34' of refraction and 16' of semi-diameter
_J2000 = np.datetime64("2000-01-01T12:00:00", "us")
_MICROSECONDS_PER_DAY = 86_400e6


@dataclass(frozen=True, kw_only=True)
class Sun:
    """The Sun as a light: a direction and the illuminance on the plane that faces it.

    Parameters
    ----------
    altitude, azimuth : float, optional
        Where it stands [degrees]: altitude above the horizon, -90 to 90, and azimuth clockwise from north.
    normal_illuminance : float
        Illuminance on a plane perpendicular to its rays [lx], 0 or more.
    direction : (3,) array_like of float, optional
        Vector (east, north, up) that points to the Sun, of any length but zero; instead of altitude and azimuth.
    disc : bool, optional
        False (default): all rays parallel, sharp patches. True: an even disc of :attr:`ANGULAR_DIAMETER`, with
        penumbrae; `normal_illuminance` is still on the plane that faces it, the whole disc in view.

    Attributes
    ----------
    direction : tuple of 3 float
        Unit vector to the Sun, whichever way it was given.
    altitude, azimuth : float
        The same in degrees, azimuth in [0, 360).

    Raises
    ------
    SceneError
        No direction or two different ones, a zero vector, NaN, an altitude beyond ±90°, a negative illuminance.

    Notes
    -----
    At or below the horizon it gives nothing: see :attr:`is_up`. Of a disc that the horizon cuts, the part above counts.
    """

    ANGULAR_DIAMETER: ClassVar[float] = 0.533  #: [degrees], mean over the year

    # None until __post_init__ has filled in what was not given
    altitude: float = None  # type: ignore[assignment]
    azimuth: float = None  # type: ignore[assignment]
    normal_illuminance: float
    direction: tuple[float, float, float] = None  # type: ignore[assignment]
    disc: bool = False

    def __post_init__(self):
        illuminance = checked_number(
            self.normal_illuminance,
            "Sun: normal_illuminance",
            low=0.0,
            remedy="give lux on the plane that faces the Sun",
        )
        if not isinstance(self.disc, bool | np.bool_):
            raise SceneError(f"Sun: disc must be True or False, not {self.disc!r}")
        altitude, azimuth, direction = _sun_direction(self.altitude, self.azimuth, self.direction)
        for name, value in (
            ("altitude", altitude),
            ("azimuth", azimuth),
            ("normal_illuminance", illuminance),
            ("direction", direction),
            ("disc", bool(self.disc)),
        ):
            object.__setattr__(self, name, value)

    @property
    def is_up(self) -> bool:
        """Whether the Sun stands above the horizon, with ``disc`` any of it; on the horizon it does not."""
        return bool(self.disc_horizon < 1.0) if self.disc else self.direction[2] > 0.0

    @property
    def horizontal_illuminance(self) -> float:
        """Illuminance on the unobstructed horizontal plane [lx]; 0 at or below the horizon."""
        if self.disc and self.disc_horizon > -1.0:
            return self.normal_illuminance * float(moments_above(self.disc_horizon) @ self.disc_axes[:, 2])
        return self.normal_illuminance * max(self.direction[2], 0.0)

    @property
    def disc_axes(self) -> np.ndarray:
        """(3, 3) float: direction of the disc's centre, a level radius of its tangent plane and a rising one."""
        centre = np.asarray(self.direction)
        level = np.array([-centre[1], centre[0], 0.0])
        length = float(np.linalg.norm(level))
        level = level / length if length > 0 else np.array([1.0, 0.0, 0.0])
        radius = np.tan(np.radians(0.5 * self.ANGULAR_DIAMETER))
        rising = [-centre[2] * level[1], centre[2] * level[0], length]
        return np.stack([centre, radius * level, np.multiply(radius, rising)])

    @property
    def disc_horizon(self) -> float:
        """Height of the horizon on the disc in radii above its centre, -1 (all of the disc is up) to 1 (none)."""
        _, _, (_, _, rise) = self.disc_axes
        height = self.direction[2]
        return -1.0 if height >= rise else min(1.0, -height / rise) if rise > 0 else 1.0


def direction_of(altitude, azimuth) -> np.ndarray:
    """Unit vectors (east, north, up) of altitudes and azimuths.

    Parameters
    ----------
    altitude, azimuth : array_like of float
        Degrees, azimuth clockwise from north; broadcast against each other.

    Returns
    -------
    ndarray of float64
        Of the broadcast shape and a last axis of 3.
    """
    altitude, azimuth = np.broadcast_arrays(np.radians(altitude), np.radians(azimuth))
    horizontal = np.cos(altitude)
    return np.stack((horizontal * np.sin(azimuth), horizontal * np.cos(azimuth), np.sin(altitude)), axis=-1)


def angles_of(directions) -> tuple[np.ndarray, np.ndarray]:
    """Altitudes and azimuths [degrees] of vectors (..., 3) of any length; azimuth 0 to 360, 0 at zenith and nadir."""
    east, north, up = np.moveaxis(np.asarray(directions, dtype=np.float64), -1, 0)
    horizontal = np.hypot(east, north)
    azimuth = np.where(horizontal > 0, np.degrees(np.arctan2(east, north)), 0.0)
    return np.degrees(np.arctan2(up, horizontal)), _turn(azimuth)


def sun_position(latitude, longitude, when, *, refraction: bool = False):
    """Altitude and azimuth of the Sun's centre for a place and an instant.

    Parameters
    ----------
    latitude, longitude : array_like of float
        Geographic degrees, north and east positive; broadcast against `when`.
    when : datetime, numpy.datetime64, or sequence of these
        The instant. A ``datetime`` needs a time zone; ``datetime64`` is UTC.
    refraction : bool, optional
        False (default): the true altitude. True: the apparent one under a standard atmosphere (1013.25 hPa, 15 °C).

    Returns
    -------
    altitude, azimuth : float or ndarray of float64
        Degrees, azimuth clockwise from north; numbers for a single place and instant, else the broadcast shape. At
        the poles azimuth counts from the meridian of `longitude`.

    Raises
    ------
    SceneError
        A latitude beyond ±90°, NaN, a ``datetime`` without time zone, something that is no time.

    Notes
    -----
    Topocentric (parallax included), within 0.002° from 1900 to 2100; UTC is taken for UT1. The place by truncated
    VSOP87 (:mod:`.ephemeris`), refraction by Reda & Andreas (2004), eq. 42.
    """
    days = _days_since_2000(when)
    latitude, longitude = _place(latitude, longitude)
    sun = apparent_sun(days)
    altitude, azimuth = _horizontal(
        np.radians(latitude), sun.declination, sun.greenwich_hour_angle + np.radians(longitude)
    )
    altitude = altitude - HORIZONTAL_PARALLAX / sun.distance * np.cos(np.radians(altitude))
    if refraction:
        altitude = altitude + _refraction(altitude)
    return _like_input(altitude), _like_input(azimuth)


def sun_position_solar(latitude, declination, solar_time):
    """Altitude and azimuth of the Sun from its declination and the apparent solar time.

    Parameters
    ----------
    latitude, declination : array_like of float
        Degrees, north positive.
    solar_time : array_like of float
        Apparent solar time [h]; 12 is the Sun's passage over the meridian. Beyond 0 to 24 it counts on into other days.

    Returns
    -------
    altitude, azimuth : float or ndarray of float64
        Degrees, azimuth clockwise from north; numbers where all inputs are, else the broadcast shape. At the poles the
        altitude is the declination (its negative in the south) and azimuth counts as just beside the pole.

    Raises
    ------
    SceneError
        Latitude or declination beyond ±90°, or NaN.
    """
    latitude = checked_array(latitude, "latitude", low=-90.0, high=90.0, remedy="give degrees, north positive")
    declination = checked_array(
        declination, "declination", low=-90.0, high=90.0, remedy="the Sun's lies within ±23.45°"
    )
    solar_time = checked_array(solar_time, "solar_time", remedy="give hours, 12 at noon")
    hour_angle = np.radians(15.0 * (solar_time - 12.0))
    altitude, azimuth = _horizontal(np.radians(latitude), np.radians(declination), hour_angle)
    return _like_input(altitude), _like_input(azimuth)


def declination(when):
    """Apparent declination of the Sun [degrees] at `when` (as in :func:`sun_position`); float or ndarray."""
    return _like_input(np.degrees(apparent_sun(_days_since_2000(when)).declination))


def equation_of_time(when):
    """Apparent minus mean solar time [minutes] at `when` (as in :func:`sun_position`); float or ndarray."""
    days = _days_since_2000(when)
    return _like_input(_equation_of_time(days, apparent_sun(days).greenwich_hour_angle))


def solar_time(longitude, when):
    """Apparent solar time [h], 0 to 24, at a longitude [degrees, east positive] and `when` of :func:`sun_position`."""
    days = _days_since_2000(when)
    longitude = checked_array(longitude, "longitude", low=-360.0, high=360.0, remedy="give degrees, east positive")
    hour_angle = np.degrees(apparent_sun(days).greenwich_hour_angle) + longitude
    return _like_input(np.mod(hour_angle / 15.0 + 12.0, 24.0))


def sunrise_sunset(
    latitude: float, longitude: float, date: dt.date, *, altitude: float = SUNRISE_ALTITUDE
) -> tuple[dt.datetime | None, dt.datetime | None]:
    """Rise and set of the Sun in the solar day whose noon falls on `date`.

    Parameters
    ----------
    latitude, longitude : float
        Geographic degrees, north and east positive.
    date : datetime.date
        The day in local mean solar time, so that sunrise comes first wherever the place is.
    altitude : float, optional
        True altitude of the Sun's centre that counts as rising or setting [degrees]; the default is the moment when the
        upper limb shows at a sea-level horizon; -6, -12, -18 give the twilights, 0 the moment from which the Sun
        gives light here.

    Returns
    -------
    sunrise, sunset : datetime in UTC, or None
        None where the Sun does not cross that altitude: polar night, or midnight sun.

    Raises
    ------
    SceneError
        A latitude beyond ±90°, NaN, or a date that is none.
    """
    latitude = np.radians(
        checked_number(latitude, "latitude", low=-90.0, high=90.0, remedy="give degrees, north positive")
    )
    longitude = checked_number(longitude, "longitude", low=-360.0, high=360.0, remedy="give degrees, east positive")
    altitude = checked_number(altitude, "altitude", low=-90.0, high=90.0)
    crossing = np.radians(altitude + HORIZONTAL_PARALLAX * np.cos(np.radians(altitude)))
    if not isinstance(date, dt.date):
        raise SceneError(f"date must be a datetime.date, not {date!r}; write datetime.date(2024, 6, 21)")
    mean_noon = np.datetime64(dt.datetime(date.year, date.month, date.day, 12), "us") - _as_timedelta(longitude / 360.0)
    return _crossing_time(latitude, crossing, mean_noon, -1), _crossing_time(latitude, crossing, mean_noon, 1)


def _crossing_time(latitude: float, crossing: float, mean_noon: np.datetime64, side: int) -> dt.datetime | None:
    """Instant before (side -1) or after (1) noon when the Sun crosses an altitude [rad], by fixed-point iteration."""
    instant = mean_noon
    for _ in range(6):
        days = _days_since_2000(instant)
        sun = apparent_sun(days)
        delta = float(sun.declination)
        cosine = (np.sin(crossing) - np.sin(latitude) * np.sin(delta)) / (np.cos(latitude) * np.cos(delta))
        half_day = np.arccos(np.clip(cosine, -1.0, 1.0)) / (2 * np.pi)
        minutes = float(_equation_of_time(days, sun.greenwich_hour_angle))
        instant = mean_noon + _as_timedelta(side * half_day - minutes / 1440.0)
    if abs(cosine) > 1.0:
        return None
    return dt.datetime.fromisoformat(str(instant)).replace(tzinfo=dt.UTC)


def _sun_direction(altitude, azimuth, direction) -> tuple[float, float, tuple[float, float, float]]:
    """Altitude, azimuth [degrees] and unit vector, from whichever of them was given."""
    angles_given = altitude is not None or azimuth is not None
    if direction is None and not angles_given:
        raise SceneError("Sun: no direction; give altitude and azimuth in degrees, or direction=(east, north, up)")
    if angles_given:
        if altitude is None or azimuth is None:
            missing = "altitude" if altitude is None else "azimuth"
            raise SceneError(f"Sun: {missing} is missing; give altitude and azimuth together, in degrees")
        altitude = checked_number(
            altitude, "Sun: altitude", low=-90.0, high=90.0, remedy="give degrees above the horizon"
        )
        azimuth = float(_turn(checked_number(azimuth, "Sun: azimuth", remedy="give degrees clockwise from north")))
        by_angles = direction_of(altitude, azimuth)
    if direction is None:
        return altitude, azimuth, tuple(by_angles.tolist())

    vector = checked_array(
        direction, "Sun: direction", remedy="give the vector (east, north, up) that points to the Sun"
    )
    largest = np.abs(vector).max() if vector.shape == (3,) else 0.0
    if largest == 0.0:
        raise SceneError(
            f"Sun: direction {direction!r} points nowhere; give three numbers (east, north, up), not all 0"
        )
    vector = vector / largest  # so that no length over- or underflows
    vector /= np.sqrt(vector @ vector)
    if angles_given:  # both, as dataclasses.replace passes them: welcome while they agree
        if np.abs(vector - by_angles).max() > 1e-9:
            raise SceneError("Sun: direction disagrees with altitude and azimuth; give one of the two")
        return altitude, azimuth, tuple(vector.tolist())
    altitude, azimuth = angles_of(vector)
    return float(altitude), float(azimuth), tuple(vector.tolist())


def _horizontal(latitude, declination, hour_angle) -> tuple[np.ndarray, np.ndarray]:
    """Altitude and azimuth [degrees] from latitude, declination and hour angle [rad], broadcast."""
    east = -np.cos(declination) * np.sin(hour_angle)
    north = np.sin(declination) * np.cos(latitude) - np.cos(declination) * np.cos(hour_angle) * np.sin(latitude)
    up = np.sin(latitude) * np.sin(declination) + np.cos(latitude) * np.cos(declination) * np.cos(hour_angle)
    return angles_of(np.stack(np.broadcast_arrays(east, north, up), axis=-1))


def _equation_of_time(days: np.ndarray, greenwich_hour_angle: np.ndarray) -> np.ndarray:
    mean = 360.0 * np.mod(days, 1.0)  # hour angle of the mean Sun at Greenwich; days count from noon
    return 4.0 * (np.mod(np.degrees(greenwich_hour_angle) - mean + 180.0, 360.0) - 180.0)


def _refraction(altitude: np.ndarray) -> np.ndarray:
    """Refraction [degrees] at a true altitude [degrees]; none where even the upper limb stays hidden."""
    visible = altitude >= SUNRISE_ALTITUDE
    safe = np.where(visible, altitude, 0.0)
    angle = np.radians(safe + 10.3 / (safe + 5.11))
    return np.where(visible, (1013.25 / 1010.0) * (283.0 / (273.0 + 15.0)) * 1.02 / (60.0 * np.tan(angle)), 0.0)


def _place(latitude, longitude) -> tuple[np.ndarray, np.ndarray]:
    return (
        checked_array(latitude, "latitude", low=-90.0, high=90.0, remedy="give degrees, north positive"),
        checked_array(longitude, "longitude", low=-360.0, high=360.0, remedy="give degrees, east positive"),
    )


def _days_since_2000(when) -> np.ndarray:
    """Days of universal time since 2000-01-01 12:00, of the shape of `when`."""
    if isinstance(when, list | tuple):
        when = np.array(when, dtype=object) if any(isinstance(item, dt.datetime) for item in when) else np.array(when)
    if isinstance(when, np.ndarray) and when.dtype == object:
        return np.array([_days_since_2000(item) for item in when.ravel()], dtype=np.float64).reshape(when.shape)
    if isinstance(when, dt.datetime):
        if when.utcoffset() is None:
            raise SceneError(
                f"when = {when.isoformat()} has no time zone; give one, e.g. "
                "when.replace(tzinfo=datetime.timezone(datetime.timedelta(hours=-3)))"
            )
        when = np.datetime64(when.astimezone(dt.UTC).replace(tzinfo=None), "us")
    instants = np.asarray(when)
    if instants.dtype.kind != "M":
        raise SceneError(f"when = {when!r} is no instant; give a datetime with a time zone, or numpy.datetime64 in UTC")
    if np.isnat(instants).any():
        raise SceneError("when holds NaT, which is no instant; leave it out")
    return (instants.astype("datetime64[us]") - _J2000).astype(np.int64) / _MICROSECONDS_PER_DAY


def _as_timedelta(days: float) -> np.timedelta64:
    return np.timedelta64(round(days * _MICROSECONDS_PER_DAY), "us")


def _turn(degrees) -> np.ndarray:
    """Degrees reduced to [0, 360)."""
    reduced = np.mod(degrees, 360.0)
    return np.where(reduced >= 360.0, 0.0, reduced)  # a tiny negative angle rounds up to a full turn


def _like_input(values: np.ndarray):
    return float(values) if np.ndim(values) == 0 else values
