"""Pieces of bright polygons: padding and repeated corners."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from luzespecular import polygons
from luzespecular.pieces import tightened

CORNERS = st.lists(st.tuples(st.integers(3, 6), st.lists(st.integers(0, 5), max_size=4)), min_size=1, max_size=5)


def ring(corners):
    angle = 2 * np.pi * np.arange(corners) / corners
    return np.stack([np.cos(angle), np.sin(angle), np.zeros(corners)], axis=1)


@given(CORNERS)
def test_corners_that_repeat_count_once(given):
    expected = [ring(corners) for corners, _ in given]
    repeated = [
        np.repeat(loop, 1 + np.isin(np.arange(len(loop)), twice), axis=0)
        for loop, (_, twice) in zip(expected, given, strict=True)
    ]
    rounding = [loop + 1e-14 * np.arange(len(loop))[:, None] for loop in repeated]
    for loops in (repeated, rounding):
        shapes, counts = tightened(polygons.pad(loops, 12)[0])
        np.testing.assert_array_equal(counts, [len(loop) for loop in expected])
        assert shapes.shape[1] == counts.max()
        for shape, loop in zip(shapes, expected, strict=True):
            kept = shape[: len(loop)]
            turns = [np.abs(np.roll(kept, k, axis=0) - loop).max() for k in range(len(loop))]
            assert min(turns) < 1e-12
            np.testing.assert_array_equal(shape[len(loop) :], np.broadcast_to(kept[-1], shape[len(loop) :].shape))


def test_what_is_tight_stays_as_it_is():
    shapes = np.stack([ring(4), 2 * ring(4)])
    assert tightened(shapes)[0] is shapes
    none, counts = tightened(shapes[:0])
    assert len(none) == len(counts) == 0
    np.testing.assert_array_equal(tightened(np.zeros((1, 4, 3)))[1], 1)
