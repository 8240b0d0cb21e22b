"""The Perez all-weather sky."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sky_samples import hemisphere, perez, some_directions

from luzespecular.errors import SceneError
from luzespecular.sky import PerezSky
from luzespecular.sky_perez import (
    diffuse_efficacy,
    direct_efficacy,
    distance_factor,
    perez_coefficients,
    precipitable_water,
)
from luzespecular.sun import angles_of, direction_of

pytestmark = pytest.mark.filterwarnings("error")

DATA = Path(__file__).parents[1] / "data" / "sun_sky_radiance.json"
RADIANCE = json.loads(DATA.read_text(encoding="utf-8"))


@pytest.mark.parametrize("case", RADIANCE["perez_coefficients"], ids=lambda c: str(c["clearness"]))
def test_perez_distribution(case):
    zenith_angle = math.radians(90 - case["sun_altitude"])
    got = perez_coefficients(case["clearness"], case["brightness"], zenith_angle)
    np.testing.assert_allclose(got, case["coefficients"], atol=1e-6)


@pytest.mark.parametrize("case", RADIANCE["perez_parameters"], ids=lambda c: f"{c['clearness']}-{c['brightness']}")
def test_perez_in_every_class_of_clearness(case):
    given_ = case["clearness"], case["brightness"], math.radians(90 - case["sun_altitude"])
    np.testing.assert_allclose(perez_coefficients(*given_), case["coefficients"], atol=4e-6)
    assert diffuse_efficacy(*given_, 2.0) == pytest.approx(case["diffuse_efficacy"], rel=1e-3)
    assert direct_efficacy(*given_, 2.0) == pytest.approx(case["direct_efficacy"], rel=1e-3)


@pytest.mark.parametrize("limit", [1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200])
def test_perez_classes_begin_at_their_limits(limit):
    below, at, above = (np.array(perez_coefficients(limit + step, 0.3, 0.8)) for step in (-1e-9, 0.0, 1e-9))
    assert np.abs(at - above).max() < 1e-12 < np.abs(at - below).max()


def test_perez_brightness_and_clearness_are_kept_in_range():
    assert perez_coefficients(1.03, 5.0, 0.5) == perez_coefficients(1.03, 0.6, 0.5)
    assert perez_coefficients(8.0, 1e-5, 0.5) == perez_coefficients(8.0, 0.01, 0.5)
    assert perez_coefficients(300.0, 0.1, 0.5) == perez_coefficients(12.0, 0.1, 0.5)
    assert direct_efficacy(1.03, 0.2, math.pi / 2, 6.0) == 0.0
    assert precipitable_water(11.0) == pytest.approx(2.0, abs=0.01)


def test_perez_with_a_clear_rising_sun_does_not_gather_on_the_horizon():
    """Here the model's own b is positive, which would make the horizon 1e10 times brighter than the sky above."""
    low = {"direct_normal_irradiance": 418.0, "diffuse_horizontal_irradiance": 47.0, "sun_altitude": 2.45}
    sky = perez(**low)
    assert perez_coefficients(sky.clearness, sky.brightness, math.radians(87.55))[1] > 0.2
    assert sky.coefficients[1] == 0.0
    horizon, above = sky.luminance(direction_of([0.5, 45.0], [210.0, 210.0]))
    assert 0.2 < horizon / above < 5.0


def test_perez_gradation_is_constant_near_the_horizon():
    """All at 90° from a Sun on the horizon, so that the gradation alone makes the difference."""
    sky = perez(direct_normal_irradiance=300.0, diffuse_horizontal_irradiance=5.0, sun_altitude=0.0, sun_azimuth=0.0)
    lowest = math.degrees(math.asin(0.01))
    values = sky.luminance(direction_of([1e-6, 0.5 * lowest, lowest, 10 * lowest], 90.0))
    np.testing.assert_allclose(values[:3], values[0], rtol=1e-12)
    a, b = sky.coefficients[:2]
    assert values[3] / values[0] == pytest.approx(
        (1 + a * math.exp(b / math.sin(math.radians(10 * lowest)))) / (1 + a * math.exp(b / 0.01))
    )


@pytest.mark.parametrize("case", RADIANCE["perez_coefficients"], ids=lambda c: str(c["clearness"]))
def test_perez_integrals(case):
    """Irradiances that give the recorded ε and Δ, then illuminances over the relative distribution's own scale."""
    altitude = case["sun_altitude"]
    zenith_angle = math.radians(90 - altitude)
    air_mass = 1 / (math.cos(zenith_angle) + 0.15 * (93.885 - (90 - altitude)) ** -1.253)
    diffuse = case["brightness"] * 1367.0 / air_mass
    direct = diffuse * (case["clearness"] - 1) * (1 + 1.041 * zenith_angle**3)
    sky = perez(
        direct_normal_irradiance=direct,
        diffuse_horizontal_irradiance=diffuse,
        sun_altitude=altitude,
        horizontal_illuminance=1.0,
    )
    assert sky.clearness == pytest.approx(case["clearness"], rel=1e-12)
    assert sky.brightness == pytest.approx(case["brightness"], rel=1e-12)
    a, b, c, d, e = case["coefficients"]
    above = direction_of(60.0, 200.0)
    chi = math.acos(float(above @ direction_of(altitude, 30.0)))
    relative = (1 + a * math.exp(b / math.sin(math.radians(60)))) * (1 + c * math.exp(d * chi) + e * math.cos(chi) ** 2)
    assert relative / sky.luminance(above) == pytest.approx(case["horizontal"], rel=2e-5)
    directions, solid = hemisphere()
    flux = sky.luminance(directions) * solid * case["horizontal"]
    for name, turn in (("facing_sun", 0.0), ("back", 180.0)):
        vertical = float((flux * np.maximum(directions @ direction_of(0.0, 30.0 + turn), 0.0)).sum())
        assert vertical == pytest.approx(case[name], rel=2e-4), name


