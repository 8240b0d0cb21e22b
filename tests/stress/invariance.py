"""The light-shelf room scaled, moved, turned, mirrored, renamed, in another order, split otherwise: the same lux.

Tolerances: coordinates are rounded to eps · |shift| where a scene is moved, over the smallest feature (5 cm of shelf);
the bulk is float32. Parcels stand otherwise to a room that is turned, so turns differ by the globe's error.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from functools import cache

import numpy as np
from situations import GLOBE, SINGLE, Outcome, Situation, near, solved

import luzespecular as luz

POLYGONS = {
    "floor": [[0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0]],
    "ceiling": [[0, 3, 3], [3, 3, 3], [3, 0, 3], [0, 0, 3]],
    "west": [[0, 0, 0], [0, 3, 0], [0, 3, 3], [0, 0, 3]],
    "east": [[3, 0, 3], [3, 3, 3], [3, 3, 0], [3, 0, 0]],
    "south": [[0, 0, 0], [0, 0, 3], [3, 0, 3], [3, 0, 0]],
    "sill": [[3, 3, 0], [3, 3, 1], [0, 3, 1], [0, 3, 0]],
    "lintel": [[3, 3, 2.5], [3, 3, 3], [0, 3, 3], [0, 3, 2.5]],
    "shelf bottom": [[0, 3, 1.725], [3, 3, 1.725], [3, 2.25, 1.725], [0, 2.25, 1.725]],
    "shelf top": [[0, 2.25, 1.775], [3, 2.25, 1.775], [3, 3, 1.775], [0, 3, 1.775]],
}
REFLECTANCE = {"floor": 0.4, "ceiling": 0.6, "shelf bottom": 0.8}
POINTS = np.array([[1.5, 0.7, 0], [0.4, 2.2, 0], [0, 1.5, 1.2], [3, 2.6, 0.4], [1, 1, 1.0]])
NORMALS = np.array([[0, 0, 1], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 0.6, 0.8]])
FEATURE = 0.05
EPS = float(np.finfo(float).eps)
FLIP = np.array([-1.0, 1.0, 1.0])


def material(name: str) -> luz.Material:
    if name == "shelf top":
        return luz.Material(specular_reflectance=0.9)
    return luz.Material(diffuse_reflectance=REFLECTANCE.get(name, 0.5))


def room(change=lambda p: p, flip=False, names=None, order=None) -> luz.Scene:
    scene = luz.Scene()
    for name in order or POLYGONS:
        polygon = change(np.array(POLYGONS[name], float))
        scene.add((names or {}).get(name, name), polygon[::-1] if flip else polygon, material(name))
    return scene


def light(azimuth: float = 20.0) -> luz.Daylight:
    sky = luz.CIESky(12, sun_altitude=40.0, sun_azimuth=azimuth, horizontal_illuminance=10_000)
    sun = luz.Sun(altitude=40.0, azimuth=azimuth, normal_illuminance=80_000)
    return luz.Daylight(sky=sky, sun=sun, ground_reflectance=0.2)


def lux(scene, points=POINTS, normals=NORMALS, azimuth=20.0, means=tuple(POLYGONS), elements=200) -> np.ndarray:
    result = solved(scene, light(azimuth), elements=elements, patches=100, bands=24)
    return np.append(result.at(points, normals), [result.mean(name) for name in means])


@cache
def base(elements: int = 200) -> np.ndarray:
    return lux(room(), elements=elements)


def turned(degrees: float):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return lambda p: np.asarray(p, float) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def scaled(factor: float) -> Outcome:
    return near(lux(room(lambda p: p * factor), POINTS * factor), base(), SINGLE)


def moved(shift) -> Outcome:
    allowed = SINGLE + 200 * EPS * float(np.abs(shift).max()) / FEATURE
    return near(lux(room(lambda p: p + shift), POINTS + shift), base(), allowed)


def spun(degrees: float) -> Outcome:
    turn = turned(degrees)
    got = lux(room(turn), turn(POINTS), turn(NORMALS), 20.0 + degrees)
    return near(got, base(), 3 * GLOBE)  # on 24 bands


def mirrored() -> Outcome:
    got = lux(room(lambda p: p * FLIP, flip=True), POINTS * FLIP, NORMALS * FLIP, -20.0)
    return near(got, base(), 3 * GLOBE)


def renamed() -> Outcome:
    names = {name: f"Ø {number} «{name}»" for number, name in enumerate(POLYGONS)}
    return near(lux(room(names=names), means=tuple(names.values())), base(), 0.0)


def reordered() -> Outcome:
    return near(lux(room(order=list(POLYGONS)[::-1])), base(), SINGLE)


def rolled() -> Outcome:
    """Polygons that begin at another corner: faces are cut otherwise, see `split`."""
    return near(lux(room(lambda p: np.roll(p, 1, axis=0)), elements=800), base(800), GLOBE)


def split(as_mesh: bool) -> Outcome:
    """Floor, walls and ceiling of nine quads each, or of eighteen triangles."""
    scene = luz.Scene()
    steps = np.array([0.0, 0.21, 0.7, 1.0])
    for name, polygon in POLYGONS.items():
        a, b, _, d = np.array(polygon, float)
        vertices = np.array([[a + u * (b - a) + v * (d - a) for u in steps] for v in steps]).reshape(-1, 3)
        quads = [
            [4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4] for j, i in itertools.product(range(3), range(3))
        ]
        faces = [t for q in quads for t in (q[:3], [q[0], q[2], q[3]])] if as_mesh else quads
        scene.add(name, vertices, material(name), faces=faces)
    # faces are other ones then, and so are the few receivers and patches: the same within what these err
    return near(lux(scene, elements=800), base(800), 3 * GLOBE)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("invariance", f"light-shelf room {name}", run, long)

    for size in (1e-3, 0.1, 1e2, 1e4):
        yield row(f"{size:g} m wide", lambda size=size: scaled(size / 3))
    for distance in (1e3, 1e4, 1e5, 1e6, 1e7):
        for name, way in (("east", [1, 0, 0]), ("off", [0.6, -0.7, 0.3])):
            yield row(f"{distance:g} m {name}", lambda d=distance, w=way: moved(d * np.array(w)), name == "east")
    for degrees in (17.0, 45.0, 90.0, 123.456, 271.3):
        yield row(f"turned by {degrees:g}° with its sky", lambda degrees=degrees: spun(degrees))
    yield row("mirrored with its sky", mirrored)
    yield row("renamed", renamed)
    yield row("in another order", reordered)
    yield row("from other corners", rolled)
    yield row("of quads", lambda: split(False))
    yield row("of triangles", lambda: split(True))
