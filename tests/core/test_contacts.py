"""Elements and patches where other surfaces touch a plane in the middle of its cells: nothing of two sides mixes."""

import numpy as np
import pytest
from builders import prepare_coarse

import luzespecular as luz

WHITE = luz.Material(diffuse_reflectance=0.5)
SKY = luz.Daylight(sky=luz.CIESky(1, horizontal_illuminance=10_000))


HALL = [[0, 0], [6, 0], [6, 3], [0, 3]]
CORNERED = [[0, 0], [6, 0], [6, 5], [4, 5], [4, 3], [0, 3]]
POINTED = [[0, 0], [6, 0], [7, 1.5], [6, 3], [0, 3]]


def two_rooms(foot, top=3.0, hall=HALL):
    """A hall of 3 m, open in the west, and a partition with its ``foot`` at these x in south and north."""
    (a, b), floor = foot, np.c_[np.array(hall, float), np.zeros(len(hall))]
    up = np.array([0, 0, 3.0])
    scene = luz.Scene()
    scene.add("floor", floor, WHITE)
    scene.add("ceiling", floor[::-1] + up, WHITE)
    for k in range(len(hall) - 1):
        scene.add(f"wall {k}", [floor[k], floor[k] + up, floor[k + 1] + up, floor[k + 1]], WHITE)
    scene.add("partition", [[a, 0, 0], [a, 0, top], [b, 3, top], [b, 3, 0]], WHITE, two_sided=True)
    return scene


@pytest.mark.parametrize(
    "foot", [(3.02, 3.02), (3.047, 3.047), (2.6, 3.41)], ids=["near a line", "mid-cell", "oblique"]
)
@pytest.mark.parametrize("hall", [HALL, CORNERED, POINTED], ids=["rectangle", "L-shape", "pentagon"])
def test_no_light_comes_below_a_partition(foot, hall):
    """Floor, ceiling and walls run on from a lit room into a dark one; as regular cells, or in other triangles."""
    transfer = prepare_coarse(two_rooms(foot, hall=hall), elements=1500, max_area=0.02)
    result = transfer.solve(SKY)
    x, y = result.centroids[:, 0], result.centroids[:, 1]
    beside = x - (foot[0] + (foot[1] - foot[0]) * y / 3)
    lit = np.average(result.illuminance[beside < -0.3], weights=result.areas[beside < -0.3])
    assert lit > 300
    assert result.illuminance[beside > 0.3].max() < 1e-5 * lit


@pytest.mark.parametrize("foot", [(3.047, 3.047), (2.6, 3.41)], ids=["mid-cell", "oblique"])
@pytest.mark.parametrize("hall", [HALL, CORNERED], ids=["rectangle", "L-shape"])
def test_divided_elements_are_the_faces_still(foot, hall):
    transfer = prepare_coarse(two_rooms(foot, 1.3, hall), elements=1500, max_area=0.02)
    geometry = transfer.geometry
    cuts = geometry.fracture
    area = np.bincount(cuts.element_side, weights=cuts.element_areas)[: len(cuts.faces)]
    np.testing.assert_allclose(area, cuts.face_areas, rtol=1e-8)
    # no element of the floor, and no patch of it beside the partition, lies on both of its sides
    corners = cuts.elements + geometry.planes.centre
    beside = corners[..., 0] - (foot[0] + (foot[1] - foot[0]) * corners[..., 1] / 3)
    on_floor = np.flatnonzero(cuts.element_surface == 0)
    low, high = beside[on_floor].min(axis=1), beside[on_floor].max(axis=1)
    here = corners[on_floor][:, :, 1].max(axis=1) <= 3.0  # where the partition stands
    on_floor, low, high = on_floor[here], low[here], high[here]
    assert ((low > -1e-9) | (high < 1e-9)).all()
    side = np.where(low > -1e-9, 1, -1)
    patch = geometry.targets.patches.of_element[on_floor]
    assert all(len(np.unique(side[patch == p])) == 1 for p in np.unique(patch))
    # beams find the patch of the side that they end on, but for some centimetres where it runs askew
    grid = geometry.targets.patches
    place = (corners[on_floor].mean(axis=1) - geometry.planes.centre) @ geometry.planes.sheet_axes[0].T
    cell = np.floor((place - grid.grid_origin[0]) * grid.grid_scale[0]).astype(int)
    found = grid.grid[grid.grid_base[0] + cell[:, 0] * grid.grid_shape[0, 1] + cell[:, 1]]
    clear = np.abs(beside[on_floor].mean(axis=1)) > 0.05
    assert (found == patch)[clear].all()


def test_faces_that_nothing_touches_are_left_alone():
    with_, without = (prepare_coarse(two_rooms((x, x)), elements=1500, max_area=0.02) for x in (3.0, 3.047))
    whole = sum(2 * grid.rows * grid.columns for grid in with_.geometry.fracture.grids)
    assert len(with_.geometry.fracture.elements) == whole < len(without.geometry.fracture.elements)
