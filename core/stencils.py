"""Lines of nodes along stretches, and the weights by which these tell of places between them and of each other."""

from __future__ import annotations

import numpy as np

from .interpolation import lagrange

_FIRST, _GROWTH = 0.6, 0.6
"""Spaces between the lattice's lines, in cells: the first, and how fast they grow with the distance from the border."""

_SPACES, _FEWEST_CELLS = 6, 2
"""Widest spaces between lines of nodes: so many in a stretch, but of so many cells at least."""

_HALF = 0.65
"""Share of a space that may be left open before the middle."""

_BESIDE = 0.12
"""Distance from the end of a stretch to its first line of nodes, in cells: light changes fast beside other planes."""


def left_out(lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 4) int and float: for each line the others that would foretell it, by these weights; itself, if outermost."""
    count = len(lines)
    others, weights = np.repeat(np.arange(count)[:, None], 4, axis=1), np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    if count >= 5:
        inner = np.arange(1, count - 1)
        start = np.clip(inner - 2, 0, count - 5)
        around = start[:, None] + np.arange(4)
        others[inner] = around + (around >= inner[:, None])
        weights[inner] = lagrange(lines[others[inner]], lines[inner])
    return others, weights


def lines_along(count: int, widest: float, spacing: int = 1) -> np.ndarray:
    """Places of the lines of nodes along a stretch, in cells: close at its ends, wider and wider towards its middle.

    Spaces are no wider than ``widest`` or a few cells. ``spacing`` cells are looked at as one where they fill the
    stretch.
    """
    if spacing > 1 and count % spacing == 0:
        return spacing * lines_along(count // spacing, widest / spacing)
    if count == 1:
        return np.array([_BESIDE, 1 - _BESIDE])
    middle, widest = 0.5 * count, max(_FEWEST_CELLS, min(count / _SPACES, widest))
    half = [_BESIDE]
    while (left := middle - half[-1]) > _HALF * (space := min(widest, _FIRST + _GROWTH * half[-1])):
        # never in the very middle, where other surfaces often lie in line
        half.append(half[-1] + min(space, 2 / 3 * left))
    return np.array(half + [count - place for place in half[::-1]])


def stencils(stretches: list, cells: np.ndarray, centre: float, places: np.ndarray, order: int):
    """Lines that serve cells ``(n, order)``, and Lagrange's weights for places in them ``(k, n, order)``.

    Lines are those around each cell's own ``centre``; unused ones weigh nothing.
    """
    numbers, weights = np.zeros((len(cells), order), np.int64), np.zeros((len(places), len(cells), order))
    first = 0
    for begin, count, lines in stretches:
        mine = np.flatnonzero((cells >= begin) & (cells < begin + count))
        used = min(order, len(lines))
        start = np.clip(np.searchsorted(lines, cells[mine] + centre) - used // 2, 0, len(lines) - used)
        index = start[:, None] + np.arange(used)
        at, place = lines[index], places[:, None] + cells[mine]
        weights[:, mine, :used] = lagrange(at, place)
        numbers[mine, :used] = first + index
        first += len(lines)
    return numbers, weights
