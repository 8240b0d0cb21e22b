"""Moments of the unit disc against closed forms and a fine grid."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luzespecular import clipping, disc

STEP = (np.arange(800) + 0.5) / 400 - 1
U, V = (x.ravel() for x in np.meshgrid(STEP, STEP))
GRID = np.stack([np.ones(len(U)), U, V])[:, U**2 + V**2 < 1]

lines = st.tuples(st.floats(-1.2, 1.2), st.floats(0, 2 * math.pi)).map(
    lambda t: np.array([t[0], math.cos(t[1]), math.sin(t[1])])
)


@given(lines, lines)
def test_moments_of_polygons(first, second):
    shape = clipping.clip(clipping.clip(disc.SQUARE[None], first), second)
    inside = (first @ GRID >= 0) & (second @ GRID >= 0)
    np.testing.assert_allclose(disc.moments(shape)[0], GRID[:, inside].sum(axis=1) / GRID.shape[1], atol=3e-3)


@given(st.floats(-1, 1), st.floats(0, 2 * math.pi))
def test_moments_of_segments(level, turn):
    """A chord at any angle: the closed form, turned."""
    across = np.array([math.cos(turn), math.sin(turn)])
    share, _, height = disc.moments_above(level)
    shape = clipping.clip(disc.SQUARE[None], np.array([-level, *across]))
    np.testing.assert_allclose(disc.moments(shape)[0], [share, *(height * across)], atol=1e-12)


def test_polygons_inside_around_and_beside_the_disc():
    small = 0.1 * disc.SQUARE + [0.9, 0.2, -0.3]
    np.testing.assert_allclose(disc.moments(small), 0.04 / math.pi * np.array([1, 0.2, -0.3]), rtol=1e-12)
    np.testing.assert_allclose(disc.moments(disc.SQUARE), [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(disc.moments(small + np.array([0, 1.5, 0])), 0, atol=1e-15)
    nothing = np.repeat(small[:1], 4, axis=0)
    np.testing.assert_allclose(disc.moments(nothing), 0, atol=1e-15)


@pytest.mark.parametrize("level", [-3.0, -1.0, -0.99, -0.3, 0.0, 0.6, 0.99])
def test_quadrature_keeps_share_and_centroid(level):
    points, weights = disc.quadrature(level)
    assert (weights > 0).all() and (np.hypot(points[:, 1], points[:, 2]) < 1).all() and (points[:, 2] > level).all()
    np.testing.assert_allclose(weights @ points, disc.moments_above(level), atol=3e-6)


@given(st.floats(-1, 1), st.floats(0, 2 * math.pi))
def test_quadrature_of_a_kink(level, turn):
    """The lit part of a face grows evenly from where an edge first meets it: a kink along some chord of the disc."""
    points, weights = disc.quadrature(-1.0)
    share, _, height = disc.moments_above(level)
    along = points[:, 1] * math.cos(turn) + points[:, 2] * math.sin(turn)
    assert weights @ np.maximum(along - level, 0) == pytest.approx(height - level * share, abs=0.0036)
