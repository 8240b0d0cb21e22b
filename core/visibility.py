"""What a group of receivers sees along the globe's shared directions: the nearest plane prevails (Claro 1998).

The planes strategy: every receiver of a group looks along the same directions, so whether a direction passes inside
an edge is a matrix product. Whole parcels inside an outline are settled there, in float32; parcels that an edge crosses
are settled by their covered share, in float64.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .projection import Beams, Obstacles, coverage, edge_planes

OPEN = -1
"""Nothing in the way: sky or ground light."""

SHARED = -2
"""A parcel that an edge crosses: see the view's parts."""

_SUBRAYS = 4


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
        Share of the beam; the shares of one beam sum to 1.
    part_direction : (p, 3) float
        Towards the part's centre, not normalised.
    heights : (r, o) float
        Signed distance from each receiver to each obstacle's plane, along the obstacle's normal [m].
    """

    seen: np.ndarray
    part_row: np.ndarray
    part_beam: np.ndarray
    part_seen: np.ndarray
    part_share: np.ndarray
    part_direction: np.ndarray
    heights: np.ndarray


def look(points, beams: Beams, obstacles: Obstacles, tolerance: float) -> View:
    """Find the nearest obstacle along each beam from each point.

    Parameters
    ----------
    points : (r, 3) float
        Receivers, near each other for speed (columns of beams are settled for all of them at once where possible).
    beams : Beams
    obstacles : Obstacles
        Cut to what these beams can meet.
    tolerance : float
        Distance below which a point lies in a plane [m].

    Returns
    -------
    View
    """
    points = np.asarray(points, float)
    rows, count = len(points), len(beams.directions)
    seen = np.full((rows, count), OPEN, np.int32)
    nearest = np.full((rows, count), np.inf, np.float32)
    planes, heights = edge_planes(points, obstacles, tolerance)
    reach = beams.reach * 1.01 + 1e-6
    hull = _bounding_corners(points)
    slopes = beams.directions @ obstacles.normals.T
    part_row, part_beam, part_obstacle = [], [], []
    for o in range(len(obstacles.outlines)):
        bounded = obstacles.bounding[o]
        columns, certain = _columns_within(hull, obstacles.vertices[o], bounded, heights[:, o], beams.directions, reach)
        if not len(columns):
            continue
        edges = planes[:, o, bounded].astype(np.float32)
        with np.errstate(divide="ignore", over="ignore"):
            slope = (1.0 / slopes[columns, o]).astype(np.float32)
        distance = heights[:, o].astype(np.float32)[:, None] * slope
        if not certain.all():
            inside = _inner_distance(edges, beams.directions[columns].astype(np.float32))
            limit = reach[columns].astype(np.float32)
            whole = inside > limit
            near = np.flatnonzero(np.abs(inside, out=inside) <= limit)
            row, column = np.divmod(near, len(columns))
            part_row.append(row)
            part_beam.append(columns[column])
            part_obstacle.append(np.full(len(row), o))
        else:
            whole = np.ones(distance.shape, bool)
        before = nearest[:, columns]
        whole &= (distance < before) & (distance > 0)
        nearest[:, columns] = np.where(whole, distance, before)
        seen[:, columns] = np.where(whole, o, seen[:, columns])
    if not part_row:
        empty = np.zeros(0, np.int64)
        return View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), heights)
    candidates = tuple(np.concatenate(x) for x in (part_row, part_beam, part_obstacle))
    return _settle_parts(seen, nearest, candidates, planes, heights, slopes, beams, obstacles)


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
    planes = (np.cross(relative, np.roll(relative, -1, axis=1)) * sign)[:, bounded]
    if not planes.shape[1]:
        return every, np.zeros(len(every), bool)
    length = np.linalg.norm(planes, axis=2).max(axis=0)
    products = np.einsum("kc,hec->ehk", directions, planes)
    margin = length[:, None] * reach[None]
    possible = (products.max(axis=1) >= -margin).all(axis=0)
    columns = np.flatnonzero(possible)
    certain = (products.min(axis=1)[:, columns] > margin[:, columns]).all(axis=0)
    return columns, certain


def _inner_distance(edges: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(r, k) float32: sine of the angle from each beam's centre to the nearest edge, positive inside."""
    across = np.ascontiguousarray(directions.T)
    if not edges.shape[1]:
        return np.full((len(edges), len(directions)), np.inf, np.float32)
    inside = np.dot(np.ascontiguousarray(edges[:, 0]), across)
    other = np.empty_like(inside)
    for e in range(1, edges.shape[1]):
        np.dot(np.ascontiguousarray(edges[:, e]), across, out=other)
        np.minimum(inside, other, out=inside)
    return inside


