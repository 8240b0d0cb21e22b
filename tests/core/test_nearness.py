"""Nearness: edges that pass over a run of cells, how narrow they ask its cells to be, and what comes of it."""

import math

import numpy as np
import pytest
from layout_samples import BLACK, WHITE, shelf, wall

import luzespecular as luz
from luzespecular.fracture import fracture
from luzespecular.gather import gather
from luzespecular.geometry import make_geometry, sight_of
from luzespecular.globe import Globe
from luzespecular.grid import Grid
from luzespecular.nearness import closeness, near_edges
from luzespecular.planes import find_planes
from luzespecular.tracing import ChainLimits

FLOOR = Grid(0, 10, 20, np.zeros(3), np.array([0, 0.1, 0]), np.array([0.1, 0, 0]))
"""Two metres by one, 10 rows along y and 20 columns along x."""

UP = np.array([0.0, 0.0, 1.0])


def planes_of(*polygons):
    scene = luz.Scene()
    for number, polygon in enumerate(polygons):
        scene.add(f"{number}", polygon, WHITE)
    planes = find_planes(scene)
    return planes, Grid(0, 10, 20, -planes.centre, FLOOR.along_rows, FLOOR.along_columns)


def test_edges_are_found_below_which_they_pass():
    planes, floor = planes_of(shelf(0.05, x=(0.5, 1.0), y=(0.2, 3.0)))
    found = near_edges(floor, planes, UP, 0.2)
    assert len(found.lines) == 3, "the fourth lies outside"
    np.testing.assert_allclose(found.heights, 0.05)
    ends = {tuple(np.round(np.sort(line, axis=0).ravel(), 6)) for line in found.lines}
    assert ends == {(2, 5, 2, 10), (2, 5, 10, 5), (2, 10, 10, 10)}


@pytest.mark.parametrize(
    "polygon",
    [
        shelf(0.3),  # too high
        shelf(-0.05),  # behind
        shelf(0.0),  # in the plane
        shelf(0.05, x=(3, 4)),  # beside
        [[1, 0.5, 0.01], [1, 0.6, 3], [1.2, 0.55, 2]],  # edges that rise steeply
    ],
)
def test_edges_that_are_not_near(polygon):
    planes, floor = planes_of(polygon)
    assert len(near_edges(floor, planes, UP, 0.2).lines) == 0


def test_an_edge_of_two_faces_is_one():
    planes, floor = planes_of(shelf(0.05), [[0, 0, 0.05], [2, 0, 0.05], [2, 0, 1], [0, 0, 1]], shelf(0.05)[::-1])
    assert len(near_edges(floor, planes, UP, 0.2).lines) == 4


def test_cells_are_half_as_wide_as_a_board_lies_high():
    planes, floor = planes_of(shelf(0.05, x=(0.2, 1.8), y=(0.2, 0.8)))
    none = np.zeros(1, bool)
    np.testing.assert_allclose(closeness(floor, planes, UP, none), 0.025)
    np.testing.assert_array_equal(closeness(floor, planes, -UP, none), np.inf)


def test_a_slat_beside_another_gets_three_cells_across_and_none_along():
    planes, _ = planes_of(shelf(0.05, x=(0, 3), y=(0, 0.04)))
    slat = Grid(0, 1, 22, -planes.centre, np.array([0, 0.04, 0]), np.array([3 / 22, 0, 0]))
    wide = closeness(slat, planes, UP, np.zeros(1, bool))
    assert wide[0] == pytest.approx(0.05 / 3) and wide[1] == math.inf


def test_little_of_a_plane_is_no_reason_but_for_luminous_edges():
    planes, floor = planes_of(shelf(0.01, x=(0.8, 1.2), y=(0.4, 0.6)))
    assert np.isinf(closeness(floor, planes, UP, np.array([False]))).all()
    np.testing.assert_allclose(closeness(floor, planes, UP, np.array([True])), [0.005, np.inf])


def test_elements_are_finer_below_a_board_and_never_too_many(monkeypatch):
    scene = wall()
    scene.add("board", [[0.2, 0.02, 0.2], [1.8, 0.02, 0.2], [1.8, 0.02, 0.8], [0.2, 0.02, 0.8]], BLACK)

    def elements():
        cuts = fracture(find_planes(scene), [True, False], [True, False], [False, False], 0.005)
        assert len(cuts.faces) == 402, "faces stay as asked for"
        np.testing.assert_allclose(cuts.side_means(np.ones(len(cuts.elements))), 1)
        return int((cuts.element_side < 400).sum())

    finer = elements()
    monkeypatch.setattr("luzespecular.fracture.MOST_FINER", 0)
    plain = elements()
    assert finer > 2 * plain
    monkeypatch.setattr("luzespecular.fracture.MOST_FINER", 8_000)
    assert plain < elements() <= plain + 8_000


@pytest.mark.parametrize("height", [0.01, 0.1])
def test_close_plates(height):
    """Mean form factor of equal squares face to face (Hottel)."""
    scene = luz.Scene()
    scene.add("one", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], BLACK)
    scene.add("other", [[0, 0, height], [0, 1, height], [1, 1, height], [1, 0, height]], luz.Material(exitance=1))
    x = 1 / height
    root = math.sqrt(1 + x * x)
    exact = math.log(root**2 / math.sqrt(1 + 2 * x * x)) + 2 * x * root * math.atan(x / root) - 2 * x * math.atan(x)
    exact *= 2 / (math.pi * x * x)
    assert luz.solve(scene, luz.Daylight(), bands=8).mean("one") == pytest.approx(exact, rel=4e-3)


def test_a_slat_sends_on_what_runs_across_it():
    """Exitance that rises across a slat, seen from the next one, against sums over the slat's points."""
    scene = luz.Scene()
    scene.add("wall", [[0, 3, 0], [3, 3, 0], [3, 3, 3], [0, 3, 3]], WHITE)
    for number in range(12):
        scene.add(f"slat {number}", shelf(0.05 * number, x=(0, 3), y=(0, 0.04)), WHITE, two_sided=True)
    planes = find_planes(scene)
    geometry = make_geometry(scene, planes, Globe.cut_at_horizon(60), 0.01)
    patches, area = geometry.targets.patches, geometry.fracture.element_areas
    lower = (geometry.element_surface == 6) & (geometry.element_normals[:, 2] > 0)
    across = (geometry.element_points + planes.centre)[:, 1] / 0.04
    exitance = np.bincount(patches.of_element[lower], (area * across)[lower], minlength=patches.count)
    exitance /= geometry.patch_areas
    places = np.array([[1.5, 0.04 * u, 0.3] for u in (0.05, 0.3, 0.7, 0.95)])
    sight = sight_of(geometry, ChainLimits(1e-3, 3), -UP, planes.centre[2] - 0.3)
    got = gather(sight, places - planes.centre, geometry.targets).patches @ exitance
    x, u = np.meshgrid((np.arange(6000) + 0.5) / 2000, (np.arange(200) + 0.5) / 200)
    exact = [
        (0.05**2 * u / ((x - p[0]) ** 2 + (0.04 * u - p[1]) ** 2 + 0.05**2) ** 2).sum() / math.pi * 0.12 / x.size
        for p in places
    ]
    np.testing.assert_allclose(got, exact, rtol=0.01)
