"""Directions and skies that the tests of the skies share."""

import math

import numpy as np

from luzespecular.sky import CIESky, PerezSky
from luzespecular.sun import direction_of

ZENITH = np.array([[0.0, 0.0, 1.0]])


def hemisphere(rings=300):
    """Directions above the horizon and their solid angles, by rings of equal width; independent of the package."""
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    polar = (nodes + 1) * math.pi / 4
    around = (np.arange(3 * rings) + 0.5) * 2 * math.pi / (3 * rings)
    theta, phi = np.meshgrid(polar, around, indexing="ij")
    directions = np.stack((np.sin(theta) * np.sin(phi), np.sin(theta) * np.cos(phi), np.cos(theta)), axis=-1)
    solid = (weights * math.pi / 4 * np.sin(polar))[:, None] * np.full(len(around), 2 * math.pi / len(around))
    return directions.reshape(-1, 3), solid.ravel()


def some_directions(count=500, seed=0):
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    vectors[:, 2] = np.abs(vectors[:, 2])
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def tregenza():
    """The 145 directions of a sky scanner."""
    rings = ((6, 30), (18, 30), (30, 24), (42, 24), (54, 18), (66, 12), (78, 6), (90, 1))
    return np.concatenate([direction_of(altitude, np.arange(n) * 360.0 / n) for altitude, n in rings])


def clear(**changes):
    return CIESky(12, **{"sun_altitude": 40.0, "sun_azimuth": 30.0, "horizontal_illuminance": 10_000.0, **changes})


def perez(**changes):
    given = {
        "direct_normal_irradiance": 700.0,
        "diffuse_horizontal_irradiance": 120.0,
        "sun_altitude": 40.0,
        "sun_azimuth": 30.0,
    }
    return PerezSky(**{**given, **changes})