def _settle_parts(seen, nearest, candidates, planes, heights, slopes, beams, obstacles) -> View:
    row, beam, obstacle = candidates
    normal = planes[row, obstacle]
    sine = np.einsum("nwc,nc->nw", normal, beams.directions[beam])
    axes, half = beams.axes[beam], beams.half_widths[beam]
    width_a = 2 * half[:, :1] * np.abs(np.einsum("nwc,nc->nw", normal, axes[:, 0]))
    width_b = 2 * half[:, 1:] * np.abs(np.einsum("nwc,nc->nw", normal, axes[:, 1]))
    support = 0.5 * (width_a + width_b)
    bounded = obstacles.bounding[obstacle]
    outside = (bounded & (sine <= -support)).any(axis=1)
    crossed = bounded & (np.abs(sine) < support)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = heights[row, obstacle] / slopes[beam, obstacle]
    distance = np.where(distance > 0, distance, np.inf)
    edges = crossed.sum(axis=1)
    behind = np.isfinite(distance) & (distance > nearest[row, beam] * (1 + 1e-5))
    keep = np.flatnonzero(~outside & (heights[row, obstacle] != 0) & ~(behind & (edges < 2)))
    order = keep[np.lexsort((distance[keep], row[keep] * len(beams.directions) + beam[keep]))]
    row, beam, obstacle, distance, edges = row[order], beam[order], obstacle[order], distance[order], edges[order]
    if not len(row):
        empty = np.zeros(0, np.int64)
        return View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), heights)
    key = row * len(beams.directions) + beam
    starts = np.flatnonzero(np.concatenate(([True], key[1:] != key[:-1])))
    group = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(key))))
    which = np.argmax(crossed[order], axis=1)
    pick = np.arange(len(order))
    share, moment = coverage(sine[order][pick, which], width_a[order][pick, which], width_b[order][pick, which])
    share[edges == 0] = 1.0
    moment[edges == 0] = 0.0
    offset = (moment / np.maximum(share, 1e-12))[:, None] * normal[order][pick, which]
    group_edges = np.add.reduceat(edges, starts)
    group_share = np.add.reduceat(share, starts)
    size = np.diff(np.append(starts, len(key)))
    straight = np.isfinite(np.maximum.reduceat(distance, starts))
    simple = straight & (
        ((size == 1) & (group_edges <= 1)) | ((size == 2) & (group_edges == 2) & (np.abs(group_share - 1) < 1e-6))
    )
    edges_most = np.maximum.reduceat(edges, starts)
    simple &= edges_most <= 1
    complex_ = np.flatnonzero(~simple)
    if len(complex_):
        chosen = np.flatnonzero(~simple[group])
        share[chosen], offset[chosen], rest, rest_offset = _sample_parts(
            row[chosen], beam[chosen], obstacle[chosen], group[chosen], seen, planes, heights, obstacles.normals, beams
        )
    left = np.where(simple, 1.0 - group_share, 0.0)
    background_offset = -np.add.reduceat(share[:, None] * offset, starts, axis=0) / np.maximum(left, 1e-12)[:, None]
    if len(complex_):
        left[complex_], background_offset[complex_] = rest, rest_offset
    first_row, first_beam = row[starts], beam[starts]
    behind_all = seen[first_row, first_beam]
    seen[first_row, first_beam] = SHARED
    remains = left > 1e-9
    lit = share > 1e-9
    part_row = np.concatenate([row[lit], first_row[remains]])
    part_beam = np.concatenate([beam[lit], first_beam[remains]])
    centre = np.concatenate([offset[lit], background_offset[remains]])
    return View(
        seen,
        part_row,
        part_beam,
        np.concatenate([obstacle[lit], behind_all[remains]]),
        np.concatenate([share[lit], left[remains]]),
        beams.directions[part_beam] + centre,
        heights,
    )


def _sample_parts(row, beam, obstacle, group, seen, planes, heights, normals, beams):
    """Shares of beams that several edges cross, by a grid of rays: each ray meets one obstacle, so nothing leaks."""
    step = (np.arange(_SUBRAYS) + 0.5) * 2 / _SUBRAYS - 1
    grid = np.stack(np.meshgrid(step, step, indexing="ij"), axis=-1).reshape(-1, 2)
    starts = np.flatnonzero(np.concatenate(([True], group[1:] != group[:-1])))
    head_row, head_beam = row[starts], beam[starts]
    shift = np.einsum("sa,gac->gsc", grid, beams.axes[head_beam] * beams.half_widths[head_beam][:, :, None])
    rays = beams.directions[head_beam][:, None] + shift
    local = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(group))))
    mine = rays[local]
    inside = (np.einsum("nwc,nsc->nws", planes[row, obstacle], mine) >= -1e-12).all(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = heights[row, obstacle][:, None] / np.einsum("nsc,nc->ns", mine, normals[obstacle])
        background = seen[head_row, head_beam]
        known = background >= 0
        far = np.full((len(starts), len(grid)), np.inf)
        b = background[known]
        far[known] = heights[head_row[known], b][:, None] / np.einsum("gsc,gc->gs", rays[known], normals[b])
    far[~(far > 0)] = np.inf
    distance = np.where(inside & (distance > 0), distance, np.inf)
    best = np.minimum.reduceat(distance, starts, axis=0)
    hit = np.isfinite(distance) & (distance <= best[local]) & (distance < far[local] * (1 - 1e-9))
    winners = np.add.reduceat(hit.astype(float), starts, axis=0)
    hit = hit / np.maximum(winners[local], 1.0)
    share = hit.mean(axis=1)
    offset = np.einsum("ns,nsc->nc", hit, shift[local]) / np.maximum(hit.sum(axis=1), 1e-12)[:, None]
    free = (winners == 0).astype(float)
    rest = free.mean(axis=1)
    rest_offset = np.einsum("gs,gsc->gc", free, shift) / np.maximum(free.sum(axis=1), 1e-12)[:, None]
    return share, offset, rest, rest_offset
