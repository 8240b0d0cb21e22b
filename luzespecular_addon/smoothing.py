"""From one value per face to one per corner: means over the faces that meet there, as the paper draws them. Pure NumPy.

Corners are averaged only where surfaces are smooth: a wall and the floor keep their own light along their common edge.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

SMOOTH_ANGLE = 30.0
"""Faces whose normals differ by more [degrees] do not share their light."""

_LARGEST_KEY = 2.0**62


def corner_means(
    values: ArrayLike,
    areas: ArrayLike,
    normals: ArrayLike,
    corners: int | ArrayLike,
    vertices: ArrayLike,
) -> NDArray[np.float64]:
    """Return the area-weighted mean of the faces around each corner.

    Parameters
    ----------
    values : (n,) float
        One value per face; NaN where there is none: such faces take no part, and their corners stay NaN.
    areas : (n,) float
        Weights.
    normals : (n, 3) float
        Unit normals.
    corners : int or (n,) int
        Number of corners of each face.
    vertices : (c,) int
        Vertex of each corner, not negative, the corners of a face one after another.

    Returns
    -------
    (c,) float
    """
    values, areas, normals = np.asarray(values, float), np.asarray(areas, float), np.asarray(normals, float)
    vertices = np.asarray(vertices)
    face = np.repeat(np.arange(len(values)), corners)
    known = ~np.isnan(values[face]) & (areas[face] > 0.0)
    means = np.repeat(values, corners)
    if not known.any():
        return means
    means[known] = _flat_means(values, areas, face[known], vertices[known])
    rough = known.copy()
    rough[known] = _rough(normals, areas, face[known], vertices[known])
    if rough.any():
        means[rough] = _pairwise_means(values, areas, normals, face[rough], vertices[rough])
    return means


def extent(points: NDArray) -> float:
    """Return the longest side of the upright box around points, (c, 3); 0 without any."""
    return max((float(np.ptp(column)) for column in points.T if len(column)), default=0.0)  # faster than all at once


def weld(points: ArrayLike, groups: ArrayLike, tolerance: float) -> NDArray[np.int64]:
    """Number points so that those of one group and one place, within a tolerance, have one number.

    Parameters
    ----------
    points : (c, 3) float
    groups : (c,) int
        Points of different groups never share a number.
    tolerance : float
        Width of the cells within which points are one.

    Returns
    -------
    (c,) int64
        0 … number of distinct points - 1.
    """
    key, room = np.asarray(groups, np.int64), 1.0 + float(np.max(groups, initial=0))
    for place in np.asarray(points, float).T:
        column = np.rint(place / tolerance).astype(np.int64)
        column -= column.min(initial=0)
        size = int(column.max(initial=0)) + 1
        if room * size > _LARGEST_KEY:  # numbered anew, without gaps
            key = np.unique(key, return_inverse=True)[1].reshape(-1)
            room = 1.0 + float(key.max(initial=0))
        key, room = key * size + column, room * size
    return np.unique(key, return_inverse=True)[1].reshape(-1)


def _flat_means(values: NDArray, areas: NDArray, face: NDArray, vertex: NDArray) -> NDArray[np.float64]:
    """Mean over all faces at each corner's vertex."""
    weight = areas[face]
    total = np.bincount(vertex, weight * values[face])
    area = np.bincount(vertex, weight)
    return total[vertex] / area[vertex]


def _rough(normals: NDArray, areas: NDArray, face: NDArray, vertex: NDArray) -> NDArray[np.bool_]:
    """Whether any face at a corner's vertex leans by more than half the smooth angle from the mean of them."""
    count = int(vertex.max()) + 1
    weighted = areas[:, None] * normals
    mean = np.column_stack([np.bincount(vertex, weighted[face, axis], count) for axis in range(3)])
    mean /= np.maximum(np.sqrt(np.einsum("vx,vx->v", mean, mean)), 1e-300)[:, None]
    leans = np.einsum("cx,cx->c", normals[face], mean[vertex]) < np.cos(np.radians(SMOOTH_ANGLE / 2.0))
    return np.bincount(vertex, leans, count)[vertex] > 0


def _pairwise_means(
    values: NDArray, areas: NDArray, normals: NDArray, face: NDArray, vertex: NDArray
) -> NDArray[np.float64]:
    """Mean over those faces at each corner's vertex that lean by less than the smooth angle from the corner's own."""
    order = np.argsort(vertex, kind="stable")
    starts = np.flatnonzero(np.diff(vertex[order], prepend=-1))
    sizes = np.diff(starts, append=len(order))
    size, start = np.repeat(sizes, sizes), np.repeat(starts, sizes)
    first = np.repeat(np.arange(len(order)), size)
    within = np.arange(len(first)) - np.repeat(np.cumsum(size) - size, size)
    a, b = face[order[first]], face[order[start[first] + within]]
    alike = np.einsum("px,px->p", normals[a], normals[b]) >= np.cos(np.radians(SMOOTH_ANGLE))
    first, b = first[alike], b[alike]
    total = np.bincount(first, areas[b] * values[b], len(order))
    area = np.bincount(first, areas[b], len(order))
    means = np.empty(len(order))
    means[order] = total / area
    return means
