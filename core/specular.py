"""Specular chains: what receivers see straight ahead, through clear panes and in mirrors, to any order.

Seen from the receivers of one plane a planar mirror is a window into the mirrored scene. So the receivers are
mirrored once, and the reflected directions are again shared by all of them; nothing of position or direction is
rounded. Chains go on until the product of reflectances falls below a cut-off; what is cut is booked, not forgotten.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields, replace
from functools import cached_property

import numpy as np

from .arrays import dots, pick
from .globe import Hemisphere
from .materials import Material
from .projection import Beams, HalfSpace, Obstacles, edge_planes, obstacles_within, reflect, reflect_points
from .rays import Flight, RayScene
from .solids import Solids
from .visibility import SHARED, Partial, View, look

DEEPEST_CHAIN = 200
"""No chain is followed further, even between perfect mirrors."""

MANY_OUTLINES = 2_500
"""Scenes of more outlines are looked at ray by ray."""

_FEW_BEAMS = 5_000
"""Fewer are followed one by one, after two mirrors or panes, without regard to edges that cross them."""

_LOOKED_INTO = 4
"""So are all after more mirrors or panes than this, which show little light each."""

_MOST_IMAGES = 80
_DEEPEST_IMAGE = 40
_WALLS_OF_BOX = 6

_WINDOWS = 2
"""Earlier mirrors whose edges bound what beams show in part."""

_WITHIN = 4e-5
"""Angle from a mirror's edge that centres of parts keep [rad], so that nothing that stands at the edge is before it."""


@dataclass(frozen=True, eq=False)
class Outlines:
    """The scene's convex outlines with what light does at them.

    Attributes
    ----------
    vertices : (o, w, 3) float, padded
    normals : (o, 3) float
    offsets : (o,) float
    materials : list of Material, one per outline
    two_sided : (o,) bool
    tolerance : float
        Length below which points count as lying on a plane [m].
    solids : Solids, optional
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    materials: list[Material]
    two_sided: np.ndarray
    tolerance: float
    solids: Solids | None = None

    @cached_property
    def rays(self) -> RayScene:
        """The outlines, to shoot single rays at."""
        return RayScene(self.vertices, self.normals, self.offsets, self.tolerance)

    @cached_property
    def plain_mirrors(self) -> np.ndarray:
        """(2, o) float: reflectance of fronts and backs that do nothing but mirror, 0 for all others."""
        plain = np.zeros((2, len(self.materials)))
        for o, m in enumerate(self.materials):
            if m.refractive_index is None and not (m.is_transparent or m.diffuse_reflectance or m.exitance):
                plain[0, o] = m.specular_reflectance
                plain[1, o] = m.specular_reflectance if self.two_sided[o] else 0.0
        return plain

    @cached_property
    def whole(self) -> Obstacles:
        """All outlines, uncut, as obstacles."""
        bounding = np.ones(self.vertices.shape[:2], bool)
        return Obstacles(np.arange(len(self.vertices)), self.vertices, bounding, self.normals, self.offsets)

    @cached_property
    def back_counts(self) -> np.ndarray:
        """(o,) bool: whether light on the back goes anywhere, onto a receiver or on by a mirror."""
        return self.two_sided | np.array([m.reflects_both_sides for m in self.materials], bool)

    def unseen_backs(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """(o,) bool: outlines whose backs none of some receivers of one plane ``(r, 3)`` can see."""
        if self.solids is None:
            return np.zeros(len(self.vertices), bool)
        return self.solids.unseen_backs(points, normal)

    @cached_property
    def any_specular(self) -> bool:
        """Whether any surface mirrors or transmits regularly."""
        return any(m.is_specular or m.is_transparent for m in self.materials)


@dataclass(frozen=True, eq=False)
class Sighting:
    """One step of what a group of receivers sees.

    Attributes
    ----------
    rows : (r,) int
        Receivers of the group that this sighting is for.
    points : (r, 3) float
        Where they look from: themselves, or their mirror image.
    normal : (3,) float
        Their plane's normal, mirrored likewise.
    beams : Beams
    obstacles : Obstacles
    view : View
    weights : (r, k) float
        Cosine weight of each beam times the reflectances and transmittances on the way here; 0 where the beam did
        not come.
    mirrors : int
        How many mirrors were on the way; for single rays one number stands for all of a kind, see `ChainLimits.kind`.
    outlines : Outlines
    partial : Partial or None
        Beams of which only a part came here.
    rays : bool
        Whether each row is a single ray, wholly described by one part.
    """

    rows: np.ndarray
    points: np.ndarray
    normal: np.ndarray
    beams: Beams
    obstacles: Obstacles
    view: View
    weights: np.ndarray
    mirrors: int
    outlines: Outlines
    partial: Partial | None = None
    rays: bool = False

    def dead_share(self, obstacle: int, back: bool) -> float:
        """Share of the light that is lost on an obstacle's side because that side is no receiver."""
        o = self.obstacles.outlines[obstacle]
        if not back or self.outlines.two_sided[o]:
            return 0.0
        material = self.outlines.materials[o]
        return material.hemispherical_absorptance if material.is_transparent else 1.0

    def part_weights(self) -> np.ndarray:
        """(p,) float: weight of each part of a shared beam, with the cosine at the part's own centre."""
        v = self.view
        if self.rays:
            return self.weights[:, 0]
        return pick(self.weights, v.part_row, v.part_beam) * v.part_share


