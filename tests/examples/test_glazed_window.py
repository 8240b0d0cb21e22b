"""The glazed room against the textbook pane: Fresnel's equations, the whole inner series, unpolarised mean."""

import math

import numpy as np
import pytest


def pane_transmittance(angle, index, normal_transmittance):
    """Sum the series of inner reflections numerically, for each polarisation (Born & Wolf; Duffie & Beckman)."""

    def through(theta, bulk):
        inner = math.asin(math.sin(theta) / index)
        c, d = math.cos(theta), math.cos(inner)
        total = 0.0
        for r in ((c - index * d) / (c + index * d), (index * c - d) / (index * c + d)):
            loss = bulk ** (1 / d)
            total += 0.5 * sum((1 - r * r) ** 2 * loss * (r * r * loss) ** (2 * k) for k in range(60))
        return total

    low, high = 0.0, 1.0
    for _ in range(80):
        bulk = (low + high) / 2
        low, high = (bulk, high) if through(0.0, bulk) < normal_transmittance else (low, bulk)
    return through(angle, bulk)


def test_sunlight_through_the_pane(example):
    import luzespecular as luz

    study = example("glazed_window.py")
    sun = np.array([0.2, 0.75, 0.4]) / np.linalg.norm([0.2, 0.75, 0.4])
    light = luz.Daylight(sun=luz.Sun(direction=sun, normal_illuminance=50_000))
    spot = np.array([2.0, 5.0, 1.7]) - sun / sun[2] * 1.7  # where the middle of the window stands on the floor
    result = luz.prepare(study.room(True), max_area=0.2).solve(light, cycles=0)
    transmittance = pane_transmittance(math.acos(sun[1]), study.INDEX, study.NORMAL_TRANSMITTANCE)
    assert result.at([spot], [[0, 0, 1]])[0] == pytest.approx(50_000 * sun[2] * transmittance, rel=1e-3)


def test_uniform_sky_just_inside_the_pane(example):
    import luzespecular as luz

    study = example("glazed_window.py")
    sky = luz.Daylight(sky=luz.UniformSky(1_000))
    angles = (np.arange(2000) + 0.5) * math.pi / 4000
    through = np.array([pane_transmittance(a, study.INDEX, study.NORMAL_TRANSMITTANCE) for a in angles])
    hemispherical = float(np.sum(through * np.sin(2 * angles)) * math.pi / 4000)
    result = luz.prepare(study.room(True), max_area=0.2).solve(sky, cycles=0)
    found = result.at([[2.0, 4.999, 1.7]], [[0, 1, 0]])[0]
    assert found == pytest.approx(math.pi * 1_000 / 2 * hemispherical, rel=5e-3)
