"""Single rays, followed one by one through mirrors and panes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from .arrays import onto
from .outlines import Outlines
from .projection import Beams
from .sighting import Rays, Sighting, ray_sighting

DEEPEST_CHAIN = 200
"""No chain is followed further, even between perfect mirrors."""

_FAINT = 6e-4
"""Where panes mirror as well as transmit, rays that show less than this of what all rays of a receiver show are thinned
out to fewer that show as much, and go on one way: else they would double at every pane."""

FAINTEST = 1e-5
"""Rays that show less than this of all that a receiver sees are thinned out however little its others show."""

_MOST_IMAGES = 80
_MOST_OF_SOURCES, _MOST_OF_FIRST = 400, 2_000
"""Images times luminous polygons, in all orders and in the first."""

_MOST_MIRRORS = 140
"""Of more none is looked into for polygons: each makes a sun patch, so that their images would be as many squared."""

_DEEPEST_IMAGE = 40
_WALLS_OF_BOX = 6
_RIGHT_ANGLE = 1e-6


@dataclass
class ChainLimits:
    """When to stop following a chain.

    Attributes
    ----------
    cutoff : float
        Smallest product of reflectances and transmittances that is still followed.
    exact_mirrors : int
        Up to this many mirrors on the way, bright polygons are gathered exactly (see `sources`).
    """

    cutoff: float = 1e-3
    exact_mirrors: int = 0

    def kind(self, mirrors: np.ndarray) -> np.ndarray:
        """0, 1 or the first number beyond `exact_mirrors`: what sightings that share a treatment are known by."""
        return np.where(mirrors > self.exact_mirrors, self.exact_mirrors + 1, np.minimum(mirrors, 1))


def exact_mirrors(outlines: Outlines) -> int:
    """How many mirrors on the way leave images few enough to be looked for one by one.

    Between n mirrors there are at most n (n − 1)^(k − 1) images of order k; between up to six at right angles, as walls
    of a box are, about 4 k² + 2. Those of the first order are looked for even where they are many.
    """
    mirrors = np.flatnonzero([m.is_specular for m in outlines.materials])
    n, box = len(mirrors), _at_right_angles(outlines.normals[mirrors])
    shining = np.array([m.exitance > 0 for m in outlines.materials])
    sources = int(shining.sum() + (shining & outlines.two_sided).sum())
    most = min(_MOST_IMAGES, _MOST_OF_SOURCES // max(sources, 1))
    if n > _MOST_MIRRORS or n * sources > _MOST_OF_FIRST:
        return 0
    images, order = 0, 0
    while order < _DEEPEST_IMAGE:
        every = n * max(n - 1, 1) ** order
        images += min(every, 4 * (order + 1) ** 2 + 2) if box and n <= _WALLS_OF_BOX else every
        if order and images > most:
            break
        order += 1
    return order


def _at_right_angles(normals) -> bool:
    """Whether planes of normals ``(n, 3)`` are all parallel or at right angles to each other."""
    cosines = np.abs(normals @ normals.T)
    return bool((np.minimum(cosines, 1 - cosines) < _RIGHT_ANGLE).all())


@dataclass(frozen=True, eq=False)
class Tracer:
    """Follows rays among outlines.

    Attributes
    ----------
    outlines : Outlines
    limits : ChainLimits
    """

    outlines: Outlines
    limits: ChainLimits

    def trace(
        self, left: list[Rays], truncated: np.ndarray, checkpoint: Callable[[], None], none: Beams
    ) -> Iterator[Sighting]:
        """Follow rays one by one.

        Parameters
        ----------
        left : list of Rays
        truncated : (r,) float
            Gets the weight of what is cut off, in place.
        checkpoint : callable
        none : Beams
            No beams.
        """
        rays = Rays.joined(left)
        faint = np.maximum(_FAINT * np.bincount(rays.rows, rays.weights, len(truncated)), FAINTEST)
        while len(rays.rows):
            checkpoint()
            if self.outlines.splits_light:
                kept, weights = thinned(rays.rows, rays.weights, faint[rays.rows])
                rays = replace(rays.take(kept), weights=weights)
            flight = self.outlines.rays.through_mirrors(
                rays.points,
                rays.directions,
                rays.throughput,
                rays.depth,
                self.outlines.plain_mirrors,
                self.limits.cutoff,
                DEEPEST_CHAIN,
            )
            rays = rays.flown(flight)
            truncated += np.bincount(rays.rows[flight.faint], rays.weights[flight.faint], minlength=len(truncated))
            outline, distance = flight.outline, flight.distance
            kinds = np.where(flight.faint, -1, self.limits.kind(rays.mirrors))
            for kind in np.unique(kinds[kinds >= 0]):
                mine = np.flatnonzero(kinds == kind)
                yield ray_sighting(self.outlines, rays.take(mine), outline[mine], int(kind), none)
            rays = Rays.joined(self.after(rays, outline, distance, truncated, faint[rays.rows]))

    def after(self, rays: Rays, outline, distance, truncated, faint) -> list[Rays]:
        """Rays that met outlines ``(n,)``, after the mirrors and panes among these.

        Those of a weight below ``faint (n,)`` go on one way of two.
        """
        if not self.outlines.any_specular:
            return []
        met = np.flatnonzero(outline >= 0)
        place = rays.points[met] + distance[met, None] * rays.directions[met]
        onward = []
        for o in np.unique(outline[met]):
            material = self.outlines.materials[o]
            if not (material.is_specular or material.is_transparent):
                continue
            here = np.flatnonzero(outline[met] == o)
            here_rays = rays.take(met[here])
            cosine = onto(here_rays.directions, self.outlines.normals[o])
            onward += self._onward(here_rays, place[here], int(o), cosine, truncated, faint[met[here]])
        return onward

    def _onward(self, rays: Rays, places, o: int, cosine, truncated, faint) -> list[Rays]:
        """Rays that met an outline at ``places``, after it: those bright enough to follow."""
        onward = []
        for side in (True, False):
            mine = np.flatnonzero((cosine < 0) == side)
            if not len(mine):
                continue
            some = rays.take(mine)
            for kind, share in _either(list(self.outlines.ways(o, side, cosine[mine])), some, faint[mine]):
                going = np.flatnonzero(share > 0)
                after = some.take(going).onward(places[mine[going]], share[going], self.outlines.normals[o], kind)
                kept = (after.throughput >= self.limits.cutoff) & (after.depth < DEEPEST_CHAIN)
                np.add.at(truncated, after.rows[~kept], after.weights[~kept])
                onward.append(after.take(np.flatnonzero(kept)))
        return onward


def thinned(rows, weights, faint) -> tuple[np.ndarray, np.ndarray]:
    """Which of rays of weights ``(n,)`` to follow, and the weights of these: below ``faint`` for those left out too."""
    chance = np.minimum(weights / faint, 1.0)
    kept = np.flatnonzero(_drawn(rows, chance))
    return kept, weights[kept] / chance[kept]


def _either(ways: list[tuple[str, np.ndarray]], rays: Rays, faint) -> list[tuple[str, np.ndarray]]:
    """Ways on with the share of each ray ``(n,)``: of two, faint rays go one for both, in proportion to the shares."""
    if len(ways) < 2:
        return ways
    (one, first), (other, second) = ways
    both = first + second
    lone = rays.weights * both <= 2 * faint
    drawn = _drawn(rays.rows, np.divide(first, both, out=np.zeros_like(both), where=both > 0))
    return [
        (one, np.where(lone, np.where(drawn, both, 0.0), first)),
        (other, np.where(lone, np.where(drawn, 0.0, both), second)),
    ]


def _drawn(rows, chance) -> np.ndarray:
    """(n,) bool: as many rays of each receiver as their chances ``(n,)`` add up to, evenly spread among them."""
    order = np.argsort(rows, kind="stable")
    sums, own = np.cumsum(chance[order]), rows[order]
    first = np.flatnonzero(np.diff(own, prepend=-1))
    before = np.concatenate([[0.0], sums[:-1]])
    start = np.repeat(before[first], np.diff(np.append(first, len(own)))) - 0.5
    drawn = np.empty(len(rows), bool)
    drawn[order] = np.floor(sums - start) > np.floor(before - start)
    return drawn


@dataclass(frozen=True, eq=False)
class RaySight:
    """What receivers see along rays of their own.

    Attributes
    ----------
    outlines : Outlines
    limits : ChainLimits
    rays : Rays
        From all of them, ``rows`` being their numbers.
    none : Beams
        No beams.
    """

    outlines: Outlines
    limits: ChainLimits
    rays: Rays
    none: Beams

    def sightings(self, points, checkpoint: Callable[[], None] = lambda: None) -> tuple[Iterator[Sighting], np.ndarray]:
        """As `GroupSight.sightings`."""
        truncated = np.zeros(len(points))
        return Tracer(self.outlines, self.limits).trace([self.rays], truncated, checkpoint, self.none), truncated
