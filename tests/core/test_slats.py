"""Slats: what is seen of them from afar, and what of the sunlight on their edges escapes."""

import numpy as np
import pytest
from builders import box, cosine_rays, first_hits, prepare_coarse

import luzespecular as luz
from luzespecular.gather import _in_thirds
from luzespecular.grid import Grid
from luzespecular.slopes import slopes
from luzespecular.sun_patches import SunPatch, Triangles, light_elements, shifts

SLATS = 12


def with_slats(scene, height):
    """With sloping slats on its north side from a height on, and prepared coarsely."""
    for k in range(SLATS):
        z = height + 0.045 * k
        slat = [[0, 3, z + 0.02], [3, 3, z + 0.02], [3, 3.04, z], [0, 3.04, z]]
        scene.add(f"slat {k}", slat, luz.Material(diffuse_reflectance=0.7), two_sided=True)
    return scene, prepare_coarse(scene, elements=1000, patches=300)


@pytest.fixture(scope="module")
def before_a_blind():
    """A floor, farther below than the slats are wide."""
    scene = luz.Scene()
    scene.add("floor", [[0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0]], luz.Material(diffuse_reflectance=0.5))
    return with_slats(scene, 1.0)


@pytest.mark.parametrize("power", [0, 1, 2])
def test_far_slats_are_seen_over_their_whole_width(before_a_blind, power):
    """What a floor gets of slats whose undersides shine unevenly, by a power of the place across, against rays."""
    scene, transfer = before_a_blind
    cuts, patches = transfer.geometry.fracture, transfer.geometry.targets.patches
    names = np.array(list(scene.surfaces))[cuts.element_surface]
    below = np.char.startswith(names, "slat") & (cuts.element_side >= len(cuts.faces))
    begin = ((cuts.elements.mean(axis=1) + transfer.geometry.planes.centre)[below, 1] - 3) / 0.04 * 3 // 1 / 3
    exitance = np.zeros(patches.count)
    exitance[patches.of_element[below]] = ((begin + 1 / 3) ** (power + 1) - begin ** (power + 1)) / (power + 1) * 3
    shapes = np.array([surface.pieces[0] for name, surface in scene.surfaces.items() if name.startswith("slat")])
    normals = np.cross(shapes[:, 1] - shapes[:, 0], shapes[:, 2] - shapes[:, 1])
    floor = np.flatnonzero(names[transfer.nodes.element] == "floor")
    floor, expected, rays = floor[:: len(floor) // 12], 0.0, cosine_rays([0, 0, 1], 50_000)
    for point in transfer.nodes.points[floor] + transfer.geometry.planes.centre:
        hit = first_hits(point, rays, shapes)
        towards, normal, corner = rays[hit >= 0], normals[hit[hit >= 0]], shapes[hit[hit >= 0], 0]
        facing = (towards * normal).sum(axis=1)
        across = (point[1] + ((corner - point) * normal).sum(axis=1) / facing * towards[:, 1] - 3) / 0.04
        expected += (across[facing > 0] ** power).sum() / len(rays)
    assert (transfer.form_factors[floor] @ exitance).sum() == pytest.approx(expected, rel=0.06)


def test_sunlight_beside_the_middle_of_elements_escapes_as_it_should():
    """What leaves slats for the sky, where each lies in part in the next one's shadow, foretells what else lands."""
    room = box(luz.Material(diffuse_reflectance=0.5), (3, 3, 0.045 * SLATS + 0.02), without=["north"])
    _, transfer = with_slats(room, 0.01)
    sun = luz.Sun(altitude=35, azimuth=10, normal_illuminance=5e4)
    assert transfer.solve(luz.Daylight(sun=sun), cycles=1).balance.adjusted < 1e-3


@pytest.mark.parametrize("axis", [0, 1])
def test_thirds_have_the_mean_of_a_parabola(axis):
    place = np.array([[0.3, 1.1], [2.0, 0.4], [1.0, 1.0]])
    every, found = _in_thirds(place, np.array([0, 1]), np.array([axis, axis]), np.array([0.3, 0.2]))
    value = np.bincount(every, weights=1 + found[:, axis] ** 2)
    u, reach = place[:, axis], np.array([0.3, 0.2, 0.0])
    np.testing.assert_allclose(value / np.bincount(every), 1 + u**2 + reach**2 / 3)
    np.testing.assert_array_equal(found[:, 1 - axis], place[every, 1 - axis])


def test_slopes_of_an_even_rise_and_none_across_a_crease():
    grid = Grid(0, 4, 5, np.zeros(3), np.array([0.5, 0, 0]), np.array([0.1, 0.2, 0]))
    slope = np.array([3.0, -2.0, 0.0])
    np.testing.assert_allclose(slopes(grid, grid.triangles.mean(axis=1) @ slope), np.tile(slope, (40, 1)), atol=1e-12)
    crease = np.abs(grid.triangles.mean(axis=1)[:, 1] - 0.5).reshape(4, 5, 2).mean(axis=2)
    found = slopes(grid, np.repeat(crease.ravel(), 2)).reshape(4, 5, 2, 3)
    np.testing.assert_allclose(found[:, 2], 0, atol=1e-12)


def test_shifts_of_sunlight_within_elements():
    corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[3, 0, 0], [4, 0, 0], [3, 1, 0]]], float)
    elements = Triangles(corners, np.array([0, 0]), 1)
    square = np.array([[0, 0, 0], [5, 0, 0], [5, 0.5, 0], [0, 0.5, 0]])
    patches = [SunPatch(0, True, square + np.array([0, y, 0]), 800.0, 0) for y in (0, 0.5)]
    lower, both = (shifts(some, elements, np.array([0])) for some in (patches[:1], patches))
    np.testing.assert_allclose(both, 0, atol=1e-10)  # all of each is lit
    lux = light_elements(patches[:1], elements, np.array([0]))[0]
    trapezium = np.array([7 / 18, 2 / 9, 0])  # its centroid: sides 1 and 0.5, height 0.5
    np.testing.assert_allclose(lower, lux[:, None] * (trapezium - [1 / 3, 1 / 3, 0]))
    assert not shifts([], elements, np.array([0])).any()