@dataclass
class ChainLimits:
    """When to stop following a chain.

    Attributes
    ----------
    cutoff : float
        Smallest product of reflectances and transmittances that is still followed.
    exact_mirrors : int
        Up to this many mirrors on the way, bright polygons are gathered exactly (see `sources`).
    """

    cutoff: float = 1e-3
    exact_mirrors: int = 0

    def kind(self, mirrors: np.ndarray) -> np.ndarray:
        """0, 1 or the first number beyond `exact_mirrors`: what sightings that share a treatment are known by."""
        return np.where(mirrors > self.exact_mirrors, self.exact_mirrors + 1, np.minimum(mirrors, 1))


def exact_mirrors(outlines: Outlines) -> int:
    """How many mirrors on the way leave images few enough to be looked for one by one.

    Between n mirrors there are at most n (n − 1)^(k − 1) images of order k; between up to six, which will mostly be
    walls of a box that meet at right angles, about 4 k² + 2.
    """
    n = sum(m.is_specular for m in outlines.materials)
    images, order = 0, 0
    while order < _DEEPEST_IMAGE:
        every = n * max(n - 1, 1) ** order
        images += min(every, 4 * (order + 1) ** 2 + 2) if n <= _WALLS_OF_BOX else every
        if order and images > _MOST_IMAGES:
            break
        order += 1
    return order


@dataclass(frozen=True, eq=False)
class _Arriving:
    """What of the beams reaches a mirror or pane.

    Attributes
    ----------
    rows, columns : (r,) and (k,) int
        Receivers and beams.
    weights : (r, k) float
    row, beam : (n,) int
        Beams that arrive in part, as indices into ``rows`` and ``columns``.
    direction : (n, 3) float
        Towards the part's centre.
    cosine : (k,) float
        Of each beam with the outline's normal.
    kept : (k,) int
        Which of the columns of what this was taken from are left.
    """

    rows: np.ndarray
    columns: np.ndarray
    weights: np.ndarray
    row: np.ndarray
    beam: np.ndarray
    direction: np.ndarray
    cosine: np.ndarray
    kept: np.ndarray

    @classmethod
    def at(cls, s: Sighting, k: int, parts, outlines: Outlines) -> _Arriving | None:
        """What arrives at obstacle k of a sighting."""
        view = s.view
        mine = np.flatnonzero((view.part_seen == k) & (parts > 0))
        beams = view.part_beam[mine]
        columns = np.union1d(view.columns.get(k, beams[:0]), beams)
        if not len(columns):
            return None
        weights = np.where(view.seen[:, columns] == k, s.weights[:, columns], 0.0)
        row, beam = view.part_row[mine], np.searchsorted(columns, beams)
        weights[row, beam] = parts[mine]
        towards = view.part_direction[mine]
        way = (view.heights[row, k] / (towards @ s.obstacles.normals[k]))[:, None] * towards
        # centres are good to first order only: where edges meet, one may lie beside what it is the centre of
        places = outlines.rays.pulled_inside(
            int(s.obstacles.outlines[k]), s.points[row] + way, _WITHIN * np.linalg.norm(way, axis=1)
        )
        direction = places - s.points[row]
        cosine = s.beams.directions[columns] @ s.obstacles.normals[k]
        every = np.arange(len(view.seen))
        return cls(every, columns, weights, row, beam, direction, cosine, np.arange(len(columns)))

    def weighted(self, share: np.ndarray) -> _Arriving | None:
        """What is left of it after shares ``(r, k)``; None where nothing is."""
        weights = self.weights * share
        rows, columns = np.flatnonzero(weights.any(axis=1)), np.flatnonzero(weights.any(axis=0))
        if not len(rows):
            return None
        mine = np.flatnonzero(weights[self.row, self.beam] > 0)
        return _Arriving(
            self.rows[rows],
            self.columns[columns],
            weights[np.ix_(rows, columns)],
            np.searchsorted(rows, self.row[mine]),
            np.searchsorted(columns, self.beam[mine]),
            self.direction[mine],
            self.cosine[columns],
            columns,
        )


