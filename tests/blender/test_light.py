"""From site, date, hour and sky settings to the solver's light."""

import numpy as np
import pytest


@pytest.fixture
def settings(bpy):
    """Settings of the scene: 27° south, 22 June, noon."""
    made = bpy.context.scene.luzespecular
    made.site.latitude, made.site.longitude, made.site.time_zone = -27.0, -45.0, -3.0
    made.site.day, made.site.month, made.site.year = 22, 6, 2026
    return made


def test_sun_at_solar_noon(addon, bpy, settings):
    place = addon.light.sun_place(settings.site)
    assert place.altitude == pytest.approx(90 - 27 - 23.44, abs=0.05)
    assert place.azimuth % 360 == pytest.approx(0.0, abs=1e-6)
    assert place.day_of_year == 173


def test_solar_morning_and_afternoon_mirror_each_other(addon, settings):
    settings.site.hour = 9.0
    morning = addon.light.sun_place(settings.site)
    settings.site.hour = 15.0
    afternoon = addon.light.sun_place(settings.site)
    assert morning.altitude == pytest.approx(afternoon.altitude, abs=0.01)
    assert morning.azimuth == pytest.approx(360 - afternoon.azimuth, abs=0.01)
    assert 0 < morning.azimuth < 90  # north-east


def test_clock_time_follows_the_time_zone(addon, bpy, settings):
    # 45° west on the zone's own meridian: clock and solar time differ by the equation of time only (-2 min in June).
    settings.site.time_kind = "CLOCK"
    by_clock = addon.light.sun_place(settings.site)
    settings.site.time_zone, settings.site.hour = 0.0, 15.0
    by_utc = addon.light.sun_place(settings.site)
    assert by_utc == by_clock
    settings.site.time_kind, settings.site.hour = "SOLAR", 12.0 - 2.0 / 60.0
    by_sun = addon.light.sun_place(settings.site)
    assert by_clock.altitude == pytest.approx(by_sun.altitude, abs=0.02)
    difference = (by_clock.azimuth - by_sun.azimuth + 180) % 360 - 180
    assert difference == pytest.approx(0.0, abs=0.2)


def test_north_offset_turns_sun_and_sky(addon, bpy, settings):
    # True north lies 30° clockwise of +Y, so the noon Sun (north here) does too: towards +X.
    settings.site.north_offset = 30.0
    settings.sky.kind = "CIE"
    light, _ = addon.light.daylight(bpy.context.scene)
    x, y, _ = light.sun.direction
    assert np.degrees(np.arctan2(x, y)) == pytest.approx(30.0, abs=1e-3)
    assert light.sky.sun_azimuth == pytest.approx(30.0, abs=1e-3)
    assert addon.light.sun_place(settings.site).azimuth % 360 == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("kind", ["CLEAR", "INTERMEDIATE", "OVERCAST"])
def test_presets_come_from_the_availability_model(addon, bpy, settings, kind):
    settings.sky.kind, settings.sky.ground_reflectance = kind, 0.2
    light, notices = addon.light.daylight(bpy.context.scene)
    place = addon.light.sun_place(settings.site)
    expected = addon.luz.default_daylight(
        kind.lower(), place.altitude, place.azimuth, day_of_year=173, ground_reflectance=0.2
    )
    assert light == expected
    assert (light.sun is None) == (kind == "OVERCAST")
    assert not notices


def test_sun_can_be_switched_off(addon, bpy, settings):
    settings.sky.use_sun = False
    light, _ = addon.light.daylight(bpy.context.scene)
    assert light.sun is None
    assert light.sky is not None


def test_given_illuminances(addon, bpy, settings):
    settings.sky.kind, settings.sky.cie_type = "CIE", "7"
    settings.sky.horizontal_illuminance, settings.sky.sun_illuminance = 12_345.0, 67_890.0
    light, _ = addon.light.daylight(bpy.context.scene)
    assert light.sky.horizontal_illuminance == 12_345.0
    assert light.sun.normal_illuminance == 67_890.0
    settings.sky.kind = "NONE"
    light, _ = addon.light.daylight(bpy.context.scene)
    assert light.sky is None
    assert light.sun.normal_illuminance == 67_890.0


