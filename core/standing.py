"""What stands before bright polygons, and what light comes past it.

Found once for all receivers of a plane, and for many planes together; then for each receiver.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from . import polygons
from .blockers import Blockers, frame
from .outlines import Outlines
from .pieces import SeenShapes, Shapes, edge_cones, joined, past_blocker, tightened
from .received import Received
from .silhouettes import Overlaps

_FEW = 4_000
"""Pairs of a blocker and a shape, times receivers: fewer are told one by one at once."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where receivers of some planes are, or their images, and what all that they see lies within.

    Attributes
    ----------
    corners : (p, c, 3) float
        Between which the receivers of each plane are.
    limits : list of ((p, 3) float, (p,) float)
        Normals and offsets of half-spaces: the receivers' horizons, and what is behind the last mirror.
    blockers : sequence of Blockers
        What lies on the way so far, for each plane.
    """

    corners: np.ndarray
    limits: list[tuple[np.ndarray, np.ndarray]]
    blockers: Sequence[Blockers]

    def cut(self, shapes: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Parts of polygons ``(m, v, 3)`` within the limits of places ``(m,)``."""
        for normals, offsets in self.limits:
            shapes = polygons.clip(shapes, normals[place], offsets[place])
        return shapes

    def above(self, shapes: np.ndarray, tolerance: float) -> np.ndarray:
        """(p, m) bool: polygons ``(m, v, 3)`` that are not wholly outside of any limit."""
        found = np.ones((len(self.corners), len(shapes)), bool)
        for normals, offsets in self.limits:
            found &= (shapes @ normals.T - offsets > tolerance).any(axis=1).T
        return found


@dataclass(frozen=True, eq=False)
class Standing:
    """Blockers that may stand before shapes, as seen from between some corners.

    Attributes
    ----------
    blockers : Blockers
    shapes : (s, v, 3) float
    counts : (s,) int
        Corners of the shapes.
    plane : (s,) int
    overlaps : Overlaps
        Of blockers and shapes.
    """

    blockers: Blockers
    shapes: np.ndarray
    counts: np.ndarray
    plane: np.ndarray
    overlaps: Overlaps

    @cached_property
    def corners(self) -> np.ndarray:
        """(3, v, s) float: the shapes'."""
        return np.ascontiguousarray(self.shapes.transpose(2, 1, 0))

    @classmethod
    def of(cls, blockers: Blockers, shapes, plane, corners, tolerance: float) -> Standing:
        """Those of the blockers that matter to shapes ``(s, v, 3)`` on planes ``(s,)``."""
        one = np.zeros(len(blockers), np.int64), np.zeros(len(shapes), np.int64)
        return _standing(blockers, one[0], shapes, one[1], plane, corners[None], tolerance)[0]


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
        parts = polygons.clip(blockers.vertices, normals[number], offsets[number])
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

    def standing(self, places: Places) -> list[tuple[np.ndarray, Standing]]:
        """For each place: which of the polygons may be seen (k,), what of them, and what may stand before them."""
        tolerance, many, count = self.tolerance, len(places.corners), len(self.polygons)
        every = np.repeat(np.arange(many), count)
        visible = places.cut(np.tile(self.polygons, (many, 1, 1)), every)
        shown = (polygons.areas(visible) > tolerance**2).reshape(many, count)
        before = (places.corners @ self.normals.T - self.offsets > tolerance).any(axis=1)
        shown &= before[:, self.plane] & places.above(self.polygons, tolerance)  # not a mirror's own back
        place, which = np.nonzero(shown)
        visible = visible[shown.ravel()]
        near = places.corners @ self.blockers.normals.T - self.blockers.offsets
        apart = (near.max(axis=1) > tolerance) & (self.low < -tolerance)
        apart |= (near.min(axis=1) < -tolerance) & (self.high > tolerance)
        apart &= places.above(self.blockers.vertices, tolerance)
        apart &= shown.any(axis=1)[:, None]
        at, number = np.nonzero(apart)
        parts = places.cut(self.blockers.vertices[number], at)
        wide = np.flatnonzero(polygons.areas(parts) > tolerance**2)
        blockers, at = replace(self.blockers.take(number), vertices=parts).take(wide), at[wide]
        passed = [len(some) for some in places.blockers]
        if any(passed):
            blockers = blockers.joined(*places.blockers)
            at = np.concatenate([at, np.repeat(np.arange(many), passed)])
            order = np.argsort(at, kind="stable")
            blockers, at = blockers.take(order), at[order]
        found = _standing(blockers, at, visible, place, self.plane[which], places.corners, tolerance)
        return list(zip(np.split(which, np.searchsorted(place, np.arange(1, many))), found, strict=True))


