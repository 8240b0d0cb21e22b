"""Light at its limits: the Sun low, high and below, poles and date line, dark skies, light from the ground alone."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, box_polygons, scene_of
from situations import GLOBE, SINGLE, Outcome, Situation, all_of, holds, near, refused, solved

import luzespecular as luz

PLATES = {
    "up": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    "down": [[3, 1, 0], [4, 1, 0], [4, 0, 0], [3, 0, 0]],
    "south": [[6, 0, 0], [7, 0, 0], [7, 0, 1], [6, 0, 1]],
}


def on_plates(light: luz.Daylight) -> np.ndarray:
    result = solved(scene_of({k: np.array(v, float) for k, v in PLATES.items()}), light, bands=24)
    return np.array([result.mean(name) for name in PLATES])


def sun_at(altitude: float, azimuth: float = 180.0) -> Outcome:
    angle, turn = math.radians(altitude), math.radians(azimuth)
    towards = np.array([math.cos(angle) * math.sin(turn), math.cos(angle) * math.cos(turn), math.sin(angle)])
    expected = 8e4 * np.maximum(0, [towards[2], -towards[2], -towards[1]]) * (altitude > 0)
    light = luz.Daylight(sun=luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=8e4))
    return near(on_plates(light), expected, 1e-9, 1e-6)


def disc_at(altitude: float) -> Outcome:
    """The disc of the Sun gives what the ray gives, and at the horizon half of that."""
    light = luz.Daylight(sun=luz.Sun(altitude=altitude, azimuth=180.0, normal_illuminance=8e4, disc=True))
    whole = 8e4 * math.cos(math.radians(altitude))
    return near(on_plates(light)[2], whole if altitude > 0.3 else 0.5 * whole if altitude == 0 else 0.0, 1e-2, 1.0)


def dark_sky() -> Outcome:
    return near(on_plates(luz.Daylight(sky=luz.UniformSky(0.0))), np.zeros(3), 0, 0.0)


def ground_alone() -> Outcome:
    """Under a Sun, what looks down gets ρ times the horizontal illuminance, what stands half of it besides its own."""
    sun = luz.Sun(altitude=30, azimuth=0, normal_illuminance=5e4)
    lux = on_plates(luz.Daylight(sun=sun, ground_reflectance=0.3))
    return near(lux, [25_000, 0.3 * 25_000, 0.5 * 0.3 * 25_000], 1e-4)


def ground_into_a_room() -> Outcome:
    """Light from below the horizon through a hole in a floor: the ceiling gets what the sky's twin would give."""
    polygons = {k: v for k, v in box_polygons((3, 3, 3)).items() if k != "floor"}
    light = luz.Daylight(sky=luz.UniformSky(1000.0), ground_reflectance=0.5)
    up = solved(scene_of(polygons, BLACK), light, bands=40).mean("ceiling")
    turned = {k: v for k, v in box_polygons((3, 3, 3)).items() if k != "ceiling"}
    down = solved(scene_of(turned, BLACK), luz.Daylight(sky=luz.UniformSky(500.0)), bands=40).mean("floor")
    return near(up, down, SINGLE * 10)


def sky_of(kind: int, altitude: float) -> Outcome:
    """Every CIE sky keeps its horizontal illuminance, wherever the Sun stands."""
    sky = luz.CIESky(kind, sun_altitude=altitude, sun_azimuth=77.0, horizontal_illuminance=1e4)
    lux = on_plates(luz.Daylight(sky=sky))
    return all_of(near(lux[0], 1e4, GLOBE), holds(bool((lux >= 0).all()), "nothing negative", f"{lux.min()}"))


def perez_at(altitude: float) -> Outcome:
    sky = luz.PerezSky(
        sun_altitude=altitude, sun_azimuth=0.0, direct_normal_irradiance=800.0, diffuse_horizontal_irradiance=100.0
    )
    lux = on_plates(luz.Daylight(sky=sky))
    return holds(bool(np.isfinite(lux).all() and (lux >= 0).all() and lux[0] > 0), "finite, above 0", f"{lux}")


