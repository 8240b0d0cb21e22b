"""Facets: outlines too many to be projected one by one. Single rays find them before what is seen beyond.

Of a furnished room the few large outlines (walls, slabs, the edges of windows) decide most of what a receiver sees:
these are projected, and parcels that their edges cross divided exactly. Whether anything of the furniture's many facets
stands before them, rays tell: one for each parcel, or for each of a coarser globe.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from . import polygons, rims
from .arrays import dots
from .bundles import Bundle
from .globe import Globe
from .projection import UNTURNED, Beams, HalfSpace
from .rays import RayScene
from .tree import Tree
from .views import OPEN, SHARED, View, along

MANY_OUTLINES = 300
"""Scenes of more outlines are looked at by rays for all but the largest."""

_FEWEST_LARGE, _MOST_LARGE = 12, 60
_LARGE = 5e-3
"""Outlines of this share of the area of the scene's bounding box are large."""

_STANDS_OUT = 16
"""So are the fewest, if they are so many times as large as half of all outlines. Of a mesh of even facets none is:
beside one that is projected, rays to the middle of what it leaves of a parcel would pass through its place."""

_FINENESS = ((3_000, 1), (20_000, 2), (None, 3))
"""Up to so many facets, parcels of the rays' globe are as wide as so many of the scene's."""

_LEAST_BANDS = 20


