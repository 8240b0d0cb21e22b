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
from .blockers import Blockers, Shapes, above, between, has_area, light_past, within_cones
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
class Mirrored:
    """A mirror on the way: its material, and its normal in the receivers' mirrored space."""

    material: Material
    normal: np.ndarray

    def share(self, directions) -> np.ndarray:
        """(n,) float: specular reflectance for light along directions ``(n, 3)`` of any length."""
        length = np.maximum(np.linalg.norm(directions, axis=1), 1e-300)
        return self.material.specular_at((directions @ self.normal) / length)

    @property
    def varies(self) -> bool:
        """Whether its reflectance changes with the angle."""
        return self.material.refractive_index is not None


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
    return view.illuminance(_Leg(points, horizon, None, None, (), Blockers.none(), 1.0, None, 0))


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
    blockers : Blockers
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
    blockers: Blockers
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
        if self.window is None:
            return rows, which, shape
        shape = within_cones(shape, self.window[rows])
        some = has_area(shape)
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
        """(r,) float: light that comes past the leg's blockers, and by any further mirror [lx]."""
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
        (rows, place), (used, which_used) = (np.unique(n, return_inverse=True) for n in (row, which))
        points, shapes = leg.points[rows], visible[used]
        blockers = leg.blockers.joined(between(outlines, self.unseen_backs, points, shapes, [plane, *leg.limits]))
        total[rows] += light_past(
            outlines,
            blockers,
            Shapes(place.reshape(-1), shape, group.exitance[which]),
            (shapes, which_used.reshape(-1)),
            points,
            leg.horizon.normal,
            leg.mirrors,
        )

    def _add_mirrored(self, leg: _Leg, mirror: int, total: np.ndarray) -> None:
        outlines, tolerance = self.outlines, self.outlines.tolerance
        material = outlines.materials[mirror]
        throughput = leg.throughput * float(material.specular_at(np.linspace(0.05, 1.0, 8)).max())
        outline = outlines.vertices[mirror]
        if throughput < self.limits.cutoff:
            return
        if leg.beyond is not None and not above(outline[None], leg.beyond, tolerance)[0]:
            return  # the mirror just used, or one in its plane
        aperture = leg.clipped(outline[None])
        if polygons.areas(aperture)[0] <= tolerance**2:
            return
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        both = outlines.two_sided[mirror] or material.reflects_both_sides
        for side in (1.0, -1.0) if both else (1.0,):
            ahead = HalfSpace(side * normal, side * offset)
            rows = np.flatnonzero(leg.points @ ahead.normal - ahead.offset > tolerance)
            if not len(rows) or not any(above(g.polygons, ahead, tolerance).any() for g in self.groups):
                continue
            rows, _, window = leg.seen(rows, np.zeros(len(rows), np.int64), aperture)
            opening = np.abs(polygons.lambert_form_factor(window, leg.horizon.normal))
            bright = throughput * self.brightest * opening > self.least
            if not bright.any():
                continue
            rows, window, opening = rows[bright], window[bright], opening[bright]
            there = between(outlines, self.unseen_backs, leg.points[rows], aperture, [ahead, *leg.limits], skip=mirror)
            passed = [Mirrored(m.material, reflect(m.normal, normal)) for m in leg.mirrors]
            total[rows] += self.illuminance(
                _Leg(
                    reflect_points(leg.points[rows], normal, offset),
                    leg.horizon.reflected(normal, offset),
                    reflect(window, normal),
                    opening,
                    (*passed, Mirrored(material, normal)),
                    leg.blockers.joined(there).reflected(normal, offset),
                    throughput,
                    ahead,
                    leg.depth + 1,
                )
            )
