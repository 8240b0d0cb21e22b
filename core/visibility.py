"""What a group of receivers sees along the globe's shared directions: the nearest plane prevails (Claro 1998).

The planes strategy: every receiver of a group looks along the same directions, so whether a direction passes inside
an edge is a matrix product. Whole parcels inside an outline are settled there, in float32; parcels that an edge crosses
are settled by their covered share, in float64.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import polygons
from .projection import Beams, HalfSpace, Obstacles, coverage, edge_planes

OPEN = -1
"""Nothing in the way: sky or ground light."""

SHARED = -2
"""A parcel that an edge crosses: see the view's parts."""

_SUBRAYS = 4

_ON_EDGE = 1e-6
"""Rays this close to an edge [rad] count as inside, so that none slips between two obstacles that share it."""

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
        Share of the beam; the shares of one beam sum to 1.
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


def look(points, beams: Beams, obstacles: Obstacles, tolerance: float, past: HalfSpace | None = None) -> View:
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
    past : HalfSpace, optional
        Only what the beams meet inside it counts: beyond the mirror or pane that they come through.

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
    start = np.zeros((len(points), 1), np.float32) if past is None else _distance_to(past, points, beams.directions)
    found = []
    width = obstacles.bounding.shape[1]
    possible: dict[int, np.ndarray] = {}
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
        else:
            whole = np.ones(distance.shape, bool)
        before = nearest[:, columns]
        whole &= distance < before
        whole &= distance > (start if past is None else start[:, columns])
        if whole.any():
            nearest[:, columns] = np.where(whole, distance, before)
            seen[:, columns] = np.where(whole, np.int32(o), seen[:, columns])
            possible[o] = columns
    if not found:
        empty = np.zeros(0, np.int64)
        return View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), nearest, possible, heights)
    candidates = tuple(np.concatenate(x) for x in zip(*found, strict=True))
    return _settle_parts(seen, nearest, possible, candidates, planes, heights, slopes, beams, obstacles)


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
    return [np.dot(np.ascontiguousarray(edges[:, e]), across) for e in range(edges.shape[1])]


def _settle_parts(seen, nearest, possible, candidates, planes, heights, slopes, beams, obstacles) -> View:
    row, beam, obstacle, sine = candidates
    reach = beams.reach[beam]
    pair, edge = np.nonzero(np.abs(sine) < reach[:, None])
    normal = planes[row[pair], obstacle[pair], edge]
    across = 2 * beams.half_widths[beam[pair]] * np.abs(np.einsum("nac,nc->na", beams.axes[beam[pair]], normal))
    place = sine[pair, edge].astype(float)
    support = 0.5 * across.sum(axis=1)
    outside = (sine <= -reach[:, None]).any(axis=1)
    outside[pair[place <= -support]] = True
    crossing = np.abs(place) < support
    pair, normal, across, place = pair[crossing], normal[crossing], across[crossing], place[crossing]
    edges = np.bincount(pair, minlength=len(row))
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = heights[row, obstacle] / slopes[beam, obstacle]
    distance = np.where(distance > 0, distance, np.inf)
    behind = np.isfinite(distance) & (distance > nearest[row, beam] * (1 + 1e-5))
    share, offset = np.ones(len(row)), np.zeros((len(row), 3))
    covered, moment = coverage(place, across[:, 0], across[:, 1])
    share[pair] = covered
    offset[pair] = (moment / np.maximum(covered, 1e-12))[:, None] * normal
    keep = np.flatnonzero(~outside & (heights[row, obstacle] != 0) & ~(behind & (edges < 2)))
    order = keep[np.lexsort((distance[keep], row[keep] * len(beams.directions) + beam[keep]))]
    row, beam, obstacle, distance, edges = row[order], beam[order], obstacle[order], distance[order], edges[order]
    share, offset = share[order], offset[order]
    if not len(row):
        empty = np.zeros(0, np.int64)
        return View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), nearest, possible, heights)
    key = row * len(beams.directions) + beam
    starts = np.flatnonzero(np.concatenate(([True], key[1:] != key[:-1])))
    group = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(key))))
    group_edges = np.add.reduceat(edges, starts)
    group_share = np.add.reduceat(share, starts)
    size = np.diff(np.append(starts, len(key)))
    straight = np.isfinite(np.maximum.reduceat(distance, starts))
    joined = (size == 2) & (group_edges == 2) & (np.abs(group_share - 1) < _SAME_EDGE)
    simple = straight & (((size == 1) & (group_edges <= 1)) | joined) & (np.maximum.reduceat(edges, starts) <= 1)
    # two obstacles share the edge: nothing is left between them, to the last bit
    meeting = (joined & simple)[group]
    share[meeting] /= group_share[group[meeting]]
    group_share[joined & simple] = 1.0
    complex_ = np.flatnonzero(~simple)
    if len(complex_):
        chosen = np.flatnonzero(~simple[group])
        share[chosen], offset[chosen], rest, rest_offset = _sample_parts(
            row[chosen],
            beam[chosen],
            obstacle[chosen],
            sine[order[chosen]],
            group[chosen],
            seen,
            planes,
            heights,
            obstacles.normals,
            beams,
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
        nearest,
        possible,
        heights,
    )


def _sample_parts(row, beam, obstacle, sine, group, seen, planes, heights, normals, beams):
    """Shares of beams that several edges cross, by a grid of rays: each ray meets one obstacle, so nothing leaks."""
    step = (np.arange(_SUBRAYS) + 0.5) * 2 / _SUBRAYS - 1
    grid = np.stack(np.meshgrid(step, step, indexing="ij")).reshape(2, -1)
    starts = np.flatnonzero(np.concatenate(([True], group[1:] != group[:-1])))
    local = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(group))))
    head_row, head_beam = row[starts], beam[starts]
    spans = beams.axes[head_beam] * beams.half_widths[head_beam][:, :, None]
    mine = spans[local]
    # sines and slopes are linear in the ray's place across the beam
    tilt = np.matmul(planes[row, obstacle], mine.transpose(0, 2, 1))
    inside = np.ones((len(row), grid.shape[1]), bool)
    for edge in range(sine.shape[1]):
        inside &= sine[:, edge, None] + tilt[:, edge] @ grid >= -_ON_EDGE

    def distances(rows, beams_, obstacles_, across):
        normal = normals[obstacles_]
        slope = (
            np.einsum("nc,nc->n", beams.directions[beams_], normal)[:, None]
            + np.einsum("nac,nc->na", across, normal) @ grid
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            along = heights[rows, obstacles_][:, None] / slope
        return np.where(along > 0, along, np.inf)

    distance = np.where(inside, distances(row, beam, obstacle, mine), np.inf)
    background = seen[head_row, head_beam]
    known = background >= 0
    far = np.full((len(starts), grid.shape[1]), np.inf)
    far[known] = distances(head_row[known], head_beam[known], background[known], spans[known])
    best = np.minimum.reduceat(distance, starts, axis=0)
    hit = np.isfinite(distance) & (distance <= best[local]) & (distance < far[local] * (1 - 1e-9))
    winners = np.add.reduceat(hit.astype(float), starts, axis=0)
    hit = hit / np.maximum(winners[local], 1.0)
    free = (winners == 0).astype(float)

    def share_and_offset(weight, across):
        total = weight.sum(axis=1)
        place = weight @ grid.T / np.maximum(total, 1e-12)[:, None]
        return total / grid.shape[1], np.einsum("na,nac->nc", place, across)

    return *share_and_offset(hit, mine), *share_and_offset(free, spans)
