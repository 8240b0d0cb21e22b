"""Convex polygons cut by planes, and what is left of them."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from polygon_samples import NUMBERS, VECTORS, regular, simple_loops

from luzespecular import clipping, polygons, rings


@given(simple_loops(), VECTORS, NUMBERS)
def test_clipping_shares_out_the_area(loop, normal, offset):
    assume(np.linalg.norm(normal[:2]) > 0.05)  # a polygon within the cutting plane belongs to both sides
    parts = [np.c_[part, np.zeros(len(part))] for part in rings.convex_parts(loop, 1e-9)]
    batch, _ = polygons.pad(parts)
    one, other = clipping.clip(batch, normal, offset), clipping.clip(batch, -normal, -offset)
    np.testing.assert_allclose(polygons.areas(one) + polygons.areas(other), polygons.areas(batch), atol=1e-9)
    kept = polygons.areas(one) > 1e-9
    assert (one[kept] @ normal >= offset - 1e-9).all()
    up = polygons.newell_normal(one)[kept]
    assert (up[:, 2] > 0).all(), "orientation stays"


def test_clipping_by_hand():
    batch = regular(4) + np.array([[[0, 0, 0]], [[5, 0, 0]], [[-5, 0, 0]]])
    np.testing.assert_allclose(polygons.areas(clipping.clip(batch, [1, 0, 0])), [1, 2, 0], atol=1e-15)
    np.testing.assert_allclose(polygons.areas(clipping.clip(batch, [1, 0, 0], [0.5, 4.5, -4.5])), [0.25, 1.75, 0.25])
    each = clipping.clip(batch, [[1, 0, 0], [-1, 0, 0], [-1, 0, 0]])
    np.testing.assert_allclose(polygons.areas(each), [1, 0, 2], atol=1e-15)
    assert clipping.clip(batch[:0], [1, 0, 0]).shape[0] == 0


def random_lines(rng, m, count):
    turn = rng.uniform(0, 2 * np.pi, (m, count))
    return np.stack([rng.uniform(-0.5, 0.8, (m, count)), np.cos(turn), np.sin(turn)], axis=2)


@pytest.mark.parametrize("count", [0, 1, 2, 3, 5])
def test_moments_of_what_half_planes_leave_of_polygons(count):
    """Against clipping one half-plane after the other; among the lines are doubled, opposite and touching ones."""
    rng = np.random.default_rng(count)
    corners = np.array([[-1, -1], [1, -1], [1.2, 0.5], [0.3, 1], [-1, 1], [-1, 1.0]]) * rng.uniform(0.5, 2, (400, 1, 1))
    lines = random_lines(rng, 400, count)
    if count > 1:
        lines[:50, 1] = lines[:50, 0]
        lines[50:100, 1] = -lines[50:100, 0]
        lines[100:150, 0] = np.stack([corners[100:150, 0, 0] * -1, np.full(50, 1.0), np.zeros(50)], axis=1)
        lines[150:200, 1] = np.stack([corners[150:200, 0, 1], np.zeros(50), np.full(50, -1.0)], axis=1)
    left = np.concatenate([corners, np.zeros((400, 6, 1))], axis=2)
    for k in range(count):
        left = clipping.clip(left, lines[:, k, [1, 2, 2]] * [1, 1, 0], -lines[:, k, 0])
    x, y = left[..., 0], left[..., 1]
    following = np.roll(left, -1, axis=1)
    twice = x * following[..., 1] - y * following[..., 0]
    exact = [
        twice.sum(axis=1) / 2,
        (twice * (x + following[..., 0])).sum(axis=1) / 6,
        (twice * (y + following[..., 1])).sum(axis=1) / 6,
    ]
    got = clipping.convex_moments(corners.transpose(2, 1, 0), lines.transpose(2, 1, 0))
    np.testing.assert_allclose(got, exact, atol=1e-12)


@settings(max_examples=60, deadline=None)
@given(
    st.integers(1, 3),
    st.integers(3, 6),
    st.integers(0, 2**31),
    st.floats(-1.2, 1.2),
)
def test_few_polygons_are_clipped_like_many(count, corners, seed, offset):
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * np.arange(corners) / corners
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(corners)], axis=1)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    few = (ring + rng.uniform(-0.5, 0.5, (count, 1, 3))) @ turn.T
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    assert few.size <= clipping._FEWEST
    clipped = clipping.clip(few, normal, offset)
    many = clipping.clip(np.tile(few, (30, 1, 1)), normal, offset)
    np.testing.assert_allclose(polygons.areas(clipped), polygons.areas(many)[:count], atol=1e-12)
    left = clipped[polygons.areas(clipped) > 0]  # of the others one corner stays, wherever it is
    assert (left @ normal - offset).min(initial=0.0) > -1e-12
    np.testing.assert_allclose(polygons.widen(clipped, many.shape[1]), many[:count], atol=1e-12)


@pytest.mark.parametrize("count", [1, 40])
def test_both_sides_of_a_plane_at_once(count):
    rng = np.random.default_rng(count)
    shapes = np.cumsum(rng.uniform(0, 1, (count, 4, 3)), axis=1)
    for offset in (-9.0, 0.7, 9.0):
        normal = np.array([0.6, 0.0, -0.8])
        beyond, within = clipping.parted(shapes, normal, offset)
        np.testing.assert_array_equal(beyond, clipping.clip(shapes, -normal, -offset))
        np.testing.assert_array_equal(within, clipping.clip(shapes, normal, offset))
