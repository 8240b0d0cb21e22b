"""Bright few: luminous surfaces and sun patches as polygons, gathered exactly by Lambert's formula.

A small bright polygon is seen by few parcels or none. So its light is found without the globe: what a receiver sees
of the polygon is the polygon less the outlines in between, clipped exactly; in mirrors it is the same in the
mirrored scene, inside the mirror's outline.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import polygons
from .materials import Material
from .projection import HalfSpace, reflect, reflect_points
from .specular import ChainLimits, Outlines

_FAINT = 1e-2
"""Mirrored images this much fainter than the cut-off, by the source's share in all flux, are not looked for."""


@dataclass(frozen=True, eq=False)
class Source:
    """A convex polygon of even luminous exitance.

    Attributes
    ----------
    polygon : (v, 3) float
        Right-handed about the direction that it shines to.
    exitance : float [lm/m²]
    """

    polygon: np.ndarray
    exitance: float

    @property
    def plane(self) -> tuple[np.ndarray, float]:
        """Unit normal and offset of its plane."""
        normal = polygons.newell_normal(self.polygon)
        normal = normal / np.linalg.norm(normal)
        return normal, float(normal @ self.polygon.mean(axis=0))


@dataclass(frozen=True, eq=False)
class Screen:
    """Something in the way, in the receivers' mirrored space.

    Attributes
    ----------
    polygon : (w, 3) float
        What of the outline lies in between.
    outline : int
    """

    polygon: np.ndarray
    outline: int

    def reflected(self, normal, offset: float) -> Screen:
        """Its image in a mirror."""
        return Screen(reflect_points(self.polygon, normal, offset), self.outline)


@dataclass(frozen=True, eq=False)
class Mirrored:
    """A mirror on the way: its material, and its normal in the receivers' mirrored space."""

    material: Material
    normal: np.ndarray

    def share(self, directions) -> np.ndarray:
        """(n,) float: specular reflectance for light along directions ``(n, 3)`` of any length."""
        length = np.maximum(np.linalg.norm(directions, axis=1), 1e-300)
        return self.material.specular_at((directions @ self.normal) / length)


def gather_sources(
    outlines: Outlines,
    sources: list[Source],
    points,
    normal,
    limits: ChainLimits,
    checkpoint: Callable[[], None] = lambda: None,
) -> np.ndarray:
    """Illuminance from sources at receivers of one plane, direct, through panes and in mirrors.

    Parameters
    ----------
    outlines : Outlines
    sources : list of Source
    points : (r, 3) float
        In one plane.
    normal : (3,) float, unit
    limits : ChainLimits
        Images by more than ``exact_mirrors`` are left out.
    checkpoint : callable
        Called between sources; may raise to stop.

    Returns
    -------
    (r,) float [lx]
    """
    total = np.zeros(len(points))
    if not sources or not len(points):
        return total
    horizon = HalfSpace(np.asarray(normal, float), float(np.asarray(normal) @ points[0]))
    # one in the receivers' own plane too: it comes into view by way of others
    mirrors = [o for o, material in enumerate(outlines.materials) if material.is_specular]
    flux = np.array([source.exitance * float(polygons.areas(source.polygon)) for source in sources])
    view = _SourceView(outlines, sources, flux / flux.sum(), mirrors, limits, checkpoint)
    return view.illuminance(_Leg(np.asarray(points, float), horizon, None, (), (), 1.0, None, 0))


@dataclass(frozen=True, eq=False)
class _Leg:
    """Where receivers look from: themselves, or their image after some mirrors.

    Attributes
    ----------
    points : (r, 3) float
    horizon : HalfSpace
        Above their own plane, mirrored likewise.
    window : (r, v, 3) float or None
        What each receiver sees of the last mirror through all before it, relative to the receiver.
    mirrors : tuple of Mirrored
    screens : tuple of Screen
        What lies on the way so far.
    throughput : float
        Largest product of the reflectances so far.
    beyond : HalfSpace or None
        Behind the last mirror, where they look.
    depth : int
        Mirrors so far.
    """

    points: np.ndarray
    horizon: HalfSpace
    window: np.ndarray | None
    mirrors: tuple[Mirrored, ...]
    screens: tuple[Screen, ...]
    throughput: float
    beyond: HalfSpace | None
    depth: int

    @property
    def limits(self) -> list[HalfSpace]:
        """What all that is seen lies within."""
        return [self.horizon] if self.beyond is None else [self.horizon, self.beyond]

    def clipped(self, polygon) -> np.ndarray:
        """(1, v, 3) float: part of a polygon within the limits."""
        part = polygon[None]
        for half in self.limits:
            part = polygons.clip(part, half.normal, half.offset)
        return part

    def seen(self, rows, polygon) -> tuple[np.ndarray, np.ndarray]:
        """Rows that see some of a polygon through the window, and what they see, relative to them."""
        if not len(rows):
            return rows, np.zeros((0, 1, 3))
        shape = polygon[None] - self.points[rows][:, None]
        if self.window is not None:
            shape = within_cones(shape, self.window[rows])
        some = _has_area(shape)
        return rows[some], shape[some]


