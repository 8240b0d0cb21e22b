"""The CIE general sky and the uniform sky."""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sky_samples import ZENITH, clear, hemisphere, some_directions

from luzespecular.errors import SceneError
from luzespecular.sky import CIE_SKY_NAMES, SUNLESS_SKIES, CIESky, UniformSky
from luzespecular.sun import angles_of, direction_of

pytestmark = pytest.mark.filterwarnings("error")

DATA = Path(__file__).parents[1] / "data"
CIE = json.loads((DATA / "sun_sky_cie.json").read_text(encoding="utf-8"))
GENSKY = json.loads((DATA / "sun_sky_radiance.json").read_text(encoding="utf-8"))["gensky"]
KINDS = st.integers(1, 16)
ALTITUDES = st.floats(0.0, 90.0)
AZIMUTHS = st.floats(0.0, 360.0)


@pytest.mark.parametrize("case", CIE["cases"], ids=lambda c: f"{c['kind']}-{c['sun_altitude']}")
def test_cie_horizontal_illuminance_is_exact(case):
    sun = {"sun_altitude": case["sun_altitude"], "sun_azimuth": case["sun_azimuth"]}
    exact = case["over_zenith"]["horizontal"]
    by_zenith = CIESky(case["kind"], **sun, zenith_luminance=5000.0)
    assert by_zenith.horizontal_illuminance == pytest.approx(5000.0 * exact, rel=1e-9)
    by_horizontal = CIESky(case["kind"], **sun, horizontal_illuminance=20_000.0)
    assert by_horizontal.zenith_luminance == pytest.approx(20_000.0 / exact, rel=1e-9)
    assert by_horizontal.luminance(ZENITH)[0] == pytest.approx(20_000.0 / exact, rel=1e-9)


@pytest.mark.parametrize("case", CIE["cases"], ids=lambda c: f"{c['kind']}-{c['sun_altitude']}")
def test_cie_luminances(case):
    sky = CIESky(case["kind"], sun_altitude=case["sun_altitude"], sun_azimuth=case["sun_azimuth"], zenith_luminance=1.0)
    altitude, azimuth, expected = np.array(case["luminances"]).T
    np.testing.assert_allclose(sky.luminance(direction_of(altitude, azimuth)), expected, rtol=1e-9)


@pytest.mark.parametrize("kind", range(1, 17))
def test_cie_illuminance_of_tilted_planes(kind):
    case = next(c for c in CIE["cases"] if c["kind"] == kind and c["sun_altitude"] == 40)
    sky = CIESky(kind, sun_altitude=40, sun_azimuth=case["sun_azimuth"], zenith_luminance=1.0)
    directions, solid = hemisphere()
    flux = sky.luminance(directions) * solid
    for name, normal in CIE["receivers"].items():
        got = float((flux * np.maximum(directions @ np.array(normal), 0.0)).sum())
        assert got == pytest.approx(case["over_zenith"][name], rel=2e-4), name


def test_traditional_overcast_in_closed_form():
    sky = CIESky(16, zenith_luminance=9000.0)
    assert sky.horizontal_illuminance == pytest.approx(7 * math.pi / 9 * 9000.0, rel=1e-12)
    assert sky.luminance(direction_of(30.0, 77.0)) == pytest.approx(9000.0 * 2 / 3)


def test_uniform_type_equals_uniform_sky():
    directions = some_directions()
    cie = CIESky(5, zenith_luminance=1000.0)
    assert cie.horizontal_illuminance == pytest.approx(UniformSky(1000.0).horizontal_illuminance, rel=1e-12)
    np.testing.assert_allclose(cie.luminance(directions), UniformSky(1000.0).luminance(directions), rtol=1e-12)


@pytest.mark.parametrize("record", GENSKY, ids=lambda r: r["name"])
def test_standard_clear_sky_agrees_with_gensky(record):
    """Gensky divides by (0.91 + 10 exp(-3 Z) + 0.45 cos² Z)(1 - exp(-0.32)); type 12 is that sky."""
    altitude, azimuth = angles_of(record["direction_to_sun"])
    sky = CIESky(12, sun_altitude=float(altitude), sun_azimuth=float(azimuth), zenith_luminance=1.0)
    at_sun = sky.luminance(direction_of(altitude, azimuth))
    gradation = 1 - math.exp(-0.32 / math.sin(math.radians(altitude)))
    assert gradation * (0.91 + 10 + 0.45) / at_sun == pytest.approx(record["zenith_over_formula"], rel=2e-3)
    ground = record["clear_zenith"] * sky.horizontal_illuminance / math.pi
    assert ground == pytest.approx(record["clear_ground"], rel=0.02)
    overcast = CIESky(16, zenith_luminance=record["overcast_zenith"])
    assert overcast.horizontal_illuminance / math.pi == pytest.approx(record["overcast_ground"], abs=0.05)


@pytest.mark.parametrize("altitude", [0.0, 5e-324, 1e-6, 0.5, 3.0, 89.99, 90.0])
@pytest.mark.parametrize("kind", [2, 8, 12, 15])
def test_cie_integral_near_horizon_and_zenith(kind, altitude):
    """At the limits of the Sun's altitude, against quadrature that knows nothing of the Sun."""
    sky = CIESky(kind, sun_altitude=altitude, sun_azimuth=0.0, zenith_luminance=1.0)
    directions, solid = hemisphere()
    assert sky.horizontal_illuminance == pytest.approx(
        float((sky.luminance(directions) * solid * directions[:, 2]).sum()), rel=3e-5
    )


