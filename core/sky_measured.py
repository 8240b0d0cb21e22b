"""A sky from measured luminances, interpolated between the measured directions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .checks import checked_array, checked_number
from .errors import SceneError
from .sky_model import Sky, unit_directions

_CHUNK = 1 << 16  # directions times measurements worked on at once: stays in the processor's cache
_COINCIDENT = 1e-6  # rad


@dataclass(frozen=True, init=False, eq=False)
class MeasuredSky(Sky):
    """Measured luminances by direction, as a sky scanner or a calibrated camera gives them.

    Parameters
    ----------
    directions : (m, 3) array_like of float
        Vectors (east, north, up) to the measured places, of any length, on or above the horizon, in any pattern.
    luminances : (m,) array_like of float
        [cd/m²], above 0. Leave out what was not measured: the obstructed, the saturated, the Sun itself.
    horizontal_illuminance : float, optional
        Scale: unobstructed diffuse illuminance of the horizontal plane [lx], where it was measured too. None
        (default): the luminances hold as they are.

    Attributes
    ----------
    directions, luminances : ndarray of float64
        Unit vectors and luminances after scaling; read-only.

    Raises
    ------
    SceneError
        Arrays that do not fit each other, directions below the horizon or twice the same, luminances of 0, negative
        ones, NaN.

    Notes
    -----
    Inverse-distance interpolation after Shepard (1968) with nodal gradients (Franke & Nielson 1980), on the sphere
    and of the logarithm of the luminance: every measurement carries a linear function fitted to its neighbours, and
    these are averaged with the weights 1 / distance⁴. It passes through the measurements, is smooth between them,
    positive everywhere, and never leaves the range of the measured values. One direction costs as much as there are
    measurements; 145 (Tregenza's pattern) to some thousands are meant; of a camera picture give averages over
    patches.
    """

    directions: np.ndarray
    luminances: np.ndarray

    def __init__(self, directions, luminances, *, horizontal_illuminance: float | None = None):
        vectors = _checked_directions(directions)
        values = checked_array(luminances, "MeasuredSky: luminances", low=0.0, remedy="give cd/m²")
        if values.shape != (len(vectors),):
            raise SceneError(
                f"MeasuredSky: {len(vectors)} directions but luminances of shape {values.shape}; give one for each"
            )
        if not values.all():
            dark = int(np.flatnonzero(values == 0.0)[0])
            raise SceneError(f"MeasuredSky: luminance {dark} is 0; leave out directions without a measured sky")
        self._keep("directions", vectors)
        self._keep("luminances", values)
        if horizontal_illuminance is not None:
            wanted = checked_number(
                horizontal_illuminance,
                "MeasuredSky: horizontal_illuminance",
                low=0.0,
                remedy="give lx, or leave it out",
            )
            if wanted == 0.0:
                raise SceneError("MeasuredSky: horizontal_illuminance is 0; leave the sky out instead")
            factor = wanted / self.horizontal_illuminance
            object.__setattr__(self, "horizontal_illuminance", wanted)
            self._keep("luminances", values * factor)
            self.__dict__.pop("_log_linear", None)  # fitted to the values before scaling

    def luminance(self, directions) -> np.ndarray:
        """Luminance [cd/m²] of unit vectors (..., 3); 0 at and below the horizon."""
        directions = unit_directions(directions)
        flat = directions.reshape(-1, 3)
        result = np.zeros(len(flat))
        above = np.flatnonzero(flat[:, 2] > 0.0)
        rows = max(1, _CHUNK // len(self.luminances))
        for start in range(0, len(above), rows):
            part = above[start : start + rows]
            result[part] = self._interpolated(flat[part])
        return result.reshape(directions.shape[:-1])

    @cached_property
    def horizontal_illuminance(self) -> float:
        """Illuminance of the unobstructed horizontal plane [lx]; by quadrature, within 1e-5 for a scanner's pattern."""
        levels, turns = 90, 360
        nodes, weights = np.polynomial.legendre.leggauss(levels)
        polar = np.pi / 4 * (nodes + 1)
        around = (np.arange(turns) + 0.5) * (2 * np.pi / turns)
        vectors = np.empty((levels, turns, 3))
        vectors[..., 0] = np.sin(polar)[:, None] * np.sin(around)
        vectors[..., 1] = np.sin(polar)[:, None] * np.cos(around)
        vectors[..., 2] = np.cos(polar)[:, None]
        mean = self.luminance(vectors).mean(axis=1)
        return float(2 * np.pi * np.pi / 4 * (weights * np.sin(polar) * np.cos(polar) * mean).sum())

    @cached_property
    def _log_linear(self) -> np.ndarray:
        """(m, 5): for each measurement the constant, the gradient of ln L, and 1 to sum the weights."""
        logarithms = np.log(self.luminances)
        fitted = np.empty((len(logarithms), 5))
        fitted[:, 0] = logarithms
        fitted[:, 4] = 1.0
        rows = max(1, _CHUNK // len(logarithms))
        for start in range(0, len(logarithms), rows):
            chosen = slice(start, start + rows)
            fitted[chosen, 1:4] = _tangent_gradients(self.directions, logarithms, chosen)
        return fitted

    def _interpolated(self, vectors: np.ndarray) -> np.ndarray:
        sums = _weights(vectors, self.directions) @ self._log_linear
        logarithms = (sums[:, 0] + (sums[:, 1:4] * vectors).sum(axis=1)) / sums[:, 4]
        return np.clip(np.exp(logarithms), self.luminances.min(), self.luminances.max())

    def _keep(self, name: str, array: np.ndarray) -> None:
        array.flags.writeable = False
        object.__setattr__(self, name, array)


def _weights(vectors: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """(n, m) inverse fourth powers of the chords between unit vectors; huge, but finite, where they coincide."""
    squared = vectors @ nodes.T
    np.subtract(1.0, squared, out=squared)
    np.maximum(squared, 1e-15, out=squared)
    np.multiply(squared, squared, out=squared)
    return np.divide(1.0, squared, out=squared)


def _tangent_gradients(nodes: np.ndarray, logarithms: np.ndarray, chosen: slice) -> np.ndarray:
    """Gradients of ln L at the chosen nodes, fitted to all others by weighted least squares."""
    here = nodes[chosen]
    weights = _weights(here, nodes)
    rows = np.arange(len(here))
    weights[rows, np.arange(len(nodes))[chosen]] = 0.0
    products = (nodes[:, :, None] * nodes[:, None, :]).reshape(-1, 9)
    tangent = np.eye(3) - here[:, :, None] * here[:, None, :]
    normal = tangent @ (weights @ products).reshape(-1, 3, 3) @ tangent
    differences = weights @ (nodes * logarithms[:, None]) - logarithms[chosen, None] * (weights @ nodes)
    right = tangent @ differences[:, :, None]
    # Filled up along the node's own direction, and a touch everywhere for neighbours that lie on one great circle.
    trace = np.trace(normal, axis1=1, axis2=2)[:, None, None] + 1e-30
    normal = normal + trace * (here[:, :, None] * here[:, None, :] + 1e-6 * np.eye(3))
    return np.linalg.solve(normal, right)[:, :, 0]


def _checked_directions(directions) -> np.ndarray:
    vectors = checked_array(directions, "MeasuredSky: directions", remedy="give (m, 3) vectors (east, north, up)")
    if vectors.ndim != 2 or vectors.shape[1] != 3 or len(vectors) == 0:
        raise SceneError(
            f"MeasuredSky: directions must be an (m, 3) array with a row at least, not of shape {vectors.shape}"
        )
    lengths = np.linalg.norm(vectors, axis=1)
    if not lengths.all():
        zero = int(np.flatnonzero(lengths == 0.0)[0])
        raise SceneError(f"MeasuredSky: direction {zero} has no length; give (east, north, up)")
    vectors = vectors / lengths[:, None]
    below = np.flatnonzero(vectors[:, 2] < -1e-9)
    if len(below):
        raise SceneError(
            f"MeasuredSky: direction {below[0]} points below the horizon ({len(below)} in all); leave it out"
        )
    _, first, counts = np.unique(np.rint(vectors / _COINCIDENT), axis=0, return_index=True, return_counts=True)
    if (counts > 1).any():
        twice = int(first[counts > 1].min())
        raise SceneError(f"MeasuredSky: direction {twice} is there more than once; give its mean luminance once")
    return vectors
