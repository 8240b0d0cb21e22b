"""The Sun as a light, and where it stands."""

import dataclasses
import datetime as dt
import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from luzespecular.errors import SceneError
from luzespecular.sun import (
    Sun,
    angles_of,
    declination,
    direction_of,
    equation_of_time,
    solar_time,
    sun_position,
    sun_position_solar,
    sunrise_sunset,
)

pytestmark = pytest.mark.filterwarnings("error")

FACTS = json.loads((Path(__file__).parents[1] / "data" / "sun_sky_positions.json").read_text(encoding="utf-8"))
LATITUDES = st.floats(-90.0, 90.0)
ANY_HOUR = st.datetimes(dt.datetime(1900, 1, 1), dt.datetime(2100, 12, 31), timezones=st.just(dt.UTC))


def separation(altitude, azimuth, reference):
    """Angle [degrees] between a position and a direction."""
    return 2 * math.degrees(math.asin(np.linalg.norm(direction_of(altitude, azimuth) - np.asarray(reference)) / 2))


# --- the light ---


def test_sun_by_angles_and_by_direction_agree():
    by_angles = Sun(altitude=39.6, azimuth=350.0, normal_illuminance=80_000)
    by_direction = Sun(direction=3.7 * direction_of(39.6, 350.0), normal_illuminance=80_000)
    np.testing.assert_allclose(by_direction.direction, by_angles.direction, atol=1e-15)
    assert by_direction.altitude == pytest.approx(39.6)
    assert by_direction.azimuth == pytest.approx(350.0)
    assert isinstance(by_direction.direction, tuple) and np.linalg.norm(by_direction.direction) == pytest.approx(1.0)
    assert Sun.ANGULAR_DIAMETER == 0.533 and by_angles.disc is False
    assert Sun(altitude=39.6, azimuth=-10.0, normal_illuminance=80_000).azimuth == pytest.approx(350.0)


@pytest.mark.parametrize(
    ("vector", "altitude", "azimuth"),
    [((0, 1, 0), 0, 0), ((1, 0, 0), 0, 90), ((0, -2, 0), 0, 180), ((-1, 0, 1), 45, 270), ((0, 0, 5), 90, 0)],
)
def test_azimuth_runs_clockwise_from_north(vector, altitude, azimuth):
    sun = Sun(direction=vector, normal_illuminance=1.0)
    assert (sun.altitude, sun.azimuth) == pytest.approx((altitude, azimuth))
    np.testing.assert_allclose(direction_of(altitude, azimuth), np.array(vector) / np.linalg.norm(vector), atol=1e-15)


def test_sun_on_the_horizon_gives_nothing_and_just_above_it_does():
    for level in (Sun(direction=(0, 1, 0), normal_illuminance=8e4), Sun(altitude=0, azimuth=0, normal_illuminance=8e4)):
        assert not level.is_up and level.horizontal_illuminance == 0.0
    low = Sun(direction=(0, 1, 1e-9), normal_illuminance=8e4)
    assert low.is_up and low.horizontal_illuminance == pytest.approx(8e-5)
    assert Sun(altitude=1e-12, azimuth=0, normal_illuminance=1.0).is_up
    below = Sun(altitude=-0.1, azimuth=0, normal_illuminance=8e4)
    assert not below.is_up and below.horizontal_illuminance == 0.0
    assert Sun(altitude=90, azimuth=0, normal_illuminance=8e4).horizontal_illuminance == 8e4


@pytest.mark.parametrize("altitude", [90.0, 60.0, 0.27, 0.1, 0.0, -0.2, -0.2664])
def test_a_disc_that_is_partly_up_gives_the_part_above(altitude):
    """Against a grid over the disc; wholly up it gives what the collimated Sun gives."""
    step = (np.arange(1000) + 0.5) / 500 - 1
    u, v = np.meshgrid(step, step)
    radius = math.tan(math.radians(Sun.ANGULAR_DIAMETER / 2))
    up = math.radians(altitude)
    height = np.maximum(math.sin(up) + radius * v * math.cos(up), 0)[u**2 + v**2 < 1]
    disc = Sun(altitude=altitude, azimuth=77.0, normal_illuminance=1.0, disc=True)
    assert disc.is_up
    assert disc.horizontal_illuminance == pytest.approx(height.mean(), rel=3e-3, abs=1e-8)
    if altitude > 0.2665:
        collimated = Sun(altitude=altitude, azimuth=77.0, normal_illuminance=1.0)
        assert disc.horizontal_illuminance == collimated.horizontal_illuminance and disc.disc_horizon == -1.0


@pytest.mark.parametrize("altitude", [-0.2665, -0.3, -90.0])
def test_a_disc_below_the_horizon_gives_nothing(altitude):
    sun = Sun(altitude=altitude, azimuth=77.0, normal_illuminance=1.0, disc=True)
    assert not sun.is_up and sun.horizontal_illuminance == 0.0 and sun.disc_horizon == 1.0


