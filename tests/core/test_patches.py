"""Patches: what exitance is resolved in: shared out, graded, and found by place."""

import math

import numpy as np
import pytest
from builders import BLACK, box
from hypothesis import given, settings
from hypothesis import strategies as st
from layout_samples import WHITE, geometry_of, shelf, wall, wall_and

import luzespecular as luz
from luzespecular import geometry as geometry_room
from luzespecular import patches as patches_room
from luzespecular.fracture import fracture
from luzespecular.geometry import make_geometry
from luzespecular.globe import Globe
from luzespecular.patches import make_patches
from luzespecular.planes import find_planes


def cuts_of(scene, max_area):
    surfaces = list(scene.surfaces.values())
    cut = [s.material.diffuse_reflectance > 0 for s in surfaces]
    return fracture(find_planes(scene), cut, cut, [s.two_sided for s in surfaces], max_area)


def patches_of(scene, target):
    cuts, planes = cuts_of(scene, 0.01), find_planes(scene)
    diffuse = np.array([s.material.diffuse_reflectance > 0 for s in scene.surfaces.values()])
    active = diffuse[planes.sheet_surface[cuts.element_sheet]]
    return cuts, make_patches(planes, cuts.elements, cuts.element_sheet, active, cuts.element_areas, target, [])


def test_patches_share_out_the_diffuse_surfaces():
    cuts, patches = patches_of(box(WHITE, (3, 2, 1), ceiling=BLACK), 200)
    assert 150 <= patches.count <= 400
    mine = patches.of_element >= 0
    assert patches.of_element.max() == patches.count - 1
    assert len(np.unique(patches.of_element[mine])) == patches.count
    area = np.bincount(patches.of_element[mine], weights=cuts.element_areas[mine])
    assert area.sum() == pytest.approx(22 - 6)
    assert area.max() < 4 * area.mean()
    dark = cuts.face_surface[cuts.element_side] == 1
    np.testing.assert_array_equal(patches.of_element[dark], -1)


def found_by_place(patches, planes, sheets, points):
    """Patch at points ``(n, 3)`` of sheets ``(n,)``, looked up as beams do."""
    axes = planes.sheet_axes[sheets % len(planes.sheet_surface)]
    place = np.einsum("nac,nc->na", axes, points)
    cell = np.floor((place - patches.grid_origin[sheets]) * patches.grid_scale[sheets]).astype(int)
    assert (cell >= 0).all() and (cell < patches.grid_shape[sheets]).all()
    return patches.grid[patches.grid_base[sheets] + cell[:, 0] * patches.grid_shape[sheets, 1] + cell[:, 1]]


def test_patches_are_found_by_place():
    """The cell that an element's centroid falls in holds the element's own patch."""
    scene = box(WHITE, (3, 2, 1))
    cuts, patches = patches_of(scene, 200)
    found = found_by_place(patches, find_planes(scene), cuts.element_sheet, cuts.elements.mean(axis=1))
    np.testing.assert_array_equal(found, patches.of_element)


TURNED = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
GRADED = {
    "wall": wall(),
    "shelf": wall_and(shelf(0.43), shelf(0.7, x=(0.5, 1.2))),
    "two-sided": wall_and(shelf(0.43), two_sided=True),
    "narrow": wall(3.0, 0.2),
}


@pytest.fixture(params=list(GRADED), scope="module")
def graded(request):
    return geometry_of(GRADED[request.param], patches=60)


def test_graded_patches_are_found_by_place(graded):
    """Every corner of an element too, a little inside: beams may end anywhere on it."""
    patches, cuts = graded.targets.patches, graded.fracture
    mine = patches.of_element >= 0
    for shares in np.vstack([np.eye(3) * 0.97 + 0.01, [[1 / 3] * 3]]):
        points = np.einsum("ekc,k->ec", cuts.elements, shares)
        found = found_by_place(patches, graded.planes, cuts.element_sheet[mine], points[mine])
        np.testing.assert_array_equal(found, patches.of_element[mine])


def test_a_turned_wall_has_the_same_patches():
    """The sheet's axes need not be those of its cells."""
    scene = luz.Scene()
    shelves = shelf(0.43), shelf(0.7, x=(0.5, 1.2))
    for number, polygon in enumerate([[[0, 0, 0], [0, 0, 1], [2, 0, 1], [2, 0, 0]], *shelves]):
        scene.add(f"{number}", np.array(polygon) @ TURNED.T + [3, -2, 7], BLACK if number else WHITE)
    one, other = geometry_of(GRADED["shelf"], patches=60), geometry_of(scene, patches=60)
    np.testing.assert_array_equal(other.targets.patches.of_element, one.targets.patches.of_element)
    mine = other.targets.patches.of_element >= 0
    found = found_by_place(
        other.targets.patches, other.planes, other.fracture.element_sheet[mine], other.element_points[mine]
    )
    np.testing.assert_array_equal(found, other.targets.patches.of_element[mine])


