"""Meshes of hundreds of triangles: what they hide, send and show, whatever they look like."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import BLACK, DARK, box_polygons, lambert_form_factor
from equilibrium import ball, even, warm
from situations import GLOBE, Outcome, Situation, near, solved

import luzespecular as luz

EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))
GREY = luz.Material(diffuse_reflectance=0.5)

HIDDEN = 3.1775
"""Area times form factor from the floor below `wavy_sheet` to it [m²], by 2²¹ rays of Sobol's sequence: ± 0.0007."""


def sheet(heights: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles of a square sheet of heights ``(n + 1, n + 1)`` above places on a grid."""
    n = len(heights) - 1
    steps = np.linspace(-size / 2, size / 2, n + 1)
    x, y = np.meshgrid(steps, steps)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    lower = np.stack([corner, corner + n + 2, corner + 1], axis=1)
    faces = np.concatenate([lower, np.stack([corner, corner + n + 1, corner + n + 2], axis=1)])
    return np.stack([x, y, heights], axis=2).reshape(-1, 3), faces


def wavy_sheet(size: float = 2.0, n: int = 13) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(*2 * (np.linspace(-size / 2, size / 2, n + 1),))
    return sheet(1 + 0.15 * np.sin(3 * x) * np.cos(2 * y), size)


def below_a_sheet() -> Outcome:
    """An open mesh of 338 triangles above a floor: what the floor gets of the sky; the balance closes as well."""
    scene = luz.Scene()
    scene.add("floor", [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], GREY, two_sided=True)
    vertices, faces = wavy_sheet()
    scene.add("sheet", vertices, GREY, faces=faces, two_sided=True)
    result = solved(scene, EVEN, elements=200, patches=100, bands=24)
    floor = result.faces_of("floor")
    lumens = float(result.components["sky_direct"][floor] @ result.areas[floor])
    return near(16 - lumens / (1000 * math.pi), HIDDEN, 4e-3)


def hill_in_the_sun() -> Outcome:
    """Terrain of 800 triangles, level at its border: however it shades itself, it takes what its outline lets in."""
    x, y = np.meshgrid(*2 * (np.linspace(-5, 5, 21),))
    heights = 1.2 * np.exp(-(x**2 + y**2) / 2)
    heights[[0, -1]] = heights[:, [0, -1]] = 0.0
    vertices, faces = sheet(heights, 10.0)
    scene = luz.Scene()
    scene.add("hill", vertices, BLACK, faces=faces[:, ::-1])
    suns = [luz.Sun(altitude=a, azimuth=z, normal_illuminance=1e5) for a, z in ((25, 10), (50, 200), (89, 0))]
    transfer = luz.prepare(scene, bands=8, max_area=math.inf)
    results = [transfer.solve(luz.Daylight(sun=sun)) for sun in suns]
    expected = [1e7 * math.sin(math.radians(sun.altitude)) for sun in suns]
    return near([float(r.illuminance @ r.areas) for r in results], expected, 1e-6)


def triangles(divisions: int, radius: float, centre) -> np.ndarray:
    """(f, 3, 3): a ball of 80 facets or more, seen from outside."""
    corners = ball(BLACK, False).surfaces["ball"].pieces[:, :3]
    for _ in range(divisions - 1):
        middle = 0.5 * (corners + np.roll(corners, -1, axis=1))
        middle /= np.linalg.norm(middle, axis=2, keepdims=True)
        (a, b, c), (ab, bc, ca) = (np.moveaxis(each, 1, 0) for each in (corners, middle))
        corners = np.concatenate(
            [np.stack(part, axis=1) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
    return radius * corners + np.asarray(centre, float)


def beside_a_ball(divisions: int, luminous: bool, allowed: float) -> Outcome:
    """Under a ball, which shines or hides the sky: the sum of Lambert's formula over the facets that face a point."""
    corners = triangles(divisions, 1.0, (0, 0, 3))
    scene = luz.Scene()
    material = luz.Material(exitance=1000.0) if luminous else BLACK
    scene.add("ball", corners.reshape(-1, 3), material, faces=np.arange(3 * len(corners)).reshape(-1, 3))
    scene.add("floor", [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]], BLACK)
    result = solved(scene, DARK if luminous else EVEN, elements=50, patches=100)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    places, up, expected = np.array([[0.1, 0, 0], [2, 1, 0]]), np.array([0.0, 0, 1]), []
    for place in places:
        facing = corners[np.einsum("fc,fc->f", place - corners[:, 0], normals) > 0]
        seen = float(np.abs(lambert_form_factor(facing - place, up)).sum())
        expected.append(1000 * seen if luminous else 1000 * math.pi * (1 - seen))
    return near(result.at(places, [up, up]), expected, allowed)


def ball_in_a_box() -> Outcome:
    """All that a luminous ball of 320 facets sends arrives on the black walls around it."""
    corners = triangles(2, 0.4, (1.3, 1.6, 1.2))
    scene = luz.Scene()
    scene.add(
        "ball", corners.reshape(-1, 3), luz.Material(exitance=1e3), faces=np.arange(3 * len(corners)).reshape(-1, 3)
    )
    for name, polygon in box_polygons((3, 3, 3)).items():
        scene.add(name, polygon, BLACK)
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    got = sum(solved(scene, DARK, bands=24, elements=100).balance.absorbed.values())
    return near(got, 500 * np.linalg.norm(crossed, axis=1).sum(), 1e-3)


def ball_in_the_field() -> Outcome:
    """A ball of 320 grey facets in an even field."""
    corners = triangles(2, 1.0, (0, 0, 0))
    scene = luz.Scene()
    scene.add("ball", corners.reshape(-1, 3), warm(0.6), faces=np.arange(3 * len(corners)).reshape(-1, 3))
    return even(scene)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False, family="degenerate"):
        return Situation(family, f"meshes: {name}", run, long)

    yield row("a floor below an open sheet of 338 triangles", below_a_sheet)
    yield row("a hill of 800 triangles in the Sun", hill_in_the_sun, family="light")
    yield row("below a luminous ball of 320", lambda: beside_a_ball(2, True, 1e-6), family="light")
    yield row("below a luminous ball of 1280", lambda: beside_a_ball(3, True, GLOBE), True, "light")
    yield row("the sky beside a ball of 320", lambda: beside_a_ball(2, False, GLOBE), family="light")
    yield row("the sky beside a ball of 1280", lambda: beside_a_ball(3, False, GLOBE), True, "light")
    yield row("a luminous ball of 320 in a black box", ball_in_a_box, family="energy")
    yield row("a ball of 320 in an even field", ball_in_the_field, True, "energy")
