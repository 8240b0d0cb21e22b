"""A grid above a floor of any outline: where the points of a work plane lie. Knows arrays and rays, no objects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

_FLAT = np.cos(np.radians(10.0))
_LEVEL = 0.05
"""Faces within this of a level belong to it [m]."""

_MOST_CELLS = 100_000


@dataclass(frozen=True)
class Lattice:
    """Square-ish cells above a floor, ready to be a mesh.

    Attributes
    ----------
    vertices : (v, 3) float
    corners : (p, 4) int
    """

    vertices: NDArray[np.float64]
    corners: NDArray[np.int32]


def above_floor(triangles: NDArray, height: float, spacing: float, border: float, turn: float) -> Lattice | None:
    """Lay a grid at a height above the floor of what the triangles enclose.

    The floor is the lowest level of faces that look up and have at least half the area of the largest such level.

    Parameters
    ----------
    triangles : (t, 3, 3) float
        World space, right-handed about the lit sides.
    height, spacing, border : float
        Of the plane above the floor, of the points, and of the strip left out along the floor's edge; as `triangles`.
    turn : float
        Angle of the grid's lines from the x axis [radians].

    Returns
    -------
    Lattice or None
        None where no face looks up, or the border leaves nothing.

    Raises
    ------
    ValueError
        Where there would be too many points.
    """
    floor = _floor(triangles)
    if floor is None:
        return None
    level = float(floor[:, :, 2].mean())
    flat = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])  # world -> grid
    across = floor.reshape(-1, 3)[:, :2] @ flat.T
    low, high = across.min(axis=0), across.max(axis=0)
    count = np.maximum(np.rint((high - low) / spacing).astype(int), 1)
    if count.prod() > _MOST_CELLS:
        raise ValueError(int(count.prod()))
    edges = [np.linspace(low[axis], high[axis], count[axis] + 1) for axis in (0, 1)]
    middles = [0.5 * (edge[1:] + edge[:-1]) for edge in edges]
    x, y = (grid.ravel() for grid in np.meshgrid(*middles, indexing="ij"))
    kept = _stands_on(floor, np.column_stack([x, y]) @ flat, border)
    column, row = np.divmod(np.flatnonzero(kept), count[1])
    if not len(row):
        return None
    corner = column * (count[1] + 1) + row
    corners = np.column_stack([corner, corner + count[1] + 1, corner + count[1] + 2, corner + 1])
    used, corners = np.unique(corners, return_inverse=True)
    x, y = (grid.ravel()[used] for grid in np.meshgrid(*edges, indexing="ij"))
    places = np.column_stack([np.column_stack([x, y]) @ flat, np.full(len(used), level + height)])
    return Lattice(places, corners.reshape(-1, 4).astype(np.int32))


def _floor(triangles: NDArray) -> NDArray | None:
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    areas = 0.5 * np.linalg.norm(normals, axis=1)
    up = normals[:, 2] > _FLAT * 2.0 * areas
    if not up.any():
        return None
    triangles, areas = triangles[up], areas[up]
    heights = triangles[:, :, 2].mean(axis=1)
    order = np.argsort(heights)
    level = np.cumsum(np.diff(heights[order], prepend=heights[order[0]]) > _LEVEL)
    sizes = np.bincount(level, areas[order])
    lowest = int(np.flatnonzero(sizes >= 0.5 * sizes.max())[0])
    return triangles[order[level == lowest]]


def _stands_on(floor: NDArray, places: NDArray, border: float) -> NDArray[np.bool_]:
    """Whether points, (m, 2), lie over the floor, and so does all that is within the border around them."""
    level = float(floor[:, :, 2].max()) + 1.0
    tree = BVHTree.FromPolygons(floor.reshape(-1, 3).tolist(), np.arange(3 * len(floor)).reshape(-1, 3).tolist())
    angles = np.arange(8) * np.pi / 4.0
    around = [(0.0, 0.0)]
    if border > 0.0:
        around += list(border * np.column_stack([np.cos(angles), np.sin(angles)]))
    kept = np.ones(len(places), bool)
    for dx, dy in around:
        for index in np.flatnonzero(kept):
            x, y = places[index]
            kept[index] = tree.ray_cast((x + dx, y + dy, level), (0.0, 0.0, -1.0))[0] is not None
    return kept