@settings(max_examples=40, deadline=None)
@given(KINDS, ALTITUDES, AZIMUTHS, st.floats(1e-3, 1e6))
def test_cie_scale_is_linear_and_positive(kind, altitude, azimuth, factor):
    directions = some_directions(60)
    one = CIESky(kind, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=1.0)
    many = CIESky(kind, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=factor)
    assert (one.luminance(directions) > 0).all()
    np.testing.assert_allclose(many.luminance(directions), factor * one.luminance(directions), rtol=1e-12)
    assert many.zenith_luminance == pytest.approx(factor * one.zenith_luminance)


@settings(max_examples=40, deadline=None)
@given(KINDS, ALTITUDES, AZIMUTHS, st.floats(-720.0, 720.0))
def test_cie_turns_with_the_sun(kind, altitude, azimuth, turn):
    directions = some_directions(60)
    angle = math.radians(turn)  # clockwise seen from above
    turned = directions @ np.array(
        [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
    )
    here = CIESky(kind, sun_altitude=altitude, sun_azimuth=azimuth, zenith_luminance=1.0)
    there = CIESky(kind, sun_altitude=altitude, sun_azimuth=azimuth + turn, zenith_luminance=1.0)
    np.testing.assert_allclose(there.luminance(turned), here.luminance(directions), rtol=1e-6)
    assert there.horizontal_illuminance == pytest.approx(here.horizontal_illuminance, rel=1e-13)


@settings(max_examples=30, deadline=None)
@given(KINDS, ALTITUDES, AZIMUTHS)
def test_cie_is_symmetric_about_the_suns_meridian(kind, altitude, azimuth):
    sky = CIESky(kind, sun_altitude=altitude, sun_azimuth=azimuth, zenith_luminance=1.0)
    heights, away = np.linspace(1, 89, 23), np.linspace(0, 180, 23)
    left, right = direction_of(heights, azimuth - away), direction_of(heights, azimuth + away)
    np.testing.assert_allclose(sky.luminance(left), sky.luminance(right), rtol=1e-6)


def test_sunless_types_ignore_the_sun():
    directions = some_directions()
    for kind in SUNLESS_SKIES:
        plain = CIESky(kind, zenith_luminance=1.0)
        at_night = CIESky(kind, sun_altitude=-30.0, sun_azimuth=11.0, zenith_luminance=1.0)
        np.testing.assert_array_equal(plain.luminance(directions), at_night.luminance(directions))
        assert not plain.needs_sun


def test_every_type_has_a_name():
    assert sorted(CIE_SKY_NAMES) == list(range(1, 17))
    assert "clear" in clear().name


def test_black_sky():
    sky = CIESky(5, zenith_luminance=0.0)
    assert sky.horizontal_illuminance == 0.0
    assert (sky.luminance(some_directions()) == 0.0).all()


@pytest.mark.parametrize("kind", [k for k in range(1, 17) if k not in SUNLESS_SKIES])
def test_types_that_need_the_sun_say_so(kind):
    with pytest.raises(SceneError, match=rf"type {kind} needs sun_altitude"):
        CIESky(kind, horizontal_illuminance=1.0)
    with pytest.raises(SceneError, match=r"needs sun_azimuth"):
        CIESky(kind, sun_altitude=30.0, horizontal_illuminance=1.0)
    with pytest.raises(SceneError, match=r"sun_altitude is -0.1.*type 1, 3, 5 or 16"):
        CIESky(kind, sun_altitude=-0.1, sun_azimuth=0.0, horizontal_illuminance=1.0)


@pytest.mark.parametrize("kind", [0, 17, -1, 1.5, "12", None, True, math.nan])
def test_unknown_type_is_refused(kind):
    with pytest.raises(SceneError, match="unknown type"):
        CIESky(kind, horizontal_illuminance=1.0)


def test_exactly_one_scale():
    with pytest.raises(SceneError, match="neither of"):
        CIESky(5)
    with pytest.raises(SceneError, match="both of"):
        CIESky(5, horizontal_illuminance=1.0, zenith_luminance=1.0)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, "much", True, [1.0, 2.0]])
@pytest.mark.parametrize("name", ["horizontal_illuminance", "zenith_luminance"])
def test_bad_scale_names_itself(name, value):
    with pytest.raises(SceneError, match=name):
        CIESky(5, **{name: value})


@pytest.mark.parametrize("change", [{"sun_altitude": math.nan}, {"sun_altitude": 90.5}, {"sun_azimuth": math.inf}])
def test_bad_sun_position_names_itself(change):
    with pytest.raises(SceneError, match=next(iter(change))):
        clear(**change)


def test_cie_sky_is_frozen_and_comparable():
    assert clear() == clear()
    assert len({clear(), clear(), clear(sun_altitude=41.0)}) == 2
    with pytest.raises(dataclasses.FrozenInstanceError):
        clear().zenith_luminance = 3.0


def test_uniform_sky():
    sky = UniformSky(2500.0)
    assert sky.horizontal_illuminance == pytest.approx(math.pi * 2500.0)
    assert sky.zenith_luminance == 2500.0
    assert UniformSky(luminance=2500) == sky


@pytest.mark.parametrize("value", [-1, math.nan, math.inf, None, "grey"])
def test_uniform_sky_refuses(value):
    with pytest.raises(SceneError, match="UniformSky: luminance"):
        UniformSky(value)
