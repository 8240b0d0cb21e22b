"""Beams that many obstacles cross, by rays: the same however many are looked at together."""

import numpy as np
from builders import BLACK, prepare_coarse

import luzespecular as luz
from luzespecular import lattice

SKY = luz.Daylight(sky=luz.UniformSky(1000.0))


def slats(count=24):
    scene = luz.Scene()
    scene.add("floor", [[0, 0, 0], [20, 0, 0], [20, 6, 0], [0, 6, 0]], BLACK)
    for k in range(count):
        y = 0.25 * (k + 0.5)
        scene.add(f"slat {k}", [[0, y, 1], [20, y, 1], [20, y + 0.1, 1.2], [0, y + 0.1, 1.2]], BLACK, two_sided=True)
    return scene


def test_blocks_of_beams_change_nothing(monkeypatch):
    asked, sampled = [], lattice._sampled
    monkeypatch.setattr(lattice, "_sampled", lambda *a: asked.append(len(a[2])) or sampled(*a))
    together = prepare_coarse(slats(), elements=30, bands=12, threads=1).solve(SKY).illuminance
    blocks = len(asked)
    monkeypatch.setattr(lattice, "_BLOCK", 40)
    apart = prepare_coarse(slats(), elements=30, bands=12, threads=1).solve(SKY).illuminance
    assert len(asked) - blocks > 2 * blocks > 0
    assert np.array_equal(together, apart)
