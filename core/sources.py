"""Bright polygons as receivers see them, straight and in mirrors, gathered exactly by Lambert's formula.

A small bright polygon is seen by few parcels or none. So its light is found without the globe: what a receiver sees
of the polygon is the polygon less the outlines in between, clipped exactly; in mirrors it is the same in the
mirrored scene, inside the mirror's outline.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock

import numpy as np

from . import polygons
from .blockers import Blockers, above, between, frame
from .bright import FAINT, Bright, Source
from .materials import Material
from .outlines import Outlines
from .pieces import SeenShapes, Windows, tightened
from .projection import HalfSpace, reflect, reflect_points
from .received import Received
from .standing import Places, Standing, light_past
from .tracing import ChainLimits
from .unhidden import whole_form_factors

_PAIRS = 100_000
"""Sources times outlines, times receivers' planes, that are looked at together."""


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
    faint: float = FAINT,
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
    points = np.asarray(points, float)
    received = Received(len(points), outlines.tolerance)
    normal = np.asarray(normal, float)
    (view,) = SourceView.of(Bright(outlines, sources, limits, faint), [(frame(points, normal), normal)])
    view.add(points, np.arange(len(points)), received, checkpoint)
    return received.illuminance()


@dataclass(frozen=True, eq=False)
class _Family:
    """Ways of receivers of several planes by the same mirrors: one thread looks, and from all of them."""

    paths: list[_Path] = field(default_factory=list)
    lock: Lock = field(default_factory=Lock)


@dataclass(frozen=True, eq=False)
class _Path:
    """A way on which all receivers of a plane look: straight on, or by some mirrors.

    Attributes
    ----------
    bright : Bright
    corners : (c, 3) float
        Between which the receivers lie, or their images.
    horizon : HalfSpace
        Above the receivers' own plane, mirrored likewise.
    beyond : HalfSpace or None
        Behind the last mirror, where they look.
    mirrors : tuple of Mirrored
    blockers : Blockers
        What lies on the way so far.
    throughput : float
        Largest product of the reflectances so far.
    depth : int
        Mirrors so far.
    family : _Family
        This way, and those of receivers of other planes.
    """

    bright: Bright
    corners: np.ndarray
    horizon: HalfSpace
    beyond: HalfSpace | None
    mirrors: tuple[Mirrored, ...]
    blockers: Blockers
    throughput: float
    depth: int
    family: _Family
    _sources: dict[int, tuple] = field(default_factory=dict)
    _apertures: dict[int, np.ndarray] = field(default_factory=dict)
    _mirrored: dict[tuple[int, float], _Path] = field(default_factory=dict)

    @property
    def limits(self) -> list[HalfSpace]:
        """What all that is seen lies within."""
        return [self.horizon] if self.beyond is None else [self.horizon, self.beyond]

    def clipped(self, shapes) -> np.ndarray:
        """(s, u, 3) float: parts of polygons ``(s, v, 3)`` within the limits."""
        for half in self.limits:
            shapes = polygons.clip(shapes, half.normal, half.offset)
        return shapes

    def sources(self, number: int) -> tuple[np.ndarray, Standing]:
        """Of a group: which of its sources may be seen (s,), what of them, and what may stand before them."""
        with self.family.lock:
            if number not in self._sources:
                paths = self.family.paths
                limits = [
                    (np.array([half.normal for half in halves]), np.array([half.offset for half in halves]))
                    for halves in zip(*(path.limits for path in paths), strict=True)
                ]
                places = Places(np.stack([path.corners for path in paths]), limits, [path.blockers for path in paths])
                found = self.bright.groups[number].shining.standing(places)
                for path, one in zip(paths, found, strict=True):
                    path._sources[number] = one
        return self._sources[number]

    def aperture(self, mirror: int) -> np.ndarray:
        """(n, u, 3) float: what of a mirror may be seen, one polygon or none."""
        found = self._apertures.get(mirror)
        if found is None:
            outlines = self.bright.outlines
            found = outlines.vertices[mirror][None]
            if self.beyond is not None and not above(found, self.beyond, outlines.tolerance)[0]:
                found = found[:0]  # the mirror just used, or one in its plane
            found = self.clipped(found)
            found = self._apertures[mirror] = tightened(found[polygons.areas(found) > outlines.tolerance**2])[0]
        return found

    def mirrored(self, mirror: int, ahead: HalfSpace, throughput: float) -> _Path:
        """The way on by one more mirror."""
        outlines = self.bright.outlines
        key = mirror, float(ahead.normal @ outlines.normals[mirror])
        with self.family.lock:
            if key not in self._mirrored:
                family = _Family()
                for path in self.family.paths:
                    aperture = path.aperture(mirror)
                    before = path.corners @ ahead.normal - ahead.offset > outlines.tolerance
                    if len(aperture) and before.any():
                        family.paths.append(path._by(mirror, ahead, aperture, throughput, family))
                        path._mirrored[key] = family.paths[-1]
        return self._mirrored[key]

    def _by(self, mirror: int, ahead: HalfSpace, aperture, throughput: float, family: _Family) -> _Path:
        outlines = self.bright.outlines
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        there = between(outlines, self.corners, aperture, [ahead, *self.limits], skip=mirror)
        passed = [Mirrored(m.material, reflect(m.normal, normal)) for m in self.mirrors]
        return _Path(
            self.bright,
            reflect_points(self.corners, normal, offset),
            self.horizon.reflected(normal, offset),
            ahead,
            (*passed, Mirrored(outlines.materials[mirror], normal)),
            self.blockers.joined(there).reflected(normal, offset),
            throughput,
            self.depth + 1,
            family,
        )


