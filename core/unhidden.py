"""What is seen of convex polygons past convex screens: Lambert's form factor along the contour of what is left.

A point sees polygons and screens as convex shapes on the sphere, bounded by great circles. The contour of a polygon
less all screens is what screens leave of its edges, and what of the screens' edges lies within it and within no other
screen; Lambert's formula is a sum over these pieces. So nothing is cut and joined again, however many screens overlap.

Arrays run over many pairs of a point and a polygon along their last axis, so that all steps go through long rows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .polygons import following

_ON_EDGE, _MOST_ON_EDGE = 1e-12, 1e-6
"""Height of unit vectors over an edge's plane, times the edge's length, up to which they lie on its great circle: at
least, and at most where corners are near and rounding of their places makes a large angle."""

_NO_EDGE = 1e-11
"""Sine of the angle that an edge spans, below which it bounds nothing."""

_TINY = 1e-300

_VALUES = 80_000
"""Corners times edges times pairs that are looked at together: they stay in cache."""


def form_factors(
    shapes: np.ndarray, screens: np.ndarray, facing: np.ndarray, normal: np.ndarray, tolerance: float = 0.0
) -> np.ndarray:
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
    normal : (3,) or (3, n) float, unit
        Of the points.
    tolerance : float
        Distance at which corners may be meant to lie on an edge [m].

    Returns
    -------
    (n,) float
    """
    count, corners, edges = shapes.shape[2], shapes.shape[1], shapes.shape[1] + screens.shape[0] * screens.shape[2]
    normal = np.broadcast_to(normal.reshape(3, -1), (3, count))

    def find(some: slice) -> np.ndarray:
        return _along_contours(shapes[..., some], screens[..., some], facing[:, some], normal[:, some], tolerance)

    return _some_at_a_time(find, count, edges * max(edges - corners, 1))


def form_factors_within(
    shapes: np.ndarray, windows: np.ndarray, facing: np.ndarray, normal: np.ndarray, tolerance: float = 0.0
) -> np.ndarray:
    """Form factors from points to what they see of polygons through windows.

    Parameters
    ----------
    shapes : (3, v, n) float
        As of `form_factors`.
    windows : (3, w, n) float
        Convex polygons relative to the points, padded likewise.
    facing : (n,) float
        Positive where a window's right-hand normal looks at the point, negative where away.
    normal, tolerance
        As of `form_factors`.

    Returns
    -------
    (n,) float
    """
    count = shapes.shape[2]
    normal = np.broadcast_to(normal.reshape(3, -1), (3, count))

    def find(some: slice) -> np.ndarray:
        edges = _Edges.of(shapes[..., some], windows[None, ..., some], facing[None, some], tolerance)
        return edges.along_what_both_share(normal[:, some])

    return _some_at_a_time(find, count, shapes.shape[1] * windows.shape[1])


