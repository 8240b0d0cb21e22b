"""Bright few: luminous surfaces and sun patches as polygons, gathered exactly by Lambert's formula.

A small bright polygon is seen by few parcels or none. So its light is found without the globe: what a receiver sees
of the polygon is the polygon less the outlines in between, clipped exactly; in mirrors it is the same in the
mirrored scene, inside the mirror's outline.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons
from .materials import Material
from .outlines import Outlines
from .projection import HalfSpace, reflect, reflect_points
from .specular import ChainLimits

_FAINT = 1e-4
"""Of the illuminance that the sources' flux would be, spread over all surfaces: what gives less is not looked for."""

_TOGETHER = 16
"""Sources of one plane that are clipped at once."""


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
    faint: float = _FAINT,
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
    faint : float
        Mirrors, and sources in them, that can give a receiver no more than this share of `even_illuminance` are not
        looked for there.

    Returns
    -------
    (r,) float [lx]
    """
    if not sources or not len(points):
        return np.zeros(len(points))
    horizon = HalfSpace(np.asarray(normal, float), float(np.asarray(normal) @ points[0]))
    # one in the receivers' own plane too: it comes into view by way of others
    mirrors = [o for o, material in enumerate(outlines.materials) if material.is_specular]
    least = faint * even_illuminance(outlines, sources)
    points = np.asarray(points, float)
    unseen = outlines.unseen_backs(points, horizon.normal)
    view = _SourceView(outlines, unseen, _coplanar(sources, outlines), mirrors, limits, least, checkpoint)
    return view.illuminance(_Leg(points, horizon, None, None, (), (), 1.0, None, 0))


def even_illuminance(outlines: Outlines, sources: list[Source]) -> float:
    """What the sources' flux would be, spread over all surfaces [lx]."""
    flux = sum(source.exitance * float(polygons.areas(source.polygon)) for source in sources)
    return flux / max(float(polygons.areas(outlines.vertices).sum()), 1e-300)


@dataclass(frozen=True, eq=False)
class _Coplanar:
    """Sources of one plane and side.

    Attributes
    ----------
    plane : HalfSpace
        Before it they are seen.
    polygons : (s, v, 3) float, padded
    exitance : (s,) float
    """

    plane: HalfSpace
    polygons: np.ndarray
    exitance: np.ndarray

    @cached_property
    def spheres(self) -> tuple[np.ndarray, np.ndarray]:
        """Centres (s, 3) and radii (s,) of spheres around the sources."""
        centres = self.polygons.mean(axis=1)
        return centres, np.linalg.norm(self.polygons - centres[:, None], axis=2).max(axis=1)

    @cached_property
    def fluxes(self) -> np.ndarray:
        """(s,) float [lm]."""
        return self.exitance * polygons.areas(self.polygons)

    def most(self, points, height) -> np.ndarray:
        """(r, s) float: no less than what points at a height before the plane get [lx]."""
        centres, radii = self.spheres
        height = height[:, None]
        near = np.maximum(np.linalg.norm(points[:, None] - centres, axis=2) - radii, height)
        return np.minimum(self.fluxes * (height / near) / (np.pi * near**2), self.exitance)

    @cached_property
    def brightest(self) -> float:
        """No less than the exitance at any one place, where sources lie on one another."""
        across = polygons.plane_basis(self.plane.normal)
        flat = self.polygons @ across.T
        low, high = flat.min(axis=1), flat.max(axis=1)
        meet = (np.minimum(high[:, None], high) > np.maximum(low[:, None], low)).all(axis=2)
        return float((meet @ self.exitance).max())


