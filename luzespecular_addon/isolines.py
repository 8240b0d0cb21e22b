"""Lines of equal illuminance on triangles whose corners have values, and where their labels stand. Pure NumPy."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class IsoLines:
    """Pieces of lines of equal value.

    Attributes
    ----------
    ends : (k, 2, 3) float
        Both ends of each piece; one piece crosses one triangle.
    values : (k,) float
        The value that each runs along.
    triangles : (k,) int
        The triangle that each crosses.
    """

    ends: NDArray[np.float64]
    values: NDArray[np.float64]
    triangles: NDArray[np.intp]


def crossed(values: ArrayLike, levels: Iterable[float]) -> NDArray[np.bool_]:
    """Return which triangles, (t,) bool, any of the levels runs through, by the values at their corners, (t, 3)."""
    lowest, highest = _ends(np.asarray(values, float))
    levels = np.unique(np.fromiter(levels, float))
    return np.searchsorted(levels, lowest, "right") < np.searchsorted(levels, highest, "right")


def _ends(values: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowest and highest value of each triangle; NaN goes through, and is no level's neighbour."""
    a, b, c = values.T  # column by column: many times as fast as along the short axis
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def trace(points: ArrayLike, values: ArrayLike, levels: Iterable[float]) -> IsoLines:
    """Return the lines along which values that vary linearly over triangles have the given levels.

    Parameters
    ----------
    points : (t, 3, 3) float
        Corners of the triangles.
    values : (t, 3) float
        Values at the corners; triangles with NaN carry no lines.
    levels : iterable of float
        Values to follow.
    """
    points, values = np.asarray(points, float), np.asarray(values, float)
    lowest, highest = _ends(values)
    found = []
    for level in map(float, levels):
        rows = np.flatnonzero((lowest < level) & (highest >= level))
        found.append((_crossings(points[rows], values[rows], level), np.full(len(rows), level), rows))
    if not found:
        return IsoLines(np.zeros((0, 2, 3)), np.zeros(0), np.zeros(0, np.intp))
    return IsoLines(*(np.concatenate(part) for part in zip(*found, strict=True)))


def _crossings(points: NDArray, values: NDArray, level: float) -> NDArray[np.float64]:
    """Return where a level enters and leaves triangles that it crosses, (k, 2, 3)."""
    above = values >= level
    every = np.arange(len(points))
    # The corner that stands alone on its side of the level: the line crosses the two edges that leave it.
    lone = np.argmax(np.where((above.sum(axis=1) == 1)[:, None], above, ~above), axis=1)
    ends = np.empty((len(points), 2, 3))
    for end, step in enumerate((1, 2)):
        other = (lone + step) % 3
        here, there = values[every, lone], values[every, other]
        share = (level - here) / (there - here)
        ends[:, end] = points[every, lone] + share[:, None] * (points[every, other] - points[every, lone])
    return ends


def parse_levels(text: str) -> list[float]:
    """Read levels as people write them: numbers divided by spaces, commas or semicolons, with ``.`` for decimals.

    Raises
    ------
    ValueError
        With the word that is no positive number.
    """
    levels = set()
    for word in text.replace(";", " ").replace(",", " ").split():
        try:
            level = float(word)
        except ValueError:
            raise ValueError(word) from None
        if not 0.0 < level < np.inf:
            raise ValueError(word)
        levels.add(level)
    return sorted(levels)


_CANDIDATES = 1_500
"""Pieces that are looked at for labels, about."""


def label_edges(lines: IsoLines, spacing: float, most: int = 96) -> NDArray[np.intp]:
    """Choose the pieces that carry labels: none where lines crowd, no two nearer than `spacing`, at most `most`.

    Labels of one level keep twice the distance; levels take turns.
    """
    middles = lines.ends.mean(axis=1)
    rows = np.flatnonzero(~_crowded(middles, lines.values, spacing / 3.0))
    rows = rows[:: 1 + len(rows) // _CANDIDATES]
    places, values = middles[rows], lines.values[rows]
    chosen: list[int] = []
    free = np.ones(len(rows), bool)
    of_level = {level: np.flatnonzero(values == level) for level in np.unique(values)}
    while of_level and len(chosen) < most:
        for level, members in list(of_level.items()):
            candidates = members[free[members]]
            if not len(candidates):
                del of_level[level]
                continue
            # The piece nearest to the middle of what is left of the level: away from the ends of its lines.
            middle = len(candidates) // 2
            centre = np.partition(places[candidates], middle, axis=0)[middle]
            best = candidates[np.argmin(_squares(places[candidates] - centre))]
            chosen.append(int(rows[best]))
            near = _squares(places - places[best])
            free &= near >= spacing**2
            free[members] &= near[members] >= 4.0 * spacing**2
            if len(chosen) == most:
                break
    return np.array(sorted(chosen), np.intp)


def _squares(vectors: NDArray) -> NDArray[np.float64]:
    return np.einsum("nc,nc->n", vectors, vectors)


def _crowded(places: NDArray, values: NDArray, width: float) -> NDArray[np.bool_]:
    """Whether another level runs through the same cell of a grid: at the edges of sun patches all of them do."""
    if not len(places) or not width > 0.0:
        return np.zeros(len(places), bool)
    cell = np.unique(np.floor(places / width), axis=0, return_inverse=True)[1].reshape(-1)
    lowest, highest = np.full(cell.max() + 1, np.inf), np.full(cell.max() + 1, -np.inf)
    np.minimum.at(lowest, cell, values)
    np.maximum.at(highest, cell, values)
    return (lowest < highest)[cell]
