"""Bundles: rays of receivers near each other, along directions that they share.

Which outlines stand in the way of a direction is found for all receivers at once, by a cone around each outline; then
where their rays meet its plane, and whether within its edges, are sums of what depends on the receiver and what on the
direction. Where outlines are far more than receivers can share, each ray is looked up by itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import dots
from .rays import RayScene
from .tree import Tree

_PER_SEARCH = 150
"""Outlines that are tested within a bundle in the time that one ray takes to find its own in a tree."""

_PER_TEST = 8
"""Cones that are tried in the time of one such test."""

_BLOCK = 40_000
"""Tests at a time: they stay in cache."""

_CONES_AT_ONCE = 1_000_000

_SLACK = 2e-6
"""What rounding in float32 may take from a cosine."""

_FEW_POINTS = 4
"""Rays of fewer go down the tree at once: what they cannot meet is found out there."""


@dataclass(frozen=True, eq=False)
class Bundle:
    """Rays that may be sent from some points along some directions.

    Attributes
    ----------
    scene : RayScene
    points : (r, 3) float
        Near each other.
    directions : (k, 3) float
        Unit vectors.
    among : Tree
        Of the outlines to look for.
    way, outline : (n,) int, or None where rays are looked up by themselves
        Directions, in ascending order, and outlines that may be met along these from some point.
    """

    scene: RayScene
    points: np.ndarray
    directions: np.ndarray
    among: Tree
    way: np.ndarray | None = None
    outline: np.ndarray | None = None

    @classmethod
    def of(cls, scene: RayScene, points: np.ndarray, directions: np.ndarray, among: Tree, rays: int) -> Bundle:
        """That of some points and directions, of which so many pairs are ``rays`` to be sent."""
        outlines = among.held
        axes, cosines = _cones(scene, points, outlines)
        expected = float(np.minimum(1 - cosines, 1.0).sum())  # around a direction of half the sphere
        if len(directions) * (len(outlines) / _PER_TEST + len(points) * expected) > _PER_SEARCH * rays:
            return cls(scene, points, directions, among)
        found = []
        step = max(1, _CONES_AT_ONCE // max(len(outlines), 1))
        for first in range(0, len(directions), step):
            way, place = np.nonzero(directions[first : first + step].astype(np.float32) @ axes.T >= cosines)
            found.append((first + way, outlines[place]))
        return cls(scene, points, directions, among, *(np.concatenate(part) for part in zip(*found, strict=True)))

    def may_meet(self) -> np.ndarray:
        """(r, k) bool, or what stands for it: whether each ray may meet anything."""
        if self.way is not None:
            return np.bincount(self.way, minlength=len(self.directions)) > 0
        if len(self.points) < _FEW_POINTS:
            return np.ones(len(self.directions), bool)
        return self.among.may_meet(self.points, self.directions)

    def nearest(self, row, way, start: np.ndarray, within: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First outline that each ray meets.

        Parameters
        ----------
        row, way : (n,) int
            Point and direction of each.
        start, within : (n,) float
            Between which distances from its point it looks [m].

        Returns
        -------
        outline : (n,) int
            -1 where nothing is met.
        distance : (n,) float
            From the point [m]; inf where nothing is met.
        """
        if self.way is None or self.outline is None:
            origins = self.points[row] + start[:, None] * self.directions[way]
            outline, distance = self.scene.nearest(origins, self.directions[way], within - start, self.among)
            return outline, distance + start
        shape = len(self.directions), len(self.points)
        least = np.zeros(shape)
        most = np.full(shape, -np.inf)  # rays that are not sent meet nothing
        least[way, row], most[way, row] = start, within
        outline, distance = np.full(shape, -1), np.full(shape, np.inf)
        used, place = np.unique(self.outline, return_inverse=True)
        tests = _Tests(self.scene, self.points, used)
        bounds = np.searchsorted(self.way, np.arange(shape[0] + 1))
        first, most_pairs, begun = 0, max(1, _BLOCK // max(shape[1], 1)), bool(start.any())
        while first < shape[0]:
            last = max(first + 1, int(np.searchsorted(bounds, bounds[first] + most_pairs, side="right")) - 1)
            pairs = slice(bounds[first], bounds[last])
            tests.first(self.directions, self.way[pairs], place[pairs], least, most, begun, outline, distance)
            first = last
        return outline[way, row], distance[way, row]


def _cones(scene: RayScene, points: np.ndarray, outlines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Axes ``(o, 3)`` and cosines ``(o,)`` of cones of directions in which outlines may be met from some of the points.

    Both float32.
    """
    middle, radius = scene.spheres
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    around = float(np.linalg.norm(points - centre, axis=1).max()) + scene.tolerance
    axes = middle[outlines] - centre
    length = np.maximum(np.linalg.norm(axes, axis=1), 1e-300)
    sine = np.minimum((radius[outlines] + around) / length, 1.0)
    cosines = np.where(sine < 1, np.sqrt(1 - sine**2) - _SLACK, -2.0)
    return (axes / length[:, None]).astype(np.float32), cosines.astype(np.float32)


class _Tests:
    """Where rays from some points meet outlines: what of this depends on points and outlines alone, ``(o, r)``."""

    def __init__(self, scene: RayScene, points: np.ndarray, outlines: np.ndarray):
        self.tolerance, self.outlines = scene.tolerance, outlines
        self.normals = scene.normals[outlines]
        self.heights = scene.offsets[outlines, None] - self.normals @ points.T
        self.apart = np.where(np.abs(self.heights) > scene.tolerance, self.heights, np.nan)
        self.inward = [inward[outlines] for inward, _ in scene.edges]
        self.above = [inward[outlines] @ points.T - least[outlines, None] for inward, least in scene.edges]

    def first(self, directions, way, place, least, most, begun: bool, outline, shortest) -> None:
        """Enter the first outline met, and how far, of rays that look between two distances: all (k, r).

        Pairs of direction and outline (``way`` and ``place``) are all that there are for these directions. Where rays
        have ``begun`` before, outlines count from there on.
        """
        if not len(way):
            return
        towards = directions.take(way, axis=0)
        slope = dots(towards, self.normals.take(place, axis=0))[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = (self.heights if begun else self.apart).take(place, axis=0)
            distance /= slope
            met = distance < most.take(way, axis=0)
            if begun:
                start = least.take(way, axis=0)
                met &= distance > start
                met &= np.abs((distance - start) * slope) > self.tolerance
            else:
                met &= distance > 0
            for inward, above in zip(self.inward, self.above, strict=True):
                height = distance * dots(towards, inward.take(place, axis=0))[:, None]
                height += above.take(place, axis=0)
                met &= height >= 0
        distance[~met] = np.inf
        begin = np.flatnonzero(np.diff(way, prepend=-1))
        best = np.minimum.reduceat(distance, begin, axis=0)
        shortest[way[begin]] = best
        pair, row = np.divmod(np.flatnonzero(met), met.shape[1])
        shown = np.flatnonzero(distance[pair, row] == shortest[way[pair], row])
        outline[way[pair[shown]], row[shown]] = self.outlines[place[pair[shown]]]