def positions() -> Iterator[tuple[float, float, dt.datetime]]:
    for year in (1900, 1999, 2000, 2024, 2100):
        for month, day, hour in ((1, 1, 0), (2, 28, 23), (6, 21, 12), (12, 31, 23)):
            when = dt.datetime(year, month, day, hour, 30, tzinfo=dt.UTC)
            for latitude in (-90.0, -66.6, -27.0, 0.0, 66.6, 90.0):
                for longitude in (-180.0, -179.999, 0.0, 179.999, 180.0):
                    yield latitude, longitude, when


def everywhere_always() -> Outcome:
    """Finite and within bounds at poles, date line and all times; −180° and 180° are one meridian."""
    found = np.array([luz.sun_position(*place) for place in positions()])
    good = (
        np.isfinite(found).all()
        and (np.abs(found[:, 0]) <= 90).all()
        and ((found[:, 1] >= 0) & (found[:, 1] <= 360)).all()
    )
    lines = found.reshape(-1, 5, 2)
    return all_of(
        holds(bool(good), "finite and in range", f"{len(found)} positions"),
        near(lines[:, 0, 0], lines[:, 4, 0], 0, 1e-9),
    )


def solar_noon() -> Outcome:
    """At solar noon the Sun's altitude is 90° − |latitude − declination|, from pole to pole."""
    got, expected = [], []
    for latitude in (-90, -60, -23.44, 0, 23.44, 45, 90):
        for declination in (-23.44, 0, 11, 23.44):
            got.append(luz.sun_position_solar(latitude, declination, 12.0)[0])
            expected.append(90 - abs(latitude - declination))
    return near(got, expected, 0, 1e-6)


def leap_day() -> Outcome:
    """29 February lies between its neighbours, and 2100 has none."""
    days = [dt.date(2024, 2, 28), dt.date(2024, 2, 29), dt.date(2024, 3, 1)]
    fall = [luz.declination(dt.datetime.combine(day, dt.time(12), dt.UTC)) for day in days]
    return holds(
        fall[0] < fall[1] < fall[2], "declination rises day by day", f"{fall[0]:.3f} {fall[1]:.3f} {fall[2]:.3f}"
    )


def polar(latitude: float, day: dt.date) -> Outcome:
    events = luz.sunrise_sunset(latitude, 15.0, day)
    return holds(events == (None, None), "neither rises nor sets", f"{events[0]}")


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("light", name, run, long)

    for altitude in (90.0, 89.9999, 45.0, 0.3, 1e-6, 0.0, -1e-6, -30.0, -90.0):
        yield row(f"the Sun at {altitude:g}°", lambda altitude=altitude: sun_at(altitude))
    for altitude in (30.0, 0.4, 0.0, -0.5):
        yield row(f"the Sun's disc at {altitude:g}°", lambda altitude=altitude: disc_at(altitude))
    yield row("a sky of luminance 0", dark_sky)
    yield row("light from the ground alone", ground_alone)
    yield row("light from the ground through a floor", ground_into_a_room)
    for kind, altitude in ((1, 0.0), (5, 90.0), (8, 90.0), (12, 0.0), (12, 90.0), (15, 45.0), (16, 10.0)):
        yield row(f"CIE sky {kind}, Sun at {altitude:g}°", lambda k=kind, a=altitude: sky_of(k, a))
    for altitude in (0.0, 3.0, 87.0, 90.0):
        yield row(f"Perez sky, Sun at {altitude:g}°", lambda altitude=altitude: perez_at(altitude))
    yield row("poles, date line, 1900 to 2100", everywhere_always)
    yield row("solar noon from pole to pole", solar_noon)
    yield row("29 February", leap_day)
    yield row("polar night at 70°", lambda: polar(70.0, dt.date(2026, 12, 21)))
    yield row("midnight Sun at 70°", lambda: polar(70.0, dt.date(2026, 6, 21)))
    yield row("polar night at −90°", lambda: polar(-90.0, dt.date(2026, 6, 21)))
    yield row("a latitude of 91°", lambda: refused(lambda: luz.sun_position_solar(91.0, 0.0, 12.0), "latitude"))
    yield row("a sky of NaN", lambda: refused(lambda: luz.UniformSky(math.nan), "luminance"))
