"""Blockers: convex polygons between receivers and bright ones, and what light comes past them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from . import polygons
from .outlines import Outlines
from .pieces import SeenShapes, Shapes, edge_cones, joined, past_blocker
from .projection import HalfSpace, reflect, reflect_points
from .received import Received

if TYPE_CHECKING:
    from .standing import Standing

_FEW = 4_000
"""Pairs of a blocker and a shape, times receivers: fewer are told one by one at once."""


@dataclass(frozen=True, eq=False)
class Blockers:
    """Convex polygons, in the receivers' mirrored space.

    Attributes
    ----------
    vertices : (k, w, 3) float, padded
        What of each outline lies in between.
    normals : (k, 3) float, unit
    offsets : (k,) float
    outline : (k,) int
    plane : (k,) int
        Of the bright polygons that it may stand before; -1: any.
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    outline: np.ndarray
    plane: np.ndarray

    @classmethod
    def of(cls, outlines: Outlines, outline, plane) -> Blockers:
        """Some outlines ``(k,)``, before planes ``(k,)``."""
        return cls(outlines.vertices[outline], outlines.normals[outline], outlines.offsets[outline], outline, plane)

    @classmethod
    def none(cls) -> Blockers:
        """Nothing in the way."""
        none = np.zeros(0, np.int64)
        return cls(np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros(0), none, none)

    def __len__(self) -> int:
        return len(self.outline)

    def take(self, index) -> Blockers:
        """Some of them."""
        return Blockers(
            *(part[index] for part in (self.vertices, self.normals, self.offsets, self.outline, self.plane))
        )

    def joined(self, *others: Blockers) -> Blockers:
        """These and others."""
        some = [one for one in (self, *others) if len(one)]
        if len(some) < 2:
            return some[0] if some else self
        return Blockers(
            polygons.joined([one.vertices for one in some]),
            np.concatenate([one.normals for one in some]),
            np.concatenate([one.offsets for one in some]),
            np.concatenate([one.outline for one in some]),
            np.concatenate([one.plane for one in some]),
        )

    def reflected(self, normal, offset: float) -> Blockers:
        """Their images in a mirror, run round the other way so that normals stay right-handed."""
        vertices = reflect_points(self.vertices[:, ::-1], normal, offset)
        normals = reflect(self.normals, normal)
        return Blockers(vertices, normals, np.einsum("kc,kc->k", normals, vertices[:, 0]), self.outline, self.plane)

    def facing(self, points, unseen_backs, tolerance: float) -> np.ndarray:
        """(k, r) float: height of points before each plane; 0 in it, and behind outlines ``(o,)`` of unseen backs."""
        height = self.normals @ points.T
        height -= self.offsets[:, None]
        height[np.abs(height) <= tolerance] = 0.0
        unseen = np.zeros(0, bool) if unseen_backs is None else unseen_backs[self.outline]
        if unseen.any():  # who is behind a solid's side is behind others
            height[unseen] = np.maximum(height[unseen], 0.0)
        return height


class Reflecting(Protocol):
    """A mirror on the way."""

    @property
    def varies(self) -> bool:
        """Whether its reflectance changes with the angle."""

    def share(self, directions) -> np.ndarray:
        """(n,) float: of light along directions ``(n, 3)``."""


def between(outlines: Outlines, corners, shapes, half_spaces: list[HalfSpace], skip: int = -1) -> Blockers:
    """Outlines, cut to the half-spaces, that may stand between some receivers of one plane and some of the shapes.

    Parameters
    ----------
    outlines : Outlines
    corners : (c, 3) float
        Between which the receivers are.
    shapes : (s, v, 3) float
    half_spaces : list of HalfSpace
        That all light is within; the receivers' horizon among them.
    skip : int
        An outline that is none.
    """
    tolerance = outlines.tolerance
    mask = np.ones(len(outlines.vertices), bool)
    for half in half_spaces:
        mask &= above(outlines.vertices, half, tolerance)
    if skip >= 0:
        mask[skip] = False
    index = np.flatnonzero(mask)
    if not len(index):
        return Blockers.none()
    normals, offsets = outlines.normals[index], outlines.offsets[index]
    near = corners @ normals.T - offsets
    far = shapes.reshape(-1, 3) @ normals.T - offsets
    apart = (near.max(axis=0) > tolerance) & (far.min(axis=0) < -tolerance)
    apart |= (near.min(axis=0) < -tolerance) & (far.max(axis=0) > tolerance)
    kept = index[apart]
    return _cut(Blockers.of(outlines, kept, np.full(len(kept), -1)), half_spaces, tolerance)


def _cut(blockers: Blockers, half_spaces: list[HalfSpace], tolerance: float) -> Blockers:
    """What of blockers lies within half-spaces."""
    parts = blockers.vertices
    for half in half_spaces:
        parts = polygons.clip(parts, half.normal, half.offset)
    return replace(blockers, vertices=parts).take(polygons.areas(parts) > tolerance**2)


def above(vertices, half: HalfSpace, tolerance: float) -> np.ndarray:
    """(m,) bool: polygons ``(m, v, 3)`` that are not wholly beneath a plane."""
    return (vertices @ half.normal - half.offset > tolerance).any(axis=1)


def frame(points, normal) -> np.ndarray:
    """(4, 3) float: corners of a rectangle around points of one plane."""
    across = polygons.plane_basis(normal)
    flat = points @ across.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    places = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return places @ across + (points[0] @ normal) * normal


def light_past(
    outlines: Outlines,
    standing: Standing,
    unseen_backs,
    seen: SeenShapes,
    points,
    normal,
    mirrors: Sequence[Reflecting],
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
    rows : (r,) int
        Receivers of what is seen at the points.
    received : Received
    """

    varies = any(mirror.varies for mirror in mirrors)

    def whole(some: SeenShapes) -> None:
        if varies:
            enter(some.made()[0])
        else:
            received.add_seen(rows[some.row], share * some.weight, some, standing.counts, normal)

    def enter(some: Shapes) -> None:
        received.add(rows[some.row], _reflected(some, mirrors), some.shape, normal)

    share = float(np.prod([mirror.share(normal[None])[0] for mirror in mirrors]))
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
