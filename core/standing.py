"""What stands before bright polygons, and what light comes past it.

Found once for all receivers of a plane, and for many planes together; then for each receiver.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from . import clipping, polygons
from .arrays import runs
from .blockers import Blockers, Places, frame
from .outlines import Outlines
from .pieces import SeenShapes, Shapes, edge_cones, even_parts, joined, past_blocker, tightened
from .received import Received
from .silhouettes import Overlaps

_FEW = 4_000
"""Pairs of a blocker and a shape, times receivers: fewer are told one by one at once."""


@dataclass(frozen=True, eq=False)
class Receivers:
    """Receivers of some planes, or their images after some mirrors.

    Attributes
    ----------
    points : (r, 3) float
    rows : (r,) int
        Numbers of the receivers.
    place : (r,) int, ascending
        Of the planes.
    horizons : (p, 3) float, unit
        The planes' normals.
    """

    points: np.ndarray
    rows: np.ndarray
    place: np.ndarray
    horizons: np.ndarray

    @cached_property
    def start(self) -> np.ndarray:
        """(p + 1,) int: where the receivers of each plane begin."""
        return np.searchsorted(self.place, np.arange(len(self.horizons) + 1))

    @cached_property
    def places(self) -> np.ndarray:
        """(3, r) float: the points."""
        return np.ascontiguousarray(self.points.T)

    @cached_property
    def normals(self) -> np.ndarray:
        """(3, r) float."""
        return self.horizons.T.take(self.place, axis=1)

    def of(self, place: int) -> slice:
        """Those of a plane."""
        return slice(int(self.start[place]), int(self.start[place + 1]))

    def with_each(self, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs (n,) of one of some things at places ``(s,)`` and a receiver there: which it is, and the receiver."""
        count = np.diff(self.start)[place]
        return np.repeat(np.arange(len(place)), count), runs(self.start[place], count)


@dataclass(frozen=True, eq=False)
class Lookout:
    """Blockers that may stand before shapes, as seen from one place.

    Attributes
    ----------
    place : int
    blockers, shapes : slice
        Those of the place.
    overlaps : Overlaps
        Of these blockers and shapes.
    """

    place: int
    blockers: slice
    shapes: slice
    overlaps: Overlaps


@dataclass(frozen=True, eq=False)
class Standing:
    """Shapes that may be seen from some places, and what may stand before them there.

    Attributes
    ----------
    blockers : Blockers
    shapes : (s, v, 3) float
    counts : (s,) int
        Corners of the shapes.
    plane : (s,) int
    place : (s,) int, ascending
        That each is seen from.
    source : (s,) int
        Which of the bright polygons each is a part of.
    begin : (p + 1,) int
        Where the shapes of each place begin.
    lookouts : list of Lookout
        From places where anything may stand before anything.
    """

    blockers: Blockers
    shapes: np.ndarray
    counts: np.ndarray
    plane: np.ndarray
    place: np.ndarray
    source: np.ndarray
    begin: np.ndarray
    lookouts: list[Lookout]

    @cached_property
    def corners(self) -> np.ndarray:
        """(3, v, s) float: the shapes'."""
        return np.ascontiguousarray(self.shapes.transpose(2, 1, 0))

    @classmethod
    def of(cls, blockers: Blockers, at, shapes, plane, place, source, corners, tolerance: float) -> Standing:
        """Those of the blockers that matter to shapes; both in the order of their places.

        Parameters
        ----------
        blockers : Blockers
        at : (k,) int
            Their places.
        shapes : (s, v, 3) float
        plane, place, source : (s,) int
        corners : (p, c, 3) float
            Between which the receivers of each place are.
        tolerance : float
        """
        shapes, counts = tightened(shapes)
        many = np.arange(len(corners) + 1)
        first, begin = np.searchsorted(at, many), np.searchsorted(place, many)
        none = cls(blockers.take(slice(0)), shapes, counts, plane, place, source, begin, [])
        if not len(blockers):
            return none
        blockers = replace(blockers, vertices=tightened(blockers.vertices)[0])
        number = np.diff(first)[place]
        inner = np.repeat(np.arange(len(shapes)), number)
        outer = runs(first[place], number)
        may = (blockers.plane[outer] == plane[inner]) | (blockers.plane[outer] < 0)
        facing = np.einsum("kcx,kx->kc", corners[at], blockers.normals) - blockers.offsets[:, None]
        facing[np.abs(facing) <= tolerance] = 0.0
        pairs = Overlaps.of(blockers.vertices, shapes, outer[may], inner[may], at, corners, facing)
        if not len(pairs.outer):
            return none
        matter = np.zeros(len(blockers), bool)
        matter[pairs.outer] = True
        bound = np.concatenate([[0], np.cumsum(matter)])[first]
        outer = (np.cumsum(matter) - 1)[pairs.outer]
        pair = np.searchsorted(pairs.inner, begin)
        found = []
        for p in np.flatnonzero(np.diff(pair)).tolist():
            of_place = slice(int(bound[p]), int(bound[p + 1])), slice(int(begin[p]), int(begin[p + 1]))
            some = slice(int(pair[p]), int(pair[p + 1]))
            overlaps = replace(
                pairs.take(some),
                outer=outer[some] - bound[p],
                inner=pairs.inner[some] - begin[p],
                centre=pairs.centre[p],
            )
            found.append(Lookout(p, *of_place, overlaps))
        return replace(none, blockers=blockers.take(np.flatnonzero(matter)), lookouts=found)


