"""Nodes: what elements get from the few receivers of a lattice, and where more of them are added."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from layout_samples import BLACK, CELL, WHITE, geometry_of, shelf, wall, wall_and

import luzespecular as luz
from luzespecular.nodes import DOUBT, STEEP, Nodes, settled


def nodes_of(geometry):
    return Nodes.of(geometry.fracture, geometry.lattices)


def wall_of(geometry):
    """(e,) bool: elements of the wall."""
    return geometry.element_surface == 0


OBLIQUE = [[0.35, 0, 0.15], [0.95, 0, 0.75], [0.95, 1, 0.75], [0.35, 1, 0.15]]
SCENES = {
    "bare": wall_and(),
    "between rows": wall_and(shelf(0.4)),
    "within cells": wall_and(shelf(0.43), shelf(0.77, x=(0.31, 1.72))),
    "oblique": wall_and(OBLIQUE),
    "crossing lines": wall_and(shelf(0.43), [[0.52, 0, 0], [0.52, 0, 1], [0.52, 1, 1], [0.52, 1, 0]]),
    "two-sided": wall_and(shelf(0.43), two_sided=True),
}


@pytest.fixture(params=list(SCENES), scope="module")
def made(request):
    geometry = geometry_of(SCENES[request.param])
    return geometry, nodes_of(geometry)


def test_weights_sum_to_one(made):
    geometry, nodes = made
    for weights in (nodes.weights, nodes.around, *nodes.foretold):
        count = len(weights.start) - 1
        np.testing.assert_allclose(np.bincount(weights.rows, weights=weights.weight, minlength=count), 1, atol=1e-12)
    assert len(nodes.weights.start) - 1 == len(geometry.fracture.elements)


def test_nodes_lie_on_their_elements(made):
    geometry, nodes = made
    centre = geometry.element_points[nodes.element]
    away = np.linalg.norm(nodes.points - centre, axis=1)
    assert away[wall_of(geometry)[nodes.element]].max() < CELL
    np.testing.assert_array_equal(nodes.sheet, geometry.fracture.element_sheet[nodes.element])
    height = np.einsum("mc,mc->m", nodes.points - centre, geometry.element_normals[nodes.element])
    np.testing.assert_allclose(height, 0, atol=1e-12)


def test_light_that_changes_evenly_is_reproduced(made):
    geometry, nodes = made
    np.testing.assert_allclose(nodes.weights.apply(nodes.points), geometry.element_points, atol=1e-6)


def power_means(corners, power):
    """Mean of x to a power over triangles, from x at their corners ``(k, 3)``: an exact sum of products."""
    total = sum(
        corners[:, 0] ** i * corners[:, 1] ** j * corners[:, 2] ** (power - i - j)
        for i in range(power + 1)
        for j in range(power + 1 - i)
    )
    return 2 * total / ((power + 1) * (power + 2))


@pytest.mark.parametrize("axis", [0, 2])
def test_means_of_a_cubic_along_one_axis_are_reproduced(axis):
    """Elements' values are means over their area, not values at their centroids."""
    geometry = geometry_of(wall())
    nodes = nodes_of(geometry)
    corners, place = geometry.fracture.elements[:, :, axis], nodes.points[:, axis]
    exact = 2 - power_means(corners, 1) + 3 * power_means(corners, 2) - 4 * power_means(corners, 3)
    np.testing.assert_allclose(nodes.weights.apply(2 - place + 3 * place**2 - 4 * place**3), exact, atol=1e-12)
    assert np.abs(nodes.weights.apply(place**4) - power_means(corners, 4)).max() > 1e-6, "no more than that"


def test_lattices_are_dense_at_their_borders_and_wide_between():
    geometry = geometry_of(wall(4.0, 4.0))
    nodes = nodes_of(geometry)
    lines = np.unique(np.round(nodes.points[:, 0], 9)) / CELL + 20
    gaps = np.diff(lines)
    assert len(gaps) < 20 and lines[0] == pytest.approx(40 - lines[-1])
    assert 0.05 < lines[0] < 0.3, "light changes fast beside other planes"
    np.testing.assert_allclose(gaps, gaps[::-1])
    assert gaps[0] < 0.7 and gaps[1] < 1.1 and gaps.max() >= 3
    assert (np.diff(gaps[:5]) > 0.1).all(), "wider and wider"
    assert np.abs(lines - 20).min() > 0.5, "none in the very middle, where other surfaces often lie in line"
    assert len(nodes.points) < 0.12 * len(geometry.fracture.elements)