def _standing(blockers: Blockers, at, shapes, place, plane, corners: np.ndarray, tolerance: float) -> list[Standing]:
    """For each place what of the blockers at it ``(k,)`` matters to its shapes ``(s,)``; both in their order.

    Parameters
    ----------
    blockers : Blockers
    at : (k,) int
    shapes : (s, v, 3) float
    place, plane : (s,) int
    corners : (p, c, 3) float
        Between which the receivers of each place are.
    tolerance : float
    """
    shapes, counts = tightened(shapes)
    blockers = replace(blockers, vertices=tightened(blockers.vertices)[0])
    many = np.arange(len(corners) + 1)
    first, begin = np.searchsorted(at, many), np.searchsorted(place, many)
    number = np.diff(first)[place]
    inner = np.repeat(np.arange(len(shapes)), number)
    outer = np.arange(len(inner)) + np.repeat(first[place] - np.cumsum(number) + number, number)
    may = (blockers.plane[outer] == plane[inner]) | (blockers.plane[outer] < 0)
    facing = np.einsum("kcx,kx->kc", corners[at], blockers.normals) - blockers.offsets[:, None]
    facing[np.abs(facing) <= tolerance] = 0.0
    pairs = Overlaps.of(blockers.vertices, shapes, outer[may], inner[may], at, corners, facing)
    matter = np.zeros(len(blockers), bool)
    matter[pairs.outer] = True
    kept = blockers.take(np.flatnonzero(matter))
    numbers = np.cumsum(matter) - 1
    bound = np.concatenate([[0], np.cumsum(matter)])[first]
    pair = np.searchsorted(pairs.inner, begin)
    outer = numbers[pairs.outer]
    found = []
    for p in range(len(corners)):
        mine, some = slice(begin[p], begin[p + 1]), slice(pair[p], pair[p + 1])
        overlaps = replace(pairs.take(some), outer=outer[some] - bound[p], inner=pairs.inner[some] - begin[p])
        overlaps = replace(overlaps, centre=pairs.centre[p])
        standing = kept.take(slice(bound[p], bound[p + 1]))
        found.append(Standing(standing, shapes[mine], counts[mine], plane[mine], overlaps))
    return found


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
    points,
    normal,
    mirrors: Sequence[Reflecting],
    throughput: float,
    rows,
    received: Received,
) -> None:
    """Enter what is seen of polygons past blockers, as mirrors reflect it.

    Parameters
    ----------
    outlines : Outlines
    standing : Standing
    unseen_backs : (o,) bool
        Outlines that nobody need look for who is behind them.
    seen : SeenShapes
        What is seen of the shapes.
    points : (r, 3) float
    normal : (3,) float
    mirrors : sequence of Reflecting
    throughput : float
        Product of their largest reflectances.
    rows : (r,) int
        Receivers of what is seen at the points.
    received : Received
    """
    varies = any(mirror.varies for mirror in mirrors)

    def whole(some: SeenShapes) -> None:
        if varies:
            enter(some.made()[0])
        else:
            received.add_seen(rows[some.row], throughput * some.weight, some, standing.counts, normal)

    def enter(some: Shapes) -> None:
        received.add(rows[some.row], _reflected(some, mirrors), some.shape, normal)

    blockers, overlaps = standing.blockers, standing.overlaps
    if len(overlaps.outer):
        facing = blockers.facing(points, unseen_backs, outlines.tolerance)
        if len(overlaps.outer) * len(points) > _FEW:
            overlaps = overlaps.take(overlaps.near(frame(points, normal), facing))
    if not len(overlaps.outer):
        whole(seen)
        return
    clear = np.array([outlines.materials[o].is_transparent for o in blockers.outline], bool)[overlaps.outer]
    hides, crosses = overlaps.seen(points, facing)
    if not (hides.any() or crosses.any()):
        whole(seen)
        return
    crosses[clear] |= hides[clear]
    # what crosses follows shape after shape, for each receiver
    shapes = len(standing.shapes)
    row, pairs = np.nonzero(crosses.T)
    place = seen.row * shapes + seen.polygon
    every = np.bincount(row * shapes + overlaps.inner[pairs], minlength=len(points) * shapes)
    start = (np.cumsum(every) - every)[place]
    count = every[place]
    hidden = np.zeros((shapes, len(points)), bool)
    np.logical_or.at(hidden, overlaps.inner[~clear], hides[~clear])
    count[hidden[seen.polygon, seen.row]] = -1
    whole(seen.take(np.flatnonzero(count == 0)))
    by_pieces = count > 0
    if not varies:
        panes = np.bincount((row * shapes + overlaps.inner[pairs])[clear[pairs]], minlength=len(every))
        by_pieces &= panes[place] > 0
    if by_pieces.any():
        enter(_in_pieces(outlines, standing, seen.take(np.flatnonzero(by_pieces)).made()[0], points))
        count[by_pieces] = -1
    corners = blockers.vertices.transpose(2, 1, 0)
    for number in np.unique(count[count > 0]).tolist():
        mine = np.flatnonzero(count == number)
        some, kept = seen.take(mine).made()
        mine, row = mine[kept], some.row
        blocker = overlaps.outer[pairs[start[mine] + np.arange(number)[:, None]]]
        screens = corners.take(blocker, axis=2).transpose(2, 0, 1, 3) - points[row].T[:, None]
        received.add(rows[row], _reflected(some, mirrors), some.shape, normal, screens, facing[blocker, row])


