"""Arrays: picking from them, and products of rows, in the ways that NumPy does fast."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_PRODUCT_ROWS = 128
_PRODUCT_COLUMNS = 2048

_FEW_COLUMNS = 1 / 3
"""Over all columns: rows with more of them are not copied."""


def pick(matrix: np.ndarray, row, column) -> np.ndarray:
    """(n,) elements of a matrix ``(r, k)``, whichever of its axes is contiguous; ``row`` and ``column`` (n,) int."""
    if matrix.flags.c_contiguous:
        return matrix.ravel().take(row * matrix.shape[1] + column)
    if matrix.flags.f_contiguous:
        return matrix.T.ravel().take(column * matrix.shape[0] + row)
    return matrix[row, column]


def runs(first, count) -> np.ndarray:
    """(sum of counts,) int: from each ``first`` (s,) on so many numbers in a row."""
    return np.arange(int(np.sum(count))) + np.repeat(first - np.cumsum(count) + count, count)


def onto(vectors: np.ndarray, axis) -> np.ndarray:
    """(n,) inner products of vectors ``(n, 3)`` with one: BLAS would wake threads for it that then wait for work."""
    return vectors[:, 0] * axis[0] + vectors[:, 1] * axis[1] + vectors[:, 2] * axis[2]


def dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) inner products of vectors ``(n, 3)``."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def box_corners(low, high) -> np.ndarray:
    """(8, 3) float: corners of a box from its lowest and its highest ``(3,)``."""
    return np.where(np.indices((2, 2, 2)).reshape(3, -1).T == 1, high, low)


def product(matrix: np.ndarray, vector: np.ndarray, exact: bool = False) -> np.ndarray:
    """(m,) float: a float32 matrix times a float64 vector.

    Summed in float32, some columns at a time, which errs by less than 1e-6; ``exact``: in float64, some rows at a time,
    so that sums of products are products of sums.
    """
    out = np.zeros(len(matrix))
    if exact:
        for first in range(0, len(matrix), _PRODUCT_ROWS):
            rows = slice(first, first + _PRODUCT_ROWS)
            out[rows] = matrix[rows].astype(float) @ vector
        return out
    scale = float(np.abs(vector).max(initial=0.0))
    if scale == 0 or not len(matrix):
        return out
    shares = (vector / scale).astype(np.float32)
    for first in range(0, len(shares), _PRODUCT_COLUMNS):
        columns = slice(first, first + _PRODUCT_COLUMNS)
        out += matrix[:, columns] @ shares[columns]
    return scale * out


@dataclass(frozen=True, eq=False)
class Banded:
    """A matrix whose rows share their zeros with those beside them: without the columns that some rows have none in.

    Attributes
    ----------
    parts : list of ((c,) int, (r, c))
        Columns, and what is in them, of some rows after others.
    """

    parts: list[tuple[np.ndarray, np.ndarray]]

    @classmethod
    def of(cls, matrix: np.ndarray) -> Banded:
        """That of a matrix."""
        parts = []
        for first in range(0, len(matrix), _PRODUCT_ROWS):
            some = matrix[first : first + _PRODUCT_ROWS]
            columns = np.flatnonzero(some.any(axis=0))
            if len(columns) > _FEW_COLUMNS * matrix.shape[1]:
                parts.append((np.arange(matrix.shape[1]), some))
            else:
                parts.append((columns, some.take(columns, axis=1)))
        return cls(parts)

    def any(self) -> bool:
        """Whether there is anything but zeros in it."""
        return any(part.size > 0 for _, part in self.parts)

    def times(self, vector: np.ndarray, exact: bool = False) -> np.ndarray:
        """(m,) float: see `product`."""
        found = [product(part, vector.take(columns), exact) for columns, part in self.parts]
        return np.concatenate(found) if found else np.zeros(0)
