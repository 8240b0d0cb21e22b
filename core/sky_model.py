"""What every sky offers, and the exact horizontal illuminance of skies with a gradation and an indicatrix."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np

from .errors import SceneError


def _smooth_gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre on (0, 1) through 3s² - 2s³, which takes the square roots out of both ends."""
    s, weights = np.polynomial.legendre.leggauss(count)
    s, weights = (s + 1) / 2, weights / 2
    return s * s * (3 - 2 * s), weights * 6 * s * (1 - s)


_RADIAL_RULE = _smooth_gauss(40)
_AROUND_RULE = _smooth_gauss(48)
_RADIAL_ENDS = (np.pi / 6, np.pi / 2)  # more panels, for indicatrices that fall steeply from the Sun


class Sky(ABC):
    """Luminance of the sky by direction, without Sun and ground; base of all skies.

    A sky of your own derives from it and gives `luminance` and `horizontal_illuminance`.
    """

    @abstractmethod
    def luminance(self, directions) -> np.ndarray:
        """Luminance by direction.

        Parameters
        ----------
        directions : (..., 3) array_like of float
            Unit vectors (east, north, up).

        Returns
        -------
        (...) ndarray of float64
            [cd/m²]; 0 at and below the horizon.
        """

    @property
    @abstractmethod
    def horizontal_illuminance(self) -> float:
        """Illuminance of the unobstructed horizontal plane by this sky alone [lx]."""

    @property
    def zenith_luminance(self) -> float:
        """Luminance of the zenith [cd/m²]."""
        return float(self.luminance(np.array([[0.0, 0.0, 1.0]]))[0])


def unit_directions(directions) -> np.ndarray:
    """`directions` as a float64 array (..., 3); SceneError where the last axis is no 3."""
    array = np.asarray(directions, dtype=np.float64)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise SceneError(f"directions must be an (n, 3) array of unit vectors, not of shape {array.shape}")
    return array


def horizontal_integral(
    gradation: Callable[[np.ndarray], np.ndarray],
    indicatrix: Callable[[np.ndarray], np.ndarray] | None = None,
    sun_altitude: float = 90.0,
    *,
    gradation_breaks: tuple[float, ...] = (),
    indicatrix_breaks: tuple[float, ...] = (),
) -> float:
    """Integral of g(sin γ)·f(χ)·sin γ over the upper hemisphere, χ being the angle from the Sun.

    Parameters
    ----------
    gradation : callable
        g of the sine of the altitude, arrays of values in (0, 1].
    indicatrix : callable, optional
        f of the angle from the Sun [rad], arrays of values in (0, π); None for a sky that does not know the Sun.
    sun_altitude : float, optional
        Altitude of the Sun [degrees], 0 to 90.
    gradation_breaks : tuple of float, optional
        Sines of altitude in (0, 1) where g is not smooth.
    indicatrix_breaks : tuple of float, optional
        Angles from the Sun [rad] where f is not smooth; χ = 0 needs no mention.

    Returns
    -------
    float
        [sr]; times the luminance that g·f = 1 stands for, the illuminance of the horizontal plane.

    Notes
    -----
    Gauss-Legendre panels in polar coordinates about the Sun, where the luminance has its cusp: rings of equal χ,
    each cut where it meets the horizon or a break of g, and panels of χ that end where a ring starts to do so.
    Within 1e-10 of the converged value for the CIE general skies.
    """
    levels = np.array([0.0, *sorted(gradation_breaks), 1.0])
    if indicatrix is None:
        sines, weights = _panels(levels, _AROUND_RULE)
        return float(2 * np.pi * (weights * sines * gradation(sines)).sum())

    altitude = np.radians(sun_altitude)
    touched = np.arcsin(levels[:-1])
    ends = np.concatenate(
        (
            [0.0, np.pi - altitude],
            np.abs(altitude - touched),
            np.pi - altitude - touched,
            indicatrix_breaks,
            _RADIAL_ENDS,
        )
    )
    ends = np.unique(ends[(ends >= 0.0) & (ends <= np.pi - altitude)])
    ends = ends[np.diff(ends, prepend=-1.0) > 1e-12]  # a panel without width has rings that meet nothing
    angles, weights = _panels(ends, _RADIAL_RULE)

    mean_sine = np.cos(angles) * np.sin(altitude)  # along a ring, sin γ = mean + swing · cos ψ
    swing = np.sin(angles) * np.cos(altitude)
    with np.errstate(divide="ignore"):
        cosines = np.clip((levels[:, None] - mean_sine) / swing, -1.0, 1.0)
    around = np.arccos(cosines)[::-1].T  # (rings, levels): ψ where the ring crosses each level, from the highest down
    nodes, node_weights = _AROUND_RULE
    width = np.diff(around, axis=1)[..., None]
    psi = around[:, :-1, None] + width * nodes
    sines = np.clip(mean_sine[:, None, None] + swing[:, None, None] * np.cos(psi), 1e-300, 1.0)
    rings = 2 * (width * node_weights * gradation(sines) * sines).sum(axis=(1, 2))
    return float((weights * np.sin(angles) * indicatrix(angles) * rings).sum())


def _panels(ends: np.ndarray, rule: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of a rule on (0, 1) in each panel between successive `ends`."""
    nodes, weights = rule
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * nodes).ravel(), (width * weights).ravel()
