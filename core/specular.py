"""Specular chains: what receivers see straight ahead, through clear panes and in mirrors, to any order.

Seen from the receivers of one plane a planar mirror is a window into the mirrored scene. So the receivers are
mirrored once, and the reflected directions are again shared by all of them; nothing of position or direction is
rounded. Chains go on until the product of reflectances falls below a cut-off; what is cut is booked, not forgotten.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from .arrays import onto
from .facets import before
from .globe import Hemisphere
from .outlines import Outlines
from .projection import Beams, HalfSpace, Obstacles, edge_planes, obstacles_within, reflect, reflect_points
from .sighting import Rays, Sighting, ray_sighting
from .tracing import DEEPEST_CHAIN, FAINTEST, ChainLimits, Tracer, thinned
from .tree import Tree
from .visibility import Partial, look

_FEW_BEAMS = 5_000
"""Fewer are followed one by one, after two mirrors or panes, without regard to edges that cross them."""

_LOOKED_INTO = 4
"""So are all after more mirrors or panes than this, which show little light each."""

_PANES_LOOKED_THROUGH = 12
_FAINT = 1e-3
"""Through panes alone, which don't multiply what is seen, as long as some receiver sees more than this by them: what
shines behind them is far brighter than the room."""

_FEW_WILL_DO = 0.1
"""Where panes mirror as well as transmit, chains that show no receiver more than this are followed as few rays."""

_WINDOWS = 2
"""Earlier mirrors whose edges bound what beams show in part."""

_WITHIN = 4e-5
"""Angle from a mirror's edge that centres of parts keep [rad], so that nothing that stands at the edge is before it."""


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
        way = (view.heights[row, k] / onto(towards, s.obstacles.normals[k]))[:, None] * towards
        # centres are good to first order only: where edges meet, one may lie beside what it is the centre of
        places = outlines.rays.pulled_inside(
            int(s.obstacles.outlines[k]), s.points[row] + way, _WITHIN * np.linalg.norm(way, axis=1)
        )
        direction = places - s.points[row]
        cosine = onto(s.beams.directions[columns], s.obstacles.normals[k])
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
    _trees: dict = field(default_factory=dict)

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
        none = beams.take(np.zeros(0, np.int64))
        horizon = HalfSpace(hemisphere.normal, self.offset)
        unseen_backs = self.outlines.unseen_backs(points, hemisphere.normal)
        tracer, left = Tracer(self.outlines, self.limits), list[Rays]()
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
            facets, tree = self.outlines.facets, self._facets(chain, [horizon, *beyond])
            if facets is not None and tree is not None:
                past = beyond[0] if beyond else None
                view, found = before(facets, tree, origin, beams, weights, view, obstacles.normals, past, unseen_backs)
                rays = Rays(
                    rows[found.row],
                    found.points,
                    found.directions,
                    found.weight,
                    np.full(len(found.row), throughput),
                    np.full(len(found.row), mirrors),
                    np.full(len(found.row), len(chain)),
                )
                yield ray_sighting(self.outlines, rays, found.outline, mirrors, none)
                faint = np.full(len(rays.rows), FAINTEST)
                left += tracer.after(rays, found.outline, found.distance, truncated, faint)
            sighting = Sighting(
                rows, origin, horizon.normal, beams, obstacles, view, weights, mirrors, self.outlines, partial
            )
            yield sighting
            if self.outlines.any_specular:
                stack += self._continue(sighting, horizon, throughput, chain, truncated, left)
        yield from tracer.trace(left, truncated, checkpoint, none)

    def _cut(self, chain, half_spaces) -> Obstacles:
        if chain not in self._obstacles:
            o, some = self.outlines, self.outlines.projected
            found = obstacles_within(o.vertices[some], o.normals[some], o.offsets[some], half_spaces, o.tolerance)
            self._obstacles[chain] = replace(found, outlines=some[found.outlines])
        return self._obstacles[chain]

    def _facets(self, chain, half_spaces) -> Tree | None:
        """Of facets that may be seen; None where there are none."""
        if self.outlines.facets is None:
            return None
        if chain not in self._trees:
            normals, offsets = [half.normal for half in half_spaces], [half.offset for half in half_spaces]
            self._trees[chain] = self.outlines.facets.rays.above(normals, offsets)
        return None if self._trees[chain].is_empty else self._trees[chain]

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
                for kind, share in self.outlines.ways(int(o), front, arriving.cosine):
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
                    step = (int(o), kind, front)
                    if chain and _one_by_one(onward.weights, (*chain, step), self.outlines.splits_light):
                        weights = self._few(onward.weights)
                        left.append(
                            Rays.beyond(rows, points, beams, weights, partial, product, mirrors, past, len(chain) + 1)
                        )
                        continue
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

    def _few(self, weights) -> np.ndarray:
        """Weights of beams ``(r, k)`` of which not all are followed on, where panes mirror as well as transmit."""
        if not self.outlines.splits_light:
            return weights
        row, beam = np.nonzero(weights)
        kept, heavier = thinned(row, weights[row, beam], FAINTEST)
        few = np.zeros_like(weights)
        few[row[kept], beam[kept]] = heavier
        return few

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


def _one_by_one(weights: np.ndarray, chain: tuple, thinned_out: bool) -> bool:
    """Whether beams of weights ``(r, k)`` are followed as single rays after a chain of mirrors and panes."""
    most = float(weights.sum(axis=1).max())
    if len(chain) <= _PANES_LOOKED_THROUGH and all(kind == "through" for _, kind, _ in chain):
        return most < _FAINT
    if thinned_out and most < _FEW_WILL_DO:
        return True
    return len(chain) > _LOOKED_INTO or np.count_nonzero(weights) < _FEW_BEAMS