@pytest.mark.parametrize("z", [0.4, 0.43])
def test_interpolation_never_reaches_across_a_shelf(z):
    """Elements above have the same values whatever the nodes below have, and the other way round."""
    geometry = geometry_of(wall_and(shelf(z)))
    nodes = nodes_of(geometry)
    line = z - 0.5  # in the scene's own frame
    assert geometry.planes.centre[2] == pytest.approx(0.5)
    rng = np.random.default_rng(1)
    light = rng.uniform(0, 1, len(nodes.points))
    above = geometry.fracture.elements[:, :, 2].min(axis=1) > line - 1e-9
    below = geometry.fracture.elements[:, :, 2].max(axis=1) < line + 1e-9
    assert above[wall_of(geometry)].sum() >= 200 and below[wall_of(geometry)].sum() > 100
    for mine, other in ((above, nodes.points[:, 2] < line), (below, nodes.points[:, 2] > line)):
        brighter = np.where(other, light + 1000, light)
        mine = mine & wall_of(geometry)
        assert (other & (nodes.element_sheet[nodes.element] == 0)).sum() > 50
        np.testing.assert_array_equal(nodes.weights.apply(brighter)[mine], nodes.weights.apply(light)[mine])


@settings(max_examples=25, deadline=None)
@given(st.floats(0.011, 0.989), st.floats(0, 1.5), st.floats(0.2, 0.5), st.booleans())
def test_parts_of_cut_cells_are_weighted_by_their_area(z, x, width, upright):
    """A step of the light along the line: each element's mean is exact, for pieces lie on one side each."""
    polygon = shelf(z, x=(x, x + width))
    if upright:
        polygon = [[p[2] * 2, p[1], p[0] / 2] for p in polygon]
    geometry = geometry_of(wall_and(polygon))
    nodes = nodes_of(geometry)
    cut = np.repeat(geometry.lattices[0].cut.ravel(), 2)
    elements = geometry.fracture.elements[: len(cut)]
    axis, line = (0, 2 * z - 1) if upright else (2, z - 0.5)
    centre = geometry.planes.centre
    np.testing.assert_allclose(centre, [1, 0.25, 0.5], atol=1e-12)
    got = nodes.weights.apply((nodes.points[:, axis] > line).astype(float))[: len(cut)]
    for element in np.flatnonzero(cut):
        assert got[element] == pytest.approx(share_above(elements[element][:, axis], line), abs=2e-6)
    mean = nodes.weights.apply(nodes.points)[: len(cut)]
    np.testing.assert_allclose(mean[cut], elements[cut].mean(axis=1), atol=1e-6)


def share_above(places, line):
    """Share of a triangle's area beyond a line, from its corners' distances along the line's normal."""
    low, middle, high = np.sort(places) - line
    if low >= 0:
        return 1.0
    if high <= 0:
        return 0.0
    if middle <= 0:
        return high**2 / ((high - low) * (high - middle))
    return 1 - low**2 / ((low - middle) * (low - high))


def test_pieces_of_cells_that_two_lines_cut():
    """A cross: four quarters' values, each weighted by its share of the element."""
    geometry = geometry_of(SCENES["crossing lines"])
    nodes = nodes_of(geometry)
    quarter = (nodes.points[:, 0] > 0.52 - 1) * 2.0 + (nodes.points[:, 2] > 0.43 - 0.5)
    area = geometry.fracture.element_areas
    wall_ = wall_of(geometry)
    got = nodes.weights.apply(quarter)[wall_] @ area[wall_]
    assert got == pytest.approx(2 * (1.48 / 2) * 2.0 + 2 * 0.57, abs=1e-6)
    cut = np.repeat(geometry.lattices[0].cut.ravel(), 2).nonzero()[0]
    assert (np.diff(nodes.weights.start)[cut] == 1).all(), "each part looks for itself"
    assert np.bincount(geometry.fracture.element_side)[geometry.fracture.element_side[cut]].max() > 4


def test_sides_of_a_two_sided_wall_are_apart():
    geometry = geometry_of(SCENES["two-sided"])
    nodes = nodes_of(geometry)
    behind = geometry.fracture.element_sheet >= 2
    assert behind.sum() == wall_of(geometry).sum() / 2 >= 400
    light = np.where(nodes.sheet >= 2, 7.0, 3.0)
    np.testing.assert_allclose(nodes.weights.apply(light), np.where(behind, 7.0, 3.0))
    np.testing.assert_array_equal(nodes.points[nodes.sheet >= 2].shape, nodes.points[nodes.sheet == 0].shape)


def test_what_lies_in_no_run_has_its_own_node():
    scene = wall()
    scene.add("triangle", [[0, 1, 0], [0.5, 1, 0], [0, 1, 0.5]], WHITE)
    geometry = geometry_of(scene)
    nodes = nodes_of(geometry)
    single = np.flatnonzero(geometry.element_surface == 1)
    own = [np.flatnonzero(nodes.weights.rows == e) for e in single]
    assert all(len(entries) == 1 for entries in own)
    found = nodes.weights.node[np.concatenate(own)]
    np.testing.assert_allclose(nodes.points[found], geometry.element_points[single])
    assert len(np.unique(found)) == len(single)


