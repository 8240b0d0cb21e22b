"""Solids: closed surfaces that look outwards, whose insides nobody outside ever sees.

From outside, every ray that meets such a surface meets a front of it before any back. So for receivers outside, what
turns its back on them need not be looked for: of a ball the near half is left, whose facets do not overlap each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons, rings
from .arrays import places_among
from .planes import Planes

_SAME_PLACE = 1e-9
"""Distance at which corners are one, over the scene's size."""

_ASIDE = 1e-6
"""How far before their plane receivers are asked whether they are outside, over the scene's size."""

_FEWEST_FACETS = 4


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed surface that looks outwards, as triangles.

    Attributes
    ----------
    triangles : (t, 3, 3) float
    low, high : (3,) float
        Its bounding box.
    """

    triangles: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def all_outside(self, points: np.ndarray) -> bool:
        """Whether none of the points ``(n, 3)`` lies inside: nowhere does it surround them (van Oosterom 1983)."""
        near = points[((points > self.low) & (points < self.high)).all(axis=1)]
        if not len(near):
            return True
        a, b, c = np.moveaxis(self.triangles[None] - near[:, None, None], 2, 0)
        la, lb, lc = (np.linalg.norm(v, axis=2) for v in (a, b, c))
        ab, bc, ca = ((one * two).sum(axis=2) for one, two in ((a, b), (b, c), (c, a)))
        triple = (polygons.cross(a, b) * c).sum(axis=2)
        angle = 2 * np.arctan2(triple, la * lb * lc + ab * lc + bc * la + ca * lb)
        return bool((np.abs(angle.sum(axis=1)) < np.pi).all())


@dataclass(frozen=True, eq=False)
class Solids:
    """The solids of a scene.

    Attributes
    ----------
    solids : tuple of Solid
    of_outline : (o,) int
        Solid that each outline belongs to, or -1.
    aside : float
        See `unseen_backs` [m].
    """

    solids: tuple[Solid, ...]
    of_outline: np.ndarray
    aside: float

    def having(self, outlines: np.ndarray) -> Solids:
        """Those that any of some outlines ``(l,)`` int belongs to."""
        kept = np.unique(self.of_outline[outlines])
        kept = kept[kept >= 0]
        number = np.full(len(self.solids) + 1, -1)
        number[kept] = np.arange(len(kept))
        return Solids(tuple(self.solids[k] for k in kept), number[self.of_outline], self.aside)

    def unseen_backs(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """(o,) bool: outlines whose backs none of some receivers of one plane ``(r, 3)`` can see."""
        before = points + self.aside * normal
        outside = np.array([solid.all_outside(before) for solid in self.solids] + [False])
        return outside[self.of_outline]


def find_solids(planes: Planes, opaque: np.ndarray) -> Solids:
    """Find closed surfaces that look outwards, whatever surfaces of the scene they are made of.

    Parameters
    ----------
    planes : Planes
    opaque : (surfaces,) bool
        Those that light does not pass straight through.

    Returns
    -------
    Solids
    """
    tight = opaque[planes.sheet_surface[planes.given_sheet]]
    body = _bodies(planes.given, planes.given_counts, tight, _SAME_PLACE * planes.size)
    found: list[Solid] = []
    number = np.full(int(body.max(initial=-1)) + 1, -1)
    order = np.argsort(body, kind="stable")
    for mine in np.split(order, np.flatnonzero(np.diff(body[order])) + 1):
        k = body[mine[0]] if len(mine) else -1
        if k < 0 or len(mine) < _FEWEST_FACETS:
            continue
        pieces, counts = planes.given[mine], planes.given_counts[mine]
        fans = [pieces[counts > j + 1][:, [0, j, j + 1]] for j in range(1, pieces.shape[1] - 1)]
        triangles = np.concatenate(fans)
        middle = triangles.reshape(-1, 3).mean(axis=0)
        a, b, c = np.moveaxis(triangles - middle, 1, 0)
        if (polygons.cross(a, b) * c).sum() > 0:
            corners = triangles.reshape(-1, 3)
            number[k] = len(found)
            found.append(Solid(triangles, corners.min(axis=0), corners.max(axis=0)))
    return Solids(tuple(found), _of_outlines(planes, np.append(number, -1)[body]), _ASIDE * planes.size)


def _bodies(pieces: np.ndarray, counts: np.ndarray, tight: np.ndarray, same: float) -> np.ndarray:
    """(g,) int: closed surface that each piece is a part of; -1 where it is of none."""
    width = pieces.shape[1]
    real = np.arange(width) < counts[:, None]
    corner = rings.welded(pieces.reshape(-1, 3), same)[1].reshape(-1, width)
    after = np.where(np.arange(width) == counts[:, None] - 1, corner[:, :1], np.roll(corner, -1, axis=1))
    piece = np.repeat(np.arange(len(pieces)), width).reshape(-1, width)
    one, two, owner = corner[real], after[real], piece[real]
    span = int(corner.max(initial=0)) + 1
    there, back = one * span + two, two * span + one
    edges, first, many = np.unique(there, return_index=True, return_counts=True)
    place, met = places_among(edges, back)
    paired = met & (many[place] == 1) & (many[np.searchsorted(edges, there)] == 1)
    other = owner[first[place]]
    # each piece takes the lowest number around, until all of a body have the same
    body = np.arange(len(pieces))
    while True:
        lower = body.copy()
        np.minimum.at(lower, owner[paired], body[other[paired]])
        lower = lower[lower]
        if (lower == body).all():
            break
        body = lower
    open_ = np.zeros(len(pieces), bool)
    open_[body[owner[~paired]]] = True
    open_[body[~tight]] = True
    return np.where(open_[body], -1, body)


def _of_outlines(planes: Planes, solid: np.ndarray) -> np.ndarray:
    """(o,) int: solid of each outline, or -1, from that of each piece ``(g,)``; of sheets that are of one alone."""
    sheets = len(planes.sheet_surface)
    low, high = np.full(sheets, len(solid)), np.full(sheets, -1)
    np.minimum.at(low, planes.given_sheet, solid)
    np.maximum.at(high, planes.given_sheet, solid)
    return np.where(low == high, high, -1)[planes.outline_sheet]
