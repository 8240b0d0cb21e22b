"""Silhouettes: how convex polygons may overlap as receivers see them.

Told first for all receivers and then one by one: a polygon hides nothing of what lies outside of one of its edges. On
which side of the plane through an edge and the receiver a corner lies, the sign of a volume tells, which is an affine
function of the receiver's place: for all of them one matrix product.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons

_SLIVER = 1e-9
"""Over the extent of all at hand: what is narrower makes no difference, as where two only touch."""

_VOLUMES = 100_000
"""That are held at once: they stay in cache."""


@dataclass(frozen=True, eq=False)
class Overlaps:
    """Pairs of an outer and an inner convex polygon, and how they may overlap as points see them.

    Attributes
    ----------
    outer, inner : (q,) int
        Numbers of the polygons; sorted by the inner one's.
    forms : (q, w, v, 4) float
        Of a point's place: height of inner corners within outer edges, over the extent of all, as seen from before the
        outer polygon.
    back : (q, v, w, 4) float
        Of outer corners within inner edges, as seen from before the inner polygon.
    free : (q, w) bool
    loose : (q, v) bool
        Which are no edges, of outer and of inner polygons.
    centre : (3,) float
        That places are relative to.
    """

    outer: np.ndarray
    inner: np.ndarray
    forms: np.ndarray
    back: np.ndarray
    free: np.ndarray
    loose: np.ndarray
    centre: np.ndarray

    @classmethod
    def of(cls, outer, inner, outer_of, inner_of, place, corners, facing) -> Overlaps:
        """Those that may overlap as seen from anywhere between the corners of their place.

        Parameters
        ----------
        outer, inner : (k, w, 3) and (s, v, 3) float
        outer_of, inner_of : (q,) int
            Pairs that count, in the order of the inner ones.
        place : (k,) int
            Of each outer polygon.
        corners : (p, c, 3) float
            Between which points are, place after place.
        facing : (k, c) float
            Positive where a corner is before an outer polygon, negative behind; 0 in its plane.

        Returns
        -------
        Overlaps
            ``centre`` is (p, 3), one for each place.
        """
        centre = corners.mean(axis=1)
        eye = corners - centre[:, None]
        outer = outer - centre[place][:, None]
        at = place[outer_of]
        one, other = outer[outer_of], inner[inner_of] - centre[at][:, None]
        low, high = (
            np.minimum(other.min(axis=1), eye.min(axis=1)[at]),
            np.maximum(other.max(axis=1), eye.max(axis=1)[at]),
        )
        extent = np.maximum(np.maximum(high, -low).max(axis=1), 1e-300)
        rounding = (_SLIVER * extent)[:, None]
        apart = (one.min(axis=1) > high + rounding) | (one.max(axis=1) < low - rounding)
        near = np.flatnonzero(~apart.any(axis=1))
        one, other, extent, at = one[near], other[near], extent[near], at[near]
        extent = np.maximum(extent, np.abs(one).max(axis=(1, 2), initial=0.0))
        outer_of, inner_of = outer_of[near], inner_of[near]
        forms, sides = _forms(one, other, extent)
        free = sides <= 1e-12 * extent[:, None]
        places = _places(eye)
        near = np.flatnonzero(_within(forms, free, places[at], facing[outer_of]))
        back, along = _forms(other[near], one[near], extent[near])
        loose = along <= 1e-12 * extent[near, None]
        found = cls(outer_of[near], inner_of[near], forms[near], back, free[near], loose, centre)
        return found.take(np.flatnonzero(found._reached(places[at[near]])))

    def take(self, index) -> Overlaps:
        """Some of the pairs."""
        return Overlaps(
            self.outer[index],
            self.inner[index],
            self.forms[index],
            self.back[index],
            self.free[index],
            self.loose[index],
            self.centre,
        )

    def near(self, corners, facing) -> np.ndarray:
        """(q,) bool: pairs that may overlap as seen from anywhere between ``corners`` (c, 3).

        ``facing`` (k, any) tells whether points are before or behind the outer polygons, or in their planes.
        """
        places = _places(corners - self.centre)
        return _within(self.forms, self.free, places, facing[self.outer]) & self._reached(places)

    def _reached(self, places) -> np.ndarray:
        """(q,) bool: outer polygons that reach within all inner edges, from some of places (4, c) or (q, 4, c)."""
        reach = _heights(self.back, places)
        return ((reach.max(axis=2, initial=-1.0) > _SLIVER) | self.loose).all(axis=1)

    def seen(self, points, facing) -> tuple[np.ndarray, np.ndarray]:
        """How each pair overlaps.

        Parameters
        ----------
        points : (r, 3) float
            Before the inner polygons.
        facing : (k, r) float
            Positive where a point is before an outer polygon, negative behind; 0 in its plane.

        Returns
        -------
        within : (q, r) bool
            The inner polygon lies wholly within the outer one.
        crossing : (q, r) bool
            A part of it does.
        """
        eye = _places(points - self.centre)
        within, crossing = np.zeros((2, len(self.outer), len(points)), bool)
        edges, corners = self.forms.shape[1:3]
        step = max(1, _VOLUMES // max(1, edges * corners * len(points)))
        for first in range(0, len(self.outer), step):
            some = slice(first, first + step)
            heights = (self.forms[some].reshape(-1, 4) @ eye).reshape(-1, edges, corners, len(points))
            low, high, free = heights.min(axis=2), heights.max(axis=2), self.free[some, :, None]
            here = facing[self.outer[some]]
            before, behind = here > 0, here < 0
            if before.any():
                crossing[some] = before & ((high > _SLIVER) | free).all(axis=1)
                within[some] = before & ((low > -_SLIVER) | free).all(axis=1)
            if behind.any():
                crossing[some] |= behind & ((low < -_SLIVER) | free).all(axis=1)
                within[some] |= behind & ((high < _SLIVER) | free).all(axis=1)
            left = first + np.flatnonzero(crossing[some].any(axis=1))
            reach = (self.back[left].reshape(-1, 4) @ eye).reshape(-1, corners, edges, len(points)).max(axis=2)
            crossing[left] &= ((reach > _SLIVER) | self.loose[left, :, None]).all(axis=1)
        within &= crossing
        crossing &= ~within
        return within, crossing


def _places(points) -> np.ndarray:
    """(..., 4, n) float: points ``(..., n, 3)`` as affine forms take them."""
    out = np.ones((*points.shape[:-2], 4, points.shape[-2]))
    out[..., :3, :] = np.swapaxes(points, -1, -2)
    return out


def _heights(forms, places) -> np.ndarray:
    """(q, w, n) float: what forms ``(q, w, v, 4)`` are at places (4, c), or (q, 4, c) of each pair's own."""
    pairs, edges, corners = forms.shape[:3]
    if places.ndim == 2:
        return (forms.reshape(-1, 4) @ places).reshape(pairs, edges, corners * places.shape[-1])
    return (forms.reshape(pairs, edges * corners, 4) @ places).reshape(pairs, edges, corners * places.shape[-1])


