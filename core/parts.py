"""Beams that edges cross: what shows of each obstacle in them, and what of the sky.

An edge alone, or one that two obstacles share, divides a beam in closed form; where more edges meet, overlaps are found
exactly.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from . import lattice, overlaps
from .arrays import dots, onto, pick, places_among
from .crossings import Candidates, Crossed, find_crossings, subtract_aligned
from .projection import Beams, Obstacles
from .views import OPEN, SHARED, Eye, View

_SEAM = 1e-5
"""Edges whose planes through the receiver are this close [rad], with an obstacle on either side, leave no opening."""

_MOST = 10
"""More obstacles than this in one beam are settled by rays."""

_FEW_RAYS, _MANY_RAYS = 8, 11
"""Order of the lattice of rays: 21 in a beam that shows no sky, 89 in others."""

_MUCH_SKY = 12
"""Receivers that see the sky in more whole beams than this don't depend on slits."""

_SLIT = 0.3
"""Openings between two edges that are this share of a beam or less count as slits."""

_SLIVER = 0.1
"""The same of openings beside a single edge."""

_TWO_LAYERS = 1.5
"""Shares that sum to more are of obstacles before each other, where no corner closes a single layer."""

_SAME_PLANE, _NOUGHT = 1e-9, 1e-12
"""Heights and normals that differ by this share of the largest are of one plane; so much where all are nought."""

_SAME_EDGE = 1e-4
"""Shares of two obstacles at one edge that sum to 1 this closely belong to obstacles that share the edge."""


def settle_parts(seen, nearest, possible, candidates: Candidates, eye: Eye, beams: Beams, obstacles: Obstacles) -> View:
    """Settle the beams that edges cross: SHARED in ``seen``, and their parts listed in the view."""
    heights = eye.heights
    crossed = find_crossings(seen, candidates, heights, beams, obstacles)
    if not len(crossed.row):
        empty = np.zeros(0, np.int64)
        return View(seen, empty, empty, empty, np.zeros(0), np.zeros((0, 3)), nearest, possible, heights)
    starts, group = crossed.starts, crossed.group
    aligned = subtract_aligned(crossed)
    head = crossed.row[starts], crossed.beam[starts]
    background = pick(seen, *head)
    total = np.add.reduceat(crossed.share, starts)
    size = np.diff(np.append(starts, len(group)))
    most_edges = np.maximum.reduceat(crossed.edges, starts)
    lone = (size == 1) & (most_edges <= 1)
    joined = (size == 2) & (most_edges == 1) & (np.abs(total - 1) < _SAME_EDGE)
    joined &= np.add.reduceat(crossed.edges, starts) == 2
    ahead = np.isfinite(np.maximum.reduceat(crossed.distance, starts))
    simple = (joined | lone | aligned) & ahead
    # a slit is a difference of two shares, and sky beside an edge one of a parcel and a rectangle: where little else is
    # seen of the sky, they are found exactly
    sky = np.count_nonzero(seen == OPEN, axis=1) - np.bincount(head[0][background == OPEN], minlength=len(seen))
    little = sky[head[0]] < _MUCH_SKY
    slit = little & (total > 1 - np.where(size == 2, _SLIT, _SLIVER))
    simple &= joined | (background != OPEN) | ~(beams.bent[head[1]] | slit)
    partial = eye.part_of(*head, len(beams.directions)) >= 0
    simple &= ~partial
    # every crossing edge met by an opposite one: a corner where obstacles close
    closed = np.zeros(len(starts), bool)
    closed[~simple] = np.linalg.norm(_group_sums(crossed.edge_sum, starts, ~simple), axis=1) < _SEAM

    # several edges, but no opening: shares by each edge alone, brought to a sum of 1
    single = total < _TWO_LAYERS
    single[~single] = _in_one_plane(crossed, starts, ~single, heights, obstacles)
    filled = ~simple & (total > 1e-9) & single & closed & (background == OPEN) & ~partial
    # the part's share of the cosine-weighted beam, to first order
    change = dots(crossed.offset, beams.slopes.take(crossed.beam, axis=0))
    share = crossed.share * np.clip(1 + change, 1e-6, 2.0)
    weighted = np.add.reduceat(share, starts)
    # two obstacles share the edge: nothing is left between them, to the last bit
    whole = joined | filled
    share = share / np.where(whole, weighted, 1.0)[group]
    left = np.where(whole, 0.0, np.clip(1.0 - weighted, 0.0, 1.0))
    towards = beams.directions.take(crossed.beam, axis=0) + crossed.offset
    left_towards = beams.directions.take(head[1], axis=0)
    rest = simple & (left > 0)
    moment = _group_sums(crossed.share[:, None] * crossed.offset, starts, rest)
    left_towards[rest] -= moment / np.maximum(1.0 - total[rest], 1e-3)[:, None]

    unsettled = ~simple & ~filled
    exactly = unsettled & (size <= _MOST)
    mine, groups = np.flatnonzero(exactly[group]), np.flatnonzero(exactly)
    more = np.zeros(0, np.int64), np.zeros(0), np.zeros((0, 3))
    if len(groups):
        grazing, cuts = _cuts(crossed.take(mine), candidates, eye, beams, obstacles)
        cuts = _with_windows(cuts, eye, head[0][groups], head[1][groups], beams)
        limits = _limits(eye, head[0][groups], background[groups], obstacles)
        exact = overlaps.settle(cuts, beams, limits, little[groups])
        share[mine], towards[mine] = exact.share[: len(mine)], exact.towards[: len(mine)]
        left[groups], left_towards[groups] = exact.left, exact.left_towards
        more = grazing, exact.share[len(mine) :], exact.towards[len(mine) :]
        unsettled[groups[exact.settled]] = False
    for order, sky in ((_FEW_RAYS, False), (_MANY_RAYS, True)):
        by_rays = unsettled & ((background == OPEN) == sky)
        mine, groups = np.flatnonzero(by_rays[group]), np.flatnonzero(by_rays)
        if len(groups):
            share[mine], towards[mine], left[groups], left_towards[groups] = lattice.sample(
                crossed.take(mine), candidates, background[groups], order, eye, beams, obstacles
            )
    seen[head] = SHARED
    remains, lit = np.flatnonzero(left > 1e-9), np.flatnonzero(share > 1e-9)
    return View(
        seen,
        np.concatenate([crossed.row[lit], head[0][remains], candidates.row[more[0]]]),
        np.concatenate([crossed.beam[lit], head[1][remains], candidates.beam[more[0]]]),
        np.concatenate([crossed.obstacle[lit], background[remains], candidates.obstacle[more[0]]]),
        np.concatenate([share[lit], left[remains], more[1]]),
        np.concatenate([towards.take(lit, axis=0), left_towards.take(remains, axis=0), more[2]]),
        nearest,
        possible,
        heights,
    )


