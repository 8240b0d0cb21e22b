"""Planes: coplanar pieces joined into few outlines, far-off scenes, sheets of meshes."""

import numpy as np
import pytest
from builders import BLACK, box, box_polygons
from hypothesis import example, given
from hypothesis import strategies as st

from luzespecular import polygons
from luzespecular.planes import find_planes, join_outline
from luzespecular.scene import Scene

UP = np.array([0.0, 0.0, 1.0])


def grid(columns, rows, size=1.0, leave_out=()):
    """Vertices and quads of a rectangle of columns × rows cells, some left out."""
    x, y = np.meshgrid(np.linspace(0, size, columns + 1), np.linspace(0, size, rows + 1), indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    faces = [
        (a, a + rows + 1, a + rows + 2, a + 1)
        for i in range(columns)
        for j in range(rows)
        if (i, j) not in leave_out
        for a in [i * (rows + 1) + j]
    ]
    return vertices, faces


def loops_of(vertices, faces):
    return [vertices[list(face)] for face in faces]


def total(outlines):
    return sum(float(polygons.areas(loop)) for loop in outlines)


@pytest.mark.parametrize(("columns", "rows"), [(2, 1), (3, 3), (30, 30)])
def test_a_subdivided_rectangle_is_one_outline(columns, rows):
    joined = join_outline(loops_of(*grid(columns, rows)), UP)
    assert len(joined) == 1 and len(joined[0]) == 4
    assert total(joined) == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize("leave_out", [{(0, 0)}, {(2, 2)}, {(0, 0), (3, 3)}, {(0, 1), (0, 2)}, {(1, 0), (2, 2)}])
def test_cells_left_out_stay_open(leave_out):
    loops = loops_of(*grid(4, 4, leave_out=leave_out))
    joined = join_outline(loops, UP)
    assert total(joined) == pytest.approx(1 - len(leave_out) / 16, rel=1e-9)
    for i, j in leave_out:
        centre = np.array([(i + 0.5) / 4, (j + 0.5) / 4])
        for loop in joined:
            edge = np.roll(loop, -1, axis=0) - loop
            side = edge[:, 0] * (centre - loop[:, :2])[:, 1] - edge[:, 1] * (centre - loop[:, :2])[:, 0]
            assert (side < 0).any(), "no outline covers the gap"


@given(st.sets(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=0, max_size=15), st.floats(0, 3))
@example({(3, 3), (2, 0), (3, 0)}, 0.0)
def test_joining_keeps_the_area_of_any_cells(leave_out, turn):
    vertices, faces = grid(4, 4, 3.0, leave_out)
    spin = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    loops = loops_of(vertices @ spin.T, faces)
    joined = join_outline(loops, UP)
    assert total(joined) == pytest.approx(9 * len(faces) / 16, rel=1e-9)
    assert len(joined) <= max(len(loops), 1)
    assert all((polygons.newell_normal(loop)[2] > 0) for loop in joined)


def test_faces_that_overlap_come_back_as_they_were():
    loop = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    assert len(join_outline([loop, loop], UP)) == 2


def test_a_box_has_six_sheets():
    planes = find_planes(box())
    assert planes.surfaces == list(box_polygons())
    assert len(planes.outlines) == len(planes.sheet_normal) == 6
    np.testing.assert_array_equal(planes.sheet_surface, range(6))
    np.testing.assert_allclose(planes.centre, [0.5, 0.5, 0.5])
    assert planes.size == pytest.approx(np.sqrt(3))
    np.testing.assert_allclose(polygons.areas(planes.outlines), 1)
    frames = np.concatenate([planes.sheet_axes, planes.sheet_normal[:, None]], axis=1)
    np.testing.assert_allclose(np.linalg.det(frames), 1)


def test_a_box_as_one_mesh_has_six_sheets_of_one_surface():
    scene = Scene()
    vertices, faces = [], []
    for corner in box_polygons((3, 2, 1)).values():
        for a, b, c in ((0, 1, 2), (0, 2, 3)):
            faces.append([len(vertices), len(vertices) + 1, len(vertices) + 2])
            vertices += [corner[a], corner[b], corner[c]]
    scene.add("room", vertices, BLACK, faces=faces)
    planes = find_planes(scene)
    assert len(planes.sheet_surface) == len(planes.outlines) == 6
    assert (planes.sheet_surface == 0).all()
    np.testing.assert_allclose(sorted(polygons.areas(planes.outlines)), [2, 2, 3, 3, 6, 6])
    assert (np.bincount(planes.given_sheet) == 2).all()
    np.testing.assert_array_equal(np.sort(planes.given_source), range(12))


def test_parallel_and_opposite_faces_are_sheets_of_their_own():
    scene = Scene()
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    vertices = np.concatenate([square, np.add(square, [0, 0, 1e-3]), np.add(square[::-1], [2, 0, 0])])
    scene.add("three", vertices, BLACK, faces=np.arange(12).reshape(3, 4))
    planes = find_planes(scene)
    assert len(planes.sheet_normal) == 3
    assert sorted(planes.sheet_normal[:, 2]) == pytest.approx([-1, 1, 1])


@pytest.mark.parametrize("shift", [0.0, 1e4, 1e6])
def test_a_scene_far_off_is_joined_alike(shift):
    scene = Scene()
    vertices, faces = grid(12, 12, 3.0)
    scene.add("floor", vertices + shift, BLACK, faces=faces)
    planes = find_planes(scene)
    assert len(planes.outlines) == 1
    assert polygons.areas(planes.outlines)[0] == pytest.approx(9, rel=1e-7)
    assert np.abs(planes.outlines).max() < 2
    np.testing.assert_allclose(planes.centre, np.array([1.5, 1.5, 0]) + shift)


@given(st.floats(0.1, 3), st.floats(0.1, 3), st.floats(0, 6.28), st.floats(-100, 100))
def test_tilted_meshes_join_too(width, height, turn, shift):
    vertices, faces = grid(5, 4)
    axis = np.array([np.cos(turn), np.sin(turn), 0.0])
    across = np.array([-0.6 * np.sin(turn), 0.6 * np.cos(turn), 0.8])
    scene = Scene()
    scene.add("sheet", shift + vertices[:, :1] * width * axis + vertices[:, 1:2] * height * across, BLACK, faces=faces)
    planes = find_planes(scene)
    assert len(planes.outlines) == 1
    assert polygons.areas(planes.outlines)[0] == pytest.approx(width * height, rel=1e-9)


def test_outlines_of_many_corners_are_parted_and_keep_their_sheet():
    turn = 2 * np.pi * np.arange(100) / 100
    scene = Scene()
    scene.add("disc", np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), BLACK)
    scene.add("square", [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], BLACK)
    planes = find_planes(scene)
    assert planes.outlines.shape[1] <= 32
    assert np.bincount(planes.outline_sheet).tolist() == [4, 1]
    assert polygons.areas(planes.outlines).sum() == pytest.approx(50 * np.sin(2 * np.pi / 100) + 1)