def _within(forms, free, places, facing) -> np.ndarray:
    """(q,) bool: inner polygons that reach within all outer edges as seen from somewhere between places."""
    before, behind = (facing > 0).any(axis=1), (facing < 0).any(axis=1)
    heights = _heights(forms, places)
    may = ((heights.max(axis=2, initial=-1.0) > _SLIVER) | free).all(axis=1) & before
    may |= ((heights.min(axis=2, initial=1.0) < -_SLIVER) | free).all(axis=1) & behind
    return may


def _forms(edged, others, extent) -> tuple[np.ndarray, np.ndarray]:
    """Affine forms of a point's place, positive where others' corners lie within an edge; and edges' lengths (q, w).

    Parameters
    ----------
    edged : (q, w, 3) float
    others : (q, v, 3) float
    extent : (q,) float

    Returns
    -------
    forms : (q, w, v, 4) float
        Nought where an edge and a corner lie on one line.
    sides : (q, w) float
    """
    edge = polygons.following(edged) - edged
    normal = polygons.cross(edge[:, :, None], others[:, None] - edged[:, :, None])
    length = np.sqrt(np.einsum("...c,...c->...", normal, normal))
    side = np.sqrt(np.einsum("...c,...c->...", edge, edge))
    extent = extent[:, None, None]
    plane = length > 1e-12 * extent * side[:, :, None]
    scale = np.where(plane, 1.0 / np.where(plane, length * extent, 1.0), 0.0)
    forms = np.empty((*length.shape, 4))
    np.multiply(normal, scale[..., None], out=forms[..., :3])
    forms[..., 3] = -np.einsum("qwvc,qwc->qwv", forms[..., :3], edged)
    return forms, side