@dataclass(frozen=True, eq=False)
class _Leg:
    """Where receivers look from on a path: themselves, or their image after some mirrors.

    Attributes
    ----------
    points : (r, 3) float
    rows : (r,) int
        Numbers of the receivers.
    window : (r, v, 3) float or None
        What each receiver sees of the last mirror through all before it, relative to the receiver.
    opening : (r,) float or None
        Form factor to the window.
    """

    points: np.ndarray
    rows: np.ndarray
    window: np.ndarray | None = None
    opening: np.ndarray | None = None

    @cached_property
    def places(self) -> np.ndarray:
        """(3, r) float: the points."""
        return np.ascontiguousarray(self.points.T)

    @cached_property
    def windows(self) -> Windows | None:
        """The windows."""
        return None if self.window is None else Windows.of(self.window)

    def seen(self, row, which, corners, weight) -> SeenShapes:
        """Of pairs ``(n,)`` of a row and one of some polygons ``(3, v, s)``, those where anything is seen of it."""
        return SeenShapes.of(row, which, corners, self.places, weight, self.windows)


@dataclass(frozen=True, eq=False)
class SourceView:
    """Sources as receivers of one plane see them, straight and in mirrors: what is found once for all of these.

    Attributes
    ----------
    bright : Bright
    straight : _Path
    """

    bright: Bright
    straight: _Path

    @classmethod
    def of(cls, bright: Bright, planes: list[tuple[np.ndarray, np.ndarray]]) -> list[SourceView]:
        """From receivers of each of some planes: four corners (4, 3) that these lie between, and its normal."""
        found = []
        together = max(1, _PAIRS // max(1, len(bright.sources) * len(bright.outlines.vertices)))
        for first in range(0, len(planes), together):
            family = _Family()
            for corners, normal in planes[first : first + together]:
                horizon = HalfSpace(normal, float(normal @ corners[0]))
                family.paths.append(_Path(bright, corners, horizon, None, (), Blockers.none(), 1.0, 0, family))
            found += [cls(bright, path) for path in family.paths]
        return found

    def add(self, points, rows, received: Received, checkpoint: Callable[[], None] = lambda: None) -> None:
        """Enter what some of the receivers ``(r, 3)`` see, as that of ``rows`` (r,)."""
        unseen = self.bright.outlines.unseen_backs(points, self.straight.horizon.normal)
        self._add_all(self.straight, _Leg(points, rows), unseen, received, checkpoint)

    def _add_all(self, path: _Path, leg: _Leg, unseen, received: Received, checkpoint) -> None:
        """Enter light that comes past the path's blockers, and by any further mirror."""
        for number in range(len(self.bright.groups)):
            checkpoint()
            self._add_sources(path, leg, number, unseen, received)
        if path.depth < self.bright.limits.exact_mirrors:
            for mirror in self.bright.mirrors:
                self._add_mirrored(path, leg, mirror, unseen, received, checkpoint)

    def _add_sources(self, path: _Path, leg: _Leg, number: int, unseen, received: Received) -> None:
        least, group, outlines = self.bright.least, self.bright.groups[number], self.bright.outlines
        some, standing = path.sources(number)
        if not len(some):
            return
        height = group.heights(leg.points)
        bright = height[some] > outlines.tolerance
        if leg.opening is not None:
            bright &= path.throughput * group.most(leg.points, height)[some] > least
            bright &= path.throughput * leg.opening * group.exitance[some, None] > least
        which, row = np.nonzero(bright)
        if not len(row):
            return
        seen = leg.seen(row, which, standing.corners, group.exitance[some[which]])
        if len(seen.row):
            normal = path.horizon.normal
            on_way = path.mirrors, path.throughput
            light_past(outlines, standing, unseen, seen, leg.points, normal, *on_way, leg.rows, received)

    def _add_mirrored(self, path: _Path, leg: _Leg, mirror: int, unseen, received: Received, checkpoint) -> None:
        outlines, tolerance = self.bright.outlines, self.bright.outlines.tolerance
        material = outlines.materials[mirror]
        throughput = path.throughput * self.bright.mirrors[mirror]
        if throughput < self.bright.limits.cutoff:
            return
        aperture = path.aperture(mirror)
        if not len(aperture):
            return
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        both = outlines.two_sided[mirror] or material.reflects_both_sides
        for side in (1.0, -1.0) if both else (1.0,):
            ahead = HalfSpace(side * normal, side * offset)
            rows = np.flatnonzero(leg.points @ ahead.normal - ahead.offset > tolerance)
            if not len(rows) or not any(above(g.polygons, ahead, tolerance).any() for g in self.bright.groups):
                continue
            one = np.zeros(len(rows), np.int64)
            seen, _ = leg.seen(rows, one, aperture.transpose(2, 1, 0), np.ones(len(rows))).made()
            opening = np.abs(whole_form_factors(seen.shape, path.horizon.normal))
            bright = np.flatnonzero(throughput * self.bright.brightest * opening > self.bright.least)
            if not len(bright):
                continue
            seen = seen.take(bright)
            window = seen.shape.transpose(2, 1, 0)
            further = _Leg(
                reflect_points(leg.points[seen.row], normal, offset),
                leg.rows[seen.row],
                reflect(window, normal),
                opening[bright],
            )
            way = path.mirrored(mirror, ahead, throughput)
            self._add_all(way, further, unseen, received, checkpoint)