@pytest.mark.parametrize("kind", ["CLEAR", "INTERMEDIATE", "OVERCAST", "CIE", "NONE"])
def test_night_is_no_error_and_is_said(addon, bpy, settings, kind):
    settings.sky.kind, settings.site.hour = kind, 22.0
    light, notices = addon.light.daylight(bpy.context.scene)
    assert light.sun is None
    assert (light.sky is not None) == (kind == "CIE")
    assert any("below the horizon" in notice.text and notice.level == "INFO" for notice in notices)


@pytest.mark.parametrize("cie_type", range(1, 17))
def test_every_cie_sky_works_day_and_night(addon, bpy, settings, cie_type):
    settings.sky.kind, settings.sky.cie_type = "CIE", str(cie_type)
    for hour in (0.0, 9.0):
        settings.site.hour = hour
        light, _ = addon.light.daylight(bpy.context.scene)
        assert light.sky.horizontal_illuminance == 10_000.0


def test_impossible_date_is_refused(addon, bpy, settings):
    settings.site.day, settings.site.month = 31, 2
    with pytest.raises(addon.notices.BadInput, match="no day 31 in month 2"):
        addon.light.daylight(bpy.context.scene)


def test_sunrise_and_sunset_in_both_kinds_of_time(addon, settings):
    rise, fall = addon.light.sunrise_sunset(settings.site)
    assert rise + fall == pytest.approx(24.0, abs=0.02)
    assert 6.5 < rise < 7.0
    settings.site.time_kind = "CLOCK"
    clock_rise, _ = addon.light.sunrise_sunset(settings.site)
    assert clock_rise - rise == pytest.approx(2 / 60, abs=0.01)  # the equation of time
    settings.site.latitude = 80.0
    assert addon.light.sunrise_sunset(settings.site) == (None, None)


def test_presets_take_given_illuminances_too(addon, bpy, settings):
    settings.sky.kind, settings.sky.illuminance_from = "INTERMEDIATE", "VALUE"
    settings.sky.horizontal_illuminance, settings.sky.sun_illuminance = 20_000.0, 15_000.0
    light, _ = addon.light.daylight(bpy.context.scene)
    assert light.sky.kind == 10
    assert light.sky.horizontal_illuminance == 20_000.0
    assert light.sun.normal_illuminance == 15_000.0
    settings.sky.kind = "CLEAR"  # a preset brings its own illuminances along
    assert settings.sky.illuminance_from == "MODEL"


@pytest.mark.parametrize(("number", "condition"), [(1, "cloudy"), (5, "cloudy"), (8, "intermediate"), (13, "clear")])
def test_cie_types_by_the_model_of_their_group(addon, bpy, settings, number, condition):
    settings.sky.kind, settings.sky.cie_type, settings.sky.illuminance_from = "CIE", str(number), "MODEL"
    light, _ = addon.light.daylight(bpy.context.scene)
    place = addon.light.sun_place(settings.site)
    direct, diffuse = addon.luz.availability(condition, place.altitude, place.day_of_year)
    assert light.sky.horizontal_illuminance == pytest.approx(diffuse)
    assert (0.0 if light.sun is None else light.sun.normal_illuminance) == pytest.approx(direct)


def test_what_the_panel_shows_is_what_is_used(addon, bpy, settings):
    for kind in ("CLEAR", "INTERMEDIATE", "OVERCAST", "CIE", "NONE"):
        settings.sky.kind = kind
        shown = addon.light.illuminances(settings.sky, addon.light.sun_place(settings.site))
        light, _ = addon.light.daylight(bpy.context.scene)
        assert shown == pytest.approx(
            (light.sky_illuminance, 0.0 if light.sun is None else light.sun.normal_illuminance), rel=1e-6
        )


def test_the_solar_disc_is_handed_on(addon, bpy, settings):
    settings.sky.sun_disc = True
    assert addon.light.daylight(bpy.context.scene)[0].sun.disc
