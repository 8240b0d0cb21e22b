"""What a group of receivers sees along the globe's shared directions: the nearest plane prevails (Claro 1998).

The planes strategy: every receiver of a group looks along the same directions, so whether a direction passes inside
an edge is a matrix product. Whole parcels inside an outline are settled there, in float32; parcels that an edge crosses
are settled by their covered share, in float64.
"""

from __future__ import annotations

import numpy as np

from . import polygons
from .arrays import box_corners, onto
from .crossings import Candidates, settle_whole
from .parts import settle_parts
from .projection import Beams, HalfSpace, Obstacles, edge_planes
from .views import OPEN, SHARED, Eye, Partial, View, along, with_partial

__all__ = ["OPEN", "SHARED", "Partial", "View", "look"]

_LONE_PRODUCT = 60_000

_BACKS_LAST = 1e-6
"""How much farther than they are backs stand: where two sides of a solid meet, the one that faces a receiver shows."""


def look(
    points,
    normal,
    beams: Beams,
    obstacles: Obstacles,
    tolerance: float,
    past: HalfSpace | None = None,
    partial: Partial | None = None,
    wanted: np.ndarray | None = None,
    unseen_backs: np.ndarray | None = None,
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
    wanted : (r, k) bool, optional
        Beams that get there from each receiver: edges are not looked for in others.
    unseen_backs : (o,) bool, optional
        Obstacles that nobody need look for who is behind them.

    Returns
    -------
    View
    """
    points = np.asarray(points, float)
    rows, count = len(points), len(beams.directions)
    # beam after beam in memory: beams are what is picked from, and rows of receivers are copied as a whole
    seen = np.full((count, rows), OPEN, np.int32).T
    nearest = np.full((count, rows), np.inf, np.float32).T
    planes, heights = edge_planes(points, obstacles, tolerance)
    heights[heights > 0] *= 1 + _BACKS_LAST
    reach = beams.reach * 1.01 + 1e-6
    hull = _bounding_corners(points)
    slopes = beams.directions @ obstacles.normals.T
    start = np.zeros((len(points), 1), np.float32) if past is None else _distance_to(past, points, beams.directions)
    if partial is not None and past is not None:
        start[partial.row, partial.beam] = along(past, points[partial.row], partial.direction)
    found = []
    width = obstacles.bounding.shape[1]
    possible: dict[int, np.ndarray] = {}
    within: dict[int, np.ndarray] = {}
    looked_for = np.ones(heights.shape, bool)
    if unseen_backs is not None:
        looked_for[:, unseen_backs] = heights[:, unseen_backs] < 0
    for o in np.flatnonzero(looked_for.any(axis=0)):
        bounded, before = obstacles.bounding[o], looked_for[:, o]
        here = hull if before.all() else _bounding_corners(points[before])
        columns, certain = _columns_within(
            here, obstacles.vertices[o], bounded, heights[before, o], beams.directions, reach
        )
        if not len(columns):
            continue
        edges = planes[:, o, bounded].astype(np.float32)
        with np.errstate(divide="ignore", over="ignore"):
            slope = (1.0 / slopes[columns, o]).astype(np.float32)
        distance = np.multiply.outer(slope, heights[:, o].astype(np.float32)).T
        if partial is not None:
            _set_partial(distance, partial, columns, heights[:, o], obstacles.normals[o])
        if not (certain.all() and before.all()):
            sines = _edge_sines(edges, beams.directions[columns].astype(np.float32))
            inside = sines[0].copy(order="K") if len(sines) else np.full_like(distance, np.inf)
            for other in sines[1:]:
                np.minimum(inside, other, out=inside)
            inside[~before] = -np.inf
            limit = reach[columns].astype(np.float32)
            whole = inside > limit
            near = np.flatnonzero((np.abs(inside, out=inside) <= limit).T)
            if len(near):
                column, row = np.divmod(near, rows)
                if wanted is not None:
                    there = wanted[row, columns[column]]
                    near, row, column = near[there], row[there], column[there]
                if past is not None:
                    ahead = ~((distance[row, column] > 0) & (distance[row, column] < start[row, columns[column]]))
                    near, row, column = near[ahead], row[ahead], column[ahead]
                sine = np.full((width, len(near)), np.inf, np.float32)
                for edge, values in zip(np.flatnonzero(bounded), sines, strict=True):
                    sine[edge] = values.T.ravel()[near]
                found.append((row, columns[column], np.full(len(row), o), sine))
                within[o] = columns
        else:
            whole = np.ones_like(distance, bool)
        # beam after beam, as they lie in memory
        known = nearest.T.take(columns, axis=0)
        shows = whole.T & (distance.T < known)
        shows &= distance.T > (start.T if past is None else start.T.take(columns, axis=0))
        if shows.any():
            nearest.T[columns] = np.where(shows, distance.T, known)
            seen.T[columns] = np.where(shows, np.int32(o), seen.T.take(columns, axis=0))
            possible[o] = columns
    if found:
        row, beam, obstacle, sine = (np.concatenate(x, axis=-1) for x in zip(*found, strict=True))
        eye = Eye(points, planes, heights, np.asarray(normal, float), past, partial)
        candidates = Candidates.of(row, beam, obstacle, sine, planes.astype(np.float32), heights, beams)
        for o in settle_whole(seen, nearest, start, candidates, eye, beams, obstacles):
            possible.setdefault(int(o), within[int(o)])
        view = settle_parts(seen, nearest, possible, candidates, eye, beams, obstacles)
    else:
        empty = np.zeros(0, np.int64)
        view = View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), nearest, possible, heights)
    return view if partial is None else with_partial(view, partial)


def _set_partial(distance, partial: Partial, columns, heights, normal) -> None:
    """Distances of partial beams along the direction of their part, in place."""
    place = np.full(int(max(columns.max(), partial.beam.max())) + 1, -1)
    place[columns] = np.arange(len(columns))
    column = place[partial.beam]
    mine = np.flatnonzero(column >= 0)
    row = partial.row[mine]
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        away = heights[row] / onto(partial.direction[mine], normal)
    distance[row, column[mine]] = away


def _distance_to(plane: HalfSpace, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(r, k) float32: distance along each beam to a plane, a little less so that what stands on the plane counts."""
    with np.errstate(divide="ignore", over="ignore"):
        slope = (1.0 / onto(directions, plane.normal)).astype(np.float32)
    return np.multiply.outer(slope * np.float32(1 - 1e-5), (plane.offset - points @ plane.normal).astype(np.float32)).T


def _bounding_corners(points: np.ndarray) -> np.ndarray:
    if len(points) == 1:
        return points
    return np.unique(box_corners(points.min(axis=0), points.max(axis=0)), axis=0)


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
    across = np.ascontiguousarray(directions.T)
    possible, least = np.ones(len(directions), bool), []
    for edge in range(planes.shape[1]):
        products = np.ascontiguousarray(planes[:, edge]) @ across
        margin = length[edge] * reach
        possible &= products.max(axis=0) >= -margin
        least.append(products.min(axis=0) - margin)
    columns = np.flatnonzero(possible)
    certain = (np.minimum.reduce(least) > 0)[columns]
    return columns, certain


def _edge_sines(edges: np.ndarray, directions: np.ndarray) -> list[np.ndarray]:
    """For each edge (r, k) float32: sine of the angle from each beam's centre to its plane, positive inside."""
    # products this small are not split over threads by BLAS, which would wait for each other here
    step = max(1, _LONE_PRODUCT // max(1, len(edges)))
    sines = []
    for e in range(edges.shape[1]):
        edge = np.ascontiguousarray(edges[:, e].T)
        sine = np.empty((len(directions), len(edges)), np.float32)
        for first in range(0, len(directions), step):
            np.matmul(directions[first : first + step], edge, out=sine[first : first + step])
        sines.append(sine.T)
    return sines
