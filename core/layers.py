"""Obstacles taken from beams one after the other, nearest first: for beams that many of them overlap in.

What is left of a beam after each obstacle is kept as convex pieces that do not overlap. So shares always sum to one,
and the work grows with the pieces, not with all sets of obstacles.
"""

from __future__ import annotations

import numpy as np

from . import clipping, polygons

_NOTHING = 1e-10
"""Pieces smaller than this share of the beam are none."""

_MOST_PIECES = 100
"""A beam in more pieces is given up."""


def depths(near, far, count: int) -> np.ndarray:
    """How many obstacles, one behind the other, stand before each.

    Parameters
    ----------
    near, far : (p,) int
        Obstacles that overlap, and which of the two is before the other.
    count : int
        Obstacles in all.

    Returns
    -------
    (count,) int
        Ascending from near to far, but for obstacles that stand before each other in a circle.
    """
    depth = np.zeros(count, np.int64)
    for _ in range(int(np.bincount(far, minlength=1).max(initial=0)) + 1):
        before = depth.copy()
        np.maximum.at(depth, far, depth[near] + 1)
        if (depth == before).all():
            break
    return depth


def peeled(beams, group, lines, line_of, depth) -> tuple[np.ndarray, np.ndarray]:
    """Take obstacles from beams, nearest first.

    Parameters
    ----------
    beams : (g, v, 3) float
        Outlines of the beams, padded; the third coordinate is 0.
    group : (k,) int
        Beam of each obstacle.
    lines : (3, l) float
        ``a + b x + c y`` is positive inside; (b, c) a unit vector.
    line_of : (k, w) int
        Lines that bound each obstacle, padded by one that cuts nothing.
    depth : (k,) int
        See `depths`.

    Returns
    -------
    visible : (k, 3) float
        Area and first moments of what shows of each obstacle.
    settled : (g,) bool
        False where there were too many pieces: nothing shows of obstacles there.
    """
    visible, settled = np.zeros((len(group), 3)), np.ones(len(beams), bool)
    pieces, owner = beams, np.arange(len(beams))
    least = _NOTHING * polygons.areas(beams)
    order = np.lexsort((depth, group))
    turn = np.empty(len(group), np.int64)
    turn[order] = np.arange(len(group)) - np.searchsorted(group[order], group[order])
    for now in range(int(turn.max(initial=-1)) + 1):
        mine = np.flatnonzero(turn == now)
        obstacle = np.full(len(beams), -1)
        obstacle[group[mine]] = mine
        asked = np.flatnonzero(obstacle[owner] >= 0)
        which = obstacle[owner[asked]]
        bounds = lines[:, line_of[which]].transpose(0, 2, 1)  # (3, w, n)
        moments = clipping.convex_moments(pieces[asked, :, :2].transpose(2, 1, 0), bounds)
        for k in range(3):
            visible[:, k] += np.bincount(which, weights=moments[k], minlength=len(visible))
        hidden = moments[0] > least[owner[asked]]
        pieces, owner = _less(pieces, owner, asked[hidden], bounds[:, :, hidden], least)
        settled &= np.bincount(owner, minlength=len(beams)) <= _MOST_PIECES
        pieces, owner = pieces[settled[owner]], owner[settled[owner]]
    visible[~settled[group]] = 0.0
    return visible, settled


def _less(pieces, owner, some, bounds, least) -> tuple[np.ndarray, np.ndarray]:
    """Pieces after what lies inside ``bounds (3, w, n)`` of some of them is taken off, and whose they are."""
    rest, whose = [np.delete(pieces, some, axis=0)], [np.delete(owner, some)]
    inside, mine = pieces[some], owner[some]
    for a, b, c in bounds.transpose(1, 0, 2):
        normal = np.stack([b, c, np.zeros(len(b))], axis=1)
        beyond = clipping.clip(inside, -normal, a)
        kept = (polygons.areas(beyond) > least[mine]) & normal.any(axis=1)
        rest.append(beyond[kept])
        whose.append(mine[kept])
        inside = clipping.clip(inside, normal, -a)
    return polygons.joined(rest), np.concatenate(whose)
