"""Layout: how closely each part of a regular run of cells has to be looked at.

Light on a plane varies evenly but for the lines where something touches it, and near its borders. Receivers and patches
are laid out accordingly: dense there, wide in between, and never across such a line.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from .fracture import Grid
from .planes import Planes

_MOST_CONTACTS = 200
"""Lines of contact in one plane beyond which they are left to be found by doubt."""

_MOST_BREAKS = 12
_ON_LINE = 1e-6


@dataclass(frozen=True, eq=False)
class Layout:
    """Where a run of cells is looked at closely: at its borders, and along the lines where other surfaces touch it.

    Attributes
    ----------
    grid : Grid
    contacts : (c, 2, 2) float
        Lines along which other surfaces touch the run, in cells.
    cut : (rows, columns) bool
        Cells that such a line cuts.
    stretches : pair of lists of (first cell, cells)
        Along either axis, between lines of contact.
    """

    grid: Grid
    contacts: np.ndarray
    cut: np.ndarray
    stretches: tuple[list, list]

    @classmethod
    def of(cls, grid: Grid, sheet: int, planes: Planes) -> Layout:
        """Layout that suits a run and what touches it."""
        touched = _touched(grid, sheet, planes)
        contacts = touched[~_along_border(touched, (grid.rows, grid.columns))]
        cut = np.zeros((grid.rows, grid.columns), bool)
        for line in contacts:
            cut[_crossed_cells(line, cut.shape)] = True
        stretches = _stretches(grid.rows, touched[:, :, 0]), _stretches(grid.columns, touched[:, :, 1])
        return cls(grid, contacts, cut, stretches)


def _stretches(count: int, places: np.ndarray) -> list:
    """Stretches of cells between the places ``(c, 2)`` of contacts."""
    inside = np.unique(np.round(places[(places > _ON_LINE) & (places < count - _ON_LINE)], 6))
    if len(inside) > _MOST_BREAKS:
        inside = inside[:0]
    low = np.floor(inside + _ON_LINE).astype(int)
    cut = low[np.abs(inside - np.rint(inside)) > _ON_LINE]  # in the middle of a cell
    borders = np.unique(
        np.concatenate([[0, count], np.rint(inside).astype(int)[np.isin(low, cut, invert=True)], cut, cut + 1])
    )
    return [(a, b - a) for a, b in itertools.pairwise(borders.tolist())]


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
        found.append(_within(ends[list(far)], (grid.rows, grid.columns)))
    lines = [line for line in found if line is not None]
    return np.array(lines) if 0 < len(lines) <= _MOST_CONTACTS else np.zeros((0, 2, 2))


def _within(line: np.ndarray, shape) -> np.ndarray | None:
    """Part of a line inside a run or along its border; None where that is a point."""
    low, high = 0.0, 1.0
    step = line[1] - line[0]
    if np.abs(step).max() < _ON_LINE:
        return None
    for axis in (0, 1):
        if abs(step[axis]) < _ON_LINE:
            if not -_ON_LINE < line[0, axis] < shape[axis] + _ON_LINE:
                return None
            continue
        ends = np.sort((np.array([0.0, shape[axis]]) - line[0, axis]) / step[axis])
        low, high = max(low, ends[0]), min(high, ends[1])
    return line[0] + np.outer([low, high], step) if high - low > _ON_LINE else None


def _along_border(lines: np.ndarray, shape) -> np.ndarray:
    """(c,) bool: lines that run along a run's border."""
    low, high = np.abs(lines) < _ON_LINE, np.abs(lines - np.array(shape)) < _ON_LINE
    return (low.all(axis=1) | high.all(axis=1)).any(axis=1)


def _crossed_cells(line: np.ndarray, shape) -> tuple[np.ndarray, np.ndarray]:
    samples = max(2, int(8 * np.abs(line[1] - line[0]).max()) + 1)
    places = line[0] + np.linspace(0.0, 1.0, samples)[:, None] * (line[1] - line[0])
    inside = (np.abs(places - np.rint(places)) > _ON_LINE).all(axis=1)
    cells = np.clip(np.floor(places[inside]).astype(int), 0, np.array(shape) - 1)
    return cells[:, 0], cells[:, 1]
