"""Layout: how closely each part of a regular run of cells has to be looked at.

Light on a plane varies evenly but for the lines where something touches it, and near its borders. Receivers and patches
are laid out accordingly: dense there, wide in between, and never across such a line.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .grid import ON_LINE, Grid
from .nearness import near_edges
from .planes import Planes

_MOST_CONTACTS = 200
"""Lines of contact in one plane beyond which they are left to be found by doubt."""

_MOST_OUTLINES = 5_000
"""Outlines of a scene beyond which lines of contact are looked for in runs alone."""

_MOST_BREAKS = 12
_CLOSE = 4.0
"""Height of an edge above a plane, in cells, up to which the light below changes over few of them."""

_OF_BREADTH = 0.5
"""Widest spaces between receivers, over the breadth of the scene: far from an opening light falls about as fast."""

_APART = 4
"""Cells at least between the places below two such edges that end stretches."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Where a run of cells is looked at closely: at its borders, and along the lines where other surfaces touch it.

    Attributes
    ----------
    grid : Grid
    contacts : (c, 2, 2) float
        Lines along which other surfaces touch the run, in cells.
    crossed : tuple of (k,) int
        Numbers of the cells that each of them cuts.
    stretches : pair of lists of (first cell, cells)
        Along either axis, between lines of contact.
    widest : (2,) float
        Spaces between receivers are no wider along either axis, in cells.
    """

    grid: Grid
    contacts: np.ndarray
    crossed: tuple[np.ndarray, ...]
    stretches: tuple[list, list]
    widest: np.ndarray

    @classmethod
    def of(cls, grid: Grid, sheet: int, planes: Planes, breadth: float) -> Layout:
        """Layout that suits a run, what touches it and what passes close over it, in a scene of some breadth."""
        touched = _touched(grid, sheet, planes)
        passed = _passed(grid, sheet, planes)
        rows, columns = (
            _stretches(grid.shape[axis], touched[:, :, axis], passed[axis], grid.spacing[axis]) for axis in (0, 1)
        )
        return cls._with(grid, touched, (rows, columns), breadth)

    @classmethod
    def over(cls, sheet: int, count, axes: np.ndarray, low: np.ndarray, extent: np.ndarray, planes: Planes) -> Layout:
        """So many cells ``(2,)`` over a sheet that is no run, with the lines where other surfaces touch it.

        Parameters
        ----------
        sheet : int
        count : (2,) int
        axes : (2, 3) float
            Of the sheet.
        low, extent : (2,) float
            Of the sheet along them [m].
        planes : Planes
        """
        front = sheet % len(planes.sheet_surface)
        normal = planes.sheet_normal[front]
        height = planes.outlines[np.argmax(planes.outline_sheet == front), 0] @ normal
        rows, columns = (int(c) for c in count)
        grid = Grid(
            0, rows, columns, low @ axes + height * normal, axes[0] * extent[0] / rows, axes[1] * extent[1] / columns
        )
        few = len(planes.outlines) <= _MOST_OUTLINES
        return cls._with(grid, _touched(grid, sheet, planes) if few else np.zeros((0, 2, 2)), ([], []))

    @classmethod
    def _with(cls, grid: Grid, touched: np.ndarray, stretches: tuple[list, list], breadth: float = np.inf) -> Layout:
        contacts = touched[~grid.along_border(touched)]
        crossed = tuple(_crossed_cells(line, grid.shape) for line in contacts)
        return cls(grid, contacts, crossed, stretches, _OF_BREADTH * breadth / grid.sides)

    @cached_property
    def cut(self) -> np.ndarray:
        """(rows, columns) bool: cells that a line of contact cuts."""
        cut = np.zeros(self.grid.rows * self.grid.columns, bool)
        for cells in self.crossed:
            cut[cells] = True
        return cut.reshape(self.grid.shape)

    def beside_askew(self, reach: float) -> np.ndarray:
        """(k,) int: cells whose middle is nearer than so many cells to a line of contact askew to the run."""
        lines = self.contacts[(np.abs(self.contacts[:, 1] - self.contacts[:, 0]) > ON_LINE).all(axis=1)]
        row, column = np.divmod(np.arange(self.grid.rows * self.grid.columns), self.grid.columns)
        middle = np.stack([row, column], axis=1) + 0.5
        near = np.zeros(len(middle), bool)
        for start, end in lines:
            share = np.clip((middle - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
            near |= np.linalg.norm(middle - start - share[:, None] * (end - start), axis=1) < reach
        return np.flatnonzero(near)

    def cell_of(self, places: np.ndarray) -> np.ndarray:
        """(n,) int: number of the cell that each place ``(n, 2)`` in cells lies in, or next to."""
        row, column = np.clip(np.floor(places).astype(int), 0, np.array(self.grid.shape) - 1).T
        return row * self.grid.columns + column

    def sides(self, places: np.ndarray) -> np.ndarray:
        """(n,) int: the same for places ``(n, 2)``, in cells, on the same side of all lines that cut their cell."""
        cell, sides = self.cell_of(places), np.zeros(len(places), np.int64)
        for (a, b), crossed in zip(self.contacts, self.crossed, strict=True):
            mine = np.isin(cell, crossed)
            step, way = b - a, places - a
            beyond = step[0] * way[:, 1] > step[1] * way[:, 0]
            sides = np.unique(3 * sides + np.where(mine, 1 + beyond, 0), return_inverse=True)[1].reshape(-1)
        return sides


def breadth_of(planes: Planes) -> float:
    """Middle one of a scene's three extents along its own axes [m]: of a corridor or shaft the larger one across."""
    corners = np.unique(planes.outlines.reshape(-1, 3), axis=0)
    return float(2 * np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(corners.T, bias=True))[1], 0)))


