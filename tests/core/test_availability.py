"""The illuminances to begin with, where nothing was measured."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luzespecular.availability import CONDITIONS, availability, default_daylight, extraterrestrial_illuminance
from luzespecular.errors import SceneError
from luzespecular.sky import CIESky
from luzespecular.sky_perez import distance_factor

DATA = Path(__file__).parents[1] / "data" / "sun_sky_availability.json"
CASES = json.loads(DATA.read_text(encoding="utf-8"))["cases"]
NAMES = {"clear": "clear", "partly": "partly cloudy", "cloudy": "overcast"}


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"day {c['day_of_year']}")
def test_formulas_of_record(case):
    day = case["day_of_year"]
    assert extraterrestrial_illuminance(day) == pytest.approx(1000 * case["extraterrestrial_klx"], rel=1e-12)
    assert distance_factor(day) == pytest.approx(case["eccentricity_spencer"], rel=1e-12)
    for altitude, conditions in case["klx_by_altitude"].items():
        for name, expected in conditions.items():
            direct, diffuse = availability(NAMES[name], float(altitude), day)
            assert direct == pytest.approx(1000 * expected["E_dn_klx"], rel=1e-12)
            assert diffuse == pytest.approx(1000 * expected["E_dh_sky_klx"], rel=1e-12)


def test_arrays_of_altitudes_and_days():
    altitude, day = np.linspace(-90, 90, 37), np.array([[1], [172], [366]])
    direct, diffuse = availability("clear", altitude, day)
    assert direct.shape == diffuse.shape == (3, 37)
    assert direct[1, 30] == availability("clear", altitude[30], 172)[0]
    assert diffuse[2, 30] == availability("clear", altitude[30])[1]
    assert availability("clear", 45.0)[0] == pytest.approx(127_500 * math.exp(-0.21 / math.sin(math.pi / 4)))


@pytest.mark.parametrize("condition", CONDITIONS)
def test_nothing_at_night(condition):
    assert availability(condition, [-90.0, -5.0, 0.0])[0].tolist() == [0, 0, 0]
    assert availability(condition, [-90.0, -5.0, 0.0])[1].tolist() == [0, 0, 0]
    light = default_daylight(condition, -5.0, 100.0)
    assert light.sky is None and light.sun is None and light.ground_luminance == 0.0


@given(st.sampled_from(CONDITIONS), st.floats(0.5, 89.0), st.floats(0.01, 1.0), st.integers(1, 366))
def test_higher_sun_more_light(condition, altitude, step, day):
    low, high = availability(condition, altitude, day), availability(condition, altitude + step, day)
    assert high[1] > low[1] and high[0] >= low[0]
    assert low[0] < extraterrestrial_illuminance(day)


def test_conditions_by_brightness_of_sun_and_sky():
    clear, partly, overcast = (availability(c, 50.0) for c in ("clear", "partly cloudy", "overcast"))
    assert clear[0] > partly[0] > overcast[0] == 0.0
    assert partly[1] > overcast[1] > clear[1]


@pytest.mark.parametrize(("condition", "kind"), [("clear", 12), ("partly cloudy", 10), ("overcast", 16)])
def test_default_daylight(condition, kind):
    light = default_daylight(condition, 39.6, 10.0, day_of_year=173)
    direct, diffuse = availability(condition, 39.6, 173)
    assert light.sky.kind == kind
    assert light.sky_illuminance == pytest.approx(diffuse)
    assert light.ground_reflectance == 0.2
    if condition == "overcast":
        assert light.sun is None
    else:
        assert light.sun.normal_illuminance == direct
        assert (light.sun.altitude, light.sun.azimuth) == (39.6, 10.0)
        assert (light.sky.sun_altitude, light.sky.sun_azimuth) == (39.6, 10.0)


def test_partly_cloudy_takes_the_nearest_cie_type():
    """Nearest to the distribution RP-21 gives: (0.526 + 5 exp(-1.5 χ))(1 - exp(-0.8 / sin γ)) (Pierpoint)."""
    sines, around = np.meshgrid((np.arange(60) + 0.5) / 60, np.arange(90) * 2 * np.pi / 90, indexing="ij")
    cosines = np.sqrt(1 - sines**2)
    directions = np.stack((cosines * np.sin(around), cosines * np.cos(around), sines), axis=-1)
    distance = dict.fromkeys(range(1, 16), 0.0)
    for altitude in range(10, 80, 10):
        sun = np.array([0.0, math.cos(math.radians(altitude)), math.sin(math.radians(altitude))])
        chi = np.arccos(np.clip(directions @ sun, -1, 1))
        wanted = (0.526 + 5 * np.exp(-1.5 * chi)) * (1 - np.exp(-0.8 / sines))
        wanted /= (wanted * sines).mean()
        for kind in distance:
            sky = CIESky(kind, sun_altitude=altitude, sun_azimuth=0.0, zenith_luminance=1.0)
            got = sky.luminance(directions)
            distance[kind] += np.sqrt(((got / (got * sines).mean() - wanted) ** 2).mean())
    assert min(distance, key=distance.get) == default_daylight("partly cloudy", 40.0, 0.0).sky.kind


def test_synonyms():
    for said, meant in (("Clear ", "clear"), ("INTERMEDIATE", "partly cloudy"), ("partly_cloudy", "partly cloudy")):
        assert availability(said, 40.0) == availability(meant, 40.0)
    assert availability("cloudy", 40.0) == availability("overcast", 40.0)


@pytest.mark.parametrize("condition", ["sunny", "", None, 12])
def test_unknown_condition_lists_the_known(condition):
    with pytest.raises(SceneError, match=r"'clear', 'partly cloudy', 'overcast'"):
        availability(condition, 40.0)


@pytest.mark.parametrize(
    ("given_", "message"),
    [
        ({"sun_altitude": 91.0}, "sun_altitude"),
        ({"sun_altitude": math.nan}, "sun_altitude"),
        ({"day_of_year": 0}, "day_of_year"),
        ({"day_of_year": 367}, "day_of_year"),
    ],
)
def test_refusals(given_, message):
    arguments = {"condition": "clear", "sun_altitude": 40.0, **given_}
    with pytest.raises(SceneError, match=message):
        availability(**arguments)
    with pytest.raises(SceneError, match=message):
        default_daylight(sun_azimuth=0.0, **arguments)


def test_default_daylight_passes_on_the_ground():
    assert default_daylight("clear", 40.0, 0.0, ground_reflectance=0.0).ground_luminance == 0.0
    with pytest.raises(SceneError, match="ground_reflectance"):
        default_daylight("clear", 40.0, 0.0, ground_reflectance=2.0)
