"""Products of rows: as exact as they say."""

import numpy as np
import pytest

from luzespecular.arrays import product


@pytest.mark.parametrize("columns", [(), (3,)])
@pytest.mark.parametrize("exact", [False, True])
def test_products(exact, columns):
    rng = np.random.default_rng(3)
    matrix = rng.uniform(0, 1, (700, 3000)).astype(np.float32)
    vector = rng.uniform(0, 1e4, (3000, *columns))
    found = product(matrix, vector, exact)
    np.testing.assert_allclose(found, matrix.astype(float) @ vector, rtol=1e-12 if exact else 1e-6)