def test_illuminances_are_never_negative():
    geometry = geometry_of(wall())
    nodes = nodes_of(geometry)
    spike = np.where(np.arange(len(nodes.points)) == len(nodes.points) // 2 + 7, 100.0, 0.0)
    assert nodes.weights.apply(spike).min() < 0, "a cubic overshoots"
    assert nodes.on_elements(spike).min() == 0


def doubt_about(light, scene=None):
    """Doubt about the wall's elements, and where they lie, from x = 0 to 2 and z = 0 to 1."""
    geometry = geometry_of(scene or wall())
    nodes = nodes_of(geometry)
    place = nodes.points + geometry.planes.centre
    doubt = nodes.doubt(np.asarray(light(place[:, 0], place[:, 2]))[:, None])
    mine = wall_of(geometry)
    return doubt[mine], geometry.element_points[mine] + geometry.planes.centre


@pytest.mark.parametrize(
    "light",
    [
        lambda x, z: 5 + 0 * x,
        lambda x, z: 5 + 2 * x - z,
        lambda x, z: 5 + (x - 0.7) ** 2 - 3 * z**2,
        lambda x, z: 20 + x**3 - 2 * x**2 * z + z**3,
    ],
    ids=["even", "linear", "parabola", "cubic"],
)
def test_no_doubt_about_even_curves(light):
    doubt, _ = doubt_about(light)
    assert doubt.max() < 1e-9


@pytest.mark.parametrize("axis", [0, 2])
def test_a_crease_is_doubted_there_alone(axis):
    where = 0.9 if axis == 0 else 0.52
    doubt, points = doubt_about(lambda x, z: 1 + 2 * np.abs((x, None, z)[axis] - where), wall(2.0, 2.0))
    away = np.abs(points[:, axis] - where)
    assert (doubt[away < 0.5 * CELL] > DOUBT).all()
    far = away > 9 * CELL
    assert far.sum() > 20 and doubt[far].max() < 1e-9


def test_a_crease_along_a_line_of_contact_is_no_doubt():
    """What ends at the shelf changes there by nature; the lattices on either side know nothing of each other."""

    def light(x, z):
        return np.where(z > 0.4, 5 + 3 * z, 20 - z)

    assert doubt_about(light, wall_and(shelf(0.4)))[0].max() < 1e-9
    assert doubt_about(light)[0].max() > 0.1


def test_doubt_does_not_ask_how_bright_it_is_nor_cancel_between_kinds():
    geometry = geometry_of(wall())
    nodes = nodes_of(geometry)
    x = nodes.points[:, 0]
    crease = 1 + np.abs(x - 0.1)
    one = nodes.doubt(crease[:, None])
    np.testing.assert_allclose(nodes.doubt(1e4 * crease[:, None]), one, atol=1e-12)
    both = nodes.doubt(np.stack([crease, 3 - crease], axis=1))
    assert both.max() > 0.3 * one.max(), "two sides of the sky may be bright on different days"
    assert (nodes.doubt(np.zeros((len(x), 3))) == 0).all(), "no light, no doubt"


def settle(scene, light):
    """Settled nodes, and the values that were asked for, in turn."""
    geometry = geometry_of(scene)
    lattice = nodes_of(geometry)
    asked, values = [], np.zeros(0)

    def evaluate(nodes, first):
        nonlocal values
        place = nodes.points[first:] + geometry.planes.centre
        asked.append(len(place))
        values = np.concatenate([values, light(place[:, 0], place[:, 2])])
        return values[:, None]

    return geometry, lattice, settled(lattice, geometry.fracture, evaluate), values, asked


def test_even_light_needs_the_lattice_alone():
    _, lattice, nodes, _, asked = settle(wall(), lambda x, z: 10 + x - z**2)
    assert nodes is lattice and asked == [len(lattice.points)]


def test_creases_get_receivers_of_their_own():
    def light(x, z):
        return 5 + 6 * np.abs(x - 0.93)

    geometry, lattice, nodes, values, asked = settle(wall(), light)
    assert len(asked) == 2 and sum(asked) == len(nodes.points) == len(values)
    own = np.diff(nodes.weights.start) == 1
    points = geometry.element_points + geometry.planes.centre
    assert own[np.abs(points[:, 0] - 0.93) < CELL / 2].all()
    assert not own[points[:, 0] < 0.3].any()
    error = np.abs(nodes.weights.apply(values) - light(points[:, 0], points[:, 2]))
    before = np.abs(lattice.weights.apply(values[: asked[0]]) - light(points[:, 0], points[:, 2]))
    assert error.max() < 0.1 * before.max() or error.max() < DOUBT * 5
    np.testing.assert_array_equal(nodes.points[: asked[0]], lattice.points)


def test_where_light_is_steep_elements_get_several_receivers():
    """Almost a step in the middle of a column: its elements have four receivers each, and a better mean by them."""

    def light(x, z):
        return 1 + 9 / (1 + np.exp(-(x - 0.94) / 0.012))

    geometry, _, nodes, values, asked = settle(wall(), light)
    assert len(asked) >= 3
    each = np.diff(nodes.weights.start)
    points = geometry.element_points + geometry.planes.centre
    steep = (points[:, 0] > 0.9) & (points[:, 0] < 1.0)
    assert (each[steep] >= 4).all() and (each[points[:, 0] > 1.2] < 17).all()
    assert sum(asked) == len(values) == len(nodes.points)
    assert asked[2] % 3 == 0, "of four parts the middle one keeps the element's receiver"
    corners = geometry.fracture.elements[steep] + geometry.planes.centre
    grid = np.array([(i + 1 / 3, j + 1 / 3) for i in range(24) for j in range(24 - i)]) / 24
    shares = np.c_[grid, 1 - grid.sum(axis=1)]
    places = np.einsum("sk,ekc->esc", shares, corners)
    exact = light(places[:, :, 0], places[:, :, 2]).mean(axis=1)
    got = nodes.weights.apply(values)[steep]
    single = light(points[steep, 0], points[steep, 2])
    assert np.abs(got - exact).mean() < 0.5 * np.abs(single - exact).mean()
    assert STEEP > DOUBT, "what is doubted has its own receiver before it is asked how steep it is"


def test_own_receivers_replace_what_was_interpolated():
    geometry = geometry_of(wall())
    nodes = nodes_of(geometry)
    some = np.array([40, 41, 300])
    more = nodes.with_own(some, geometry.fracture)
    light = np.concatenate([np.ones(len(nodes.points)), [2, 4, 10]])
    got = more.weights.apply(light)
    np.testing.assert_allclose(got[some], [2, 4, 10])
    np.testing.assert_allclose(np.delete(got, some), 1)
    np.testing.assert_array_equal(more.element[-3:], some)
    np.testing.assert_allclose(nodes.weights.apply(light[:-3]), 1, err_msg="the first are untouched")


def test_many_kinds_of_light_at_once():
    geometry = geometry_of(wall())
    nodes = nodes_of(geometry)
    light = np.random.default_rng(2).uniform(0, 1, (len(nodes.points), 3))
    np.testing.assert_allclose(nodes.weights.apply(light)[:, 1], nodes.weights.apply(light[:, 1]))


def test_a_scene_of_triangles_alone():
    scene = luz.Scene()
    scene.add("triangle", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], BLACK)
    geometry = geometry_of(scene)
    nodes = nodes_of(geometry)
    assert len(nodes.points) == len(geometry.fracture.elements)
    assert (nodes.doubt(np.ones((len(nodes.points), 2))) == 0).all()


