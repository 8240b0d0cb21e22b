"""The globe of parcels: directions shared by every receiver (Claro 1998; Claro & Pereira 2001, fig. 1).

The sphere is cut from zenith to nadir into bands of equal height in polar angle, each band into parcels of
equal width in azimuth. A band at mid polar angle θ holds ``1 + round(2.55 · bands · sin θ)`` parcels, so solid
angles are nearly equal and 60 bands give the paper's 5,902 parcels.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .arrays import onto
from .errors import SceneError
from .hemisphere import POLAR_BANDS, Hemisphere, direction_of

PARCELS_PER_BAND_FACTOR = 2.55
MAX_BANDS = 2000
_HORIZON_SUBDIVISION = 16


@dataclass(frozen=True, eq=False)
class Globe:
    """Parcels of the sphere of directions.

    Parameters
    ----------
    bands : int
        Number of bands from zenith to nadir, 2 or more.

    Raises
    ------
    SceneError
        Where ``bands`` is no integer between 2 and 2000.
    """

    bands: int = 60
    _scattered: dict[int, np.ndarray] = field(default_factory=dict, repr=False)
    _shared: dict[int, tuple] = field(default_factory=dict, repr=False)

    def __post_init__(self):
        if isinstance(self.bands, bool) or not isinstance(self.bands, int | np.integer):
            raise SceneError(f"bands must be a whole number (60 is usual), not {self.bands!r}")
        if not 2 <= self.bands <= MAX_BANDS:
            raise SceneError(f"bands must lie between 2 and {MAX_BANDS}, not {self.bands}; 60 is usual")

    @classmethod
    def cut_at_horizon(cls, bands: int) -> Globe:
        """Globe of ``bands`` bands, or one more, so that the horizon is a limit between two of them.

        Parameters
        ----------
        bands : int

        Returns
        -------
        Globe

        Raises
        ------
        SceneError
            As for the globe itself.
        """
        globe = cls(bands)
        return globe if bands % 2 == 0 else cls(bands + 1)

    @cached_property
    def parcels_in_band(self) -> np.ndarray:
        """(bands,) int: parcels in each band, from the zenith down."""
        mid = (np.arange(self.bands) + 0.5) * np.pi / self.bands
        half = 1 + np.rint(PARCELS_PER_BAND_FACTOR * self.bands * np.sin(mid)).astype(np.int64)
        return np.minimum(half, half[::-1])  # symmetric to the last bit

    @cached_property
    def band_starts(self) -> np.ndarray:
        """(bands + 1,) int: index of each band's first parcel; the last entry is the number of parcels."""
        return np.concatenate(([0], np.cumsum(self.parcels_in_band)))

    @property
    def count(self) -> int:
        """Number of parcels."""
        return int(self.band_starts[-1])

    @cached_property
    def band_of(self) -> np.ndarray:
        """(count,) int: band of each parcel."""
        return np.repeat(np.arange(self.bands), self.parcels_in_band)

    @cached_property
    def polar_edges(self) -> np.ndarray:
        """(bands + 1,) float: polar angle of the band limits [rad], 0 at the zenith."""
        return np.linspace(0.0, np.pi, self.bands + 1)

    @cached_property
    def polar(self) -> np.ndarray:
        """(count,) float: polar angle of the parcel centres [rad]."""
        return (self.band_of + 0.5) * (np.pi / self.bands)

    @cached_property
    def azimuth_width(self) -> np.ndarray:
        """(count,) float: width of each parcel in azimuth [rad]."""
        return (2 * np.pi / self.parcels_in_band)[self.band_of]

    @cached_property
    def azimuth(self) -> np.ndarray:
        """(count,) float: azimuth of the parcel centres, clockwise from north [rad]."""
        return (np.arange(self.count) - self.band_starts[self.band_of] + 0.5) * self.azimuth_width

    @cached_property
    def directions(self) -> np.ndarray:
        """(count, 3) float: direction cosines of the parcel centres (east, north, up)."""
        return direction_of(self.polar, self.azimuth)

    @cached_property
    def solid_angles(self) -> np.ndarray:
        """(count,) float: exact solid angle of each parcel [sr]; they sum to 4π."""
        cosines = np.cos(self.polar_edges)
        return (cosines[:-1] - cosines[1:])[self.band_of] * self.azimuth_width

    @cached_property
    def half_widths(self) -> np.ndarray:
        """(count, 2) float: half the parcel's extent along polar angle and along azimuth [rad on the sphere]."""
        across = np.full(self.count, 0.5 * np.pi / self.bands)
        # of equal area with the parcel, so that the rectangle stands for it in the tangent plane
        return np.stack([across, self.solid_angles / (4 * across)], axis=1)

    @cached_property
    def corners(self) -> np.ndarray:
        """(count, 4, 3) float: directions of the parcels' corners."""
        polar = self.polar_edges[self.band_of[:, None] + np.array([0, 0, 1, 1])]
        azimuth = self.azimuth[:, None] + 0.5 * self.azimuth_width[:, None] * np.array([-1, 1, 1, -1])
        return direction_of(polar, azimuth)

    @cached_property
    def axes(self) -> np.ndarray:
        """(count, 2, 3) float: unit vectors of growing polar angle and growing azimuth at the parcel centres."""
        ct, st = np.cos(self.polar), np.sin(self.polar)
        ca, sa = np.cos(self.azimuth), np.sin(self.azimuth)
        along_polar = np.stack([ct * sa, ct * ca, -st], axis=1)
        along_azimuth = np.stack([ca, -sa, np.zeros_like(ca)], axis=1)
        return np.stack([along_polar, along_azimuth], axis=1)

    @cached_property
    def first_moments(self) -> np.ndarray:
        """(count, 3) float: exact ∫ d dω over each parcel, from which cosine weights follow."""
        t0, t1 = self.polar_edges[self.band_of], self.polar_edges[self.band_of + 1]
        half = 0.5 * self.azimuth_width
        sin_squared = 0.5 * (t1 - t0) - 0.25 * (np.sin(2 * t1) - np.sin(2 * t0))
        level = sin_squared * 2 * np.sin(half)
        up = 0.5 * (np.sin(t1) ** 2 - np.sin(t0) ** 2) * 2 * half
        return np.stack([level * np.sin(self.azimuth), level * np.cos(self.azimuth), up], axis=1)

    def polar_rank(self, parcels) -> np.ndarray:
        """(m,) int: how many bands lie between each parcel's and the nearer pole."""
        band = self.band_of[parcels]
        return np.minimum(band, self.bands - 1 - band)

    def subdirections(self, parcels, splits: int) -> np.ndarray:
        """Centres of ``splits`` × ``splits`` parts of equal solid angle of each parcel.

        Parameters
        ----------
        parcels : (m,) array of int
        splits : int

        Returns
        -------
        (m, splits², 3) float
        """
        step = (np.arange(splits) + 0.5) / splits
        down, across = np.meshgrid(step, step, indexing="ij")
        return self._inside(parcels, down.ravel(), across.ravel())

    def all_scattered(self, order: int) -> np.ndarray:
        """(count, F, 3) float32: `scattered` for all parcels; found once."""
        if order not in self._scattered:
            self._scattered[order] = self.scattered(np.arange(self.count), order).astype(np.float32)
        return self._scattered[order]

    def scattered(self, parcels, order: int) -> np.ndarray:
        """Directions spread evenly over each parcel, no two in line along it or across it.

        A Fibonacci lattice (Zaremba 1966): edges that run along a band are met one ray at a time, not a row at a time.

        Parameters
        ----------
        parcels : (m,) array of int
        order : int
            Index of a Fibonacci number F, the number of directions: 7 gives 13, 11 gives 89.

        Returns
        -------
        (m, F, 3) float
        """
        before, count = 0, 1
        for _ in range(order - 1):
            before, count = count, before + count
        place = np.arange(count) + 0.5
        return self._inside(parcels, place / count, np.mod(place * before / count, 1.0))

    def _inside(self, parcels, down: np.ndarray, across: np.ndarray) -> np.ndarray:
        """(m, s, 3) float: directions at places 0 … 1 of each parcel, of equal solid angle."""
        parcels = np.asarray(parcels)
        c0 = np.cos(self.polar_edges[self.band_of[parcels]])[:, None]
        c1 = np.cos(self.polar_edges[self.band_of[parcels] + 1])[:, None]
        polar = np.arccos(np.clip(c0 + (c1 - c0) * down, -1.0, 1.0))
        azimuth = self.azimuth[parcels][:, None] + (across - 0.5) * self.azimuth_width[parcels][:, None]
        return direction_of(polar, azimuth)

    def shared_with(self, other: Globe) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """What parcels have in common with those of another globe, parcel by parcel; found once.

        Parameters
        ----------
        other : Globe

        Returns
        -------
        own, others : (n,) int
            Parcels.
        solid_angle : (n,) float [sr]
        direction : (n, 3) float
            Of the middle of what they share.
        """
        if other.bands not in self._shared:
            self._shared[other.bands] = self._common(other)
        return self._shared[other.bands]

    def _common(self, other: Globe) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        limits = np.union1d(np.rint(self.polar_edges * 1e12), np.rint(other.polar_edges * 1e12)) * 1e-12
        found = []
        for upper, lower in itertools.pairwise(limits.tolist()):
            polar = 0.5 * (upper + lower)
            bands = [int(polar * globe.bands / np.pi) for globe in (self, other)]
            counts = [int(globe.parcels_in_band[band]) for globe, band in zip((self, other), bands, strict=True)]
            starts = [int(globe.band_starts[band]) for globe, band in zip((self, other), bands, strict=True)]
            turns = np.unique(np.concatenate([np.arange(count + 1) / count for count in counts]))
            turn, width = 0.5 * (turns[1:] + turns[:-1]), np.diff(turns)
            own, others = (start + (turn * count).astype(np.int64) for start, count in zip(starts, counts, strict=True))
            solid_angle = 2 * np.pi * width * (np.cos(upper) - np.cos(lower))
            found.append((own, others, solid_angle, direction_of(np.full(len(turn), polar), 2 * np.pi * turn)))
        own, others, solid_angle, direction = (np.concatenate(part) for part in zip(*found, strict=True))
        order = np.lexsort((others, own))
        return own[order], others[order], solid_angle[order], direction[order]

    def parcel_of(self, directions) -> np.ndarray:
        """Index of the parcel that holds each direction, in constant time.

        Parameters
        ----------
        directions : (..., 3) array of float
            Of any length but zero.

        Returns
        -------
        (...) int
        """
        d = np.asarray(directions, float)
        polar = np.arctan2(np.hypot(d[..., 0], d[..., 1]), d[..., 2])
        band = np.minimum((polar * (self.bands / np.pi)).astype(np.int64), self.bands - 1)
        turn = np.mod(np.arctan2(d[..., 0], d[..., 1]) / (2 * np.pi), 1.0)
        in_band = self.parcels_in_band[band]
        return self.band_starts[band] + np.minimum((turn * in_band).astype(np.int64), in_band - 1)

    def interpolation(self, directions) -> tuple[np.ndarray, np.ndarray]:
        """Four parcels and weights that interpolate a smooth function of direction linearly.

        Never mixes parcels above the horizon with parcels below it, so that the sky's edge stays sharp: there
        the two bands on the direction's own side are continued.

        Parameters
        ----------
        directions : (m, 3) array of float

        Returns
        -------
        parcels : (m, 4) int
        weights : (m, 4) float
            They sum to 1 for each direction.
        """
        d = np.asarray(directions, float)
        polar = np.arctan2(np.hypot(d[:, 0], d[:, 1]), d[:, 2])
        turn = np.mod(np.arctan2(d[:, 0], d[:, 1]) / (2 * np.pi), 1.0)
        place = polar * (self.bands / np.pi) - 0.5
        upper_last = (self.bands + 1) // 2 - 1  # last band with its centre on or above the horizon
        above = d[:, 2] >= 0
        low = np.where(above, 0, min(upper_last + 1, self.bands - 1))
        high = np.where(above, upper_last, self.bands - 1)
        first = np.clip(np.floor(place), low, np.maximum(high - 1, low)).astype(np.int64)
        second = np.minimum(first + 1, high)
        share = np.where(second > first, np.clip(place - first, -0.5, 1.5), 0.0)
        parcels, weights = [], []
        for band, band_share in ((first, 1 - share), (second, share)):
            n = self.parcels_in_band[band]
            position = turn * n - 0.5
            left = np.floor(position)
            fraction = position - left
            left = left.astype(np.int64)
            parcels += [self.band_starts[band] + np.mod(left, n), self.band_starts[band] + np.mod(left + 1, n)]
            weights += [band_share * (1 - fraction), band_share * fraction]
        return np.stack(parcels, axis=1), np.stack(weights, axis=1)

    def hemisphere(self, normal) -> Hemisphere:
        """The half of the globe that a plane with this normal looks at.

        Parcels that the plane's own horizon cuts are represented by the part above it.

        Parameters
        ----------
        normal : (3,) array of float
            Of any length but zero.

        Returns
        -------
        Hemisphere
        """
        n = np.asarray(normal, float)
        n = n / np.linalg.norm(n)
        cosine = onto(self.directions, n)
        reach = np.hypot(*self.half_widths.T) * 1.3
        parcels = np.flatnonzero(cosine > -reach)
        whole = self.whole
        cut = np.abs(cosine[parcels]) <= reach[parcels]
        low = np.flatnonzero(cut)
        directions = self.directions[parcels].copy()
        weights = self.first_moments[parcels] @ n / np.pi
        half_widths = self.half_widths[parcels].copy()
        distance = whole.reach[parcels]
        if len(low):
            weight, seen, centre = self._above(parcels[low], n)
            ok = seen > 0
            directions[low[ok]] = centre[ok] / np.linalg.norm(centre[ok], axis=1, keepdims=True)
            half_widths[low] *= np.sqrt(np.maximum(seen, 1) / _HORIZON_SUBDIVISION**2)[:, None]
            weights[low] = np.where(ok, weight, 0.0)
            # the whole parcels are exact, so the sampled ones must make up the rest of exactly 1
            sampled = weights[low].sum()
            if sampled > 0:
                weights[low] *= (1.0 - weights[~cut].sum()) / sampled
            distance[low] = self._to_corners(parcels[low], directions[low])
        keep = weights > 0
        return Hemisphere(
            normal=n,
            parcels=parcels[keep],
            directions=directions[keep],
            weights=weights[keep] / weights[keep].sum(),
            half_widths=half_widths[keep],
            axes=self.axes[parcels[keep]],
            odd=(whole.odd[parcels] | cut)[keep],
            cut=cut[keep],
            reach=distance[keep],
            globe=self,
        )

    @cached_property
    def whole(self) -> Hemisphere:
        """All parcels, as a plane would see them that has no horizon and weighs nothing."""
        every = np.arange(self.count)
        return Hemisphere(
            normal=np.zeros(3),
            parcels=every,
            directions=self.directions,
            weights=np.zeros(self.count),
            half_widths=self.half_widths,
            axes=self.axes,
            odd=self.polar_rank(every) < POLAR_BANDS,
            cut=np.ones(self.count, bool),
            reach=self._to_corners(every, self.directions),
            globe=self,
        )

    def _to_corners(self, parcels, directions) -> np.ndarray:
        """(m,) float: angles from directions ``(m, 3)`` to the farthest corner of each parcel [rad]."""
        chord = np.linalg.norm(self.corners[parcels] - directions[:, None], axis=2).max(axis=1)
        return 2 * np.arcsin(0.5 * chord)

    def _above(self, parcels, normal) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Cosine weight, parts and their sum of directions ``(m, 3)``, of what of parcels is above a horizon."""
        step = (np.arange(_HORIZON_SUBDIVISION) + 0.5) / _HORIZON_SUBDIVISION
        c0, c1 = (np.cos(self.polar_edges[self.band_of[parcels] + k])[:, None] for k in (0, 1))
        up = c0 + (c1 - c0) * step
        level = np.sqrt(np.maximum(1 - up**2, 0.0))
        azimuth = self.azimuth[parcels][:, None] + (step - 0.5) * self.azimuth_width[parcels][:, None]
        east, north = np.sin(azimuth), np.cos(azimuth)
        lit = level[:, :, None] * (normal[0] * east + normal[1] * north)[:, None, :] + (normal[2] * up)[:, :, None]
        seen = lit > 0
        weight = np.where(seen, lit, 0.0).sum(axis=(1, 2)) * self.solid_angles[parcels] / seen[0].size / np.pi
        across = (level[:, :, None] * seen).sum(axis=1)
        centre = [(across * east).sum(axis=1), (across * north).sum(axis=1), (up * seen.sum(axis=2)).sum(axis=1)]
        return weight, seen.sum(axis=(1, 2)), np.stack(centre, axis=1)
