"""Enclosures: parts of a scene that hardly exchange light with each other, such as rooms without a door between."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

APART = 1e-3
"""Share of its light that a part exchanges with all others at most."""

_ROWS = 256


@dataclass(frozen=True, eq=False)
class Enclosures:
    """Which part of the scene each patch, node and element belongs to.

    Attributes
    ----------
    count : int
    of_patches : (p,) int
    of_nodes : (m,) int
    of_elements : (e,) int
    """

    count: int
    of_patches: np.ndarray
    of_nodes: np.ndarray
    of_elements: np.ndarray

    @classmethod
    def of(cls, factors: np.ndarray, areas: np.ndarray, form_factors: np.ndarray, first: np.ndarray) -> Enclosures:
        """Find them.

        Parameters
        ----------
        factors : (p, p) float
            Form factors from patch to patch.
        areas : (p,) float
            Of the patches [m²].
        form_factors : (m, p) float32
            From nodes to patches.
        first : (e,) int
            A node of each element.
        """
        of_patches = enclosed(areas[:, None] * np.abs(factors))
        count = int(of_patches.max(initial=0)) + 1
        of_nodes = np.zeros(len(form_factors), np.int64)
        if count > 1:
            member = np.zeros((len(of_patches), count), np.float32)
            member[np.arange(len(of_patches)), of_patches] = 1.0
            for start in range(0, len(form_factors), _ROWS):
                some = slice(start, start + _ROWS)
                of_nodes[some] = np.argmax(np.abs(form_factors[some]) @ member, axis=1)
        return cls(count, of_patches, of_nodes, of_nodes[first])

    def sums(self, of: np.ndarray, values: np.ndarray) -> np.ndarray:
        """(count,) float: sums of values over each part."""
        return np.bincount(of, weights=values, minlength=self.count)


def enclosed(flux: np.ndarray) -> np.ndarray:
    """(p,) int: numbers of the parts that patches belong to.

    From single patches on, each part that exchanges more than `APART` of its light with others joins the one that it
    exchanges most with. What exchanges nothing with anything is of part 0.

    Parameters
    ----------
    flux : (p, p) float
        What each patch gives each other, in any measure of light.
    """
    number = np.zeros(len(flux), np.int64)
    used = np.flatnonzero((flux.sum(axis=0) > 0) | (flux.sum(axis=1) > 0))
    both = flux[np.ix_(used, used)]
    both = both + both.T
    of = np.arange(len(used))
    while len(both) > 1:
        total = both.sum(axis=1)
        own = both.diagonal().copy()
        np.fill_diagonal(both, -1.0)
        partner = np.where(total - own > APART * total, both.argmax(axis=1), np.arange(len(both)))
        np.fill_diagonal(both, own)
        joined = _joined(partner)
        if int(joined.max()) + 1 == len(both):
            break
        of = joined[of]
        order = np.argsort(joined, kind="stable")
        starts = np.flatnonzero(np.diff(joined[order], prepend=-1))
        both = np.add.reduceat(np.add.reduceat(both[order], starts, axis=0)[:, order], starts, axis=1)
    number[used] = of
    return number


def _joined(partner: np.ndarray) -> np.ndarray:
    """(n,) int: numbers from 0 on, the same for whatever is joined to its partner, directly or by others."""
    number = np.arange(len(partner))
    while True:
        before = number
        number = np.minimum(number, number[partner])
        np.minimum.at(number, partner, number.copy())
        number = number[number]
        if (number == before).all():
            return np.unique(number, return_inverse=True)[1].reshape(-1)
