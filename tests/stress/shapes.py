"""Lamps and openings with known form factors, drawn in every way: many corners, meshes, balls, stray vertices."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, box_polygons
from equilibrium import ball
from situations import GLOBE, SINGLE, Outcome, Situation, all_of, holds, near, solved

import luzespecular as luz

GREY = luz.Material(diffuse_reflectance=0.5)
EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
LAMP = luz.Material(exitance=1000.0)


def ring(radius: float, count: int, z: float, down: bool = True) -> np.ndarray:
    turn = 2 * math.pi * np.arange(count) / count * (-1 if down else 1)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(count, z)], axis=1)


def under_disc(count: int, how: str) -> Outcome:
    """A round lamp of many corners straight above: as many equal triangles, each by Lambert."""
    loop = ring(1.0, count, 2.0)
    apothem, slant = math.cos(math.pi / count), math.hypot(math.cos(math.pi / count), 2.0)
    factor = count / math.pi * apothem / slant * math.atan(math.sin(math.pi / count) / slant)
    scene = luz.Scene()
    scene.add("floor", [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]], BLACK)
    if how == "polygon":
        scene.add("lamp", loop, LAMP)
    elif how == "face":
        scene.add("lamp", loop, LAMP, faces=[list(range(count))])
    else:
        vertices = np.concatenate([loop, [[0, 0, 2.0]]])
        scene.add("lamp", vertices, LAMP, faces=[[count, k, (k + 1) % count] for k in range(count)])
    got = solved(scene, DARK, bands=8, elements=50, patches=10).at([[0, 0, 0]], [[0, 0, 1]])
    return near(got, [1000 * factor], 1e-6)


def beside_disc(count: int, star: bool = False) -> Outcome:
    """The sky past a round or star-shaped roof of many corners: all but what the roof's triangles hide, by Lambert."""
    radius = np.where(np.arange(count) % 2, 0.6, 1.0) if star else np.ones(count)
    loop = ring(1.0, count, 1.0) * np.stack([radius, radius, np.ones(count)], axis=1)
    scene = luz.Scene()
    scene.add("floor", [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]], BLACK)
    scene.add("roof", loop, BLACK)
    way = loop / np.linalg.norm(loop, axis=1, keepdims=True)
    poles = np.cross(np.roll(way, -1, axis=0), way)
    length = np.linalg.norm(poles, axis=1)
    hidden = abs((np.arcsin(length) * poles[:, 2] / length).sum()) / (2 * math.pi)
    got = solved(scene, EVEN, bands=24, elements=50, patches=10).at([[0, 0, 0]], [[0, 0, 1]])
    return near(got, [1000 * math.pi * (1 - hidden)], GLOBE)


def under_a_ball() -> Outcome:
    """A luminous ball of 80 facets: flux M·A over 4 π d² far away, in the mean over directions."""
    scene = ball(LAMP, False)
    mesh = scene.surfaces["ball"]
    area = float(
        0.5
        * np.linalg.norm(
            np.cross(mesh.pieces[:, 1] - mesh.pieces[:, 0], mesh.pieces[:, 2] - mesh.pieces[:, 0]), axis=1
        ).sum()
    )
    rng = np.random.default_rng(2)
    ways = rng.normal(size=(40, 3))
    ways = np.concatenate([ways, -ways]) / np.linalg.norm(np.concatenate([ways, -ways]), axis=1)[:, None]
    got = solved(scene, DARK, bands=8, elements=80, patches=80).at(50 * ways, -ways)
    return near(got.mean(), 1000 * area / (4 * math.pi * 2500), 2e-3)


def integrating_ball(reflectance: float) -> Outcome:
    """A closed ball that shines: lux 1000 / (1 − ρ) everywhere."""
    scene = ball(luz.Material(diffuse_reflectance=reflectance, exitance=1000.0), True)
    result = solved(scene, DARK, bands=24, elements=80, patches=80)
    return near(result.illuminance, np.full(len(result.areas), 1000 / (1 - reflectance)), 1e-3)


def far_speck(distance: float) -> Outcome:
    """A speck far away in a room's scene: the room is as it was, or it is told that digits are lost."""

    def lux(speck: bool) -> np.ndarray:
        scene = luz.Scene()
        for name, polygon in box_polygons((3, 3, 2.5)).items():
            if name != "north":
                scene.add(name, polygon, GREY)
        if speck:
            scene.add("speck", np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]) - np.array([0, distance, 0]), BLACK)
        result = solved(scene, EVEN, bands=30, elements=200, patches=100)
        return np.append(result.at([[1.5, 1.2, 0]], [[0, 0, 1]]), [result.mean(n) for n in ("floor", "west")])

    return near(lux(True), lux(False), 3e-3)