@dataclass(frozen=True, eq=False)
class _SourceView:
    """Sources as receivers of one plane see them, straight and in mirrors.

    Attributes
    ----------
    flux : (s,) float
        Share of each source in the flux of all.
    """

    outlines: Outlines
    sources: list[Source]
    flux: np.ndarray
    mirrors: list[int]
    limits: ChainLimits
    checkpoint: Callable[[], None]

    def illuminance(self, leg: _Leg) -> np.ndarray:
        """(r,) float: light that comes past the leg's screens, and by any further mirror [lx]."""
        total = np.zeros(len(leg.points))
        for source, flux in zip(self.sources, self.flux, strict=True):
            if leg.depth == 0 or leg.throughput * flux > _FAINT * self.limits.cutoff:
                self.checkpoint()
                self._add_source(leg, source, total)
        if leg.depth < self.limits.exact_mirrors:
            for mirror in self.mirrors:
                self._add_mirrored(leg, mirror, total)
        return total

    def _add_source(self, leg: _Leg, source: Source, total: np.ndarray) -> None:
        outlines, tolerance = self.outlines, self.outlines.tolerance
        plane, at = source.plane
        visible = leg.clipped(source.polygon)
        if polygons.areas(visible)[0] <= tolerance**2:
            return
        rows, shape = leg.seen(np.flatnonzero(leg.points @ plane - at > tolerance), visible[0])
        if not len(rows):
            return
        between = _between(outlines, leg.points[rows], visible[0], [HalfSpace(plane, at), *leg.limits])
        screens = [*leg.screens, *(Screen(polygon, o) for o, polygon in between)]
        factor = _seen_factor(outlines, shape, leg.points[rows], leg.horizon.normal, screens, leg.mirrors)
        total[rows] += source.exitance * factor

    def _add_mirrored(self, leg: _Leg, mirror: int, total: np.ndarray) -> None:
        outlines, tolerance = self.outlines, self.outlines.tolerance
        material = outlines.materials[mirror]
        throughput = leg.throughput * float(material.specular_at(np.linspace(0.05, 1.0, 8)).max())
        outline = outlines.vertices[mirror]
        if throughput < self.limits.cutoff:
            return
        if leg.beyond is not None and not _above(outline[None], leg.beyond, tolerance)[0]:
            return  # the mirror just used, or one in its plane
        aperture = leg.clipped(outline)
        if polygons.areas(aperture)[0] <= tolerance**2:
            return
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        both = outlines.two_sided[mirror] or material.reflects_both_sides
        for side in (1.0, -1.0) if both else (1.0,):
            ahead = HalfSpace(side * normal, side * offset)
            rows = np.flatnonzero(leg.points @ ahead.normal - ahead.offset > tolerance)
            if not len(rows) or not any(_above(s.polygon[None], ahead, tolerance)[0] for s in self.sources):
                continue
            rows, window = leg.seen(rows, aperture[0])
            if not len(rows):
                continue
            between = _between(outlines, leg.points[rows], aperture[0], [ahead, *leg.limits], skip=mirror)
            screens = [*leg.screens, *(Screen(polygon, o) for o, polygon in between)]
            passed = [Mirrored(m.material, reflect(m.normal, normal)) for m in leg.mirrors]
            total[rows] += self.illuminance(
                _Leg(
                    reflect_points(leg.points[rows], normal, offset),
                    leg.horizon.reflected(normal, offset),
                    reflect(window, normal),
                    (*passed, Mirrored(material, normal)),
                    tuple(s.reflected(normal, offset) for s in screens),
                    throughput,
                    ahead,
                    leg.depth + 1,
                )
            )


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
    planes, _, facing = _edge_cones(windows)
    for edge in range(planes.shape[1]):
        shapes = polygons.clip(shapes, planes[:, edge])
    return np.where((facing != 0)[:, None, None], shapes, shapes[:, :1])


def _edge_cones(windows) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Planes through the eye and a window's edges, positive inside; which are edges; from which side it is seen."""
    planes = polygons.cross(windows, np.roll(windows, -1, axis=1))
    facing = np.einsum("rc,rc->r", polygons.newell_normal(windows), windows[:, 0])
    planes *= np.sign(facing)[:, None, None]
    length = np.linalg.norm(planes, axis=2)
    edges = length > 1e-14 * np.linalg.norm(windows, axis=2).max(axis=1)[:, None] ** 2
    planes = np.where(edges[:, :, None], planes / np.where(edges, length, 1.0)[:, :, None], 0.0)
    return planes, edges, facing


