"""The Sun as seen from the Earth's centre: apparent place, distance, sidereal time.

A truncated VSOP87 (Bretagnon & Francou 1988) with nutation and aberration, after J. Meeus, *Astronomical Algorithms*,
2nd ed. 1998, chapters 12, 22 and 25. Within 0.001° of the complete series from 1900 to 2100, the ecliptic latitude
of the Sun (never more than 1.2″) included.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

DAYS_PER_CENTURY = 36525.0
_ARCSECOND = np.pi / (180 * 3600)

# Periodic terms A·cos(B + C·τ), τ in Julian millennia of J2000: A [1e-8 rad, or 1e-8 au], B [rad], C [rad per
# millennium]. Terms of the longitude below 0.5″ and of the distance below 3e-5 au are left out.
_LONGITUDE = (
    (
        (175347046.0, 0.0, 0.0),
        (3341656.0, 4.6692568, 6283.07585),
        (34894.0, 4.6261, 12566.1517),
        (3497.0, 2.7441, 5753.3849),
        (3418.0, 2.8289, 3.5231),
        (3136.0, 3.6277, 77713.7715),
        (2676.0, 4.4181, 7860.4194),
        (2343.0, 6.1352, 3930.2097),
        (1324.0, 0.7425, 11506.7698),
        (1273.0, 2.0371, 529.691),
        (1199.0, 1.1096, 1577.3435),
        (990.0, 5.233, 5884.927),
        (902.0, 2.045, 26.298),
        (857.0, 3.508, 398.149),
        (780.0, 1.179, 5223.694),
        (753.0, 2.533, 5507.553),
        (505.0, 4.583, 18849.228),
        (492.0, 4.205, 775.523),
        (357.0, 2.92, 0.067),
        (317.0, 5.849, 11790.629),
        (284.0, 1.899, 796.298),
        (271.0, 0.315, 10977.079),
        (243.0, 0.345, 5486.778),
    ),
    (
        (628331966747.0, 0.0, 0.0),
        (206059.0, 2.678235, 6283.07585),
        (4303.0, 2.6351, 12566.1517),
        (425.0, 1.59, 3.523),
    ),
    ((52919.0, 0.0, 0.0), (8720.0, 1.0721, 6283.0758), (309.0, 0.867, 12566.152)),
)
_DISTANCE = (
    (
        (100013989.0, 0.0, 0.0),
        (1670700.0, 3.0984635, 6283.07585),
        (13956.0, 3.05525, 12566.1517),
        (3084.0, 5.1985, 77713.7715),
    ),
    ((103019.0, 1.10749, 6283.07585),),
)

# TT - UT1 [s] by year: the polynomials of Espenak & Meeus (2006) every ten years, the observed value for 2020.
# Straight lines between them stay within 2.5 s of those polynomials, which moves the Sun by 0.00003°.
_DELTA_T_YEARS = (1900, 1910, 1920, 1930, 1940, 1950, 1960, 1970, 1980, 1990, 2000, 2010, 2020, 2050, 2100)
_DELTA_T_SECONDS = (-2.8, 10.4, 21.2, 24.1, 24.4, 29.1, 33.1, 40.2, 50.5, 56.9, 63.9, 66.7, 69.4, 93.0, 202.7)


class ApparentSun(NamedTuple):
    """Apparent geocentric place of the Sun; every field has the shape of the instants asked for."""

    declination: np.ndarray  #: [rad]
    greenwich_hour_angle: np.ndarray  #: [rad], westwards from the meridian of Greenwich, not reduced to one turn
    distance: np.ndarray  #: [au]


def apparent_sun(days: np.ndarray) -> ApparentSun:
    """Apparent geocentric place of the Sun.

    Parameters
    ----------
    days : ndarray of float64
        Days of universal time since 2000-01-01 12:00.

    Returns
    -------
    ApparentSun
        Declination and Greenwich hour angle [rad], distance [au], each of the shape of `days`.

    Notes
    -----
    Meeus (1998), eqs. 12.4, 22.2, 25.6 to 25.10; nutation by its four largest terms (chapter 22, good to 0.5″).
    """
    century = (days + delta_t(2000.0 + days / 365.25) / 86400.0) / DAYS_PER_CENTURY
    millennium = century / 10.0
    distance = _series(_DISTANCE, millennium)
    aberration = -20.4898 * _ARCSECOND / distance
    to_fk5 = -0.09033 * _ARCSECOND
    nutation_in_longitude, obliquity = _nutation(century)
    longitude = _series(_LONGITUDE, millennium) + np.pi + to_fk5 + aberration + nutation_in_longitude

    right_ascension = np.arctan2(np.sin(longitude) * np.cos(obliquity), np.cos(longitude))
    declination = np.arcsin(np.sin(longitude) * np.sin(obliquity))
    ut_century = days / DAYS_PER_CENTURY
    mean_sidereal = 280.46061837 + 360.98564736629 * days + 0.000387933 * ut_century**2
    sidereal = np.radians(np.mod(mean_sidereal, 360.0)) + nutation_in_longitude * np.cos(obliquity)
    return ApparentSun(declination, sidereal - right_ascension, distance)


def delta_t(year: np.ndarray) -> np.ndarray:
    """Terrestrial time minus universal time [s] by decimal year; outside 1900 to 2100 that of the nearer end."""
    return np.interp(year, _DELTA_T_YEARS, _DELTA_T_SECONDS)


def _series(powers, millennium: np.ndarray) -> np.ndarray:
    total = np.zeros_like(millennium)
    for exponent, terms in enumerate(powers):
        amplitude, phase, frequency = np.array(terms).T[:, :, None]
        values = (amplitude * np.cos(phase + frequency * millennium.ravel())).sum(axis=0)
        total += values.reshape(millennium.shape) * millennium**exponent
    return total * 1e-8


def _nutation(century: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nutation in longitude and true obliquity of the ecliptic [rad]."""
    node = np.radians(125.04452 - 1934.136261 * century)
    sun = 2 * np.radians(280.4665 + 36000.7698 * century)
    moon = 2 * np.radians(218.3165 + 481267.8813 * century)
    in_longitude = -17.20 * np.sin(node) - 1.32 * np.sin(sun) - 0.23 * np.sin(moon) + 0.21 * np.sin(2 * node)
    in_obliquity = 9.20 * np.cos(node) + 0.57 * np.cos(sun) + 0.10 * np.cos(moon) - 0.09 * np.cos(2 * node)
    mean_obliquity = 84381.448 - 46.8150 * century - 0.00059 * century**2 + 0.001813 * century**3
    return in_longitude * _ARCSECOND, (mean_obliquity + in_obliquity) * _ARCSECOND
