"""Sky, Sun and ground light together."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luzespecular.daylight import Daylight
from luzespecular.errors import SceneError
from luzespecular.sky import CIESky, Sky, UniformSky
from luzespecular.sun import Sun, direction_of

UP, DOWN, LEVEL = [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]
SUN = Sun(altitude=30.0, azimuth=0.0, normal_illuminance=80_000.0)


def test_illuminances_add_up():
    light = Daylight(sky=UniformSky(1000.0), sun=SUN, ground_reflectance=0.2)
    assert light.sky_illuminance == pytest.approx(1000 * math.pi)
    assert light.sun_illuminance == pytest.approx(40_000.0)
    assert light.horizontal_illuminance == pytest.approx(1000 * math.pi + 40_000.0)
    assert light.ground_luminance == pytest.approx(0.2 * (1000 * math.pi + 40_000.0) / math.pi)


def test_luminance_above_and_below_the_horizon():
    light = Daylight(sky=UniformSky(1000.0), sun=SUN, ground_reflectance=0.5)
    np.testing.assert_allclose(light.sky_luminance([UP, DOWN, LEVEL]), [1000.0, light.ground_luminance, 0.0])
    without_sky = Daylight(sun=SUN, ground_reflectance=0.5)
    np.testing.assert_allclose(without_sky.sky_luminance([UP, DOWN]), [0.0, 0.5 * 40_000 / math.pi])
    assert (Daylight(sky=UniformSky(1000.0)).sky_luminance([DOWN, LEVEL]) == 0.0).all()


def test_no_light_at_all():
    light = Daylight()
    assert light.horizontal_illuminance == light.ground_luminance == 0.0
    assert (light.sky_luminance([UP, DOWN]) == 0.0).all()


@pytest.mark.parametrize("altitude", [0.0, -20.0])
def test_a_sun_that_is_not_up_gives_nothing(altitude):
    light = Daylight(sun=Sun(altitude=altitude, azimuth=10.0, normal_illuminance=80_000.0), ground_reflectance=0.3)
    assert light.sun_illuminance == light.ground_luminance == 0.0


@given(st.floats(0.0, 1.0), st.floats(0.0, 90.0), st.floats(0.0, 1e5))
def test_the_ground_sends_back_its_reflectance(reflectance, altitude, illuminance):
    """Flux up from the ground over flux down on it; the uniform hemisphere gives π times its luminance."""
    sky = CIESky(12, sun_altitude=altitude, sun_azimuth=0.0, horizontal_illuminance=10_000.0)
    sun = Sun(altitude=altitude, azimuth=0.0, normal_illuminance=illuminance)
    light = Daylight(sky=sky, sun=sun, ground_reflectance=reflectance)
    assert math.pi * light.ground_luminance == pytest.approx(reflectance * light.horizontal_illuminance)
    down = direction_of(np.linspace(-90, -1, 9), np.linspace(0, 350, 9))
    np.testing.assert_array_equal(light.sky_luminance(down), light.ground_luminance)


def test_a_sky_of_ones_own():
    class Stripe(Sky):
        horizontal_illuminance = 5.0

        def luminance(self, directions):
            return np.where(np.asarray(directions)[..., 2] > 0.5, 3.0, 0.0)

    assert Daylight(sky=Stripe()).sky_illuminance == 5.0
    assert Stripe().zenith_luminance == 3.0


@pytest.mark.parametrize(
    ("given_", "message"),
    [
        ({"sky": "clear"}, "sky must be a sky object, not 'clear'"),
        ({"sky": SUN}, "sky must be a sky object"),
        ({"sun": UniformSky(1.0)}, "sun must be a Sun"),
        ({"sun": (0, 0, 1)}, "sun must be a Sun"),
        ({"ground_reflectance": 1.2}, "ground_reflectance is 1.2; it must be between 0 and 1"),
        ({"ground_reflectance": -0.1}, "ground_reflectance"),
        ({"ground_reflectance": math.nan}, "ground_reflectance"),
        ({"ground_reflectance": "grass"}, "ground_reflectance"),
    ],
)
def test_refusals_name_the_part(given_, message):
    with pytest.raises(SceneError, match=f"Daylight: {message}"):
        Daylight(**given_)
