"""The half of the globe that a plane looks at: its parcels with cosine weights and exact outlines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from . import polygons

if TYPE_CHECKING:
    from .globe import Globe

POLAR_BANDS = 2
"""Bands around each pole whose parcels no rectangle stands for."""

_BENT = 0.1

_ARC = 8
"""Sides that stand for an arc where a chord will not do."""


@dataclass(frozen=True, eq=False)
class Hemisphere:
    """Directions that a plane looks at, with their cosine weights.

    Attributes
    ----------
    normal : (3,) float, unit
    parcels : (k,) int, index on the globe
    directions : (k, 3) float, unit; the centre of what the plane sees of the parcel
    weights : (k,) float, ∫ cos θ dω / π over that part; they sum to 1
    half_widths : (k, 2) float [rad]
    axes : (k, 2, 3) float, unit vectors along the half widths
    reach : (k,) float
        No corner of the parcel is farther from the direction than this [rad].
    odd : (k,) bool
        Parcels that a rectangle stands for badly: cut by the horizon, or next to a pole.
    globe : Globe
    """

    normal: np.ndarray
    parcels: np.ndarray
    directions: np.ndarray
    weights: np.ndarray
    half_widths: np.ndarray
    axes: np.ndarray
    reach: np.ndarray
    odd: np.ndarray
    globe: Globe

    @cached_property
    def frames(self) -> np.ndarray:
        """(k, 3, 3) float: each direction and two unit vectors across it, right-handed."""
        across = self.axes[:, 0] - np.einsum("kc,kc->k", self.axes[:, 0], self.directions)[:, None] * self.directions
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        return np.stack([self.directions, across, polygons.cross(self.directions, across)], axis=1)

    @cached_property
    def shapes(self) -> Shapes:
        """Outlines of what is seen of the parcels, on the planes that touch the sphere at `directions`.

        The arcs between bands are chords, shifted to leave the areas right; next to the poles there are more of them.
        """
        inner, outer, turn = self._sides
        every = np.arange(len(turn))
        near = self._chord(every, inner, turn)[:, ::-1]
        corners, counts = self._cut(every, np.concatenate([self._chord(every, outer, turn), near], axis=1))
        polar = np.flatnonzero(self.globe.polar_rank(self.parcels) < POLAR_BANDS)
        if len(polar):
            arc = self._flat(polar, outer[polar, None], turn[polar])
            many, counts[polar] = self._cut(polar, np.concatenate([arc, near[polar]], axis=1))
            corners = polygons.widen(corners, many.shape[1])
            corners[polar] = many
        return Shapes.of(corners, counts)

    @cached_property
    def fine_shapes(self) -> tuple[Shapes, Shapes]:
        """The same within arcs: outlines as far as the inner arc's chord; what lies between the two, to take off."""
        inner, outer, turn = self._sides
        every = np.arange(len(turn))
        arcs = [self._flat(every, angle[:, None], turn) for angle in (outer, inner)]
        around = np.concatenate([arcs[0], arcs[1][:, [-1, 0]]], axis=1)
        return Shapes.of(*self._cut(every, around)), Shapes.of(*self._cut(every, arcs[1]))

    @cached_property
    def _sides(self):
        """(k,), (k,) and (k, a) float: polar angles next to the pole and away from it, azimuths across."""
        band = self.globe.band_of[self.parcels]
        southern = band >= self.globe.bands // 2
        turn = self.globe.azimuth[self.parcels][:, None] + np.multiply.outer(
            0.5 * self.globe.azimuth_width[self.parcels], np.linspace(-1, 1, _ARC + 1)
        )
        return self.globe.polar_edges[band + southern], self.globe.polar_edges[band + ~southern], turn

    def _cut(self, index, corners) -> tuple[np.ndarray, np.ndarray]:
        """Outlines ``(n, v, 2)`` on some of the tangent planes, turned counter-clockwise, of them what is above."""
        spatial = np.concatenate([corners, np.zeros((*corners.shape[:2], 1))], axis=2)
        clockwise = polygons.newell_normal(spatial)[:, 2] < 0
        spatial[clockwise] = spatial[clockwise, ::-1]
        counts = np.full(len(spatial), spatial.shape[1])
        level = np.concatenate([self.cosines[index, 1:], np.zeros((len(index), 1))], axis=1)
        height = self.cosines[index, 0]
        low = np.flatnonzero((np.einsum("kvc,kc->kv", spatial, level) < -height[:, None]).any(axis=1))
        if len(low):
            above = polygons.clip(spatial[low], level[low], -height[low])
            width = max(spatial.shape[1], above.shape[1])
            spatial = polygons.widen(spatial, width)
            spatial[low] = polygons.widen(above, width)
            counts[low] = above.shape[1]
        return spatial[:, :, :2], counts

    def _chord(self, index, angle, turn) -> np.ndarray:
        """(n, 2, 2) float: ends of an arc's chord, shifted so that as much lies beyond it as within."""
        flat = self._flat(index, angle[:, None], turn[:, [0, turn.shape[1] // 2, -1]])
        sagitta = flat[:, 1] - 0.5 * (flat[:, 0] + flat[:, 2])
        return flat[:, ::2] + (2 / 3) * sagitta[:, None]

    def _flat(self, index, angle, azimuth) -> np.ndarray:
        """(n, a, 2) float: directions on some of the tangent planes."""
        towards = direction_of(*np.broadcast_arrays(angle, azimuth))
        place = np.einsum("kac,knc->kna", self.frames[index], towards)
        return place[:, :, 1:] / place[:, :, :1]

    @cached_property
    def bent(self) -> np.ndarray:
        """(k,) bool: odd parcels, and those a tenth wider or more at their end than in the middle."""
        polar = self.globe.polar[self.parcels]
        return self.odd | (np.abs(self.half_widths[:, 0] * np.cos(polar)) > _BENT * np.sin(polar))

    @cached_property
    def slopes(self) -> np.ndarray:
        """(k, 3) float: relative change of a parcel's cosine-weighted width with direction, at its centre [1/rad]."""
        narrowing = np.cos(self.globe.polar[self.parcels]) / np.sin(self.globe.polar[self.parcels])
        return self.normal / (self.directions @ self.normal)[:, None] + narrowing[:, None] * self.axes[:, 0]

    @cached_property
    def cosines(self) -> np.ndarray:
        """(k, 3) float: products of the normal with the vectors of `frames`: the cosine and how it changes across."""
        return self.frames @ self.normal


@dataclass(frozen=True, eq=False)
class Shapes:
    """Outlines on tangent planes, along the vectors of `Hemisphere.frames`.

    Attributes
    ----------
    corners : (2, v, k) float
        Counter-clockwise, padded.
    counts : (k,) int
        Corners before the padding.
    moments : (k, 3) float
        Area and first moments.
    """

    corners: np.ndarray
    counts: np.ndarray
    moments: np.ndarray

    @classmethod
    def of(cls, corners, counts) -> Shapes:
        """Shapes from corners ``(k, v, 2)``."""
        corners = np.ascontiguousarray(np.moveaxis(corners, 0, 2).swapaxes(0, 1))
        return cls(corners, counts, polygons.convex_moments(corners, np.zeros((3, 0, len(counts)))).T)


def direction_of(polar, azimuth) -> np.ndarray:
    """Direction cosines (east, north, up) from polar angle and azimuth [rad].

    Parameters
    ----------
    polar, azimuth : (m,) arrays of float

    Returns
    -------
    (m, 3) float
    """
    s = np.sin(polar)
    return np.stack([s * np.sin(azimuth), s * np.cos(azimuth), np.cos(polar)], axis=-1)