@dataclass(frozen=True, eq=False)
class Facets:
    """Outlines that rays find.

    Attributes
    ----------
    large, small : (l,) and (s,) int
        Outlines that are projected, and those that rays look for.
    large_rays, rays : RayScene
        Of either.
    globe : Globe
        One ray is shot for each of its parcels.
    """

    large: np.ndarray
    small: np.ndarray
    large_rays: RayScene
    rays: RayScene
    globe: Globe

    @classmethod
    def of(cls, vertices: np.ndarray, normals, offsets, tolerance: float, globe: Globe) -> Facets | None:
        """Those of a scene's outlines ``(o, w, 3)``; None where they are few.

        Parameters
        ----------
        vertices : (o, w, 3) float, padded
        normals : (o, 3) float
        offsets : (o,) float
        tolerance : float [m]
        globe : Globe
            The scene's.
        """
        if len(vertices) <= MANY_OUTLINES:
            return None
        areas = polygons.areas(vertices)
        x, y, z = np.ptp(vertices.reshape(-1, 3), axis=0)
        many = int(np.count_nonzero(areas >= _LARGE * 2 * (x * y + y * z + z * x)))
        order = np.argsort(-areas, kind="stable")
        stand_out = int(np.count_nonzero(areas >= _STANDS_OUT * np.median(areas)))
        count = min(max(many, min(stand_out, _FEWEST_LARGE)), _MOST_LARGE)
        large, small = np.sort(order[:count]), np.sort(order[count:])
        times = next(times for most, times in _FINENESS if most is None or len(small) <= most)
        bands = min(globe.bands, max(_LEAST_BANDS, globe.bands // times))
        first, second = (RayScene(vertices[k], normals[k], offsets[k], tolerance) for k in (large, small))
        return cls(
            large,
            small,
            first,
            second,
            globe if bands == globe.bands else Globe.cut_at_horizon(bands),
        )


@dataclass(frozen=True, eq=False)
class Found:
    """Facets that show, ``n``: one for each ray that met one.

    Attributes
    ----------
    row : (n,) int
    outline : (n,) int
    points, directions : (n, 3) float
        Where the ray began, and its direction.
    distance : (n,) float
        From there [m].
    weight : (n,) float
        Of the beams that it stands for.
    """

    row: np.ndarray
    outline: np.ndarray
    points: np.ndarray
    directions: np.ndarray
    distance: np.ndarray
    weight: np.ndarray


def before(
    facets: Facets,
    among: Tree,
    points: np.ndarray,
    beams: Beams,
    weights: np.ndarray,
    view: View,
    normals: np.ndarray,
    past: HalfSpace | None,
    unseen_backs: np.ndarray,
) -> tuple[View, Found]:
    """Find facets that stand before what receivers see.

    Parameters
    ----------
    facets : Facets
    among : Tree
        Of those that may show at all.
    points : (r, 3) float
    beams : Beams
    weights : (r, k) float
        0 where a beam did not come.
    view : View
        Of the large outlines.
    normals : (o, 3) float
        Of the obstacles in the view.
    past : HalfSpace, optional
        Rays begin at its border.
    unseen_backs : (all,) bool
        Of all outlines of the scene, those whose backs are not looked for.

    Returns
    -------
    view : View
        Without what facets hide.
    found : Found
    """
    whole = (weights > 0) & (view.seen != SHARED)
    tiles = _Tiles.of(facets.globe, beams)
    hidden, beside, by_tiles = _before_whole(facets, among, tiles, points, beams, weights, whole, view, past)
    view, left, by_many = _before_sky(
        facets, among, unseen_backs[facets.large], points, beams, weights, view, beside, beside & whole
    )
    kept, by_parts = _before_parts(facets, among, tiles, points, weights, view, normals, past)
    clear = replace(
        view,
        seen=np.where(hidden, SHARED, view.seen),
        **{f: np.concatenate([getattr(view, f)[kept], left[f]]) for f in left},
    )
    every = (by_tiles, by_many, by_parts)
    return clear, Found(*(np.concatenate([getattr(one, f.name) for one in every]) for f in fields(Found)))


def _before_sky(facets: Facets, among: Tree, unseen_backs, points, beams: Beams, weights, view: View, beside, whole):
    """Facets before the sky in beams ``(r, k)`` beside rims, by many rays: in ``whole`` beams and in parts.

    The view is that without these, and what they leave of the sky is listed as parts.
    """
    parts = np.flatnonzero((view.part_seen == OPEN) & beside[view.part_row, view.part_beam])
    row, beam = np.nonzero(whole)
    share = np.append(np.ones(len(row)), view.part_share[parts])
    row, beam = np.append(row, view.part_row[parts]), np.append(beam, view.part_beam[parts])
    wider = max(1, beams.hemisphere.globe.bands // facets.globe.bands)
    number, outline, directions, distance, of_beam, left, towards = rims.sampled(
        facets.rays, among, facets.large_rays, unseen_backs, points, beams, row, beam, wider
    )
    told = ~np.isnan(left)
    told[: len(row) - len(parts)] = True  # nothing large is in these
    left = np.where(np.isnan(left), 1.0, left)
    towards = np.where((left < 1.0)[:, None], towards, beams.directions[beam])
    others = np.setdiff1d(np.arange(len(view.part_row)), parts[told[len(row) - len(parts) :]])
    names = ("part_row", "part_beam", "part_seen", "part_share", "part_direction")
    some = np.flatnonzero(told & (left > 0))
    sky = row[some], beam[some], np.full(len(some), OPEN), share[some] * left[some], towards[some]
    weight = weights[row, beam][number] * share[number] * of_beam
    return (
        replace(view, seen=np.where(whole, SHARED, view.seen), **{f: getattr(view, f)[others] for f in names}),
        dict(zip(names, sky, strict=True)),
        Found(row[number], facets.small[outline], points[row[number]], directions, distance, weight),
    )


def _before_whole(facets: Facets, among: Tree, tiles: _Tiles, points, beams: Beams, weights, whole, view: View, past):
    """Which of the beams ``(r, k)`` that see one thing see a facet before it, which are near to such; and these."""
    sent = np.logical_or.reduceat(whole.take(tiles.order, axis=1), tiles.starts, axis=1)
    bundle = Bundle.of(facets.rays, points, tiles.directions, among, sent.size)
    sent &= bundle.may_meet()
    row, tile = np.nonzero(sent)
    directions = tiles.directions[tile]
    away = _start(past, points[row], directions)
    origins = points[row] + away[:, None] * directions
    middle, limit = (each[row, tiles.middle[tile]] for each in (view.seen, view.nearest))
    divided = np.flatnonzero(middle == SHARED)
    limit = limit.astype(float)
    limit[divided] = away[divided] + facets.large_rays.nearest(origins[divided], directions[divided])[1]
    outline, distance = bundle.nearest(row, tile, away, limit)
    mine = np.flatnonzero(outline >= 0)
    row, tile, distance = row[mine], tile[mine], distance[mine]
    hit = np.full(sent.shape, np.inf, np.float32)
    hit[row, tile] = distance
    # what is behind the facet in the tile's middle, is behind it in all of the tile
    behind = np.full(sent.shape, SHARED)
    behind[row, tile] = middle[mine]
    hidden = hit.take(tiles.of_beam, axis=1) < view.nearest
    hidden |= view.seen == behind.take(tiles.of_beam, axis=1)
    hidden &= whole
    beside = np.zeros(whole.shape, bool)
    if past is None and beams.turn is UNTURNED:
        sky = whole & (view.seen == OPEN)
        above, met = sky.take(tiles.middle, axis=1), np.isfinite(hit)
        lit = tiles.summed(np.where(sky, weights, 0.0))
        partly = np.zeros(whole.shape, bool)
        some = view.part_seen == OPEN
        partly[view.part_row[some], view.part_beam[some]] = True
        open_ = (above & ~met) | partly.take(tiles.middle, axis=1)
        near = rims.mixed_tiles(facets.globe, tiles.parcels, met & above, open_, lit)
        beside = near.take(tiles.of_beam, axis=1) & (sky | ~whole) & (weights > 0)
        hidden &= ~beside
    weight = tiles.summed(np.where(hidden, weights, 0.0))[row, tile]
    shows = np.flatnonzero(weight > 0)
    mine = mine[shows]
    return (
        hidden,
        beside,
        Found(
            row[shows],
            facets.small[outline[mine]],
            origins[mine],
            directions[mine],
            distance[shows] - away[mine],
            weight[shows],
        ),
    )


def _before_parts(facets: Facets, among: Tree, tiles: _Tiles, points, weights, view: View, normals, past):
    """Which parts of beams ``(p,)`` have no facet before them; and the facets before the others.

    Parts are asked for themselves, one of those that see the same in a tile for all: beside the edge of a large
    outline, facets often are what continues it.
    """
    weight = weights[view.part_row, view.part_beam] * view.part_share
    kind = view.part_row * len(tiles.starts) + tiles.of_beam[view.part_beam]
    kind = kind * (len(normals) + 1) + view.part_seen
    order = np.lexsort((-weight, kind))
    first = np.flatnonzero(np.diff(kind[order], prepend=kind.min(initial=0) - 1))
    asked = order[first]
    row, seen = view.part_row[asked], view.part_seen[asked]
    towards = view.part_direction[asked]
    directions = towards / np.linalg.norm(towards, axis=1, keepdims=True)
    limit = np.full(len(row), np.inf)
    met = np.flatnonzero(seen != OPEN)
    with np.errstate(divide="ignore", invalid="ignore"):
        limit[met] = view.heights[row[met], seen[met]] / dots(directions[met], normals[seen[met]])
    away = _start(past, points[row], directions)
    origins = points[row] + away[:, None] * directions
    outline, distance = facets.rays.nearest(origins, directions, np.where(limit > 0, limit, np.inf) - away, among)
    every = np.add.reduceat(weight[order], first) if len(first) else weight
    kept = np.ones(len(order), bool)
    kept[order] = np.repeat(outline < 0, np.diff(np.append(first, len(order))))
    mine = np.flatnonzero((outline >= 0) & (every > 0))
    return kept, Found(
        row[mine], facets.small[outline[mine]], origins[mine], directions[mine], distance[mine], every[mine]
    )


def _start(past: HalfSpace | None, points, directions) -> np.ndarray:
    """(n,) float: how far along each ray begins."""
    return np.zeros(len(points)) if past is None else along(past, points, directions)


@dataclass(frozen=True, eq=False)
class _Tiles:
    """Beams gathered in parcels of a coarser globe, ``t``.

    Attributes
    ----------
    of_beam : (k,) int
    order : (k,) int
        Beams, tile by tile.
    starts : (t,) int
        Where each tile begins in that order.
    middle : (t,) int
        The beam nearest to each tile's middle.
    directions : (t, 3) float
        Of that beam.
    parcels : (t,) int
        On the coarser globe; of mirrored beams before the mirror.
    """

    of_beam: np.ndarray
    order: np.ndarray
    starts: np.ndarray
    middle: np.ndarray
    directions: np.ndarray
    parcels: np.ndarray

    def summed(self, values: np.ndarray) -> np.ndarray:
        """(r, t): sums of beams' values ``(r, k)``."""
        return np.add.reduceat(values.take(self.order, axis=1), self.starts, axis=1)

    @classmethod
    def of(cls, globe: Globe, beams: Beams) -> _Tiles:
        every = np.arange(len(beams.columns))
        if globe is beams.hemisphere.globe:
            return cls(every, every, every, every, beams.directions, beams.hemisphere.parcels[beams.columns])
        parcel = globe.parcel_of(beams.hemisphere.directions[beams.columns])
        order = np.argsort(parcel, kind="stable")
        starts = np.flatnonzero(np.diff(parcel[order], prepend=-1))
        of_beam = np.empty(len(order), np.int64)
        of_beam[order] = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(order))))
        sums = np.add.reduceat(beams.directions[order], starts, axis=0)
        aside = dots(beams.directions, sums[of_beam])
        middle = np.lexsort((-aside, of_beam))[starts]
        return cls(of_beam, order, starts, middle, beams.directions[middle], parcel[order[starts]])
