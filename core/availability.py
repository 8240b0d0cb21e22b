"""Daylight to begin with where nothing was measured: the IES daylight availability model.

Gillette, Pierpoint & Treado 1984, "A general illuminance model for daylight availability", Journal of the IES
13(4), and the IES *Recommended practice for the calculation of daylight availability* (RP-21), same volume. Mean
illuminances of three conditions from date and solar altitude; single moments may differ by a factor of two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .checks import checked_array, checked_number
from .daylight import Daylight
from .errors import SceneError
from .sky_cie import TRADITIONAL_OVERCAST, CIESky
from .sun import Sun

SOLAR_ILLUMINANCE = 127_500.0  # lx on the plane that faces the Sun, outside the atmosphere, at its mean distance


class _Condition(NamedTuple):
    extinction: float  # per air mass; infinite: no Sun comes through
    constant: float  # A of the horizontal sky illuminance A + B·sin^C [lx]
    factor: float  # B [lx]
    exponent: float  # C
    cie_sky: int


# RP-21, tables of constants. The skies are those whose luminance distribution RP-21 uses with these illuminances:
# its clear sky (Kittler) is CIE type 12 exactly, its overcast sky (Moon & Spencer) type 16; of Pierpoint's partly
# cloudy sky type 10 is the nearest (relative RMS difference 0.41 over solar altitudes 10° to 70°; type 7 is next
# with 0.53).
_CONDITIONS = {
    "clear": _Condition(0.21, 800.0, 15_500.0, 0.5, 12),
    "partly cloudy": _Condition(0.80, 300.0, 45_000.0, 1.0, 10),
    "overcast": _Condition(np.inf, 300.0, 21_000.0, 1.0, TRADITIONAL_OVERCAST),
}
_SYNONYMS = {"intermediate": "partly cloudy", "cloudy": "overcast"}
CONDITIONS = tuple(_CONDITIONS)


def extraterrestrial_illuminance(day_of_year=None):
    """Normal illuminance of the Sun outside the atmosphere.

    Parameters
    ----------
    day_of_year : array_like of float, optional
        1 to 366; None (default): at the mean distance of the Sun.

    Returns
    -------
    float or ndarray of float64
        [lx]: 127,500·(1 + 0.034·cos(2π·(J - 2)/365)) (RP-21, eq. 5).

    Raises
    ------
    SceneError
        A day outside 1 to 366, NaN.
    """
    if day_of_year is None:
        return SOLAR_ILLUMINANCE
    day = checked_array(day_of_year, "day_of_year", low=1.0, high=366.0, remedy="1 January is day 1")
    value = SOLAR_ILLUMINANCE * (1 + 0.034 * np.cos(2 * np.pi / 365 * (day - 2)))
    return float(value) if np.ndim(value) == 0 else value


def availability(condition: str, sun_altitude, day_of_year=None):
    """Mean illuminances under a clear, partly cloudy or overcast sky.

    Parameters
    ----------
    condition : str
        ``"clear"``, ``"partly cloudy"`` (also ``"intermediate"``) or ``"overcast"`` (also ``"cloudy"``).
    sun_altitude : array_like of float
        Degrees, -90 to 90.
    day_of_year : array_like of float, optional
        1 to 366, for the Earth's distance from the Sun; None (default): its mean distance.

    Returns
    -------
    direct_normal_illuminance, diffuse_horizontal_illuminance : float or ndarray of float64
        [lx], of the broadcast shape. Both are 0 with the Sun at or below the horizon: the model knows no twilight.

    Raises
    ------
    SceneError
        An unknown condition, an altitude beyond ±90°, a day outside 1 to 366, NaN.

    Notes
    -----
    E_dn = E_ext·exp(-c / sin α); E_dh = A + B·(sin α)^C, with c, A, B, C of the condition (RP-21, eqs. 6 to 10).
    """
    chosen = _CONDITIONS[_condition_name(condition)]
    altitude = checked_array(sun_altitude, "sun_altitude", low=-90.0, high=90.0, remedy="give degrees")
    outside = extraterrestrial_illuminance(day_of_year)
    up = altitude > 0.0
    sine = np.where(up, np.sin(np.radians(altitude)), 1.0)
    direct = np.where(up, outside * np.exp(-chosen.extinction / sine), 0.0)
    diffuse = np.where(up, chosen.constant + chosen.factor * sine**chosen.exponent, 0.0)
    if direct.ndim == 0:
        return float(direct), float(diffuse)
    return direct, np.broadcast_to(diffuse, direct.shape).copy()


def default_daylight(
    condition: str,
    sun_altitude: float,
    sun_azimuth: float,
    day_of_year: float | None = None,
    ground_reflectance: float = 0.2,
) -> Daylight:
    """Sky and Sun of a condition, to begin with where nothing was measured.

    Parameters
    ----------
    condition, sun_altitude, day_of_year
        As in :func:`availability`, single values.
    sun_azimuth : float
        Degrees clockwise from north.
    ground_reflectance : float, optional
        0.2 by default, grass or bare soil.

    Returns
    -------
    Daylight
        The sky is CIE type 12 (clear), 10 (partly cloudy) or 16 (overcast), the distributions that belong to the
        model or are nearest to its own; the Sun is None where none comes through. With the Sun at or below the
        horizon there is neither.

    Raises
    ------
    SceneError
        As :func:`availability`.
    """
    kind = _CONDITIONS[_condition_name(condition)].cie_sky
    altitude = checked_number(sun_altitude, "sun_altitude", low=-90.0, high=90.0, remedy="give degrees")
    azimuth = checked_number(sun_azimuth, "sun_azimuth", remedy="give degrees clockwise from north")
    if day_of_year is not None:
        day_of_year = checked_number(day_of_year, "day_of_year", low=1.0, high=366.0, remedy="1 January is day 1")
    direct, diffuse = availability(condition, altitude, day_of_year)
    sky = sun = None
    if diffuse > 0.0:
        sky = CIESky(kind, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=diffuse)
    if direct > 0.0:
        sun = Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=direct)
    return Daylight(sky=sky, sun=sun, ground_reflectance=ground_reflectance)


def _condition_name(condition) -> str:
    name = condition.strip().lower().replace("_", " ") if isinstance(condition, str) else condition
    name = _SYNONYMS.get(name, name) if isinstance(name, str) else name
    if not isinstance(name, str) or name not in _CONDITIONS:
        raise SceneError(f"unknown sky condition {condition!r}; choose one of {', '.join(map(repr, CONDITIONS))}")
    return name
