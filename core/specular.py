"""Specular chains: what receivers see straight ahead, through clear panes and in mirrors, to any order.

Seen from the receivers of one plane a planar mirror is a window into the mirrored scene. So the receivers are
mirrored once, and the reflected directions are again shared by all of them; nothing of position or direction is rounded. Chains
go on until the product of reflectances falls below a cut-off; what is cut is booked, not forgotten.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from .globe import Hemisphere
from .materials import Material
from .projection import Beams, HalfSpace, Obstacles, obstacles_within, reflect_points
from .visibility import View, look

DEEPEST_CHAIN = 200
"""No chain is followed further, even between perfect mirrors."""


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
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    materials: list[Material]
    two_sided: np.ndarray
    tolerance: float

    @property
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
        Cosine weight of each beam times the reflectances and transmittances on the way here; 0 where the beam did not come.
    mirrored : bool
        Whether at least one mirror was on the way.
    """

    rows: np.ndarray
    points: np.ndarray
    normal: np.ndarray
    beams: Beams
    obstacles: Obstacles
    view: View
    weights: np.ndarray
    mirrored: bool

    def part_weights(self) -> np.ndarray:
        """(p,) float: weight of each part of a shared beam, with the cosine at the part's own centre."""
        v = self.view
        cosine = self.beams.directions @ self.normal
        tilt = (v.part_direction @ self.normal) / cosine[v.part_beam]
        return self.weights[v.part_row, v.part_beam] * v.part_share * np.clip(tilt, 0.0, 2.0)


@dataclass
class ChainLimits:
    """When to stop following a chain.

    Attributes
    ----------
    cutoff : float
        Smallest product of reflectances and transmittances that is still followed.
    """

    cutoff: float = 1e-3


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
        weights = np.broadcast_to(hemisphere.weights, (len(points), len(hemisphere.weights)))
        horizon = HalfSpace(hemisphere.normal, self.offset)
        stack = [(np.arange(len(points)), points, horizon, (), Beams.of(hemisphere), weights, 1.0, False, ())]
        while stack:
            rows, origin, horizon, beyond, beams, weights, throughput, mirrored, chain = stack.pop()
            checkpoint()
            obstacles = self._cut(chain, [horizon, *beyond])
            sighting = Sighting(
                rows,
                origin,
                horizon.normal,
                beams,
                obstacles,
                look(origin, beams, obstacles, self.outlines.tolerance),
                weights,
                mirrored,
            )
            yield sighting
            if self.outlines.any_specular:
                stack += self._continue(sighting, horizon, throughput, chain, truncated)

    def _cut(self, chain, half_spaces) -> Obstacles:
        if chain not in self._obstacles:
            o = self.outlines
            self._obstacles[chain] = obstacles_within(o.vertices, o.normals, o.offsets, half_spaces, o.tolerance)
        return self._obstacles[chain]

    def _continue(self, s: Sighting, horizon: HalfSpace, throughput: float, chain, truncated) -> list:
        following = []
        parts = None
        for k, o in enumerate(s.obstacles.outlines):
            material = self.outlines.materials[o]
            if not (material.is_specular or material.is_transparent):
                continue
            if parts is None:
                parts = s.part_weights()
            arriving = self._arriving(s, k, parts)
            if arriving is None:
                continue
            cosine = s.beams.directions @ s.obstacles.normals[k]
            normal, offset = self.outlines.normals[o], float(self.outlines.offsets[o])
            for front in (True, False):
                side = (s.view.heights[:, k] < 0) == front
                mine = arriving * side[:, None]
                for kind, share in self._ways(material, o, front, cosine):
                    onward = mine * share
                    rows, columns = np.flatnonzero(onward.any(axis=1)), np.flatnonzero(onward.any(axis=0))
                    if not len(rows):
                        continue
                    onward = onward[np.ix_(rows, columns)]
                    product = throughput * float(share[columns].max())
                    step = (int(o), kind, front)
                    if product < self.limits.cutoff or len(chain) >= DEEPEST_CHAIN:
                        truncated[s.rows[rows]] += onward.sum(axis=1)
                        continue
                    beams, points = s.beams.take(columns), s.points[rows]
                    if kind == "mirror":
                        facing = 1.0 if front else -1.0
                        beams = beams.reflected(normal)
                        points = reflect_points(points, normal, offset)
                        ahead, past = horizon.reflected(normal, offset), HalfSpace(facing * normal, facing * offset)
                    else:
                        facing = -1.0 if front else 1.0
                        ahead, past = horizon, HalfSpace(facing * normal, facing * offset)
                    following.append(
                        (s.rows[rows], points, ahead, (past,), beams, onward, product, s.mirrored or kind == "mirror", (*chain, step))
                    )
        return following

    def _arriving(self, s: Sighting, k: int, parts: np.ndarray) -> np.ndarray | None:
        whole = s.view.seen == k
        mine = np.flatnonzero(s.view.part_seen == k)
        if not whole.any() and not len(mine):
            return None
        arriving = np.where(whole, s.weights, 0.0)
        arriving[s.view.part_row[mine], s.view.part_beam[mine]] += parts[mine]
        return arriving

    def _ways(self, material: Material, o: int, front: bool, cosine: np.ndarray):
        if material.is_specular and (front or self.outlines.two_sided[o] or material.reflects_both_sides):
            yield "mirror", material.specular_at(cosine)
        if material.is_transparent:
            yield "through", material.transmittance_at(cosine)

