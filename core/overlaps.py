"""Shares of beams that several edges cross, exactly: what convex obstacles that overlap each other leave open.

Within one beam an obstacle is the beam's outline cut by a few half-planes: convex. So is what obstacles have in common,
and by inclusion and exclusion the areas of all that is common to some of them tell what shows of each and what of none
shows: each common part counts, by turns positive and negative, for its farthest obstacle.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from . import clipping, layers, polygons
from .arrays import dots, places_among, runs
from .hemisphere import Shapes
from .projection import Beams

_NOTHING = 1e-9
"""Areas smaller than this share of the beam are none."""

_CLOSED = 1e-7
"""An opening smaller than this share of the beam is the rounding of edges that meet."""

_SMALL = 0.05
"""Openings smaller than this share of a beam are found again within the beam's arcs."""

_FEW_CORNERS = 4
"""Corners of most parcels."""

_FEW = 4
"""More obstacles in one beam are first compared with the largest, which may hide them."""

_FEW_PAIRS = 6
"""Overlaps of two obstacles in one beam beyond which obstacles are taken from it one after the other: parts that are
common to more become too many."""

_HIDDEN = 1e-9
"""What shows of an obstacle less than this share of it is hidden."""

_BATCH = 1_000
"""Fewer regions with the same number of lines are cut together with those of more."""


@dataclass(frozen=True, eq=False)
class Cuts:
    """Obstacles in beams, ``n`` in all.

    Attributes
    ----------
    beam : (n,) int
    group : (n,) int
        Number of the beam among those settled.
    count : (n,) int
        How many edges cut the beam.
    edge : (sum of count, 3) float
        Normals of the edges' planes, positive inside; obstacle by obstacle.
    height : (n,) float
        Signed distance from the receiver to the obstacle's plane, along its normal.
    normal : (n, 3) float
        Normal of the obstacle's plane.
    window_count, window_edge : (g,) int and (sum of them, 3) float, or None
        Edges of the window that each beam comes through, as for obstacles.
    """

    beam: np.ndarray
    group: np.ndarray
    count: np.ndarray
    edge: np.ndarray
    height: np.ndarray
    normal: np.ndarray
    window_count: np.ndarray | None = None
    window_edge: np.ndarray | None = None

    def distance(self, obstacle, towards) -> np.ndarray:
        """(m,) float: how far obstacles' planes are, in lengths of ``towards``; inf where they are not ahead."""
        return _along(self.height[obstacle], self.normal.take(obstacle, axis=0), towards)

    def of(self, groups) -> tuple[Cuts, np.ndarray]:
        """The cuts of some groups, which are numbered anew, and their places among all."""
        number = np.full(int(self.group.max()) + 1, -1)
        number[groups] = np.arange(len(groups))
        mine = np.flatnonzero(number[self.group] >= 0)
        first = np.cumsum(self.count) - self.count
        count, edge = self.window_count, self.window_edge
        if count is not None and edge is not None:
            begin = np.cumsum(count) - count
            count, edge = count[groups], edge[runs(begin[groups], count[groups])]
        return (
            Cuts(
                self.beam[mine],
                number[self.group[mine]],
                self.count[mine],
                self.edge[runs(first[mine], self.count[mine])],
                self.height[mine],
                self.normal[mine],
                count,
                edge,
            ),
            mine,
        )

    def twice(self, groups: int) -> Cuts:
        """All ``groups``, and after them the same once more."""
        parts = {f.name: getattr(self, f.name) for f in fields(self)}
        both = {name: np.concatenate([part, part]) for name, part in parts.items() if part is not None}
        return replace(self, **{**both, "group": np.concatenate([self.group, groups + self.group])})


