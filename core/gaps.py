"""Gaps: edges that nearly meet another surface, and leave a slit that light comes through."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons

WIDEST = 0.015
"""Widest slit that counts as a mistake, over the length of its edge and over the depth of the polygon behind it."""

_PLACES = np.array([0.02, 0.2, 0.35, 0.5, 0.65, 0.8, 0.98])
_TOWARDS = 0.5
_MOST_OUTLINES = 4_000
_MOST_EDGES, _FEWER_EDGES = 1_000, 300
_CHUNK = 200_000


@dataclass(frozen=True, eq=False)
class Gaps:
    """Slits, each beside one edge of an outline.

    Attributes
    ----------
    one, two : (g,) int
        Outline that the edge belongs to, and the one that it nearly meets.
    width : (g,) float
        Largest distance between them [m].
    length : (g,) float
        Length of the slit [m].
    places, across : (g, 3) float
        A place in the middle of the slit, and the unit vector along which light would come through.
    """

    one: np.ndarray
    two: np.ndarray
    width: np.ndarray
    length: np.ndarray
    places: np.ndarray
    across: np.ndarray


def free_edges(outlines: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Edges of padded polygons that do not run from corner to corner along another polygon's edge.

    Parameters
    ----------
    outlines : (o, w, 3) float, padded
    tolerance : float
        Corners closer than this may be one [m].

    Returns
    -------
    outline, corner : (e,) int
        The edge leads from this corner to the next.
    """
    count, width = outlines.shape[:2]
    corners = point_keys(outlines.reshape(-1, 3), 4 * tolerance).reshape(count, width)
    after = np.roll(corners, -1, axis=1)
    outline, corner = np.nonzero(corners != after)
    low, high = np.sort([corners[outline, corner], after[outline, corner]], axis=0)
    _, of, walked = np.unique(low * np.uint64(3) + high, return_inverse=True, return_counts=True)
    free = walked[of.reshape(-1)] < 2
    return outline[free], corner[free]


def point_keys(points: np.ndarray, cell: float) -> np.ndarray:
    """(n,) uint64: a number for each point's cell; points that are equal but for rounding mostly have one."""
    whole = np.rint(points / cell + 0.25).astype(np.int64).view(np.uint64)
    factors = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
    mixed = (whole * factors).sum(axis=1, dtype=np.uint64)
    return mixed ^ (mixed >> np.uint64(29))


def find_gaps(outlines: np.ndarray, normals: np.ndarray, tolerance: float) -> Gaps:
    """Slits between edges of convex polygons and what they nearly meet.

    An edge and its neighbour make a slit where lengthening the edge's polygon in its own plane would close it: sheets
    laid on one another at a distance are none.

    Parameters
    ----------
    outlines : (o, w, 3) float, padded
    normals : (o, 3) float, unit
    tolerance : float
        What is nearer than this, touches [m].

    Returns
    -------
    Gaps
    """
    outline, corner = free_edges(outlines, tolerance)
    begin = outlines[outline, corner]
    step = outlines[outline, (corner + 1) % outlines.shape[1]] - begin
    length = np.linalg.norm(step, axis=1)
    outward = polygons.cross(step, normals[outline]) / length[:, None]
    depth = -np.einsum("ewc,ec->ew", outlines[outline] - begin[:, None], outward).min(axis=1)
    limit = WIDEST * np.minimum(length, depth)
    most = _MOST_EDGES if len(outlines) <= _MOST_OUTLINES else _FEWER_EDGES
    kept = np.flatnonzero(limit > 2 * tolerance)
    kept = kept[np.argsort(-limit[kept], kind="stable")[:most]]
    low, high = (np.ascontiguousarray(bound.T) for bound in (outlines.min(axis=1), outlines.max(axis=1)))
    found: list[tuple] = []
    for e in kept.tolist():
        places = begin[e] + _PLACES[:, None] * step[e]
        reach = limit[e]
        upper, lower = places.max(axis=0) + reach, places.min(axis=0) - reach
        near = np.flatnonzero((low[0] <= upper[0]) & (high[0] >= lower[0]))
        for axis in (1, 2):
            near = near[(low[axis, near] <= upper[axis]) & (high[axis, near] >= lower[axis])]
        near = near[near != outline[e]]
        if not len(near):
            continue
        nearest, way = _nearest(places, outlines[near], normals[near])
        distance = np.linalg.norm(way, axis=1)
        touching = distance <= tolerance
        beside = ~touching & (distance <= reach) & (way @ outward[e] >= _TOWARDS * distance)
        if beside.sum() * 2 <= (~touching).sum() or not beside.any():
            continue
        widest = int(np.argmax(np.where(beside, distance, -1.0)))
        across = polygons.cross(step[e] / length[e], way[widest] / distance[widest])
        found.append(
            (
                outline[e],
                near[nearest[widest]],
                distance[widest],
                length[e] * beside.mean(),
                places[widest] + 0.5 * way[widest],
                across,
            )
        )
    columns = list(zip(*found, strict=True)) if found else [[], [], [], [], np.zeros((0, 3)), np.zeros((0, 3))]
    return Gaps(
        np.array(columns[0], np.int64),
        np.array(columns[1], np.int64),
        np.array(columns[2], float),
        np.array(columns[3], float),
        np.array(columns[4], float).reshape(-1, 3),
        np.array(columns[5], float).reshape(-1, 3),
    )


def _nearest(points: np.ndarray, outlines: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each point the nearest of some convex polygons, and the way there, (n,) int and (n, 3) float."""
    best = np.full(len(points), np.inf)
    nearest = np.zeros(len(points), np.int64)
    towards = np.zeros((len(points), 3))
    rows = max(1, _CHUNK // (len(points) * outlines.shape[1]))
    for first in range(0, len(outlines), rows):
        some = slice(first, first + rows)
        way = ways(points, outlines[some], normals[some])
        distance = np.linalg.norm(way, axis=2)
        closest = np.argmin(distance, axis=0)
        every = np.arange(len(points))
        better = distance[closest, every] < best
        best[better] = distance[closest, every][better]
        nearest[better] = first + closest[better]
        towards[better] = way[closest, every][better]
    return nearest, towards


def ways(points: np.ndarray, outlines: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(o, n, 3) float: from each point ``(n, 3)`` to the nearest place of each convex polygon ``(o, w, 3)``."""
    edge = np.roll(outlines, -1, axis=1) - outlines
    squared = np.einsum("owc,owc->ow", edge, edge)
    from_corner = points[None, :, None] - outlines[:, None]  # (o, n, w, 3)
    along = np.einsum("onwc,owc->onw", from_corner, edge) / np.where(squared > 0, squared, 1.0)[:, None]
    to_edge = np.clip(along, 0.0, 1.0)[..., None] * edge[:, None] - from_corner
    choice = np.argmin(np.einsum("onwc,onwc->onw", to_edge, to_edge), axis=2)
    way = np.take_along_axis(to_edge, choice[..., None, None], axis=2)[:, :, 0]
    inward = polygons.cross(normals[:, None], edge)
    inside = (np.einsum("onwc,owc->onw", from_corner, inward) >= 0).all(axis=2)
    height = np.einsum("onc,oc->on", from_corner[:, :, 0], normals)
    return np.where(inside[..., None], -height[..., None] * normals[:, None], way)
