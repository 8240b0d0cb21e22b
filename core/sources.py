"""Bright polygons as receivers see them, straight and in mirrors, gathered exactly by Lambert's formula.

A small bright polygon is seen by few parcels or none. So its light is found without the globe: what a receiver sees
of the polygon is the polygon less the outlines in between, clipped exactly; in mirrors it is the same in the
mirrored scene, inside the mirror's outline.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from threading import Lock

import numpy as np

from . import polygons
from .arrays import pick
from .blockers import Blockers, Places, above, between, frame
from .bright import FAINT, Bright, Source
from .materials import Material
from .outlines import Outlines
from .pieces import SeenShapes, Windows, tightened
from .projection import HalfSpace, reflect, reflect_points
from .received import Received
from .standing import Receivers, Standing, in_order, light_past
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
    view.add(points, np.zeros(len(points), int), np.arange(len(points)), received, checkpoint)
    return received.illuminance()


@dataclass(frozen=True, eq=False)
class _Path:
    """A way on which receivers of some planes look: straight on, or by some mirrors.

    Attributes
    ----------
    bright : Bright
    corners : (p, c, 3) float
        Between which the receivers of each plane lie, or their images.
    horizons : (p, 3) float
        Normals of the receivers' own planes, mirrored likewise.
    levels : (p,) float
        Offsets of these planes.
    beyond : HalfSpace or None
        Behind the last mirror, where they look.
    mirrors : tuple of Mirrored
    blockers : Blockers
        What lies on the way so far.
    at : (k,) int, ascending
        From which of the planes.
    throughput : float
        Largest product of the reflectances so far.
    depth : int
        Mirrors so far.
    lock : Lock
        One thread looks on, others wait: what they share is never seen half made.
    """

    bright: Bright
    corners: np.ndarray
    horizons: np.ndarray
    levels: np.ndarray
    beyond: HalfSpace | None
    mirrors: tuple[Mirrored, ...]
    blockers: Blockers
    at: np.ndarray
    throughput: float
    depth: int
    lock: Lock = field(default_factory=Lock)
    _sources: dict[int, Standing] = field(default_factory=dict)
    _apertures: dict[int, _Apertures] = field(default_factory=dict)
    _mirrored: dict[tuple[int, float], _Path] = field(default_factory=dict)

    @cached_property
    def places(self) -> Places:
        """Where receivers are, and what all that they see lies within."""
        limits = [(self.horizons, self.levels)]
        if self.beyond is not None:
            count = len(self.levels)
            limits.append((np.tile(self.beyond.normal, (count, 1)), np.full(count, self.beyond.offset)))
        return Places(self.corners, limits)

    def sources(self, number: int) -> Standing:
        """What of a group's sources may be seen, and what may stand before them."""
        with self.lock:
            if number not in self._sources:
                shining = self.bright.groups[number].shining
                self._sources[number] = shining.standing(self.places, self.blockers, self.at)
        return self._sources[number]

    def aperture(self, mirror: int) -> _Apertures:
        """What of a mirror may be seen."""
        if mirror not in self._apertures:
            outlines, count = self.bright.outlines, len(self.levels)
            found, place = outlines.vertices[[mirror] * count], np.arange(count)
            if self.beyond is not None and not above(found[:1], self.beyond, outlines.tolerance)[0]:
                found, place = found[:0], place[:0]  # the mirror just used, or one in its plane
            found = self.places.cut(found, place)
            wide = np.flatnonzero(polygons.areas(found) > outlines.tolerance**2)
            number = np.full(count, -1)
            number[place[wide]] = np.arange(len(wide))
            self._apertures[mirror] = _Apertures(tightened(found[wide])[0], place[wide], number)
        return self._apertures[mirror]

    def mirrored(self, mirror: int, ahead: HalfSpace, throughput: float) -> _Path:
        """The way on by one more mirror."""
        key = mirror, float(ahead.normal @ self.bright.outlines.normals[mirror])
        with self.lock:
            if key not in self._mirrored:
                self._mirrored[key] = self._by(mirror, ahead, throughput)
        return self._mirrored[key]

    def _by(self, mirror: int, ahead: HalfSpace, throughput: float) -> _Path:
        outlines, aperture = self.bright.outlines, self.aperture(mirror)
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        before = (self.corners @ ahead.normal - ahead.offset > outlines.tolerance).any(axis=1)[aperture.place]
        place = aperture.place[before]
        limits = [(np.tile(ahead.normal, (len(place), 1)), np.full(len(place), ahead.offset))]
        places = self.places.take(place)
        places = replace(places, limits=limits + places.limits)
        there, at = between(outlines, places, aperture.shapes[before], mirror)
        blockers, at = in_order(self.blockers, self.at, there, place[at])
        passed = [Mirrored(m.material, reflect(m.normal, normal)) for m in self.mirrors]
        horizons = reflect(self.horizons, normal)
        origins = reflect_points(self.horizons * self.levels[:, None], normal, offset)
        return _Path(
            self.bright,
            reflect_points(self.corners, normal, offset),
            horizons,
            np.einsum("pc,pc->p", horizons, origins),
            ahead,
            (*passed, Mirrored(outlines.materials[mirror], normal)),
            blockers.reflected(normal, offset),
            at,
            throughput,
            self.depth + 1,
        )


