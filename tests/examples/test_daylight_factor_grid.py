"""The grid's sky component against the closed form for a window under the CIE traditional overcast sky."""

import numpy as np
import pytest


def sky_component(width, height, distance):
    """Walsh (1961), The Science of Daylight: unglazed window, sill at the point's height, one jamb opposite to it."""
    head, jamb = np.arctan(height / distance), np.arctan(width / distance)
    inclined = np.arctan(np.cos(head) * np.tan(jamb))
    return (
        3 / (14 * np.pi) * (jamb - inclined * np.cos(head))
        + 2 / (7 * np.pi) * np.arcsin(np.sin(jamb) * np.sin(head))
        - 1 / (7 * np.pi) * np.sin(2 * head) * np.sin(inclined)
    )


@pytest.fixture(scope="module")
def grids(example):
    return example("daylight_factor_grid.py"), *example("daylight_factor_grid.py").daylight_factors()


def test_sky_component_of_every_point(grids):
    study, _, sky = grids
    points, _, shape = study.work_plane()
    exact = []
    for x, y, z in points:
        right, left = (np.sign(d) * sky_component(abs(d), study.HEAD - z, y) for d in (study.RIGHT - x, study.LEFT - x))
        exact.append(100 * (right - left))
    np.testing.assert_allclose(sky, np.reshape(exact, shape), rtol=0.01)
    assert np.sqrt(np.mean((sky / np.reshape(exact, shape) - 1) ** 2)) < 0.003


def test_walls_add_light_everywhere_and_the_room_is_symmetric(grids):
    _, factors, sky = grids
    assert np.all(factors > sky)
    np.testing.assert_allclose(factors, factors[:, ::-1], rtol=0.01)


def test_statistics(grids):
    study = grids[0]
    found = study.statistics(np.array([1.0, 2.0, 6.0]))
    assert found == {
        "minimum": 1.0,
        "mean": 3.0,
        "median": 2.0,
        "maximum": 6.0,
        "uniformity": pytest.approx(1 / 3),
        "share above 2 %": pytest.approx(200 / 3),
    }
