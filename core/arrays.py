"""Arrays: picking from them, and products of rows, in the ways that NumPy does fast."""

from __future__ import annotations

import numpy as np

_PRODUCT_ROWS = 128
_PRODUCT_COLUMNS = 2048


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


def places_among(known: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(k,) int: where each of ``wanted`` is among ascending numbers ``known`` (n,); (k,) bool: whether it is there."""
    if not len(known):
        return np.zeros(len(wanted), np.int64), np.zeros(len(wanted), bool)
    place = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    return place, known[place] == wanted


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
    """(m,) or (m, k) float: a float32 matrix times a float64 vector or vectors ``(c,)`` or ``(c, k)``.

    Summed in float32, some columns at a time, which errs by less than 1e-6; ``exact``: in float64, some rows at a time,
    so that sums of products are products of sums.
    """
    out = np.zeros((len(matrix), *vector.shape[1:]))
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