@dataclass(frozen=True, eq=False)
class _Apertures:
    """What receivers of some planes may see of a mirror.

    Attributes
    ----------
    shapes : (m, v, 3) float, padded
    place : (m,) int
        Whose each is.
    number : (p,) int
        Which of the shapes is whose; -1: none.
    """

    shapes: np.ndarray
    place: np.ndarray
    number: np.ndarray


@dataclass(frozen=True, eq=False)
class _Leg(Receivers):
    """Where receivers look from on a path: themselves, or their image after some mirrors.

    Attributes
    ----------
    window : (r, v, 3) float or None
        What each receiver sees of the last mirror through all before it, relative to the receiver.
    opening : (r,) float or None
        Form factor to the window.
    """

    window: np.ndarray | None = None
    opening: np.ndarray | None = None

    @cached_property
    def windows(self) -> Windows | None:
        """The windows."""
        return None if self.window is None else Windows.of(self.window)

    def seen(self, row, which, corners, weight) -> SeenShapes:
        """Of pairs ``(n,)`` of a row and one of some polygons ``(3, v, s)``, those where anything is seen of it."""
        return SeenShapes.of(row, which, corners, self.places, weight, self.windows)


@dataclass(frozen=True, eq=False)
class SourceView:
    """Sources as receivers of some planes see them, straight and in mirrors: what is found once for all of these.

    Attributes
    ----------
    bright : Bright
    straight : _Path
    """

    bright: Bright
    straight: _Path

    @classmethod
    def of(cls, bright: Bright, planes: list[tuple[np.ndarray, np.ndarray]]) -> list[SourceView]:
        """From receivers of planes: four corners (4, 3) that these lie between, and a normal; some planes in each."""
        found = []
        together = max(1, _PAIRS // max(1, len(bright.sources) * len(bright.outlines.vertices)))
        for first in range(0, len(planes), together):
            some = planes[first : first + together]
            corners, normals = np.stack([corners for corners, _ in some]), np.stack([normal for _, normal in some])
            levels = np.einsum("pc,pc->p", normals, corners[:, 0])
            none = Blockers.none()
            found.append(cls(bright, _Path(bright, corners, normals, levels, None, (), none, none.plane, 1.0, 0)))
        return found

    @property
    def planes(self) -> int:
        """How many there are."""
        return len(self.straight.levels)

    def add(self, points, place, rows, received: Received, checkpoint: Callable[[], None] = lambda: None) -> None:
        """Enter what receivers ``(r, 3)`` of planes ``(r,)``, ascending, see, as that of ``rows`` (r,)."""
        leg = _Leg(points, rows, place, self.straight.horizons)
        outlines = self.bright.outlines
        unseen = np.zeros((self.planes, len(outlines.vertices)), bool)
        if outlines.solids is not None:
            for number in np.unique(place).tolist():
                unseen[number] = outlines.unseen_backs(points[leg.of(number)], leg.horizons[number])
        self._add_all(self.straight, leg, unseen, received, checkpoint)

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
        standing = path.sources(number)
        which, row = leg.with_each(standing.place)
        if not len(which):
            return
        source = standing.source[which]
        height = pick(group.heights(leg.points), standing.plane[which], row)
        before = height > outlines.tolerance
        if leg.opening is not None:
            before &= path.throughput * leg.opening[row] * group.exitance[source] > least
        bright = np.flatnonzero(before)
        if leg.opening is not None:
            most = group.most(source[bright], leg.points[row[bright]], height[bright])
            bright = bright[path.throughput * most > least]
        if not len(bright):
            return
        which, row, source = which[bright], row[bright], source[bright]
        seen = leg.seen(row, which, standing.corners, group.exitance[source])
        if len(seen.row):
            light_past(outlines, standing, unseen, seen, leg, path.mirrors, path.throughput, received)

    def _add_mirrored(self, path: _Path, leg: _Leg, mirror: int, unseen, received: Received, checkpoint) -> None:
        outlines, tolerance = self.bright.outlines, self.bright.outlines.tolerance
        material = outlines.materials[mirror]
        throughput = path.throughput * self.bright.mirrors[mirror]
        if throughput < self.bright.limits.cutoff:
            return
        aperture = path.aperture(mirror)
        if not len(aperture.shapes):
            return
        normal, offset = outlines.normals[mirror], float(outlines.offsets[mirror])
        both = outlines.two_sided[mirror] or material.reflects_both_sides
        there = aperture.number[leg.place]
        for side in (1.0, -1.0) if both else (1.0,):
            ahead = HalfSpace(side * normal, side * offset)
            rows = np.flatnonzero((leg.points @ ahead.normal - ahead.offset > tolerance) & (there >= 0))
            if not len(rows) or not any(above(g.polygons, ahead, tolerance).any() for g in self.bright.groups):
                continue
            seen, _ = leg.seen(rows, there[rows], aperture.shapes.transpose(2, 1, 0), np.ones(len(rows))).made()
            opening = np.abs(whole_form_factors(seen.shape, leg.normals.take(seen.row, axis=1)))
            bright = np.flatnonzero(throughput * self.bright.brightest * opening > self.bright.least)
            if not len(bright):
                continue
            bright = bright[np.argsort(seen.row[bright])]
            seen, way = seen.take(bright), path.mirrored(mirror, ahead, throughput)
            further = _Leg(
                reflect_points(leg.points[seen.row], normal, offset),
                leg.rows[seen.row],
                leg.place[seen.row],
                way.horizons,
                reflect(seen.shape.transpose(2, 1, 0), normal),
                opening[bright],
            )
            self._add_all(way, further, unseen, received, checkpoint)
