"""Solving for a sky and Sun: components, linearity, what is skipped, progress and cancelling."""

import math
from itertools import pairwise

import numpy as np
import pytest
from builders import BLACK, DARK, UNIFORM, box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz

WHITE = luz.Material(diffuse_reflectance=0.6)
COMPONENTS = ["sky_direct", "sky_specular", "sun_direct", "sun_specular", "emitted", "interreflected"]
SKY = luz.CIESky(12, sun_altitude=40, sun_azimuth=0, horizontal_illuminance=10_000)
SUN = luz.Sun(altitude=40, azimuth=0, normal_illuminance=80_000)
BOTH = luz.Daylight(sky=SKY, sun=SUN)


def lit_room(lamp=500.0, reflectance=0.6):
    """Room open to the north, with a mirror shelf, a lamp and diffuse walls."""
    white = luz.Material(diffuse_reflectance=reflectance)
    scene = box(white, (3, 3, 3), without=("north",))
    scene.add("shelf", [[0, 2, 1.5], [3, 2, 1.5], [3, 3, 1.5], [0, 3, 1.5]], luz.Material(specular_reflectance=0.9))
    glow = luz.Material(diffuse_reflectance=reflectance, exitance=lamp)
    scene.add("lamp", [[1, 1.5, 2.5], [2, 1.5, 2.5], [2, 1, 2.5], [1, 1, 2.5]], glow)
    return scene


@pytest.fixture(scope="module")
def transfer():
    return prepare_coarse(lit_room(), elements=300, patches=150)


@pytest.fixture(scope="module")
def unlit():
    return prepare_coarse(lit_room(lamp=0.0), elements=300, patches=150)


def test_every_component_is_there(transfer):
    result = transfer.solve(BOTH)
    assert list(result.components) == COMPONENTS
    for name, values in result.components.items():
        assert values.shape == result.illuminance.shape
        assert values.any(), name
        assert (values >= 0).all(), name


def test_each_light_has_its_components(transfer, unlit):
    expected = {
        "sky": {"sky_direct", "sky_specular", "interreflected"},
        "sun": {"sun_direct", "sun_specular", "interreflected"},
    }
    assert lit_components(unlit.solve(luz.Daylight(sky=SKY))) == expected["sky"]
    assert lit_components(unlit.solve(luz.Daylight(sun=SUN))) == expected["sun"]
    assert lit_components(transfer.solve(DARK)) == {"emitted", "interreflected"}
    assert lit_components(unlit.solve(DARK)) == set()


def lit_components(result):
    return {name for name, values in result.components.items() if values.any()}


@settings(max_examples=15, deadline=None)
@given(st.floats(0, 1e5), st.floats(0, 1e5), st.floats(0, 89), st.floats(0, 360))
def test_lights_add_up(unlit, dni, horizontal, altitude, azimuth):
    sky = luz.CIESky(3, horizontal_illuminance=horizontal)
    sun = luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=dni)
    one, two, both = (
        unlit.solve(luz.Daylight(sky=a, sun=b), cycles=3) for a, b in ((sky, None), (None, sun), (sky, sun))
    )
    scale = 1e-6 * (dni + horizontal) + 1e-9
    np.testing.assert_allclose(both.illuminance, one.illuminance + two.illuminance, rtol=1e-5, atol=scale)
    points, normals = [[1.5, 1, 0], [0, 2, 1], [2, 2.5, 1]], [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    np.testing.assert_allclose(
        both.at(points, normals), one.at(points, normals) + two.at(points, normals), rtol=1e-5, atol=scale
    )


@pytest.mark.parametrize("cycles", [0, 1, 4])
def test_lights_add_up_to_the_last_digit(unlit, cycles):
    """Made to add up, lumens of two lights are those of each: nothing in between depends on how bright it is."""
    one, two, both = (
        unlit.solve(luz.Daylight(sky=a, sun=b), cycles=cycles).illuminance
        for a, b in ((SKY, None), (None, SUN), (SKY, SUN))
    )
    np.testing.assert_allclose(both, one + two, rtol=1e-9)


def test_lamps_of_a_closed_box_scale_to_the_last_digit():
    """Where receivers are added does not ask how bright a lamp is, nor does what is made up for."""

    def lit(exitance):
        lamp = luz.Material(diffuse_reflectance=0.7, exitance=exitance)
        scene = box(WHITE, (3, 2, 2.5), ceiling=lamp)
        return prepare_coarse(scene, elements=50, max_area=0.2).solve(DARK, tolerance=1e-12).illuminance

    np.testing.assert_allclose(lit(3e4), 1e4 * lit(3.0), rtol=1e-9)


def test_all_cycles_of_an_open_room_add_up(unlit):
    """Less exactly: how far what stays is trusted depends on how much of this light escapes."""
    one, two, both = (
        unlit.solve(luz.Daylight(sky=a, sun=b), tolerance=1e-10).illuminance
        for a, b in ((SKY, None), (None, SUN), (SKY, SUN))
    )
    np.testing.assert_allclose(both, one + two, rtol=1e-4)


def test_lamps_and_daylight_add_up(transfer, unlit):
    day, lamp = unlit.solve(BOTH, tolerance=1e-7), transfer.solve(DARK, tolerance=1e-7)
    both = transfer.solve(BOTH, tolerance=1e-7)
    np.testing.assert_allclose(both.illuminance, day.illuminance + lamp.illuminance, rtol=1e-5)


def test_light_scales(unlit):
    one = unlit.solve(BOTH, tolerance=1e-7)
    ten = unlit.solve(
        luz.Daylight(
            sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=0, horizontal_illuminance=100_000),
            sun=luz.Sun(altitude=40, azimuth=0, normal_illuminance=800_000),
        ),
        tolerance=1e-7,
    )
    for name, values in one.components.items():
        np.testing.assert_allclose(ten.components[name], 10 * values, rtol=1e-5, atol=1e-6)