@pytest.mark.parametrize("spacing", [(2, 3), (4, 1), (1, 7)])
def test_cells_looked_at_as_one_need_not_fill_a_run(spacing):
    """At the run's end fewer cells are left for one: each has its number, and its middle lies in it."""
    fracture = geometry_of(wall()).fracture
    grids = tuple(replace(grid, spacing=spacing) for grid in fracture.grids)
    assert any(grid.shape[0] % spacing[0] or grid.shape[1] % spacing[1] for grid in grids)
    block, middle = replace(fracture, grids=grids).blocks
    mine = block >= 0
    assert block.max() < len(middle) and set(block[mine]) == set(range(len(middle)))
    np.testing.assert_array_equal(block[middle], np.arange(len(middle))[:, None] + [0, 0])


def test_receivers_shared_by_cells_tell_of_the_point_where_they_stand():
    """What they add to the lattice is nothing where this is right: a mean is not taken for a value at the middle."""
    geometry = geometry_of(wall())
    fracture = replace(
        geometry.fracture, grids=tuple(replace(grid, spacing=(1, 2)) for grid in geometry.fracture.grids)
    )
    layouts = [replace(layout, grid=grid) for layout, grid in zip(geometry.lattices, fracture.grids, strict=True)]
    nodes = Nodes.of(fracture, layouts)
    more = nodes.with_own(np.flatnonzero(wall_of(geometry))[40:60], fracture)
    assert len(more.points) > len(nodes.points)
    curve = 1 + more.points[:, 0] ** 2 - 0.5 * more.points[:, 2] ** 3
    np.testing.assert_allclose(more.weights.apply(curve), nodes.weights.apply(curve[: len(nodes.points)]), atol=1e-9)
