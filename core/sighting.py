"""Sightings: one step of what receivers see, along shared beams or along single rays."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from .arrays import dots, onto, pick
from .outlines import Outlines
from .projection import Beams, HalfSpace, Obstacles, reflect
from .rays import Flight
from .views import SHARED, Partial, View


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


@dataclass(frozen=True, eq=False)
class Rays:
    """Single rays on their way: all arrays of length n."""

    rows: np.ndarray
    points: np.ndarray
    directions: np.ndarray
    weights: np.ndarray
    throughput: np.ndarray
    mirrors: np.ndarray
    depth: np.ndarray

    @classmethod
    def of(cls, rows, points, directions, weights, throughput: float, mirrors: int, depth: int) -> Rays:
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
    ) -> Rays:
        """Rays of mirrored receivers, set forward to the mirror's plane; partial beams in their own direction."""
        rays = cls.of(rows, points, beams.directions, weights, throughput, mirrors, depth)
        directions = rays.directions
        if partial is not None:
            place = np.zeros(weights.shape, np.int64)
            place[weights > 0] = np.arange(len(rays.rows))
            some = np.flatnonzero(weights[partial.row, partial.beam] > 0)
            way = partial.direction[some]
            directions[place[partial.row[some], partial.beam[some]]] = way / np.linalg.norm(way, axis=1, keepdims=True)
        ahead = (past.offset - onto(rays.points, past.normal)) / onto(directions, past.normal)
        return replace(rays, points=rays.points + ahead[:, None] * directions, directions=directions)

    @classmethod
    def joined(cls, parts: list[Rays]) -> Rays:
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

    def take(self, index) -> Rays:
        """Some of the rays."""
        return Rays(*(getattr(self, f.name)[index] for f in fields(self)))

    def flown(self, flight: Flight) -> Rays:
        """The rays on the last stretch of their flight."""
        return Rays(
            self.rows,
            flight.points,
            flight.directions,
            self.weights * flight.factor,
            self.throughput * flight.factor,
            self.mirrors + flight.mirrors,
            self.depth + flight.mirrors,
        )

    def onward(self, places, share, normal, kind: str) -> Rays:
        """The rays after a mirror or a pane."""
        mirror = kind == "mirror"
        return Rays(
            self.rows,
            places,
            reflect(self.directions, normal) if mirror else self.directions,
            self.weights * share,
            self.throughput * share,
            self.mirrors + mirror,
            self.depth + 1,
        )


def ray_sighting(outlines: Outlines, rays: Rays, outline, mirrors: int, beams: Beams) -> Sighting:
    """What single rays meet: outlines ``(n,)``, or -1 for none."""
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