@pytest.mark.parametrize("direction", [(0, 0, 1), (1e-9, 0, 1), (0.3, -0.4, 0.5), (0, 1, 0), (1, 1, -3e-3)])
def test_axes_of_the_disc(direction):
    sun = Sun(direction=direction, normal_illuminance=1.0)
    radius = math.tan(math.radians(0.533 / 2))
    axes = sun.disc_axes
    np.testing.assert_allclose(axes @ axes.T, np.diag([1, radius**2, radius**2]), atol=1e-15)
    np.testing.assert_allclose(axes[0], sun.direction, atol=1e-15)
    assert axes[1, 2] == 0 and axes[2, 2] >= 0


@pytest.mark.parametrize(
    ("given_", "message"),
    [
        ({}, "no direction"),
        ({"altitude": 30.0}, "azimuth is missing"),
        ({"azimuth": 30.0}, "altitude is missing"),
        ({"altitude": math.nan, "azimuth": 0.0}, "altitude must be a finite"),
        ({"altitude": 91.0, "azimuth": 0.0}, "altitude is 91"),
        ({"direction": (0, 0, 0)}, "points nowhere"),
        ({"direction": (0, 1)}, "points nowhere"),
        ({"direction": (0, math.nan, 1)}, "direction is nan"),
        ({"direction": "north"}, "direction must be numbers"),
        ({"direction": (0, 0, 1), "altitude": 30.0, "azimuth": 0.0}, "disagrees"),
    ],
)
def test_bad_directions_are_refused(given_, message):
    with pytest.raises(SceneError, match=message):
        Sun(normal_illuminance=1.0, **given_)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, None, "bright"])
def test_bad_illuminance_is_refused(value):
    with pytest.raises(SceneError, match="normal_illuminance"):
        Sun(altitude=30.0, azimuth=0.0, normal_illuminance=value)


def test_sun_can_be_replaced_and_compared():
    sun = Sun(altitude=30.0, azimuth=0.0, normal_illuminance=1.0)
    assert dataclasses.replace(sun, normal_illuminance=2.0).normal_illuminance == 2.0
    assert dataclasses.replace(sun, altitude=50.0, direction=None).altitude == 50.0
    assert {sun, Sun(altitude=30.0, azimuth=0.0, normal_illuminance=1)} == {sun}
    with pytest.raises(SceneError, match="disc"):
        dataclasses.replace(sun, disc="yes")
    with pytest.raises(dataclasses.FrozenInstanceError):
        sun.altitude = 2.0


@pytest.mark.parametrize("length", [1e-300, 1e-5, 1.0, 1e300])
def test_direction_of_any_length(length):
    sun = Sun(direction=np.array([0.48, 0.6, 0.64]) * length, normal_illuminance=1.0)
    np.testing.assert_allclose(sun.direction, (0.48, 0.6, 0.64), rtol=1e-14)


# --- its place ---


@pytest.mark.parametrize("case", FACTS["cases"], ids=lambda c: c["name"])
def test_sun_position_against_spa(case):
    when = dt.datetime.fromisoformat(case["utc"])
    altitude, azimuth = sun_position(case["latitude"], case["longitude"], when)
    assert separation(altitude, azimuth, case["direction"]) < 0.002
    assert altitude == pytest.approx(case["altitude"], abs=0.001)
    apparent, same_azimuth = sun_position(case["latitude"], case["longitude"], when, refraction=True)
    assert apparent == pytest.approx(case["apparent_altitude"], abs=0.001)
    assert same_azimuth == azimuth
    assert equation_of_time(when) == pytest.approx(case["equation_of_time"], abs=0.01)
    assert solar_time(case["longitude"], when) == pytest.approx(case["solar_time"], abs=2e-4)
    assert when.timetuple().tm_yday == case["day_of_year"]


def test_sun_position_worldwide_1900_to_2100():
    cases = FACTS["worldwide"]
    when = np.array([case["utc"].rstrip("Z") for case in cases], dtype="datetime64[s]")
    latitude, longitude, altitude, azimuth = (
        np.array([case[key] for case in cases]) for key in ("latitude", "longitude", "altitude", "azimuth")
    )
    got = direction_of(*sun_position(latitude, longitude, when))
    apart = 2 * np.degrees(np.arcsin(np.linalg.norm(got - direction_of(altitude, azimuth), axis=1) / 2))
    assert apart.max() < 0.002