def _some_at_a_time(find: Callable[[slice], np.ndarray], count: int, values: int) -> np.ndarray:
    """(count,) float: what is found for some pairs of so many ``values`` each at a time."""
    step, found = max(16, _VALUES // values), np.empty(count)
    with np.errstate(divide="ignore", over="ignore"):
        for first in range(0, count, step):
            some = slice(first, first + step)
            found[some] = find(some)
    return found


def whole_form_factors(shapes: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(n,) float: form factors to polygons, as `form_factors` where no screen is in the way."""
    after = following(shapes)
    pole = _cross(after, shapes)
    length = np.sqrt(_dot(pole, pole))
    angle = np.arctan2(length, _dot(shapes, after))
    angle *= normal[0] * pole[0] + normal[1] * pole[1] + normal[2] * pole[2]
    return np.divide(angle, length, out=angle, where=length > 0).sum(axis=0) / (2 * np.pi)


@dataclass(frozen=True, eq=False)
class _Edges:
    """Edges of polygons, and after them those of screens, as seen from points.

    Attributes
    ----------
    corners, screens : int
        Of each polygon, and how many screens.
    start, end : (3, c, n) float, unit
    pole : (3, c, n) float
        Of the planes through point and edge, inwards; nought where there is no edge.
    length : (c, n) float
        Of ``pole``.
    edge : (c, n) bool
    on_edge : (n,) float
        Height up to which corners lie on an edge, times its length.
    """

    corners: int
    screens: int
    start: np.ndarray
    end: np.ndarray
    pole: np.ndarray
    length: np.ndarray
    edge: np.ndarray
    on_edge: np.ndarray

    @classmethod
    def of(cls, shapes, screens, facing, tolerance: float) -> _Edges:
        """Those of shapes ``(3, v, n)`` and of screens ``(k, 3, w, n)``."""
        k, _, w, n = screens.shape
        v = shapes.shape[1]
        start = np.concatenate([shapes, screens.transpose(1, 0, 2, 3).reshape(3, k * w, n)], axis=1)
        distance = np.maximum(np.sqrt(_dot(start, start)), _TINY)
        start /= distance
        on_edge = np.clip(tolerance / distance.min(axis=0), _ON_EDGE, _MOST_ON_EDGE)
        after = following(start[:, v:].reshape(3, k, w, n), 2).reshape(3, k * w, n)
        end = np.concatenate([following(start[:, :v]), after], axis=1)
        pole = _cross(end, start)  # of polygons that face the point it looks inwards
        pole[:, v:] *= np.repeat(np.where(facing < 0, -1.0, 1.0), w, axis=0)
        length = np.sqrt(_dot(pole, pole))
        edge = length > _NO_EDGE
        pole *= edge
        return cls(v, k, start, end, pole, length, edge, on_edge)

    def heights(self, planes: slice, corners: slice) -> tuple[np.ndarray, np.ndarray]:
        """(p, c, n) twice: of edges' beginnings and ends above the planes of others; tiny where there is no edge."""
        pole, start = self.pole, self.start
        out = pole[0, planes, None] * start[0, None, corners]
        out += pole[1, planes, None] * start[1, None, corners]
        out += pole[2, planes, None] * start[2, None, corners]
        out += _TINY
        if corners.stop <= self.corners:
            return out, following(out)
        width = (self.start.shape[1] - self.corners) // self.screens
        return out, following(out.reshape(len(out), -1, width, out.shape[2]), 2).reshape(out.shape)

    def within(self, planes: slice, corners: slice, borders: str) -> tuple[np.ndarray, np.ndarray]:
        """(c, n) twice: where edges enter and leave what other edges bound, as shares of their lengths.

        ``borders`` tells whether an edge that lies on one of these counts as within: "never"; "alike", where the inner
        sides are the same; or "later", where besides the other belongs to a later screen, so that one of two counts.
        """
        first, last = self.heights(planes, corners)
        lies = _lying(first, last, self.edge[planes], self.on_edge)
        if lies is not None and borders != "never":
            plane, other, pair = np.nonzero(lies)
            poles = self.pole[:, planes.start + plane, pair], self.pole[:, corners.start + other, pair]
            counts = (poles[0] * poles[1]).sum(axis=0) > 0
            if borders == "later":
                counts &= corners.start + other < planes.start
            lies[plane[counts], other[counts], pair[counts]] = False
        return _between(first, last, lies)

    def along_what_both_share(self, normal) -> np.ndarray:
        """(n,) float: Lambert's sum along the contour of what lies within the polygon and within the one window."""
        own, others = slice(0, self.corners), slice(self.corners, self.start.shape[1])
        kept = np.concatenate([self.within(others, own, "alike"), self.within(own, others, "never")], axis=1)
        return self.sum_of_gaps(kept[0], kept[1], np.zeros((2, 0)), normal, len(self.length))

    def sum_of_gaps(self, low, high, covers, normal, forwards: int) -> np.ndarray:
        """(n,): Lambert's sum over what covers ``(2, k, c, n)`` leave of edges from ``low`` to ``high``.

        The first so many edges are run along ``forwards``, the others backwards.
        """
        count = low.shape[1]
        begin, finish = covers
        if len(begin) > 1:
            begin, finish = _ordered(begin, finish)
        along = normal[0] * self.pole[0] + normal[1] * self.pole[1] + normal[2] * self.pole[2]
        along /= np.maximum(self.length, _TINY)
        along[forwards:] *= -1.0
        cosine = _dot(self.start, self.end).ravel()
        along, length = along.ravel(), self.length.ravel()
        total, reached = np.zeros(count), low
        for j in range(len(begin) + 1):
            until = high if j == len(begin) else np.minimum(begin[j], high)
            some = np.flatnonzero(until > reached)
            a, b = reached.ravel().take(some), until.ravel().take(some)
            aside = cosine.take(some) - 1.0
            # between points of the chord from one unit vector to the next
            angle = np.arctan2((b - a) * length.take(some), 1.0 + (a + b - 2.0 * a * b) * aside)
            total += np.bincount(some % count, weights=angle * along.take(some), minlength=count)
            if j < len(begin):
                reached = np.maximum(reached, finish[j])
        return total / (2 * np.pi)


def _along_contours(shapes, screens, facing, normal, tolerance: float) -> np.ndarray:
    k, _, w, n = screens.shape
    v = shapes.shape[1]
    edges = _Edges.of(shapes, screens, facing, tolerance)
    own, others = slice(0, v), slice(v, v + k * w)
    # of the screens' edges what lies within the polygon, borders not included
    low, high = np.empty((2, v + k * w, n))
    low[own], high[own] = 0.0, 1.0
    low[others], high[others] = edges.within(own, others, "never")
    # of all edges what each screen covers
    covers = np.full((2, k, v + k * w, n), 2.0)
    for j in range(k):
        mine = slice(v + j * w, v + (j + 1) * w)
        for some in (own, slice(v, mine.start), slice(mine.stop, v + k * w)):
            if some.stop > some.start:
                covers[:, j, some] = edges.within(mine, some, "later")
    return edges.sum_of_gaps(low, high, covers, normal, v)


def _lying(first, last, edge, on_edge) -> np.ndarray | None:
    """(p, c, n) bool: segments that lie on the great circles of edges, whose heights become 1; None where none do."""
    lies = np.abs(first) <= on_edge * edge[:, None]
    if not lies.any():
        return None
    lies &= np.abs(last) <= on_edge
    lies &= edge[:, None]
    if not lies.any():
        return None
    first[lies] = last[lies] = 1.0  # rounding shall not cut them
    return lies


def _between(first, last, outside) -> tuple[np.ndarray, np.ndarray]:
    """(c, n) twice: where edges enter and leave a convex shape, as shares of their lengths; the same where they do not.

    ``first`` and ``last`` (p, c, n) are the heights of their ends above the planes of its edges; ``outside``: an edge
    that lies in such a plane counts as not within.
    """
    change = first - last
    cut = np.divide(first, change, out=first)
    rising = change < 0
    begin = np.where(rising, cut, 0.0).max(axis=0, initial=0.0)
    np.copyto(cut, 1.0, where=rising)
    finish = cut.min(axis=0, initial=1.0)
    if outside is not None:
        finish[outside.any(axis=0)] = -1.0
    return begin, np.maximum(finish, begin, out=finish)


def _ordered(begin: np.ndarray, finish: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Covers ``(k, c, n)`` in the order of their beginnings."""
    if len(begin) == 2:  # several times as quick as by sorting
        later = begin[0] > begin[1]
        return (
            np.stack([np.minimum(*begin), np.maximum(*begin)]),
            np.stack([np.where(later, finish[1], finish[0]), np.where(later, finish[0], finish[1])]),
        )
    order = np.argsort(begin, axis=0)
    return np.take_along_axis(begin, order, axis=0), np.take_along_axis(finish, order, axis=0)


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
