"""Receivers that stand for many facets each: what rays from all over these see."""

from __future__ import annotations

import numpy as np

from .geometry import Geometry
from .projection import Beams
from .sighting import Rays
from .tracing import ChainLimits, RaySight
from .weights import Weights

RAYS = 512
"""From each receiver."""

_STEPS = 1.1673039782614187 ** -np.arange(1.0, 5.0)
"""Multiples of these, less whole numbers, are evenly spread in four dimensions (Roberts 2018, his R4)."""


def scattered_sight(geometry: Geometry, limits: ChainLimits, served: Weights) -> RaySight:
    """What facets see that share a receiver.

    Parameters
    ----------
    geometry : Geometry
    limits : ChainLimits
    served : Weights
        Facets of each receiver; their weights say nothing.

    Returns
    -------
    RaySight
        Of as many receivers. Each ray stands for the same share of what all facets of its receiver get: these by their
        area, directions by the cosine with the facet's own normal.
    """
    row, facet, spread = _facets_of_rays(geometry.fracture.element_areas[served.node], served)
    a, b, c = geometry.fracture.elements[facet].transpose(1, 0, 2)
    u, v = np.where(spread[:2].sum(axis=0) > 1, 1 - spread[:2], spread[:2])
    points = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    # a point of the unit sphere that touches the facet from above lies in a direction by the cosine
    height, angle = 1 - 2 * spread[2], 2 * np.pi * spread[3]
    level = np.sqrt(1 - height**2)
    towards = np.stack([level * np.cos(angle), level * np.sin(angle), height], axis=1)
    towards += geometry.element_normals[facet]
    length = np.linalg.norm(towards, axis=1)
    flat = length < 1e-9
    towards[flat], length[flat] = geometry.element_normals[facet[flat]], 1.0
    n = len(row)
    none = np.zeros(n, np.int64)
    rays = Rays(row, points, towards / length[:, None], np.full(n, 1.0 / RAYS), np.ones(n), none, none)
    beams = Beams.of(geometry.targets.globe.hemisphere(np.array([0.0, 0.0, 1.0])))
    return RaySight(geometry.outlines, limits, rays, beams.take(none[:0]))


def _facets_of_rays(area: np.ndarray, served: Weights) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Receiver and facet of each ray ``(n,)``, facets of a receiver as often as their areas ``(k,)`` ask for.

    And four numbers from 0 to 1 for each ``(4, n)``, spread evenly over the rays of each receiver.
    """
    receivers = len(served.start) - 1
    number = np.arange(RAYS)
    sums = np.concatenate([[0.0], np.cumsum(area)])
    low, high = sums[served.start[:-1]], sums[served.start[1:]]
    place = low[:, None] + (high - low)[:, None] * (number + 0.5) / RAYS
    entry = np.searchsorted(sums, place.ravel(), side="right") - 1
    row = np.repeat(np.arange(receivers), RAYS)
    entry = np.clip(entry, served.start[row], served.start[row + 1] - 1)
    spread = (0.5 + number * _STEPS[:, None]) % 1.0
    return row, served.node[entry], np.tile(spread, receivers)
