"""Fronts and backs, wanted receivers, and rooms that share a wall."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, box_polygons
from degenerate import by_lamps
from situations import SINGLE, Outcome, Situation, all_of, holds, near, refused, solved

import luzespecular as luz

GREY = luz.Material(diffuse_reflectance=0.5)
EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
SUNNY = luz.Daylight(sky=luz.UniformSky(1000.0), sun=luz.Sun(direction=(0.3, -0.5, 1), normal_illuminance=5e4))


def level(x, y, z) -> np.ndarray:
    """A rectangle that looks up."""
    return np.array([[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]], float)


def between_lamps() -> Outcome:
    """A plate of both sides between two lamps: each lights its side, by Lambert."""
    scene = luz.Scene()
    plate = level((-0.01, 0.01), (-0.01, 0.01), 0.0)
    above, below = level((-1, 1), (-1, 1), 1.0)[::-1], level((-1, 1), (-1, 1), -2.0)
    scene.add("plate", plate, BLACK, two_sided=True)
    scene.add("above", above, luz.Material(exitance=1000.0))
    scene.add("below", below, luz.Material(exitance=3000.0))
    result = solved(scene, DARK, bands=8, elements=60, max_area=1e-4)
    up = by_lamps([above], np.zeros(3), [0, 0, 1.0])
    down = 3 * by_lamps([below], np.zeros(3), [0, 0, -1.0])
    faces = result.faces_of("plate")
    return all_of(
        near(result.front.illuminance[faces].mean(), up, 1e-3),
        near(result.back.illuminance[faces].mean(), down, 1e-3),
    )


def lamp_of_both_sides() -> Outcome:
    """It gives each side what a lamp of one side gives, and its back is dark where it has but one."""

    def lux(both: bool) -> list[float]:
        scene = luz.Scene()
        scene.add("floor", level((-1, 1), (-1, 1), 0.0), BLACK)
        scene.add("ceiling", level((-1, 1), (-1, 1), 2.0)[::-1], BLACK)
        scene.add("lamp", level((-0.3, 0.3), (-0.3, 0.3), 1.0)[::-1], luz.Material(exitance=1000.0), two_sided=both)
        result = solved(scene, DARK, bands=8, elements=100)
        return result.at([[0.2, 0.1, 0], [0.2, 0.1, 2.0]], [[0, 0, 1], [0, 0, -1]]).tolist()

    both, one = lux(True), lux(False)
    return all_of(near(both[0], both[1], 1e-9), near(one[0], both[0], 1e-9), near(one[1], 0.0, 0, 1e-9))


def back_to_back() -> Outcome:
    """Two plates of one side, back to back in one plane: as one of both."""

    def result(kind: str) -> list[float]:
        scene = luz.Scene()
        for name, polygon in box_polygons((3, 3, 2)).items():
            if name not in ("ceiling",):
                scene.add(name, polygon, GREY)
        plate = level((0.5, 2), (0.7, 2.2), 1.0)
        if kind == "one":
            scene.add("up", plate, GREY, two_sided=True)
        else:
            scene.add("up", plate, GREY)
            scene.add("down", plate[::-1], GREY)
        found = solved(scene, SUNNY, bands=24, elements=400, patches=200)
        below = found.back.illuminance[found.faces_of("up")].mean() if kind == "one" else found.mean("down")
        return [*(found.mean(n) for n in ("floor", "west", "up")), float(below)]

    return near(result("two"), result("one"), 3e-3)


def flipped() -> Outcome:
    """A surface of both sides turned over: what was front is back."""

    def both(turn: bool) -> tuple[float, float]:
        scene = luz.Scene()
        scene.add("ground", level((-3, 3), (-3, 3), 0.0), GREY)
        plate = level((-0.5, 0.5), (-0.5, 0.5), 0.8)
        scene.add("plate", plate[::-1] if turn else plate, GREY, two_sided=True)
        found = solved(scene, SUNNY, bands=24, elements=300, patches=100)
        faces = found.faces_of("plate")
        return float(found.front.illuminance[faces].mean()), float(found.back.illuminance[faces].mean())

    return near(both(True)[::-1], both(False), 1e-3)


def closed_rooms(size: float, origins: dict[str, tuple], reflectance: float = 0.5) -> luz.Scene:
    """Closed cubes by title and origin; the ceiling of the "lit" one glows."""
    scene = luz.Scene()
    for title, origin in origins.items():
        for name, polygon in box_polygons((size, size, size), origin).items():
            glow = 1000.0 if (title, name) == ("lit", "ceiling") else 0.0
            scene.add(f"{title} {name}", polygon, luz.Material(diffuse_reflectance=reflectance, exitance=glow))
    return scene


def shared_wall(gap: float) -> Outcome:
    """Two closed rooms with one wall between, given from both sides: where no lamp is, it is dark."""
    scene = closed_rooms(2, {"lit": (0, 0, 0), "dark": (2 + gap, 0, 0)})
    result = solved(scene, DARK, bands=24, elements=600, patches=300)
    dark = np.concatenate([result.illuminance[result.faces_of(f"dark {n}")] for n in box_polygons()])
    return near(dark, np.zeros(len(dark)), 0, 1e-9 * result.mean("lit floor"))


def rooms_around_a_lit_one() -> Outcome:
    """Six closed rooms around a lit one, wall to wall: all are dark."""
    origins = [(0, 0, 0), (2, 0, 0), (-2, 0, 0), (0, 2, 0), (0, -2, 0), (0, 0, 2), (0, 0, -2)]
    scene = closed_rooms(2, dict(zip(["lit", *"abcdef"], origins, strict=True)), 0.6)
    result = solved(scene, DARK, bands=24, elements=1500, patches=500)
    worst = max(result.illuminance[result.faces_of(f"{t} {n}")].max() for t in "abcdef" for n in box_polygons())
    return near(worst, 0.0, 0, 1e-9 * result.mean("lit floor"))


def cabinet() -> Outcome:
    """A closed cabinet in a bright room is dark inside, to 1e-4 of the light outside: walls of both sides."""
    scene = luz.Scene()
    for name, polygon in box_polygons((3, 3, 3)).items():
        scene.add(name, polygon, luz.Material(diffuse_reflectance=0.5, exitance=1000.0))
    for name, polygon in box_polygons((0.8, 0.6, 1.2), (1, 1, 0.5)).items():
        scene.add(f"cabinet {name}", polygon, GREY, two_sided=True)
    result = solved(scene, DARK, bands=24, elements=500, patches=200)
    worst = max(result.illuminance[result.faces_of(f"cabinet {n}")].max() for n in box_polygons())
    outer = result.back.illuminance[result.faces_of("cabinet west")]
    return all_of(near(worst, 0.0, 0, 1e-4 * result.mean("floor")), holds(bool((outer > 100).all()), "lit", "outside"))


def sunlit_room_beside_a_closed_one(gap: float) -> Outcome:
    """A room under Sun and sky beside a closed one."""
    scene = luz.Scene()
    for title, x in (("open", 0.0), ("dark", 2.0 + gap)):
        for name, polygon in box_polygons((2, 2, 2), (x, 0, 0)).items():
            if (title, name) != ("open", "south"):
                scene.add(f"{title} {name}", polygon, GREY)
    result = solved(scene, SUNNY, bands=24, elements=600, patches=300)
    worst = max(result.illuminance[result.faces_of(f"dark {n}")].max() for n in box_polygons())
    return near(worst, 0.0, 0, 1e-9 * result.mean("open floor"))


def wanted(names, allowed: float = 2e-2) -> Outcome:
    """Faces of some surfaces alone: about the lux that they have with all."""

    def scene() -> luz.Scene:
        room = luz.Scene()
        for name, polygon in box_polygons((3, 4, 2.5)).items():
            if name != "north":
                room.add(name, polygon, GREY)
        room.add("desk", level((0.5, 2), (0.8, 2.2), 0.8), GREY, two_sided=True)
        room.add(
            "mirror", box_polygons((3, 4, 2.5))["west"] * 0.5 + [0.01, 1, 0.5], luz.Material(specular_reflectance=0.9)
        )
        return room

    light = luz.Daylight(
        sky=luz.CIESky(12, sun_altitude=35, sun_azimuth=20, horizontal_illuminance=1e4),
        sun=luz.Sun(altitude=35, azimuth=20, normal_illuminance=8e4),
    )
    options = {"bands": 24, "elements": 800, "patches": 400}
    all_, some = solved(scene(), light, **options), solved(scene(), light, receivers=names, **options)
    return all_of(
        near([some.mean(n) for n in names], [all_.mean(n) for n in names], allowed),
        holds(some.surfaces == [n for n in all_.surfaces if n in names], "the wanted surfaces", f"{some.surfaces}"),
        refused(lambda: some.mean("south"), "'south'", "receivers"),
    )


def wanted_is_refused(names, *words) -> Outcome:
    scene = luz.Scene()
    scene.add("floor", level((0, 1), (0, 1), 0), GREY)
    return refused(lambda: luz.prepare(scene, bands=4, receivers=names), *words)


def two_sided_ground() -> Outcome:
    """A plate of both sides in mid-air over grey ground: its back gets half of what the ground throws back."""
    scene = luz.Scene()
    scene.add("plate", level((-1, 1), (-1, 1), 0.0), BLACK, two_sided=True)
    light = luz.Daylight(sky=luz.UniformSky(1000.0), ground_reflectance=0.3)
    result = solved(scene, light, bands=24)
    faces = result.faces_of("plate")
    return all_of(
        near(result.illuminance[faces], 1000 * math.pi, SINGLE),
        near(result.back.illuminance[faces], 300 * math.pi, SINGLE),
    )


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("degenerate", f"sides: {name}", run, long)

    yield row("a plate between two lamps", between_lamps)
    yield row("a lamp of both sides", lamp_of_both_sides)
    yield row("two plates back to back", back_to_back)
    yield row("a plate of both sides turned over", flipped)
    yield row("a plate of both sides in mid-air", two_sided_ground)
    for gap in (0.0, 1e-6, 0.3):
        yield row(f"a lit room {gap:g} m beside a dark one", lambda gap=gap: shared_wall(gap))
        yield row(f"a sunlit room {gap:g} m beside a closed one", lambda gap=gap: sunlit_room_beside_a_closed_one(gap))
    yield row("the floor alone is wanted", lambda: wanted(["floor"]))
    yield row("a desk of both sides is wanted", lambda: wanted(["desk"]))
    yield row("a mirror is wanted", lambda: wanted(["mirror", "ceiling"]), True)
    yield row("none is wanted", lambda: wanted_is_refused([], "receivers", "empty"))
    yield row("one that is not there is wanted", lambda: wanted_is_refused(["flor"], "'flor'", "floor"))
    yield row("a name instead of a list", lambda: wanted_is_refused("floor", "list"))
    yield row("six dark rooms around a lit one", rooms_around_a_lit_one)
    yield row("a closed cabinet in a bright room", cabinet)