def test_more_cycles_more_light(transfer):
    results = [transfer.solve(BOTH, cycles=n).illuminance for n in range(5)]
    for less, more in pairwise(results):
        assert (more >= less * (1 - 1e-9)).all() and more.sum() > less.sum()
    assert (transfer.solve(BOTH).illuminance > results[-1] * (1 - 1e-4)).all()
    np.testing.assert_array_equal(results[0], transfer.solve(BOTH, cycles=0).initial)


def test_cycles_of_sun_and_sky_count_alike(unlit):
    """The first reflection of sunlight is found exactly, not by patches: its cycles must not be off by one."""
    for light in (luz.Daylight(sun=SUN), luz.Daylight(sky=SKY)):
        steps = [unlit.solve(light, cycles=n).illuminance @ unlit.solve(light, cycles=0).areas for n in range(6)]
        gained = np.diff(steps)
        ratios = gained[1:] / gained[:-1]
        assert (gained > 0).all()
        assert (ratios < 0.6).all() and ratios.std() < 0.06, "each cycle gives about the same share of the last"


def test_a_tighter_tolerance_comes_closer(unlit):
    exact = unlit.solve(BOTH, tolerance=1e-9).illuminance
    errors = [np.abs(unlit.solve(BOTH, tolerance=t).illuminance / exact - 1).max() for t in (1e-2, 1e-4, 1e-6)]
    assert errors[0] < 0.05 and errors[1] < 1e-3 and errors[2] < 1e-5


def test_brighter_walls_never_take_light_away():
    """Monotone in the reflectance, everywhere, in every component."""
    results = [prepare_coarse(lit_room(reflectance=r)).solve(BOTH, tolerance=1e-7) for r in (0.01, 0.2, 0.5, 0.8)]
    for darker, brighter in pairwise(results):
        assert (brighter.illuminance >= darker.illuminance * (1 - 1e-6)).all()
        for name in COMPONENTS[:-1]:
            np.testing.assert_allclose(brighter.components[name], darker.components[name], rtol=1e-6, err_msg=name)


def test_ground_light_counts_as_sky(unlit):
    bare = unlit.solve(BOTH)
    ground = unlit.solve(luz.Daylight(sky=SKY, sun=SUN, ground_reflectance=0.2))
    gained = ground.components["sky_direct"] - bare.components["sky_direct"]
    ceiling = ground.faces_of("ceiling")
    assert (gained[ceiling] > 0).all() and gained.min() > -1e-6
    np.testing.assert_allclose(ground.components["sun_direct"], bare.components["sun_direct"])
    alone = unlit.solve(luz.Daylight(sun=SUN, ground_reflectance=0.2), cycles=0)
    luminance = 0.2 * 80_000 * math.sin(math.radians(40)) / math.pi
    assert alone.sky[-1] == pytest.approx(luminance)
    assert alone.components["sky_direct"][ceiling].max() < np.pi * luminance


@pytest.mark.parametrize("altitude", [0.0, -0.1, -90.0])
def test_a_sun_that_is_not_up_leaves_the_sky(unlit, altitude):
    night = unlit.solve(luz.Daylight(sky=SKY, sun=luz.Sun(altitude=altitude, azimuth=0, normal_illuminance=8e4)))
    np.testing.assert_array_equal(night.illuminance, unlit.solve(luz.Daylight(sky=SKY)).illuminance)
    assert skipped(night)["sun"] == "the Sun is at or below the horizon"


def skipped(result):
    return {stage.name: stage.skipped for stage in result.stages if stage.skipped}