def test_sun_position_speaks_every_kind_of_time():
    utc = dt.datetime(2024, 6, 21, 15, 0, tzinfo=dt.UTC)
    local = utc.astimezone(dt.timezone(dt.timedelta(hours=-3)))
    expected = sun_position(-27.6, -48.5, utc)
    assert all(isinstance(value, float) for value in expected)
    assert sun_position(-27.6, -48.5, local) == expected
    assert sun_position(-27.6, -48.5, np.datetime64("2024-06-21T15:00")) == expected
    altitude, azimuth = sun_position(-27.6, -48.5, [utc, local])
    np.testing.assert_array_equal(altitude, [expected[0]] * 2)
    np.testing.assert_array_equal(azimuth, [expected[1]] * 2)
    hours = np.datetime64("2024-06-21", "h") + np.arange(24)
    altitude, _ = sun_position(np.array([[-27.6], [51.5]]), 0.0, hours)
    assert altitude.shape == (2, 24)
    assert altitude[1, 12] == sun_position(51.5, 0.0, hours[12])[0]


@pytest.mark.parametrize(
    ("when", "message"),
    [
        (dt.datetime(2024, 6, 21, 12), r"no time zone.*replace\(tzinfo"),
        ([dt.datetime(2024, 6, 21, 12)], "no time zone"),
        (np.datetime64("NaT"), "NaT"),
        ("2024-06-21", "is no instant"),
        (dt.date(2024, 6, 21), "is no instant"),
        (45_000.0, "is no instant"),
    ],
)
def test_times_that_are_none(when, message):
    for ask in (lambda: sun_position(0.0, 0.0, when), lambda: declination(when), lambda: equation_of_time(when)):
        with pytest.raises(SceneError, match=message):
            ask()


@pytest.mark.parametrize(("latitude", "longitude"), [(90.5, 0.0), (math.nan, 0.0), (0.0, math.inf), ("south", 0.0)])
def test_places_that_are_none(latitude, longitude):
    with pytest.raises(SceneError, match=r"latitude|longitude"):
        sun_position(latitude, longitude, dt.datetime(2024, 1, 1, tzinfo=dt.UTC))


@settings(max_examples=60, deadline=None)
@given(LATITUDES, st.floats(-180.0, 180.0), ANY_HOUR)
def test_sun_position_is_that_of_its_declination_and_solar_time(latitude, longitude, when):
    """But for the parallax, the two functions tell the same."""
    altitude, azimuth = sun_position(latitude, longitude, when)
    assert -90 <= altitude <= 90 and 0 <= azimuth < 360
    solar = sun_position_solar(latitude, declination(when), solar_time(longitude, when))
    assert separation(altitude, azimuth, direction_of(*solar)) < 0.0026


def test_leap_days():
    for year in (2000, 2024, 2048):
        before, leap, after = (
            declination(dt.datetime(year, *day, 12, tzinfo=dt.UTC)) for day in ((2, 28), (2, 29), (3, 1))
        )
        assert before < leap < after
        assert leap - before == pytest.approx(after - leap, abs=0.01)


def test_declination_of_solstices_and_equinoxes():
    assert declination(dt.datetime(2024, 6, 20, 20, 51, tzinfo=dt.UTC)) == pytest.approx(23.437, abs=0.003)
    assert declination(dt.datetime(2024, 12, 21, 9, 20, tzinfo=dt.UTC)) == pytest.approx(-23.437, abs=0.003)
    assert declination(dt.datetime(2024, 3, 20, 3, 6, 21, tzinfo=dt.UTC)) == pytest.approx(0.0, abs=0.001)
    year = np.datetime64("2024-01-01T12:00") + np.arange(366) * np.timedelta64(1, "D")
    minutes = equation_of_time(year)
    assert minutes.min() == pytest.approx(-14.2, abs=0.1) and minutes.max() == pytest.approx(16.5, abs=0.1)


# --- from declination and solar time ---


def test_light_shelf_room():
    """Latitude -27°, 22 June: the hours of the paper's experiment, by spherical trigonometry written out."""
    latitude, delta = math.radians(-27.0), math.radians(23.44)
    for hour in (9.0, 10.0, 12.0):
        altitude, azimuth = sun_position_solar(-27.0, 23.44, hour)
        hour_angle = math.radians(15 * (hour - 12))
        sine = math.sin(latitude) * math.sin(delta) + math.cos(latitude) * math.cos(delta) * math.cos(hour_angle)
        assert altitude == pytest.approx(math.degrees(math.asin(sine)))
        assert (azimuth + 180) % 360 - 180 == pytest.approx(
            math.degrees(math.asin(-math.cos(delta) * math.sin(hour_angle) / math.cos(math.asin(sine)))), abs=1e-9
        )
    assert sun_position_solar(-27.0, 23.44, 12.0) == pytest.approx((90 - 27 - 23.44, 0.0))


