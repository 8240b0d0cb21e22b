"""The standard skies: CIE general sky, types 1 to 15, the traditional overcast sky, and the uniform sky."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .checks import checked_number
from .errors import SceneError
from .sky_model import Sky, horizontal_integral, unit_directions
from .sun import direction_of

TRADITIONAL_OVERCAST = 16

CIE_SKY_NAMES = {
    1: "CIE standard overcast sky, steep gradation towards the zenith, azimuthal uniformity",
    2: "Overcast, steep gradation, slight brightening towards the Sun",
    3: "Overcast, moderate gradation, azimuthal uniformity",
    4: "Overcast, moderate gradation, slight brightening towards the Sun",
    5: "Sky of uniform luminance",
    6: "Partly cloudy, no gradation towards the zenith, slight brightening towards the Sun",
    7: "Partly cloudy, no gradation towards the zenith, brighter circumsolar region",
    8: "Partly cloudy, no gradation towards the zenith, distinct solar corona",
    9: "Partly cloudy, Sun obscured",
    10: "Partly cloudy, brighter circumsolar region",
    11: "White-blue sky, distinct solar corona",
    12: "CIE standard clear sky, low luminance turbidity",
    13: "CIE standard clear sky, polluted atmosphere",
    14: "Cloudless turbid sky, broad solar corona",
    15: "White-blue turbid sky, broad solar corona",
    TRADITIONAL_OVERCAST: "Traditional overcast sky (Moon & Spencer)",
}

# CIE S 011/E:2003 (ISO 15469:2004), table 1: gradation a, b and indicatrix c, d, e.
_PARAMETERS = {
    1: (4.0, -0.70, 0.0, -1.0, 0.00),
    2: (4.0, -0.70, 2.0, -1.5, 0.15),
    3: (1.1, -0.80, 0.0, -1.0, 0.00),
    4: (1.1, -0.80, 2.0, -1.5, 0.15),
    5: (0.0, -1.00, 0.0, -1.0, 0.00),
    6: (0.0, -1.00, 2.0, -1.5, 0.15),
    7: (0.0, -1.00, 5.0, -2.5, 0.30),
    8: (0.0, -1.00, 10.0, -3.0, 0.45),
    9: (-1.0, -0.55, 2.0, -1.5, 0.15),
    10: (-1.0, -0.55, 5.0, -2.5, 0.30),
    11: (-1.0, -0.55, 10.0, -3.0, 0.45),
    12: (-1.0, -0.32, 10.0, -3.0, 0.45),
    13: (-1.0, -0.32, 16.0, -3.0, 0.30),
    14: (-1.0, -0.15, 16.0, -3.0, 0.30),
    15: (-1.0, -0.15, 24.0, -2.8, 0.15),
}
SUNLESS_SKIES = frozenset((1, 3, 5, TRADITIONAL_OVERCAST))


@dataclass(frozen=True)
class CIESky(Sky):
    """A sky of the CIE general sky standard, or the traditional overcast sky.

    Parameters
    ----------
    kind : int
        1 to 15: the types of CIE S 011 (ISO 15469), named in :data:`CIE_SKY_NAMES`; 16: the traditional overcast sky,
        L = Lz·(1 + 2 sin γ)/3 (Moon & Spencer 1942).
    sun_altitude, sun_azimuth : float, optional
        The Sun's altitude, 0 to 90, and azimuth clockwise from north [degrees]. Types 1, 3, 5 and 16 need none and
        ignore them.
    horizontal_illuminance : float, optional
        Scale: diffuse illuminance on the unobstructed horizontal plane, Sun and ground left out [lx].
    zenith_luminance : float, optional
        Scale: luminance of the zenith [cd/m²]. Exactly one of the two scales is given; afterwards both attributes hold
        their value.

    Raises
    ------
    SceneError
        An unknown type, no Sun position where one is needed, a Sun below the horizon (the formula ends there: take
        one of the types that need no Sun, or no sky at night), both scales or neither, a negative value, NaN.

    Notes
    -----
    L(γ, χ) = Lz·φ(γ)·f(χ) / (φ(90°)·f(Zs)), φ = 1 + a·exp(b / sin γ), f = 1 + c·(exp(d·χ) - exp(d·π/2)) + e·cos² χ,
    with γ the altitude of the direction, χ its angle from the Sun and Zs the Sun's zenith angle (CIE S 011/E:2003,
    eqs. 1 to 6). The formula contains no solar disc.
    """

    kind: int
    sun_altitude: float | None = field(default=None, kw_only=True)
    sun_azimuth: float | None = field(default=None, kw_only=True)
    # None until __post_init__ has filled in the one that was not given
    horizontal_illuminance: float = field(default=None, kw_only=True)  # type: ignore[assignment]
    zenith_luminance: float = field(default=None, kw_only=True)  # type: ignore[assignment]

    def __post_init__(self):
        if isinstance(self.kind, bool) or not isinstance(self.kind, int | np.integer) or self.kind not in CIE_SKY_NAMES:
            raise SceneError(
                f"CIESky: unknown type {self.kind!r}; the types are 1 to 15 of CIE S 011 and 16, traditional overcast"
            )
        object.__setattr__(self, "kind", int(self.kind))
        self._check_sun()
        name, value = _only_scale(self)
        value = checked_number(value, f"CIESky: {name}", low=0.0, remedy="0 is a black sky")
        relative = self._relative_horizontal_illuminance()  # of a zenith of 1 cd/m²
        horizontal = name == "horizontal_illuminance"
        object.__setattr__(self, "horizontal_illuminance", value if horizontal else value * relative)
        object.__setattr__(self, "zenith_luminance", value / relative if horizontal else value)

    @property
    def name(self) -> str:
        """What the standard calls this type."""
        return CIE_SKY_NAMES[self.kind]

    @property
    def needs_sun(self) -> bool:
        """Whether the luminances depend on where the Sun stands."""
        return self.kind not in SUNLESS_SKIES

    def luminance(self, directions) -> np.ndarray:
        """Luminance [cd/m²] of unit vectors (..., 3); 0 at and below the horizon."""
        directions = unit_directions(directions)
        sines = directions[..., 2]
        above = sines > 0.0
        values = self._gradation(np.where(above, sines, 1.0))
        if self.needs_sun:
            towards_sun = directions @ direction_of(self.sun_altitude, self.sun_azimuth)
            values *= self._indicatrix(np.arccos(np.clip(towards_sun, -1.0, 1.0)))
        return np.where(above, values * (self.zenith_luminance / self._zenith_value()), 0.0)

    def _check_sun(self) -> None:
        if not self.needs_sun:
            return
        for name in ("sun_altitude", "sun_azimuth"):
            if getattr(self, name) is None:
                raise SceneError(f"CIESky: type {self.kind} needs {name}; give the Sun's position in degrees")
        remedy = "below the horizon take type 1, 3, 5 or 16, or no sky at all"
        altitude = checked_number(self.sun_altitude, "CIESky: sun_altitude", low=0.0, high=90.0, remedy=remedy)
        azimuth = checked_number(self.sun_azimuth, "CIESky: sun_azimuth", remedy="give degrees clockwise from north")
        object.__setattr__(self, "sun_altitude", altitude)
        object.__setattr__(self, "sun_azimuth", azimuth)

    def _gradation(self, sines: np.ndarray) -> np.ndarray:
        if self.kind == TRADITIONAL_OVERCAST:
            return (1 + 2 * sines) / 3
        a, b = _PARAMETERS[self.kind][:2]
        return 1 + a * np.exp(b / sines)

    def _indicatrix(self, angles: np.ndarray) -> np.ndarray:
        c, d, e = _PARAMETERS[self.kind][2:]
        return 1 + c * (np.exp(d * angles) - np.exp(d * np.pi / 2)) + e * np.cos(angles) ** 2

    def _zenith_value(self) -> float:
        """φ(90°)·f(Zs), what the formula gives for the zenith before scaling."""
        gradation = float(self._gradation(np.array(1.0)))
        if self.sun_altitude is None or not self.needs_sun:
            return gradation
        return gradation * float(self._indicatrix(np.array(np.radians(90.0 - self.sun_altitude))))

    def _relative_horizontal_illuminance(self) -> float:
        if self.sun_altitude is None or not self.needs_sun:
            integral = horizontal_integral(self._gradation)
        else:
            integral = horizontal_integral(self._gradation, self._indicatrix, self.sun_altitude)
        return integral / self._zenith_value()


@dataclass(frozen=True, init=False)
class UniformSky(Sky):
    """A sky of the same luminance everywhere above the horizon.

    Parameters
    ----------
    luminance : float
        [cd/m²], 0 or more; the attribute :attr:`zenith_luminance` keeps it.

    Raises
    ------
    SceneError
        A negative luminance, NaN.
    """

    zenith_luminance: float = 0.0

    def __init__(self, luminance: float):
        value = checked_number(luminance, "UniformSky: luminance", low=0.0, remedy="give cd/m²")
        object.__setattr__(self, "zenith_luminance", value)

    @property
    def horizontal_illuminance(self) -> float:
        """Illuminance of the unobstructed horizontal plane [lx]: π times the luminance."""
        return np.pi * self.zenith_luminance

    def luminance(self, directions) -> np.ndarray:
        """Luminance [cd/m²] of unit vectors (..., 3); 0 at and below the horizon."""
        return np.where(unit_directions(directions)[..., 2] > 0.0, self.zenith_luminance, 0.0)


def _only_scale(sky: CIESky) -> tuple[str, float]:
    """Name and value of the one scale that was given."""
    given = [name for name in ("horizontal_illuminance", "zenith_luminance") if getattr(sky, name) is not None]
    if len(given) != 1:
        count = "both of" if given else "neither of"
        raise SceneError(
            f"CIESky: {count} horizontal_illuminance [lx] and zenith_luminance [cd/m²] given; give exactly one of them"
        )
    return given[0], getattr(sky, given[0])
