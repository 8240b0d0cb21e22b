"""Holes far smaller than a parcel, onto the sky and into the next room; and boxes that let nothing in."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, box_polygons, lambert_form_factor
from situations import GLOBE, Outcome, Situation, all_of, near, solved, told

import luzespecular as luz

EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
GREY = luz.Material(diffuse_reflectance=0.5)
UP = np.array([0.0, 0.0, 1.0])


def with_hole(wall: np.ndarray, width: float) -> np.ndarray:
    """A rectangle's corners, and by a bridge those of a square hole in its middle."""
    middle = wall.mean(axis=0)
    u, v = (0.5 * width * (w / np.linalg.norm(w)) for w in (wall[1] - wall[0], wall[3] - wall[0]))
    hole = middle + np.array([-u - v, -u + v, u + v, u - v])
    return np.concatenate([wall, wall[:1], hole, hole[:1]])


def factor(corners, point, normal) -> float:
    return abs(float(lambert_form_factor(np.asarray(corners, float)[None] - point, normal)[0]))


def room(width: float, material) -> luz.Scene:
    scene = luz.Scene()
    for name, polygon in box_polygons((4, 4, 3)).items():
        scene.add(name, with_hole(polygon, width) if name == "ceiling" else polygon, material)
    return scene


def sky_through(width: float) -> Outcome:
    """Under a small hole in the ceiling of a black room: Lambert's formula."""
    half = 0.5 * width
    hole = [[2 - half, 2 - half, 3], [2 - half, 2 + half, 3], [2 + half, 2 + half, 3], [2 + half, 2 - half, 3]]
    result = solved(room(width, BLACK), EVEN)
    places = np.array([[2, 2, 0], [1.3, 2.4, 0]])
    expected = [1000 * math.pi * factor(hole, place, UP) for place in places]
    return near(result.at(places, [UP, UP]), expected, GLOBE)


def next_room(width: float) -> Outcome:
    """Through a small hole into a bright room of even walls: by Lambert, the lux of these looked up there."""
    scene = luz.Scene()
    for name, polygon in box_polygons((3, 3, 3)).items():
        if name != "east":
            scene.add(f"bright {name}", polygon, luz.Material(diffuse_reflectance=0.5, exitance=1000.0))
    for name, polygon in box_polygons((3, 3, 3), (3, 0, 0)).items():
        if name != "west":
            scene.add(f"dark {name}", polygon, BLACK)
    wall = box_polygons((3, 3, 3))["east"]
    scene.add("wall", with_hole(wall, width), GREY, two_sided=True)
    result = solved(scene, DARK, elements=200, patches=200)
    places = np.array([[6, 1.5, 1.5], [6, 1.1, 1.7], [6, 2.0, 1.5]])
    seen = np.array([[0, 1.5, 1.5], [0, 1.9, 1.3], [0, 1.0, 1.5]])
    sent = 1000 + 0.5 * result.at(seen, np.tile([1.0, 0, 0], (3, 1)))
    way = np.tile([-1.0, 0, 0], (3, 1))
    hole = with_hole(wall, width)[5:9]
    expected = [m * factor(hole, place, way[0]) for m, place in zip(sent, places, strict=True)]
    return near(result.at(places, way), expected, GLOBE)


def closed_but_for(width: float) -> Outcome:
    """So small a hole that no ray of the scene check finds it: told as a space without an opening."""
    return told(room(width, GREY), "no opening")


def cabinet(walls: str) -> Outcome:
    """A closed cabinet in a sunny room: nothing gets in, a millionth of what is outside at most."""
    scene = luz.Scene()
    for name, polygon in box_polygons((4, 4, 3)).items():
        if name != "north":
            scene.add(name, polygon, GREY)
    low, size = np.array([1.2, 1.1, 0.4]), np.array([0.8, 0.7, 0.9])
    for name, polygon in box_polygons(size, low).items():
        scene.add(f"cabinet {name}", polygon[::-1] if walls == "thick" else polygon, GREY, two_sided=walls == "thin")
    if walls == "thick":
        for name, polygon in box_polygons(size - 0.04, low + 0.02).items():
            scene.add(f"inside {name}", polygon, GREY)
    light = luz.Daylight(
        sky=luz.UniformSky(1000.0), sun=luz.Sun(altitude=30, azimuth=10, normal_illuminance=8e4), ground_reflectance=0.2
    )
    result = solved(scene, light, elements=300)
    inside = "inside" if walls == "thick" else "cabinet"
    faces = np.concatenate([result.faces_of(f"{inside} {name}") for name in box_polygons()])
    rng = np.random.default_rng(0)
    places, normals = low + 0.02 + rng.uniform(0.02, 0.98, (30, 3)) * (size - 0.04), rng.normal(size=(30, 3))
    found = np.concatenate([result.illuminance[faces], result.at(places, normals)])
    return near(found, np.zeros(len(found)), 0.0, 1e-6 * result.mean("floor"))


def situations() -> Iterator[Situation]:
    def row(name, run, long=False, family="light"):
        return Situation(family, f"openings: {name}", run, long)

    for width in (0.3, 0.05, 0.004, 0.001):
        yield row(f"the sky through {1000 * width:g} mm", lambda w=width: sky_through(w), width in (0.3, 0.004))
    for width in (0.1, 0.05, 0.005):
        yield row(f"the next room through {1000 * width:g} mm", lambda w=width: next_room(w), width == 0.1)
    yield row("a hole of 1 mm is told", lambda: all_of(*(closed_but_for(w) for w in (1e-3, 4e-3))))
    for walls in ("thick", "thin"):
        yield row(f"a cabinet of {walls} walls", lambda w=walls: cabinet(w), family="degenerate")
