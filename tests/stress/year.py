"""Many lights at once, and years of them, where sums are known."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Iterator
from functools import cache

import numpy as np
from builders import BLACK, box_polygons, prepare_coarse
from situations import SINGLE, Outcome, Situation, all_of, holds, near, refused

import luzespecular as luz

GREY = luz.Material(diffuse_reflectance=0.5)
EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
SUNNY = luz.Daylight(sky=luz.UniformSky(500.0), sun=luz.Sun(altitude=50, azimuth=30, normal_illuminance=6e4))


@cache
def plate() -> luz.Transfer:
    scene = luz.Scene()
    scene.add("plate", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], BLACK)
    scene.add("wall", [[3e4, 0, 0], [3e4 + 1, 0, 0], [3e4 + 1, 0, 1], [3e4, 0, 1]], BLACK)  # looks south
    return prepare_coarse(scene, bands=24, elements=20)


@cache
def room(lamp: float = 0.0) -> luz.Transfer:
    scene = luz.Scene()
    for name, polygon in box_polygons((3, 2, 2.5)).items():
        if name != "north":
            scene.add(name, polygon, GREY)
    scene.add(
        "mirror",
        [[0.01, 0.5, 0.5], [0.01, 1.5, 0.5], [0.01, 1.5, 1.5], [0.01, 0.5, 1.5]],
        luz.Material(specular_reflectance=0.8),
    )
    if lamp:
        scene.add("lamp", [[1, 0.4, 2.4], [2, 0.4, 2.4], [2, 0.2, 2.4], [1, 0.2, 2.4]], luz.Material(exitance=lamp))
    return prepare_coarse(scene, bands=16, elements=300, patches=150)


def suns(latitude: float, day: dt.date) -> list[luz.Daylight]:
    """Sunlight alone, hour by hour."""
    places = [
        luz.sun_position_solar(latitude, luz.declination(dt.datetime.combine(day, dt.time(12), dt.UTC)), h)
        for h in range(24)
    ]
    return [luz.Daylight(sun=luz.Sun(altitude=a, azimuth=z, normal_illuminance=5e4)) for a, z in places]


def sums_of_one_light() -> Outcome:
    """The same light for ten hours: ten times its lux, and every limit below it is reached all the time."""
    annual = plate().annual([EVEN] * 10, limits=[100.0, 3000.0, 3200.0])
    level, half = 1000 * math.pi, 500 * math.pi
    up, side = annual.lux_hours[plate().geometry.faces_of("plate")], annual.lux_hours[plate().geometry.faces_of("wall")]
    return all_of(
        near(up, 10 * level, SINGLE * 10),
        near(side, 10 * half, 1e-4),
        near(annual.daylight_autonomy(3000.0)[0], 1.0, 0),
        near(annual.daylight_autonomy(3200.0)[0], 0.0, 0, 0),
        near(annual.spatial_daylight_autonomy("wall", 3000.0), 0.0, 0, 0),
    )


def weighted_hours() -> Outcome:
    """Hours that count for half and for nothing."""
    annual = plate().annual([EVEN, SUNNY, EVEN], hours=[0.5, 0.0, 2.0])
    return all_of(
        near(annual.hours, 2.5, 0),
        near(annual.lux_hours[0], 2500 * math.pi, 1e-4),
        near(annual.mean_illuminance[0], 1000 * math.pi, 1e-4),
    )


def nights() -> Outcome:
    """A year without light but a lamp's: nothing on the plates; the lamp's lux in the room, all the time."""
    dark = plate().annual([None] * 5 + [luz.Daylight()] * 3)
    lit = room(800.0)
    alone = lit.solve(luz.Daylight(), tolerance=1e-7).illuminance
    by_year = lit.annual([None] * 4, limits=[1.0])
    return all_of(
        near(dark.lux_hours, np.zeros(len(dark.lux_hours)), 0, 0), near(by_year.mean_illuminance, alone, 5e-3, 0.05)
    )


def sunny_day(latitude: float, day: dt.date) -> Outcome:
    """On an open plate a day's sunlight is the sum of E⊥ · sin(altitude)."""
    lights = suns(latitude, day)
    heights = [math.sin(math.radians(light.sun.altitude)) for light in lights]
    annual = plate().annual(lights, sun_spacing=0)
    return near(annual.lux_hours[0], 5e4 * sum(max(0.0, h) for h in heights), 1e-5, 1e-6)


