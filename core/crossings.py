"""Obstacles whose edges cross beams, and the share that a single edge leaves of a beam."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from .arrays import dots, onto, pick
from .projection import Beams, Obstacles, coverage
from .views import Eye

_WELL_BEHIND = 1.05
"""How much farther than a wholly seen obstacle a corner must be to be hidden without a closer look."""

_ASKEW = np.array([0.48, 0.6, 0.64], np.float32)
"""In line with nothing that is built, as a rule."""

_ALIGNED = 0.99
"""Cosine between edges that count as parallel within one beam."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """Obstacles that beams may be crossed by, ``n``; those that edges do cross, ``l``; and the edges that cross, ``m``.

    Attributes
    ----------
    row, beam, obstacle : (n,) int
    sine : (w, n) float32
        Of the angle from each edge's plane to the beam's centre, positive inside; inf where there is no edge.
    whole, grazing : (·,) int
        Candidates that no edge parts from the beam; and those beside it, but not beside the circle around it.
    crossed : (l,) int
        Candidates that edges cross.
    edges : (l,) int
        How many of them.
    pair : (m,) int
        Place in ``crossed`` that an edge belongs to.
    normal : (m, 3) float32
    across : (2, m) float32
        The beam's sides, projected on the edge's normal.
    place : (m,) float32
    """

    row: np.ndarray
    beam: np.ndarray
    obstacle: np.ndarray
    sine: np.ndarray
    whole: np.ndarray
    grazing: np.ndarray
    crossed: np.ndarray
    edges: np.ndarray
    pair: np.ndarray
    normal: np.ndarray
    across: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, row, beam, obstacle, sine, planes, heights, beams: Beams) -> Candidates:
        """Find the edges that really cross the beams: by their own shape, not the circle around them."""
        reach = beams.reach.astype(np.float32)[beam]
        edge, pair = np.nonzero(np.abs(sine) < reach)
        mine = beam.take(pair)
        first = (row * planes.shape[1] + obstacle) * planes.shape[2]
        normal = planes.reshape(-1, 3).take(first.take(pair) + edge, axis=0)
        across = np.stack([dots(side, normal) for side in beams.spans.take(mine, axis=0).swapaxes(0, 1)])
        place = pick(sine, edge, pair) - beams.lags.take(mine) * across[0]
        np.abs(across, out=across)
        support = 0.5 * (across[0] + across[1])
        round_ = np.flatnonzero(beams.odd[mine])
        support[round_] = reach[pair[round_]]
        beyond = (sine <= -reach).any(axis=0) | (pick(heights, row, obstacle) == 0)
        outside = beyond.copy()
        outside[pair[place <= -support]] = True
        crossing = np.flatnonzero((np.abs(place) < support) & ~outside[pair])
        edges = np.bincount(pair[crossing], minlength=len(row))
        idle = _idle(pair[crossing], edges, normal.take(crossing, axis=0), place[crossing], reach)
        edges -= np.bincount(pair[crossing[idle]], minlength=len(row))
        crossing = np.delete(crossing, idle)
        crossed = np.flatnonzero(edges)
        number = np.cumsum(edges > 0) - 1
        return cls(
            row,
            beam,
            obstacle,
            sine,
            np.flatnonzero((edges == 0) & ~outside),
            np.flatnonzero(outside & ~beyond),
            crossed,
            edges[crossed],
            number[pair[crossing]],
            normal.take(crossing, axis=0),
            across.take(crossing, axis=1),
            place[crossing],
        )


def _idle(pair, edges, normal, place, reach) -> np.ndarray:
    """Which edges of two that cross a beam bound nothing in it: they run outside the other, past the corner."""
    two = np.flatnonzero(edges[pair] == 2)
    two = two[np.argsort(pair[two], kind="stable")]
    a, b = two[::2], two[1::2]
    alike = dots(normal.take(a, axis=0), normal.take(b, axis=0))
    apart = np.sqrt(np.maximum(1 - alike * alike, 0))
    most = (1.05 * reach[pair[a]]) ** 2
    # the other edge's distance along each within the beam: at its middle, and how much it may change to either side
    beside_a = place[b] - place[a] * alike + np.sqrt(np.maximum(most - place[a] ** 2, 0)) * apart < 0
    beside_b = place[a] - place[b] * alike + np.sqrt(np.maximum(most - place[b] ** 2, 0)) * apart < 0
    return np.concatenate([a[beside_a & ~beside_b], b[beside_b & ~beside_a]])


@dataclass(frozen=True, eq=False)
class Crossed:
    """Obstacles whose edges cross beams, sorted by beam; all arrays of length n.

    ``number`` is their place among the candidates. ``share`` and ``offset`` are those by the crossing edge alone, where
    there is just one; ``edge_sum`` is the sum of the normals of the crossing edges' planes, and fourth of the cubes of
    what these are along some direction: where edges are no pairs of opposite ones, both hardly cancel.
    """

    row: np.ndarray
    beam: np.ndarray
    obstacle: np.ndarray
    number: np.ndarray
    share: np.ndarray
    offset: np.ndarray
    distance: np.ndarray
    edges: np.ndarray
    edge_sum: np.ndarray
    group: np.ndarray

    def take(self, index) -> Crossed:
        """Some of them."""
        return Crossed(*(getattr(self, f.name).take(index, axis=0) for f in fields(self)))

    @property
    def starts(self) -> np.ndarray:
        """Where each beam's obstacles begin."""
        return np.flatnonzero(np.concatenate(([True], self.group[1:] != self.group[:-1])))


