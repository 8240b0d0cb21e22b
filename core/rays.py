"""Single rays: the nearest outline along each, for scenes of many outlines and the ends of deep specular chains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons
from .arrays import dots

_FEW = 48
_LEAF = 4

_SUBTREE = 12
"""Levels of the tree below boxes that rays go through one after the other, nearest first."""

_MISS = -1

_BLOCK = 80_000
"""Rays times outlines that are looked at together: they stay in cache."""

_BLOCK_OF_TREE = 8000
"""Rays that go down the tree together."""


@dataclass(frozen=True, eq=False)
class Flight:
    """Where rays got to by way of mirrors.

    Attributes
    ----------
    points, directions : (n, 3) float
        Of their last stretch.
    outline : (n,) int
        What they met at its end; -1 for nothing.
    distance : (n,) float
        To there, in lengths of the direction; inf for nothing.
    factor : (n,) float
        Product of the mirrors' reflectances.
    mirrors : (n,) int
        How many there were.
    faint : (n,) bool
        Not followed to the end.
    """

    points: np.ndarray
    directions: np.ndarray
    outline: np.ndarray
    distance: np.ndarray
    factor: np.ndarray
    mirrors: np.ndarray
    faint: np.ndarray


@dataclass(frozen=True, eq=False)
class RayScene:
    """Convex outlines to shoot rays at.

    Parameters
    ----------
    vertices : (o, w, 3) float, padded
    normals : (o, 3) float
    offsets : (o,) float
    tolerance : float
        Hits nearer than this do not count [m].
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    tolerance: float

    @cached_property
    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        edge = np.roll(self.vertices, -1, axis=1) - self.vertices
        inward = polygons.cross(self.normals[:, None], edge)
        length = np.linalg.norm(inward, axis=2, keepdims=True)
        inward = np.where(length > 0, inward / np.where(length > 0, length, 1.0), 0.0)
        start = np.einsum("owc,owc->ow", inward, self.vertices) - 1e-3 * self.tolerance
        return inward, np.where(length[:, :, 0] > 0, start, -np.inf)

    @cached_property
    def _tree(self) -> _Tree:
        return _Tree.over(self.vertices, self.tolerance)

    def nearest(self, points, directions) -> tuple[np.ndarray, np.ndarray]:
        """First outline that each ray meets.

        Parameters
        ----------
        points, directions : (n, 3) float

        Returns
        -------
        outline : (n,) int
            -1 where nothing is met.
        distance : (n,) float
            In lengths of the direction; inf where nothing is met.
        """
        points, directions = np.asarray(points, float), np.asarray(directions, float)
        outline, distance = np.empty(len(points), np.int64), np.empty(len(points))
        for some in self._blocks(len(points)):
            outline[some], distance[some] = self._first(points[some].T, directions[some].T)
        return outline, distance

    def through_mirrors(self, points, directions, brightness, mirrors, reflectance, cutoff: float, most: int) -> Flight:
        """Follow rays from mirror to mirror, up to what is none.

        Parameters
        ----------
        points, directions : (n, 3) float
        brightness : (n,) float
            Product of reflectances and transmittances on the way here.
        mirrors : (n,) int
            Mirrors and panes on the way here.
        reflectance : (2, o) float
            Of outlines' fronts and backs where they are mirrors and nothing else; 0 where rays end.
        cutoff : float
            Rays of less brightness are not followed.
        most : int
            Nor those with so many mirrors on the way.

        Returns
        -------
        Flight
        """
        n = len(points)
        flight = Flight(
            np.empty((n, 3)),
            np.empty((n, 3)),
            np.full(n, _MISS),
            np.full(n, np.inf),
            np.ones(n),
            np.zeros(n, np.int64),
            np.zeros(n, bool),
        )
        for some in self._blocks(n):
            start = points[some].T, directions[some].T
            self._fly(flight, some.start, *start, brightness[some], most - mirrors[some], reflectance, cutoff)
        return flight

    def _blocks(self, count: int) -> list[slice]:
        step = _BLOCK // max(len(self.vertices), 1) if len(self.vertices) <= _FEW else _BLOCK_OF_TREE
        return [slice(first, first + step) for first in range(0, count, step)]

    def _fly(self, flight: Flight, first: int, points, directions, brightness, left, reflectance, cutoff) -> None:
        """Follow a block of rays; points and directions (3, n), as NumPy is fastest along long rows."""
        ray, factor, flown = first + np.arange(points.shape[1]), np.ones(points.shape[1]), 0
        while len(ray):
            outline, distance = self._first(points, directions)
            normal = self.normals[outline].T
            slope = (normal * directions).sum(axis=0)
            share = np.where(slope < 0, reflectance[0, outline], reflectance[1, outline])
            share[outline < 0] = 0.0
            ends = np.flatnonzero(share <= 0)
            onward = np.flatnonzero(share > 0)
            done = ray[ends]
            flight.points[done], flight.directions[done] = points[:, ends].T, directions[:, ends].T
            flight.outline[done], flight.distance[done] = outline[ends], distance[ends]
            flight.factor[done], flight.mirrors[done] = factor[ends], flown
            ray, factor, flown = ray[onward], factor[onward] * share[onward], flown + 1
            points = points[:, onward] + distance[onward] * directions[:, onward]
            directions = directions[:, onward] - 2 * slope[onward] * normal[:, onward]
            brightness, left = brightness[onward] * share[onward], left[onward]
            faint = (brightness < cutoff) | (left <= flown)
            if faint.any():
                lost, kept = ray[faint], ~faint
                flight.faint[lost], flight.factor[lost], flight.mirrors[lost] = True, factor[faint], flown
                flight.points[lost], flight.directions[lost] = points[:, faint].T, directions[:, faint].T
                ray, factor, brightness, left = ray[kept], factor[kept], brightness[kept], left[kept]
                points, directions = points[:, kept], directions[:, kept]

    def _first(self, points, directions) -> tuple[np.ndarray, np.ndarray]:
        """Outlines that rays ``(3, n)`` meet first, and how far along."""
        if len(self.vertices) <= _FEW:
            return self._first_of_few(points, directions)
        outline = np.full(points.shape[1], _MISS)
        distance = np.full(points.shape[1], np.inf)
        points, directions = np.ascontiguousarray(points.T), np.ascontiguousarray(directions.T)

        def meet(ray: np.ndarray, candidate: np.ndarray) -> None:
            self._meet(ray, candidate, points, directions, outline, distance)

        self._tree.search(points, directions, distance, meet)
        return outline, distance

    def _first_of_few(self, points, directions) -> tuple[np.ndarray, np.ndarray]:
        """As `_first`: planes by distance, until one is met within its outline."""
        height = self.offsets[:, None] - self.normals @ points
        with np.errstate(divide="ignore", invalid="ignore"):
            along = height / (self.normals @ directions)
        ahead = along > 0
        ahead &= np.abs(height, out=height) > self.tolerance
        along[~ahead] = np.inf
        outline = along.argmin(axis=0)
        distance = along[outline, np.arange(len(outline))]
        unsure = np.flatnonzero(np.isfinite(distance))
        unsure = unsure[~self._within(outline[unsure], points[:, unsure], directions[:, unsure], distance[unsure])]
        while len(unsure):
            along[outline[unsure], unsure] = np.inf
            outline[unsure] = along[:, unsure].argmin(axis=0)
            distance[unsure] = along[outline[unsure], unsure]
            unsure = unsure[np.isfinite(distance[unsure])]
            unsure = unsure[~self._within(outline[unsure], points[:, unsure], directions[:, unsure], distance[unsure])]
        outline[np.isinf(distance)] = _MISS
        return outline, distance

    def _within(self, outline, points, directions, distance) -> np.ndarray:
        """(n,) bool: whether rays that meet an outline's plane meet the outline."""
        inward, start = self._edges
        height = np.einsum("nwc,cn->wn", inward[outline], points + distance * directions)
        return (height >= start[outline].T).all(axis=0)

    def pulled_inside(self, outline: int, places, margin) -> np.ndarray:
        """Places in an outline's plane, moved to within the outline where they lie outside.

        Parameters
        ----------
        outline : int
        places : (n, 3) float
        margin : (n,) float
            Distance to keep from the edges [m].

        Returns
        -------
        (n, 3) float
        """
        moved = np.array(places, float)
        inward, start = self._edges
        real = np.isfinite(start[outline])
        for _ in range(2):  # pushing in at one edge may push out at the next
            for across, least in zip(inward[outline][real], start[outline][real], strict=True):
                moved += np.maximum(least + margin - moved @ across, 0.0)[:, None] * across
        return moved

    def _meet(self, ray, candidate, points, directions, outline, distance) -> None:
        normal = self.normals[candidate]
        slope = dots(directions.take(ray, axis=0), normal)
        height = self.offsets[candidate] - dots(points.take(ray, axis=0), normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            along = height / slope
        near = (along > 0) & (np.abs(height) > self.tolerance) & (along < distance[ray])
        ray, candidate, along = ray[near], candidate[near], along[near]
        place = points[ray] + along[:, None] * directions[ray]
        inward, start = self._edges
        inside = (np.einsum("nwc,nc->nw", inward[candidate], place) >= start[candidate]).all(axis=1)
        ray, candidate, along = ray[inside], candidate[inside], along[inside]
        # several candidates of one ray may be here: write the nearest last
        order = np.argsort(-along, kind="stable")
        ray, candidate, along = ray[order], candidate[order], along[order]
        outline[ray], distance[ray] = candidate, along


@dataclass(frozen=True, eq=False)
class _Tree:
    """Complete binary tree of bounding boxes over outlines in Morton order."""

    order: np.ndarray
    boxes: list[np.ndarray]

    @classmethod
    def over(cls, vertices: np.ndarray, tolerance: float) -> _Tree:
        low, high = vertices.min(axis=1), vertices.max(axis=1)
        order = np.argsort(_morton(0.5 * (low + high)), kind="stable")
        leaves = 1 << max(0, int(np.ceil(np.log2(len(order) / _LEAF))))
        padded = np.full(leaves * _LEAF, _MISS)
        padded[: len(order)] = order
        pad = max(tolerance, 1e-12)
        lows = np.where((padded >= 0)[:, None], low[padded] - pad, np.inf).reshape(leaves, _LEAF, 3).min(axis=1)
        highs = np.where((padded >= 0)[:, None], high[padded] + pad, -np.inf).reshape(leaves, _LEAF, 3).max(axis=1)
        boxes = [np.stack([lows, highs], axis=1)]
        while len(boxes[0]) > 1:
            below = boxes[0].reshape(-1, 2, 2, 3)
            boxes.insert(0, np.stack([below[:, :, 0].min(axis=1), below[:, :, 1].max(axis=1)], axis=1))
        return cls(padded, boxes)

    def search(self, points, directions, distance, meet: Callable[[np.ndarray, np.ndarray], None]) -> None:
        """Find outlines that rays may meet, nearest boxes first.

        Parameters
        ----------
        points, directions : (n, 3) float
        distance : (n,) float
            To the nearest hit so far: what is farther is not looked at.
        meet : callable(ray, outline)
            Called with pairs whose leaf's box the ray meets; lowers ``distance``.
        """
        with np.errstate(divide="ignore"):
            inverse = 1.0 / np.where(directions == 0, 1e-300, directions)
        rays = points, inverse, distance
        first = max(1, len(self.boxes) - _SUBTREE)
        every = np.arange(len(points))
        ray, node, enter = self._down(rays, every, np.zeros(len(points), np.int64), range(first))
        order = np.lexsort((enter, ray))
        ray, node, enter = ray[order], node[order], enter[order]
        turn = np.arange(len(ray)) - np.searchsorted(ray, ray)
        level = np.frexp(turn + 1.0)[1]  # the first, the next two, the next four ...
        for now in range(1, int(level.max(initial=0)) + 1):
            mine = np.flatnonzero((level == now) & (enter < distance[ray]))
            if not len(mine):
                continue
            some, leaf, _ = self._down(rays, *_halves(ray[mine], node[mine]), range(first, len(self.boxes)))
            for k in range(_LEAF):
                candidate = self.order[leaf * _LEAF + k]
                real = candidate >= 0
                meet(some[real], candidate[real])

    def _down(self, rays, ray, node, levels: range):
        """Pairs of ray and box on the last of some levels that are met before what is known; and how far they are."""
        points, inverse, distance = rays
        enter = np.zeros(len(ray))
        for level in levels:
            boxes = self.boxes[level].take(node, axis=0)
            start, factor = points.take(ray, axis=0), inverse.take(ray, axis=0)
            with np.errstate(invalid="ignore", over="ignore"):
                a = (boxes[:, 0] - start) * factor
                b = (boxes[:, 1] - start) * factor
            near, far = np.minimum(a, b), np.maximum(a, b)
            enter = np.maximum(np.maximum(near[:, 0], near[:, 1]), near[:, 2])
            leave = np.minimum(np.minimum(far[:, 0], far[:, 1]), far[:, 2])
            met = (leave >= enter) & (leave > 0) & (enter < distance[ray])
            met &= boxes[:, 0, 0] <= boxes[:, 1, 0]  # empty boxes have no sides
            ray, node, enter = ray[met], node[met], enter[met]
            if level + 1 < levels.stop:
                ray, node = _halves(ray, node)
        return ray, node, enter


def _halves(ray: np.ndarray, node: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of ray and box with both halves of each box on the next level."""
    node = np.repeat(2 * node, 2)
    node[1::2] += 1
    return np.repeat(ray, 2), node


def _morton(points: np.ndarray) -> np.ndarray:
    extent = np.maximum(np.ptp(points, axis=0), 1e-300)
    cell = ((points - points.min(axis=0)) / extent * 1023).astype(np.int64)
    code = np.zeros(len(points), np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code