@pytest.mark.parametrize("case", RADIANCE["perez_irradiances"], ids=lambda c: f"{c['month']}-{c['day']}")
def test_perez_from_irradiances_agrees_with_gendaylit(case):
    altitude, azimuth = map(float, angles_of(case["direction_to_sun"]))
    day = {12: 355, 6: 172, 3: 80}[case["month"]]
    sky = PerezSky(
        direct_normal_irradiance=case["direct"],
        diffuse_horizontal_irradiance=case["diffuse"],
        sun_altitude=altitude,
        sun_azimuth=azimuth,
        day_of_year=day,
    )
    assert sky.clearness == pytest.approx(case["clearness"], abs=6e-5)
    assert sky.brightness == pytest.approx(case["brightness"], abs=6e-5)
    np.testing.assert_allclose(sky.coefficients, case["coefficients"], atol=5e-5)
    assert sky.horizontal_illuminance == pytest.approx(case["horizontal_illuminance"], rel=case["dome_error"] + 5e-3)
    assert sky.direct_normal_illuminance == pytest.approx(case["direct_normal_illuminance"], rel=1e-3)


def test_perez_overcast_is_darkest_at_the_horizon_and_clear_brightest_by_the_sun():
    overcast = perez(direct_normal_irradiance=0.0)
    assert overcast.direct_normal_illuminance == 0.0
    assert overcast.luminance(direction_of(5.0, 200.0)) < overcast.zenith_luminance
    sky = perez()
    near, far = sky.luminance(direction_of([38.0, 38.0], [30.0, 210.0]))
    assert near > 5 * far
    assert 60_000 < sky.direct_normal_illuminance < 80_000


def test_perez_scale_and_options():
    measured = perez(horizontal_illuminance=12_345.0)
    assert measured.horizontal_illuminance == 12_345.0
    default = perez()
    np.testing.assert_allclose(
        measured.luminance(some_directions()) / 12_345.0,
        default.luminance(some_directions()) / default.horizontal_illuminance,
        rtol=1e-12,
    )
    by_day = perez(day_of_year=3)
    same = perez(extraterrestrial_irradiance=1367.0 * distance_factor(3))
    assert by_day.brightness == same.brightness < default.brightness
    assert (
        perez(dew_point=24.0).horizontal_illuminance > default.horizontal_illuminance
    )  # class 8: more water, more lm/W


@settings(max_examples=60, deadline=None)
@given(st.floats(0.0, 1000.0), st.floats(5.0, 400.0), st.floats(0.0, 75.0), st.floats(0.0, 360.0))
def test_perez_never_negative_and_consistent(direct, diffuse, altitude, azimuth):
    sky = PerezSky(
        direct_normal_irradiance=direct,
        diffuse_horizontal_irradiance=diffuse,
        sun_altitude=altitude,
        sun_azimuth=azimuth,
    )
    values = sky.luminance(some_directions(200))
    assert np.isfinite(values).all() and (values >= 0).all() and values.max() > 0
    assert 50 < sky.horizontal_illuminance / diffuse < 250  # lm/W
    assert sky.coefficients[1] <= 0


@pytest.mark.parametrize(
    "change",
    [
        {"direct_normal_irradiance": -1.0},
        {"diffuse_horizontal_irradiance": math.nan},
        {"diffuse_horizontal_irradiance": 0.0},
        {"sun_altitude": -0.5},
        {"sun_azimuth": None},
        {"day_of_year": 0},
        {"extraterrestrial_irradiance": 0.0},
        {"dew_point": 300.0},
        {"horizontal_illuminance": -5.0},
    ],
)
def test_perez_refuses(change):
    with pytest.raises(SceneError, match=rf"PerezSky: {next(iter(change))}"):
        perez(**change)


def test_perez_refuses_two_sources_of_the_extraterrestrial_irradiance():
    with pytest.raises(SceneError, match="give one of them"):
        perez(day_of_year=10, extraterrestrial_irradiance=1367.0)


def test_perez_with_a_zenith_that_would_be_dark_has_no_gradation():
    sky = perez(direct_normal_irradiance=165.0, diffuse_horizontal_irradiance=61.3, sun_altitude=68.7)
    a, b = perez_coefficients(sky.clearness, sky.brightness, math.radians(90 - 68.7))[:2]
    assert b < 0 and 1 + a * math.exp(b) < 0
    assert sky.coefficients[:2] == (0.0, 0.0)
    assert (sky.luminance(some_directions()) > 0).all()


def test_perez_with_a_negative_indicatrix_is_dark_there():
    """Far from any weather: much diffuse light and the Sun at the zenith, where the model has c < -1."""
    sky = perez(direct_normal_irradiance=727.0, diffuse_horizontal_irradiance=900.0, sun_altitude=90.0)
    a, b, c, d, e = sky.coefficients
    assert 1 + c + e < 0 and sky.zenith_luminance == 0.0
    angles = np.linspace(0.0, math.pi / 2, 400_001)[:-1]
    sines = np.cos(angles)
    gradation = 1 + a * np.exp(b / np.maximum(sines, 0.01))
    relative = gradation * np.maximum(1 + c * np.exp(d * angles) + e * np.cos(angles) ** 2, 0.0)
    integral = 2 * math.pi * (relative * sines * np.sin(angles)).sum() * (angles[1] - angles[0])
    ratio = sky.luminance(direction_of(20.0, 0.0)) / sky.horizontal_illuminance
    at_20 = np.interp(math.radians(70.0), angles, relative)
    assert ratio == pytest.approx(at_20 / integral, rel=1e-7)
