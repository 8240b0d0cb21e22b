"""A year of daylight: metrics against a count of the hours one by one, and standards' limits at their edges."""

import numpy as np
import pytest
from builders import box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular.annual import LIMITS, Annual, without_dark

WHITE = luz.Material(diffuse_reflectance=0.5)


@pytest.fixture(scope="module")
def transfer():
    return prepare_coarse(box(WHITE, (3, 3, 3), without=("north",)), max_area=0.5)


@pytest.fixture(scope="module")
def day():
    """Hours of a day: the Sun rises, shines into the room, sets."""
    altitude, azimuth = luz.sun_position_solar(-27.0, 10.0, np.arange(24) + 0.5)
    return [luz.default_daylight("clear", a, z, 100) if a > 0 else None for a, z in zip(altitude, azimuth, strict=True)]


@settings(max_examples=10, deadline=None)
@given(hours=st.lists(st.sampled_from([0.0, 0.5, 1.0, 2.0]), min_size=24, max_size=24).filter(any))
def test_hours_are_counted_as_one_would(transfer, day, hours):
    hours = np.array(hours)
    lux = transfer.solve_many(day)
    year = transfer.annual(day, hours=hours)
    assert year.hours == hours.sum()
    np.testing.assert_allclose(year.lux_hours, hours @ lux, rtol=1e-4)
    np.testing.assert_allclose(year.mean_illuminance, hours @ lux / hours.sum(), rtol=1e-4)
    for limit in LIMITS:
        sure = (np.abs(lux - limit) > 1e-3 * limit).all(axis=0)
        share = (hours @ (lux >= limit)) / hours.sum()
        np.testing.assert_allclose(year.daylight_autonomy(limit)[sure], share[sure], atol=1e-6)
        if limit > 100:
            useful = year.daylight_autonomy(100) - year.daylight_autonomy(limit)
            np.testing.assert_allclose(year.useful_daylight(100, limit), useful, atol=1e-12)


def test_dark_hours_are_one(transfer, day):
    """However many there are: what is computed does not grow with the nights."""
    many, counted = without_dark([*day, *[None] * 100], None)
    assert len(many) == 1 + sum(light is not None for light in day) < 24
    assert (counted.sum(), counted[-1]) == (124, 124 - len(many) + 1)
    with pytest.raises(luz.SceneError, match="Light 2 must be"):
        transfer.annual([None, None, "noon"])


def test_occupied_hours_may_be_true_or_false(transfer, day):
    occupied = [8 <= hour < 18 for hour in range(24)]
    some, all_of_them = transfer.annual(day, hours=occupied), transfer.annual(day)
    assert (some.hours, all_of_them.hours) == (10, 24)
    assert (some.daylight_autonomy() >= all_of_them.daylight_autonomy()).all()


def test_direct_sunlight_is_that_of_single_hours(transfer, day):
    year = transfer.annual(day, sun_spacing=0)
    count = np.zeros(len(year.sunny))
    for light in day:
        if light is not None:
            count += transfer.solve(light).components["sun_direct"] >= 1000
    np.testing.assert_array_equal(year.sunny, count)
    floor = transfer.geometry.fracture.face_surface == 0
    areas = transfer.geometry.fracture.face_areas[floor]
    assert year.sunlight_exposure("floor", hours=4) == pytest.approx(areas @ (count[floor] > 4) / areas.sum())
    assert 0 < year.sunlight_exposure("floor", hours=4) < 1


def test_points_of_a_work_plane(transfer, day):
    x, y = np.meshgrid(np.arange(0.5, 3, 1.0), np.arange(0.5, 3, 1.0))
    points = np.stack([x.ravel(), y.ravel(), np.full(9, 0.8)], axis=1)
    normals = np.broadcast_to([0.0, 0.0, 1.0], points.shape)
    year = transfer.annual(day, points=points, normals=normals)
    lux = transfer.solve_many(day, points=points, normals=normals)
    np.testing.assert_allclose(year.lux_hours, lux.sum(axis=0), rtol=1e-4)
    reached = (lux >= 300).mean(axis=0) >= 0.3
    assert year.spatial_daylight_autonomy(illuminance=300, share=0.3) == pytest.approx(reached.mean())
    with pytest.raises(luz.SceneError, match="free points"):
        year.spatial_daylight_autonomy("floor")