@pytest.mark.parametrize("delta", [23.44, 0.0, -23.44])
@pytest.mark.parametrize("pole", [90.0, -90.0])
def test_at_the_poles_the_altitude_is_the_declination(pole, delta):
    hours = np.linspace(0, 24, 49)
    altitude, azimuth = sun_position_solar(pole, delta, hours)
    np.testing.assert_allclose(altitude, math.copysign(1, pole) * delta, atol=1e-9)
    assert np.isfinite(azimuth).all() and ((azimuth >= 0) & (azimuth < 360)).all()


def test_polar_night_and_midnight_sun():
    hours = np.linspace(0, 24, 97)
    night, _ = sun_position_solar(80.0, -23.44, hours)
    assert night.max() == pytest.approx(-13.44) and (night < 0).all()
    day, _ = sun_position_solar(80.0, 23.44, hours)
    assert (day.min(), day.max()) == pytest.approx((13.44, 33.44))


@settings(max_examples=100, deadline=None)
@given(LATITUDES, st.floats(-23.45, 23.45), st.floats(0.0, 12.0))
def test_morning_mirrors_afternoon(latitude, delta, hours):
    morning = direction_of(*sun_position_solar(latitude, delta, 12 - hours))
    afternoon = direction_of(*sun_position_solar(latitude, delta, 12 + hours))
    np.testing.assert_allclose(morning, afternoon * [-1, 1, 1], atol=1e-9)
    assert morning[0] >= -1e-9  # the morning Sun stands in the east


@settings(max_examples=50, deadline=None)
@given(LATITUDES, st.floats(-23.45, 23.45), st.floats(-48.0, 48.0))
def test_hemispheres_mirror_each_other(latitude, delta, hour):
    north = direction_of(*sun_position_solar(latitude, delta, hour))
    south = direction_of(*sun_position_solar(-latitude, -delta, hour))
    np.testing.assert_allclose(north, south * [1, -1, 1], atol=1e-9)


@pytest.mark.parametrize("bad", [(91, 0, 12), (0, 100, 12), (0, 0, math.nan), (0, 0, None)])
def test_solar_position_refuses(bad):
    with pytest.raises(SceneError):
        sun_position_solar(*bad)


def test_angles_of_many_directions():
    altitude, azimuth = angles_of([[0, 0, 2], [0, 0, -1], [-1e-18, 1, 0]])
    np.testing.assert_allclose(altitude, [90, -90, 0])
    assert (azimuth == 0).all()


# --- sunrise and sunset ---


@pytest.mark.parametrize("case", FACTS["sunrise_sunset"], ids=lambda c: c["name"])
def test_sunrise_and_sunset_against_spa(case):
    rise, fall = sunrise_sunset(case["latitude"], case["longitude"], dt.date.fromisoformat(case["date"]))
    for got, key in ((rise, "sunrise"), (fall, "sunset")):
        assert abs((got - dt.datetime.fromisoformat(case[key])).total_seconds()) < 2, key


def test_no_sunrise_in_polar_day_and_night():
    assert sunrise_sunset(69.65, 18.96, dt.date(2023, 12, 21)) == (None, None)
    assert sunrise_sunset(69.65, 18.96, dt.date(2023, 6, 21)) == (None, None)
    assert sunrise_sunset(90.0, 0.0, dt.date(2023, 6, 21)) == (None, None)
    assert sunrise_sunset(-90.0, 0.0, dt.date(2023, 6, 21)) == (None, None)
    assert None not in sunrise_sunset(69.65, 18.96, dt.date(2023, 12, 21), altitude=-6.0)  # but civil twilight


@settings(max_examples=60, deadline=None)
@given(st.floats(-60.0, 60.0), st.floats(-180.0, 180.0), st.dates(dt.date(1901, 1, 1), dt.date(2099, 12, 31)))
def test_the_sun_stands_at_the_horizon_when_it_rises_and_sets(latitude, longitude, date):
    rise, fall = sunrise_sunset(latitude, longitude, date, altitude=0.0)
    assert rise < fall
    for moment, hour_side in ((rise, -1), (fall, 1)):
        altitude, _ = sun_position(latitude, longitude, moment)
        assert altitude == pytest.approx(0.0, abs=1e-4)
        assert math.copysign(1, solar_time(longitude, moment) - 12) == hour_side
    noon = rise + (fall - rise) / 2
    assert solar_time(longitude, noon) == pytest.approx(12.0, abs=0.05)
    assert abs((noon + dt.timedelta(hours=longitude / 15)).replace(tzinfo=None) - dt.datetime(
        date.year, date.month, date.day, 12
    )) < dt.timedelta(minutes=20)  # fmt: skip


def test_sunrise_needs_a_date():
    with pytest.raises(SceneError, match=r"datetime\.date"):
        sunrise_sunset(0.0, 0.0, "2024-06-21")
