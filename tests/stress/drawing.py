"""Drawn carelessly, or with little: corners that are none, holes by a bridge, panes in parts, slivers that shine,
pinholes, wedges of mirrors at any angle."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, box_polygons, cosine_rays
from degenerate import EVEN, GREY, LAMP, NORMALS, PLATE, POINTS, ROOM, by_lamps, corner_of_mirrors, image
from situations import Outcome, Situation, all_of, near, solved

import luzespecular as luz

FRAME = [[0, 4], [4, 4], [4, 0], [0, 0], [0, 4], [1.5, 2.5], [1.5, 1.5], [2.5, 1.5], [2.5, 2.5], [1.5, 2.5]]
STRIPS = (((0, 1.5), (0, 4)), ((2.5, 4), (0, 4)), ((1.5, 2.5), (0, 1.5)), ((1.5, 2.5), (2.5, 4)))


def ceiling(x, y, z=3.0) -> np.ndarray:
    """(4, 3): a rectangle that looks down."""
    return np.array([[x[0], y[1], z], [x[1], y[1], z], [x[1], y[0], z], [x[0], y[0], z]], float)


def walls(material, **more) -> luz.Scene:
    """A room of 4 m × 4 m × 3 m without a ceiling, and what is added."""
    scene = luz.Scene()
    for name, polygon in box_polygons((4, 4, 3)).items():
        if name != "ceiling":
            scene.add(name, polygon, material)
    for name, (polygon, own) in more.items():
        scene.add(name, polygon, own)
    return scene


def floor_of(corners, mesh: bool = False) -> Outcome:
    """A floor of these corners in a half-open room: as the square one."""

    def result(polygon, faces=None) -> luz.Result:
        scene = luz.Scene()
        for name, wall in ROOM.items():
            if name != "floor":
                scene.add(name, wall, GREY)
        scene.add("floor", np.array(polygon, float), GREY, faces=faces)
        return solved(scene, EVEN, elements=400, patches=200, bands=40)

    drawn, plain = result(corners, [range(len(corners))] if mesh else None), result(PLATE)
    return all_of(
        near(drawn.areas[drawn.faces_of("floor")].sum(), 16, 1e-9),
        near(drawn.at(POINTS, NORMALS), plain.at(POINTS, NORMALS), 1e-3),
    )


def hole_by_a_bridge(mesh: bool) -> Outcome:
    """A ceiling with a hole that an edge walked both ways leads to: as four rectangles around it."""
    ring = np.c_[FRAME, np.full(len(FRAME), 3.0)]
    drawn = walls(GREY)
    drawn.add("ceiling", ring, GREY, faces=[range(len(ring))] if mesh else None)
    plain = walls(GREY, **{f"strip {k}": (ceiling(*strip), GREY) for k, strip in enumerate(STRIPS)})
    one, other = (solved(scene, EVEN, elements=600, patches=300, bands=40) for scene in (drawn, plain))
    return all_of(
        near(one.areas[one.faces_of("ceiling")].sum(), 15, 1e-9),
        near(one.at(POINTS, NORMALS), other.at(POINTS, NORMALS), 5e-3),
    )


def panes_in_parts() -> Outcome:
    """A roof of three panes that meet in a T: as one pane."""
    glass = luz.Material(regular_transmittance=0.8, refractive_index=1.52)
    parts = (((0, 4), (0, 1.3)), ((0, 2.2), (1.3, 4)), ((2.2, 4), (1.3, 4)))
    whole = walls(GREY, pane=(ceiling((0, 4), (0, 4)), glass))
    three = walls(GREY, **{f"pane {k}": (ceiling(*part), glass) for k, part in enumerate(parts)})
    one, other = (
        solved(scene, EVEN, elements=300, patches=150, bands=30).at(POINTS, NORMALS) for scene in (whole, three)
    )
    return near(other, one, 2e-3)


def clear_before_a_wall(distance: float) -> Outcome:
    """A pane that lets all light through, next to nothing before a wall: as without it."""

    def lux(**more) -> np.ndarray:
        scene = luz.Scene()
        for name, wall in ROOM.items():
            scene.add(name, wall, GREY)
        for name, polygon in more.items():
            scene.add(name, polygon, luz.Material(regular_transmittance=1.0))
        return solved(scene, EVEN, elements=200, patches=100, bands=30).at(POINTS, NORMALS)

    return near(lux(pane=ROOM["west"] + [distance, 0, 0]), lux(), 5e-3)


def sliver_that_shines() -> Outcome:
    """A lamp of 1 m × 1 µm: the integral along a line."""
    scene = luz.Scene()
    scene.add("floor", PLATE, BLACK)
    scene.add("lamp", ceiling((1, 2), (2, 2 + 1e-6), 1.0), luz.Material(exitance=1e9))
    point = np.array([1.5, 2.3, 0])
    got = solved(scene, DARK, elements=100, patches=20, bands=8).at([point], [[0, 0, 1]])
    along = 1 + (np.arange(20_000) + 0.5) / 20_000
    way = np.stack([along, np.full_like(along, 2 + 5e-7), np.ones_like(along)], axis=1) - point
    factor = 1e-6 * float((way[:, 2] ** 2 / (way**2).sum(axis=1) ** 2).mean()) / math.pi
    return near(got, [1e9 * factor], 1e-6)


def floor_in_halves(rise: float) -> Outcome:
    """A floor of two halves that meet at next to no angle: as a flat one."""

    def lux(height: float) -> np.ndarray:
        scene = luz.Scene()
        for name, wall in ROOM.items():
            if name != "floor":
                scene.add(name, wall, GREY)
        corners = [[0, 0, 0], [2, 0, height], [2, 4, height], [0, 4, 0], [4, 0, 0], [4, 4, 0]]
        scene.add("floor", np.array(corners, float), GREY, faces=[[0, 1, 2, 3], [1, 4, 5, 2]])
        return solved(scene, EVEN, elements=400, patches=200, bands=40).at(np.add(POINTS, [0, 0, 1e-3]), NORMALS)

    return near(lux(rise), lux(0.0), 1e-3)


def pinhole(width: float, points) -> Outcome:
    """The sky through a hole far smaller than a parcel: luminance × area × cos² over the distance squared."""
    low, high = 2 - width / 2, 2 + width / 2
    strips = (((0, low), (0, 4)), ((high, 4), (0, 4)), ((low, high), (0, low)), ((low, high), (high, 4)))
    scene = walls(BLACK, **{f"strip {k}": (ceiling(*strip), BLACK) for k, strip in enumerate(strips)})
    result = solved(scene, luz.Daylight(sky=luz.UniformSky(1e6)), elements=100)
    squared = ((np.array(points) - [2, 2, 3]) ** 2).sum(axis=1)
    return near(result.at(points, [[0, 0, 1]] * len(points)), 1e6 * width**2 * 9 / squared**2, 0.01)


def sun_through_a_pinhole(width: float) -> Outcome:
    """What of the Sun comes through a hole arrives on the floor, to the last lumen."""
    low, high = 2 - width / 2, 2 + width / 2
    strips = (((0, low), (0, 4)), ((high, 4), (0, 4)), ((low, high), (0, low)), ((low, high), (high, 4)))
    scene = walls(BLACK, **{f"strip {k}": (ceiling(*strip), BLACK) for k, strip in enumerate(strips)})
    sun = luz.Sun(direction=(0.2, 0.1, 1), normal_illuminance=1e5)
    result = solved(scene, luz.Daylight(sun=sun), bands=8, elements=100)
    floor = result.faces_of("floor")
    return near(result.illuminance[floor] @ result.areas[floor], 1e5 * width**2 / math.sqrt(1.05), 1e-6)


def wedge_by_rays(degrees: float, reflectance: float) -> Outcome:
    """A lamp between mirrors at an angle that divides no circle: against single rays."""
    angle, count = math.radians(degrees), 1_000_000
    inward = np.array([[0.0, 1, 0], [math.sin(angle), -math.cos(angle), 0]])
    sides, middle, across = _wedge(angle)
    centre, point = 1.2 * middle + [0, 0, 1], 1.5 * middle + 0.1 * across
    lamp = np.array([centre + a * 0.2 * middle + b * 0.2 * across for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1))])
    scene = luz.Scene()
    for name, polygon in zip(("one", "two"), sides, strict=True):
        scene.add(name, polygon, luz.Material(specular_reflectance=reflectance))
    scene.add("lamp", lamp, LAMP)
    got = solved(scene, DARK, elements=20, patches=5, bands=8, specular_cutoff=1e-4).at([point], [[0, 0, 1]])
    rays = cosine_rays([0, 0, 1], count)
    place, weight, alive, total = np.tile(point, (count, 1)), np.ones(count), np.ones(count, bool), 0.0
    for _ in range(16):
        with np.errstate(divide="ignore", invalid="ignore"):
            far = -(place @ inward.T) / (rays @ inward.T)
            up = (1 - place[:, 2]) / rays[:, 2]
        far = np.where(far > 1e-9, far, np.inf)
        mirror, first = far.argmin(axis=1), far.min(axis=1)
        beside = place + up[:, None] * rays - centre
        lit = alive & (up > 0) & (up < first) & (np.abs(beside @ middle) <= 0.2) & (np.abs(beside @ across) <= 0.2)
        total += float(weight[lit].sum())
        alive &= ~lit & np.isfinite(first)
        place = place + np.where(np.isfinite(first), first, 0.0)[:, None] * rays
        rays = rays - 2 * np.einsum("rc,rc->r", rays, inward[mirror])[:, None] * inward[mirror]
        weight = weight * reflectance
    return near(got, [1000 * total / count], 1e-2)


def thin_wedge() -> Outcome:
    """Mirrors that meet at 0.01°: a lamp 1 km out has images, each turned a little more."""
    angle, reflectance, out = math.radians(0.01), 0.5, 1000.0
    sides, _, _ = _wedge(angle, 3000.0, 2000.0)
    normals = [np.array([0.0, 1, 0]), np.array([math.sin(angle), -math.cos(angle), 0])]
    gap = out * math.tan(angle)
    lamp = ceiling((out - 0.05, out + 0.05), (0.3 * gap, 0.7 * gap), 1.0)
    point = np.array([out + 0.3, 0.5 * gap, 0])
    scene = luz.Scene()
    for name, polygon in zip(("one", "two"), sides, strict=True):
        scene.add(name, polygon, luz.Material(specular_reflectance=reflectance))
    scene.add("lamp", lamp, LAMP)
    got = solved(scene, DARK, elements=20, patches=5, bands=8, specular_cutoff=1e-5).at([point], [[0, 0, 1]])
    expected = by_lamps([lamp], point, [0, 0, 1])
    for first in (0, 1):
        for order in range(1, 18):
            shown = lamp
            for step in range(order):
                shown = image(shown, normals[(first + step) % 2], 0.0)
            expected += reflectance**order * by_lamps([shown], point, [0, 0, 1])
    return near(got, [expected], 1e-4)


def _wedge(angle: float, far: float = 400.0, tall: float = 400.0):
    """Two mirrors that meet in the z axis and look at each other, and unit vectors midway between and across."""
    along = far * np.array([[1.0, 0, 0], [math.cos(angle), math.sin(angle), 0]])
    low, up = np.array([0, 0, -tall / 2]), np.array([0, 0, tall])
    one = np.array([low, low + up, low + along[0] + up, low + along[0]])
    two = np.array([low, low + along[1], low + along[1] + up, low + up])
    middle = np.array([math.cos(angle / 2), math.sin(angle / 2), 0.0])
    return [one, two], middle, np.array([-middle[1], middle[0], 0.0])


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("degenerate", name, run, long)

    square = PLATE.tolist()
    for name, corners in {
        "straight corners": [square[0], [1, 0, 0], [2, 0, 0], *square[1:3], [3, 4, 0], square[3], [0, 1.7, 0]],
        "a corner twice": [*square[:2], *square[1:]],
        "its first corner again": [*square, square[0]],
        "corners 1e-12 m apart": [*square[:2], [4, 1e-12, 0], *square[2:]],
        "a bridge to nowhere": [square[0], [2, 0, 0], [2, 1, 0], [2, 0, 0], *square[1:]],
    }.items():
        yield row(f"a floor with {name}", lambda corners=corners: floor_of(corners))
        yield row(f"a mesh with {name}", lambda corners=corners: floor_of(corners, mesh=True), True)
    yield row("a hole by a bridge", lambda: hole_by_a_bridge(False))
    yield row("a hole by a bridge in a mesh", lambda: hole_by_a_bridge(True), True)
    yield row("panes that meet in a T", panes_in_parts)
    for distance in (1e-6, 1e-3):
        yield row(f"a clear pane {distance:g} m before a wall", lambda d=distance: clear_before_a_wall(d))
    yield row("a lamp of aspect 1e6", sliver_that_shines)
    yield row("a floor bent by 1e-6", lambda: floor_in_halves(2e-6))
    for width in (0.03, 1e-3):
        yield row(
            f"the sky through a hole of {width:g} m", lambda width=width: pinhole(width, [[1, 2, 0], [0.3, 3.1, 0]])
        )
    for width in (0.01, 1e-4):
        yield row(f"the Sun through a hole of {width:g} m", lambda width=width: sun_through_a_pinhole(width))
    for degrees, reflectance in ((30, 0.9), (36, 0.8)):
        yield row(
            f"mirrors that meet at {degrees}°",
            lambda degrees=degrees, reflectance=reflectance: corner_of_mirrors(degrees, reflectance),
        )
    for degrees, reflectance in ((72, 0.8), (50, 0.7)):
        yield row(
            f"mirrors that meet at {degrees}°",
            lambda degrees=degrees, reflectance=reflectance: wedge_by_rays(degrees, reflectance),
            degrees == 50,
        )
    yield row("mirrors that meet at 0.01°", thin_wedge)