def _in_one_plane(crossed: Crossed, starts: np.ndarray, which: np.ndarray, heights, obstacles: Obstacles) -> np.ndarray:
    """(w,) bool: whether all obstacles of some groups that begin at ``starts`` lie in one plane, in one layer."""
    rows, begin = _members(len(crossed.row), starts, which)
    alike = np.ones(len(begin), bool)
    if len(begin):
        row, obstacle = crossed.row[rows], crossed.obstacle[rows]
        for values in (pick(heights, row, obstacle), *obstacles.normals[obstacle].T):
            apart = np.maximum.reduceat(values, begin) - np.minimum.reduceat(values, begin)
            alike &= apart <= _SAME_PLANE * np.maximum.reduceat(np.abs(values), begin) + _NOUGHT
    return alike


def _group_sums(values: np.ndarray, starts: np.ndarray, which: np.ndarray) -> np.ndarray:
    """(w, c) float: sums of values ``(n, c)`` over some of the groups that begin at ``starts``."""
    rows, begin = _members(len(values), starts, which)
    if not len(rows):
        return np.zeros((0, values.shape[1]))
    return np.add.reduceat(values.take(rows, axis=0), begin, axis=0)


def _members(count: int, starts: np.ndarray, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which of ``count`` items are of some of the groups that begin at ``starts``, and where each begins there."""
    sizes = np.diff(np.append(starts, count))
    return np.flatnonzero(np.repeat(which, sizes)), np.cumsum(sizes[which]) - sizes[which]


def _cuts(crossed: Crossed, candidates: Candidates, eye: Eye, beams: Beams, obstacles: Obstacles):
    """Which candidates graze the beams that obstacles cross; and how these, and after them those, cut the beams."""
    starts = crossed.starts
    keys = crossed.row[starts] * len(beams.directions) + crossed.beam[starts]
    grazing = candidates.grazing
    key = candidates.row[grazing] * len(beams.directions) + candidates.beam[grazing]
    place, mine = places_among(keys, key)
    grazing, place = grazing[mine], place[mine]
    sizes = np.diff(np.append(starts, len(crossed.row)))
    number = np.concatenate([crossed.number, grazing])
    row, beam, obstacle = candidates.row[number], candidates.beam[number], candidates.obstacle[number]
    reach = beams.reach.astype(np.float32).take(beam)
    pair, edge = np.nonzero((np.abs(candidates.sine.take(number, axis=1)) < reach).T)
    return grazing, overlaps.Cuts(
        beam=beam,
        group=np.concatenate([np.repeat(np.arange(len(starts)), sizes), place]),
        count=np.bincount(pair, minlength=len(row)),
        edge=eye.planes[row[pair], obstacle[pair], edge],
        height=pick(eye.heights, row, obstacle),
        normal=obstacles.normals.take(obstacle, axis=0),
    )


def _with_windows(cuts: overlaps.Cuts, eye: Eye, row, beam, beams: Beams) -> overlaps.Cuts:
    """The cuts, within the windows that the beams of each group come through."""
    if eye.partial is None:
        return cuts
    group = np.flatnonzero(eye.part_of(row, beam, len(beams.directions)) >= 0)
    edges = eye.partial.window[row[group]]
    sine = np.einsum("gwc,gc->gw", edges, beams.directions[beam[group]])
    pair, edge = np.nonzero((sine < beams.reach[beam[group], None]) & edges.any(axis=2))
    count = np.bincount(group[pair], minlength=len(row))
    return replace(cuts, window_count=count, window_edge=edges[pair, edge].astype(float))


def _limits(eye: Eye, row, background, obstacles: Obstacles) -> overlaps.Limits:
    """Between which planes obstacles show: beyond the mirror or pane, before what is seen wholly."""
    height = np.where(background >= 0, eye.heights[row, background], np.inf)
    start, facing = np.zeros(len(row)), np.zeros(3)
    if eye.past is not None:
        start, facing = (eye.past.offset - onto(eye.points[row], eye.past.normal)) * (1 - 1e-5), eye.past.normal
    return overlaps.Limits(start, np.broadcast_to(facing, (len(row), 3)), height, obstacles.normals[background])