@dataclass(frozen=True, eq=False)
class Limits:
    """Planes between which obstacles show in each beam.

    Attributes
    ----------
    near_height, near_normal : (g,) and (g, 3) float
        The receiver's signed distance to the near plane and its normal; 0 where there is none.
    far_height, far_normal : (g,) and (g, 3) float
        The same of the far plane; inf where there is none.
    """

    near_height: np.ndarray
    near_normal: np.ndarray
    far_height: np.ndarray
    far_normal: np.ndarray

    def take(self, groups) -> Limits:
        """Those of some groups."""
        return Limits(*(getattr(self, f.name)[groups] for f in fields(self)))

    def hold(self, group, distance, towards) -> np.ndarray:
        """(n,) bool: whether what lies this many lengths of ``towards`` away is between them."""
        far = _along(self.far_height[group], self.far_normal.take(group, axis=0), towards)
        near = np.where(distance < np.inf, distance, 0.0) * dots(self.near_normal.take(group, axis=0), towards)
        return (distance < far) & (near >= self.near_height[group])


@dataclass(frozen=True, eq=False)
class Shares:
    """What shows in beams.

    Attributes
    ----------
    share : (n,) float
        Of each obstacle, of the beam's cosine-weighted solid angle.
    towards : (n, 3) float
        The middle of what shows of it.
    left : (g,) float
        Of none.
    left_towards : (g, 3) float
    settled : (g,) bool
        False for beams with too many overlaps, which show nothing yet.
    """

    share: np.ndarray
    towards: np.ndarray
    left: np.ndarray
    left_towards: np.ndarray
    settled: np.ndarray


def settle(cuts: Cuts, beams: Beams, limits: Limits, fine: np.ndarray) -> Shares:
    """Find what shows of obstacles in beams.

    Parameters
    ----------
    cuts : Cuts
    beams : Beams
    limits : Limits
    fine : (g,) bool
        Where openings much smaller than the beam count.

    Returns
    -------
    Shares
    """
    half = beams.hemisphere
    beam = _beams_of(cuts, len(fine))
    shares = _Tally(beams, cuts, *_visible(cuts, beams, limits, half.shapes, beams.columns[beam])).shares()
    small = np.flatnonzero(shares.settled & fine & (shares.left > 0) & (shares.left < _SMALL))
    if len(small):  # an opening that may be smaller than what chords make of arcs
        mine, some = cuts.of(small)
        around, off = (shapes.take(beams.columns[beam[small]]) for shapes in half.fine_shapes)
        both = mine.twice(len(small)), beams, limits.take(np.tile(small, 2)), around.followed(off)
        visible, whole, settled = (np.split(found, 2) for found in _visible(*both, np.arange(2 * len(small))))
        again = _Tally(beams, mine, visible[0] - visible[1], whole[0] - whole[1], settled[0]).shares()
        shares.share[some], shares.towards[some] = again.share, again.towards
        shares.left[small], shares.left_towards[small] = again.left, again.left_towards
        shares.settled[small] = again.settled
    return shares


def _beams_of(cuts: Cuts, groups: int) -> np.ndarray:
    """(g,) int: the beam of each group."""
    beam = np.zeros(groups, np.int64)
    beam[cuts.group] = cuts.beam
    return beam


