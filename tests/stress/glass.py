"""Panes: one after the other, from either side, by Fresnel's equations, and mirrors besides."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, box_polygons
from degenerate import by_lamps
from situations import GLOBE, SINGLE, Outcome, Situation, all_of, holds, near, refused, solved

import luzespecular as luz

EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
HIGH = luz.Daylight(sun=luz.Sun(direction=(0.4, 0.3, 1), normal_illuminance=1e5))
FLOOR = np.array([[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]])
GLASS = luz.Material(refractive_index=1.52, regular_transmittance=0.88)


def plain(share: float) -> luz.Material:
    return luz.Material(regular_transmittance=share)


def sheet(half: float, z: float) -> np.ndarray:
    """A level square that looks up."""
    return half * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float) + [0, 0, z]


def fresnel(cosine: float, index: float, normal_transmittance: float) -> tuple[float, float]:
    """Reflectance and transmittance of a pane, by summing the rays between its faces one by one."""
    r0 = ((index - 1) / (index + 1)) ** 2
    low, high = 0.0, 1.0
    for _ in range(200):  # the inner transmittance that gives the pane's at normal incidence
        a = 0.5 * (low + high)
        through = sum((1 - r0) ** 2 * a * (r0 * a) ** (2 * k) for k in range(60))
        low, high = (a, high) if through < normal_transmittance else (low, a)
    inner_cosine = math.sqrt(1 - (1 - cosine**2) / index**2)
    once = a ** (1 / inner_cosine)
    reflected = transmitted = 0.0
    for r in (
        ((cosine - index * inner_cosine) / (cosine + index * inner_cosine)) ** 2,
        ((inner_cosine - index * cosine) / (inner_cosine + index * cosine)) ** 2,
    ):
        transmitted += 0.5 * sum((1 - r) ** 2 * once * (r * once) ** (2 * k) for k in range(400))
        reflected += 0.5 * (r + sum((1 - r) ** 2 * r * once**2 * (r * once) ** (2 * k) for k in range(400)))
    return reflected, transmitted


def under(*panes, half: float = 50.0, step: float = 0.01) -> luz.Scene:
    """A small black floor close under wide panes."""
    scene = luz.Scene()
    scene.add("floor", FLOOR, BLACK)
    for k, pane in enumerate(panes):
        scene.add(f"pane {k}", sheet(half, step * (k + 1)), pane)
    return scene


def through(panes, light, expected: float, allowed: float, absolute: float = 0.0, **options) -> Outcome:
    result = solved(under(*panes), light, **{"bands": 40, **options})
    return near(result.illuminance[result.faces_of("floor")], expected, allowed, absolute)


def fresnel_in_sun(degrees: float) -> Outcome:
    """Sunlight through a sheet of glass."""
    angle = math.radians(degrees)
    sun = luz.Sun(direction=(math.sin(angle), 0, math.cos(angle)), normal_illuminance=1e5)
    share = fresnel(math.cos(angle), 1.52, 0.88)[1]
    return through([GLASS], luz.Daylight(sun=sun), 1e5 * math.cos(angle) * share, 1e-6, bands=8)


def fresnel_under_the_sky() -> Outcome:
    """Of an even sky: the mean over all angles, by their cosine."""
    cosines = (np.arange(400) + 0.5) / 400
    mean = float(np.mean([2 * c * fresnel(c, 1.52, 0.88)[1] for c in cosines]))
    return through([GLASS], EVEN, 1000 * math.pi * mean, 3e-3)


def image_in_glass(degrees: float) -> Outcome:
    """A small lamp and its image in a pane that stands behind a black floor."""
    angle, far = math.radians(degrees), 4.0
    x, z = far * math.sin(angle), far * math.cos(angle)
    # the way from the point by the pane (plane y = 0) to the lamp: the image stands as far behind as the lamp before
    place = np.array([0.0, 0.5 * far * math.cos(angle), 0.5 + x])
    point = np.array([0.0, 0.5 * far * math.cos(angle), 0.5])
    del z
    size = 0.02
    lamp = place + size * np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])  # looks to -y: at the pane
    normal = np.array([0.0, -1.0, 0.0])
    scene = luz.Scene()
    scene.add("pane", 40 * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], float), GLASS)
    scene.add("lamp", lamp, luz.Material(exitance=1e6))
    got = solved(scene, DARK, bands=8, elements=20, patches=5, specular_cutoff=1e-5).at([point], [normal])
    image = (lamp * [1, -1, 1])[::-1]
    share = fresnel(math.cos(angle), 1.52, 0.88)[0]
    return near(got, [1e3 * share * by_lamps([image], point, normal)], 1e-4)


def lamp_behind_glass() -> Outcome:
    """A small lamp seen at 60° through two panes."""
    point, normal = np.zeros(3), np.array([0.0, 0, 1])
    lamp = np.array([2 * math.sqrt(3), 0, 2.0]) + 0.02 * np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]])
    scene = under(GLASS, plain(0.7))
    scene.add("lamp", lamp, luz.Material(exitance=1e6))
    got = solved(scene, DARK, bands=8, elements=20, patches=5, specular_cutoff=1e-5).at([point], [normal])
    share = fresnel(0.5, 1.52, 0.88)[1] * 0.7
    # between the two the light goes to and fro: the plain one reflects nothing
    return near(got, [1e3 * share * by_lamps([lamp], point, normal)], 1e-4)


def turned(light) -> Outcome:
    """A pane transmits both ways: it may look up or down, and have one side or two."""

    def lux(flip: bool, both: bool) -> np.ndarray:
        scene = luz.Scene()
        for name, polygon in box_polygons((3, 3, 2)).items():
            if name != "ceiling":
                scene.add(name, polygon, luz.Material(diffuse_reflectance=0.5))
        pane = np.array([[0, 0, 2], [3, 0, 2], [3, 3, 2], [0, 3, 2]], float)
        scene.add("pane", pane[::-1] if flip else pane, GLASS, two_sided=both)
        result = solved(scene, light, bands=24, elements=150)
        return np.array([result.mean(name) for name in ("floor", "west", "south")])

    base = lux(False, False)
    return all_of(*(near(lux(*how), base, 5e-4) for how in ((True, False), (False, True), (True, True))))


def in_a_shaft(count: int, share: float) -> Outcome:
    """Panes in a black shaft: what the sky would give times the share of each; what is below the cut-off is booked."""

    def result(panes: int) -> luz.Result:
        scene = luz.Scene()
        for name, polygon in box_polygons((1, 1, 2)).items():
            if name != "ceiling":
                scene.add(name, polygon, BLACK)
        for k in range(panes):
            z = 0.2 + 1.7 * k / count
            scene.add(f"pane {k}", [[0, 0, z], [1, 0, z], [1, 1, z], [0, 1, z]], plain(share))
        return solved(scene, EVEN, bands=24, elements=60)

    free, stacked = result(0).mean("floor"), result(count)
    booked = stacked.balance.truncated
    return all_of(
        near(stacked.mean("floor"), free * share**count, 1e-3, 1e-3 * free),
        holds((booked > 0) == (share**count < 1e-3) and booked <= 4, "booked where cut off", f"{booked:.4g} lm"),
    )


def at_points(count: int) -> Outcome:
    """Single points below panes in a shaft get what they would without, times the share of each."""

    def lux(panes: int) -> np.ndarray:
        scene = luz.Scene()
        for name, polygon in box_polygons((1, 1, 2)).items():
            if name != "ceiling":
                scene.add(name, polygon, BLACK)
        for k in range(panes):
            scene.add(f"pane {k}", box_polygons((1, 1, 0.2 + 1.7 * k / panes))["ceiling"], plain(0.9))
        return solved(scene, EVEN, bands=24, elements=60).at([[0.5, 0.5, 0], [0.3, 0.7, 0]], [[0, 0, 1]] * 2)

    return near(lux(count), lux(0) * 0.9**count, 5e-3)


def frosted() -> Outcome:
    """A sheet that reflects diffusely and lets light through: the floor below a third of the sky's."""
    both = luz.Material(diffuse_reflectance=0.5, regular_transmittance=0.3)
    return through([both], EVEN, 300 * math.pi, 1e-3)