def _reflected(seen: Shapes, mirrors: Sequence[Reflecting]) -> np.ndarray:
    """(n,) float: weights, as mirrors on the way weaken them."""
    weight = seen.weight
    if mirrors:
        centre = seen.shape.mean(axis=1).T
        for mirror in mirrors:
            weight = weight * mirror.share(centre)
    return weight


def _in_pieces(outlines: Outlines, standing: Standing, seen: Shapes, points) -> Shapes:
    """What is seen past blockers, where pieces need weights of their own: past panes, or by uneven mirrors."""
    blockers = standing.blockers
    every = zip(blockers.vertices, blockers.outline.tolist(), blockers.plane.tolist(), strict=True)
    for polygon, outline, plane in every:
        planes, edges, facing = edge_cones(polygon[None] - points[:, None])
        height = np.matmul(seen.shape.transpose(2, 1, 0), planes.transpose(0, 2, 1)[seen.row])
        reach = np.abs(seen.shape).max(axis=(0, 1))
        overlaps = ((height.max(axis=1) > 1e-12 * reach[:, None]) | ~edges[seen.row]).all(axis=1)
        overlaps &= facing[seen.row] != 0
        if plane >= 0:
            overlaps &= standing.plane[seen.polygon] == plane
        if overlaps.any():
            behind = past_blocker(outlines, polygon, outline, seen.take(np.flatnonzero(overlaps)), planes, edges)
            seen = joined([seen.take(np.flatnonzero(~overlaps)), *behind])
        if not len(seen.row):
            break
    return seen