def _visible(cuts: Cuts, beams: Beams, limits: Limits, shapes: Shapes, shape_of_group: np.ndarray):
    """Moments of what shows of each obstacle (n, 3) and of the beams (g, 3); which are settled (g,)."""
    groups = len(limits.far_height)
    region = _Regions(cuts, beams, shapes, shape_of_group)
    every = np.arange(len(cuts.beam))
    whole = region.whole()
    alone = region.moments(every[:, None])
    ahead = _towards(region.frames.take(cuts.beam, axis=0), alone)
    distance = cuts.distance(every, ahead)
    shows = (alone[:, 0] > _NOTHING * whole[cuts.group, 0]) & (distance < np.inf)
    shows &= limits.hold(cuts.group, distance, ahead)
    visible = np.where(shows[:, None], alone, 0.0)

    some = np.flatnonzero(shows)
    some = some[np.argsort(cuts.group[some], kind="stable")]
    some = some[~region.behind_largest(some, alone)]
    visible[np.setdiff1d(np.flatnonzero(shows), some, assume_unique=True)] = 0.0
    last = np.searchsorted(cuts.group[some], cuts.group[some], side="right")  # where each one's group ends
    members, moments = region.extended(some, np.arange(len(some))[:, None], last)
    owner = cuts.group[some[members[:, 0]]]
    settled = whole[:, 0] > 0
    many = settled & (np.bincount(owner, minlength=groups) > _FEW_PAIRS)
    if many.any():
        mine = many[owner]
        near, far, shared = region.ordered(some[members[mine]], moments[mine])
        places = some[many[cuts.group[some]]]
        visible[places], settled[many] = region.peeled(places, near, far, shared, alone)
    few = (settled & ~many)[owner]
    members, moments = members[few], moments[few]
    pairs = members[:, 0] * len(some) + members[:, 1]
    sign = -1.0
    while len(members):
        farthest = region.farthest(some[members], moments)
        for k in range(3):
            visible[:, k] += sign * np.bincount(farthest, weights=moments[:, k], minlength=len(visible))
        members, moments = region.extended(some, members, last, pairs)
        sign = -sign
    return visible, whole, settled


@dataclass(frozen=True, eq=False)
class _Tally:
    """What shows of obstacles and of beams, by area and first moments."""

    beams: Beams
    cuts: Cuts
    visible: np.ndarray
    whole: np.ndarray
    settled: np.ndarray

    def shares(self) -> Shares:
        """Shares of the beams' cosine-weighted solid angle."""
        group, groups = self.cuts.group, len(self.whole)
        beam = _beams_of(self.cuts, groups)
        cosines, frames = self.beams.hemisphere.cosines[self.beams.columns[beam]], self.beams.frames
        total = dots(self.whole, cosines)
        total = np.where(self.settled & (total > 0), total, 1.0)
        share = dots(self.visible, cosines.take(group, axis=0)) / total[group]
        share = np.where(self.settled[group], np.maximum(share, 0.0), 0.0)
        covered = np.bincount(group, weights=share, minlength=groups)
        left = 1.0 - covered
        left[left < _CLOSED] = 0.0
        share /= (covered + left)[group]
        hidden = np.stack([np.bincount(group, weights=v, minlength=groups) for v in self.visible.T], axis=1)
        towards = _towards(frames.take(self.cuts.beam, axis=0), self.visible)
        return Shares(share, towards, left, _towards(frames.take(beam, axis=0), self.whole - hidden), self.settled)


