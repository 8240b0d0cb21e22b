"""Blockers: convex polygons between receivers and bright ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from . import clipping, polygons
from .outlines import Outlines
from .projection import HalfSpace, reflect, reflect_points


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


@dataclass(frozen=True, eq=False)
class Places:
    """Where receivers of some planes are, or their images, and what all that they see lies within.

    Attributes
    ----------
    corners : (p, c, 3) float
        Between which the receivers of each plane are.
    limits : list of ((p, 3) float, (p,) float)
        Normals and offsets of half-spaces: the receivers' horizons, and what is behind the last mirror.
    """

    corners: np.ndarray
    limits: list[tuple[np.ndarray, np.ndarray]]

    def __len__(self) -> int:
        return len(self.corners)

    def take(self, index) -> Places:
        """Some of them."""
        return Places(self.corners[index], [(normals[index], offsets[index]) for normals, offsets in self.limits])

    def cut(self, shapes: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Parts of polygons ``(m, v, 3)`` within the limits of places ``(m,)``."""
        for normals, offsets in self.limits:
            shapes = clipping.clip(shapes, normals[place], offsets[place])
        return shapes

    def above(self, shapes: np.ndarray, tolerance: float) -> np.ndarray:
        """(p, m) bool: polygons ``(m, v, 3)`` that are not wholly outside of any limit."""
        found = np.ones((len(self.corners), len(shapes)), bool)
        for normals, offsets in self.limits:
            found &= (shapes @ normals.T - offsets > tolerance).any(axis=1).T
        return found


def between(outlines: Outlines, places: Places, shapes, skip: int) -> tuple[Blockers, np.ndarray]:
    """Outlines, cut to the limits, that may stand between receivers and a shape; and whose these are (k,), ascending.

    Parameters
    ----------
    outlines : Outlines
    places : Places
    shapes : (p, v, 3) float
        One for each place.
    skip : int
        An outline that is none.
    """
    tolerance = outlines.tolerance
    near = places.corners @ outlines.normals.T - outlines.offsets
    far = shapes @ outlines.normals.T - outlines.offsets
    apart = (near.max(axis=1) > tolerance) & (far.min(axis=1) < -tolerance)
    apart |= (near.min(axis=1) < -tolerance) & (far.max(axis=1) > tolerance)
    apart[:, skip] = False
    apart &= places.above(outlines.vertices, tolerance)
    place, index = np.nonzero(apart)
    parts = places.cut(outlines.vertices[index], place)
    wide = np.flatnonzero(polygons.areas(parts) > tolerance**2)
    blockers = replace(Blockers.of(outlines, index, np.full(len(index), -1)), vertices=parts)
    return blockers.take(wide), place[wide]


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
