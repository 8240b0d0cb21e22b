"""The half of the globe that a plane looks at: its parcels with cosine weights and exact outlines."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from . import clipping, polygons
from .arrays import dots

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
    cut : (k,) bool
        Parcels that may reach below the horizon.
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
    cut: np.ndarray
    globe: Globe

    @cached_property
    def frames(self) -> np.ndarray:
        """(k, 3, 3) float: each direction and two unit vectors across it, right-handed."""
        some = np.flatnonzero(self.cut)
        if len(some) == len(self.cut):
            return self._frames(some)
        frames = self.globe.whole.frames.take(self.parcels, axis=0)
        frames[some] = self._frames(some)
        return frames

    @cached_property
    def shapes(self) -> Shapes:
        """Outlines of what is seen of the parcels, on the planes that touch the sphere at `directions`.

        The arcs between bands are chords, shifted to leave the areas right; next to the poles there are more of them.
        """
        return self._all_shapes(lambda whole: whole.shapes, self._shapes)

    @cached_property
    def fine_shapes(self) -> tuple[Shapes, Shapes]:
        """The same within arcs: outlines as far as the inner arc's chord; what lies between the two, to take off."""
        return (
            self._all_shapes(lambda whole: whole.fine_shapes[0], self._outer_shapes),
            self._all_shapes(lambda whole: whole.fine_shapes[1], self._inner_shapes),
        )

    def _all_shapes(self, of: Callable[[Hemisphere], Shapes], find: Callable[[np.ndarray], Shapes]) -> Shapes:
        """Those of whole parcels, which all hemispheres have alike; and of the others, found anew."""
        some = np.flatnonzero(self.cut)
        if len(some) == len(self.cut):
            return find(some)
        return of(self.globe.whole).take(self.parcels).replaced(some, find(some))

    def _frames(self, some) -> np.ndarray:
        axes, directions = self.axes[some, 0], self.directions[some]
        across = axes - dots(axes, directions)[:, None] * directions
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        return np.stack([directions, across, polygons.cross(directions, across)], axis=1)

    def _shapes(self, some) -> Shapes:
        inner, outer, turn = self._sides(some)
        near = self._chord(some, inner, turn)[:, ::-1]
        corners, counts = self._above(some, np.concatenate([self._chord(some, outer, turn), near], axis=1))
        polar = np.flatnonzero(self.globe.polar_rank(self.parcels[some]) < POLAR_BANDS)
        if len(polar):
            arc = self._flat(some[polar], outer[polar, None], turn[polar])
            many, counts[polar] = self._above(some[polar], np.concatenate([arc, near[polar]], axis=1))
            corners = polygons.widen(corners, many.shape[1])
            corners[polar] = polygons.widen(many, corners.shape[1])
        return Shapes.of(corners, counts)

    def _outer_shapes(self, some) -> Shapes:
        inner, outer, turn = self._sides(some)
        ends = self._flat(some, inner[:, None], turn[:, [-1, 0]])
        return Shapes.of(*self._above(some, np.concatenate([self._flat(some, outer[:, None], turn), ends], axis=1)))

    def _inner_shapes(self, some) -> Shapes:
        inner, _, turn = self._sides(some)
        return Shapes.of(*self._above(some, self._flat(some, inner[:, None], turn)))

    def _sides(self, some):
        """(n,), (n,) and (n, a) float: polar angles next to the pole and away from it, azimuths across."""
        parcels = self.parcels[some]
        band = self.globe.band_of[parcels]
        southern = band >= self.globe.bands // 2
        turn = self.globe.azimuth[parcels][:, None] + np.multiply.outer(
            0.5 * self.globe.azimuth_width[parcels], np.linspace(-1, 1, _ARC + 1)
        )
        return self.globe.polar_edges[band + southern], self.globe.polar_edges[band + ~southern], turn

    def _above(self, index, corners) -> tuple[np.ndarray, np.ndarray]:
        """Outlines ``(n, v, 2)`` on some of the tangent planes, turned counter-clockwise, of them what is above."""
        spatial = np.concatenate([corners, np.zeros((*corners.shape[:2], 1))], axis=2)
        clockwise = polygons.newell_normal(spatial)[:, 2] < 0
        spatial[clockwise] = spatial[clockwise, ::-1]
        counts = np.full(len(spatial), spatial.shape[1])
        level = np.concatenate([self.cosines[index, 1:], np.zeros((len(index), 1))], axis=1)
        height = self.cosines[index, 0]
        low = np.flatnonzero((np.einsum("kvc,kc->kv", spatial, level) < -height[:, None]).any(axis=1))
        if len(low):
            above = clipping.clip(spatial[low], level[low], -height[low])
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
        return cls(corners, counts, clipping.convex_moments(corners, np.zeros((3, 0, len(counts)))).T)

    def take(self, index) -> Shapes:
        """Some of the shapes."""
        return Shapes(self.corners.take(index, axis=2), self.counts.take(index), self.moments.take(index, axis=0))

    def followed(self, others: Shapes) -> Shapes:
        """These, and others after them."""
        width = max(self.corners.shape[1], others.corners.shape[1])
        corners = [polygons.widen(shapes.corners.T, width).T for shapes in (self, others)]
        return Shapes(
            np.concatenate(corners, axis=2),
            np.concatenate([self.counts, others.counts]),
            np.concatenate([self.moments, others.moments]),
        )

    def replaced(self, index, others: Shapes) -> Shapes:
        """With others in some places."""
        width = max(self.corners.shape[1], others.corners.shape[1])
        corners, new = (polygons.widen(shape.corners.T, width).T for shape in (self, others))
        counts, moments = self.counts.copy(), self.moments.copy()
        corners[:, :, index], counts[index], moments[index] = new, others.counts, others.moments
        return Shapes(np.ascontiguousarray(corners), counts, moments)


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
