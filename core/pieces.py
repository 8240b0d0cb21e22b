"""Pieces of bright polygons as receivers see them, cut where panes dim them or mirrors throw back unevenly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from . import clipping, polygons
from .outlines import Outlines

_EVEN = 0.4
_EVEN_TO = 0.003
"""By how much shares of light at corners may differ from that in the middle: of it, and more by so much."""

_MOST_HALVINGS = 8

_OF_CORNERS = 0.3
"""Their part in a mean over a polygon, the rest is the middle's: by a quarter for triangles, by a third for rectangles
the mean of a quadratic function is exact."""


@dataclass(frozen=True, eq=False)
class Shapes:
    """What receivers see of bright polygons.

    Attributes
    ----------
    row, polygon : (n,) int
        Receiver of each, and which polygon it is a part of.
    shape : (3, v, n) float, padded
        Relative to the receiver.
    weight : (n,) float
        Exitance times what panes let through [lm/m²].
    """

    row: np.ndarray
    polygon: np.ndarray
    shape: np.ndarray
    weight: np.ndarray

    def take(self, index) -> Shapes:
        """Some of them ``(k,)`` int."""
        return Shapes(self.row[index], self.polygon[index], self.shape.take(index, axis=2), self.weight[index])


@dataclass(frozen=True, eq=False)
class Windows:
    """What each receiver sees of a mirror, through which it sees all else.

    Attributes
    ----------
    corners : (3, w, r) float, padded
        Relative to the receivers.
    planes : (3, w, r) float
        Through each eye and the window's edges, positive inside; nought where there is no edge.
    edges : (w, r) bool
    facing : (r,) float
        Positive where the right-hand normal looks at the receiver.
    """

    corners: np.ndarray
    planes: np.ndarray
    edges: np.ndarray
    facing: np.ndarray

    @classmethod
    def of(cls, windows: np.ndarray) -> Windows:
        """Polygons ``(r, w, 3)``."""
        planes, edges, facing = edge_cones(windows)
        edges &= (facing != 0)[:, None]
        corners, planes = (np.ascontiguousarray(part.transpose(2, 1, 0)) for part in (windows, planes))
        return cls(corners, planes, np.ascontiguousarray(edges.T), -facing)


@dataclass(frozen=True, eq=False)
class SeenShapes:
    """Pairs of a receiver and a bright polygon that it sees, all of it or what a window shows: made when it is needed.

    Attributes
    ----------
    row, polygon : (n,) int
    corners : (3, v, s) float, padded
        Of the polygons.
    places : (3, r) float
        Of the receivers.
    weight : (n,) float
    cut : (n,) bool
        Of which a window shows but a part.
    windows : Windows or None
    """

    row: np.ndarray
    polygon: np.ndarray
    corners: np.ndarray
    places: np.ndarray
    weight: np.ndarray
    cut: np.ndarray
    windows: Windows | None = None

    @classmethod
    def of(cls, row, polygon, corners, places, weight, windows: Windows | None) -> SeenShapes:
        """Those pairs of which windows show anything."""
        every = cls(row, polygon, corners, places, weight, np.zeros(len(row), bool), windows)
        if windows is None or not len(row):
            return every
        shape, planes = every.shape, windows.planes.take(row, axis=2)
        height = planes[0, :, None] * shape[0]
        height += planes[1, :, None] * shape[1]
        height += planes[2, :, None] * shape[2]
        # what only touches a window's edge, as where surfaces cross, is beside it
        beside = height.max(axis=1) <= _TOUCHES * np.abs(shape).max(axis=(0, 1))
        beside = (beside & windows.edges.take(row, axis=1)).any(axis=0)
        cut = (height.min(axis=1) < 0).any(axis=0)
        some = np.flatnonzero(cut & ~beside)
        # polygons that cross a mirror may leave but an edge behind it, which a window must not find inside
        beside[some] = ~has_area(shape.take(some, axis=2).transpose(2, 1, 0))
        return replace(every, cut=cut).take(np.flatnonzero(~beside))

    @property
    def shape(self) -> np.ndarray:
        """(3, v, n) float: the polygons, without regard to windows."""
        shape = self.corners.take(self.polygon, axis=2)
        shape -= self.places.take(self.row, axis=1)[:, None]
        return shape

    def take(self, index) -> SeenShapes:
        """Some of them ``(k,)`` int."""
        picked = {name: getattr(self, name)[index] for name in ("row", "polygon", "weight", "cut")}
        return replace(self, **picked)

    def made(self) -> tuple[Shapes, np.ndarray]:
        """Those of which anything is seen, cut to the windows; and which they are (k,)."""
        if self.windows is None or not self.cut.any():
            return Shapes(self.row, self.polygon, self.shape, self.weight), np.arange(len(self.row))
        whole, cut = np.flatnonzero(~self.cut), np.flatnonzero(self.cut)
        shape = self.shape
        part = shape.take(cut, axis=2).transpose(2, 1, 0)
        for plane in self.windows.planes.take(self.row[cut], axis=2).transpose(1, 2, 0):
            part = clipping.clip(part, plane)
        some = has_area(part)
        index = np.concatenate([whole, cut[some]])
        parts = polygons.joined([shape.take(whole, axis=2).transpose(2, 1, 0), part[some]])
        shape = np.ascontiguousarray(parts.transpose(2, 1, 0))
        return Shapes(self.row[index], self.polygon[index], shape, self.weight[index]), index


def tightened(shapes) -> tuple[np.ndarray, np.ndarray]:
    """Padded polygons ``(m, v, 3)`` without corners that lie on the one before, padded anew; and their corners (m,)."""
    if not len(shapes):
        return shapes, np.zeros(0, np.int64)
    step = np.abs(shapes - shapes[:, np.arange(-1, shapes.shape[1] - 1)]).max(axis=2)
    apart = step > _SAME * np.ptp(shapes, axis=1).max(axis=1)[:, None]
    counts = np.maximum(apart.sum(axis=1), 1)
    if apart.all():
        return shapes, counts
    width = int(counts.max())
    order = np.argsort(~apart, axis=1, kind="stable")
    place = np.minimum(np.arange(width), counts[:, None] - 1)
    rows = np.arange(len(shapes))[:, None]
    return shapes[rows, order[rows, place]], counts


_TOUCHES = 1e-10
"""Height within a window's edge, over the distance, up to which a polygon is beside it."""

