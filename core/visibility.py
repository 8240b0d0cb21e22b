"""What a group of receivers sees along the globe's shared directions: the nearest plane prevails (Claro 1998).

The planes strategy: every receiver of a group looks along the same directions, so whether a direction passes inside
an edge is a matrix product. Whole parcels inside an outline are settled there, in float32; parcels that an edge crosses
are settled by their covered share, in float64.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from . import polygons
from .projection import Beams, HalfSpace, Obstacles, coverage, edge_planes

OPEN = -1
"""Nothing in the way: sky or ground light."""

SHARED = -2
"""A parcel that an edge crosses: see the view's parts."""

_RAYS = (8, 11)
"""Order of the lattice of rays in a beam that several edges cross: 21 rays, then 89 where sky shows in part."""

_LONE_PRODUCT = 60_000

_ON_EDGE = 1e-6
"""Rays this close to an edge [rad] count as inside, so that none slips between two obstacles that share it."""

_SEAM = 1e-4
"""Edges whose planes through the receiver are this close [rad], with an obstacle on either side, leave no opening."""

_WELL_BEHIND = 1.05
"""How much farther than a wholly seen obstacle a corner must be to be hidden without a closer look."""

_BACKS_LAST = 1e-6
"""How much farther than they are backs stand: where two sides of a solid meet, the one that faces a receiver shows."""

_ALIGNED = 0.99
"""Cosine between edges that count as parallel within one beam."""

_SAME_EDGE = 1e-4
"""Shares of two obstacles at one edge that sum to 1 this closely belong to obstacles that share the edge."""


@dataclass(frozen=True, eq=False)
class View:
    """What receivers see along beams.

    Attributes
    ----------
    seen : (r, k) int16 or int32
        Obstacle seen along the whole beam, OPEN, or SHARED.
    part_row, part_beam, part_seen : (p,) int
        Receiver, beam and obstacle (or OPEN) of each part of a shared beam.
    part_share : (p,) float
        Share of the beam's cosine-weighted solid angle; the shares of one beam sum to 1.
    part_direction : (p, 3) float
        Towards the part's centre, not normalised.
    nearest : (r, k) float32
        Distance along each beam to the obstacle seen wholly [m].
    columns : dict of int to (c,) int
        For each obstacle that may be seen wholly, the beams that may see it.
    heights : (r, o) float, or what can be indexed like it
        Signed distance from each receiver to each obstacle's plane, along the obstacle's normal [m].
    """

    seen: np.ndarray
    part_row: np.ndarray
    part_beam: np.ndarray
    part_seen: np.ndarray
    part_share: np.ndarray
    part_direction: np.ndarray
    nearest: np.ndarray
    columns: dict[int, np.ndarray]
    heights: Any


@dataclass(frozen=True, eq=False)
class Partial:
    """Beams that come through a mirror or pane in part.

    Attributes
    ----------
    row, beam : (n,) int
    direction : (n, 3) float
        Towards the centre of the part.
    window : (r, w, 3) float32
        For each receiver the planes through the edges of the mirror or pane, positive inside.
    """

    row: np.ndarray
    beam: np.ndarray
    direction: np.ndarray
    window: np.ndarray


