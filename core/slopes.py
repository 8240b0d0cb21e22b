"""Slopes: how values on elements change over them, told by the neighbours in their run."""

from __future__ import annotations

import numpy as np

from .grid import Grid


def slopes(grid: Grid, values: np.ndarray) -> np.ndarray:
    """Slopes along a run of values that are means over its elements.

    Parameters
    ----------
    grid : Grid
    values : (e,) float
        Of all elements of the scene.

    Returns
    -------
    (n, 3) float [1/m]
        Of the run's elements; across a crease none.
    """
    cells = values[grid.elements].reshape(*grid.shape, 2).mean(axis=2)
    steps = np.stack([_steps(cells), _steps(cells.T).T], axis=2).reshape(-1, 2)
    axes = np.stack([grid.along_rows, grid.along_columns])
    return np.repeat(steps @ np.linalg.pinv(axes).T, 2, axis=0)


def _steps(cells: np.ndarray) -> np.ndarray:
    """(r, c) float: change from row to row, the lesser of those to either side, 0 where these are opposite."""
    if len(cells) == 1:
        return np.zeros(cells.shape)
    change = np.diff(cells, axis=0)
    before, after = np.concatenate([change[:1], change]), np.concatenate([change, change[-1:]])
    return np.where(before * after > 0, np.where(np.abs(before) < np.abs(after), before, after), 0.0)
