"""Products of rows: as exact as they say, whatever is left out."""

import numpy as np
import pytest

from luzespecular.arrays import Banded, product


@pytest.fixture(scope="module")
def matrix():
    """Rows of which each sees a stretch of the columns, many of them nothing."""
    rng = np.random.default_rng(3)
    place = np.linspace(0, 2500, 700)
    near = np.abs(np.arange(3000) - place[:, None]) < rng.uniform(0, 300, (700, 1))
    near[200:400] = False
    return (rng.uniform(0, 1, near.shape) * near).astype(np.float32)


@pytest.mark.parametrize("exact", [False, True])
def test_products_without_what_is_nought(matrix, exact):
    vector = np.random.default_rng(5).uniform(0, 1e4, 3000)
    expected = matrix.astype(float) @ vector
    for found in (product(matrix, vector, exact), Banded.of(matrix).times(vector, exact)):
        np.testing.assert_allclose(found, expected, rtol=1e-12 if exact else 1e-6)


def test_what_no_row_sees_is_left_out(matrix):
    banded = Banded.of(matrix)
    assert banded.any()
    assert sum(part.size for _, part in banded.parts) < 0.4 * matrix.size
    assert not Banded.of(0 * matrix).any()
    np.testing.assert_array_equal(Banded.of(0 * matrix).times(np.ones(3000)), 0)
    assert Banded.of(matrix[:0]).times(np.ones(3000)).shape == (0,)
