"""Geometry at its limits: slivers, doubles, things exactly on planes and edges, mirrors that meet."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, UNIFORM, box, box_polygons, cosine_rays, lambert_form_factor
from situations import SINGLE, Outcome, Situation, all_of, holds, near, refused, solved, told

import luzespecular as luz

LAMP = luz.Material(exitance=1000.0)
GREY = luz.Material(diffuse_reflectance=0.5)
EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
PLATE = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], float)
ROOM = {**{k: v for k, v in box_polygons((4, 4, 3)).items() if k != "ceiling"}}
ROOM["lid"] = np.array([[0, 4, 3], [4, 4, 3], [4, 2, 3], [0, 2, 3]], float)
AS_COARSE = 3e-3
"""What few receivers may be off by, where surfaces more or less change how they are shared."""

POINTS, NORMALS = np.array([[2, 2, 0], [0.5, 3, 0], [4, 2, 1.5]]), np.array([[0, 0, 1], [0, 0, 1], [-1, 0, 0]])


def half_open(**more) -> luz.Scene:
    scene = luz.Scene()
    for name, polygon in ROOM.items():
        scene.add(name, polygon, GREY)
    for name, (polygon, material) in more.items():
        scene.add(name, np.array(polygon, float), material)
    return scene


def lux(scene, bands: int = 40) -> np.ndarray:
    return solved(scene, UNIFORM, elements=150, bands=bands).at(POINTS, NORMALS)


def blemish(polygon, allowed: float = 1e-3, material=BLACK) -> Outcome:
    """A room with something in it that must not change it."""
    return near(lux(half_open(blemish=(polygon, material))), lux(half_open()), allowed)


def image(polygon, normal, offset):
    p, n = np.asarray(polygon, float), np.asarray(normal, float)
    return (p - 2 * (p @ n - offset)[:, None] * n)[::-1]


def by_lamps(lamps, point, normal) -> float:
    """Lux of luminous polygons that nothing hides, by Lambert's formula (with the part below the horizon cut off)."""
    from luzespecular import clipping

    total = 0.0
    for lamp in lamps:
        shown = clipping.clip((np.asarray(lamp, float) - point)[None], np.asarray(normal, float))
        total += 1000.0 * float(lambert_form_factor(shown, np.asarray(normal, float))[0])
    return total