def stacked(panes: int) -> Outcome:
    """Sheets of glass one above the other: all that they throw to and fro arrives below."""
    glass = luz.Material(regular_transmittance=0.85, refractive_index=1.52)
    cosine = np.sqrt((np.arange(20_000) + 0.5) / 20_000)
    mirrored, through_one = glass.specular_at(cosine), glass.transmittance_at(cosine)
    back, on = np.zeros_like(cosine), np.ones_like(cosine)
    for _ in range(panes):
        gap = 1 - back * mirrored
        on, back = on * through_one / gap, mirrored + through_one**2 * back / gap
    return through([glass] * panes, EVEN, 1000 * math.pi * on.mean(), GLOBE)


def tinted_mirror() -> Outcome:
    """A sheet that mirrors half and lets through a third, above a mirror: the series between both."""
    scene = luz.Scene()
    half = luz.Material(specular_reflectance=0.5, regular_transmittance=0.3)
    scene.add("sheet", sheet(50, 0.01)[::-1], half)  # its mirror looks down
    scene.add("mirror", sheet(50, 0.0), luz.Material(specular_reflectance=0.8))
    result = solved(scene, HIGH, bands=8, elements=20, specular_cutoff=1e-6)
    # between the sheets sunlight comes down with 0.3, 0.3·0.8·0.5, …: the mirror gets all orders
    level = 1e5 / math.sqrt(1.25)
    point = result.at([[5.0, 5.0, 0.0]], [[0, 0, 1]])
    return near(point, [level * 0.3 / (1 - 0.4)], 1e-4)