@dataclass(frozen=True, eq=False)
class Shining:
    """Convex polygons that shine, and what of the outlines lies before their planes: found once for all receivers.

    Attributes
    ----------
    polygons : (s, v, 3) float, padded
    plane : (s,) int
        Of those below, ascending.
    normals, offsets : (p, 3) and (p,) float
        Planes before which the polygons are seen.
    blockers : Blockers
        For each plane its own.
    low, high : (k,) float
        How far what shines on the plane reaches behind and before the blocker's plane.
    tolerance : float
    """

    polygons: np.ndarray
    plane: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    blockers: Blockers
    low: np.ndarray
    high: np.ndarray
    tolerance: float

    @classmethod
    def of(cls, outlines: Outlines, shining, plane, normals, offsets) -> Shining:
        """Polygons ``(s, v, 3)`` on planes ``(s,)``."""
        tolerance = outlines.tolerance
        height = shining @ outlines.normals.T - outlines.offsets
        first = np.flatnonzero(np.diff(plane, prepend=-1))
        low = np.minimum.reduceat(height.min(axis=1), first)
        high = np.maximum.reduceat(height.max(axis=1), first)
        above = (outlines.vertices @ normals.T - offsets > tolerance).any(axis=1).T
        number, outline = np.nonzero(above & ((low < -tolerance) | (high > tolerance)))
        blockers = Blockers.of(outlines, outline, number)
        parts = clipping.clip(blockers.vertices, normals[number], offsets[number])
        wide = polygons.areas(parts) > tolerance**2
        return cls(
            shining,
            plane,
            normals,
            offsets,
            replace(blockers, vertices=parts).take(wide),
            low[number, outline][wide],
            high[number, outline][wide],
            tolerance,
        )

    def standing(self, places: Places, passed: Blockers, passed_at: np.ndarray) -> Standing:
        """What of the polygons may be seen from some places, and what may stand before it.

        Parameters
        ----------
        places : Places
        passed : Blockers
            What lies on the way so far.
        passed_at : (k,) int, ascending
            From which of the places.
        """
        tolerance, many = self.tolerance, len(places)
        shown = (places.corners @ self.normals.T - self.offsets > tolerance).any(axis=1)[:, self.plane]
        shown &= places.above(self.polygons, tolerance)  # not a mirror's own back
        place, which = np.nonzero(shown)
        visible = places.cut(self.polygons[which], place)
        wide = np.flatnonzero(polygons.areas(visible) > tolerance**2)
        place, which, visible = place[wide], which[wide], visible[wide]
        sees = np.zeros((many, 1), bool)
        sees[place] = True
        near = places.corners @ self.blockers.normals.T - self.blockers.offsets
        apart = (near.max(axis=1) > tolerance) & (self.low < -tolerance)
        apart |= (near.min(axis=1) < -tolerance) & (self.high > tolerance)
        apart &= places.above(self.blockers.vertices, tolerance)
        apart &= sees
        at, number = np.nonzero(apart)
        parts = places.cut(self.blockers.vertices[number], at)
        wide = np.flatnonzero(polygons.areas(parts) > tolerance**2)
        blockers, at = replace(self.blockers.take(number), vertices=parts).take(wide), at[wide]
        if len(passed):
            blockers, at = in_order(blockers, at, passed, passed_at)
        return Standing.of(blockers, at, visible, self.plane[which], place, which, places.corners, tolerance)


