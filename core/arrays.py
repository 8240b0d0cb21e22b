"""Arrays: picking from them, and products of rows, in the ways that NumPy does fast."""

from __future__ import annotations

import numpy as np


def pick(matrix: np.ndarray, row, column) -> np.ndarray:
    """(n,) elements of a matrix ``(r, k)``, whichever of its axes is contiguous; ``row`` and ``column`` (n,) int."""
    if matrix.flags.c_contiguous:
        return matrix.ravel().take(row * matrix.shape[1] + column)
    if matrix.flags.f_contiguous:
        return matrix.T.ravel().take(column * matrix.shape[0] + row)
    return matrix[row, column]


def onto(vectors: np.ndarray, axis) -> np.ndarray:
    """(n,) inner products of vectors ``(n, 3)`` with one: BLAS would wake threads for it that then wait for work."""
    return vectors[:, 0] * axis[0] + vectors[:, 1] * axis[1] + vectors[:, 2] * axis[2]


def dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) inner products of vectors ``(n, 3)``."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]
