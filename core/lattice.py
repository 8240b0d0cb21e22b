"""Beams that too many obstacles cross, settled by rays: each ray meets one obstacle, so nothing leaks."""

from __future__ import annotations

import numpy as np

from .crossings import Candidates, Crossed
from .projection import Beams, Obstacles
from .views import Eye, Partial, along

_ON_EDGE = 1e-6
"""Rays this close to an edge [rad] count as inside, so that none slips between two obstacles that share it."""


_BLOCK = 1_000
"""Obstacles in beams that are looked at together: arrays of these times rays stay in cache."""


def sample(
    crossed: Crossed, candidates: Candidates, background, order: int, eye: Eye, beams: Beams, obstacles: Obstacles
):
    """Shares of obstacles in beams, and of what none hides.

    Parameters
    ----------
    crossed : Crossed
    candidates : Candidates
        That they are of.
    background : (g,) int
        What is seen wholly behind the obstacles of each beam, or OPEN.
    order : int
        See `Globe.scattered`.
    eye : Eye
    beams : Beams
    obstacles : Obstacles

    Returns
    -------
    share, towards : (n,) and (n, 3) float
    left, left_towards : (g,) and (g, 3) float
    """
    planes, begin, found = eye.planes.astype(np.float32), np.append(crossed.starts, len(crossed.row)), []
    first = 0
    while first < len(background):
        last = int(np.searchsorted(begin, begin[first] + _BLOCK, side="right")) - 1
        last = min(max(last, first + 1), len(background))
        some = crossed.take(np.arange(begin[first], begin[last]))
        found.append(_sampled(some, candidates, background[first:last], order, eye, planes, beams, obstacles))
        first = last
    share, towards, left, left_towards = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return share, towards, left, left_towards


def _sampled(
    crossed: Crossed, candidates: Candidates, background, order: int, eye: Eye, planes, beams: Beams, obstacles
):
    """As `sample`, for beams few enough to stay in cache; ``planes`` (r, o, w, 3) float32 are the eye's."""
    row, beam, obstacle, starts = crossed.row, crossed.beam, crossed.obstacle, crossed.starts
    heights, normal = eye.heights, eye.normal
    local = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(row))))
    single = np.float32
    rays = beams.rays(beam[starts], order)
    weight = np.maximum(np.einsum("gsc,c->gs", rays, normal.astype(single)), 0.0)
    if eye.partial is not None:
        part = eye.part_of(row[starts], beam[starts], len(beams.directions))
        _keep_partial(eye.partial, row[starts], part, rays, weight)
    weight /= np.maximum(weight.sum(axis=1, keepdims=True), single(1e-30))
    mine = rays[local]
    inside = np.ones(mine.shape[:2], bool)
    near = np.abs(candidates.sine[:, crossed.number]) < 2 * beams.reach[beam]
    for edge, close in enumerate(near):
        some = np.flatnonzero(close)
        if len(some):
            across = planes[row[some], obstacle[some], edge]
            inside[some] &= np.matmul(mine[some], across[:, :, None])[:, :, 0] >= -_ON_EDGE

    def distances(rows, obstacles_, towards):
        slope = np.matmul(towards, obstacles.normals[obstacles_].astype(single)[:, :, None])[:, :, 0]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            away = heights[rows, obstacles_].astype(single)[:, None] / slope
        away[~(away > 0)] = np.inf
        return away

    distance = distances(row, obstacle, mine)
    distance[~inside] = np.inf
    if eye.past is not None:
        distance[distance < along(eye.past, eye.points[row[starts]][:, None], rays)[local]] = np.inf
    known = background >= 0
    best = np.minimum.reduceat(distance, starts, axis=0)
    far = np.full(weight.shape, np.inf, single)
    if known.any():
        far[known] = distances(row[starts][known], background[known], rays[known])
    limit = np.minimum(best, far * single(1 - 1e-6))
    hit = (distance <= limit[local]) & (distance < np.inf)
    winners = np.add.reduceat(hit, starts, axis=0, dtype=np.int32)
    hit = hit * weight[local] / np.maximum(winners, 1).astype(single)[local]
    free = np.where(winners == 0, weight, single(0))

    def share_and_centre(part, towards):
        share = part.sum(axis=1)
        return share, np.matmul(part[:, None], towards)[:, 0] / np.maximum(share, single(1e-30))[:, None]

    return *share_and_centre(hit, mine), *share_and_centre(free, rays)


def _keep_partial(partial: Partial, row, part, rays, weight) -> None:
    """Leave only the rays that come through the window; where there are none, the part's own direction, in place."""
    groups = np.flatnonzero(part >= 0)
    if not len(groups):
        return
    towards = partial.direction[part[groups]]
    inside = (np.matmul(rays[groups], partial.window[row[groups]].transpose(0, 2, 1)) >= -_ON_EDGE).all(axis=2)
    none = ~(inside & (weight[groups] > 0)).any(axis=1)
    weight[groups] *= inside
    weight[groups[none]] = 1.0
    rays[groups[none]] = (towards / np.linalg.norm(towards, axis=1, keepdims=True))[none, None]
