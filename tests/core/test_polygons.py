"""Polygons in space: orientation, areas, and the form factors that they have by formula."""

import math

import numpy as np
import pytest
from builders import lambert_form_factor
from hypothesis import assume, given
from hypothesis import strategies as st
from polygon_samples import VECTORS, regular

from luzespecular import polygons


@pytest.mark.parametrize("corners", [3, 4, 5, 64])
def test_area_and_normal_of_regular_polygons(corners):
    polygon = regular(corners, 2.0, 5.0)
    area = 0.5 * corners * 4 * math.sin(2 * math.pi / corners)
    assert polygons.areas(polygon) == pytest.approx(area)
    np.testing.assert_allclose(polygons.newell_normal(polygon), [0, 0, 2 * area], atol=1e-12)
    np.testing.assert_allclose(polygons.newell_normal(polygon[::-1]), [0, 0, -2 * area], atol=1e-12)


def test_area_far_from_the_origin():
    assert polygons.areas(regular(4) + 1e8) == pytest.approx(2, rel=1e-6)


def test_padding_changes_neither_area_nor_normal():
    padded, counts = polygons.pad([regular(3), regular(6)])
    assert padded.shape == (2, 6, 3) and counts.tolist() == [3, 6]
    np.testing.assert_allclose(polygons.areas(padded), [polygons.areas(regular(3)), polygons.areas(regular(6))])
    np.testing.assert_array_equal(padded[0, 3:], np.broadcast_to(regular(3)[-1], (3, 3)))
    empty, none = polygons.pad([])
    assert empty.shape == (0, 3, 3) and len(none) == 0


@given(VECTORS)
def test_plane_basis_is_right_handed(vector):
    length = np.linalg.norm(vector)
    assume(length > 1e-3)
    first, second = polygons.plane_basis(vector / length)
    np.testing.assert_allclose(np.cross(first, second), vector / length, atol=1e-12)
    assert abs(first @ second) < 1e-12 and np.linalg.norm(first) == pytest.approx(1)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)])
def test_plane_basis_follows_the_axes_of_rooms(normal):
    basis = polygons.plane_basis(np.array(normal, float))
    np.testing.assert_allclose(np.sort(np.abs(basis), axis=1), [[0, 0, 1], [0, 0, 1]])


def parallel_corner(a, b, c):
    """Element under the corner of a parallel rectangle a × b at distance c (Howell's catalogue B-3)."""
    x, y = a / c, b / c
    one = x / math.hypot(1, x) * math.atan(y / math.hypot(1, x))
    return (one + y / math.hypot(1, y) * math.atan(x / math.hypot(1, y))) / (2 * math.pi)


def perpendicular_corner(a, b, c):
    """Element at distance c from the lower corner of a perpendicular rectangle, a high and b wide (Howell B-4)."""
    x, y = a / b, c / b
    root = math.hypot(x, y)
    return (math.atan(1 / y) - y / root * math.atan(1 / root)) / (2 * math.pi)


SIZES = st.floats(0.01, 50.0)


@given(SIZES, SIZES, SIZES)
def test_lambert_parallel_rectangle(a, b, c):
    ceiling = np.array([[[0, b, c], [a, b, c], [a, 0, c], [0, 0, c]]])
    got = lambert_form_factor(ceiling, [0, 0, 1])[0]
    assert got == pytest.approx(parallel_corner(a, b, c), rel=1e-6, abs=1e-12)
    assert lambert_form_factor(ceiling[:, ::-1], [0, 0, 1])[0] == pytest.approx(-got)


@given(SIZES, SIZES, SIZES)
def test_lambert_perpendicular_rectangle(a, b, c):
    wall = np.array([[[c, 0, 0], [c, 0, a], [c, b, a], [c, b, 0]]])[:, ::-1]
    got = abs(lambert_form_factor(wall, [0, 0, 1])[0])
    assert got == pytest.approx(perpendicular_corner(a, b, c), rel=1e-5, abs=1e-12)


def test_lambert_adds_up_over_parts_and_turns_with_the_scene():
    whole = np.add(regular(5, 1.0, 0.5)[::-1], [0.2, 0.1, 0])
    parts, _ = polygons.pad([whole[:3], whole[[0, 2, 3]], whole[[0, 3, 4]]])
    one = lambert_form_factor(whole[None], [0, 0, 1])[0]
    assert lambert_form_factor(parts, [0, 0, 1]).sum() == pytest.approx(one, rel=1e-12)
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    assert lambert_form_factor(whole[None] @ turn.T, turn @ [0, 0, 1])[0] == pytest.approx(one, rel=1e-12)
    assert lambert_form_factor(whole[None] * 1e-6, [0, 0, 1])[0] == pytest.approx(one, rel=1e-12)


def test_lambert_of_a_disc():
    """Element on the axis of a parallel disc: sin² of the half angle; a polygon of many sides is nearly one."""
    for radius, height in ((1, 1), (0.5, 2), (3, 0.2)):
        disc = regular(400, radius, height)[::-1]
        exact = radius**2 / (radius**2 + height**2)
        assert lambert_form_factor(disc[None], [0, 0, 1])[0] == pytest.approx(exact, rel=1e-4)


def test_lambert_takes_one_normal_for_each():
    ceiling = np.array([[[0, 1, 1], [1, 1, 1], [1, 0, 1], [0, 0, 1.0]]] * 2)
    got = lambert_form_factor(ceiling, [[0, 0, 1], [1, 0, 0]])
    assert got[0] == pytest.approx(parallel_corner(1, 1, 1))
    assert got[1] == pytest.approx(perpendicular_corner(1, 1, 1))
    assert len(lambert_form_factor(ceiling[:0], [0, 0, 1])) == 0
