"""Light received: the same whether polygons are worked out one by one or together."""

import numpy as np
import pytest

from luzespecular import received, unhidden
from luzespecular.received import Received

UP = np.array([0.0, 0.0, 1.0])
ASIDE = np.array([0.6, 0.0, 0.8])


def ring(rng, corners, height, size, count):
    """(3, corners, count) float: regular polygons over points, right-handed about the way down."""
    angle = -2 * np.pi * np.arange(corners)[:, None] / corners
    x, y = rng.uniform(-0.4, 0.4, (2, count))
    return np.stack([x + size * np.cos(angle), y + size * np.sin(angle), np.full((corners, count), height)])


@pytest.fixture(scope="module")
def views():
    """What `Received.add` takes: few and many, of 3 to 5 corners, behind 0 to 3 screens."""
    rng = np.random.default_rng(4)
    found = []
    for count in (1, 7, 90):
        for corners in (3, 4, 5):
            for number in range(4):
                shapes = ring(rng, corners, 2.0, 0.7, count)
                screens = np.array(
                    [ring(rng, 3 + k % 2, 1.0 + 0.2 * k, 0.4, count)[:, [0, 1, 2, -1]] for k in range(number)]
                )
                facing = np.ones((number, count))
                normal = UP if number % 2 else ASIDE
                found.append((rng.integers(0, 20, count), rng.uniform(1, 9, count), shapes, normal, screens, facing))
    return found


def one_by_one(views):
    total = np.zeros(20)
    for rows, weight, shapes, normal, screens, facing in views:
        for k, row in enumerate(rows):
            some = slice(k, k + 1)
            if len(screens):
                factor = unhidden.form_factors(shapes[..., some], screens[..., some], facing[:, some], normal)
            else:
                factor = unhidden.whole_form_factors(shapes[..., some], normal)
            total[row] += weight[k] * factor[0]
    return total


def together(views):
    total = Received(20, 0.0)
    for rows, weight, shapes, normal, screens, facing in views:
        if len(screens):
            total.add(rows, weight, shapes, normal, screens, facing)
        else:
            total.add(rows, weight, shapes, normal)
    return total


def test_together_as_one_by_one(views):
    np.testing.assert_allclose(together(views).illuminance(), one_by_one(views), rtol=1e-10)


def test_asked_twice_it_is_the_same(views):
    total = together(views)
    np.testing.assert_array_equal(total.illuminance(), total.illuminance())


def test_few_may_wait(views, monkeypatch):
    expected = together(views).illuminance()
    monkeypatch.setattr(received, "_MOST", 50)
    np.testing.assert_allclose(together(views).illuminance(), expected, rtol=1e-10)


def test_few_behind_a_screen_join_those_behind_more(views, monkeypatch):
    calls = []
    of = unhidden.form_factors
    monkeypatch.setattr(unhidden, "form_factors", lambda *given: calls.append(given[1].shape[0]) or of(*given))
    few = [view for view in views if len(view[0]) == 1 or len(view[4]) == 3]
    np.testing.assert_allclose(together(few).illuminance(), one_by_one(few), rtol=1e-10)
    calls.clear()
    together(few).illuminance()
    assert calls == [3, 3, 3]


def test_nothing_entered():
    total = Received(3, 0.0)
    total.add(np.zeros(0, int), np.zeros(0), np.zeros((3, 4, 0)), UP)
    np.testing.assert_array_equal(total.illuminance(), 0)