def test_patches_are_narrow_where_planes_meet():
    """Beside borders and lines of contact a patch is one cell wide, in between as wide as asked for."""
    geometry = geometry_of(wall_and(shelf(0.4)), patches=40)
    patch = geometry.targets.patches.of_element[:400].reshape(10, 20, 2)
    np.testing.assert_array_equal(patch[:, :, 0], patch[:, :, 1])
    rows = np.flatnonzero(np.diff(patch[:, 0, 0])) + 1
    columns = np.flatnonzero(np.diff(patch[0, :, 0])) + 1
    assert {1, 3, 4, 5, 9} <= set(rows.tolist())
    assert {1, 19} <= set(columns.tolist()) and len(columns) < 16
    widths = np.diff([0, *columns, 20])
    np.testing.assert_array_equal(widths, widths[::-1])
    assert widths.max() >= 2


def test_no_patch_reaches_across_a_line_of_contact(graded):
    patches, cuts = graded.targets.patches, graded.fracture
    for layout in graded.lattices:
        place = layout.grid.in_cells(cuts.elements[layout.grid.elements].mean(axis=1))
        of = patches.of_element[layout.grid.elements]
        for axis in (0, 1):
            number = np.zeros(len(place), int)
            for k, (first, cells) in enumerate(layout.stretches[axis]):
                number[(place[:, axis] > first) & (place[:, axis] < first + cells)] = k
            low, high = np.full(patches.count, 99), np.full(patches.count, -1)
            np.minimum.at(low, of, number)
            np.maximum.at(high, of, number)
            assert (low[of] == high[of]).all()


def test_sides_of_a_two_sided_wall_share_no_patch():
    geometry = geometry_of(GRADED["two-sided"], patches=60)
    patches, sheet = geometry.targets.patches, geometry.fracture.element_sheet
    front, back = (set(patches.of_element[sheet == s].tolist()) for s in (0, 3 - 1))
    assert front and back and not front & back and -1 not in front | back
    assert len(front) == len(back)


@pytest.mark.parametrize("target", [1000, 2000])
def test_graded_patches_are_about_as_many_as_asked_for(target):
    geometry = geometry_of(box(WHITE, (3, 2, 1)), max_area=0.0025, patches=target)
    assert len(geometry.lattices) == 6
    assert 0.9 * target < geometry.targets.patches.count < 2 * target


def test_graded_patches_are_never_fewer_than_their_borders_need():
    """However few are asked for: narrow beside edges, and growing no faster than with the distance from there."""
    counts = [
        geometry_of(box(WHITE, (3, 2, 1)), max_area=0.0025, patches=n).targets.patches.count for n in (20, 50, 200)
    ]
    assert counts[0] == counts[1] == counts[2]
    assert counts[0] < len(geometry_of(box(WHITE, (3, 2, 1)), max_area=0.0025).fracture.elements) / 8


@settings(max_examples=25, deadline=None)
@given(st.floats(0.3, 4), st.floats(0.3, 4), st.integers(10, 300), st.floats(0.05, 0.95))
def test_every_patch_is_whole_and_numbered_once(width, height, target, z):
    scene = wall(width, height)
    scene.add("shelf", shelf(z * height, x=(0, width)), BLACK)
    geometry = geometry_of(scene, patches=target)
    patches = geometry.targets.patches
    mine = geometry.element_surface == 0
    assert (patches.of_element[mine] >= 0).all() and (patches.of_element[~mine] == -1).all()
    np.testing.assert_array_equal(np.unique(patches.of_element[mine]), np.arange(patches.count))


def slats(count, tilt=0.02):
    """A white floor of 30 m², and slats of 4.5 cm close one above the other, smaller than its patches."""
    scene = luz.Scene()
    scene.add("floor", [[-2, 0, -1], [4, 0, -1], [4, 5, -1], [-2, 5, -1]], WHITE)
    for k in range(count):
        z = 0.045 * k
        scene.add(f"slat {k}", [[0, 2, z + tilt], [2, 2, z + tilt], [2, 2.04, z], [0, 2.04, z]], WHITE, two_sided=True)
    return scene


def patches_of_slats(monkeypatch, count):
    monkeypatch.setattr(geometry_room, "PATCHES", 100)
    geometry = make_geometry(slats(count), find_planes(slats(count)), Globe(4), None)
    of, sheet = geometry.targets.patches.of_element, geometry.fracture.element_sheet
    return geometry, [np.unique(of[sheet == s]) for s in range(1, len(geometry.planes.sheet_surface))]


