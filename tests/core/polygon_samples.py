"""Polygons for tests."""

import math

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

NUMBERS = st.floats(-1.0, 1.0)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS).map(np.array)


def regular(corners, radius=1.0, height=0.0):
    turn = 2 * math.pi * np.arange(corners) / corners
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(corners, height)], axis=1)


@st.composite
def simple_loops(draw):
    """Star-shaped loops, so never self-crossing, mostly concave; counter-clockwise."""
    count = draw(st.integers(3, 14))
    radius = np.array(draw(st.lists(st.floats(0.1, 2.0), min_size=count, max_size=count)))
    shift = np.array(draw(st.lists(st.floats(0, 0.6), min_size=count, max_size=count)))
    turn = 2 * math.pi * (np.arange(count) + shift) / count
    gaps = np.diff(np.append(turn, turn[0] + 2 * math.pi))
    assume(gaps.max() < math.pi - 0.05)
    return radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1) + draw(st.floats(-5, 5))


def flat_area(loop):
    x, y = np.asarray(loop).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
