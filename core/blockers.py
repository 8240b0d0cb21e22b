"""Blockers: convex polygons between receivers and bright ones, and what light comes past them.

Which of them matter is told first, for all receivers and then one by one: a blocker hides nothing of what lies outside
of one of its edges. On which side of the plane through an edge and the receiver a corner lies, the sign of a volume
tells, which is an affine function of the receiver's place: for all of them one matrix product.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from . import polygons, unhidden
from .outlines import Outlines
from .projection import HalfSpace, reflect_points

_ROUNDING = np.float32(2e-6)
"""Of distances in float32, over the extent of all at hand: who is nearer to an edge's plane may be on either side."""

_VOLUMES = 1_000_000
"""That are held at once."""


@dataclass(frozen=True, eq=False)
class Blockers:
    """Convex polygons, in the receivers' mirrored space.

    Attributes
    ----------
    vertices : (k, w, 3) float, padded
        What of each outline lies in between.
    outline : (k,) int
    """

    vertices: np.ndarray
    outline: np.ndarray

    @classmethod
    def none(cls) -> Blockers:
        """Nothing in the way."""
        return cls(np.zeros((0, 3, 3)), np.zeros(0, np.int64))

    def __len__(self) -> int:
        return len(self.outline)

    def take(self, index) -> Blockers:
        """Some of them."""
        return Blockers(self.vertices[index], self.outline[index])

    def joined(self, others: Blockers) -> Blockers:
        """These and others."""
        if not len(self) or not len(others):
            return self if len(self) else others
        vertices = polygons.joined([self.vertices, others.vertices])
        return Blockers(vertices, np.concatenate([self.outline, others.outline]))

    def reflected(self, normal, offset: float) -> Blockers:
        """Their images in a mirror."""
        return Blockers(reflect_points(self.vertices, normal, offset), self.outline)

    @cached_property
    def planes(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit normals (k, 3) and offsets (k,)."""
        normal = polygons.newell_normal(self.vertices)
        normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        return normal, np.einsum("kc,kc->k", normal, self.vertices.mean(axis=1))

    def facing(self, points, tolerance: float) -> np.ndarray:
        """(k, r) float: height of points before each plane; 0 in it."""
        normal, offset = self.planes
        height = normal @ points.T
        height -= offset[:, None]
        height[np.abs(height) <= tolerance] = 0.0
        return height

    def before(self, points, shapes, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """What stands before convex shapes, as each point sees them.

        Parameters
        ----------
        points : (r, 3) float
        shapes : (s, v, 3) float
        tolerance : float
            Height over a blocker's plane up to which points lie in it.

        Returns
        -------
        hides : (k, s, r) bool
            The whole shape, surely.
        crosses : (k, s, r) bool
            A part of it, maybe.
        """
        k, s, r = len(self), len(shapes), len(points)
        hides, crosses = np.zeros((2, k, s, r), bool)
        step = max(1, _VOLUMES // max(1, self.vertices.shape[1] * shapes.shape[0] * shapes.shape[1] * r))
        for first in range(0, k, step):
            some = self.take(slice(first, first + step))
            low, high, bounding = some._volumes(points, shapes)
            facing = some.facing(points, tolerance)[:, None]
            behind = facing < 0
            may = np.where(behind, (low < _ROUNDING).all(axis=1), (high > -_ROUNDING).all(axis=1)) & (facing != 0)
            free = ~bounding[:, :, None, None]
            within = np.where(behind, ((high < -_ROUNDING) | free).all(axis=1), ((low > _ROUNDING) | free).all(axis=1))
            hides[first : first + step] = may & within
            crosses[first : first + step] = may & ~within
        return hides, crosses

    def that_matter(self, corners, shapes, tolerance: float) -> np.ndarray:
        """(k, s) bool: which may stand before which shape, as seen from anywhere between ``corners`` (c, 3)."""
        low, high, _ = self._volumes(corners, shapes)
        facing = self.facing(corners, tolerance)
        some_before, some_behind = (facing > 0).any(axis=1)[:, None], (facing < 0).any(axis=1)[:, None]
        as_front, as_back = (high.max(axis=3) > -_ROUNDING).all(axis=1), (low.min(axis=3) < _ROUNDING).all(axis=1)
        return (as_front & some_before) | (as_back & some_behind)

    def _volumes(self, points, shapes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Least and largest height of shapes' corners over the planes through points and edges, over the extent.

        Returns
        -------
        low, high : (k, w, s, r) float32
            Positive within, for blockers that face the point.
        bounding : (k, w) bool
            Which are edges.
        """
        centre = points.mean(axis=0)
        a, corners, eye = self.vertices - centre, shapes - centre, (points - centre).T
        edge = np.roll(a, -1, axis=1) - a
        extent = max(float(np.abs(a).max()), float(np.abs(corners).max()), float(np.abs(eye).max()), 1e-300)
        to = corners[None, None] - a[:, :, None, None]
        normal = polygons.cross(edge[:, :, None, None], to)
        length = np.linalg.norm(normal, axis=4)
        # where an edge and a corner lie on one line the plane is none, and the height nought
        side = np.linalg.norm(edge, axis=2)
        plane = length > 1e-6 * extent * side[:, :, None, None]
        normal *= np.where(plane, 1.0 / np.where(plane, length, 1.0), 0.0)[..., None]
        offset = np.einsum("kwsvc,kwc->kwsv", normal, a)
        forms = np.concatenate([normal, -offset[..., None]], axis=4).reshape(-1, 4).astype(np.float32) / extent
        eye = np.concatenate([eye, np.ones((1, eye.shape[1]))]).astype(np.float32)
        heights = (forms @ eye).reshape(*normal.shape[:4], -1)
        return heights.min(axis=3), heights.max(axis=3), side > 1e-12 * extent


class Reflecting(Protocol):
    """A mirror on the way."""

    @property
    def varies(self) -> bool:
        """Whether its reflectance changes with the angle."""

    def share(self, directions) -> np.ndarray:
        """(n,) float: of light along directions ``(n, 3)``."""


@dataclass(frozen=True, eq=False)
class Shapes:
    """What receivers see of bright polygons.

    Attributes
    ----------
    row : (n,) int
        Receiver of each.
    shape : (n, v, 3) float, padded
        Relative to it.
    weight : (n,) float
        Exitance times what panes let through [lm/m²].
    """

    row: np.ndarray
    shape: np.ndarray
    weight: np.ndarray

    def take(self, index) -> Shapes:
        """Some of the polygons."""
        return Shapes(self.row[index], self.shape[index], self.weight[index])

    @classmethod
    def joined(cls, parts: list[Shapes]) -> Shapes:
        """All polygons in one."""
        parts = [p for p in parts if len(p.row)] or parts[:1]
        return cls(
            np.concatenate([p.row for p in parts]),
            polygons.joined([p.shape for p in parts]),
            np.concatenate([p.weight for p in parts]),
        )


def between(outlines: Outlines, unseen_backs, points, shapes, half_spaces: list[HalfSpace], skip: int = -1) -> Blockers:
    """Outlines, cut to the half-spaces, that may stand between some receivers of one plane and some of the shapes.

    Parameters
    ----------
    outlines : Outlines
    unseen_backs : (o,) bool
        Outlines that nobody need look for who is behind them.
    points : (r, 3) float
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
    low, high = points.min(axis=0), points.max(axis=0)
    pick = np.indices((2, 2, 2)).reshape(3, -1).T.astype(bool)
    corners = np.where(pick, high, low) if len(points) > 8 else points
    normals, offsets = outlines.normals[index], outlines.offsets[index]
    near = corners @ normals.T - offsets
    far = shapes.reshape(-1, 3) @ normals.T - offsets
    apart = ((near.max(axis=0) > tolerance) & (far.min(axis=0) < -tolerance)) | (
        (near.min(axis=0) < -tolerance) & (far.max(axis=0) > tolerance)
    )
    apart &= ~unseen_backs[index] | (near.max(axis=0) > tolerance)  # who is behind a solid's side is behind others
    kept = index[apart]
    parts = outlines.vertices[kept]
    for half in half_spaces:
        parts = polygons.clip(parts, half.normal, half.offset)
    wide = polygons.areas(parts) > tolerance**2
    return Blockers(parts[wide], kept[wide])


def above(vertices, half: HalfSpace, tolerance: float) -> np.ndarray:
    """(m,) bool: polygons ``(m, v, 3)`` that are not wholly beneath a plane."""
    return (vertices @ half.normal - half.offset > tolerance).any(axis=1)


def light_past(
    outlines: Outlines,
    blockers: Blockers,
    seen: Shapes,
    whole: tuple[np.ndarray, np.ndarray],
    points,
    normal,
    mirrors: Sequence[Reflecting],
) -> np.ndarray:
    """Illuminance by what is seen of polygons past blockers, as mirrors reflect it.

    Parameters
    ----------
    outlines : Outlines
    blockers : Blockers
    seen : Shapes
    whole : tuple of (s, v, 3) float and (n,) int
        Polygons that those are parts of, and which one each is of.
    points : (r, 3) float
    normal : (3,) float
    mirrors : sequence of Reflecting

    Returns
    -------
    (r,) float [lx]
    """
    out = np.zeros(len(points))
    polygon, which = whole
    if len(blockers) > 1 and len(points) > 8:
        corners = _frame(points, normal)
        blockers = blockers.take(blockers.that_matter(corners, polygon, outlines.tolerance).any(axis=1))
    if not len(blockers):
        return _add_whole(out, seen, normal, mirrors)
    clear = np.array([outlines.materials[o].is_transparent for o in blockers.outline], bool)
    hides, crosses = blockers.before(points, polygon, outlines.tolerance)
    crosses[clear] |= hides[clear]
    dark = hides[~clear].any(axis=0)[which, seen.row]
    crossed = crosses[:, which, seen.row]
    count = np.where(dark, -1, crossed.sum(axis=0))
    by_pieces = crossed[clear].any(axis=0) if clear.any() else np.zeros(len(count), bool)
    if any(mirror.varies for mirror in mirrors):
        by_pieces[:] = True
    by_pieces &= count > 0
    _add_whole(out, seen.take(count == 0), normal, mirrors)
    if by_pieces.any():
        out += _by_pieces(outlines, blockers, seen.take(by_pieces), points, normal, mirrors)
        count[by_pieces] = -1
    facing = blockers.facing(points, outlines.tolerance)
    corners = blockers.vertices.transpose(2, 1, 0)
    for number in np.unique(count[count > 0]).tolist():
        mine = np.flatnonzero(count == number)
        some, row = seen.take(mine), seen.row[mine]
        _, blocker = np.nonzero(crossed[:, mine].T)
        blocker = blocker.reshape(-1, number).T
        screens = corners[:, :, blocker].transpose(2, 0, 1, 3) - points[row].T[None, :, None]
        shape = np.ascontiguousarray(some.shape.transpose(2, 1, 0))
        factor = unhidden.form_factors(shape, screens, facing[blocker, row], normal)
        weight = _reflected(some, mirrors)
        out += np.bincount(row, weights=weight * np.maximum(factor, 0.0), minlength=len(out))
    return out


def _frame(points, normal) -> np.ndarray:
    """(4, 3) float: corners of a rectangle around points of one plane."""
    across = polygons.plane_basis(normal)
    flat = points @ across.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    places = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return places @ across + (points[0] @ normal) * normal


def _reflected(seen: Shapes, mirrors: Sequence[Reflecting]) -> np.ndarray:
    """(n,) float: weights, as mirrors on the way weaken them."""
    weight = seen.weight
    if mirrors:
        centre = seen.shape.mean(axis=1)
        for mirror in mirrors:
            weight = weight * mirror.share(centre)
    return weight


def _add_whole(out: np.ndarray, seen: Shapes, normal, mirrors: Sequence[Reflecting]) -> np.ndarray:
    """Add light of polygons that nothing hides."""
    if len(seen.row):
        factor = unhidden.whole_form_factors(np.ascontiguousarray(seen.shape.transpose(2, 1, 0)), normal)
        weight = _reflected(seen, mirrors)
        out += np.bincount(seen.row, weights=weight * np.maximum(factor, 0.0), minlength=len(out))
    return out


def _by_pieces(outlines: Outlines, blockers: Blockers, seen: Shapes, points, normal, mirrors) -> np.ndarray:
    """(r,) float: as `light_past`, where pieces need weights of their own: past panes, or by uneven mirrors."""
    for polygon, outline in zip(blockers.vertices, blockers.outline.tolist(), strict=True):
        planes, edges, facing = edge_cones(polygon[None] - points[:, None])
        height = np.matmul(seen.shape, planes.transpose(0, 2, 1)[seen.row])
        reach = np.abs(seen.shape).max(axis=(1, 2))
        overlaps = ((height.max(axis=1) > 1e-12 * reach[:, None]) | ~edges[seen.row]).all(axis=1)
        overlaps &= facing[seen.row] != 0
        if overlaps.any():
            behind = _past_blocker(outlines, polygon, outline, seen.take(overlaps), planes, edges)
            seen = Shapes.joined([seen.take(~overlaps), *behind])
        if not len(seen.row):
            break
    return _add_whole(np.zeros(len(points)), seen, normal, mirrors)


def _past_blocker(outlines: Outlines, polygon, outline: int, seen: Shapes, planes, edges) -> list[Shapes]:
    """Polygons less a blocker's cone; behind a pane they are kept, dimmed."""
    kept = []
    material = outlines.materials[outline]
    for e in range(planes.shape[1]):
        if not len(seen.row):
            break
        wall, edge = planes[seen.row, e], edges[seen.row, e]
        outside = Shapes(seen.row, polygons.clip(seen.shape, -wall), seen.weight)
        kept.append(outside.take(edge & has_area(outside.shape)))
        inside = polygons.clip(seen.shape, wall)
        inside = inside if edge.all() else _choose(edge, inside, seen.shape)
        seen = Shapes(seen.row, inside, seen.weight).take(has_area(inside))
    if material.is_transparent:
        plane = polygons.newell_normal(polygon)
        centre = seen.shape.mean(axis=1)
        length = np.linalg.norm(centre, axis=1) * np.linalg.norm(plane)
        through = material.transmittance_at((centre @ plane) / np.maximum(length, 1e-300))
        kept.append(Shapes(seen.row, seen.shape, seen.weight * through))
    return kept


def within_cones(shapes, windows) -> np.ndarray:
    """Part of each polygon that is seen through a convex window, both relative to the eye.

    Parameters
    ----------
    shapes : (r, v, 3) float, padded
    windows : (r, w, 3) float, padded

    Returns
    -------
    (r, u, 3) float, padded
    """
    planes, _, facing = edge_cones(windows)
    for edge in range(planes.shape[1]):
        shapes = polygons.clip(shapes, planes[:, edge])
    return np.where((facing != 0)[:, None, None], shapes, shapes[:, :1])


def edge_cones(windows) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Planes through the eye and a window's edges, positive inside; which are edges; from which side it is seen."""
    planes = polygons.cross(windows, np.roll(windows, -1, axis=1))
    facing = np.einsum("rc,rc->r", polygons.newell_normal(windows), windows[:, 0])
    planes *= np.sign(facing)[:, None, None]
    length = np.linalg.norm(planes, axis=2)
    edges = length > 1e-14 * np.linalg.norm(windows, axis=2).max(axis=1)[:, None] ** 2
    planes = np.where(edges[:, :, None], planes / np.where(edges, length, 1.0)[:, :, None], 0.0)
    return planes, edges, facing


def has_area(shapes) -> np.ndarray:
    """Whether clipped polygons, relative to their receivers, still span a solid angle."""
    if not len(shapes):
        return np.zeros(0, bool)
    twice = np.linalg.norm(polygons.newell_normal(shapes), axis=1)
    return twice > 1e-20 * np.maximum(np.abs(shapes).max(axis=(1, 2)), 1e-300) ** 2


def _choose(which, one, other):
    width = max(one.shape[1], other.shape[1])
    return np.where(which[:, None, None], polygons.widen(one, width), polygons.widen(other, width))