def in_order(some: Blockers, at, others: Blockers, others_at) -> tuple[Blockers, np.ndarray]:
    """Blockers at places ``(k,)`` and others, by their places."""
    place = np.concatenate([at, others_at])
    order = np.argsort(place, kind="stable")
    return some.joined(others).take(order), place[order]


class Reflecting(Protocol):
    """A mirror on the way."""

    @property
    def varies(self) -> bool:
        """Whether its reflectance changes with the angle."""

    def share(self, directions) -> np.ndarray:
        """(n,) float: of light along directions ``(n, 3)``."""


def light_past(
    outlines: Outlines,
    standing: Standing,
    unseen_backs,
    seen: SeenShapes,
    receivers: Receivers,
    mirrors: Sequence[Reflecting],
    throughput: float,
    received: Received,
) -> None:
    """Enter what is seen of polygons past blockers, as mirrors reflect it.

    Parameters
    ----------
    outlines : Outlines
    standing : Standing
    unseen_backs : (p, o) bool
        Outlines that nobody at a place need look for who is behind them.
    seen : SeenShapes
        What is seen of the shapes.
    receivers : Receivers
    mirrors : sequence of Reflecting
    throughput : float
        Product of their largest reflectances.
    received : Received
    """
    varies = any(mirror.varies for mirror in mirrors)
    rows, normals = receivers.rows, receivers.normals

    def whole(some: SeenShapes) -> None:
        if not len(some.row):
            return
        if varies:
            enter(some.made()[0])
        else:
            of_rows = normals.take(some.row, axis=1)
            received.add_seen(rows[some.row], throughput * some.weight, some, standing.counts, of_rows)

    def enter(some: Shapes, screens=None, facing=None) -> None:
        if varies:
            some, of = even_parts(some, lambda directions: _thrown_back(mirrors, directions))
            if screens is not None:
                screens, facing = screens.take(of, axis=3), facing.take(of, axis=1)
        else:
            some = replace(some, weight=throughput * some.weight)
        received.add(rows[some.row], some.weight, some.shape, normals.take(some.row, axis=1), screens, facing)

    crossing = _Crossing.of(outlines, standing, unseen_backs, receivers)
    if crossing is None:
        whole(seen)
        return
    place = receivers.place[seen.row]
    pair = crossing.base[place] + (seen.row - receivers.start[place]) * np.diff(standing.begin)[place]
    pair += seen.polygon - standing.begin[place]
    every = np.bincount(crossing.pair, minlength=len(crossing.hidden))
    count = every[pair]
    count[crossing.hidden[pair]] = -1
    whole(seen.take(np.flatnonzero(count == 0)))
    clear = outlines.transparent[standing.blockers.outline[crossing.blocker]]
    by_pieces = (count > 0) & (np.bincount(crossing.pair[clear], minlength=len(every))[pair] > 0)
    if by_pieces.any():
        enter(_in_pieces(outlines, standing, seen.take(np.flatnonzero(by_pieces)).made()[0], receivers))
        count[by_pieces] = -1
    start = (np.cumsum(every) - every)[pair]
    corners = standing.blockers.vertices.transpose(2, 1, 0)
    for number in np.unique(count[count > 0]).tolist():
        mine = np.flatnonzero(count == number)
        some, kept = seen.take(mine).made()
        entry = start[mine[kept]] + np.arange(number)[:, None]
        screens = corners.take(crossing.blocker[entry], axis=2).transpose(2, 0, 1, 3)
        screens = screens - receivers.places.take(some.row, axis=1)[:, None]
        enter(some, screens, crossing.facing[entry])


