"""Checks of users' numbers: what passes, and what the message says."""

import math
from fractions import Fraction

import numpy as np
import pytest

from luzespecular.checks import checked_array, checked_number
from luzespecular.errors import SceneError


@pytest.mark.parametrize("value", [3, 3.0, np.float32(3), np.int64(3), np.array(3.0), Fraction(3)])
def test_every_real_number_passes(value):
    number = checked_number(value, "x", low=3, high=3)
    assert number == 3.0 and type(number) is float


@pytest.mark.parametrize("value", [True, np.bool_(True), "3", None, 1j, [3.0], np.array([3.0])])
def test_what_is_no_number(value):
    with pytest.raises(SceneError, match=r"^x must be a number, not .*; give lx$"):
        checked_number(value, "x", remedy="give lx")


@pytest.mark.parametrize(
    ("value", "limits", "message"),
    [
        (math.nan, {}, "x must be a finite number, not nan"),
        (-math.inf, {}, "x must be a finite number, not -inf"),
        (-1, {"low": 0}, "x is -1; it must be 0 or more"),
        (2, {"high": 1}, "x is 2; it must be 1 or less"),
        (2, {"low": 0, "high": 1}, "x is 2; it must be between 0 and 1"),
    ],
)
def test_messages_of_numbers_and_arrays(value, limits, message):
    with pytest.raises(SceneError) as caught:
        checked_number(value, "x", **limits)
    assert str(caught.value) == message
    with pytest.raises(SceneError, match=r"^x is \S+ at \(1, 0\); it must be finite"):
        checked_array([[0.5], [value]], "x", **limits)


def test_arrays_are_copied_as_float64():
    given = np.array([1, 2], dtype=np.int32)
    array = checked_array(given, "x", low=0)
    assert array.dtype == np.float64
    floats = np.array([1.0, 2.0])
    assert checked_array(floats, "x") is not floats
    assert checked_array(5, "x").shape == ()


@pytest.mark.parametrize("values", ["up", [[1, 2], [3]], [None, 1.0], [True, False]])
def test_what_is_no_array_of_numbers(values):
    with pytest.raises(SceneError, match=r"^x must be numbers"):
        checked_array(values, "x")
