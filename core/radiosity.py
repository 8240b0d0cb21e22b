"""Radiosity: diffuse interreflection between patches, by cycles or until nothing is left to come."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .errors import SceneError

_UNBOUNDED = 1 - 1e-9
_MOST_STEPS = 400

_EXHAUSTED = 1e-14
"""Of a unit vector: what is less of the next direction is rounding, and there is none."""


def by_cycles(factors, reflectance, initial, cycles: int, checkpoint: Callable[[], None] = lambda: None) -> np.ndarray:
    """Illuminance after a number of diffuse reflections, E_n = Σ_{k≤n} (K ρ)^k E_0.

    Parameters
    ----------
    factors : (p, p) float, or Exchange
        K: form factors from each patch (receiver) to each patch (emitter).
    reflectance : (p,) float
    initial : (p,) float [lx]
    cycles : int
    checkpoint : callable

    Returns
    -------
    (p,) float [lx]
    """
    total = initial.copy()
    for _ in range(cycles):
        checkpoint()
        total = initial + factors @ (reflectance * total)
    return total


def until_settled(
    factors,
    reflectance,
    initial,
    tolerance: float,
    checkpoint: Callable[[], None] = lambda: None,
    gain: float | None = None,
) -> np.ndarray:
    """Illuminance after all diffuse reflections: solves (I − K ρ) E = E_0.

    GMRES (Saad & Schultz 1986) on the patches: near-white rooms, which plain cycles need hundreds of sweeps for, take a
    dozen steps.

    Parameters
    ----------
    factors, reflectance, initial
        As for `by_cycles`.
    tolerance : float
        The change left to come, relative to the mean illuminance.
    checkpoint : callable
    gain : float, optional
        `largest_gain` where it is known.

    Returns
    -------
    (p,) float [lx]

    Raises
    ------
    SceneError
        Where light multiplies without end.
    """
    scale = float(np.abs(initial).mean())
    if not len(initial) or scale == 0 or not reflectance.any():
        return initial.copy()
    gain = _bounded(largest_gain(factors, reflectance) if gain is None else gain)
    # an error e of the residual grows to at most e / (1 − gain) in the illuminance
    return _gmres(lambda e: e - factors @ (reflectance * e), initial, tolerance * (1 - gain), checkpoint)


def all_settled(exchange, reflectance: np.ndarray, initial: np.ndarray) -> np.ndarray:
    """Illuminance after all diffuse reflections, for many kinds of initial light at once, by elimination.

    Parameters
    ----------
    exchange : Exchange
    reflectance : (p,) float
    initial : (p, c) float32

    Returns
    -------
    (p, c) float32

    Raises
    ------
    SceneError
        Where light multiplies without end.
    """
    _bounded(largest_gain(exchange, reflectance))
    matrix = exchange.factors.astype(np.float32)
    made_up = np.outer(exchange.spread.astype(np.float32), exchange.missing.astype(np.float32))
    if (exchange.part != exchange.part[:1]).any():
        made_up[exchange.part[:, None] != exchange.part] = 0.0
    matrix += made_up
    matrix *= -reflectance.astype(np.float32)
    matrix[np.diag_indices_from(matrix)] += 1.0
    return np.linalg.solve(matrix, initial)


def _bounded(gain: float) -> float:
    """A gain with which light does not multiply without end; else SceneError."""
    if gain >= _UNBOUNDED:
        raise SceneError(
            "Light multiplies without end: a closed scene of diffuse reflectance 1 has no steady state; "
            "lower the reflectances below 1"
        )
    return gain


def largest_gain(factors, reflectance) -> float:
    """Upper estimate of the share of the light that survives one cycle (spectral radius of K ρ)."""
    bound = float((factors @ reflectance).max())
    if bound < 0.95:
        return bound
    field = np.ones(len(reflectance))
    for _ in range(60):
        passed = factors @ (reflectance * field)
        top = float(passed.max())
        if top <= 0:
            return 0.0
        ratio = passed / np.maximum(field, 1e-300)
        field = passed / top
        if ratio.max() - ratio.min() < 1e-6 * ratio.max():
            break
    return float(min(bound, ratio.max()))  # Collatz & Wielandt: never below the spectral radius


def _gmres(apply, right, tolerance: float, checkpoint) -> np.ndarray:
    x = right.copy()
    residual = right - apply(x)
    target = tolerance * max(float(np.linalg.norm(right)), 1e-300)
    start = float(np.linalg.norm(residual))
    if start <= target:
        return x
    basis = [residual / start]
    h = np.zeros((_MOST_STEPS + 1, _MOST_STEPS))
    weights = np.zeros(0)
    for k in range(_MOST_STEPS):
        checkpoint()
        w = apply(basis[k])
        for j, q in enumerate(basis):
            h[j, k] = float(q @ w)
            w = w - h[j, k] * q
        h[k + 1, k] = float(np.linalg.norm(w))
        goal = np.zeros(k + 2)
        goal[0] = start
        weights = np.linalg.lstsq(h[: k + 2, : k + 1], goal, rcond=None)[0]
        left = float(np.linalg.norm(goal - h[: k + 2, : k + 1] @ weights))
        if left <= target or h[k + 1, k] <= _EXHAUSTED:
            break
        basis.append(w / h[k + 1, k])
    return x + np.stack(basis[: len(weights)], axis=1) @ weights
