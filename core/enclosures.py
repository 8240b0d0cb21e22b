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
        of_patches = enclosed(areas[:, None] * factors)
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
    flux = np.array(flux, float)
    of = np.arange(len(flux))
    used = np.ones(len(flux), bool)
    while len(flux) > 1:
        own = flux.diagonal().copy()
        sent, got = flux.sum(axis=1), flux.sum(axis=0)
        if len(of) == len(flux):
            used = (sent > 0) | (got > 0)
        np.fill_diagonal(flux, -1.0)
        partner = flux.argmax(axis=1)
        blind = np.flatnonzero(sent <= own)
        partner[blind] = flux[:, blind].argmax(axis=0)
        np.fill_diagonal(flux, own)
        closed = sent + got - 2 * own <= APART * (sent + got)
        joined = _joined(np.where(closed, np.arange(len(flux)), partner))
        if int(joined.max()) + 1 == len(flux):
            break
        of, flux = joined[of], _contracted(flux, joined)
    numbers = np.zeros(len(of), np.int64)
    numbers[used] = np.unique(of[used], return_inverse=True)[1].reshape(-1)
    return numbers


def _contracted(flux: np.ndarray, joined: np.ndarray) -> np.ndarray:
    """Flux between parts, of what flows between their members."""
    order = np.argsort(joined, kind="stable")
    starts = np.flatnonzero(np.diff(joined[order], prepend=-1))
    rows = np.stack([flux[some].sum(axis=0) for some in np.split(order, starts[1:])])
    return np.add.reduceat(rows[:, order], starts, axis=1)


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
