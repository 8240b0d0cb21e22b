"""Nodes: one receiver for the two triangles of a grid cell, and what their own centroids receive by differences.

Form factors vary evenly over a face's width, so the two triangles of a cell share the receiver at the cell's centre;
each gets its value plus or minus the change towards its centroid. The change is taken from that neighbour, along either
axis, from which the row differs least: across the line where a shelf meets a wall nothing is mixed. The mean of the two
stays the cell's own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fracture import Fracture, Grid

_TO_CENTROID = 1.0 / 6.0
"""From a cell's centre to a triangle's centroid, in cells along each axis."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Receivers that stand for the elements.

    Attributes
    ----------
    points : (m, 3) float
    sheet : (m,) int, as `Fracture.element_sheet`
    element : (m,) int
        First element that each stands for.
    grids : list of (int, Grid)
        First node of each grid of cells; the nodes of cells run like the cells.
    """

    points: np.ndarray
    sheet: np.ndarray
    element: np.ndarray
    grids: list[tuple[int, Grid]]

    @classmethod
    def of(cls, fracture: Fracture) -> Nodes:
        """Cells' centres where elements lie in grids, the elements' own centroids elsewhere."""
        centroids = fracture.elements.mean(axis=1)
        alone = np.ones(len(centroids), bool)
        points, elements, grids, count = [], [], [], 0
        for grid in fracture.grids:
            first = np.arange(grid.first, grid.first + 2 * grid.rows * grid.columns, 2)
            alone[first] = alone[first + 1] = False
            points.append(0.5 * (centroids[first] + centroids[first + 1]))
            elements.append(first)
            grids.append((count, grid))
            count += len(first)
        elements.append(np.flatnonzero(alone))
        points.append(centroids[alone])
        element = np.concatenate(elements)
        return cls(np.concatenate(points), fracture.element_sheet[element], element, grids)

    def steps(self, form_factors: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """For each grid the neighbours, along rows and along columns, that each cell takes its change from.

        Parameters
        ----------
        form_factors : (m, p) float

        Returns
        -------
        list of pairs of (rows, columns) int
            +1 or -1: the next or the last cell; 0 where there is none.
        """
        found = []
        for start, grid in self.grids:
            cells = form_factors[start : start + grid.rows * grid.columns].reshape(grid.rows, grid.columns, -1)
            found.append((_flatter_side(cells, 0), _flatter_side(cells, 1)))
        return found

    def spread(self, values: np.ndarray, steps, out: np.ndarray) -> None:
        """Fill elements' values ``(e,)`` from nodes' values ``(m,)``.

        Parameters
        ----------
        values : (m,) float
            Never negative; no element's value becomes so.
        steps : list
            Of `steps`.
        out : (e,) float
        """
        cells_end = sum(grid.rows * grid.columns for _, grid in self.grids)
        out[self.element[cells_end:]] = values[cells_end:]
        for (start, grid), (along_rows, along_columns) in zip(self.grids, steps, strict=True):
            cells = values[start : start + grid.rows * grid.columns].reshape(grid.rows, grid.columns)
            change = _TO_CENTROID * (_change(cells, along_rows, 0) - _change(cells, along_columns, 1))
            change = np.clip(change, -cells, cells)
            pairs = np.stack([cells + change, cells - change], axis=2)
            out[grid.first : grid.first + 2 * grid.rows * grid.columns] = pairs.ravel()


def _flatter_side(cells: np.ndarray, axis: int) -> np.ndarray:
    count = cells.shape[axis]
    sides = np.zeros(cells.shape[:2], np.int64)
    if count < 2:
        return sides
    difference = np.abs(np.diff(cells, axis=axis)).sum(axis=2)
    ahead = np.concatenate([difference, np.full_like(difference.take([0], axis=axis), np.inf)], axis=axis)
    behind = np.roll(ahead, 1, axis=axis)
    return np.where(ahead <= behind, 1, -1)


def _change(cells: np.ndarray, side: np.ndarray, axis: int) -> np.ndarray:
    """Change per cell along an axis, taken from the chosen side."""
    place = np.indices(side.shape)
    place[axis] += side
    return (cells[tuple(place)] - cells) * side
