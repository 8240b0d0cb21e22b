"""Sparse rows: what receivers see of the sky, without the parcels that none of those around them sees."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .arrays import places_among, product


@dataclass(frozen=True, eq=False)
class Block:
    """Some rows of a matrix: zeros but in some columns.

    Attributes
    ----------
    rows : (r,) int
    columns : (c,) int
        Ascending.
    values : (r, c) float32
    """

    rows: np.ndarray
    columns: np.ndarray
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class SparseRows:
    """A matrix of which rows that are entered together share their zeros; all others are zeros alone.

    Attributes
    ----------
    shape : (int, int)
        Rows and columns.
    blocks : list of Block
        No row is in two of them.
    """

    shape: tuple[int, int]
    blocks: list[Block] = field(default_factory=list)

    def enter(self, rows: np.ndarray, values: np.ndarray) -> None:
        """Enter rows ``(r,)`` that are not there yet, of which ``values`` (r, columns) is all; threads may do so."""
        columns = np.flatnonzero(values.any(axis=0))
        self.blocks.append(Block(rows, columns, values.take(columns, axis=1)))

    def of(self, count: int) -> SparseRows:
        """The same blocks in a matrix of so many rows, in the order of these, in whatever order they were entered."""
        blocks = sorted((block for block in self.blocks if len(block.rows)), key=lambda block: int(block.rows[0]))
        return SparseRows((count, self.shape[1]), blocks)

    def any(self) -> bool:
        """Whether there is anything but zeros in it."""
        return any(block.values.size > 0 for block in self.blocks)

    def held(self) -> np.ndarray:
        """(m,) bool: rows that were entered, be they zeros."""
        held = np.zeros(self.shape[0], bool)
        for block in self.blocks:
            held[block.rows] = True
        return held

    def columns(self) -> np.ndarray:
        """(c,) bool: columns with anything but zeros."""
        found = np.zeros(self.shape[1], bool)
        for block in self.blocks:
            found[block.columns] = True
        return found

    def times(self, vector: np.ndarray, exact: bool = False) -> np.ndarray:
        """(m,) or (m, k) float: product with a vector or vectors ``(c,)`` or ``(c, k)``; see `arrays.product`."""
        out = np.zeros((self.shape[0], *vector.shape[1:]))
        for block in self.blocks:
            out[block.rows] = product(block.values, vector.take(block.columns, axis=0), exact)
        return out

    def sums_of_rows(self, weights: np.ndarray, first: int = 0) -> np.ndarray:
        """(m - first, k) float: ``times`` for few weights ``(c, k)`` float32, of the later rows, without BLAS."""
        out = np.zeros((self.shape[0] - first, weights.shape[1]))
        for block in self.blocks:
            late = np.flatnonzero(block.rows >= first)
            if len(late):
                sums = [np.einsum("rc,c->r", block.values, w) for w in weights.T.take(block.columns, axis=1)]
                out[block.rows[late] - first] = np.stack(sums, axis=1)[late]
        return out

    def row_totals(self) -> np.ndarray:
        """(m,) float: sums of the rows."""
        return self.times(np.ones(self.shape[1]))

    def sums(self) -> np.ndarray:
        """(c,) float: sums of the columns."""
        out = np.zeros(self.shape[1])
        for block in self.blocks:
            out[block.columns] += block.values.sum(axis=0, dtype=float)
        return out

    def some_columns(self, columns: np.ndarray) -> np.ndarray:
        """(m, k) float32: some of the columns."""
        out = np.zeros((self.shape[0], len(columns)), np.float32)
        for block in self.blocks:
            place, known = places_among(block.columns, columns)
            out[block.rows[:, None], np.flatnonzero(known)] = block.values.take(place[known], axis=1)
        return out

    def some_rows(self, rows: np.ndarray) -> np.ndarray:
        """(k, c) float32: some of the rows."""
        out = np.zeros((len(rows), self.shape[1]), np.float32)
        for block in self.blocks:
            order = np.argsort(block.rows)
            place, known = places_among(block.rows[order], rows)
            if known.any():
                out[np.flatnonzero(known)[:, None], block.columns] = block.values[order[place[known]]]
        return out

    def dense(self) -> np.ndarray:
        """(m, c) float32: all of it."""
        return self.some_rows(np.arange(self.shape[0]))

    def packed(self) -> dict[str, np.ndarray]:
        """Arrays that tell all of it, by name."""
        blocks = self.blocks
        sizes = np.array([block.values.shape for block in blocks], np.int64).reshape(-1, 2)
        return {
            "sizes": sizes,
            "rows": np.concatenate([np.zeros(0, np.int64), *(block.rows for block in blocks)]),
            "columns": np.concatenate([np.zeros(0, np.int64), *(block.columns for block in blocks)]),
            "values": np.concatenate([np.zeros(0, np.float32), *(block.values.ravel() for block in blocks)]),
        }

    @classmethod
    def unpacked(cls, shape: tuple[int, int], sizes, rows, columns, values) -> SparseRows:
        """What `packed` has told; ValueError where its arrays do not fit each other."""
        ends = [np.cumsum(count)[:-1] for count in (sizes[:, 0], sizes[:, 1], sizes.prod(axis=1))]
        whole = int(sizes[:, 0].sum()), int(sizes[:, 1].sum()), int(sizes.prod(axis=1).sum())
        if (sizes < 0).any() or whole != (len(rows), len(columns), len(values)) or len(np.unique(rows)) < len(rows):
            raise ValueError("blocks of rows do not fit")
        parts = zip(np.split(rows, ends[0]), np.split(columns, ends[1]), np.split(values, ends[2]), strict=True)
        return cls(shape, [Block(r, c, v.reshape(len(r), len(c))) for r, c, v in parts] if len(sizes) else [])