def _above(vertices, half: HalfSpace, tolerance: float) -> np.ndarray:
    return (vertices @ half.normal - half.offset > tolerance).any(axis=1)


def _between(outlines: Outlines, points, target, half_spaces: list[HalfSpace], skip: int = -1):
    """Outlines, cut to the half-spaces, whose plane separates some receiver from some of the target."""
    tolerance = outlines.tolerance
    mask = np.ones(len(outlines.vertices), bool)
    for half in half_spaces:
        mask &= _above(outlines.vertices, half, tolerance)
    if skip >= 0:
        mask[skip] = False
    index = np.flatnonzero(mask)
    low, high = points.min(axis=0), points.max(axis=0)
    pick = np.indices((2, 2, 2)).reshape(3, -1).T.astype(bool)
    corners = np.where(pick, high, low) if len(points) > 8 else points
    normals, offsets = outlines.normals[index], outlines.offsets[index]
    near = corners @ normals.T - offsets
    far = target @ normals.T - offsets
    apart = ((near.max(axis=0) > tolerance) & (far.min(axis=0) < -tolerance)) | (
        (near.min(axis=0) < -tolerance) & (far.max(axis=0) > tolerance)
    )
    for o in index[apart]:
        part = outlines.vertices[o][None]
        for half in half_spaces:
            part = polygons.clip(part, half.normal, half.offset)
        if polygons.areas(part)[0] > tolerance**2:
            yield int(o), part[0]


def _seen_factor(outlines: Outlines, shape, points, normal, screens: list[Screen], mirrors) -> np.ndarray:
    """(r,) float: form factor to what is seen of polygons, times what panes let through and mirrors reflect."""
    row = np.arange(len(points))
    weight = np.ones(len(points))
    for screen in screens:
        planes, edges, facing = _edge_cones(screen.polygon[None] - points[:, None])
        height = np.einsum("nvc,nwc->nvw", shape, planes[row])
        reach = np.abs(shape).max(axis=(1, 2))
        overlaps = ((height.max(axis=1) > 1e-12 * reach[:, None]) | ~edges[row]).all(axis=1) & (facing[row] != 0)
        row, shape, weight = _pass_screen(outlines, screen, row, shape, weight, planes, edges, overlaps)
        if not len(row):
            return np.zeros(len(points))
    centre = shape.mean(axis=1)
    for mirror in mirrors:
        weight = weight * mirror.share(centre)
    factor = np.maximum(polygons.lambert_form_factor(shape, normal), 0.0)
    return np.bincount(row, weights=weight * factor, minlength=len(points))


def _pass_screen(outlines, screen, row, shape, weight, planes, edges, overlaps):
    """Polygons less a screen's cone; behind a pane they are kept, dimmed."""
    kept = [(row[~overlaps], shape[~overlaps], weight[~overlaps])]
    row, shape, weight = row[overlaps], shape[overlaps], weight[overlaps]
    material = outlines.materials[screen.outline]
    for e in range(planes.shape[1]):
        if not len(row):
            break
        wall = planes[row, e]
        outside = polygons.clip(shape, -wall)
        keep = edges[row, e] & _has_area(outside)
        kept.append((row[keep], outside[keep], weight[keep]))
        inside = polygons.clip(shape, wall)
        inside = inside if edges[:, e].all() else _choose(edges[row, e], inside, shape)
        keep = _has_area(inside)
        row, shape, weight = row[keep], inside[keep], weight[keep]
    if material.is_transparent:
        plane = polygons.newell_normal(screen.polygon)
        centre = shape.mean(axis=1)
        length = np.linalg.norm(centre, axis=1) * np.linalg.norm(plane)
        kept.append((row, shape, weight * material.transmittance_at((centre @ plane) / np.maximum(length, 1e-300))))
    kept = [part for part in kept if len(part[0])]
    if not kept:
        return row[:0], np.zeros((0, 1, 3)), weight[:0]
    rows, shapes, weights = zip(*kept, strict=True)
    return np.concatenate(rows), polygons.joined(shapes), np.concatenate(weights)


def _choose(which, one, other):
    width = max(one.shape[1], other.shape[1])
    return np.where(which[:, None, None], polygons.widen(one, width), polygons.widen(other, width))


def _has_area(shapes) -> np.ndarray:
    """Whether clipped polygons, relative to their receivers, still span a solid angle."""
    if not len(shapes):
        return np.zeros(0, bool)
    twice = np.linalg.norm(polygons.newell_normal(shapes), axis=1)
    return twice > 1e-20 * np.maximum(np.abs(shapes).max(axis=(1, 2)), 1e-300) ** 2