def look(
    points,
    normal,
    beams: Beams,
    obstacles: Obstacles,
    tolerance: float,
    past: HalfSpace | None = None,
    partial: Partial | None = None,
) -> View:
    """Find the nearest obstacle along each beam from each point.

    Parameters
    ----------
    points : (r, 3) float
        Receivers, near each other for speed (columns of beams are settled for all of them at once where possible).
    normal : (3,) float
        Of the receivers' plane: parts of a beam count by the cosine.
    beams : Beams
    obstacles : Obstacles
        Cut to what these beams can meet.
    tolerance : float
        Distance below which a point lies in a plane [m].
    past : HalfSpace, optional
        Only what the beams meet inside it counts: beyond the mirror or pane that they come through.
    partial : Partial, optional
        Beams of which only a part gets there; they are settled as parts of beams throughout.

    Returns
    -------
    View
    """
    points = np.asarray(points, float)
    rows, count = len(points), len(beams.directions)
    seen = np.full((rows, count), OPEN, np.int32)
    nearest = np.full((rows, count), np.inf, np.float32)
    planes, heights = edge_planes(points, obstacles, tolerance)
    heights[heights > 0] *= 1 + _BACKS_LAST
    reach = beams.reach * 1.01 + 1e-6
    hull = _bounding_corners(points)
    slopes = beams.directions @ obstacles.normals.T
    start = np.zeros((len(points), 1), np.float32) if past is None else _distance_to(past, points, beams.directions)
    if partial is not None and past is not None:
        start[partial.row, partial.beam] = _along(past, points[partial.row], partial.direction)
    found = []
    width = obstacles.bounding.shape[1]
    possible: dict[int, np.ndarray] = {}
    within: dict[int, np.ndarray] = {}
    for o in range(len(obstacles.outlines)):
        bounded = obstacles.bounding[o]
        columns, certain = _columns_within(hull, obstacles.vertices[o], bounded, heights[:, o], beams.directions, reach)
        if not len(columns):
            continue
        edges = planes[:, o, bounded].astype(np.float32)
        with np.errstate(divide="ignore", over="ignore"):
            slope = (1.0 / slopes[columns, o]).astype(np.float32)
        distance = heights[:, o].astype(np.float32)[:, None] * slope
        if partial is not None:
            _set_partial(distance, partial, columns, heights[:, o], obstacles.normals[o])
        if not certain.all():
            sines = _edge_sines(edges, beams.directions[columns].astype(np.float32))
            inside = sines[0].copy() if len(sines) else np.full(distance.shape, np.inf, np.float32)
            for other in sines[1:]:
                np.minimum(inside, other, out=inside)
            limit = reach[columns].astype(np.float32)
            whole = inside > limit
            near = np.flatnonzero(np.abs(inside, out=inside) <= limit)
            if len(near):
                row, column = np.divmod(near, len(columns))
                if past is not None:
                    ahead = ~((distance[row, column] > 0) & (distance[row, column] < start[row, columns[column]]))
                    near, row, column = near[ahead], row[ahead], column[ahead]
                sine = np.full((len(near), width), np.inf, np.float32)
                for edge, values in zip(np.flatnonzero(bounded), sines, strict=True):
                    sine[:, edge] = values.ravel()[near]
                found.append((row, columns[column], np.full(len(row), o), sine))
                within[o] = columns
        else:
            whole = np.ones(distance.shape, bool)
        before = nearest[:, columns]
        whole &= distance < before
        whole &= distance > (start if past is None else start[:, columns])
        if whole.any():
            nearest[:, columns] = np.where(whole, distance, before)
            seen[:, columns] = np.where(whole, np.int32(o), seen[:, columns])
            possible[o] = columns
    if found:
        candidates = tuple(np.concatenate(x) for x in zip(*found, strict=True))
        eye = _Eye(points, planes.astype(np.float32), heights, np.asarray(normal, float), past, partial)
        candidates = _Candidates.of(*candidates, eye.planes, heights, beams)
        for o in _settle_whole(seen, nearest, start, candidates, eye, beams, obstacles):
            possible.setdefault(int(o), within[int(o)])
        crossed = _crossings(seen, candidates, heights, beams, obstacles)
        view = _settle_parts(seen, nearest, possible, crossed, eye, beams, obstacles)
    else:
        empty = np.zeros(0, np.int64)
        view = View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), nearest, possible, heights)
    return view if partial is None else _with_partial(view, partial)


@dataclass(frozen=True, eq=False)
class _Eye:
    """Where receivers look from: what settling parts of beams needs to know of them."""

    points: np.ndarray
    planes: np.ndarray
    heights: np.ndarray
    normal: np.ndarray
    past: HalfSpace | None
    partial: Partial | None

    def part_of(self, row, beam, beams: int) -> np.ndarray:
        """(n,) int: which of the partial beams these are; -1 for those that get here wholly."""
        if self.partial is None:
            return np.full(len(row), -1)
        mark = np.full((len(self.points), beams), -1)
        mark[self.partial.row, self.partial.beam] = np.arange(len(self.partial.row))
        return mark[row, beam]

    def towards(self, row, beam, beams: Beams) -> np.ndarray:
        """(n, 3) float: the centre of each beam, or of the part of it that gets here."""
        directions = beams.directions[beam]
        if self.partial is not None:
            part = self.part_of(row, beam, len(beams.directions))
            directions[part >= 0] = self.partial.direction[part[part >= 0]]
        return directions


def _set_partial(distance, partial: Partial, columns, heights, normal) -> None:
    """Distances of partial beams along the direction of their part, in place."""
    place = np.full(int(max(columns.max(), partial.beam.max())) + 1, -1)
    place[columns] = np.arange(len(columns))
    column = place[partial.beam]
    mine = np.flatnonzero(column >= 0)
    row = partial.row[mine]
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        along = heights[row] / (partial.direction[mine] @ normal)
    distance[row, column[mine]] = along