def _towards(frames, moments) -> np.ndarray:
    """(m, 3) float: the middles of regions; of beams where they have no area."""
    area = moments[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y = (np.where(area > 1e-300, moments[:, k] / area, 0.0)[:, None] for k in (1, 2))
    return frames[:, 0] + x * frames[:, 1] + y * frames[:, 2]


class _Regions:
    """Parts of beams that are common to some obstacles."""

    def __init__(self, cuts: Cuts, beams: Beams, shapes: Shapes, shape_of_group: np.ndarray):
        self.cuts, self.frames = cuts, beams.frames
        frames = self.frames.take(np.repeat(cuts.beam, cuts.count), axis=0)
        lines = np.stack([dots(frames[:, k], cuts.edge) for k in range(3)])
        self.lines = np.concatenate([lines, [[1.0], [0.0], [0.0]]], axis=1)  # the last cuts nothing
        self.count, self.first = cuts.count, np.cumsum(cuts.count) - cuts.count
        self.shapes, self.shape_of_group = shapes, shape_of_group
        if cuts.window_count is not None and cuts.window_edge is not None:
            groups = len(shape_of_group)
            frames = self.frames.take(_beams_of(cuts, groups), axis=0)
            self.shapes = _within_windows(shapes.take(shape_of_group), cuts, frames)
            self.shape_of_group = np.arange(groups)
        self.shape = self.shape_of_group[cuts.group]

    def whole(self) -> np.ndarray:
        """(g, 3) float: area and first moments of each beam, within its window."""
        return self.shapes.moments[self.shape_of_group]

    def moments(self, members) -> np.ndarray:
        """(m, 3) float: area and first moments of what is common to obstacles ``(m, s)``, on the beams' planes."""
        corners = self.shapes.corners
        out = np.empty((len(members), 3))
        lines = self.count[members].sum(axis=1)
        shape = self.shape[members[:, 0]]
        many = self.shapes.counts[shape] > _FEW_CORNERS
        for sides, kind in ((_FEW_CORNERS, ~many), (corners.shape[1], many)):
            mine = np.flatnonzero(kind)
            mine = mine[np.argsort(lines[mine], kind="stable")]
            ends = np.append(np.flatnonzero(np.diff(lines[mine])) + 1, len(mine))
            begin = 0
            for end in ends:
                if end - begin >= _BATCH or (end == len(mine) and end > begin):
                    now = mine[begin:end]
                    bounds = self.lines.take(self._lines_of(members[now], lines[now]).T, axis=1)
                    out[now] = clipping.convex_moments(corners[:, :sides].take(shape[now], axis=2), bounds).T
                    begin = end
        return out

    def _lines_of(self, members, counts) -> np.ndarray:
        """(m, l) int: lines that bound what obstacles have in common, padded."""
        width = int(counts.max(initial=0))
        index = np.full((len(members), width), self.lines.shape[1] - 1)
        index[np.arange(width) < counts[:, None]] = runs(self.first[members].ravel(), self.count[members].ravel())
        return index

    def extended(self, some, members, last, pairs=None):
        """What obstacles have in common with one more of their beam, where there is anything.

        Parameters
        ----------
        some : (k,) int
            Obstacles that show, by group.
        members : (m, s) int
            Places in ``some``, ascending along each row.
        last : (k,) int
            Where in ``some`` each one's group ends.
        pairs : (p,) int, optional
            Places of two that have something in common, as one ascending number.

        Returns
        -------
        members : (n, s + 1) int
        moments : (n, 3) float
        """
        begin = members[:, -1] + 1
        more = last[members[:, -1]] - begin
        row = np.repeat(np.arange(len(members)), more)
        other = runs(begin, more)
        if pairs is not None and len(row):
            _, known = places_among(pairs, members[row, -1] * len(some) + other)
            row, other = row[known], other[known]
        together = np.concatenate([members[row], other[:, None]], axis=1)
        moments = self.moments(some[together])
        real = moments[:, 0] > _NOTHING * self.shapes.moments[self.shape[some[other]], 0]
        real = np.flatnonzero(real)
        return together.take(real, axis=0), moments.take(real, axis=0)

    def behind_largest(self, some, alone) -> np.ndarray:
        """(k,) bool: which obstacles the largest of their group hides, where there are many in it.

        Parameters
        ----------
        some : (k,) int
            Obstacles, by group.
        alone : (n, 3) float
            Moments of every obstacle.
        """
        hidden = np.zeros(len(some), bool)
        group = self.cuts.group[some]
        crowded = np.flatnonzero(np.bincount(group)[group] > _FEW)
        if not len(crowded):
            return hidden
        mine, group = some[crowded], group[crowded]
        largest = mine[np.lexsort((-alone[mine, 0], group))[np.searchsorted(group, group)]]
        others = largest != mine
        pairs = np.stack([mine[others], largest[others]], axis=1)
        far, shared = self.farthest(pairs, moments := self.moments(pairs)), moments[:, 0]
        hidden[crowded[others]] = (far == pairs[:, 0]) & (shared >= (1 - _HIDDEN) * alone[pairs[:, 0], 0])
        return hidden

    def ordered(self, pairs, moments) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of two obstacles ``(m, 2)`` that overlap the nearer and the farther, and the area they have in common."""
        far = self.farthest(pairs, moments)
        return pairs.sum(axis=1) - far, far, moments[:, 0]

    def peeled(self, obstacles, near, far, shared, alone) -> tuple[np.ndarray, np.ndarray]:
        """What shows of obstacles that many others of their beams overlap.

        Parameters
        ----------
        obstacles : (k,) int
            All of some groups.
        near, far, shared : (m,)
            As from `ordered`, of these groups.
        alone : (n, 3) float
            Moments of every obstacle.

        Returns
        -------
        visible : (k, 3) float
        settled : (g,) bool
            By group.
        """
        groups, group = np.unique(self.cuts.group[obstacles], return_inverse=True)
        hidden = np.zeros(len(self.cuts.beam), bool)
        hidden[far[shared >= (1 - _HIDDEN) * alone[far, 0]]] = True
        mine = np.flatnonzero(~hidden[obstacles])
        place = np.zeros(len(hidden), np.int64)
        place[obstacles[mine]] = np.arange(len(mine))
        real = ~(hidden[near] | hidden[far])
        depth = layers.depths(place[near[real]], place[far[real]], len(mine))
        outlines = _flat(self.shapes.corners.take(self.shape_of_group[groups], axis=2))
        lines_of = self._lines_of(obstacles[mine][:, None], self.count[obstacles[mine]])
        visible = np.zeros((len(obstacles), 3))
        visible[mine], settled = layers.peeled(outlines, group[mine], self.lines, lines_of, depth)
        return visible, settled

    def farthest(self, members, moments) -> np.ndarray:
        """(m,) int: of the obstacles ``(m, s)`` that have a region in common, the one seen last."""
        towards = _towards(self.frames.take(self.cuts.beam[members[:, 0]], axis=0), moments)
        distance = np.stack([self.cuts.distance(members[:, k], towards) for k in range(members.shape[1])], axis=1)
        return members[np.arange(len(members)), np.argmax(distance, axis=1)]


def _within_windows(shapes: Shapes, cuts: Cuts, frames) -> Shapes:
    """Outlines of the beams of each group ``(g)``, within their windows."""
    count, edge = cuts.window_count, cuts.window_edge
    assert count is not None and edge is not None
    some = np.flatnonzero(count)
    first = np.cumsum(count) - count
    corners = _flat(shapes.corners.take(some, axis=2))
    for k in range(int(count.max(initial=0))):
        mine = np.flatnonzero(count[some] > k)
        line = edge[first[some[mine]] + k]
        a, b, c = (dots(frames[some[mine], axis], line) for axis in range(3))
        less = clipping.clip(corners[mine], np.stack([b, c, np.zeros(len(b))], axis=1), -a)
        corners = polygons.widen(corners, max(corners.shape[1], less.shape[1]))
        corners[mine] = polygons.widen(less, corners.shape[1])
    padded = (corners[:, ::-1] == corners[:, -1:]).all(axis=2).cumprod(axis=1).sum(axis=1)
    counts = corners.shape[1] + 1 - padded
    return shapes.replaced(some, Shapes.of(corners[:, : int(counts.max(initial=1)), :2], counts))


def _flat(corners) -> np.ndarray:
    """(m, v, 3) float: outlines ``(2, v, m)`` as polygons in space, on the plane z = 0."""
    return np.concatenate([corners.T, np.zeros((corners.shape[2], corners.shape[1], 1))], axis=2)


def _along(height, normal, towards) -> np.ndarray:
    """(n,) float: distance to planes, in lengths of ``towards``; inf where they are not ahead."""
    with np.errstate(divide="ignore", invalid="ignore"):
        along = height / dots(normal, towards)
    return np.where(along > 0, along, np.inf)
