"""Single rays: the nearest outline along each, for scenes of many outlines and the ends of deep specular chains."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons
from .arrays import dots, onto
from .tree import Tree

_FEW = 48

_EACH = 20_000
"""Of more outlines it is their boxes that are asked whether they lie above planes."""

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
    def edges(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """For each corner, normals ``(o, 3)`` of the edges after it, inward, and what points inside are above ``(o,)``.

        One after the other, as there may be a million.
        """
        found = []
        for k in range(self.vertices.shape[1]):
            corner = self.vertices[:, k]
            inward = polygons.cross(self.normals, self.vertices[:, (k + 1) % self.vertices.shape[1]] - corner)
            length = np.linalg.norm(inward, axis=1)
            real = length > 0
            inward /= np.where(real, length, 1.0)[:, None]
            found.append((inward, np.where(real, dots(inward, corner) - 1e-3 * self.tolerance, -np.inf)))
        return found

    @cached_property
    def spheres(self) -> tuple[np.ndarray, np.ndarray]:
        """Middles ``(o, 3)`` and radii ``(o,)`` of spheres around the outlines."""
        low, high = self.vertices.min(axis=1), self.vertices.max(axis=1)
        middle = 0.5 * (low + high)
        radius = np.zeros(len(middle))
        for k in range(self.vertices.shape[1]):
            np.maximum(radius, np.linalg.norm(self.vertices[:, k] - middle, axis=1), out=radius)
        return middle, radius

    @cached_property
    def _tree(self) -> Tree:
        return Tree.over(self.vertices, self.tolerance)

    def nearest(self, points, directions, within=np.inf, among: Tree | None = None) -> tuple[np.ndarray, np.ndarray]:
        """First outline that each ray meets.

        Parameters
        ----------
        points, directions : (n, 3) float
        within : (n,) float, optional
            Distances beyond which nothing is looked for, in lengths of the direction.
        among : Tree, optional
            Of the outlines to look for, see `above`.

        Returns
        -------
        outline : (n,) int
            -1 where nothing is met.
        distance : (n,) float
            In lengths of the direction; inf where nothing is met.
        """
        points, directions = np.asarray(points, float), np.asarray(directions, float)
        outline, distance = np.empty(len(points), np.int64), np.empty(len(points))
        limit = np.broadcast_to(np.asarray(within, float), len(points))
        for some in self._blocks(len(points)):
            outline[some], distance[some] = self._first(points[some].T, directions[some].T, limit[some], among)
        return outline, distance

    def above(self, normals, offsets) -> Tree:
        """Of outlines with some corner above every plane ``normals (h, 3) · x = offsets (h,)``."""
        if len(self.vertices) > _EACH:
            return self._tree.above(normals, offsets)
        alive = np.ones(len(self.vertices), bool)
        for normal, offset in zip(normals, offsets, strict=True):
            alive &= (self.vertices @ normal > offset + self.tolerance).any(axis=1)
        return self._tree.of(alive)

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
            outline, distance = self._first(points, directions, np.full(points.shape[1], np.inf), None)
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

    def _first(self, points, directions, within, among: Tree | None) -> tuple[np.ndarray, np.ndarray]:
        """Outlines that rays ``(3, n)`` meet first within distances ``(n,)``, and how far along."""
        if len(self.vertices) <= _FEW:
            return self._first_of_few(points, directions, within)
        outline = np.full(points.shape[1], _MISS)
        distance = np.array(within, float)
        points, directions = np.ascontiguousarray(points.T), np.ascontiguousarray(directions.T)

        def meet(ray: np.ndarray, candidate: np.ndarray) -> None:
            self._meet(ray, candidate, points, directions, outline, distance)

        (among or self._tree).search(points, directions, distance, meet)
        distance[outline == _MISS] = np.inf
        return outline, distance

    def _first_of_few(self, points, directions, within) -> tuple[np.ndarray, np.ndarray]:
        """As `_first`: planes by distance, until one is met within its outline."""
        height = self.offsets[:, None] - self.normals @ points
        with np.errstate(divide="ignore", invalid="ignore"):
            along = height / (self.normals @ directions)
        ahead = (along > 0) & (along < within)
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
        places = (points + distance * directions).T
        inside = np.ones(len(outline), bool)
        for inward, start in self.edges:
            inside &= dots(inward.take(outline, axis=0), places) >= start.take(outline)
        return inside

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
        edges = [(inward[outline], start[outline]) for inward, start in self.edges]
        for _ in range(2):  # pushing in at one edge may push out at the next
            for across, least in edges:
                moved += np.maximum(least + margin - onto(moved, across), 0.0)[:, None] * across
        return moved

    def _meet(self, ray, candidate, points, directions, outline, distance) -> None:
        way, normal = directions.take(ray, axis=0), self.normals.take(candidate, axis=0)
        place = points.take(ray, axis=0)
        height = self.offsets.take(candidate) - dots(place, normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            along = height / dots(way, normal)
        near = np.flatnonzero((along > 0) & (np.abs(height) > self.tolerance) & (along < distance.take(ray)))
        ray, candidate, along = ray.take(near), candidate.take(near), along.take(near)
        place = place.take(near, axis=0) + along[:, None] * way.take(near, axis=0)
        for inward, start in self.edges:
            inside = np.flatnonzero(dots(inward.take(candidate, axis=0), place) >= start.take(candidate))
            ray, candidate, along = ray.take(inside), candidate.take(inside), along.take(inside)
            place = place.take(inside, axis=0)
        # several candidates of one ray may be here: write the nearest last
        order = np.argsort(-along, kind="stable")
        ray, candidate, along = ray[order], candidate[order], along[order]
        outline[ray], distance[ray] = candidate, along
