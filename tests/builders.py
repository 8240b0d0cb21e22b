"""Scenes and independent rays that the solver's tests share; none of it uses the solver's own geometry."""

import math

import numpy as np
import pytest

import luzespecular as luz
from luzespecular import fracture, geometry

BLACK = luz.Material()
DARK = luz.Daylight()
UNIFORM = luz.Daylight(sky=luz.UniformSky(1000.0))


def box_polygons(size=(1.0, 1.0, 1.0), origin=(0.0, 0.0, 0.0)):
    """Name -> (4, 3): the six sides of a box, normals inwards."""
    corner = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]) * size
    sides = {
        "floor": (0, 1, 2, 3),
        "ceiling": (7, 6, 5, 4),
        "south": (0, 4, 5, 1),
        "north": (2, 6, 7, 3),
        "west": (0, 3, 7, 4),
        "east": (1, 5, 6, 2),
    }
    return {name: corner[list(index)] + np.asarray(origin) for name, index in sides.items()}


def scene_of(polygons, material=BLACK, **others):
    """Scene of named polygons: ``material`` for all but those named in ``others``."""
    scene = luz.Scene()
    for name, polygon in polygons.items():
        scene.add(name, polygon, others.get(name, material))
    return scene


def box(material=BLACK, size=(1.0, 1.0, 1.0), without=(), **others):
    """Scene of a box seen from inside."""
    return scene_of({k: v for k, v in box_polygons(size).items() if k not in without}, material, **others)


def prepare_coarse(scene, elements=200, patches=100, **options):
    """`luz.prepare` with few receivers and patches: for what does not depend on their number, and is quick then."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fracture, "FEWEST_ELEMENTS", elements)
        patch.setattr(fracture, "ELEMENTS_PER_PLAIN_SURFACE", max(8, elements // 10))
        patch.setattr(geometry, "PATCHES", patches)
        return luz.prepare(scene, **{"bands": 24, "max_area": math.inf, **options})


def flux(result, name):
    """Lumens that arrive on a surface's front."""
    faces = result.faces_of(name)
    return float(result.illuminance[faces] @ result.areas[faces])


def lambert_form_factor(polygons, normal):
    """(m,): form factors from a surface element at the origin to polygons ``(m, v, 3)`` above its horizon.

    Lambert's contour formula, F = 1/(2π) Σ β_e (n · γ_e) (Lambert 1760; e.g. Howell, C-1), positive for polygons
    that run clockwise as the element sees them, that is whose right-hand normal looks at it.
    """
    p = np.asarray(polygons, float)
    q = np.roll(p, -1, axis=1)
    sides = np.cross(p, q)
    length = np.linalg.norm(sides, axis=2)
    angle = np.arctan2(length, np.einsum("mvc,mvc->mv", p, q))
    along = np.einsum("mvc,mc->mv", sides, np.broadcast_to(np.asarray(normal, float), (len(p), 3)))
    ratio = np.divide(angle, length, out=np.zeros_like(angle), where=length > 0)
    return -(along * ratio).sum(axis=1) / (2 * np.pi)


def frame(normal):
    """Two unit vectors across a unit normal."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(normal, helper)
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


def cosine_rays(normal, count=200_000):
    """(count, 3): directions above a plane, each standing for the same share of what the plane receives.

    Places on the disc by the additive recurrence of Roberts (2018), far more even than random ones.
    """
    normal = np.asarray(normal, float) / np.linalg.norm(normal)
    number = np.arange(count)[:, None]
    share, turn = ((0.5 + number * [0.7548776662466927, 0.5698402909980532]) % 1).T[:, :, None]
    first, second = frame(normal)
    level = np.cos(2 * math.pi * turn) * first + np.sin(2 * math.pi * turn) * second
    return np.sqrt(share) * level + np.sqrt(1 - share) * normal


def first_hits(point, rays, polygons):
    """Index of the nearest convex polygon along each ray from a point, -1 where there is none."""
    best, hit = np.full(len(rays), np.inf), np.full(len(rays), -1)
    for number, polygon in enumerate(polygons):
        polygon = np.asarray(polygon, float)
        normal = sum(np.cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]) for k in range(1, len(polygon) - 1))
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = ((polygon[0] - point) @ normal) / (rays @ normal)
            place = point + distance[:, None] * rays
        inside = distance > 1e-9
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            inside &= (place - a) @ np.cross(normal, b - a) >= 0
        nearer = inside & (distance < best)
        best[nearer], hit[nearer] = distance[nearer], number
    return hit
