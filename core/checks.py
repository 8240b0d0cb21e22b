"""Checks of numbers that users give: finite, within range, or a SceneError that says which and what to do."""

from __future__ import annotations

import numbers

import numpy as np

from .errors import SceneError


def checked_number(value, name: str, *, low: float = -np.inf, high: float = np.inf, remedy: str = "") -> float:
    """Return `value` as a float after checking it.

    Parameters
    ----------
    value : float
        Any real number; booleans, strings, NaN and infinities are refused.
    name : str
        What the message calls it, e.g. ``"Sun: normal_illuminance"``.
    low, high : float, optional
        Inclusive limits, in the value's own unit.
    remedy : str, optional
        A sentence for the end of the message.

    Returns
    -------
    float

    Raises
    ------
    SceneError
        Where the value is no finite number or lies outside the limits.
    """
    scalar = value.item() if isinstance(value, np.ndarray | np.generic) and np.ndim(value) == 0 else value
    if isinstance(scalar, bool) or not isinstance(scalar, numbers.Real):
        raise SceneError(_sentence(f"{name} must be a number, not {value!r}", remedy))
    number = float(scalar)
    if not np.isfinite(number):
        raise SceneError(_sentence(f"{name} must be a finite number, not {number}", remedy))
    if not low <= number <= high:
        raise SceneError(_sentence(f"{name} is {number:g}; it must be {_limits(low, high)}", remedy))
    return number


def checked_array(values, name: str, *, low: float = -np.inf, high: float = np.inf, remedy: str = "") -> np.ndarray:
    """Return `values` as a float64 array after checking every element as :func:`checked_number` does.

    Parameters
    ----------
    values : array_like
        Real numbers of any shape.
    name, low, high, remedy
        As in :func:`checked_number`.

    Returns
    -------
    ndarray of float64
        Of the shape of `values`.

    Raises
    ------
    SceneError
        Naming the first offending element.
    """
    try:
        raw = np.asarray(values)
    except ValueError:
        raise SceneError(_sentence(f"{name} must be numbers in a regular array", remedy)) from None
    if raw.dtype.kind not in "iuf":
        raise SceneError(_sentence(f"{name} must be numbers, not {_shortened(values)}", remedy))
    array = raw.astype(np.float64)
    wrong = ~(np.isfinite(array) & (array >= low) & (array <= high))
    if wrong.any():
        place = tuple(int(i) for i in np.argwhere(wrong)[0])
        where = f" at {place[0] if len(place) == 1 else place}" if place else ""
        limits = _limits(low, high)
        expected = f"finite and {limits}" if limits else "finite"
        raise SceneError(_sentence(f"{name} is {array[place]:g}{where}; it must be {expected}", remedy))
    return array


def _limits(low: float, high: float) -> str:
    if np.isinf(low) and np.isinf(high):
        return ""
    if np.isinf(high):
        return f"{low:g} or more"
    if np.isinf(low):
        return f"{high:g} or less"
    return f"between {low:g} and {high:g}"


def _sentence(statement: str, remedy: str) -> str:
    return f"{statement}; {remedy}" if remedy else statement


def _shortened(values, length: int = 60) -> str:
    text = repr(values)
    return text if len(text) <= length else text[: length - 1] + "…"