def _with_partial(view: View, partial: Partial) -> View:
    """The view with beams that are partial, and see one thing or nothing, listed among the parts."""
    found = view.seen[partial.row, partial.beam]
    mine = np.flatnonzero(found != SHARED)
    row, beam = partial.row[mine], partial.beam[mine]
    view.seen[row, beam] = SHARED
    return replace(
        view,
        part_row=np.concatenate([view.part_row, row]),
        part_beam=np.concatenate([view.part_beam, beam]),
        part_seen=np.concatenate([view.part_seen, found[mine]]),
        part_share=np.concatenate([view.part_share, np.ones(len(mine))]),
        part_direction=np.concatenate([view.part_direction, partial.direction[mine]]),
    )


def _along(plane: HalfSpace, points, directions) -> np.ndarray:
    """(n,) float: distance from each point along its direction to a plane, a little less."""
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (plane.offset - points @ plane.normal) / np.einsum("...c,c->...", directions, plane.normal)
    return along * (1 - 1e-5)


def _distance_to(plane: HalfSpace, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(r, k) float32: distance along each beam to a plane, a little less so that what stands on the plane counts."""
    with np.errstate(divide="ignore", over="ignore"):
        slope = (1.0 / (directions @ plane.normal)).astype(np.float32)
    return (plane.offset - points @ plane.normal).astype(np.float32)[:, None] * slope * np.float32(1 - 1e-5)


def _bounding_corners(points: np.ndarray) -> np.ndarray:
    low, high = points.min(axis=0), points.max(axis=0)
    if len(points) == 1:
        return points
    pick = np.indices((2, 2, 2)).reshape(3, -1).T
    return np.unique(np.where(pick, high, low), axis=0)


def _columns_within(hull, outline, bounded, heights, directions, reach):
    """Beams that may meet an obstacle from some receiver, and which of them meet it wholly from all.

    Before normalising, the distance to an edge is affine in the receiver's position, so its extremes over
    the receivers are among those over the corners of their bounding box.
    """
    every = np.arange(len(directions))
    if heights.min() * heights.max() <= 0:  # receivers on both sides, or in the plane
        if not heights.any():
            return every[:0], np.zeros(0, bool)
        return every, np.zeros(len(every), bool)
    sign = np.sign(heights[0])
    relative = outline[None] - hull[:, None]
    planes = (polygons.cross(relative, np.roll(relative, -1, axis=1)) * sign)[:, bounded]
    if not planes.shape[1]:
        return every, np.zeros(len(every), bool)
    length = np.linalg.norm(planes, axis=2).max(axis=0)
    products = np.einsum("kc,hec->ehk", directions, planes)
    margin = length[:, None] * reach[None]
    possible = (products.max(axis=1) >= -margin).all(axis=0)
    columns = np.flatnonzero(possible)
    certain = (products.min(axis=1)[:, columns] > margin[:, columns]).all(axis=0)
    return columns, certain


def _edge_sines(edges: np.ndarray, directions: np.ndarray) -> list[np.ndarray]:
    """For each edge (r, k) float32: sine of the angle from each beam's centre to its plane, positive inside."""
    across = np.ascontiguousarray(directions.T)
    # products this small are not split over threads by BLAS, which would wait for each other here
    step = max(1, _LONE_PRODUCT // max(1, len(edges)))
    sines = []
    for e in range(edges.shape[1]):
        edge = np.ascontiguousarray(edges[:, e])
        sine = np.empty((len(edges), across.shape[1]), np.float32)
        for first in range(0, across.shape[1], step):
            np.matmul(edge, np.ascontiguousarray(across[:, first : first + step]), out=sine[:, first : first + step])
        sines.append(sine)
    return sines


@dataclass(frozen=True, eq=False)
class _Crossed:
    """Obstacles whose edges cross beams, sorted by beam and then by distance; all arrays of length n.

    ``share`` and ``offset`` are those by the crossing edge alone, where there is just one; ``edge_sum`` is the sum of
    the normals of the crossing edges' planes.
    """

    row: np.ndarray
    beam: np.ndarray
    obstacle: np.ndarray
    sine: np.ndarray
    share: np.ndarray
    offset: np.ndarray
    distance: np.ndarray
    edges: np.ndarray
    edge_sum: np.ndarray
    group: np.ndarray

    def take(self, index) -> _Crossed:
        """Some of them."""
        return _Crossed(*(getattr(self, f.name)[index] for f in fields(self)))

    @property
    def starts(self) -> np.ndarray:
        """Where each beam's obstacles begin."""
        return np.flatnonzero(np.concatenate(([True], self.group[1:] != self.group[:-1])))


def _settle_parts(seen, nearest, possible, crossed: _Crossed, eye: _Eye, beams: Beams, obstacles: Obstacles) -> View:
    heights, normal = eye.heights, eye.normal
    if not len(crossed.row):
        empty = np.zeros(0, np.int64)
        return View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), nearest, possible, heights)
    starts, group = crossed.starts, crossed.group
    aligned = _subtract_aligned(crossed)
    head = crossed.row[starts], crossed.beam[starts]
    background = seen[head]
    total = np.add.reduceat(crossed.share, starts)
    size = np.diff(np.append(starts, len(group)))
    most_edges = np.maximum.reduceat(crossed.edges, starts)
    lone = (size == 1) & (most_edges <= 1)
    joined = (size == 2) & (most_edges == 1) & (np.abs(total - 1) < _SAME_EDGE)
    joined &= np.add.reduceat(crossed.edges, starts) == 2
    ahead = np.isfinite(np.maximum.reduceat(crossed.distance, starts))
    simple = (joined | lone | aligned) & ahead
    simple &= joined | (background != OPEN) | ~beams.odd[head[1]]
    partial = eye.part_of(*head, len(beams.directions)) >= 0
    simple &= ~partial
    # every crossing edge met by an opposite one: a corner where obstacles close
    closed = np.zeros(len(starts), bool)
    closed[~simple] = np.linalg.norm(_group_sums(crossed.edge_sum, starts, ~simple), axis=1) < _SEAM

    # several edges, but no opening: shares by each edge alone, brought to a sum of 1
    filled = ~simple & (total > 1e-9) & closed & (background == OPEN) & ~partial
    # the part's share of the cosine-weighted beam, to first order
    cosine = beams.directions @ normal
    share = crossed.share * np.clip(1 + (crossed.offset @ normal) / cosine[crossed.beam], 0.0, 2.0)
    weighted = np.add.reduceat(share, starts)
    # two obstacles share the edge: nothing is left between them, to the last bit
    whole = joined | filled
    share /= np.where(whole, weighted, 1.0)[group]
    left = np.where(whole, 0.0, np.clip(1.0 - weighted, 0.0, 1.0))
    towards = beams.directions[crossed.beam] + crossed.offset
    left_towards = beams.directions[head[1]]
    rest = simple & (left > 0)
    moment = _group_sums(crossed.share[:, None] * crossed.offset, starts, rest)
    left_towards[rest] -= moment / np.maximum(1.0 - total[rest], 1e-3)[:, None]

    open_ = ~simple & ~filled
    for order in _RAYS:
        mine, groups = np.flatnonzero(open_[group]), np.flatnonzero(open_)
        if not len(groups):
            break
        share[mine], towards[mine], left[groups], left_towards[groups] = _sample_parts(
            crossed.take(mine), background[groups], order, eye, beams, obstacles
        )
        open_ &= (left > 0) & (left < 1) & (background == OPEN)
    seen[head] = SHARED
    remains, lit = left > 1e-9, share > 1e-9
    return View(
        seen,
        np.concatenate([crossed.row[lit], head[0][remains]]),
        np.concatenate([crossed.beam[lit], head[1][remains]]),
        np.concatenate([crossed.obstacle[lit], background[remains]]),
        np.concatenate([share[lit], left[remains]]),
        np.concatenate([towards[lit], left_towards[remains]]),
        nearest,
        possible,
        heights,
    )


