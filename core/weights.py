"""Weights: elements' values as weighted sums of nodes' values, in compressed rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import runs


@dataclass(frozen=True, eq=False)
class Weights:
    """Elements' values as weighted sums of nodes' values: compressed rows.

    Attributes
    ----------
    start : (e + 1,) int
    node : (k,) int
    weight : (k,) float
    """

    start: np.ndarray
    node: np.ndarray
    weight: np.ndarray

    @classmethod
    def of(cls, element, node, weight, count: int) -> Weights:
        """From entries in any order; those of no weight are left out."""
        keep = np.flatnonzero(weight)
        order = keep[np.argsort(element[keep], kind="stable")]
        start = np.concatenate([[0], np.cumsum(np.bincount(element[order], minlength=count))])
        return cls(start, node[order], weight[order])

    @property
    def rows(self) -> np.ndarray:
        """(k,) int: element of each entry."""
        return np.repeat(np.arange(len(self.start) - 1), np.diff(self.start))

    def apply(self, values: np.ndarray) -> np.ndarray:
        """(e,) or (e, g) float from values at the nodes ``(m,)`` or ``(m, g)``."""
        if values.ndim > 1:
            return np.stack([self.apply(column) for column in values.T], axis=1)
        out = np.zeros(len(self.start) - 1)
        some = np.flatnonzero(np.diff(self.start))
        if len(some):
            out[some] = np.add.reduceat(self.weight * values.take(self.node), self.start[some])
        return out

    def rows_of(self, some: slice) -> np.ndarray:
        """(n,) int: row of each entry of some rows, from 0."""
        return np.repeat(np.arange(some.stop - some.start), np.diff(self.start[some.start : some.stop + 1]))

    def gathered(self, values: np.ndarray, nodes: int) -> np.ndarray:
        """(m,) float: the other way round, sums at the nodes of elements' values ``(e,)``."""
        return np.bincount(self.node, weights=self.weight * values[self.rows], minlength=nodes)

    def of_rows(self, rows: np.ndarray) -> Weights:
        """Those of some elements ``(k,)``, in their order."""
        count = np.diff(self.start)[rows]
        entry = runs(self.start[rows], count)
        return Weights(np.concatenate([[0], np.cumsum(count)]), self.node[entry], self.weight[entry])

    def turned(self, nodes) -> Weights:
        """The other way round: elements of each of some nodes ``(k,)``, which the rows are."""
        number = np.full(int(max(self.node.max(initial=-1), np.max(nodes, initial=-1))) + 1, -1)
        number[nodes] = np.arange(len(nodes))
        mine = np.flatnonzero(number[self.node] >= 0)
        return Weights.of(number[self.node[mine]], self.rows[mine], self.weight[mine], len(nodes))

    def replaced(self, element, node, weight) -> Weights:
        """With other entries for some elements."""
        mine = np.zeros(len(self.start) - 1, bool)
        mine[element] = True
        keep = np.flatnonzero(~np.repeat(mine, np.diff(self.start)))
        kept = np.where(mine, 0, np.diff(self.start))
        return self._merged(kept, self.node.take(keep), self.weight.take(keep), element, node, weight)

    def shared(self, quartered, element, node, weight) -> Weights:
        """With a quarter of the weight for some nodes ``quartered``, and new entries."""
        share = np.ones(int(max(self.node.max(initial=-1), np.max(quartered, initial=-1))) + 1)
        share[quartered] = 0.25
        kept = share.take(self.node)
        kept *= self.weight
        return self._merged(np.diff(self.start), self.node, kept, element, node, weight)

    def _merged(self, count, node, weight, element, more_nodes, more_weights) -> Weights:
        """So many of the entries for each element, in their order, and after them more for elements ``(k,)``."""
        some = np.flatnonzero(more_weights)
        some = some[np.argsort(element[some], kind="stable")]
        more = np.bincount(element[some], minlength=len(count))
        start = np.concatenate([[0], np.cumsum(count + more)])
        place = start[1:][element[some]] - np.cumsum(more)[element[some]] + np.arange(len(some))
        first = np.ones(start[-1], bool)
        first[place] = False
        first = np.flatnonzero(first)
        out = Weights(start, np.empty(start[-1], self.node.dtype), np.empty(start[-1]))
        out.node[first], out.weight[first] = node, weight
        out.node[place], out.weight[place] = more_nodes[some], more_weights[some]
        return out
