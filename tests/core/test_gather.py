"""Sums of what beams bring, whether there are few of them or many."""

import numpy as np
import pytest

from luzespecular import gather


@pytest.mark.parametrize("count", [0, 1, 40, 5_000])
@pytest.mark.parametrize("kind", [float, np.float32])
def test_weights_add_up_at_their_places(count, kind):
    rng = np.random.default_rng(count)
    place, weights = rng.integers(0, 2_000, count), rng.uniform(0, 1, count)
    place[: count // 2] = 7  # many to one place
    found = np.ones((40, 50), kind)
    gather._add(found, place, weights)
    expected = 1 + np.bincount(place, weights, 2_000).reshape(40, 50)
    assert found == pytest.approx(expected, rel=1e-6)
