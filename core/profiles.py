"""Profiles: how light runs across narrow strips, told by few patches beside each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .interpolation import lagrange

_ORDER = 3
"""Patches beside each other that a parabola goes through."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Columns finer than the patches of a strip, and how these make them up.

    What is narrow is often seen in part, the brighter or the darker one: a slat behind others. There exitance is taken
    to run as the parabola that has the means of the nearest patches.

    Attributes
    ----------
    first_column, first_patch : int
        Both run across the strip first, then along it.
    along : int
        Patches along the strip.
    shares : (columns across, patches across) float
        Mean exitance of each column's part of the strip is ``shares @ exitance of patches``.
    """

    first_column: int
    first_patch: int
    along: int
    shares: np.ndarray

    def fold(self, columns: np.ndarray, patches: np.ndarray) -> None:
        """Add form factors to columns ``(r, c)`` to those to patches ``(r, p)``."""
        fine, coarse = self.shares.shape
        mine = columns[:, self.first_column : self.first_column + self.along * fine].reshape(-1, fine)
        into = patches[:, self.first_patch : self.first_patch + self.along * coarse]
        into += (mine @ self.shares).reshape(into.shape)

    def evened(self, sent: np.ndarray, landed: np.ndarray) -> None:
        """Share out what landed ``(p,)`` of the strip's light among its patches as it was sent ``(p,)``.

        Whole widths of a strip are seen at their middle: all in all right, but not patch by patch.
        """
        mine = slice(self.first_patch, self.first_patch + self.along * self.shares.shape[1])
        landed[mine] = sent[mine] * (landed[mine].sum() / max(float(sent[mine].sum()), 1e-300))


def profile_shares(groups: np.ndarray, stretches: list, finer: int) -> np.ndarray:
    """(cells · finer, groups) float: parts of cells across a strip as sums of groups' means.

    Parameters
    ----------
    groups : (cells,) int
        Group of each cell, rising.
    stretches : list of (first cell, cells)
        Nothing is told across their ends.
    finer : int
        Parts of each cell.
    """
    shares = np.zeros((len(groups) * finer, int(groups.max()) + 1))
    edges = np.arange(len(groups) * finer + 1) / finer
    for begin, count in stretches:
        first, last = int(groups[begin]), int(groups[begin + count - 1])
        borders = begin + np.concatenate([[0], np.cumsum(np.bincount(groups[begin : begin + count] - first))])
        order = min(_ORDER, last - first + 1)
        for part in range(begin * finer, (begin + count) * finer):
            start = min(max(int(groups[part // finer]) - first - order // 2, 0), last - first + 1 - order)
            at = borders[start : start + order + 1]
            # the sum up to each border is known: what interpolates it has the groups' means
            sums = np.tril(np.ones((order + 1, order)), -1) * np.diff(at)
            low, high = (lagrange(at, edges[k]) for k in (part, part + 1))
            shares[part, first + start : first + start + order] = finer * (high - low) @ sums
    return shares
