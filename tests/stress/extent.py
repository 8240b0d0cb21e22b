"""From nothing to a million triangles."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, box_polygons, prepare_coarse
from situations import SINGLE, Outcome, Situation, assert_sound, holds, near, refused, solved

import luzespecular as luz

EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
GREY = luz.Material(diffuse_reflectance=0.5)


def one_triangle(size: float) -> Outcome:
    scene = luz.Scene()
    scene.add("one", size * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), GREY)
    result = solved(scene, EVEN, bands=24)
    return near(result.illuminance, np.full(len(result.areas), 1000 * math.pi), SINGLE)


def ceiling_of(n: int, height: float = 1.0):
    """Vertices and faces of a square ceiling of 2 n² triangles that is not flat by a hair."""
    steps = np.linspace(-5, 5, n + 1)
    x, y = np.meshgrid(steps, steps)
    z = height + 1e-3 * np.sin(3 * x) * np.cos(2 * y)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    lower = np.stack([corner, corner + n + 2, corner + 1], axis=1)
    faces = np.concatenate([lower, np.stack([corner, corner + n + 1, corner + n + 2], axis=1)])
    return np.stack([x, y, z], axis=2).reshape(-1, 3), faces


def one_face_below(n: int, **options) -> Outcome:
    """One face that 2 n² triangles stand above: what it gets of the sky is as under a flat ceiling."""
    floor = np.array([[-0.1, -0.1, 0], [0.1, -0.1, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0]])
    scene, flat = luz.Scene(), luz.Scene()
    vertices, faces = ceiling_of(n)
    for target in (scene, flat):
        target.add("floor", floor, BLACK)
    scene.add("ceiling", vertices, BLACK, faces=faces)
    flat.add("ceiling", [[-5, 5, 1], [5, 5, 1], [5, -5, 1], [-5, -5, 1]], BLACK)
    lux = [prepare_coarse(s, elements=20, bands=60, **options).solve(EVEN).mean("floor") for s in (scene, flat)]
    return near(lux[0], lux[1], 0.02)


def within_memory(n: int, memory: float) -> Outcome:
    """A lit mesh of 2 n² triangles: it is solved within the memory given, or refused before work starts."""
    vertices, faces = ceiling_of(n)
    scene = luz.Scene()
    scene.add("room", vertices, GREY, faces=faces)
    try:
        result = luz.prepare(scene, bands=24, memory=memory).solve(EVEN)
    except luz.SceneError as error:
        return holds("'memory'" in str(error), "solved, or refused naming the memory", str(error)[:60])
    assert_sound(result)
    return holds(True, "solved, or refused naming the memory", f"{result.mean('room'):.6g} lx")


def too_little_memory() -> Outcome:
    scene = luz.Scene()
    for name, polygon in box_polygons((3, 3, 3)).items():
        if name != "north":
            scene.add(name, polygon, GREY)
    return refused(lambda: luz.prepare(scene, memory=1e6), "memory", "max_area")


def many_surfaces(count: int) -> Outcome:
    """Plates beside one another, each under the whole sky."""
    scene = luz.Scene()
    for k in range(count):
        x, y = 2.0 * (k % 20), 2.0 * (k // 20)
        scene.add(f"plate {k}", [[x, y, 0], [x + 1, y, 0], [x + 1, y + 1, 0], [x, y + 1, 0]], BLACK)
    result = solved(scene, EVEN, bands=16)
    return near(result.illuminance, np.full(len(result.areas), 1000 * math.pi), SINGLE)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("scale", name, run, long)

    yield row("no surface", lambda: refused(lambda: luz.prepare(luz.Scene()), "no surfaces"))
    for size in (1e-6, 1.0, 1e6):
        yield row(f"one triangle of {size:g} m", lambda size=size: one_triangle(size))
    yield row("400 surfaces", lambda: many_surfaces(400))
    yield row("1 face under 800 triangles", lambda: one_face_below(20))
    yield row("1 face under 1e5 triangles", lambda: one_face_below(224), True)
    yield row("too little memory", too_little_memory)
    yield row("1e6 triangles in 2 GB", lambda: within_memory(708, 2e9), True)
    yield row("max_area of a millionth", lambda: refused(lambda: luz.prepare(_square(), max_area=1e-9), "max_area"))
    for bands in (0, -4, 10**9):
        yield row(f"{bands} bands", lambda bands=bands: refused(lambda: luz.prepare(_square(), bands=bands), "bands"))


def _square() -> luz.Scene:
    scene = luz.Scene()
    scene.add("square", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], GREY)
    return scene
