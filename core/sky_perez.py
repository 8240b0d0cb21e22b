"""The all-weather sky of Perez from measured irradiances.

Perez, Ineichen, Seals, Michalsky & Stewart 1990, "Modeling daylight availability and irradiance components from
direct and global irradiance", Solar Energy 44(5): sky clearness, brightness and luminous efficacies. Perez, Seals &
Michalsky 1993, "All-weather model for sky luminance distribution", Solar Energy 50(3), erratum 51(5): the
distribution.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .checks import checked_number
from .errors import SceneError
from .sky_model import Sky, horizontal_integral, unit_directions
from .sun import direction_of

SOLAR_IRRADIANCE = 1367.0  # W/m² at the Earth's mean distance: the constant of the model's time, kept with its fits
LOWEST_SINE = 0.01  # the gradation is constant below an altitude of 0.57°, where its exponent has no limit

# Sky clearness at which each class after the first begins (1990, table 1).
_CLASS_LIMITS = np.array([1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200])
_CLEARNESS_RANGE = (1.0, 12.0)
_BRIGHTNESS_RANGE = (0.01, 0.6)

# 1993, table 1: for each class and each of a, b, c, d, e the numbers x1 to x4.
_COEFFICIENTS = np.array(
    [
        [
            [1.3525, -0.2576, -0.2690, -1.4366],
            [-0.7670, 0.0007, 1.2734, -0.1233],
            [2.8000, 0.6004, 1.2375, 1.0000],
            [1.8734, 0.6297, 0.9738, 0.2809],
            [0.0356, -0.1246, -0.5718, 0.9938],
        ],
        [
            [-1.2219, -0.7730, 1.4148, 1.1016],
            [-0.2054, 0.0367, -3.9128, 0.9156],
            [6.9750, 0.1774, 6.4477, -0.1239],
            [-1.5798, -0.5081, -1.7812, 0.1080],
            [0.2624, 0.0672, -0.2190, -0.4285],
        ],
        [
            [-1.1000, -0.2515, 0.8952, 0.0156],
            [0.2782, -0.1812, -4.5000, 1.1766],
            [24.7219, -13.0812, -37.7000, 34.8438],
            [-5.0000, 1.5218, 3.9229, -2.6204],
            [-0.0156, 0.1597, 0.4199, -0.5562],
        ],
        [
            [-0.5484, -0.6654, -0.2672, 0.7117],
            [0.7234, -0.6219, -5.6812, 2.6297],
            [33.3389, -18.3000, -62.2500, 52.0781],
            [-3.5000, 0.0016, 1.1477, 0.1062],
            [0.4659, -0.3296, -0.0876, -0.0329],
        ],
        [
            [-0.6000, -0.3566, -2.5000, 2.3250],
            [0.2937, 0.0496, -5.6812, 1.8415],
            [21.0000, -4.7656, -21.5906, 7.2492],
            [-3.5000, -0.1554, 1.4062, 0.3988],
            [0.0032, 0.0766, -0.0656, -0.1294],
        ],
        [
            [-1.0156, -0.3670, 1.0078, 1.4051],
            [0.2875, -0.5328, -3.8500, 3.3750],
            [14.0000, -0.9999, -7.1406, 7.5469],
            [-3.4000, -0.1078, -1.0750, 1.5702],
            [-0.0672, 0.4016, 0.3017, -0.4844],
        ],
        [
            [-1.0000, 0.0211, 0.5025, -0.5119],
            [-0.3000, 0.1922, 0.7023, -1.6317],
            [19.0000, -5.0000, 1.2438, -1.9094],
            [-4.0000, 0.0250, 0.3844, 0.2656],
            [1.0468, -0.3788, -2.4517, 1.4656],
        ],
        [
            [-1.0500, 0.0289, 0.4260, 0.3590],
            [-0.3250, 0.1156, 0.7781, 0.0025],
            [31.0625, -14.5000, -46.1148, 55.3750],
            [-7.2312, 0.4050, 13.3500, 0.6234],
            [1.5000, -0.6426, 1.8564, 0.5636],
        ],
    ]
)

# 1990, table 4: luminous efficacies by class; diffuse a + b·W + c·cos Z + d·ln Δ, direct a + b·W + c·exp(5.73 Z -
# 5) + d·Δ.
_DIFFUSE_EFFICACY = (
    (97.24, -0.46, 12.00, -8.91),
    (107.22, 1.15, 0.59, -3.95),
    (104.97, 2.96, -5.53, -8.77),
    (102.39, 5.59, -13.95, -13.90),
    (100.71, 5.94, -22.75, -23.74),
    (106.42, 3.83, -36.15, -28.83),
    (141.88, 1.90, -53.24, -14.03),
    (152.23, 0.35, -45.27, -7.98),
)
_DIRECT_EFFICACY = (
    (57.20, -4.55, -2.98, 117.12),
    (98.99, -3.46, -1.21, 12.38),
    (109.83, -4.90, -1.71, -8.81),
    (110.34, -5.84, -1.99, -4.56),
    (106.36, -3.97, -1.75, -6.16),
    (107.19, -1.25, -1.51, -26.73),
    (105.75, 0.77, -1.26, -34.44),
    (101.18, 1.58, -1.10, -8.29),
)


@dataclass(frozen=True, kw_only=True)
class PerezSky(Sky):
    """The Perez all-weather sky from direct and diffuse irradiance, as weather files give them.

    Parameters
    ----------
    direct_normal_irradiance : float
        Beam irradiance on the plane that faces the Sun [W/m²], 0 or more.
    diffuse_horizontal_irradiance : float
        [W/m²], above 0.
    sun_altitude, sun_azimuth : float
        Degrees, altitude 0 to 90, azimuth clockwise from north.
    day_of_year : float, optional
        1 to 366, for the Earth's distance from the Sun; None (default): its mean distance.
    extraterrestrial_irradiance : float, optional
        Normal irradiance outside the atmosphere [W/m²], where it is known better than by `day_of_year`.
    dew_point : float, optional
        Dew point at the ground [°C], for the water in the air; 11 °C by default (2 cm of precipitable water).
    horizontal_illuminance : float, optional
        Scale: unobstructed diffuse illuminance [lx], where it was measured; None (default): by the model's luminous
        efficacy. Afterwards the attribute holds the value.

    Attributes
    ----------
    clearness, brightness : float
        ε and Δ of the model, before they are brought into its range.
    coefficients : tuple of 5 float
        a, b, c, d, e of the distribution, as used.
    direct_normal_illuminance : float
        Illuminance of the beam by the model's direct luminous efficacy [lx]: what :class:`~.sun.Sun` wants.

    Raises
    ------
    SceneError
        A Sun below the horizon, no diffuse irradiance, a negative one, NaN.

    Notes
    -----
    L ∝ (1 + a·exp(b / sin γ))·(1 + c·exp(d·χ) + e·cos² χ), γ the altitude of the direction and χ its angle from the
    Sun. ε is limited to 1 to 12, Δ to 0.01 to 0.6, and for ε from 1.065 to 2.8 to 0.2 at least (Perez et al. 1993).
    sin γ counts as 0.01 at least. Two rules are ours, for weather far from the model's own data: the gradation is left
    out (a = b = 0) where b is not negative, since all light would then gather in the last degree over the horizon, as
    with a clear Sun below 5°, and where the zenith would be dark; a negative second factor counts as 0.
    """

    direct_normal_irradiance: float
    diffuse_horizontal_irradiance: float
    sun_altitude: float
    sun_azimuth: float
    day_of_year: float | None = None
    extraterrestrial_irradiance: float | None = None
    dew_point: float = 11.0
    horizontal_illuminance: float = None  # type: ignore[assignment]  # filled in by __post_init__
    clearness: float = field(init=False, compare=False)
    brightness: float = field(init=False, compare=False)
    coefficients: tuple[float, ...] = field(init=False, compare=False)
    direct_normal_illuminance: float = field(init=False, compare=False)
    _scale: float = field(init=False, compare=False, repr=False)

    def __post_init__(self):
        self._check()
        zenith_angle = np.radians(90.0 - self.sun_altitude)
        direct, diffuse = self.direct_normal_irradiance, self.diffuse_horizontal_irradiance
        clearness = sky_clearness(direct, diffuse, zenith_angle)
        brightness = sky_brightness(diffuse, zenith_angle, self._outside_irradiance())
        water = precipitable_water(self.dew_point)
        coefficients = _with_sound_gradation(perez_coefficients(clearness, brightness, zenith_angle))
        if self.horizontal_illuminance is None:
            horizontal = diffuse * diffuse_efficacy(clearness, brightness, zenith_angle, water)
        else:
            horizontal = self.horizontal_illuminance
        relative = _relative_horizontal_illuminance(coefficients, self.sun_altitude)
        for name, value in (
            ("horizontal_illuminance", horizontal),
            ("clearness", clearness),
            ("brightness", brightness),
            ("coefficients", coefficients),
            ("direct_normal_illuminance", direct * direct_efficacy(clearness, brightness, zenith_angle, water)),
            ("_scale", horizontal / relative),
        ):
            object.__setattr__(self, name, value)

    def luminance(self, directions) -> np.ndarray:
        """Luminance [cd/m²] of unit vectors (..., 3); 0 at and below the horizon."""
        directions = unit_directions(directions)
        sines = directions[..., 2]
        towards_sun = directions @ direction_of(self.sun_altitude, self.sun_azimuth)
        angles = np.arccos(np.clip(towards_sun, -1.0, 1.0))
        values = _gradation(self.coefficients, sines) * _indicatrix(self.coefficients, angles)
        return np.where(sines > 0.0, values * self._scale, 0.0)

    def _check(self) -> None:
        limits = {
            "direct_normal_irradiance": (0.0, np.inf, "give W/m²"),
            "diffuse_horizontal_irradiance": (0.0, np.inf, "give W/m²"),
            "sun_altitude": (0.0, 90.0, "the model ends at the horizon; leave the sky out at night"),
            "sun_azimuth": (-np.inf, np.inf, "give degrees clockwise from north"),
            "day_of_year": (1.0, 366.0, "or leave it out for the mean distance of the Sun"),
            "extraterrestrial_irradiance": (0.0, np.inf, "about 1367 W/m²"),
            "dew_point": (-90.0, 60.0, "give °C"),
            "horizontal_illuminance": (0.0, np.inf, "give lx, or leave it out"),
        }
        for name, (low, high, remedy) in limits.items():
            value = getattr(self, name)
            if value is None and name in ("day_of_year", "extraterrestrial_irradiance", "horizontal_illuminance"):
                continue
            object.__setattr__(
                self, name, checked_number(value, f"PerezSky: {name}", low=low, high=high, remedy=remedy)
            )
        if self.diffuse_horizontal_irradiance == 0.0:
            raise SceneError(
                "PerezSky: diffuse_horizontal_irradiance is 0; without it there is no sky: leave the sky out"
            )
        if self.extraterrestrial_irradiance == 0.0:
            raise SceneError("PerezSky: extraterrestrial_irradiance is 0; it is about 1367 W/m²")
        if self.day_of_year is not None and self.extraterrestrial_irradiance is not None:
            raise SceneError("PerezSky: both day_of_year and extraterrestrial_irradiance given; give one of them")

    def _outside_irradiance(self) -> float:
        if self.extraterrestrial_irradiance is not None:
            return self.extraterrestrial_irradiance
        return SOLAR_IRRADIANCE * (1.0 if self.day_of_year is None else distance_factor(self.day_of_year))


def distance_factor(day_of_year: float) -> float:
    """Square of mean over actual distance of the Sun (Spencer 1971)."""
    angle = 2 * np.pi * (day_of_year - 1) / 365
    return float(
        1.00011
        + 0.034221 * np.cos(angle)
        + 0.00128 * np.sin(angle)
        + 0.000719 * np.cos(2 * angle)
        + 0.000077 * np.sin(2 * angle)
    )


def sky_clearness(direct: float, diffuse: float, zenith_angle: float) -> float:
    """ε of Perez et al. (1990), eq. 1, from normal direct, horizontal diffuse irradiance and zenith angle [rad]."""
    damping = 1.041 * zenith_angle**3
    return float(((diffuse + direct) / diffuse + damping) / (1 + damping))


def sky_brightness(diffuse: float, zenith_angle: float, extraterrestrial: float) -> float:
    """Δ of Perez et al. (1990), eq. 2, with the air mass of Kasten (1966); irradiances in W/m², zenith angle in rad."""
    air_mass = 1 / (np.cos(zenith_angle) + 0.15 * (93.885 - np.degrees(zenith_angle)) ** -1.253)
    return float(diffuse * air_mass / extraterrestrial)


def precipitable_water(dew_point: float) -> float:
    """Water in the air [cm] from the dew point [°C] (Wright, Perez & Michalsky 1989)."""
    return float(np.exp(0.07 * dew_point - 0.075))


def diffuse_efficacy(clearness: float, brightness: float, zenith_angle: float, water: float) -> float:
    """Luminous efficacy of the diffuse irradiance [lm/W]: Perez et al. (1990), eq. 7."""
    a, b, c, d = _DIFFUSE_EFFICACY[_clearness_class(clearness)]
    return float(a + b * water + c * np.cos(zenith_angle) + d * np.log(np.clip(brightness, *_BRIGHTNESS_RANGE)))


def direct_efficacy(clearness: float, brightness: float, zenith_angle: float, water: float) -> float:
    """Luminous efficacy of the beam [lm/W], 0 or more: Perez et al. (1990), eq. 8."""
    a, b, c, d = _DIRECT_EFFICACY[_clearness_class(clearness)]
    value = a + b * water + c * np.exp(5.73 * zenith_angle - 5) + d * np.clip(brightness, *_BRIGHTNESS_RANGE)
    return float(max(value, 0.0))


def perez_coefficients(
    clearness: float, brightness: float, zenith_angle: float
) -> tuple[float, float, float, float, float]:
    """Coefficients of the relative luminance distribution: Perez et al. (1993), eqs. 6 to 8.

    Parameters
    ----------
    clearness, brightness : float
        ε and Δ; limited to the model's range.
    zenith_angle : float
        Of the Sun [rad].

    Returns
    -------
    a, b, c, d, e : float
    """
    brightness = float(np.clip(brightness, *_BRIGHTNESS_RANGE))
    if 1.065 < clearness < 2.8:
        brightness = max(brightness, 0.2)
    chosen = _clearness_class(clearness)
    x1, x2, x3, x4 = _COEFFICIENTS[chosen].T
    a, b, c, d, e = (x1 + x2 * zenith_angle + brightness * (x3 + x4 * zenith_angle)).tolist()
    if chosen == 0:
        c = float(np.exp((brightness * (x1[2] + x2[2] * zenith_angle)) ** x3[2]) - x4[2])
        d = float(-np.exp(brightness * (x1[3] + x2[3] * zenith_angle)) + x3[3] + brightness * x4[3])
    return a, b, c, d, e


def _clearness_class(clearness: float) -> int:
    return int(np.searchsorted(_CLASS_LIMITS, np.clip(clearness, *_CLEARNESS_RANGE), side="right"))


def _with_sound_gradation(coefficients: tuple[float, ...]) -> tuple[float, ...]:
    """The coefficients; a and b 0 where the gradation would run away at the horizon or make the zenith dark."""
    a, b, *of_indicatrix = coefficients
    sound = b < 0 and 1 + a * np.exp(b) > 0
    return (a if sound else 0.0, b if sound else 0.0, *of_indicatrix)


def _gradation(coefficients, sines: np.ndarray) -> np.ndarray:
    a, b = coefficients[:2]
    return 1 + a * np.exp(b / np.maximum(sines, LOWEST_SINE))


def _indicatrix(coefficients, angles: np.ndarray) -> np.ndarray:
    c, d, e = coefficients[2:]
    return np.maximum(1 + c * np.exp(d * angles) + e * np.cos(angles) ** 2, 0.0)


def _relative_horizontal_illuminance(coefficients, sun_altitude: float) -> float:
    """Integral of the relative distribution over the upper hemisphere, weighted by the sine of the altitude [sr]."""
    angles = np.linspace(0.0, np.pi, 361)
    c, d, e = coefficients[2:]
    signs = np.sign(1 + c * np.exp(d * angles) + e * np.cos(angles) ** 2)
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    zeros = tuple(_bisected(coefficients, angles[i], angles[i + 1]) for i in changes)
    return horizontal_integral(
        lambda sines: _gradation(coefficients, sines),
        lambda chi: _indicatrix(coefficients, chi),
        sun_altitude,
        gradation_breaks=(LOWEST_SINE,),
        indicatrix_breaks=zeros,
    )


def _bisected(coefficients, low: float, high: float) -> float:
    """Angle between `low` and `high` at which the indicatrix leaves 0."""
    positive_at_low = _indicatrix(coefficients, np.array(low)) > 0
    for _ in range(50):
        middle = (low + high) / 2
        if (_indicatrix(coefficients, np.array(middle)) > 0) == positive_at_low:
            low = middle
        else:
            high = middle
    return (low + high) / 2