def corner_of_mirrors(degrees: float, reflectance: float = 0.9) -> Outcome:
    """A lamp in the corner of two mirrors that divide the circle evenly: one image in each of its sectors but its own.

    In sectors beyond the first two the light has met both mirrors, by turns.
    """
    number = round(360 / degrees)
    angle = math.radians(degrees)
    normals = [np.array([0.0, 1, 0]), np.array([math.sin(angle), -math.cos(angle), 0])]
    far, tall = 400.0, 400.0
    along = [np.array([far, 0, 0]), far * np.array([math.cos(angle), math.sin(angle), 0])]
    up = np.array([0, 0, tall])
    low = np.array([0, 0, -tall / 2])
    mirrors = [
        np.array([low, low + up, low + along[0] + up, low + along[0]]),
        np.array([low, low + along[1], low + along[1] + up, low + up]),
    ]
    middle = np.array([math.cos(angle / 2), math.sin(angle / 2), 0.0])
    side = np.array([-middle[1], middle[0], 0.0])
    place = 1.2 * middle + np.array([0, 0, 1.0])
    lamp = np.array([place + a * 0.05 * middle + b * 0.05 * side for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1))])
    point, normal = 1.5 * middle + 0.1 * side, np.array([0.0, 0, 1])
    scene = luz.Scene()
    for name, polygon, inward in zip(("one", "two"), mirrors, normals, strict=True):
        turn = np.cross(polygon[1] - polygon[0], polygon[2] - polygon[0]) @ inward > 0
        scene.add(name, polygon if turn else polygon[::-1], luz.Material(specular_reflectance=reflectance))
    scene.add("lamp", lamp, LAMP)
    got = solved(scene, DARK, elements=20, patches=5, bands=8, specular_cutoff=1e-4).at([point], [normal])
    lamps, weights = [lamp], [1.0]
    # words of alternating mirrors: each is one image; half a turn is reached by both and counts once
    for first in (0, 1):
        shown = lamp
        for order in range(1, number // 2 + 1):
            if order == number // 2 and first == 1:
                break
            shown = image(shown, normals[(first + order + 1) % 2], 0.0)
            lamps.append(shown)
            weights.append(reflectance**order)
    expected = sum(w * by_lamps([polygon], point, normal) for w, polygon in zip(weights, lamps, strict=True))
    return near(got, [expected], 1e-4)


def almost_parallel_mirrors() -> Outcome:
    """Mirrors face to face at 0.01°: as parallel ones, but for what the tilt does."""

    def at(degrees: float) -> np.ndarray:
        scene = luz.Scene()
        mirror = luz.Material(specular_reflectance=0.8)
        lean = 3 * math.tan(math.radians(degrees))
        scene.add("west", [[0, 0, 0], [0, 3, 0], [0, 3, 3], [0, 0, 3]], mirror)
        scene.add("east", [[2, 0, 3], [2, 3, 3], [2 + lean, 3, 0], [2 + lean, 0, 0]], mirror)
        scene.add("lamp", [[0.6, 3, 2.5], [0.9, 3, 2.5], [0.9, 0, 2.5], [0.6, 0, 2.5]], LAMP)
        return solved(scene, DARK, elements=20, patches=5, bands=8).at([[1, 1.2, 0]], [[0, 0, 1]])

    return near(at(0.01), at(0.0), 2e-3)


def mirror_beside_its_own_plane() -> Outcome:
    """A mirror that sees itself by way of another: three walls of a well, against single rays."""
    mirror = luz.Material(specular_reflectance=0.5)
    scene = luz.Scene()
    for name in ("west", "east", "south"):
        scene.add(name, box_polygons((2, 2, 2))[name], mirror)
    scene.add("lamp", [[0.5, 1.5, 2], [1.5, 1.5, 2], [1.5, 0.5, 2], [0.5, 0.5, 2]], LAMP)
    point, normal = np.array([1.0, 1.0, 0.5]), np.array([0, 0, 1.0])
    got = solved(scene, DARK, elements=40, patches=5, bands=8, specular_cutoff=1e-5).at([point], [normal])
    total = 0.0
    rays = cosine_rays(normal, 200_000)
    place, weight = np.tile(point, (len(rays), 1)), np.ones(len(rays))
    alive = np.ones(len(rays), bool)
    for _ in range(24):
        with np.errstate(divide="ignore", invalid="ignore"):
            walls = np.stack(
                [(0 - place[:, 0]) / rays[:, 0], (2 - place[:, 0]) / rays[:, 0], (0 - place[:, 1]) / rays[:, 1]], axis=1
            )
            top = (2 - place[:, 2]) / rays[:, 2]
        walls = np.where((walls > 1e-9) & np.isfinite(walls), walls, np.inf)
        first = walls.argmin(axis=1)
        wall = walls[np.arange(len(rays)), first]
        over = place + top[:, None] * rays
        lit = alive & (top > 0) & (top <= wall) & (np.abs(over[:, 0] - 1) <= 0.5) & (np.abs(over[:, 1] - 1) <= 0.5)
        total += weight[lit].sum()
        hit = place + np.where(np.isfinite(wall), wall, 0.0)[:, None] * rays
        alive &= ~lit & np.isfinite(wall) & (hit[:, 2] <= 2) & (hit[:, 2] >= 0) & (hit[:, 1] <= 2)
        axis = np.where(first == 2, 1, 0)
        rays = rays.copy()
        rays[np.arange(len(rays)), axis] *= -1
        place, weight = hit, weight * 0.5
    return near(got, [1000.0 * total / 200_000], 5e-3)


def on_a_mirrors_edge() -> Outcome:
    """A receiver on the foot of a mirror: half of the picture, from no side NaN."""
    scene = luz.Scene()
    scene.add("floor", PLATE, BLACK)
    scene.add("mirror", [[4, 0, 3], [4, 4, 3], [4, 4, 0], [4, 0, 0]], luz.Material(specular_reflectance=0.9))
    scene.add("lamp", [[1, 3, 2], [3, 3, 2], [3, 1, 2], [1, 1, 2]], LAMP)
    result = solved(scene, DARK, elements=40, patches=5, bands=8)
    on, inside = result.at([[4, 2, 0], [4 - 1e-7, 2, 0]], [[0, 0, 1]] * 2)
    direct = by_lamps([[[1, 3, 2], [3, 3, 2], [3, 1, 2], [1, 1, 2]]], np.array([4.0, 2, 0]), [0, 0, 1])
    low, high = direct, 1.9 * direct
    both = all_of(near(inside, high, 1e-5), near(on, low if abs(on - low) < abs(on - high) else high, 1e-5))
    return both


def sun_on_edges(direction) -> Outcome:
    """Sunlight along planes and through edges: what arrives on the plates is what meets them."""
    unit = np.asarray(direction, float) / np.linalg.norm(direction)
    scene = luz.Scene()
    scene.add("plate", PLATE, BLACK)
    scene.add("wall", [[10, 10, 0], [10, 10, 3], [14, 10, 3], [14, 10, 0]], BLACK)  # looks north
    scene.add("fin", [[1, 20, 0], [1, 24, 0], [1, 24, 2], [1, 20, 2]], BLACK)  # looks east
    result = solved(scene, luz.Daylight(sun=luz.Sun(direction=direction, normal_illuminance=1e5)), bands=4)
    up = unit[2] > 0
    expected = [1e5 * max(0.0, float(unit @ n)) * up for n in ([0, 0, 1], [0, 1, 0], [1, 0, 0])]
    return near([result.mean(n) for n in ("plate", "wall", "fin")], expected, 1e-9, 1e-6)


def grain_beside_a_plain() -> Outcome:
    """A face of a micrometre on the ground of 100 m: both see the same sky."""
    scene = luz.Scene()
    scene.add("plain", 25 * PLATE, GREY)
    scene.add("grain", np.array([[50, 50, 1], [50 + 1e-6, 50, 1], [50, 50 + 1e-6, 1]]), BLACK)
    result = solved(scene, EVEN)
    return all_of(near(result.mean("grain"), 1000 * math.pi, SINGLE), told(scene, "tiny faces", "seen from behind"))


def planes_through_a_point() -> Outcome:
    """A receiver nearer and nearer to a corner; in it the walls do not block what its normal looks to."""
    result = solved(half_open(), UNIFORM, elements=150, bands=40)
    close = [1e-3, 1e-5, 1e-6, 1e-7, 1e-8]
    lux = result.at([[d, d, 0] for d in (*close, 0.0)], [[0, 0, 1]] * 6)
    return all_of(
        near(lux[1:5], np.full(4, lux[0]), 1e-3), holds(lux[0] < lux[5] < 1000 * math.pi, "more", f"{lux[5]}")
    )


def along_a_parcels_edge() -> Outcome:
    """Walls exactly along the globe's bands and meridians, seen from the axis: half the sky each."""
    scene = luz.Scene()
    scene.add("wall", [[0, -1000, 0], [0, 1000, 0], [0, 1000, 1000], [0, -1000, 1000]], BLACK)
    result = solved(scene, EVEN, bands=40, elements=20)
    got = result.at([[0, 0, 0], [1e-3, 0, 0]], [[0, 0, 1], [0, 0, 1]])
    on_plane = 500 * math.pi if abs(got[0] - 500 * math.pi) < 500 else 1000 * math.pi  # either side may be meant
    return all_of(near(got[1], 500 * math.pi, 2e-3), near(got[0], on_plane, 2e-3))


def doubled(material) -> Outcome:
    floor = ROOM["floor"]
    scene = half_open(again=(floor, material))
    # of 100 bands, for faces look by 40 of them then
    same = near(lux(scene, 100), lux(half_open(), 100), AS_COARSE) if material is GREY else told(scene, "overlap")
    return all_of(told(scene, "overlap"), same)


def twice(polygon, material, light, two_sided=False) -> Outcome:
    """A thing given twice in a room counts once, whatever it does with light, and its doubles show what it gets."""

    def result(copies: int) -> luz.Result:
        scene = half_open()
        for copy in range(copies):
            scene.add(f"copy {copy}", np.array(polygon, float), material, two_sided=two_sided)
        return solved(scene, light, elements=150, bands=40)

    once, both = result(1), result(2)
    return all_of(
        near(both.at(POINTS, NORMALS), once.at(POINTS, NORMALS), AS_COARSE),
        near([both.mean(f"copy {copy}") for copy in (0, 1)], np.full(2, once.mean("copy 0")), AS_COARSE),
        near(both.balance.entering, once.balance.entering, AS_COARSE),
    )


def polygon_refused(points, *words) -> Outcome:
    return refused(lambda: luz.Scene().add("bad", points, BLACK), "'bad'", *words)


def t_junctions() -> Outcome:
    """A closed box whose sides meet at T-junctions only: rows sum to one, lux are even."""
    scene = luz.Scene()
    glow = luz.Material(diffuse_reflectance=0.5, exitance=10.0)
    for name, polygon in box_polygons((2, 3, 2.5)).items():
        a, b, c, d = polygon
        for k, (low, high) in enumerate(
            itertools.pairwise((0.0, 0.37, 1.0) if name in ("floor", "west") else (0.0, 0.61, 1.0))
        ):
            p = [a + low * (b - a), a + high * (b - a), d + high * (c - d), d + low * (c - d)]
            scene.add(f"{name} {k}", p, glow)
    result = solved(scene, DARK, bands=24, elements=200)
    return near(result.illuminance, np.full(len(result.areas), 20.0), 1e-3)


def box_of_slivers() -> Outcome:
    """A closed box whose floor is cut into slivers of aspect 1e6 at one side."""
    scene = box(luz.Material(diffuse_reflectance=0.5, exitance=10.0), (1, 1, 1), without=("floor",))
    edges = [0.0, 1e-6, 3e-6, 1e-3, 0.5, 1.0]
    vertices = [[x, y, 0] for x in edges for y in (0.0, 1.0)]
    faces = [[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1] for k in range(len(edges) - 1)]
    scene.add("floor", vertices, luz.Material(diffuse_reflectance=0.5, exitance=10.0), faces=faces)
    result = solved(scene, DARK, bands=24, elements=200)
    return near(result.illuminance, np.full(len(result.areas), 20.0), 1e-3)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("degenerate", name, run, long)

    yield row(
        "a sliver of aspect 1e6 in a room", lambda: blemish([[1, 1, 1], [2, 1, 1], [2, 1 + 1e-6, 1], [1, 1 + 1e-6, 1]])
    )
    yield row("a triangle of aspect 1e8", lambda: blemish([[1, 1, 1], [2, 1, 1], [1.5, 1 + 1e-8, 1]]))
    yield row("a face of 1e-6 m in a room", lambda: blemish([[1, 1, 1], [1 + 1e-6, 1, 1], [1, 1 + 1e-6, 1]]))
    yield row("a face in a wall's plane, outside", lambda: blemish([[0, 5, 0], [0, 6, 0], [0, 6, 1], [0, 5, 1]]))
    yield row("a floor of slivers", box_of_slivers)
    yield row("a face of 1e-6 m above a plain of 100 m", grain_beside_a_plain)
    yield row("a floor twice, of one material", lambda: doubled(GREY))
    yield row("a floor twice, of two materials", lambda: doubled(BLACK))
    sunny = luz.Daylight(sky=luz.UniformSky(1000.0), sun=luz.Sun(direction=(0.3, 0.2, 1), normal_illuminance=1e5))
    table, upright = [[1, 1, 1], [3, 1, 1], [3, 3, 1], [1, 3, 1]], [[3.9, 1, 2], [3.9, 3, 2], [3.9, 3, 1], [3.9, 1, 1]]
    for name, polygon, material, both in (
        ("table", table, GREY, True),
        ("table of one side", table, GREY, False),
        ("lamp", table[::-1], LAMP, False),
        ("mirror", upright, luz.Material(specular_reflectance=0.8), False),
        ("pane", [[0, 2, 3], [4, 2, 3], [4, 0, 3], [0, 0, 3]], luz.Material(regular_transmittance=0.8), False),
    ):
        yield row(f"a {name} twice", lambda p=polygon, m=material, b=both: twice(p, m, sunny, b))
    yield row("T-junctions all around", t_junctions)
    yield row("a polygon without area", lambda: polygon_refused([[0, 0, 0], [1, 1, 1], [2, 2, 2]], "no area"))
    yield row("a polygon that is a point", lambda: polygon_refused([[1, 1, 1]] * 4, "no area"))
    yield row("a bow-tie", lambda: polygon_refused([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], "cross"))
    yield row(
        "a pentagram",
        lambda: polygon_refused(
            [[math.cos(4 * math.pi * k / 5), math.sin(4 * math.pi * k / 5), 0] for k in range(5)], "cross"
        ),
    )
    yield row(
        "a polygon 1 mm off its plane",
        lambda: polygon_refused([[0, 0, 0], [1, 0, 0], [1, 1, 1e-3], [0, 1, 0]], "not flat"),
    )
    yield row("a receiver where three planes meet", planes_through_a_point)
    yield row("a receiver on a mirror's foot", on_a_mirrors_edge)
    yield row("walls along the globe's meridians", along_a_parcels_edge)
    for name, direction in {
        "the zenith": (0, 0, 1),
        "along the wall": (1, 0, 0.5),
        "along the fin": (0, 1, 0.5),
        "along both": (0, 0, 3),
        "nearly along the fin": (1e-12, 1, 0.5),
        "1e-6 above the horizon": (0, 1, 1e-6),
        "corner to corner": (1, 1, 1),
    }.items():
        yield row(f"the Sun, {name}", lambda direction=direction: sun_on_edges(direction))
    for degrees in (90, 60, 45):
        yield row(f"mirrors that meet at {degrees}°", lambda degrees=degrees: corner_of_mirrors(degrees))
    yield row("mirrors face to face at 0.01°", almost_parallel_mirrors)
    yield row("a mirror that sees itself by others", mirror_beside_its_own_plane)