@dataclass(frozen=True, eq=False)
class _Rays:
    """Single rays on their way: all arrays of length n."""

    rows: np.ndarray
    points: np.ndarray
    directions: np.ndarray
    weights: np.ndarray
    throughput: np.ndarray
    mirrors: np.ndarray
    depth: np.ndarray

    @classmethod
    def of(cls, rows, points, directions, weights, throughput: float, mirrors: int, depth: int) -> _Rays:
        """One ray for each beam ``(r, k)`` of any weight."""
        row, beam = np.nonzero(weights)
        n = len(row)
        return cls(
            rows[row],
            points[row],
            directions[beam],
            weights[row, beam],
            np.full(n, throughput),
            np.full(n, mirrors),
            np.full(n, depth),
        )

    @classmethod
    def beyond(
        cls,
        rows,
        points,
        beams: Beams,
        weights,
        partial: Partial | None,
        throughput: float,
        mirrors: int,
        past: HalfSpace,
        depth: int,
    ) -> _Rays:
        """Rays of mirrored receivers, set forward to the mirror's plane; partial beams in their own direction."""
        rays = cls.of(rows, points, beams.directions, weights, throughput, mirrors, depth)
        directions = rays.directions
        if partial is not None:
            place = np.zeros(weights.shape, np.int64)
            place[weights > 0] = np.arange(len(rays.rows))
            directions[place[partial.row, partial.beam]] = partial.direction / np.linalg.norm(
                partial.direction, axis=1, keepdims=True
            )
        ahead = (past.offset - rays.points @ past.normal) / (directions @ past.normal)
        return replace(rays, points=rays.points + ahead[:, None] * directions, directions=directions)

    @classmethod
    def joined(cls, parts: list[_Rays]) -> _Rays:
        """All rays in one."""
        if not parts:
            none = np.zeros(0)
            return cls(
                none.astype(np.int64),
                np.zeros((0, 3)),
                np.zeros((0, 3)),
                none,
                none,
                none.astype(np.int64),
                none.astype(np.int64),
            )
        return cls(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(cls)))

    def take(self, index) -> _Rays:
        """Some of the rays."""
        return _Rays(*(getattr(self, f.name)[index] for f in fields(self)))

    def flown(self, flight: Flight) -> _Rays:
        """The rays on the last stretch of their flight."""
        return _Rays(
            self.rows,
            flight.points,
            flight.directions,
            self.weights * flight.factor,
            self.throughput * flight.factor,
            self.mirrors + flight.mirrors,
            self.depth + flight.mirrors,
        )

    def onward(self, places, share, normal, kind: str) -> _Rays:
        """The rays after a mirror or a pane."""
        mirror = kind == "mirror"
        return _Rays(
            self.rows,
            places,
            reflect(self.directions, normal) if mirror else self.directions,
            self.weights * share,
            self.throughput * share,
            self.mirrors + mirror,
            self.depth + 1,
        )


def _ray_sighting(outlines: Outlines, rays: _Rays, outline, mirrors: int, beams: Beams) -> Sighting:
    n = len(rays.rows)
    view = View(
        seen=np.full((n, 0), SHARED, np.int32),
        part_row=np.arange(n),
        part_beam=np.zeros(n, np.int64),
        part_seen=outline,
        part_share=np.ones(n),
        part_direction=rays.directions,
        nearest=np.zeros((n, 0), np.float32),
        columns={},
        heights=_Heights(outlines, rays.points),
    )
    return Sighting(
        rays.rows,
        rays.points,
        np.zeros(3),
        beams,
        outlines.whole,
        view,
        rays.weights[:, None],
        mirrors,
        outlines,
        rays=True,
    )


@dataclass(frozen=True, eq=False)
class _Heights:
    """Signed distances from points to outlines' planes, found only where asked for: ``heights[rows, outlines]``."""

    outlines: Outlines
    points: np.ndarray

    def __getitem__(self, key):
        row, outline = key
        return self.outlines.offsets[outline] - dots(self.points[row], self.outlines.normals[outline])


