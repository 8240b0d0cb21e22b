"""The unit disc: how much of it a polygon covers, where that part's centre lies, and quadrature over it.

Points are homogeneous, ``(1, u, v)``, so that half-planes are ``line · point ≥ 0`` and directions of the solar disc
are ``point @ axes``.
"""

from __future__ import annotations

import numpy as np

SQUARE = np.array([[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])
"""(4, 3): the square around the disc, anticlockwise."""

_RINGS, _ON_A_RING = 3, 9
_CHORDS = 8


def moments(shapes) -> np.ndarray:
    """Share of the unit disc inside polygons, and that share times its centroid.

    Parameters
    ----------
    shapes : (..., v, 3) array of float
        Anticlockwise, homogeneous; padded by repeating the last vertex.

    Returns
    -------
    (..., 3) float
        Share, share · u, share · v.

    Notes
    -----
    Green's theorem along the boundary: triangles from the centre to what of an edge lies inside, sectors to what lies
    outside.
    """
    start = np.asarray(shapes, float)[..., 1:]
    end = np.roll(start, -1, axis=-2)
    edge = end - start
    square, slope = (edge**2).sum(axis=-1), (start * edge).sum(axis=-1)
    root = slope**2 - square * ((start**2).sum(axis=-1) - 1.0)
    meets = (root > 0) & (square > 0)
    root, square = np.sqrt(np.where(meets, root, 0.0)), np.where(meets, square, 1.0)
    enter = np.where(meets, np.clip((-slope - root) / square, 0.0, 1.0), 0.0)
    leave = np.where(meets, np.clip((-slope + root) / square, 0.0, 1.0), 0.0)
    first, last = start + enter[..., None] * edge, start + leave[..., None] * edge
    area = 0.5 * (first[..., 0] * last[..., 1] - first[..., 1] * last[..., 0])
    triangle = np.concatenate([area[..., None], area[..., None] * (first + last) / 3.0], axis=-1)
    total = triangle + _sector(start, first, enter > 0) + _sector(last, end, leave < 1)
    return total.sum(axis=-2) / np.pi


def _sector(start, end, outside) -> np.ndarray:
    """Area and first moments of the disc's sectors between points outside of it; 0 where they are not."""
    one = start / np.maximum(np.linalg.norm(start, axis=-1, keepdims=True), 1e-300)
    two = end / np.maximum(np.linalg.norm(end, axis=-1, keepdims=True), 1e-300)
    angle = np.arctan2(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0], (one * two).sum(axis=-1))
    parts = [0.5 * angle, (two[..., 1] - one[..., 1]) / 3.0, (one[..., 0] - two[..., 0]) / 3.0]
    return np.where(outside[..., None], np.stack(parts, axis=-1), 0.0)


def moments_above(level: float) -> np.ndarray:
    """(3,) float: as `moments`, of the part of the disc with ``v ≥ level``."""
    level = min(max(float(level), -1.0), 1.0)
    half = np.sqrt(1.0 - level**2)
    return np.array([np.arccos(level) - level * half, 0.0, 2.0 / 3.0 * half**3]) / np.pi


def quadrature(level: float) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights for means over the part of the disc with ``v ≥ level``.

    Parameters
    ----------
    level : float
        -1 or less: the whole disc; below 1.

    Returns
    -------
    points : (q, 3) float, homogeneous
    weights : (q,) float
        They add up to the part's share in the disc.

    Notes
    -----
    Whole: three rings of nine points, every other one turned by half a step, Gaussian in the square of the radius; for
    a kink along any chord the mean errs by less than 0.0035 radii, five times less than as many evenly spread points.
    Cut: eight chords of eight points.
    """
    if level <= -1.0:
        node, weight = np.polynomial.legendre.leggauss(_RINGS)
        ring, step = np.divmod(np.arange(_RINGS * _ON_A_RING), _ON_A_RING)
        radius, angle = np.sqrt(0.5 * (node[ring] + 1.0)), (step + 0.5 * ring) * (2.0 * np.pi / _ON_A_RING)
        points = np.stack([np.ones(len(ring)), radius * np.cos(angle), radius * np.sin(angle)], axis=1)
        return points, 0.5 * weight[ring] / _ON_A_RING
    node, weight = np.polynomial.legendre.leggauss(_CHORDS)
    angle = 0.5 * np.arccos(level) * (node + 1.0)
    u = np.sin(angle)[:, None] * node
    v = np.broadcast_to(np.cos(angle)[:, None], u.shape)
    share = (np.sin(angle) ** 2 * weight)[:, None] * weight
    share *= moments_above(level)[0] / share.sum()
    return np.stack([np.ones(u.size), u.ravel(), v.ravel()], axis=1), share.ravel()
