"""Slopes of values on a run of cells."""

import numpy as np
import pytest
from builders import prepare_coarse

import luzespecular as luz
from luzespecular.slopes import slopes

WHITE = luz.Material(diffuse_reflectance=0.5)


@pytest.mark.parametrize("skew", [0.0, 0.7])
def test_slopes_of_an_even_field_are_its_own_and_no_steeper_at_a_crease(skew):
    scene = luz.Scene()
    scene.add("floor", np.array([[0, 0, 0], [3, 0, 0], [3 + skew, 2, 0], [skew, 2, 0]], float), WHITE)
    geometry = prepare_coarse(scene).geometry
    (grid,) = geometry.fracture.grids
    middles = geometry.fracture.elements.mean(axis=1)
    found = slopes(grid, 5 + middles @ [3.0, -2.0, 0.0])
    np.testing.assert_allclose(found, np.broadcast_to([3.0, -2.0, 0.0], found.shape), atol=1e-9)
    ridge = slopes(grid, -np.abs(middles[:, 1] - 1.0))
    assert np.abs(ridge[:, 1]).max() < 1 + 1e-9, "a crease makes nothing steeper"
    far = np.abs(middles[grid.elements, 1] - 1.0) > 0.5
    np.testing.assert_allclose(np.abs(ridge[far, 1]), 1.0, atol=1e-9)
