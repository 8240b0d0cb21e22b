"""What is seen of convex polygons past convex screens: Lambert's form factor along the contour of what is left.

A point sees polygons and screens as convex shapes on the sphere, bounded by great circles. The contour of a polygon
less all screens is what screens leave of its edges, and what of the screens' edges lies within it and within no other
screen; Lambert's formula is a sum over these pieces. So nothing is cut and joined again, however many screens overlap.

Arrays run over many pairs of a point and a polygon along their last axis, so that all steps go through long rows.
"""

from __future__ import annotations

import numpy as np

_ON_EDGE = 1e-12
"""Over the lengths of the three vectors: less volume than this means that a corner lies on an edge's great circle."""

_NO_EDGE = 1e-11
"""Sine of the angle that an edge spans, below which it bounds nothing."""

_VALUES = 40_000
"""Corners times edges times pairs that are looked at together: they stay in cache."""


def form_factors(shapes: np.ndarray, screens: np.ndarray, facing: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Form factors from points to what they see of polygons past opaque screens.

    Parameters
    ----------
    shapes : (3, v, n) float
        Convex polygons relative to the points, padded by repeating a vertex; above the points' horizon, their
        right-hand normals towards the points.
    screens : (k, 3, w, n) float
        Convex polygons relative to the points, padded likewise, between point and polygon wherever they overlap.
    facing : (k, n) float
        Positive where a screen's right-hand normal looks at the point, negative where away.
    normal : (3,) float, unit
        Of the points.

    Returns
    -------
    (n,) float
    """
    count, corners, edges = shapes.shape[2], shapes.shape[1], shapes.shape[1] + screens.shape[0] * screens.shape[2]
    step = max(16, _VALUES // (edges * max(edges - corners, 1)))
    found = np.empty(count)
    for first in range(0, count, step):
        some = slice(first, first + step)
        found[some] = _along_contours(shapes[..., some], screens[..., some], facing[:, some], normal)
    return found


def whole_form_factors(shapes: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(n,) float: form factors to polygons, as `form_factors` where no screen is in the way."""
    following = _following(shapes)
    pole = _cross(following, shapes)
    length = np.sqrt(_dot(pole, pole))
    angle = np.arctan2(length, _dot(shapes, following))
    angle *= normal[0] * pole[0] + normal[1] * pole[1] + normal[2] * pole[2]
    return np.divide(angle, length, out=angle, where=length > 0).sum(axis=0) / (2 * np.pi)


def _along_contours(shapes, screens, facing, normal) -> np.ndarray:
    k, _, w, n = screens.shape
    v = shapes.shape[1]
    start = np.concatenate([shapes, screens.transpose(1, 0, 2, 3).reshape(3, k * w, n)], axis=1)
    end = np.concatenate(
        [_following(shapes), _following(screens, 2).transpose(1, 0, 2, 3).reshape(3, k * w, n)], axis=1
    )
    pole = _cross(end, start)  # of polygons that face the point it looks inwards
    pole[:, v:] *= np.repeat(np.where(facing < 0, -1.0, 1.0), w, axis=0)
    size = np.sqrt(_dot(start, start))
    length = np.sqrt(_dot(pole, pole))
    reach = size * np.concatenate([_following(size[:v], 0), _following(size[v:].reshape(k, w, n), 1).reshape(-1, n)])
    edge = length > _NO_EDGE * reach
    rounding = _ON_EDGE * reach

    def heights(planes: slice, corners: slice) -> np.ndarray:
        """(p, c, n): of corners above the planes of edges; 0 on them, 1 where there is no edge."""
        out = pole[0, planes, None] * start[0, None, corners]
        out += pole[1, planes, None] * start[1, None, corners]
        out += pole[2, planes, None] * start[2, None, corners]
        out[np.abs(out) <= rounding[planes, None] * size[None, corners]] = 0.0
        np.copyto(out, 1.0, where=~edge[planes, None])
        return out

    def aligned(planes: slice, corners: slice, both) -> np.ndarray:
        """(j,) bool: whether edges that lie on each other, at indices ``both``, have the same inner side."""
        p, c, m = both
        p, c = p + planes.start, c + corners.start
        return (pole[:, p, m] * pole[:, c, m]).sum(axis=0) > 0

    own, others = slice(0, v), slice(v, v + k * w)
    # of the screens' edges what lies within the polygon, borders not included
    height = heights(own, others)
    after = _following(height.reshape(v, k, w, n), 2).reshape(v, k * w, n)
    low, high = _between(height, after, (height == 0) & (after == 0) & edge[own, None])
    low, high = np.concatenate([np.zeros((v, n)), low]), np.concatenate([np.ones((v, n)), high])
    # of all edges what each screen covers
    begin, finish = np.full((k, v + k * w, n), 2.0), np.full((k, v + k * w, n), 2.0)
    every = slice(0, v + k * w) if k > 1 else own
    for j in range(k):
        mine = slice(v + j * w, v + (j + 1) * w)
        height = heights(mine, every)
        parts = [_following(height[:, :v], 1)]
        if k > 1:
            parts.append(_following(height[:, v:].reshape(w, k, w, n), 2).reshape(w, k * w, n))
        after = np.concatenate(parts, axis=1)
        lies = (height == 0) & (after == 0) & edge[mine, None]
        if lies.any():
            # where two lie on each other with the same inner side, one counts: the later screen's, never the polygon's
            both = np.nonzero(lies)
            covered = aligned(mine, every, both) & (both[1] < mine.start)
            lies[tuple(index[covered] for index in both)] = False
        covers = _between(height, after, lies)
        empty = covers[0] >= covers[1]
        for out, found in zip((begin, finish), covers, strict=True):
            out[j, every] = np.where(empty, 2.0, found)
            out[j, mine] = 2.0
    return _sum_of_gaps(low, high, begin, finish, start, end, pole, length, v, normal)


def _between(first, last, outside) -> tuple[np.ndarray, np.ndarray]:
    """(c, n) twice: where edges enter and leave a convex shape, as shares of their lengths.

    ``first`` and ``last`` (p, c, n) are the heights of their ends above the planes of its edges; ``outside``: an edge
    that lies in such a plane counts as not within.
    """
    change = first - last
    change[change == 0] = -1e-300
    with np.errstate(over="ignore"):
        cut = first / change
    rising = change < 0
    begin = np.where(rising, cut, 0.0).max(axis=0)
    finish = np.where(rising, 1.0, cut).min(axis=0)
    if outside.any():
        finish[outside.any(axis=0)] = -1.0
    return np.maximum(begin, 0.0), np.minimum(finish, 1.0)


def _sum_of_gaps(low, high, begin, finish, start, end, pole, length, corners: int, normal) -> np.ndarray:
    """(n,): Lambert's sum over what covers ``(k, c, n)`` leave of edges from ``low`` to ``high``."""
    if len(begin) > 1:
        order = np.argsort(begin, axis=0)
        begin, finish = np.take_along_axis(begin, order, axis=0), np.take_along_axis(finish, order, axis=0)
    total, reached = np.zeros(low.shape[1]), low
    along = np.divide(
        normal[0] * pole[0] + normal[1] * pole[1] + normal[2] * pole[2],
        length,
        out=np.zeros_like(length),
        where=length > 0,
    )
    along[corners:] *= -1.0
    step = end - start
    squares = _dot(start, start), _dot(start, step), _dot(step, step)
    for j in range(len(begin) + 1):
        until = high if j == len(begin) else np.minimum(begin[j], high)
        edge, pair = np.nonzero(until > reached)
        a, b = reached[edge, pair], until[edge, pair]
        here, slope, square = (values[edge, pair] for values in squares)
        angle = np.arctan2((b - a) * length[edge, pair], here + (a + b) * slope + a * b * square)
        total += np.bincount(pair, weights=angle * along[edge, pair], minlength=len(total))
        if j < len(begin):
            reached = np.maximum(reached, finish[j])
    return total / (2 * np.pi)


def _following(values: np.ndarray, axis: int = 1) -> np.ndarray:
    """Each corner's next one."""
    rest = np.take(values, np.arange(1, values.shape[axis]), axis=axis)
    return np.concatenate([rest, np.take(values, [0], axis=axis)], axis=axis)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products of vectors ``(3, ...)``."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for k, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(a[i], b[j], out=out[k])
        out[k] -= a[j] * b[i]
    return out


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    out = a[0] * b[0]
    out += a[1] * b[1]
    out += a[2] * b[2]
    return out