@dataclass(frozen=True, eq=False)
class _Crossing:
    """Which blockers hide a part of which shape from which receiver.

    Attributes
    ----------
    base : (p + 1,) int
        Where the pairs of a receiver and a shape at each place begin, receiver after receiver.
    hidden : (n,) bool
        Pairs of which all is hidden.
    pair, blocker : (m,) int
        What crosses, pair after pair.
    facing : (m,) float
        Positive where the receiver is before the blocker, negative behind.
    """

    base: np.ndarray
    hidden: np.ndarray
    pair: np.ndarray
    blocker: np.ndarray
    facing: np.ndarray

    @classmethod
    def of(cls, outlines: Outlines, standing: Standing, unseen_backs, receivers: Receivers) -> _Crossing | None:
        """None where nothing hides anything."""
        base = np.concatenate([[0], np.cumsum(np.diff(standing.begin) * np.diff(receivers.start))])
        hidden, found = np.zeros(base[-1], bool), []
        for lookout in standing.lookouts:
            place, mine = lookout.place, receivers.of(lookout.place)
            if mine.start == mine.stop:
                continue
            points, overlaps = receivers.points[mine], lookout.overlaps
            blockers = standing.blockers.take(lookout.blockers)
            facing = blockers.facing(points, unseen_backs[place], outlines.tolerance)
            if len(overlaps.outer) * len(points) > _FEW:
                near = overlaps.near(frame(points, receivers.horizons[place]), facing)
                overlaps = overlaps.take(np.flatnonzero(near))
            if not len(overlaps.outer):
                continue
            hides, crosses = overlaps.seen(points, facing)
            clear = outlines.transparent[blockers.outline[overlaps.outer]]
            if clear.any():
                crosses[clear] |= hides[clear]
                hides[clear] = False
            first, count = base[place], lookout.shapes.stop - lookout.shapes.start
            which, row = np.nonzero(hides)
            hidden[first + row * count + overlaps.inner[which]] = True
            row, which = np.nonzero(crosses.T)
            outer = overlaps.outer[which]
            pair = first + row * count + overlaps.inner[which]
            found.append((pair, lookout.blockers.start + outer, facing[outer, row]))
        if not found:
            return None
        pair, blocker, facing = (np.concatenate(part) for part in zip(*found, strict=True))
        return cls(base, hidden, pair, blocker, facing) if len(pair) or hidden.any() else None


def _thrown_back(mirrors: Sequence[Reflecting], directions: np.ndarray) -> np.ndarray:
    """(n,) float: share of light along directions ``(n, 3)`` that all mirrors on the way throw back."""
    share = np.ones(len(directions))
    for mirror in mirrors:
        share *= mirror.share(directions)
    return share


def _in_pieces(outlines: Outlines, standing: Standing, seen: Shapes, receivers: Receivers) -> Shapes:
    """What is seen past blockers, where pieces need weights of their own: past panes."""
    if not len(seen.row):
        return seen
    found, place = [], receivers.place[seen.row]
    for lookout in standing.lookouts:
        mine = np.flatnonzero(place == lookout.place)
        if len(mine):
            points = receivers.of(lookout.place)
            some = seen.take(mine)
            left = _past_all(
                outlines,
                standing.blockers.take(lookout.blockers),
                standing.plane,
                replace(some, row=some.row - points.start),
                receivers.points[points],
            )
            found.append(replace(left, row=left.row + points.start))
    return joined(found)


def _past_all(outlines: Outlines, blockers: Blockers, shape_plane, seen: Shapes, points) -> Shapes:
    """What is seen past blockers, one after the other, from points ``(r, 3)`` of one plane."""
    every = zip(blockers.vertices, blockers.outline.tolist(), blockers.plane.tolist(), strict=True)
    for polygon, outline, plane in every:
        planes, edges, facing = edge_cones(polygon[None] - points[:, None])
        height = np.matmul(seen.shape.transpose(2, 1, 0), planes.transpose(0, 2, 1)[seen.row])
        reach = np.abs(seen.shape).max(axis=(0, 1))
        overlaps = ((height.max(axis=1) > 1e-12 * reach[:, None]) | ~edges[seen.row]).all(axis=1)
        overlaps &= facing[seen.row] != 0
        if plane >= 0:
            overlaps &= shape_plane[seen.polygon] == plane
        if overlaps.any():
            behind = past_blocker(outlines, polygon, outline, seen.take(np.flatnonzero(overlaps)), planes, edges)
            seen = joined([seen.take(np.flatnonzero(~overlaps)), *behind])
        if not len(seen.row):
            break
    return seen
