"""The skies: luminance, exact horizontal illuminance, scale, validation."""

import dataclasses
import json
import math
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from luzespecular.errors import SceneError
from luzespecular.sky import CIE_SKY_NAMES, SUNLESS_SKIES, CIESky, MeasuredSky, PerezSky, Sky, UniformSky
from luzespecular.sky_model import horizontal_integral
from luzespecular.sky_perez import distance_factor, perez_coefficients
from luzespecular.sun import angles_of, direction_of

DATA = Path(__file__).parents[1] / "data"
CIE = json.loads((DATA / "sun_sky_cie.json").read_text(encoding="utf-8"))
RADIANCE = json.loads((DATA / "sun_sky_radiance.json").read_text(encoding="utf-8"))
ZENITH = np.array([[0.0, 0.0, 1.0]])
KINDS = st.integers(1, 16)
ALTITUDES = st.floats(0.0, 90.0)
AZIMUTHS = st.floats(0.0, 360.0)


def hemisphere(rings=300):
    """Directions above the horizon and their solid angles, by rings of equal width; independent of the package."""
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    polar = (nodes + 1) * math.pi / 4
    around = (np.arange(3 * rings) + 0.5) * 2 * math.pi / (3 * rings)
    theta, phi = np.meshgrid(polar, around, indexing="ij")
    directions = np.stack((np.sin(theta) * np.sin(phi), np.sin(theta) * np.cos(phi), np.cos(theta)), axis=-1)
    solid = (weights * math.pi / 4 * np.sin(polar))[:, None] * np.full(len(around), 2 * math.pi / len(around))
    return directions.reshape(-1, 3), solid.ravel()


def some_directions(count=500, seed=0):
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    vectors[:, 2] = np.abs(vectors[:, 2])
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def tregenza():
    """The 145 directions of a sky scanner."""
    rings = ((6, 30), (18, 30), (30, 24), (42, 24), (54, 18), (66, 12), (78, 6), (90, 1))
    return np.concatenate([direction_of(altitude, np.arange(n) * 360.0 / n) for altitude, n in rings])


def clear(**changes):
    return CIESky(12, **{"sun_altitude": 40.0, "sun_azimuth": 30.0, "horizontal_illuminance": 10_000.0, **changes})


def perez(**changes):
    given = {
        "direct_normal_irradiance": 700.0,
        "diffuse_horizontal_irradiance": 120.0,
        "sun_altitude": 40.0,
        "sun_azimuth": 30.0,
    }
    return PerezSky(**{**given, **changes})


# --- CIE general sky ---


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


@pytest.mark.parametrize("record", RADIANCE["gensky"], ids=lambda r: r["name"])
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


# --- all skies ---


SKIES = {
    "clear": clear,
    "overcast": lambda: CIESky(16, horizontal_illuminance=10_000.0),
    "uniform": lambda: UniformSky(1000.0),
    "perez": perez,
    "measured": lambda: MeasuredSky(tregenza(), clear().luminance(tregenza())),
}


@pytest.mark.parametrize("make", SKIES.values(), ids=SKIES)
def test_nothing_at_and_below_the_horizon(make):
    sky = make()
    assert isinstance(sky, Sky)
    below = some_directions() * [1, 1, -1]
    level = direction_of(np.zeros(36), np.arange(0, 360, 10))
    assert (sky.luminance(np.concatenate((below, level))) == 0.0).all()
    assert sky.luminance(direction_of(1e-9, 0.0)) > 0.0


@pytest.mark.parametrize("make", SKIES.values(), ids=SKIES)
def test_horizontal_illuminance_is_the_integral_of_the_luminance(make):
    sky = make()
    directions, solid = hemisphere(150)
    integral = float((sky.luminance(directions) * solid * directions[:, 2]).sum())
    assert sky.horizontal_illuminance == pytest.approx(integral, rel=1e-4)
    assert sky.zenith_luminance == pytest.approx(float(sky.luminance(ZENITH)[0]))


@pytest.mark.parametrize("make", SKIES.values(), ids=SKIES)
def test_shapes_of_directions(make):
    sky, directions = make(), some_directions(24)
    flat = sky.luminance(directions)
    assert flat.shape == (24,) and flat.dtype == np.float64
    np.testing.assert_allclose(sky.luminance(directions.reshape(4, 6, 3)), flat.reshape(4, 6))
    assert np.shape(sky.luminance(directions[0])) == ()
    assert sky.luminance(np.empty((0, 3))).shape == (0,)
    with pytest.raises(SceneError, match=r"\(n, 3\)"):
        sky.luminance(np.zeros((4, 2)))


def test_fast_enough_for_a_slider():
    directions = some_directions(6000)

    def best(run):
        times = []
        for _ in range(7):
            start = time.perf_counter()
            run()
            times.append(time.perf_counter() - start)
        return min(times)

    assert best(clear) < 3e-3
    assert best(perez) < 3e-3
    for sky in (clear(), perez()):
        assert best(lambda sky=sky: sky.luminance(directions)) < 2e-3


def test_horizontal_integral_with_breaks_in_closed_form():
    """A sky that shines above sin γ = 0.3 only, and only within a radian of a Sun at the zenith."""
    band = horizontal_integral(lambda sines: np.where(sines > 0.3, 1.0, 0.0), gradation_breaks=(0.3,))
    assert band == pytest.approx(math.pi * (1 - 0.3**2), rel=1e-12)
    cap = horizontal_integral(
        np.ones_like, lambda angles: np.where(angles < 1.0, 1.0, 0.0), 90.0, indicatrix_breaks=(1.0,)
    )
    assert cap == pytest.approx(math.pi * math.sin(1.0) ** 2, rel=1e-12)


# --- uniform ---


def test_uniform_sky():
    sky = UniformSky(2500.0)
    assert sky.horizontal_illuminance == pytest.approx(math.pi * 2500.0)
    assert sky.zenith_luminance == 2500.0
    assert UniformSky(luminance=2500) == sky


@pytest.mark.parametrize("value", [-1, math.nan, math.inf, None, "grey"])
def test_uniform_sky_refuses(value):
    with pytest.raises(SceneError, match="UniformSky: luminance"):
        UniformSky(value)


# --- Perez ---


@pytest.mark.parametrize("case", RADIANCE["perez_coefficients"], ids=lambda c: str(c["clearness"]))
def test_perez_distribution(case):
    zenith_angle = math.radians(90 - case["sun_altitude"])
    got = perez_coefficients(case["clearness"], case["brightness"], zenith_angle)
    np.testing.assert_allclose(got, case["coefficients"], atol=1e-6)


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
@given(st.floats(0.0, 1000.0), st.floats(5.0, 400.0), st.floats(0.0, 75.0), AZIMUTHS)
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


def test_perez_without_a_positive_sky_is_refused():
    with pytest.raises(SceneError, match="gives no sky"):
        perez(direct_normal_irradiance=23.78, diffuse_horizontal_irradiance=7.388, sun_altitude=82.19)


# --- measured ---


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
