"""Polygons in space: orientation, areas and middles.

Batches of convex polygons travel as ``(m, v, 3)`` arrays padded by repeating the last vertex.
"""

from __future__ import annotations

import numpy as np


def cross(a, b) -> np.ndarray:
    """Cross products of vectors ``(..., 3)``, several times faster than NumPy's on small arrays."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    out[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    out[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    out[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return out


def following(values, axis: int = 1) -> np.ndarray:
    """Each corner's next one along an axis, several times faster than NumPy's ``roll`` on small arrays."""
    before = (slice(None),) * axis
    return np.concatenate([values[(*before, slice(1, None))], values[(*before, slice(1))]], axis=axis)


def newell_normal(polygon) -> np.ndarray:
    """Vector along the right-hand normal of closed polygons, of twice their area (Newell's method).

    Parameters
    ----------
    polygon : (..., v, 3) array of float

    Returns
    -------
    (..., 3) float
    """
    p = np.asarray(polygon, float)
    p = p[..., 1:, :] - p[..., :1, :]
    if p.size < _FEW:  # fewer steps
        product = np.matmul(np.swapaxes(p[..., :-1, :], -1, -2), p[..., 1:, :])
        return np.stack([product[..., i, j] - product[..., j, i] for i, j in _PLANES], axis=-1)
    out = np.empty((*p.shape[:-2], 3))
    for k, (i, j) in enumerate(_PLANES):
        first, second = p[..., i], p[..., j]
        out[..., k] = np.einsum("...v,...v->...", first[..., :-1], second[..., 1:])
        out[..., k] -= np.einsum("...v,...v->...", second[..., :-1], first[..., 1:])
    return out


_PLANES = ((1, 2), (2, 0), (0, 1))
_FEW = 500
"""Coordinates up to which the number of steps counts, not what they do."""


def areas(polygons) -> np.ndarray:
    """(...) float: areas of planar polygons ``(..., v, 3)`` [m²]."""
    normal = newell_normal(polygons)
    return 0.5 * np.sqrt((normal * normal).sum(axis=-1))


def widen(polygons, width: int) -> np.ndarray:
    """(m, width, 3) float: padded polygons ``(m, v, 3)``, v ≤ width, padded further."""
    return np.concatenate([polygons, np.repeat(polygons[:, -1:], width - polygons.shape[1], axis=1)], axis=1)


def joined(batches) -> np.ndarray:
    """All padded polygons of several batches ``(m, v, 3)`` in one; at least one batch."""
    width = max(batch.shape[1] for batch in batches)
    return np.concatenate([widen(batch, width) for batch in batches])


# Radon's rule for means over triangles, exact to the fifth degree: barycentric places, and shares
_NEAR, _FAR = (6 - np.sqrt(15)) / 21, (6 + np.sqrt(15)) / 21
RADON_PLACES = np.array(
    [[1 / 3] * 3] + [np.roll([1 - 2 * a, a, a], k).tolist() for a in (_NEAR, _FAR) for k in range(3)]
)
RADON_SHARES = np.repeat([9 / 40, (155 - np.sqrt(15)) / 1200, (155 + np.sqrt(15)) / 1200], [1, 3, 3])


def centroids(polygons) -> np.ndarray:
    """(m, 3) float: centroids of planar convex polygons ``(m, v, 3)``."""
    p = np.asarray(polygons, float)
    if not len(p):
        return np.zeros((0, 3))
    fan = cross(p[:, 1:-1] - p[:, :1], p[:, 2:] - p[:, :1])
    normal = fan.sum(axis=1)
    share = np.einsum("mvc,mc->mv", fan, normal) / np.maximum(np.einsum("mc,mc->m", normal, normal), 1e-300)[:, None]
    return p[:, 0] + np.einsum("mv,mvc->mc", share, p[:, 1:-1] + p[:, 2:] - 2 * p[:, :1]) / 3


def plane_basis(normal) -> np.ndarray:
    """Two unit vectors that span the plane of a normal, right-handed with it.

    Axis-parallel planes get axis-parallel vectors, so that grids align with rooms.

    Parameters
    ----------
    normal : (3,) float, unit

    Returns
    -------
    (2, 3) float
    """
    n = np.asarray(normal, float)
    helper = np.eye(3)[2] if abs(n[2]) < 0.9 else np.eye(3)[0]
    first = cross(helper, n) if abs(n[2]) < 0.9 else helper - n * n[0]
    first /= np.linalg.norm(first)
    return np.stack([first, cross(n, first)])


def pad(polygons: list[np.ndarray], width: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Stack polygons of different length by repeating their last vertex.

    Returns
    -------
    vertices : (m, v, 3) float
    counts : (m,) int
    """
    counts = np.array([len(p) for p in polygons], dtype=np.int64)
    width = width or (int(counts.max()) if len(counts) else 3)
    out = np.zeros((len(polygons), width, 3))
    for row, p in zip(out, polygons, strict=True):
        row[: len(p)] = p
        row[len(p) :] = p[-1]
    return out, counts
