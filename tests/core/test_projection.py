"""Projection: images in mirrors, covered shares of parcels, outlines cut to what can be seen."""

import math

import numpy as np
import pytest
from builders import box_polygons
from hypothesis import assume, given
from hypothesis import strategies as st

from luzespecular import polygons
from luzespecular.globe import Globe
from luzespecular.projection import (
    Beams,
    HalfSpace,
    coverage,
    edge_planes,
    obstacles_within,
    reflect,
    reflect_points,
)

COORDINATE = st.floats(-10, 10)
POINT = st.tuples(COORDINATE, COORDINATE, COORDINATE).map(np.array)
UNIT = POINT.filter(lambda v: np.linalg.norm(v) > 0.1).map(lambda v: v / np.linalg.norm(v))


@given(POINT, UNIT, COORDINATE)
def test_reflecting_twice_changes_nothing(point, normal, offset):
    np.testing.assert_allclose(reflect(reflect(point, normal), normal), point, atol=1e-12)
    image = reflect_points(point, normal, offset)
    np.testing.assert_allclose(reflect_points(image, normal, offset), point, atol=1e-10)
    assert image @ normal - offset == pytest.approx(offset - point @ normal, abs=1e-10)
    np.testing.assert_allclose(np.cross(image - point, normal), 0, atol=1e-10)


@given(POINT, UNIT, COORDINATE)
def test_reflections_keep_lengths(point, normal, offset):
    assert np.linalg.norm(reflect(point, normal)) == pytest.approx(np.linalg.norm(point))
    other = np.array([1.0, 2.0, 3.0])
    images = reflect_points(np.stack([point, other]), normal, offset)
    assert np.linalg.norm(images[0] - images[1]) == pytest.approx(np.linalg.norm(point - other))


def test_reflection_in_a_floor():
    np.testing.assert_array_equal(reflect_points([[1, 2, 3], [4, 5, 0.5]], [0, 0, 1], 0.5), [[1, 2, -2], [4, 5, 0.5]])
    np.testing.assert_array_equal(reflect([1, 2, 3], [0, 0, -1]), [1, 2, -3])


@given(POINT, UNIT, COORDINATE, UNIT, COORDINATE)
def test_half_spaces_are_mirrored_with_their_points(point, normal, offset, mirror, at):
    half = HalfSpace(normal, offset)
    image = half.reflected(mirror, at)
    assert image.normal @ reflect_points(point, mirror, at) - image.offset == pytest.approx(
        normal @ point - offset, abs=1e-9
    )


@given(UNIT)
def test_mirrored_beams_keep_their_shape(mirror):
    beams = Beams.of(Globe(7).hemisphere([0, 0, 1]))
    image = beams.reflected(mirror)
    frames = np.concatenate([image.directions[:, None], image.axes], axis=1)
    before = np.concatenate([beams.directions[:, None], beams.axes], axis=1)
    np.testing.assert_allclose(
        np.einsum("nac,nbc->nab", frames, frames), np.einsum("nac,nbc->nab", before, before), atol=1e-12
    )
    np.testing.assert_array_equal(image.columns, beams.columns)
    np.testing.assert_array_equal(image.reach, beams.reach)


@given(
    st.floats(0.02, 1.0),
    st.floats(0.02, 1.0),
    st.floats(0, 2 * math.pi),
    st.floats(-1.6, 1.6),
)
def test_coverage_against_sampling(half_a, half_b, turn, place):
    """A rectangle's share on one side of a line, and where that share's centre lies, by 300 × 300 points."""
    step = (np.arange(300) + 0.5) / 150 - 1
    a, b = (x.ravel() for x in np.meshgrid(half_a * step, half_b * step))
    distance = place * math.hypot(half_a, half_b)
    across = a * math.cos(turn) + b * math.sin(turn)
    inside = across + distance >= 0
    share, moment = coverage(
        np.array([distance]),
        np.array([2 * half_a * abs(math.cos(turn))]),
        np.array([2 * half_b * abs(math.sin(turn))]),
    )
    # a line along the rows of points is off by up to half a row
    assert share[0] == pytest.approx(inside.mean(), abs=4e-3)
    assert moment[0] == pytest.approx(inside.mean() * across[inside].mean() if inside.any() else 0.0, abs=5e-3)