def stray_vertex() -> Outcome:
    """A corner of the mesh that no face uses, far away: nothing changes."""

    def lux(stray: bool) -> np.ndarray:
        scene = luz.Scene()
        vertices, faces = [], []
        for name, polygon in box_polygons((3, 3, 2.5)).items():
            if name != "north":
                faces.append([len(vertices) + k for k in range(4)])
                vertices += polygon.tolist()
        scene.add("room", [*vertices, [1e9, 1e9, 1e9]] if stray else vertices, GREY, faces=faces)
        return solved(scene, EVEN, bands=24, elements=200, patches=100).illuminance

    return near(lux(True), lux(False), 0.0)


def kinds_of_arrays() -> Outcome:
    """Coordinates as lists, whole numbers, single precision, read-only, in another order in memory: the same lux."""
    walls = {k: v for k, v in box_polygons((3, 4, 2)).items() if k != "north"}

    def lux(form) -> np.ndarray:
        scene = luz.Scene()
        for name, polygon in walls.items():
            scene.add(name, form(polygon), GREY)
        return solved(scene, EVEN, bands=12, elements=100, patches=60).illuminance

    def frozen(polygon):
        polygon = polygon.copy()
        polygon.setflags(write=False)
        return polygon

    base = lux(np.asarray)
    forms = (np.ndarray.tolist, lambda p: p.astype(np.int16), lambda p: p.astype(np.float32), np.asfortranarray, frozen)
    return all_of(*(near(lux(form), base, 0.0) for form in forms))