_SAME = 1e-12
"""Over a polygon's size: corners that are no farther apart are one."""


def past_blocker(outlines: Outlines, polygon, outline: int, seen: Shapes, planes, edges) -> list[Shapes]:
    """Polygons less a blocker's cone; behind a pane they are kept, dimmed."""
    kept = []
    material = outlines.materials[outline]
    row, shape, weight, which = seen.row, seen.shape.transpose(2, 1, 0), seen.weight, seen.polygon
    for e in range(planes.shape[1]):
        if not len(row):
            break
        wall, edge = planes[row, e], edges[row, e]
        outside = clipping.clip(shape, -wall)
        some = np.flatnonzero(edge & has_area(outside))
        kept.append(Shapes(row[some], which[some], outside[some].transpose(2, 1, 0), weight[some]))
        inside = clipping.clip(shape, wall)
        inside = inside if edge.all() else _choose(edge, inside, shape)
        some = np.flatnonzero(has_area(inside))
        row, which, shape, weight = row[some], which[some], inside[some], weight[some]
    if material.is_transparent:
        plane = polygons.newell_normal(polygon)
        plane /= np.linalg.norm(plane)

        def through(directions: np.ndarray) -> np.ndarray:
            length = np.maximum(np.linalg.norm(directions, axis=1), 1e-300)
            return material.transmittance_at((directions @ plane) / length)

        kept.append(even_parts(Shapes(row, which, shape.transpose(2, 1, 0), weight), through)[0])
    return kept


def even_parts(seen: Shapes, share: Callable[[np.ndarray], np.ndarray]) -> tuple[Shapes, np.ndarray]:
    """Shapes in parts of which a share of light comes that is about the same all over each.

    Parameters
    ----------
    seen : Shapes
    share : callable
        Of light along directions ``(n, 3)`` of any length; (n,) float.

    Returns
    -------
    parts : Shapes
        Weighed with the share.
    of : (m,) int
        Which of the shapes each is a part of.
    """
    shapes, of = seen.shape.transpose(2, 1, 0), np.arange(len(seen.row))
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for halving in range(_MOST_HALVINGS + 1):
        middle = share(_mean_directions(shapes))
        corners = share(shapes.reshape(-1, 3)).reshape(shapes.shape[:2])
        apart = np.abs(corners - middle[:, None]).max(axis=1, initial=0.0)
        uneven = (apart > _EVEN * middle + _EVEN_TO) & (halving < _MOST_HALVINGS)
        own = (shapes != polygons.following(shapes)).any(axis=2)  # each corner once
        mean = (corners * own).sum(axis=1) / np.maximum(own.sum(axis=1), 1)
        mean = (1 - _OF_CORNERS) * middle + _OF_CORNERS * np.where(own.any(axis=1), mean, middle)
        found.append((shapes[~uneven], of[~uneven], mean[~uneven]))
        if not uneven.any():
            break
        shapes, of = _halved(shapes[uneven]), np.tile(of[uneven], 2)
        wide = has_area(shapes)
        shapes, of = shapes[wide], of[wide]
    of, mean = (np.concatenate([part[k] for part in found]) for k in (1, 2))
    shape = np.ascontiguousarray(polygons.joined([part for part, _, _ in found]).transpose(2, 1, 0))
    return Shapes(seen.row[of], seen.polygon[of], shape, seen.weight[of] * mean), of


def _mean_directions(shapes: np.ndarray) -> np.ndarray:
    """(m, 3) float, of any length: directions to polygons ``(m, v, 3)``, means over the solid angle (Lambert)."""
    after = polygons.following(shapes)
    pole = polygons.cross(shapes, after)
    length = np.sqrt((pole * pole).sum(axis=2))
    angle = np.arctan2(length, (shapes * after).sum(axis=2))
    return (pole * (angle / np.where(length > 0, length, 1.0))[:, :, None]).sum(axis=1)


def _halved(shapes: np.ndarray) -> np.ndarray:
    """(2 m, v, 3): both sides of convex polygons ``(m, v, 3)``, cut through the middle across their longest reach."""
    centre = polygons.centroids(shapes)
    reach = shapes - centre[:, None]
    farthest = np.argmax(np.einsum("mvc,mvc->mv", reach, reach), axis=1)
    along = reach[np.arange(len(shapes)), farthest]
    at = np.einsum("mc,mc->m", along, centre)
    return polygons.joined([clipping.clip(shapes, along, at), clipping.clip(shapes, -along, -at)])


def joined(parts: list[Shapes]) -> Shapes:
    """All polygons in one."""
    parts = [p for p in parts if len(p.row)] or parts[:1]
    return Shapes(
        np.concatenate([p.row for p in parts]),
        np.concatenate([p.polygon for p in parts]),
        np.ascontiguousarray(polygons.joined([p.shape.transpose(2, 1, 0) for p in parts]).transpose(2, 1, 0)),
        np.concatenate([p.weight for p in parts]),
    )


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
