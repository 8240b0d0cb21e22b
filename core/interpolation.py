"""Interpolation: what values at some places weigh for a place between them."""

from __future__ import annotations

import numpy as np


def lagrange(at: np.ndarray, place) -> np.ndarray:
    """Lagrange's weights, which make polynomials of degree n - 1 exact.

    Parameters
    ----------
    at : (..., n) float
        Places with values, no two alike.
    place : (...) float
        Where to.

    Returns
    -------
    (..., n) float
    """
    at, place = np.asarray(at, float), np.asarray(place, float)[..., None]
    weights = []
    for k in range(at.shape[-1]):
        others = np.delete(at, k, axis=-1)
        weights.append(((place - others) / (at[..., [k]] - others)).prod(axis=-1))
    return np.stack(weights, axis=-1)