def given_is_kept() -> Outcome:
    """What the user holds is not changed, and changing it later changes nothing."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    before = corners.copy()
    scene = luz.Scene()
    scene.add("plate", corners, GREY)
    first = solved(scene, EVEN, bands=8).illuminance
    same = bool((corners == before).all())
    corners += 5
    second = solved(scene, EVEN, bands=8)
    return all_of(
        holds(same, "untouched", "changed"), near(second.illuminance, first, 0.0), near(second.centroids.max(), 1, 0, 1)
    )


def extreme_size(size: float) -> Outcome:
    """A room of this size: as one of 3 m, or refused in words."""

    def lux(scale: float) -> np.ndarray:
        scene = luz.Scene()
        for name, polygon in box_polygons((3, 3, 2.5)).items():
            if name != "north":
                scene.add(name, scale * polygon, luz.Material(specular_reflectance=0.5) if name == "west" else GREY)
        light = luz.Daylight(sky=luz.UniformSky(1000.0), sun=luz.Sun(altitude=30, azimuth=10, normal_illuminance=5e4))
        result = solved(scene, light, bands=16, elements=100, patches=60)
        return np.append(
            result.at(scale * np.array([[1.5, 1.2, 0]]), [[0, 0, 1]]), [result.mean(n) for n in ("floor", "south")]
        )

    return near(lux(size / 3), lux(1.0), SINGLE)


def long_and_thin(ratio: float) -> Outcome:
    """Between two endless strips face to face: F = √(1 + (h/w)²) − h/w from strip to strip (Hottel's strings)."""
    scene = luz.Scene()
    half = ratio / 2
    scene.add("floor", [[-0.5, -half, 0], [0.5, -half, 0], [0.5, half, 0], [-0.5, half, 0]], BLACK)
    scene.add("lamp", [[-0.5, half, 0.7], [0.5, half, 0.7], [0.5, -half, 0.7], [-0.5, -half, 0.7]], LAMP)
    result = solved(scene, DARK, bands=8, elements=50)
    x = (np.arange(200) + 0.5) / 200 - 0.5
    got = result.at(np.stack([x, 0 * x, 0 * x], axis=1), np.tile([0.0, 0, 1], (200, 1))).mean()
    return near(got, 1000 * (math.sqrt(1 + 0.49) - 0.7), 1e-4)


def slats_hide(tilt: float) -> Outcome:
    """Black slats that overlap just so: up to the cut-off angle nothing comes through, beyond it the rest."""
    scene = luz.Scene()
    scene.add("floor", [[-0.05, -0.05, 0], [0.05, -0.05, 0], [0.05, 0.05, 0], [-0.05, 0.05, 0]], BLACK)
    for k in range(-9, 10):
        x = 0.1 * k
        scene.add(f"slat {k}", [[x, -1, 0.3], [x, 1, 0.3], [x, 1, 0.4], [x, -1, 0.4]], BLACK, two_sided=True)
    # the Sun at 45° across upright slats as high as they stand apart: all is hidden; at 60° of height most passes
    angle = math.radians(tilt)
    sun = luz.Sun(direction=(math.cos(angle), 0, math.sin(angle)), normal_illuminance=1e5)
    result = solved(scene, luz.Daylight(sun=sun), bands=8, elements=50, max_area=1e-4)
    share = max(0.0, 1 - 1 / math.tan(angle)) if tilt < 90 else 1.0
    faces = result.faces_of("floor")
    mean = float(result.illuminance[faces] @ result.areas[faces] / result.areas[faces].sum())
    return near(mean, 1e5 * math.sin(angle) * share, 1e-6, 1e-6)


def sky_over_a_roof(degrees: float) -> Outcome:
    """Under an even sky a plane tilted by β sees (1 + cos β) / 2 of it."""
    angle = math.radians(degrees)
    c, s = math.cos(angle), math.sin(angle)
    scene = luz.Scene()
    scene.add("roof", [[0, 0, 0], [c, 0, s], [c, 1, s], [0, 1, 0]], BLACK)
    result = solved(scene, EVEN, bands=60)
    return near(result.mean("roof"), 1000 * math.pi * (1 + c) / 2, 1e-3)


def skylight() -> Outcome:
    """A round opening far smaller than a parcel, straight above, in an endless ceiling: π L r²/(r² + h²)."""
    count, radius = 48, 0.08
    hole = ring(radius, count, 2.0, down=False)
    outer = 3000.0 * np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    outer = np.c_[outer, np.full(4, 2.0)]
    loop = np.concatenate([outer, outer[:1], hole[[6]], hole[np.arange(6, 6 + count) % count][1:], hole[[6]]])
    scene = luz.Scene()
    scene.add("ceiling", loop, BLACK)
    scene.add("floor", [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], BLACK)
    got = solved(scene, EVEN, elements=50).at([[0, 0, 0]], [[0, 0, 1]])
    squared = radius**2 * count / math.pi * math.sin(math.pi / count) * math.cos(math.pi / count)
    return near(got, [1000 * math.pi * squared / (squared + 4)], GLOBE)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False, family="degenerate"):
        return Situation(family, f"shapes: {name}", run, long)

    for count in (5, 64, 1000):
        yield row(f"past a roof of {count} corners", lambda n=count: beside_disc(n), count > 100)
        yield row(f"a lamp of {count} corners", lambda n=count: under_disc(n, "polygon"), count > 100)
    yield row("past a roof of 100 points", lambda: beside_disc(200, True))
    yield row("a lamp of one face of 64", lambda: under_disc(64, "face"))
    yield row("a lamp of a fan of 64", lambda: under_disc(64, "fan"))
    yield row("far from a luminous ball", under_a_ball)
    for reflectance in (0.0, 0.9, 0.999):
        yield row(f"in a ball of ρ = {reflectance}", lambda r=reflectance: integrating_ball(r), family="energy")
    for distance in (1e3, 1e5, 1e7):
        yield row(f"a speck {distance:g} m off", lambda d=distance: far_speck(d), family="scale")
    yield row("a stray vertex", stray_vertex)
    yield row("coordinates of all kinds", kinds_of_arrays, family="invariance")
    yield row("what is given is kept", given_is_kept, family="invariance")
    for size in (1e-9, 1e-5, 1e6, 1e9, 1e12):
        yield row(f"a room of {size:g} m", lambda s=size: extreme_size(s), family="scale")
    for ratio in (1e2, 1e4, 1e6):
        yield row(f"strips {ratio:g} times as long as wide", lambda r=ratio: long_and_thin(r))
    for tilt in (30, 44.999, 45.001, 60, 90):
        yield row(f"upright slats, the Sun at {tilt:g}°", lambda t=tilt: slats_hide(t), tilt != 60)
    for degrees in (0, 30, 90, 135, 180):
        yield row(f"a plane tilted by {degrees}°", lambda d=degrees: sky_over_a_roof(d), family="light")
    yield row("a round skylight of 8 cm", skylight)
