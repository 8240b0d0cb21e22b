"""Receivers of many facets each: rays from all over these tell the facets' mean."""

from dataclasses import replace

import numpy as np
import pytest
from layout_samples import WHITE, geometry_of

import luzespecular as luz
from luzespecular.gather import Targets, gather
from luzespecular.globe import Globe
from luzespecular.scattered import RAYS, scattered_sight
from luzespecular.tracing import ChainLimits
from luzespecular.weights import Weights

FACING_SQUARES = 0.199825
"""Form factor of opposite faces of a cube (Howell, Catalog of Radiation Heat Transfer Configuration Factors, C-11)."""


def square(z, up, height=None, side=1.0):
    corners = np.array([[0, 0, z], [side, 0, z], [side, side, z], [0, side, z]], float)
    if height is not None:  # upright, facing south
        corners = np.array([[0, side, z], [side, side, z], [side, side, z + height], [0, side, z + height]])
    return corners if up else corners[::-1]


def looked_from(scene, name):
    """What all elements of a surface gather together, with the geometry."""
    geometry = geometry_of(scene, max_area=0.02)
    fine = Targets.of(geometry.planes, geometry.targets.patches, Globe.cut_at_horizon(24))
    geometry = replace(geometry, targets=fine)
    mine = np.flatnonzero(geometry.element_surface == geometry.planes.surfaces.index(name))
    served = Weights(np.array([0, len(mine)]), mine, np.ones(len(mine)))
    sight = scattered_sight(geometry, ChainLimits(), served)
    return geometry, gather(sight, np.zeros((1, 3)), geometry.targets)


def of_surface(geometry, found, name):
    """Form factor to all patches of a surface."""
    number = geometry.planes.surfaces.index(name)
    mine = np.unique(geometry.targets.patches.of_element[geometry.element_surface == number])
    return float(found.patches[0, mine[mine >= 0]].sum())


def test_the_mean_over_a_square_is_the_form_factor_between_squares():
    scene = luz.Scene()
    scene.add("below", square(0.0, up=True), WHITE)
    scene.add("above", square(1.0, up=False), WHITE)
    geometry, found = looked_from(scene, "below")
    assert of_surface(geometry, found, "above") == pytest.approx(FACING_SQUARES, rel=0.02)
    everything = found.patches.sum() + found.sky.sum() + found.unlit.sum() + found.truncated.sum()
    assert everything == pytest.approx(1.0, abs=1e-5)
    assert not found.patches[0, geometry.targets.patches.of_element[geometry.element_surface == 0]].any()


def test_each_facet_looks_along_its_own_normal_by_its_area():
    """One facet looks up at the sky, one of twice the area down at the ground."""
    scene = luz.Scene()
    up, down = square(0.0, up=True), square(-1.0, up=False, side=np.sqrt(2.0))
    scene.add("both", np.concatenate([up, down]), WHITE, faces=[[0, 1, 2, 3], [4, 5, 6, 7]])
    _, found = looked_from(scene, "both")
    assert found.sky[0, -1] == pytest.approx(2 / 3, abs=2 / RAYS)
    assert found.sky[0, :-1].sum() == pytest.approx(1 / 3, abs=2 / RAYS)


def test_the_sky_is_weighed_by_the_cosine():
    scene = luz.Scene()
    scene.add("plate", square(0.0, up=True), WHITE)
    geometry, found = looked_from(scene, "plate")
    towards = geometry.targets.globe.directions[: geometry.targets.sky_parcels]
    assert float(found.sky[0, :-1] @ towards[:, 2]) == pytest.approx(2 / 3, rel=0.02)
    np.testing.assert_allclose(found.sky[0, :-1] @ towards[:, :2], 0.0, atol=0.02)


def test_rays_go_on_by_mirrors():
    """A mirror at right angles shows the square above once more: half of what two squares in a row would show."""
    scene = luz.Scene()
    scene.add("below", square(0.0, up=True), WHITE)
    scene.add("above", square(1.0, up=False), WHITE)
    plain = of_surface(*looked_from(scene, "below"), "above")
    scene.add("mirror", square(0.0, up=True, height=1.0), luz.Material(specular_reflectance=1.0))
    mirrored = of_surface(*looked_from(scene, "below"), "above")
    # Howell C-11 between equal rectangles 1 by 2 at distance 1, of which the square and its image make one
    assert plain < mirrored
    assert mirrored == pytest.approx(0.285875, rel=0.02)
