"""Sparse rows: what is entered comes back, and is multiplied as if nothing were left out."""

import numpy as np
import pytest

from luzespecular.sparse import SparseRows


@pytest.fixture(scope="module")
def matrix():
    """Rows of which each sees a stretch of the columns, many of them nothing."""
    rng = np.random.default_rng(3)
    place = np.linspace(0, 2500, 700)
    near = np.abs(np.arange(3000) - place[:, None]) < rng.uniform(0, 300, (700, 1))
    near[200:400] = False
    return (rng.uniform(0, 1, near.shape) * near).astype(np.float32)


def entered(matrix, order=(2, 0, 1)):
    """The matrix, entered in parts, one after the other or otherwise; the last rows are not entered."""
    sparse = SparseRows((1000, matrix.shape[1]))
    parts = np.array_split(np.arange(600), 3)
    for part in order:
        sparse.enter(parts[part], matrix[parts[part]])
    return sparse.of(len(matrix))


@pytest.fixture(scope="module")
def whole(matrix):
    return np.where(np.arange(len(matrix))[:, None] < 600, matrix, 0)


def test_what_is_entered_comes_back(matrix, whole):
    sparse = entered(matrix)
    np.testing.assert_array_equal(sparse.dense(), whole)
    rows, columns = np.array([650, 3, 450, 4]), np.array([2999, 17, 18])
    np.testing.assert_array_equal(sparse.some_rows(rows), whole[rows])
    np.testing.assert_array_equal(sparse.some_columns(columns), whole[:, columns])
    np.testing.assert_array_equal(sparse.columns(), whole.any(axis=0))
    np.testing.assert_array_equal(sparse.held(), np.arange(700) < 600)
    np.testing.assert_allclose(sparse.sums(), whole.sum(axis=0, dtype=float))


def test_what_no_row_sees_is_left_out(matrix):
    sparse = entered(matrix)
    assert sparse.any()
    assert sum(block.values.size for block in sparse.blocks) < 0.4 * matrix.size
    dark = entered(0 * matrix)
    assert not dark.any() and not dark.columns().any()
    np.testing.assert_array_equal(dark.times(np.ones(3000)), np.zeros(700))


@pytest.mark.parametrize("exact", [False, True])
def test_products_without_what_is_nought(matrix, whole, exact):
    sparse = entered(matrix)
    for shape in (3000, (3000, 4)):
        vector = np.random.default_rng(5).uniform(0, 1e4, shape)
        found = sparse.times(vector, exact)
        np.testing.assert_allclose(found, whole.astype(float) @ vector, rtol=1e-12 if exact else 1e-6)
    sums = whole @ vector
    np.testing.assert_allclose(sparse.sums_of_rows(vector.astype(np.float32)), sums, rtol=1e-5)
    np.testing.assert_allclose(sparse.sums_of_rows(vector.astype(np.float32), 100), sums[100:], rtol=1e-5)


def test_the_order_of_entries_changes_nothing(matrix):
    one, other = entered(matrix), entered(matrix, (0, 1, 2))
    for name, values in one.packed().items():
        np.testing.assert_array_equal(other.packed()[name], values)


@pytest.mark.parametrize("size", [0, 600])
def test_packed_and_unpacked(matrix, size):
    sparse = entered(matrix) if size else SparseRows((7, 5))
    np.testing.assert_array_equal(SparseRows.unpacked(sparse.shape, **sparse.packed()).dense(), sparse.dense())


@pytest.mark.parametrize("part", ["rows", "columns", "values"])
def test_arrays_that_do_not_fit_are_refused(matrix, part):
    packed = entered(matrix).packed()
    with pytest.raises(ValueError, match="do not fit"):
        SparseRows.unpacked((700, 3000), **{**packed, part: packed[part][:-1]})
    with pytest.raises(ValueError, match="do not fit"):
        SparseRows.unpacked((700, 3000), **{**packed, "rows": np.zeros_like(packed["rows"])})
