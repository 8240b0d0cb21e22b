"""Meshes of hundreds of triangles: what they hide, send and show, whatever they look like."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from situations import Outcome, Situation, near, solved

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


def situations() -> Iterator[Situation]:
    yield Situation("degenerate", "meshes: a floor below an open sheet of 338 triangles", below_a_sheet)
