"""The light of an hour: sky, Sun and the light that the ground sends back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .checks import checked_number
from .errors import SceneError
from .sky_model import Sky, unit_directions
from .sun import Sun


@dataclass(frozen=True)
class Daylight:
    """Sky, Sun and ground light together.

    Parameters
    ----------
    sky : Sky, optional
        A sky, e.g. :class:`~.sky_cie.CIESky`; None (default): no sky.
    sun : Sun, optional
        None (default): no Sun. One at or below the horizon gives nothing.
    ground_reflectance : float, optional
        Diffuse reflectance of the ground, 0 (default) to 1; the hemisphere below the horizon then has the uniform
        luminance :attr:`ground_luminance`, unshaded by the scene.

    Raises
    ------
    SceneError
        A sky or Sun of another type, a reflectance outside 0 to 1, NaN.
    """

    sky: Sky | None = None
    sun: Sun | None = None
    ground_reflectance: float = 0.0

    def __post_init__(self):
        if self.sky is not None and not isinstance(self.sky, Sky):
            raise SceneError(
                f"Daylight: sky must be a sky object, not {self.sky!r}; e.g. CIESky(16, horizontal_illuminance=10_000)"
            )
        if self.sun is not None and not isinstance(self.sun, Sun):
            raise SceneError(
                f"Daylight: sun must be a Sun, not {self.sun!r}; "
                "e.g. Sun(altitude=40, azimuth=0, normal_illuminance=80_000)"
            )
        reflectance = checked_number(
            self.ground_reflectance,
            "Daylight: ground_reflectance",
            low=0.0,
            high=1.0,
            remedy="grass or soil has about 0.2",
        )
        object.__setattr__(self, "ground_reflectance", reflectance)

    @property
    def sky_illuminance(self) -> float:
        """Illuminance of the unobstructed horizontal plane by the sky [lx]."""
        return 0.0 if self.sky is None else float(self.sky.horizontal_illuminance)

    @property
    def sun_illuminance(self) -> float:
        """Illuminance of the unobstructed horizontal plane by the Sun [lx]; 0 at or below the horizon."""
        return 0.0 if self.sun is None else self.sun.horizontal_illuminance

    @property
    def horizontal_illuminance(self) -> float:
        """Illuminance of the unobstructed horizontal plane by sky and Sun [lx]."""
        return self.sky_illuminance + self.sun_illuminance

    @property
    def ground_luminance(self) -> float:
        """Luminance of the ground [cd/m²]: ρ_g·E_h / π."""
        return self.ground_reflectance * self.horizontal_illuminance / np.pi

    def sky_luminance(self, directions) -> np.ndarray:
        """Luminance of what lies behind the scene, the Sun left out.

        Parameters
        ----------
        directions : (..., 3) array_like of float
            Unit vectors (east, north, up).

        Returns
        -------
        (...) ndarray of float64
            [cd/m²]: the sky above the horizon, the ground below, 0 on the horizon and where there is neither.
        """
        directions = unit_directions(directions)
        below = np.where(directions[..., 2] < 0.0, self.ground_luminance, 0.0)
        return below if self.sky is None else below + self.sky.luminance(directions)
