"""Grid: a regular run of cells on a plane, places and lines in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons

ON_LINE = 1e-6
"""Distance from a line between cells, in cells, that still counts as on it."""


@dataclass(frozen=True, eq=False)
class Grid:
    """A run of triangles that are the halves of rows × columns cells.

    Attributes
    ----------
    first : int
        The first triangle; those of a cell follow each other, then those of the next column.
    rows, columns : int
    corner : (3,) float
        Where the first cell begins.
    along_rows, along_columns : (3,) float
        From a cell to the one in the next row, and in the next column.
    """

    first: int
    rows: int
    columns: int
    corner: np.ndarray
    along_rows: np.ndarray
    along_columns: np.ndarray

    spacing: tuple[int, int] = (1, 1)
    """Cells along either axis that are looked at as one: where the other axis needs narrower ones."""

    corners = (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)))
    """Of a cell's halves, in cells along either axis."""

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along either axis."""
        return self.rows, self.columns

    @property
    def sides(self) -> np.ndarray:
        """(2,) float: a cell's, along either axis [m]."""
        return np.linalg.norm([self.along_rows, self.along_columns], axis=1)

    @property
    def elements(self) -> slice:
        """Its triangles."""
        return slice(self.first, self.first + 2 * self.rows * self.columns)

    @property
    def normal(self) -> np.ndarray:
        """(3,) float, unit."""
        normal = polygons.cross(self.along_rows, self.along_columns)
        return normal / np.linalg.norm(normal)

    @property
    def triangles(self) -> np.ndarray:
        """(2 · rows · columns, 3, 3) float: the halves of the cells."""
        rows, columns = np.indices((self.rows + 1, self.columns + 1))
        corner = self.corner + rows[:, :, None] * self.along_rows + columns[:, :, None] * self.along_columns
        p, q, r, s = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
        cells = np.stack([np.stack([p, q, r], axis=2), np.stack([p, r, s], axis=2)], axis=2)
        return cells.reshape(-1, 3, 3)

    def in_cells(self, points) -> np.ndarray:
        """(n, 2) float: places of points ``(n, 3)`` of its plane, in cells along either axis."""
        axes = np.stack([self.along_rows, self.along_columns])
        return np.linalg.solve(axes @ axes.T, axes @ (points - self.corner).T).T

    def place(self, cells) -> np.ndarray:
        """(3,) float: the point at a place in cells."""
        return self.corner + cells[0] * self.along_rows + cells[1] * self.along_columns

    def within(self, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(k, 2, 2) float and (k,) int: parts of lines ``(c, 2, 2)`` in cells in or along the run, and which.

        Lines that only touch it in a point are left out.
        """
        start, step = lines[:, 0], lines[:, 1] - lines[:, 0]
        shape = np.array(self.shape, float)
        level = np.abs(step) < ON_LINE
        outside = level & ((start <= -ON_LINE) | (start >= shape + ON_LINE))
        divisor = np.where(level, 1.0, step)
        ends = np.sort([-start / divisor, (shape - start) / divisor], axis=0)
        low = np.where(level, 0.0, ends[0]).max(axis=1, initial=0.0)
        high = np.where(level, 1.0, ends[1]).min(axis=1, initial=1.0)
        kept = np.flatnonzero(~outside.any(axis=1) & ~level.all(axis=1) & (high - low > ON_LINE))
        return start[kept, None] + np.stack([low, high], axis=1)[kept, :, None] * step[kept, None], kept

    def along_border(self, lines: np.ndarray) -> np.ndarray:
        """(c,) bool: lines that run along the run's border."""
        low, high = np.abs(lines) < ON_LINE, np.abs(lines - np.array(self.shape)) < ON_LINE
        return (low.all(axis=1) | high.all(axis=1)).any(axis=1)
