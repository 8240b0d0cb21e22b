"""The pipe against closed forms: a mirror pipe is a periodic window when one unfolds the reflections."""

import math

import numpy as np
import pytest


def sun_transmittance(length, width, reflectance, altitude, azimuth):
    """Exact for a square pipe: over its section, the Sun's rays meet floor(s) or floor(s) + 1 walls of each pair."""
    share = 1.0
    for component in (abs(math.sin(math.radians(azimuth))), abs(math.cos(math.radians(azimuth)))):
        crossings = length / math.tan(math.radians(altitude)) * component / width
        whole, part = divmod(crossings, 1)
        share *= (1 - part) * reflectance**whole + part * reflectance ** (whole + 1)
    return share


def corner_factor(a, b, height):
    """Configuration factor from a point to a parallel rectangle a x b, one corner straight above it."""
    x, y = a / height, b / height
    p, q = math.hypot(1, x), math.hypot(1, y)
    return (x / p * math.atan(y / p) + y / q * math.atan(x / q)) / (2 * math.pi)


def test_sunlight(example):
    pipes = example("mirror_light_pipe.py")
    found = pipes.transmittances(2)[1:]
    exact = [
        sun_transmittance(2 * pipes.WIDTH, pipes.WIDTH, pipes.REFLECTANCE, altitude, pipes.AZIMUTH)
        for altitude in pipes.ALTITUDES
    ]
    assert found == pytest.approx(exact, rel=2e-3)


def test_uniform_sky_at_the_centre_of_the_bottom(example):
    import luzespecular as luz

    pipes = example("mirror_light_pipe.py")
    width, length = pipes.WIDTH, 2 * pipes.WIDTH
    result = luz.prepare(pipes.pipe(length), max_area=0.005, specular_cutoff=1e-5).solve(
        luz.Daylight(sky=luz.UniformSky(1 / math.pi))
    )
    exact = 0.0
    for i in range(-60, 61):
        for j in range(-60, 61):
            edges = [(k + s) * width for k in (i, j) for s in (-0.5, 0.5)]
            signed = [math.copysign(corner_factor(abs(x), abs(y), length), x * y) for x in edges[:2] for y in edges[2:]]
            exact += pipes.REFLECTANCE ** (abs(i) + abs(j)) * (signed[3] - signed[2] - signed[1] + signed[0])
    assert result.at([[width / 2, width / 2, 0]], [[0, 0, 1]])[0] == pytest.approx(exact, rel=5e-3)
    steps = width * (0.05 + 0.1 * np.arange(10))
    grid = np.array([[x, y, 0.0] for x in steps for y in steps])
    points = result.at(grid, np.broadcast_to([0.0, 0.0, 1.0], grid.shape))
    assert result.mean("bottom") == pytest.approx(points.mean(), rel=5e-3)
