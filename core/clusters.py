"""Clusters: facets of curved meshes and furniture that lie beside each other and face alike, for one receiver."""

from __future__ import annotations

import numpy as np

MANY_FACETS = 20_000
"""Facets that are planes of their own, beyond which they share receivers."""

_STEP = 0.5
"""Components of normals are told apart in such steps: some 25° of difference at most from one to the next."""

_FINEST = 1 << 15
"""Cells along the longest side, to begin with."""


def clustered(points: np.ndarray, normals: np.ndarray, surface: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Gather facets by surface, facing and place until there are few groups.

    Parameters
    ----------
    points, normals : (k, 3) float
    surface : (k,) int
        Facets of different surfaces never share a group.
    most : int
        Number of groups not to exceed, unless facing and surface alone make more.

    Returns
    -------
    group : (k,) int
    middle : (g,) int
        The facet of each group that is most like the mean of all.
    """
    facing = np.rint(normals / _STEP).astype(np.int64) @ [1, 8, 64]
    _, kind = np.unique(np.stack([surface, facing]), axis=1, return_inverse=True)
    kind = kind.reshape(-1)
    low = points.min(axis=0)
    side = max(float(np.ptp(points, axis=0).max()), 1e-300) / _FINEST
    while True:
        cell = ((points - low) / side).astype(np.int64)
        place = (cell[:, 0] * (_FINEST + 1) + cell[:, 1]) * (_FINEST + 1) + cell[:, 2]
        _, place = np.unique(place, return_inverse=True)
        kinds, group = np.unique(place.reshape(-1) * (int(kind.max()) + 1) + kind, return_inverse=True)
        if len(kinds) <= most or not cell.any():
            break
        side *= 2
    group = group.reshape(-1)
    return group, _middles(group, len(kinds), points / side, normals)


def _middles(group: np.ndarray, count: int, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    size = np.bincount(group, minlength=count)
    away = np.zeros(len(group))
    for values in (*points.T, *normals.T):
        mean = np.bincount(group, weights=values, minlength=count) / size
        away += (values - mean[group]) ** 2
    order = np.lexsort((away, group))
    return order[np.cumsum(size) - size]