def test_stages_say_what_was_skipped_and_why(transfer, unlit):
    assert not {"sky", "sun", "sun patches", "interreflection"} & set(skipped(transfer.solve(BOTH)))
    assert [s.name for s in transfer.solve(BOTH).stages if not s.skipped] == [
        "planes",
        "scene check",
        "fracture",
        "visibility and form factors",
        "sky",
        "sun",
        "interreflection",
    ]
    dark = skipped(unlit.solve(DARK))
    assert (dark["sky"], dark["sun"]) == ("no sky and no ground light", "no Sun")
    dim = luz.Daylight(sun=luz.Sun(altitude=40, azimuth=0, normal_illuminance=0.0))
    assert skipped(unlit.solve(dim))["sun"] == "the Sun gives no light"
    black = prepare_coarse(box(BLACK, without=("ceiling",))).solve(UNIFORM)
    assert skipped(black)["interreflection"] == "no surface reflects or emits diffusely"


def test_skipping_changes_nothing(unlit):
    """A Sun without light, a sky without light: the same as none."""
    none = unlit.solve(luz.Daylight(sky=SKY))
    dim = unlit.solve(luz.Daylight(sky=SKY, sun=luz.Sun(altitude=40, azimuth=0, normal_illuminance=0.0)))
    np.testing.assert_array_equal(none.illuminance, dim.illuminance)
    tiny = luz.Daylight(sky=SKY, sun=luz.Sun(altitude=40, azimuth=0, normal_illuminance=1e-9))
    np.testing.assert_allclose(unlit.solve(tiny).illuminance, none.illuminance, rtol=1e-9)


def test_no_light_no_lux(unlit):
    result = unlit.solve(DARK)
    assert not result.illuminance.any() and not result.exitance.any()
    assert not result.at([[1, 1, 1]], [[0, 0, 1]]).any()


def test_solving_again_gives_the_same_and_leaves_the_transfer_alone(transfer):
    kept = transfer.form_factors.copy(), transfer.sky_direct.dense()
    first = transfer.solve(BOTH)
    transfer.solve(DARK, cycles=1)
    np.testing.assert_array_equal(transfer.solve(BOTH).illuminance, first.illuminance)
    np.testing.assert_array_equal(transfer.form_factors, kept[0])
    np.testing.assert_array_equal(transfer.sky_direct.dense(), kept[1])


def test_both_steps_in_one():
    scene = box(WHITE, without=("ceiling",))
    seen = []
    options = {"bands": 8, "max_area": math.inf, "threads": 1, "progress": lambda f, s: seen.append(s) or True}
    result = luz.solve(scene, UNIFORM, **options)
    np.testing.assert_allclose(result.illuminance, luz.prepare(scene, **options).solve(UNIFORM).illuminance, rtol=1e-6)
    assert seen


def reports_of(transfer, light=BOTH, **options):
    reports = []
    transfer.solve(light, progress=lambda f, s: reports.append((f, s)) or True, **options)
    return reports


def test_solving_reports_its_way(unlit):
    reports = reports_of(unlit)
    fractions = [f for f, _ in reports]
    assert fractions[0] == 0 and fractions[-1] == 1
    assert (np.diff(fractions) >= 0).all()
    assert {s for _, s in reports} == {"sky", "sun", "interreflection", "solved"}


def test_progress_never_goes_back(transfer):
    assert (np.diff([f for f, _ in reports_of(transfer)]) >= 0).all()


@pytest.mark.parametrize("fraction", [0.0, 0.05, 0.1, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("options", [{}, {"cycles": 3}])
def test_solving_can_be_cancelled_anywhere(transfer, fraction, options):
    before = transfer.solve(BOTH).illuminance
    with pytest.raises(luz.Cancelled):
        transfer.solve(BOTH, progress=lambda f, s: f < fraction, **options)
    np.testing.assert_array_equal(transfer.solve(BOTH).illuminance, before)


def test_the_sky_column_holds_means_over_parcels(unlit):
    result = unlit.solve(luz.Daylight(sky=luz.UniformSky(1000.0), ground_reflectance=0.5))
    np.testing.assert_allclose(result.sky[:-1], 1000)
    assert result.sky[-1] == pytest.approx(500)
    clear = unlit.solve(luz.Daylight(sky=SKY)).sky
    globe = unlit.geometry.targets.globe
    upward = globe.first_moments[: len(clear) - 1, 2]
    assert clear[:-1] @ upward == pytest.approx(10_000, rel=3e-3)


def test_quick_is_near_and_keeps_the_lumens(transfer, unlit):
    for some in (transfer, unlit):
        exact, quick = some.solve(BOTH), some.solve(BOTH, quick=True)
        for name in ("sky_direct", "sky_specular", "sun_direct", "sun_specular"):
            np.testing.assert_array_equal(quick.components[name], exact.components[name])
        off = quick.illuminance - exact.illuminance
        assert np.sqrt(np.average(off**2, weights=exact.areas)) < 0.05 * np.average(
            exact.illuminance, weights=exact.areas
        )
        assert abs(quick.balance.defect) < 0.02
        assert quick.balance.entering == pytest.approx(exact.balance.entering, rel=0.02)


def test_quick_changes_nothing_where_nothing_is_bright(unlit):
    sky = luz.Daylight(sky=SKY)
    np.testing.assert_array_equal(unlit.solve(sky, quick=True).illuminance, unlit.solve(sky).illuminance)