def _coplanar(sources: list[Source], outlines: Outlines) -> list[_Coplanar]:
    groups: list[tuple[HalfSpace, list[Source]]] = []
    for source in sources:
        normal, offset = source.plane
        for plane, members in groups:
            alike = plane.normal @ normal > 1 - 1e-12 and abs(plane.offset - offset) <= outlines.tolerance
            if alike and len(members) < _TOGETHER:
                members.append(source)
                break
        else:
            groups.append((HalfSpace(normal, offset), [source]))
    return [
        _Coplanar(plane, polygons.pad([s.polygon for s in members])[0], np.array([s.exitance for s in members]))
        for plane, members in groups
    ]


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
    opening : (r,) float or None
        Form factor to the window.
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
    opening: np.ndarray | None
    mirrors: tuple[Mirrored, ...]
    screens: tuple[Screen, ...]
    throughput: float
    beyond: HalfSpace | None
    depth: int

    @property
    def limits(self) -> list[HalfSpace]:
        """What all that is seen lies within."""
        return [self.horizon] if self.beyond is None else [self.horizon, self.beyond]

    def clipped(self, shapes) -> np.ndarray:
        """(s, u, 3) float: parts of polygons ``(s, v, 3)`` within the limits."""
        for half in self.limits:
            shapes = polygons.clip(shapes, half.normal, half.offset)
        return shapes

    def seen(self, rows, which, shapes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of pairs of a row and one of some polygons, those where it is seen through the window.

        Parameters
        ----------
        rows, which : (n,) int
        shapes : (s, v, 3) float

        Returns
        -------
        rows, which : (m,) int
        seen : (m, u, 3) float
            Relative to the receivers.
        """
        if not len(rows):
            return rows, which, np.zeros((0, 1, 3))
        shape = shapes[which] - self.points[rows][:, None]
        if self.window is not None:
            shape = within_cones(shape, self.window[rows])
        some = _has_area(shape)
        return rows[some], which[some], shape[some]


@dataclass(frozen=True, eq=False)
class _SourceView:
    """Sources as receivers of one plane see them, straight and in mirrors.

    Attributes
    ----------
    unseen_backs : (o,) bool
        Outlines that nobody need look for who is behind them.
    least : float
        What gives no more is not looked for [lx].
    """

    outlines: Outlines
    unseen_backs: np.ndarray
    groups: list[_Coplanar]
    mirrors: list[int]
    limits: ChainLimits
    least: float
    checkpoint: Callable[[], None]

    @cached_property
    def brightest(self) -> float:
        """No less than the exitance that is seen along any one direction, all mirrors on the way together."""
        planes = [group.brightest for group in self.groups]
        mixed = any(
            (m.is_specular or m.is_transparent) and (m.diffuse_reflectance > 0 or m.exitance > 0)
            for m in self.outlines.materials
        )
        return (1 + self.limits.exact_mirrors) * sum(planes) if mixed else max(planes)

    def illuminance(self, leg: _Leg) -> np.ndarray:
        """(r,) float: light that comes past the leg's screens, and by any further mirror [lx]."""
        total = np.zeros(len(leg.points))
        for group in self.groups:
            self.checkpoint()
            self._add_sources(leg, group, total)
        if leg.depth < self.limits.exact_mirrors:
            for mirror in self.mirrors:
                self._add_mirrored(leg, mirror, total)
        return total

    def _add_sources(self, leg: _Leg, group: _Coplanar, total: np.ndarray) -> None:
        outlines, tolerance, plane = self.outlines, self.outlines.tolerance, group.plane
        height = leg.points @ plane.normal - plane.offset
        rows = np.flatnonzero(height > tolerance)
        bright = np.ones((len(rows), len(group.exitance)), bool)
        if leg.opening is not None:
            bright = leg.throughput * group.most(leg.points[rows], height[rows]) > self.least
            bright &= leg.throughput * leg.opening[rows, None] * group.exitance > self.least
        if not bright.any():
            return
        visible = leg.clipped(group.polygons)
        row, which = np.nonzero(bright & (polygons.areas(visible) > tolerance**2))
        row, which, shape = leg.seen(rows[row], which, visible)
        if not len(row):
            return
        rows, place = np.unique(row, return_inverse=True)
        target = visible[np.unique(which)].reshape(-1, 3)
        between = _between(outlines, self.unseen_backs, leg.points[rows], target, [plane, *leg.limits])
        screens = [*leg.screens, *(Screen(polygon, o) for o, polygon in between)]
        total[rows] += _light_past(
            outlines,
            _Shapes(place.reshape(-1), shape, group.exitance[which]),
            leg.points[rows],
            leg.horizon.normal,
            screens,
            leg.mirrors,
        )

    def _add_mirrored(self, leg: _Leg, mirror: int, total: np.ndarray) -> None:
        outlines, tolerance = self.outlines, self.outlines.tolerance
        material = outlines.materials[mirror]
        throughput = leg.throughput * float(material.specular_at(np.linspace(0.05, 1.0, 8)).max())
        outline = outlines.vertices[mirror]
        if throughput < self.limits.cutoff:
            return
        if leg.beyond is not None and not _above(outline[None], leg.beyond, tolerance)[0]:
            return  # the mirror just used, or one in its plane
        aperture = leg.clipped(outline[None])
        if polygons.areas(aperture)[0] <= tolerance**2:
            return
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        both = outlines.two_sided[mirror] or material.reflects_both_sides
        for side in (1.0, -1.0) if both else (1.0,):
            ahead = HalfSpace(side * normal, side * offset)
            rows = np.flatnonzero(leg.points @ ahead.normal - ahead.offset > tolerance)
            if not len(rows) or not any(_above(g.polygons, ahead, tolerance).any() for g in self.groups):
                continue
            rows, _, window = leg.seen(rows, np.zeros(len(rows), np.int64), aperture)
            opening = np.abs(polygons.lambert_form_factor(window, leg.horizon.normal))
            bright = throughput * self.brightest * opening > self.least
            if not bright.any():
                continue
            rows, window, opening = rows[bright], window[bright], opening[bright]
            between = _between(
                outlines, self.unseen_backs, leg.points[rows], aperture[0], [ahead, *leg.limits], skip=mirror
            )
            screens = [*leg.screens, *(Screen(polygon, o) for o, polygon in between)]
            passed = [Mirrored(m.material, reflect(m.normal, normal)) for m in leg.mirrors]
            total[rows] += self.illuminance(
                _Leg(
                    reflect_points(leg.points[rows], normal, offset),
                    leg.horizon.reflected(normal, offset),
                    reflect(window, normal),
                    opening,
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


def _between(outlines: Outlines, unseen_backs, points, target, half_spaces: list[HalfSpace], skip: int = -1):
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
    apart &= ~unseen_backs[index] | (near.max(axis=0) > tolerance)  # who is behind a solid's side is behind others
    kept = index[apart]
    parts = outlines.vertices[kept]
    for half in half_spaces:
        parts = polygons.clip(parts, half.normal, half.offset)
    wide = polygons.areas(parts) > tolerance**2
    return list(zip(kept[wide].tolist(), parts[wide], strict=True))


@dataclass(frozen=True, eq=False)
class _Shapes:
    """What is left of bright polygons.

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

    def take(self, index) -> _Shapes:
        """Some of the polygons."""
        return _Shapes(self.row[index], self.shape[index], self.weight[index])

    @classmethod
    def joined(cls, parts: list[_Shapes]) -> _Shapes:
        """All polygons in one."""
        parts = [p for p in parts if len(p.row)] or parts[:1]
        return cls(
            np.concatenate([p.row for p in parts]),
            polygons.joined([p.shape for p in parts]),
            np.concatenate([p.weight for p in parts]),
        )


def _light_past(outlines: Outlines, shapes: _Shapes, points, normal, screens: list[Screen], mirrors) -> np.ndarray:
    """(r,) float: illuminance by what is seen of polygons past screens, as mirrors reflect it [lx]."""
    for screen in screens:
        planes, edges, facing = _edge_cones(screen.polygon[None] - points[:, None])
        height = np.matmul(shapes.shape, planes.transpose(0, 2, 1)[shapes.row])
        reach = np.abs(shapes.shape).max(axis=(1, 2))
        overlaps = ((height.max(axis=1) > 1e-12 * reach[:, None]) | ~edges[shapes.row]).all(axis=1)
        overlaps &= facing[shapes.row] != 0
        if overlaps.any():
            behind = _past_screen(outlines, screen, shapes.take(overlaps), planes, edges)
            shapes = _Shapes.joined([shapes.take(~overlaps), *behind])
        if not len(shapes.row):
            return np.zeros(len(points))
    centre = shapes.shape.mean(axis=1)
    weight = shapes.weight
    for mirror in mirrors:
        weight = weight * mirror.share(centre)
    factor = np.maximum(polygons.lambert_form_factor(shapes.shape, normal), 0.0)
    return np.bincount(shapes.row, weights=weight * factor, minlength=len(points))


def _past_screen(outlines: Outlines, screen: Screen, shapes: _Shapes, planes, edges) -> list[_Shapes]:
    """Polygons less a screen's cone; behind a pane they are kept, dimmed."""
    kept = []
    material = outlines.materials[screen.outline]
    for e in range(planes.shape[1]):
        if not len(shapes.row):
            break
        wall, edge = planes[shapes.row, e], edges[shapes.row, e]
        outside = _Shapes(shapes.row, polygons.clip(shapes.shape, -wall), shapes.weight)
        kept.append(outside.take(edge & _has_area(outside.shape)))
        inside = polygons.clip(shapes.shape, wall)
        inside = inside if edge.all() else _choose(edge, inside, shapes.shape)
        shapes = _Shapes(shapes.row, inside, shapes.weight).take(_has_area(inside))
    if material.is_transparent:
        plane = polygons.newell_normal(screen.polygon)
        centre = shapes.shape.mean(axis=1)
        length = np.linalg.norm(centre, axis=1) * np.linalg.norm(plane)
        through = material.transmittance_at((centre @ plane) / np.maximum(length, 1e-300))
        kept.append(_Shapes(shapes.row, shapes.shape, shapes.weight * through))
    return kept


def _choose(which, one, other):
    width = max(one.shape[1], other.shape[1])
    return np.where(which[:, None, None], polygons.widen(one, width), polygons.widen(other, width))


def _has_area(shapes) -> np.ndarray:
    """Whether clipped polygons, relative to their receivers, still span a solid angle."""
    if not len(shapes):
        return np.zeros(0, bool)
    twice = np.linalg.norm(polygons.newell_normal(shapes), axis=1)
    return twice > 1e-20 * np.maximum(np.abs(shapes).max(axis=(1, 2)), 1e-300) ** 2