@given(st.floats(-2, 2), st.floats(1e-6, 1), st.floats(1e-6, 1))
def test_two_sides_of_an_edge_add_up_to_one(place, width_a, width_b):
    distance = np.array([place * (width_a + width_b)])
    one, moment = coverage(distance, np.array([width_a]), np.array([width_b]))
    other, opposite = coverage(-distance, np.array([width_a]), np.array([width_b]))
    assert one[0] + other[0] == pytest.approx(1, abs=1e-9)
    # the parts' centres balance about the middle; the other side's normal points the other way
    assert moment[0] - opposite[0] == pytest.approx(0, abs=1e-9)


def test_coverage_of_a_beam_without_width():
    with np.errstate(all="raise"):
        share, moment = coverage(np.array([-1.0, 1.0]), np.zeros(2), np.zeros(2))
    np.testing.assert_allclose(share, [0, 1])
    np.testing.assert_allclose(moment, 0, atol=1e-90)


def test_coverage_far_from_the_edge():
    share, moment = coverage(np.array([-9.0, 9.0]), np.array([0.1, 0.1]), np.array([0.2, 0.0]))
    np.testing.assert_allclose(share, [0, 1])
    np.testing.assert_allclose(moment, 0, atol=1e-12)


ROOM = np.array(list(box_polygons((2, 2, 2)).values()))
NORMALS = polygons.newell_normal(ROOM) / np.linalg.norm(polygons.newell_normal(ROOM), axis=1)[:, None]
OFFSETS = np.einsum("oc,oc->o", NORMALS, ROOM[:, 0])


def test_outlines_are_cut_at_the_horizon():
    seen = obstacles_within(ROOM, NORMALS, OFFSETS, [HalfSpace(np.array([0, 0, 1.0]), 0.5)], 1e-9)
    assert seen.outlines.tolist() == [1, 2, 3, 4, 5], "the floor lies below"
    np.testing.assert_allclose(polygons.areas(seen.vertices), [4, 3, 3, 3, 3])
    assert (seen.vertices[:, :, 2] >= 0.5 - 1e-9).all()
    np.testing.assert_array_equal(seen.normals, NORMALS[1:])
    # the ceiling keeps its four edges, the walls lose the one on the horizon
    length = np.linalg.norm(np.roll(seen.vertices, -1, axis=1) - seen.vertices, axis=2)
    assert ((length > 1e-9) & seen.bounding).sum(axis=1).tolist() == [4, 3, 3, 3, 3]


def test_a_plane_that_the_receivers_lie_in_is_no_obstacle():
    seen = obstacles_within(ROOM, NORMALS, OFFSETS, [HalfSpace(np.array([0, 0, 1.0]), 0.0)], 1e-9)
    assert 0 not in seen.outlines
    assert len(seen.outlines) == 5
    everything = obstacles_within(ROOM, NORMALS, OFFSETS, [], 1e-9)
    assert len(everything.outlines) == 6 and everything.bounding.all()
    nothing = obstacles_within(ROOM, NORMALS, OFFSETS, [HalfSpace(np.array([0, 0, 1.0]), 2.0)], 1e-9)
    assert len(nothing.outlines) == 0


@given(POINT, st.integers(0, 5), st.floats(-0.4, 1.4), st.floats(-0.4, 1.4))
def test_edge_planes_tell_inside_from_outside(point, side, u, v):
    """A direction is within an outline where all its edge planes are on the positive side."""
    obstacles = obstacles_within(ROOM, NORMALS, OFFSETS, [], 1e-9)
    height = point @ NORMALS[side] - OFFSETS[side]
    assume(abs(height) > 1e-2)
    assume(min(abs(u), abs(v), abs(1 - u), abs(1 - v)) > 1e-3)
    a, b, _, d = ROOM[side]
    target = a + u * (b - a) + v * (d - a)
    planes, heights = edge_planes(point[None], obstacles, 1e-9)
    assert heights[0, side] == pytest.approx(-height)
    inside = (planes[0, side] @ (target - point) > 0).all()
    assert inside == (0 < u < 1 and 0 < v < 1)
    np.testing.assert_allclose(np.linalg.norm(planes[0, side], axis=1), 1)


def test_points_in_a_plane_have_no_height_over_it():
    obstacles = obstacles_within(ROOM, NORMALS, OFFSETS, [], 1e-6)
    _, heights = edge_planes(np.array([[1.0, 1.0, 1e-7], [1.0, 1.0, 1e-5]]), obstacles, 1e-6)
    assert heights[0, 0] == 0 and heights[1, 0] != 0
