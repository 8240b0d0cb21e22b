"""Sums of what beams bring."""

import numpy as np
import pytest

from luzespecular import gather
from luzespecular.globe import Globe


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


def sky_of(bands, normal, seen):
    """Form factors to the sky's parcels below an open sky, as far as a direction's ``seen``, by other beams."""
    targets = gather.Targets.of(None, None, Globe(60))
    hemisphere = Globe(bands).hemisphere(normal)
    free = np.where(seen(hemisphere.directions), hemisphere.weights, 0.0)[None]
    columns, weights = gather._spread_over_sky(free, hemisphere.parcels, hemisphere, targets)
    found = np.zeros(targets.columns)
    found[columns] = weights[0]
    return found, targets


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 1, 0), (0.3, 0.5, 0.2), (0, 0.2, -1)])
def test_wide_beams_leave_the_sky_as_fine_as_it_is(normal):
    """All of an open sky: each parcel gets its own cosine-weighted solid angle, whatever the beams' width."""
    found, targets = sky_of(24, normal, lambda directions: np.ones(len(directions), bool))
    hemisphere = targets.globe.hemisphere(normal)
    exact = np.zeros(targets.columns)
    np.add.at(exact, np.minimum(hemisphere.parcels, targets.sky_parcels), hemisphere.weights)
    assert found.sum() == pytest.approx(1, abs=1e-6)
    assert found[-1] == pytest.approx(exact[-1], abs=2e-4)
    np.testing.assert_allclose(found[:-1], exact[:-1], atol=0.15 * exact[:-1].max())
    assert np.abs(found - exact)[:-1].sum() < 0.06


def test_beams_that_see_nothing_bring_nothing():
    found, _ = sky_of(24, (0, 0, 1), lambda directions: np.zeros(len(directions), bool))
    assert found.shape == (2952,) and not found.any()
