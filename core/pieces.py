"""Pieces of bright polygons as receivers see them, cut where panes dim them or mirrors throw back unevenly."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from . import polygons
from .outlines import Outlines


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
        beside = ((height.max(axis=1) <= 0) & windows.edges.take(row, axis=1)).any(axis=0)
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
            part = polygons.clip(part, plane)
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
        outside = polygons.clip(shape, -wall)
        some = np.flatnonzero(edge & has_area(outside))
        kept.append(Shapes(row[some], which[some], outside[some].transpose(2, 1, 0), weight[some]))
        inside = polygons.clip(shape, wall)
        inside = inside if edge.all() else _choose(edge, inside, shape)
        some = np.flatnonzero(has_area(inside))
        row, which, shape, weight = row[some], which[some], inside[some], weight[some]
    if material.is_transparent:
        plane = polygons.newell_normal(polygon)
        centre = shape.mean(axis=1)
        length = np.linalg.norm(centre, axis=1) * np.linalg.norm(plane)
        through = material.transmittance_at((centre @ plane) / np.maximum(length, 1e-300))
        kept.append(Shapes(row, which, shape.transpose(2, 1, 0), weight * through))
    return kept


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