@dataclass
class GroupSight:
    """Sightings of receivers that share one plane.

    Parameters
    ----------
    outlines : Outlines
    hemisphere : Hemisphere
    offset : float
        ``normal · x`` of the receivers' plane.
    limits : ChainLimits
    """

    outlines: Outlines
    hemisphere: Hemisphere
    offset: float
    limits: ChainLimits
    _obstacles: dict = field(default_factory=dict)

    def sightings(self, points, checkpoint: Callable[[], None] = lambda: None) -> tuple[Iterator[Sighting], np.ndarray]:
        """Follow the beams of receivers in this plane.

        Parameters
        ----------
        points : (r, 3) float
        checkpoint : callable
            Called between sightings; may raise to stop.

        Returns
        -------
        sightings : iterator of Sighting
        truncated : (r,) float
            Filled while iterating: weight of the chains that were cut off.
        """
        truncated = np.zeros(len(points))
        return self._follow(np.asarray(points, float), truncated, checkpoint), truncated

    def _follow(self, points, truncated, checkpoint) -> Iterator[Sighting]:
        hemisphere = self.hemisphere
        beams = Beams.of(hemisphere)
        weights = np.broadcast_to(hemisphere.weights, (len(points), len(hemisphere.weights)))
        horizon = HalfSpace(hemisphere.normal, self.offset)
        unseen_backs = self.outlines.unseen_backs(points, hemisphere.normal)
        left = []
        if len(self.outlines.vertices) > MANY_OUTLINES:
            left.append(_Rays.of(np.arange(len(points)), points, beams.directions, weights, 1.0, 0, 0))
            stack = []
        else:
            stack = [(np.arange(len(points)), points, horizon, (), beams, weights, None, 1.0, 0, ())]
        while stack:
            rows, origin, horizon, beyond, beams, weights, partial, throughput, mirrors, chain = stack.pop()
            checkpoint()
            obstacles = self._cut(chain, [horizon, *beyond])
            view = look(
                origin,
                horizon.normal,
                beams,
                obstacles,
                self.outlines.tolerance,
                beyond[0] if beyond else None,
                partial,
                weights > 0 if beyond else None,
                unseen_backs[obstacles.outlines],
            )
            sighting = Sighting(
                rows, origin, horizon.normal, beams, obstacles, view, weights, mirrors, self.outlines, partial
            )
            yield sighting
            if self.outlines.any_specular:
                stack += self._continue(sighting, horizon, throughput, chain, truncated, left)
        yield from self._trace(left, truncated, checkpoint)

    def _trace(self, left: list[_Rays], truncated, checkpoint) -> Iterator[Sighting]:
        """Follow rays one by one, from where the mirrored view was too narrow to be worth sharing."""
        rays = _Rays.joined(left)
        none = Beams.of(self.hemisphere).take(np.zeros(0, np.int64))
        while len(rays.rows):
            checkpoint()
            flight = self.outlines.rays.through_mirrors(
                rays.points,
                rays.directions,
                rays.throughput,
                rays.depth,
                self.outlines.plain_mirrors,
                self.limits.cutoff,
                DEEPEST_CHAIN,
            )
            rays = rays.flown(flight)
            truncated += np.bincount(rays.rows[flight.faint], rays.weights[flight.faint], minlength=len(truncated))
            outline, distance = flight.outline, flight.distance
            kinds = np.where(flight.faint, -1, self.limits.kind(rays.mirrors))
            for kind in np.unique(kinds[kinds >= 0]):
                mine = np.flatnonzero(kinds == kind)
                yield _ray_sighting(self.outlines, rays.take(mine), outline[mine], int(kind), none)
            met = np.flatnonzero(outline >= 0)
            place = rays.points[met] + distance[met, None] * rays.directions[met]
            onward = []
            for o in np.unique(outline[met]):
                material = self.outlines.materials[o]
                if not (material.is_specular or material.is_transparent):
                    continue
                here = np.flatnonzero(outline[met] == o)
                here_rays = rays.take(met[here])
                cosine = here_rays.directions @ self.outlines.normals[o]
                onward += self._onward(here_rays, place[here], int(o), cosine < 0, cosine, truncated)
            rays = _Rays.joined(onward)

    def _cut(self, chain, half_spaces) -> Obstacles:
        if chain not in self._obstacles:
            o = self.outlines
            self._obstacles[chain] = obstacles_within(o.vertices, o.normals, o.offsets, half_spaces, o.tolerance)
        return self._obstacles[chain]

    def _continue(self, s: Sighting, horizon: HalfSpace, throughput: float, chain, truncated, left: list) -> list:
        following = []
        parts = None
        for k, o in enumerate(s.obstacles.outlines):
            material = self.outlines.materials[o]
            if not (material.is_specular or material.is_transparent):
                continue
            parts = s.part_weights() if parts is None else parts
            arriving = _Arriving.at(s, k, parts, self.outlines)
            if arriving is None:
                continue
            normal, offset = self.outlines.normals[o], float(self.outlines.offsets[o])
            for front in (True, False):
                side = (s.view.heights[:, k] < 0) == front
                if not side.any():
                    continue
                for kind, share in self._ways(material, int(o), front, arriving.cosine):
                    onward = arriving.weighted(np.where(side[:, None], share[None, :], 0.0))
                    if onward is None:
                        continue
                    product = throughput * float(share[onward.kept].max())
                    rows, points = s.rows[onward.rows], s.points[onward.rows]
                    if product < self.limits.cutoff or len(chain) >= DEEPEST_CHAIN:
                        truncated[rows] += onward.weights.sum(axis=1)
                        continue
                    beams, direction = s.beams.take(onward.columns), onward.direction
                    window = None if s.partial is None else s.partial.window[onward.rows]
                    facing = 1.0 if front == (kind == "mirror") else -1.0
                    past, ahead = HalfSpace(facing * normal, facing * offset), horizon
                    if kind == "mirror":
                        beams, ahead = beams.reflected(normal), horizon.reflected(normal, offset)
                        points, direction = reflect_points(points, normal, offset), reflect(direction, normal)
                        window = None if window is None else reflect(window, normal).astype(np.float32)
                    mirrors = s.mirrors + (kind == "mirror")
                    partial = self._partial(onward, direction, points, int(o), window)
                    few = np.count_nonzero(onward.weights) < _FEW_BEAMS
                    if chain and (few or len(chain) >= _LOOKED_INTO):
                        left.append(
                            _Rays.beyond(
                                rows, points, beams, onward.weights, partial, product, mirrors, past, len(chain) + 1
                            )
                        )
                        continue
                    step = (int(o), kind, front)
                    following.append(
                        (
                            rows,
                            points,
                            ahead,
                            (past,),
                            beams,
                            onward.weights,
                            partial,
                            product,
                            mirrors,
                            (*chain, step),
                        )
                    )
        return following

    def _partial(self, onward: _Arriving, direction, points, o: int, window) -> Partial | None:
        """Beams that come through outline ``o`` in part, within it and within the windows before it."""
        if not len(onward.row):
            return None
        whole = self.outlines.whole
        one = Obstacles(
            whole.outlines[[o]], whole.vertices[[o]], whole.bounding[[o]], whole.normals[[o]], whole.offsets[[o]]
        )
        planes = edge_planes(points, one, self.outlines.tolerance)[0][:, 0].astype(np.float32)
        if window is not None:
            # of the mirrors before, the last few: what is seen through many lies well inside the first
            planes = np.concatenate([window[:, -_WINDOWS * planes.shape[1] :], planes], axis=1)
        return Partial(onward.row, onward.beam, direction, planes)

    def _onward(self, rays: _Rays, places, o: int, front, cosine, truncated) -> list[_Rays]:
        """Rays that met an outline at ``places``, after it: those bright enough to follow."""
        onward = []
        for side in (True, False):
            mine = np.flatnonzero(front == side)
            if not len(mine):
                continue
            for kind, share in self._ways(self.outlines.materials[o], o, side, cosine[mine]):
                after = rays.take(mine).onward(places[mine], share, self.outlines.normals[o], kind)
                kept = (after.throughput >= self.limits.cutoff) & (after.depth < DEEPEST_CHAIN)
                np.add.at(truncated, after.rows[~kept], after.weights[~kept])
                onward.append(after.take(np.flatnonzero(kept)))
        return onward

    def _ways(self, material: Material, o: int, front: bool, cosine: np.ndarray):
        if material.is_specular and (front or self.outlines.two_sided[o] or material.reflects_both_sides):
            yield "mirror", material.specular_at(cosine)
        if material.is_transparent:
            yield "through", material.transmittance_at(cosine)
