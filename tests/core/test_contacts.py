"""Elements and patches where other surfaces touch a plane in the middle of its cells: nothing of two sides mixes."""

import numpy as np
import pytest
from builders import prepare_coarse

import luzespecular as luz

WHITE = luz.Material(diffuse_reflectance=0.5)
SKY = luz.Daylight(sky=luz.CIESky(1, horizontal_illuminance=10_000))


def two_rooms(foot, top=None):
    """A hall of 6 × 3 × 3 m, open in the west, and a partition with its ``foot`` at these x in south and north."""
    (a, b), height = foot, 3.0 if top is None else top
    scene = luz.Scene()
    scene.add("floor", [[0, 0, 0], [6, 0, 0], [6, 3, 0], [0, 3, 0]], WHITE)
    scene.add("ceiling", [[0, 3, 3], [6, 3, 3], [6, 0, 3], [0, 0, 3]], WHITE)
    scene.add("south", [[0, 0, 0], [0, 0, 3], [6, 0, 3], [6, 0, 0]], WHITE)
    scene.add("north", [[0, 3, 0], [6, 3, 0], [6, 3, 3], [0, 3, 3]], WHITE)
    scene.add("east", [[6, 0, 0], [6, 0, 3], [6, 3, 3], [6, 3, 0]], WHITE)
    scene.add("partition", [[a, 0, 0], [a, 0, height], [b, 3, height], [b, 3, 0]], WHITE, two_sided=True)
    return scene


@pytest.mark.parametrize(
    "foot", [(3.02, 3.02), (3.047, 3.047), (2.6, 3.41)], ids=["near a line", "mid-cell", "oblique"]
)
def test_no_light_comes_below_a_partition(foot):
    """Floor, ceiling and walls run on from a lit room into a dark one."""
    transfer = prepare_coarse(two_rooms(foot), elements=1500, max_area=0.02)
    result = transfer.solve(SKY)
    x, y = result.centroids[:, 0], result.centroids[:, 1]
    beside = x - (foot[0] + (foot[1] - foot[0]) * y / 3)
    lit = np.average(result.illuminance[beside < -0.3], weights=result.areas[beside < -0.3])
    assert lit > 300
    assert result.illuminance[beside > 0.3].max() < 1e-5 * lit


@pytest.mark.parametrize("foot", [(3.047, 3.047), (2.6, 3.41)], ids=["mid-cell", "oblique"])
def test_divided_elements_are_the_faces_still(foot):
    transfer = prepare_coarse(two_rooms(foot, top=1.3), elements=1500, max_area=0.02)
    geometry = transfer.geometry
    cuts = geometry.fracture
    area = np.bincount(cuts.element_side, weights=cuts.element_areas)[: len(cuts.faces)]
    np.testing.assert_allclose(area, cuts.face_areas, rtol=1e-8)
    assert len(cuts.elements) > 40 + 2 * sum(grid.rows * grid.columns for grid in cuts.grids)
    # no element of the floor, and no patch of it beside the partition, lies on both of its sides
    corners = cuts.elements + geometry.planes.centre
    beside = corners[..., 0] - (foot[0] + (foot[1] - foot[0]) * corners[..., 1] / 3)
    on_floor = np.flatnonzero(cuts.element_surface == 0)
    low, high = beside[on_floor].min(axis=1), beside[on_floor].max(axis=1)
    assert ((low > -1e-9) | (high < 1e-9)).all()
    side = np.where(low > -1e-9, 1, -1)
    patch = geometry.targets.patches.of_element[on_floor]
    assert all(len(np.unique(side[patch == p])) == 1 for p in np.unique(patch))
    # beams find the patch of the side that they end on, but for half a sixteenth of a cell
    grid = geometry.targets.patches
    place = (corners[on_floor].mean(axis=1) - geometry.planes.centre) @ geometry.planes.sheet_axes[0].T
    cell = np.floor((place - grid.grid_origin[0]) * grid.grid_scale[0]).astype(int)
    found = grid.grid[grid.grid_base[0] + cell[:, 0] * grid.grid_shape[0, 1] + cell[:, 1]]
    clear = np.abs(beside[on_floor].mean(axis=1)) > 0.02
    assert (found == patch)[clear].all()


def test_faces_that_nothing_touches_are_left_alone():
    with_, without = (prepare_coarse(two_rooms((x, x)), elements=1500, max_area=0.02) for x in (3.0, 3.047))
    whole = sum(2 * grid.rows * grid.columns for grid in with_.geometry.fracture.grids)
    assert len(with_.geometry.fracture.elements) == whole < len(without.geometry.fracture.elements)