def window_of_panes() -> Outcome:
    """A window of twelve panes is one pane."""

    def lux(columns: int, rows: int) -> np.ndarray:
        scene = luz.Scene()
        for name, polygon in box_polygons((3, 3, 2.4)).items():
            if name != "north":
                scene.add(name, polygon, luz.Material(diffuse_reflectance=0.5))
        for i in range(columns):
            for k in range(rows):
                x, z = 3.0 * np.array([i, i + 1]) / columns, 2.4 * np.array([k, k + 1]) / rows
                corners = [[x[1], 3, z[0]], [x[1], 3, z[1]], [x[0], 3, z[1]], [x[0], 3, z[0]]]
                scene.add(f"pane {i} {k}", np.array(corners), GLASS)
        light = luz.Daylight(
            sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=10, horizontal_illuminance=1e4),
            sun=luz.Sun(altitude=40, azimuth=10, normal_illuminance=8e4),
        )
        result = solved(scene, light, bands=24, elements=300, patches=150)
        return np.append(result.at([[1.5, 1.5, 0.8]], [[0, 0, 1]]), [result.mean(n) for n in ("floor", "west")])

    return near(lux(4, 3), lux(1, 1), 2e-3)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("light", f"glass: {name}", run, long)

    level = 1e5 / math.sqrt(1.25)
    yield row("one pane under the sky", lambda: through([plain(0.8)], EVEN, 800 * math.pi, 1e-3))
    yield row("two panes under the sky", lambda: through([plain(0.8), plain(0.7)], EVEN, 560 * math.pi, 1e-3))
    for count in (1, 2, 5):
        yield row(
            f"{count} of 0.9 in the Sun",
            lambda n=count: through([plain(0.9)] * n, HIGH, level * 0.9**n, 1e-6, bands=8),
        )
    yield row("a pane of 1", lambda: through([plain(1.0)], EVEN, 1000 * math.pi, SINGLE))
    yield row("a pane of 0", lambda: through([luz.Material()], EVEN, 0.0, 0, 1e-3))
    for degrees in (0, 45, 75, 89):
        yield row(f"by Fresnel at {degrees}°", lambda d=degrees: fresnel_in_sun(d))
    yield row("by Fresnel under the sky", fresnel_under_the_sky)
    for degrees in (20, 60, 80):
        yield row(f"a lamp's image at {degrees}°", lambda d=degrees: image_in_glass(d))
    yield row("a lamp behind two panes", lamp_behind_glass)
    yield row("turned, under the sky", lambda: turned(EVEN))
    yield row("turned, in the Sun", lambda: turned(HIGH))
    for count, share in ((3, 0.85), (5, 0.85), (10, 0.9), (3, 0.05)):
        yield row(f"{count} panes of {share:g} in a shaft", lambda n=count, s=share: in_a_shaft(n, s))
    for count in (2, 6):
        yield row(f"points below {count} panes in a shaft", lambda n=count: at_points(n))
    yield row("a sheet that scatters and transmits", frosted)
    yield row("a sheet that mirrors and transmits", tinted_mirror)
    yield row("a window of twelve panes", window_of_panes)
    yield row("three sheets that mirror as well", lambda: stacked(3))
    yield row("ten sheets that mirror as well", lambda: stacked(10), True)
    yield row("a share above 1", lambda: refused(lambda: plain(1.01), "regular_transmittance", "between 0 and 1"))
    yield row(
        "clearer than glass can be",
        lambda: refused(lambda: luz.Material(refractive_index=1.52, regular_transmittance=0.95), "more than"),
    )