def settle_whole(
    seen, nearest, start, candidates: Candidates, eye: Eye, beams: Beams, obstacles: Obstacles
) -> np.ndarray:
    """Enter obstacles that no edge parts from a beam into ``seen`` and ``nearest``, in place; gives their numbers."""
    whole = candidates.whole
    row, beam, obstacle = candidates.row[whole], candidates.beam[whole], candidates.obstacle[whole]
    towards = eye.towards(row, beam, beams)
    distance = _distance_along(eye.heights, obstacles, row, obstacle, towards).astype(np.float32)
    least = pick(start, row, beam) if start.shape[1] > 1 else start[row, 0]
    ahead = np.flatnonzero((distance > least) & (distance < pick(nearest, row, beam)))
    ahead = ahead[np.argsort(-distance[ahead], kind="stable")]  # the nearest is written last
    seen[row[ahead], beam[ahead]] = obstacle[ahead]
    nearest[row[ahead], beam[ahead]] = distance[ahead]
    return np.unique(obstacle[ahead])


def find_crossings(seen, candidates: Candidates, heights, beams: Beams, obstacles: Obstacles) -> Crossed:
    """Candidates that edges really cross, with the share that one edge alone leaves them."""
    mine, edges = candidates.crossed, candidates.edges
    row, beam, obstacle = candidates.row[mine], candidates.beam[mine], candidates.obstacle[mine]
    pair, normal = candidates.pair, candidates.normal
    covered, moment = coverage(candidates.place.astype(float), *candidates.across.astype(float))
    # exact for one edge, and near enough where edges meet at a corner
    share, edge_sum = np.ones(len(mine)), np.zeros((len(mine), 4), np.float32)
    askew = onto(normal, _ASKEW)
    told = np.concatenate([normal, (askew * askew * askew)[:, None]], axis=1)
    lone = edges.take(pair) == 1
    several = np.flatnonzero(~lone)
    lone = np.flatnonzero(lone)
    share[pair[lone]] = covered[lone]
    edge_sum[pair[lone]] = told.take(lone, axis=0)
    np.multiply.at(share, pair[several], covered[several])
    np.add.at(edge_sum, pair[several], told.take(several, axis=0))
    # of several edges the one that leaves least tells best where the part is
    most = np.zeros(len(mine), np.int64)
    most[pair[lone]] = lone
    least = np.ones(len(mine))
    np.minimum.at(least, pair[several], covered[several])
    several = several[covered[several] <= least[pair[several]]]
    most[pair[several]] = several
    offset = (moment / np.maximum(covered, 1e-12)).astype(np.float32).take(most)[:, None] * normal.take(most, axis=0)
    # what is nearer shows at the part's own centre: an edge may stand on the obstacle behind it
    towards = beams.directions.astype(np.float32).take(beam, axis=0) + offset
    distance = _distance_along(heights, obstacles, row, obstacle, towards)
    behind = pick(seen, row, beam)
    known = np.flatnonzero(behind >= 0)
    far = _distance_along(heights, obstacles, row[known], behind[known], towards.take(known, axis=0))
    far *= np.where(edges[known] < 2, 1.0, _WELL_BEHIND)
    shows = np.ones(len(mine), bool)
    shows[known] = ~(np.isfinite(distance[known]) & (distance[known] >= far))
    keep = np.flatnonzero(shows)
    key = row[keep] * len(beams.directions) + beam[keep]
    # with the obstacle no two are alike, so that the fast sort, which is not stable, will do
    order = np.argsort(key * len(obstacles.outlines) + obstacle[keep])
    keep, key = keep[order], key[order]
    group = np.cumsum(np.diff(key, prepend=key[:1]) > 0)
    return Crossed(
        row[keep],
        beam[keep],
        obstacle[keep],
        mine[keep],
        share[keep],
        offset.take(keep, axis=0),
        distance[keep],
        edges[keep],
        edge_sum.take(keep, axis=0),
        group,
    )


def subtract_aligned(crossed: Crossed) -> np.ndarray:
    """Settle beams that two obstacles cross with one edge each, almost parallel: slats, shelves, slits.

    Where both lie on the same side, the farther one shows only as far as it reaches beyond the nearer; its share is
    lowered accordingly, in place.

    Returns
    -------
    (groups,) bool
        Beams whose shares are now exact.
    """
    starts = crossed.starts
    size = np.diff(np.append(starts, len(crossed.group)))
    front = np.minimum(starts, len(crossed.row) - 2) if len(crossed.row) > 1 else starts
    back = front + (len(crossed.row) > 1)
    swap = crossed.distance[front] > crossed.distance[back]
    front, back = np.where(swap, back, front), np.where(swap, front, back)
    pair = (size == 2) & (crossed.edges[front] == 1) & (crossed.edges[back] == 1)
    alike = dots(crossed.edge_sum.take(front, axis=0), crossed.edge_sum.take(back, axis=0))
    nested = np.flatnonzero(pair & (alike > _ALIGNED))
    a, b = front[nested], back[nested]
    covered = np.maximum(crossed.share[b] - crossed.share[a], 0.0)
    moment = crossed.share[b, None] * crossed.offset[b] - crossed.share[a, None] * crossed.offset[a]
    crossed.offset[b] = np.where(covered[:, None] > 1e-6, moment / np.maximum(covered, 1e-6)[:, None], 0.0)
    crossed.share[b] = covered
    opposed = pair & (alike < -_ALIGNED)
    a, b = front[opposed], back[opposed]
    crossed.share[b] = np.minimum(crossed.share[b], 1.0 - crossed.share[a])
    return pair & (np.abs(alike) > _ALIGNED)


def _distance_along(heights, obstacles: Obstacles, row, obstacle, towards) -> np.ndarray:
    """(n,) float: distance from receivers to obstacles' planes along directions; inf where these lead away."""
    slope = dots(towards, obstacles.normals.take(obstacle, axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = pick(heights, row, obstacle) / slope
    return np.where(distance > 0, distance, np.inf)