def one_by_one(spacing: float, allowed: float) -> Outcome:
    """Many lights together and each by itself, in a room with a mirror; what is dark is dark."""
    lights = [
        EVEN,
        None,
        SUNNY,
        luz.Daylight(sun=luz.Sun(altitude=60, azimuth=0, normal_illuminance=5e4)),
        luz.Daylight(sun=luz.Sun(altitude=-5, azimuth=0, normal_illuminance=5e4)),
        luz.Daylight(sky=luz.CIESky(3, zenith_luminance=2000), ground_reflectance=0.4),
    ]
    got = room().solve_many(lights, sun_spacing=spacing)
    singles = [
        np.zeros(got.shape[1]) if light is None else room().solve(light, tolerance=1e-7).illuminance for light in lights
    ]
    areas = room().solve(EVEN).areas
    return near(got @ areas, np.array(singles) @ areas, allowed, 1e-6)


def at_points() -> Outcome:
    """At free points: as `Result.at` tells."""
    places, normals = [[1.5, 1, 0.8], [2.5, 0.5, 0.0], [1.5, 1.2, 1.0]], [[0, 0, 1], [0, 0, 1], [0, -1, 0]]
    got = room().solve_many([EVEN, SUNNY], points=places, normals=normals, sun_spacing=0)
    single = [room().solve(light, tolerance=1e-7).at(places, normals) for light in (EVEN, SUNNY)]
    return near(got, single, 2e-2)


def low_sun() -> Outcome:
    """A Sun lower than any position that is followed: never more than at that one, never negative."""
    low = [luz.Daylight(sun=luz.Sun(altitude=a, azimuth=180, normal_illuminance=5e4)) for a in (0.01, 0.5, 2.0)]
    got = plate().solve_many(low, sun_spacing=5.0)
    exact = 5e4 * np.sin(np.radians([0.01, 0.5, 2.0]))
    good = bool((got >= 0).all() and (got[:, 0] <= 5e4 * math.sin(math.radians(5)) * 1.01).all())
    return all_of(holds(good, "bounded", f"{got[:, 0]}"), near(got[2, 0], exact[2], 0.6))


def no_lights() -> Outcome:
    got = room().solve_many([])
    return all_of(
        holds(got.shape == (0, len(room().solve(EVEN).areas)), "an empty table", f"{got.shape}"),
        refused(lambda: room().annual([]), "no lights"),
    )


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("light", f"hours: {name}", run, long)

    yield row("one light ten times", sums_of_one_light)
    yield row("halves and none", weighted_hours)
    yield row("nights alone", nights)
    for latitude, month in ((0.0, 3), (-27.0, 6), (60.0, 12), (80.0, 12), (80.0, 6), (-90.0, 12), (90.0, 12)):
        yield row(
            f"sunlight of a day at {latitude:g}°, month {month}",
            lambda la=latitude, m=month: sunny_day(la, dt.date(2026, m, 21)),
        )
    yield row("together and one by one", lambda: one_by_one(0, 2e-3))
    yield row("together and one by one, positions shared", lambda: one_by_one(5.0, 0.1))
    yield row("at points", at_points)
    yield row("the Sun below all positions", low_sun)
    yield row("no lights", no_lights)
    for hours in ([1.0], [1, -1, 1], [0, 0, 0], [math.nan, 1, 1], "all"):
        yield row(f"hours {hours}", lambda h=hours: refused(lambda: plate().annual([EVEN] * 3, hours=h), "hours"))
