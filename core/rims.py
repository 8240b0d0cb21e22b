"""Rims of facets before the sky: parcels beside them, by many rays each."""

from __future__ import annotations

import numpy as np

from .arrays import dots
from .bundles import Bundle
from .globe import Globe
from .hemisphere import direction_of
from .projection import Beams
from .rays import RayScene
from .tree import Tree

_LITTLE_SKY = 0.1
"""Receivers that see the sky with more of their weight than this don't depend on single parcels."""

_RAYS = (7, 5, 4)
"""Order of the lattice of rays in a beam: 13 rays; 5 or 3 where tiles are two or three times as wide."""


def mixed_tiles(
    globe: Globe, parcels: np.ndarray, met: np.ndarray, open_: np.ndarray, weights: np.ndarray
) -> np.ndarray:
    """Tiles beside rims, where little is seen of the sky.

    Parameters
    ----------
    globe : Globe
        Of the tiles.
    parcels : (t,) int
        The tiles' parcels there.
    met : (r, t) bool
        Where a facet is met before the sky.
    open_ : (r, t) bool
        Where the sky is, wholly or beside large outlines.
    weights : (r, t) float
        Of the sky in each tile that no large outline's edge crosses, as if no facet stood before it.

    Returns
    -------
    (r, t) bool
        Tiles around which facets are met and the sky is seen as well.
    """
    found = np.zeros(met.shape, bool)
    sky = np.einsum("rt,rt->r", weights, open_)
    rows = np.flatnonzero((sky > 0) & (sky < _LITTLE_SKY) & met.any(axis=1))
    if not len(rows):
        return found
    place = np.full(globe.count, len(parcels))
    place[parcels] = np.arange(len(parcels))
    beside = place[_neighbours(globe, parcels)]
    none = np.zeros((len(rows), 1), bool)
    met_too, open_too = (np.concatenate([each[rows], none], axis=1) for each in (met, open_))
    found[rows] = open_too[:, beside].any(axis=2) & met_too[:, beside].any(axis=2)
    return found


def _neighbours(globe: Globe, parcels: np.ndarray) -> np.ndarray:
    """(n, 9) int: each parcel and those around it."""
    polar, azimuth = globe.polar[parcels], globe.azimuth[parcels]
    high = np.pi / globe.bands
    around = [
        direction_of(np.clip(polar + down * high, 1e-9, np.pi - 1e-9), azimuth + across * globe.azimuth_width[parcels])
        for down in (-1, 0, 1)
        for across in (-1, 0, 1)
    ]
    return np.stack([globe.parcel_of(towards) for towards in around], axis=1)


def sampled(
    rays: RayScene,
    among: Tree,
    large: RayScene,
    unseen_backs: np.ndarray,
    points: np.ndarray,
    beams: Beams,
    row: np.ndarray,
    beam: np.ndarray,
    wider: int,
):
    """Meet facets by many rays in each of some beams ``(n,)``, in what the large outlines leave of them.

    Backs ``(l,)`` bool of large outlines that nobody looks for stand behind facets, and leave what these do. Tiles are
    ``wider`` than beams by that factor.

    Returns
    -------
    number : (m,) int
        Of the beam that each ray which met a facet belongs to.
    outline : (m,) int
    directions : (m, 3) float
    distance : (m,) float
    share : (m,) float
        Of the cosine-weighted solid angle of what is left of its beam.
    left : (n,) float
        Share of that in which nothing was met; NaN where no ray comes through.
    left_towards : (n, 3) float
        The middle of that.
    """
    some, place = np.unique(beam, return_inverse=True)
    rays_of = beams.rays(some, _RAYS[min(wider, len(_RAYS)) - 1]).astype(float)
    rays_of /= np.linalg.norm(rays_of, axis=2, keepdims=True)
    directions = rays_of[place]
    weight = np.maximum(directions @ beams.hemisphere.normal, 0.0)
    shape = weight.shape
    origins = np.broadcast_to(points[row][:, None], directions.shape).reshape(-1, 3)
    if len(unseen_backs):
        outline, _ = large.nearest(origins, directions.reshape(-1, 3))
        unseen = unseen_backs[outline] & (dots(directions.reshape(-1, 3), large.normals[outline]) > 0)
        weight[((outline >= 0) & ~unseen).reshape(shape)] = 0.0
    total = weight.sum(axis=1, keepdims=True)
    weight = np.divide(weight, total, out=weight, where=total > 0)
    of_ray = (place[:, None] * shape[1] + np.arange(shape[1])).ravel()
    bundle = Bundle.of(rays, points, rays_of.reshape(-1, 3), among, len(of_ray))
    outline, distance = bundle.nearest(
        np.repeat(row, shape[1]), of_ray, np.zeros(len(of_ray)), np.full(len(of_ray), np.inf)
    )
    met = (outline >= 0) & (weight.ravel() > 0)
    free = np.where(met.reshape(shape), 0.0, weight)
    left = np.where(total[:, 0] > 0, free.sum(axis=1), np.nan)
    towards = np.einsum("ns,nsc->nc", free, directions) / np.maximum(free.sum(axis=1), 1e-300)[:, None]
    mine = np.flatnonzero(met)
    return (
        mine // shape[1],
        outline[mine],
        directions.reshape(-1, 3)[mine],
        distance[mine],
        weight.ravel()[mine],
        left,
        towards,
    )