def _distance_along(heights, obstacles: Obstacles, row, obstacle, towards) -> np.ndarray:
    """(n,) float: distance from receivers to obstacles' planes along directions; inf where these lead away."""
    slope = np.einsum("nc,nc->n", towards, obstacles.normals[obstacle])
    with np.errstate(divide="ignore", invalid="ignore"):
        along = heights[row, obstacle] / slope
    return np.where(along > 0, along, np.inf)


def _subtract_aligned(crossed: _Crossed) -> np.ndarray:
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
    pair = (size == 2) & (crossed.edges[front] == 1) & (crossed.edges[back] == 1)
    alike = np.einsum("gc,gc->g", crossed.edge_sum[front], crossed.edge_sum[back])
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


def _group_sums(values: np.ndarray, starts: np.ndarray, which: np.ndarray) -> np.ndarray:
    """(w, c) float: sums of values ``(n, c)`` over some of the groups that begin at ``starts``."""
    rows = np.flatnonzero(np.repeat(which, np.diff(np.append(starts, len(values)))))
    if not len(rows):
        return np.zeros((0, values.shape[1]))
    sizes = np.diff(np.append(starts, len(values)))[which]
    return np.add.reduceat(values[rows], np.cumsum(sizes) - sizes, axis=0)


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Obstacles that beams may be crossed by, one row each (n); and the edges that cross (m).

    Attributes
    ----------
    row, beam, obstacle : (n,) int
    sine : (n, w) float32
    outside : (n,) bool
        The beam passes beside the obstacle.
    edges : (n,) int
        How many edges cross the beam; where none does, it meets the obstacle wholly or not at all.
    pair : (m,) int
        Which candidate an edge belongs to.
    normal : (m, 3) float32
    across : (m, 2) float32
        The beam's sides, projected on the edge's normal.
    place : (m,) float32
    """

    row: np.ndarray
    beam: np.ndarray
    obstacle: np.ndarray
    sine: np.ndarray
    outside: np.ndarray
    edges: np.ndarray
    pair: np.ndarray
    normal: np.ndarray
    across: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, row, beam, obstacle, sine, planes, heights, beams: Beams) -> _Candidates:
        """Find the edges that really cross the beams: by their own shape, not the circle around them."""
        reach = beams.reach.astype(np.float32)[beam]
        pair, edge = np.nonzero(np.abs(sine) < reach[:, None])
        normal = planes[row[pair], obstacle[pair], edge]
        across = np.abs(np.matmul(beams.spans[beam[pair]], normal[:, :, None])[:, :, 0])
        place = sine[pair, edge]
        support = np.where(beams.odd[beam[pair]], reach[pair], 0.5 * (across[:, 0] + across[:, 1]))
        outside = (sine <= -reach[:, None]).any(axis=1) | (heights[row, obstacle] == 0)
        outside[pair[place <= -support]] = True
        crossing = np.abs(place) < support
        pair = pair[crossing]
        edges = np.bincount(pair, minlength=len(row))
        return cls(row, beam, obstacle, sine, outside, edges, pair, normal[crossing], across[crossing], place[crossing])


def _settle_whole(
    seen, nearest, start, candidates: _Candidates, eye: _Eye, beams: Beams, obstacles: Obstacles
) -> np.ndarray:
    """Enter obstacles that no edge parts from a beam into ``seen`` and ``nearest``, in place; gives their numbers."""
    whole = np.flatnonzero((candidates.edges == 0) & ~candidates.outside)
    row, beam, obstacle = candidates.row[whole], candidates.beam[whole], candidates.obstacle[whole]
    towards = eye.towards(row, beam, beams)
    distance = _distance_along(eye.heights, obstacles, row, obstacle, towards).astype(np.float32)
    least = start[row, beam] if start.shape[1] > 1 else start[row, 0]
    ahead = np.flatnonzero((distance > least) & (distance < nearest[row, beam]))
    ahead = ahead[np.argsort(-distance[ahead], kind="stable")]  # the nearest is written last
    seen[row[ahead], beam[ahead]] = obstacle[ahead]
    nearest[row[ahead], beam[ahead]] = distance[ahead]
    return np.unique(obstacle[ahead])


def _crossings(seen, candidates: _Candidates, heights, beams: Beams, obstacles: Obstacles) -> _Crossed:
    """Candidates that edges really cross, with the share that one edge alone leaves them."""
    row, beam, obstacle, edges = candidates.row, candidates.beam, candidates.obstacle, candidates.edges
    pair, normal = candidates.pair, candidates.normal
    offset = np.zeros((len(row), 3), np.float32)
    covered, moment = coverage(candidates.place.astype(float), *candidates.across.T.astype(float))
    # exact for one edge, and near enough where edges meet at a corner
    share = np.exp(np.bincount(pair, weights=np.log(np.maximum(covered, 1e-30)), minlength=len(row)))
    offset[pair] = (moment / np.maximum(covered, 1e-12))[:, None] * normal
    # what is nearer shows at the part's own centre: an edge may stand on the obstacle behind it
    towards = beams.directions.astype(np.float32)[beam] + offset
    distance = _distance_along(heights, obstacles, row, obstacle, towards)
    far = np.full(len(row), np.inf)
    known = np.flatnonzero(seen[row, beam] >= 0)
    far[known] = _distance_along(heights, obstacles, row[known], seen[row[known], beam[known]], towards[known])
    behind = np.isfinite(distance) & (distance >= np.where(edges < 2, far, _WELL_BEHIND * far))
    edge_sum = np.zeros((len(row), 3), np.float32)
    lone = edges[pair] == 1
    edge_sum[pair[lone]] = normal[lone]
    np.add.at(edge_sum, pair[~lone], normal[~lone])
    keep = np.flatnonzero(~candidates.outside & (edges > 0) & ~behind)
    key = row[keep] * len(beams.directions) + beam[keep]
    order = np.lexsort((distance[keep], key))
    group = np.cumsum(np.diff(key[order], prepend=key[order[:1]]) > 0)
    keep = keep[order]
    return _Crossed(
        row[keep],
        beam[keep],
        obstacle[keep],
        candidates.sine[keep],
        share[keep],
        offset[keep],
        distance[keep],
        edges[keep],
        edge_sum[keep],
        group,
    )


def _sample_parts(crossed: _Crossed, background, order: int, eye: _Eye, beams: Beams, obstacles: Obstacles):
    """Shares of beams that several edges cross, by a lattice of rays: each ray meets one obstacle, so nothing leaks."""
    row, beam, obstacle, starts = crossed.row, crossed.beam, crossed.obstacle, crossed.starts
    planes, heights, normal = eye.planes, eye.heights, eye.normal
    local = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(row))))
    single = np.float32
    rays = beams.rays(beam[starts], order)
    weight = np.maximum(np.einsum("gsc,c->gs", rays, normal.astype(single)), 0.0)
    if eye.partial is not None:
        part = eye.part_of(row[starts], beam[starts], len(beams.directions))
        _keep_partial(eye.partial, row[starts], part, rays, weight)
    weight /= np.maximum(weight.sum(axis=1, keepdims=True), single(1e-30))
    mine = rays[local]
    inside = np.ones(mine.shape[:2], bool)
    near = np.abs(crossed.sine) < 2 * beams.reach[beam][:, None]
    for edge in range(near.shape[1]):
        some = np.flatnonzero(near[:, edge])
        if len(some):
            across = planes[row[some], obstacle[some], edge]
            inside[some] &= np.matmul(mine[some], across[:, :, None])[:, :, 0] >= -_ON_EDGE

    def distances(rows, obstacles_, towards):
        slope = np.matmul(towards, obstacles.normals[obstacles_].astype(single)[:, :, None])[:, :, 0]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            along = heights[rows, obstacles_].astype(single)[:, None] / slope
        along[~(along > 0)] = np.inf
        return along

    distance = distances(row, obstacle, mine)
    distance[~inside] = np.inf
    if eye.past is not None:
        distance[distance < _along(eye.past, eye.points[row[starts]][:, None], rays)[local]] = np.inf
    known = background >= 0
    best = np.minimum.reduceat(distance, starts, axis=0)
    far = np.full(weight.shape, np.inf, single)
    if known.any():
        far[known] = distances(row[starts][known], background[known], rays[known])
    limit = np.minimum(best, far * single(1 - 1e-6))
    hit = (distance <= limit[local]) & (distance < np.inf)
    winners = np.add.reduceat(hit, starts, axis=0, dtype=np.int32)
    hit = hit * weight[local] / np.maximum(winners, 1).astype(single)[local]
    free = np.where(winners == 0, weight, single(0))

    def share_and_centre(part, towards):
        share = part.sum(axis=1)
        return share, np.matmul(part[:, None], towards)[:, 0] / np.maximum(share, single(1e-30))[:, None]

    return *share_and_centre(hit, mine), *share_and_centre(free, rays)


def _keep_partial(partial: Partial, row, part, rays, weight) -> None:
    """Leave only the rays that come through the window; where there are none, the part's own direction, in place."""
    groups = np.flatnonzero(part >= 0)
    if not len(groups):
        return
    towards = partial.direction[part[groups]]
    inside = (np.matmul(rays[groups], partial.window[row[groups]].transpose(0, 2, 1)) >= -_ON_EDGE).all(axis=2)
    none = ~(inside & (weight[groups] > 0)).any(axis=1)
    weight[groups] *= inside
    weight[groups[none]] = 1.0
    rays[groups[none]] = (towards / np.linalg.norm(towards, axis=1, keepdims=True))[none, None]