def of_points(reached, sunny=None):
    """A year of 100 hours from hours reached at points, by limit."""
    limits = np.array(LIMITS)
    hours = np.array([reached.get(limit, np.zeros(20)) for limit in LIMITS], float)
    zero = np.zeros(20)
    return Annual(None, 100.0, zero, limits, hours, zero if sunny is None else sunny, False, ())


def share(of, hours):
    """Hours at 20 points: so many of them have ``hours``, the others one less."""
    return np.where(np.arange(20) < of, hours, hours - 1)


@pytest.mark.parametrize(
    "reached, level",
    [
        ({}, "none"),
        ({100: share(19, 50), 300: share(10, 50)}, "minimum"),
        ({100: share(18, 50), 300: share(10, 50)}, "none"),
        ({100: share(19, 50), 300: share(9, 50)}, "none"),
        ({100: share(20, 50), 300: share(19, 50), 500: share(10, 50)}, "medium"),
        ({100: share(20, 50), 300: share(18, 50), 500: share(10, 50)}, "minimum"),
        ({100: share(20, 90), 300: share(20, 50), 500: share(19, 50), 750: share(10, 50)}, "high"),
        ({100: share(20, 90), 300: share(20, 50), 500: share(19, 50), 750: share(9, 50)}, "medium"),
    ],
)
def test_levels_of_en_17037_begin_where_it_says(reached, level):
    assert of_points(reached).provision() == level


def test_shares_of_an_area_at_their_limits():
    year = of_points({300: share(7, 50)}, sunny=np.where(np.arange(20) < 3, 251, 250))
    assert year.spatial_daylight_autonomy() == pytest.approx(7 / 20)
    assert year.sunlight_exposure() == pytest.approx(3 / 20)


def test_areas_weigh_by_their_size(transfer, day):
    year = transfer.annual(day)
    rows = np.flatnonzero(transfer.geometry.fracture.face_surface == 0)
    areas = transfer.geometry.fracture.face_areas[rows]
    expected = areas @ (year.daylight_autonomy(1000)[rows] >= 0.4) / areas.sum()
    assert year.spatial_daylight_autonomy("floor", 1000, 0.4) == pytest.approx(expected)


def test_other_limits_can_be_asked_for(transfer, day):
    year = transfer.annual(day, limits=[123.0])
    assert year.daylight_autonomy(123).shape == year.lux_hours.shape
    with pytest.raises(luz.SceneError, match="only by 123; name it in 'limits'"):
        year.daylight_autonomy(300)
    with pytest.raises(luz.SceneError, match="not below"):
        year.useful_daylight(300, 100)


@pytest.mark.parametrize("hours", [np.ones(3), -np.ones(24), np.zeros(24), "all", np.full(24, np.nan)])
def test_hours_that_do_not_fit_are_refused(transfer, day, hours):
    with pytest.raises(luz.SceneError, match="hours must be"):
        transfer.annual(day, hours=hours)


def test_unknown_surfaces_are_refused(transfer, day):
    year = transfer.annual(day)
    with pytest.raises(luz.SceneError, match="no surface 'roof'"):
        year.spatial_daylight_autonomy("roof")
    with pytest.raises(luz.SceneError, match="Name a surface, one of: floor"):
        year.spatial_daylight_autonomy()


def test_a_year_without_lights_is_refused():
    scene = luz.Scene()
    scene.add("plate", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], luz.Material())
    transfer = prepare_coarse(scene, bands=4)
    with pytest.raises(luz.SceneError, match="no lights"):
        transfer.annual([])