def _stretches(count: int, contacts: np.ndarray, passed: np.ndarray, spacing: int) -> list:
    """Stretches of cells between the places ``(c, 2)`` of contacts, and between cells below what passes over."""
    inside = np.unique(np.round(contacts[(contacts > ON_LINE) & (contacts < count - ON_LINE)], 6))
    if len(inside) > _MOST_BREAKS:
        inside = inside[:0]
    low = np.minimum(np.floor(inside + ON_LINE).astype(int), count - 1)
    cut = low[np.abs(inside - np.rint(inside)) > ON_LINE]  # in the middle of a cell
    whole = np.rint(inside).astype(int)[np.isin(low, cut, invert=True)]
    borders = np.unique(np.concatenate([[0, count], whole, cut, cut + 1]))
    for place in (spacing * np.unique(np.rint(passed / spacing).astype(int))).tolist():
        if len(borders) <= _MOST_BREAKS + 1 and np.abs(borders - place).min() >= _APART * spacing:
            borders = np.union1d(borders, place)
    return [(a, b - a) for a, b in itertools.pairwise(borders.tolist())]


def _passed(grid: Grid, sheet: int, planes: Planes) -> tuple[np.ndarray, np.ndarray]:
    """Places along either axis, in cells, below edges that pass so closely that light changes over few of them."""
    fronts = len(planes.sheet_surface)
    normal = planes.sheet_normal[sheet % fronts] * (1.0 if sheet < fronts else -1.0)
    sides = grid.sides * grid.spacing
    edges = near_edges(grid, planes, normal, _CLOSE * float(sides.max()))
    step = np.abs(edges.lines[:, 1] - edges.lines[:, 0])
    rows, columns = (
        edges.lines[(step[:, axis] < ON_LINE) & (edges.heights <= _CLOSE * sides[axis]), 0, axis] for axis in (0, 1)
    )
    return rows, columns


def _touched(grid: Grid, sheet: int, planes: Planes) -> np.ndarray:
    """(c, 2, 2) float: where other surfaces touch or cross a run of cells, in cells along its axes."""
    fronts = len(planes.sheet_surface)
    normal, tolerance = planes.sheet_normal[sheet % fronts], 1e-9 * planes.size
    height = (planes.outlines - grid.corner) @ normal
    touching = (height.min(axis=1) <= tolerance) & (height.max(axis=1) >= -tolerance)
    touching &= np.abs(height).max(axis=1) > tolerance
    found = []
    for outline, above in zip(planes.outlines[touching], height[touching], strict=True):
        after, next_above = np.roll(outline, -1, axis=0), np.roll(above, -1)
        crossing = np.flatnonzero(
            (np.minimum(above, next_above) < -tolerance) & (np.maximum(above, next_above) > tolerance)
        )
        share = (above / np.where(above == next_above, 1.0, above - next_above))[crossing, None]
        points = np.concatenate(
            [outline[np.abs(above) <= tolerance], outline[crossing] * (1 - share) + after[crossing] * share]
        )
        ends = grid.in_cells(points)
        far = np.unravel_index(np.argmax(np.linalg.norm(ends[:, None] - ends, axis=2)), (len(ends),) * 2)
        found.append(ends[list(far)])
    lines, _ = grid.within(np.array(found).reshape(-1, 2, 2))
    return lines if len(lines) <= _MOST_CONTACTS else lines[:0]


def _crossed_cells(line: np.ndarray, shape) -> np.ndarray:
    """Numbers of the cells that a line ``(2, 2)`` in cells cuts, not only touches."""
    start, step = line[0], line[1] - line[0]
    low, high = np.ceil(line.min(axis=0)), np.floor(line.max(axis=0))
    ends = [
        (np.arange(a, b + 1) - start[axis]) / step[axis]
        for axis, (a, b) in enumerate(zip(low, high, strict=True))
        if abs(step[axis]) > ON_LINE
    ]
    ends = np.unique(np.concatenate([[0.0, 1.0], *ends]))
    ends = ends[(ends >= 0) & (ends <= 1)]
    middles = 0.5 * (ends[1:] + ends[:-1])[np.diff(ends) * np.linalg.norm(step) > ON_LINE]
    places = start + middles[:, None] * step
    inside = (np.abs(places - np.rint(places)) > ON_LINE).all(axis=1)
    cells = np.clip(np.floor(places[inside]).astype(int), 0, np.array(shape) - 1)
    return np.unique(cells[:, 0] * shape[1] + cells[:, 1])