def test_slats_smaller_than_a_patch_are_parted_across(monkeypatch):
    """One above the other they see each other's near edges, which are not as bright as the far ones."""
    geometry, patches = patches_of_slats(monkeypatch, 4)
    cuts = geometry.fracture
    assert cuts.element_areas[cuts.element_sheet == 1].sum() < 30 / 100
    for sheet, mine in enumerate(patches, 1):
        y = cuts.elements[cuts.element_sheet == sheet][:, :, 1]
        of = geometry.targets.patches.of_element[cuts.element_sheet == sheet]
        assert len(mine) >= 9 and all(np.ptp(y[of == k]) < 0.021 for k in mine)


def test_a_great_many_slats_share_patches_as_leaves_do(monkeypatch):
    monkeypatch.setattr(patches_room, "_MOST_STRIPS", 7)
    _, patches = patches_of_slats(monkeypatch, 4)
    assert max(len(mine) for mine in patches) <= 2


def test_small_sheets_on_either_side_of_a_wall_share_no_patch(monkeypatch):
    """However close: else a closed room would be lit by the next one."""
    monkeypatch.setattr(geometry_room, "PATCHES", 50)
    scene, plates = wall_and(two_sided=True), []
    for y in (-0.06, -0.02, 0.02, 0.06):
        plates.append([[1, y - 0.01, 0.5], [1.02, y - 0.01, 0.5], [1.02, y + 0.01, 0.5], [1, y + 0.01, 0.5]])
    scene.add("plates", np.concatenate(plates), WHITE, faces=np.arange(16).reshape(4, 4), two_sided=True)
    geometry = make_geometry(scene, find_planes(scene), Globe(4), None)
    of, y = geometry.targets.patches.of_element, geometry.element_points[:, 1] + geometry.planes.centre[1]
    mine = geometry.element_surface == 1
    assert not set(of[mine & (y < 0)].tolist()) & set(of[mine & (y > 0)].tolist())
    assert len(np.unique(of[mine])) == 4


@pytest.mark.parametrize("turned", [False, True])
def test_small_sheets_that_a_wall_crosses_are_parted(monkeypatch, turned):
    """A board through a wall: light of its bright end does not leave from its dark one."""
    monkeypatch.setattr(geometry_room, "PATCHES", 50)
    turn = TURNED if turned else np.eye(3)
    scene = luz.Scene()
    scene.add("wall", np.array([[0, 0, 0], [0, 0, 1], [2, 0, 1], [2, 0, 0]]) @ turn.T, WHITE, two_sided=True)
    board = np.array([[0.4, -0.1, 0.5], [1.6, -0.1, 0.5], [1.6, 0.05, 0.5], [0.4, 0.05, 0.5]])
    scene.add("board", board @ turn.T, WHITE)
    geometry = make_geometry(scene, find_planes(scene), Globe(4), None)
    of = geometry.targets.patches.of_element
    y = (geometry.fracture.elements + geometry.planes.centre) @ turn[:, 1]
    mine = geometry.element_surface == 1
    for number in np.unique(of[mine]):
        here = y[of == number]
        assert here.max() < 1e-9 or here.min() > -1e-9


def test_no_diffuse_surface_no_patches():
    _, patches = patches_of(box(BLACK), 100)
    assert patches.count == 0 and (patches.of_element == -1).all() and (patches.grid_base == -1).all()


def small_sheets(vertices, faces, target):
    scene = luz.Scene()
    scene.add("mesh", vertices, WHITE, faces=faces)
    cuts, planes = cuts_of(scene, math.inf), find_planes(scene)
    every = np.ones(len(cuts.elements), bool)
    return make_patches(planes, cuts.elements, cuts.element_sheet, every, cuts.element_areas, target, [])


def test_curved_meshes_share_patches():
    """Sheets smaller than a patch are gathered by place and facing, so patches are not many more than asked for."""
    turn, height = np.meshgrid(np.linspace(0, 2 * math.pi, 49), np.linspace(-1, 1, 25), indexing="ij")
    radius = np.sqrt(1 - 0.99 * height**2)
    vertices = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1).reshape(-1, 3)
    corner = (np.arange(48)[:, None] * 25 + np.arange(24)).ravel()
    patches = small_sheets(vertices, np.stack([corner, corner + 25, corner + 26, corner + 1], axis=1), 100)
    assert 50 <= patches.count <= 400
    assert (patches.of_element >= 0).all()


def test_scattered_leaves_share_patches():
    rng = np.random.default_rng(3)
    centre = rng.uniform(0, 1, (2000, 3))
    triangles = (centre[:, None] + rng.normal(0, 0.01, (2000, 3, 3))).reshape(-1, 3)
    assert small_sheets(triangles, np.arange(6000).reshape(-1, 3), 100).count < 700
