"""The sky from measured luminances."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sky_samples import ZENITH, clear, hemisphere, some_directions, tregenza

from luzespecular.errors import SceneError
from luzespecular.sky import CIESky, MeasuredSky
from luzespecular.sun import direction_of

pytestmark = pytest.mark.filterwarnings("error")


def test_measured_sky_passes_through_its_measurements():
    nodes = tregenza()
    values = np.random.default_rng(1).uniform(500.0, 20_000.0, len(nodes))
    np.testing.assert_allclose(MeasuredSky(nodes, values).luminance(nodes), values, rtol=1e-9)


@pytest.mark.parametrize(("kind", "altitude", "rms"), [(5, 40, 1e-12), (1, 40, 0.03), (12, 55, 0.03), (12, 25, 0.04)])
def test_measured_sky_recovers_what_a_scanner_saw(kind, altitude, rms):
    sky = CIESky(kind, sun_altitude=altitude, sun_azimuth=37.0, horizontal_illuminance=10_000.0)
    nodes, directions = tregenza(), some_directions(3000)
    measured = MeasuredSky(nodes, sky.luminance(nodes))
    error = measured.luminance(directions) / sky.luminance(directions) - 1
    nearest = sky.luminance(nodes)[np.argmax(directions @ nodes.T, axis=1)] / sky.luminance(directions) - 1
    assert np.sqrt((error**2).mean()) <= rms
    assert np.sqrt((error**2).mean()) <= 0.5 * np.sqrt((nearest**2).mean()) + 1e-12
    assert measured.horizontal_illuminance == pytest.approx(10_000.0, rel=0.01)


def test_measured_sky_has_the_horizontal_illuminance_of_what_it_shows():
    sky = MeasuredSky(tregenza(), clear().luminance(tregenza()))
    directions, solid = hemisphere(250)
    integral = float((sky.luminance(directions) * solid * directions[:, 2]).sum())
    assert sky.horizontal_illuminance == pytest.approx(integral, rel=1e-5)


def test_measured_sky_converges_with_more_measurements():
    sky, directions = clear(sun_altitude=30.0), some_directions(1000)
    errors = []
    for count in (200, 800, 3200):
        nodes = some_directions(count, seed=count)
        got = MeasuredSky(nodes, sky.luminance(nodes)).luminance(directions)
        errors.append(np.sqrt(((got / sky.luminance(directions) - 1) ** 2).mean()))
    assert errors[1] < 0.6 * errors[0] and errors[2] < 0.6 * errors[1]


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 40), st.integers(0, 2**32 - 1))
def test_measured_sky_stays_within_its_values(count, seed):
    random = np.random.default_rng(seed)
    values = np.exp(random.uniform(-3.0, 12.0, count))
    sky = MeasuredSky(some_directions(count, seed=seed), values)
    got = sky.luminance(some_directions(200))
    assert (got >= values.min() * (1 - 1e-12)).all() and (got <= values.max() * (1 + 1e-12)).all()


@settings(max_examples=20, deadline=None)
@given(st.floats(-360.0, 360.0), st.floats(1e-2, 1e3))
def test_measured_sky_turns_and_scales(turn, factor):
    nodes, directions = tregenza(), some_directions(50)
    values = clear().luminance(nodes)
    angle = math.radians(turn)
    rotation = np.array([[math.cos(angle), math.sin(angle), 0], [-math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    turned = MeasuredSky(nodes @ rotation, factor * values).luminance(directions @ rotation)
    np.testing.assert_allclose(turned, factor * MeasuredSky(nodes, values).luminance(directions), rtol=1e-6)


def test_measured_sky_rescaled():
    nodes = tregenza()
    sky = MeasuredSky(nodes, clear().luminance(nodes), horizontal_illuminance=25_000.0)
    assert sky.horizontal_illuminance == 25_000.0
    directions, solid = hemisphere(120)
    assert (sky.luminance(directions) * solid * directions[:, 2]).sum() == pytest.approx(25_000.0, rel=1e-4)
    plain = MeasuredSky(nodes, sky.luminances)
    np.testing.assert_allclose(plain.luminance(nodes), sky.luminance(nodes), rtol=1e-9)


def test_measured_sky_takes_any_length_and_keeps_copies():
    nodes, values = tregenza() * 7.0, np.full(145, 100.0)
    sky = MeasuredSky(nodes, values)
    values[:] = 0.0
    assert sky.luminance(ZENITH)[0] == pytest.approx(100.0)
    with pytest.raises(ValueError, match="read-only"):
        sky.luminances[0] = 1.0


def test_measured_sky_from_neighbours_on_one_great_circle():
    nodes = direction_of([10.0, 40.0, 80.0], [0.0, 0.0, 0.0])
    got = MeasuredSky(nodes, [100.0, 200.0, 400.0]).luminance(some_directions())
    assert np.isfinite(got).all() and (got >= 100.0).all()


@pytest.mark.parametrize(
    ("directions", "luminances", "message"),
    [
        ([[0, 0, 1]], [1.0, 2.0], "give one for each"),
        (np.empty((0, 3)), [], "array with a row"),
        ([[0, 0, 1], [0, 1, 0.5]], [1.0, 0.0], "luminance 1 is 0"),
        ([[0, 0, 1], [0, 1, 0.5]], [1.0, -2.0], "luminances is -2 at 1"),
        ([[0, 0, 1], [0, 1, 0.5]], [math.nan, 2.0], "luminances is nan at 0"),
        ([[0, 0, 1], [0, 1, -0.5]], [1.0, 2.0], "direction 1 points below"),
        ([[0, 0, 1], [0, 0, 0]], [1.0, 2.0], "direction 1 has no length"),
        ([[0, 0, 1], [0, 1, 1], [0, 0, 2]], [1.0, 2.0, 3.0], "direction 0 is there more than once"),
        ([[0, 0, math.inf]], [1.0], "directions is inf"),
        ("up", [1.0], "must be numbers"),
    ],
)
def test_measured_sky_refuses(directions, luminances, message):
    with pytest.raises(SceneError, match=message):
        MeasuredSky(directions, luminances)


def test_measured_sky_refuses_a_dark_scale():
    with pytest.raises(SceneError, match="horizontal_illuminance is 0"):
        MeasuredSky([[0, 0, 1]], [1.0], horizontal_illuminance=0.0)
