"""Nearness: how closely the edges of other surfaces pass over a run of cells, and how narrow that asks its cells to be.

Light changes over a distance of about the height at which an edge stands above a plane: over the width of a slat beside
the next slat, and within centimetres below a board that lies close over a table.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .grid import Grid
from .planes import Planes

_LEVEL = 0.2
"""Rise of an edge, over its length, up to which it counts as running along a plane."""

_SPREAD = 4.0
"""Width of what an edge shapes of the light on a plane, over its height above."""

_LEAST_SHARE = 0.1
"""Share of a run that edges have to shape: fewer are left to the check of interpolation."""

_ACROSS = 3
"""Cells across a run that is no wider than a few heights of the edges over it."""

_OF_HEIGHT = 0.5
"""Width of cells on wide planes, over the height of the edges over them."""

_OF_LUMINOUS = 10.0
"""How much more the edge of a luminous surface counts."""

_ALONG = 0.05


@dataclass(frozen=True, eq=False)
class NearEdges:
    """Edges that pass over a run of cells.

    Attributes
    ----------
    lines : (c, 2, 2) float
        Below each edge, in cells along either axis.
    heights : (c,) float [m]
    luminous : (c,) bool
    """

    lines: np.ndarray
    heights: np.ndarray
    luminous: np.ndarray


def near_edges(grid: Grid, planes: Planes, normal, reach: float, luminous: np.ndarray | None = None) -> NearEdges:
    """Edges of other surfaces before a run of cells that run along it, no higher than ``reach`` above.

    Parameters
    ----------
    grid : Grid
    planes : Planes
    normal : (3,) float
        Of the side that is lit.
    reach : float [m]
    luminous : (o,) bool, optional
        Outlines that give light of their own.

    Returns
    -------
    NearEdges
    """
    height = (planes.outlines - grid.corner) @ normal
    tolerance = 1e-9 * planes.size
    near = np.flatnonzero((height.max(axis=1) > tolerance) & (height.min(axis=1) <= reach))
    start, low = planes.outlines[near], height[near]
    end, high = np.roll(start, -1, axis=1), np.roll(low, -1, axis=1)
    middle = 0.5 * (low + high)
    fits = np.abs(high - low) <= _LEVEL * np.linalg.norm(end - start, axis=2)
    fits &= (middle > tolerance) & (middle <= reach)
    outline, edge = np.nonzero(fits)
    ends = grid.in_cells(np.concatenate([start[outline, edge], end[outline, edge]])).reshape(2, -1, 2)
    lines, kept = grid.within(ends.swapaxes(0, 1))
    heights = middle[fits][kept]
    glows = np.zeros(len(kept), bool) if luminous is None else luminous[near[outline[kept]]]
    # an edge that two faces of a body share, or both sides of a board, is one
    step = lines[:, 1] - lines[:, 0]
    key = np.c_[lines.mean(axis=1), np.abs(step), step.prod(axis=1), heights / reach]
    _, first, same = np.unique(np.rint(1e6 * key), axis=0, return_index=True, return_inverse=True)
    return NearEdges(lines[first], heights[first], np.bincount(same.reshape(-1), weights=glows) > 0)


def closeness(grid: Grid, planes: Planes, normal, luminous: np.ndarray) -> np.ndarray:
    """(2,) float: how wide cells may be along either axis for what passes near before one side [m]; inf for nothing.

    Parameters
    ----------
    grid : Grid
    planes : Planes
    normal : (3,) float
    luminous : (o,) bool
        Outlines that give light of their own: their edges count for more.
    """
    sides, extent = grid.sides, grid.sides * grid.shape
    edges = near_edges(grid, planes, normal, _ACROSS * float(sides.max()), luminous)
    step = np.abs(edges.lines[:, 1] - edges.lines[:, 0]) * sides
    length = np.linalg.norm(step, axis=1)
    wide = np.full(2, np.inf)
    for axis in (0, 1):
        mine = np.flatnonzero(step[:, 1 - axis] > _ALONG * length)  # not those that run along this axis
        order = mine[np.argsort(edges.heights[mine], kind="stable")]
        spread = np.minimum(_SPREAD * edges.heights[order], extent[axis])
        spread *= np.where(grid.along_border(edges.lines[order]), 0.5, 1.0)
        spread *= np.where(edges.luminous[order], _OF_LUMINOUS, 1.0)
        enough = np.cumsum(spread * length[order]) >= _LEAST_SHARE * extent.prod()
        if enough.any():
            height = edges.heights[order[np.argmax(enough)]]
            wide[axis] = min(_OF_HEIGHT * height, max(extent[axis], height) / _ACROSS)
    return wide
