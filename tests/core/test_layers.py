"""Obstacles taken from beams one after the other, against counting points."""

import numpy as np
import pytest

from luzespecular import layers, overlaps

SQUARE = np.array([[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]])


def half_planes(rng, obstacles, edges=3):
    """Lines that leave a good part of the square each, and one that cuts nothing."""
    turn = rng.uniform(0, 2 * np.pi, (obstacles, edges))
    lines = np.stack([rng.uniform(0.05, 0.4, turn.shape), np.cos(turn), np.sin(turn)])
    return np.concatenate([lines.reshape(3, -1), [[1.0], [0.0], [0.0]]], axis=1)


@pytest.mark.parametrize("obstacles", [2, 5, 12])
def test_nearest_prevails(obstacles):
    rng = np.random.default_rng(obstacles)
    lines = half_planes(rng, 2 * obstacles)
    line_of = np.arange(6 * obstacles).reshape(-1, 3)
    line_of[0, 2] = lines.shape[1] - 1
    depth = np.concatenate([rng.permutation(obstacles), rng.permutation(obstacles)])
    group = np.repeat([0, 1], obstacles)
    visible, settled = layers.peeled(np.stack([SQUARE, 0.5 * SQUARE]), group, lines, line_of, depth)
    assert settled.all()
    for beam, size in ((0, 1.0), (1, 0.5)):
        steps = (np.arange(1500) + 0.5) / 1500 - 0.5
        x, y = (size * v.ravel() for v in np.meshgrid(steps, steps))
        open_ = np.ones(len(x), bool)
        for k in np.flatnonzero(group == beam)[np.argsort(depth[group == beam])]:
            inside = (lines[0, line_of[k]][:, None] + lines[1:, line_of[k]].T @ np.stack([x, y]) > 0).all(axis=0)
            shows = inside & open_
            expected = size**2 / len(x) * np.array([shows.sum(), x[shows].sum(), y[shows].sum()])
            np.testing.assert_allclose(visible[k], expected, atol=2e-4 * size**2)
            open_ &= ~inside


def test_too_many_pieces_are_given_up():
    """A hundred small obstacles, none of which hides another."""
    side = 0.08
    at = (np.stack(np.meshgrid(np.arange(10), np.arange(10)), axis=-1).reshape(-1, 2) - 4.5) / 10
    ways = np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    offset = side / 2 - at @ ways.T
    lines = np.stack([offset, *np.broadcast_to(ways.T[:, None], (2, 100, 4))]).reshape(3, -1)
    visible, settled = layers.peeled(SQUARE[None], np.zeros(100, int), lines, np.arange(400).reshape(-1, 4), at[:, 0])
    assert not settled.any() and not visible.any()


def test_depths_follow_what_stands_before_what():
    near, far = np.array([3, 1, 1, 0]), np.array([0, 2, 3, 2])
    assert layers.depths(near, far, 5).tolist() == [2, 0, 3, 1, 0]
    assert len(layers.depths(np.array([0, 1]), np.array([1, 0]), 2)) == 2  # before each other: an end all the same


def test_many_layers_count_as_few_do(monkeypatch):
    """What inclusion and exclusion finds of a dozen sheets behind one another, found one after the other."""
    from test_visibility import seen_shares

    rng = np.random.default_rng(5)
    sheets = []
    for k in range(9):
        low, high = rng.uniform(-2, -0.2, 2), rng.uniform(0.2, 2, 2)
        corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
        sheets.append(np.c_[corners, np.full(4, 2 + 0.05 * k)])
    points = np.array([[0.1, 0.2, 0], [-0.4, 0.6, 0], [1.0, -1.0, 0]])
    one_by_one = seen_shares(points, [0, 0, 1], sheets, 24)
    monkeypatch.setattr(overlaps, "_FEW_PAIRS", 1000)
    monkeypatch.setattr(overlaps, "_FEW", 1000)
    by_sets = seen_shares(points, [0, 0, 1], sheets, 24)
    np.testing.assert_allclose(one_by_one, by_sets, atol=1e-9)
    assert (one_by_one > 1e-4).sum() > 15
