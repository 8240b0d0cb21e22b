"""Rims: slits of sky beside meshes: exact ones are seen below a flat ceiling."""

import numpy as np
import pytest
from builders import BLACK, box, prepare_coarse

import luzespecular as luz
from luzespecular import facets, rims
from luzespecular.arrays import box_corners
from luzespecular.globe import Globe

EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))


def below(divisions: int, bands: int) -> float:
    """What a small floor gets past the rim of a wide ceiling, flat or of triangles that are no plane by a hair."""
    scene = luz.Scene()
    scene.add("floor", 0.1 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), BLACK)
    steps = np.linspace(-5, 5, divisions + 1)
    x, y = (v.ravel() for v in np.meshgrid(steps, steps))
    z = 1 + 1e-3 * np.sin(3 * x) * np.cos(2 * y) * (divisions > 1)
    first = (np.arange(divisions)[:, None] * (divisions + 1) + np.arange(divisions)).ravel()
    faces = first[:, None] + np.array([[0, divisions + 2, 1], [0, divisions + 1, divisions + 2]])[:, None]
    scene.add("ceiling", np.stack([x, y, z], axis=1), BLACK, faces=faces.reshape(-1, 3))
    return prepare_coarse(scene, elements=20, bands=bands).solve(EVEN).mean("floor")


@pytest.mark.parametrize("bands", [24])
def test_a_slit_of_sky_below_a_mesh(bands):
    np.testing.assert_allclose(below(20, bands), below(1, 60), rtol=0.05)


def test_tiles_beside_silhouettes():
    """Around a disc of facets at the zenith a ring is mixed, and nothing where much is seen of the sky."""
    globe = Globe(24)
    up = np.flatnonzero(globe.directions[:, 2] > 0)
    polar = globe.polar[up]
    met = (polar < 0.5)[None]
    some = rims.mixed_tiles(globe, up, met, ~met, np.full(met.shape, 0.05 / len(up)))
    mixed = polar[some[0]]
    high = np.pi / 24
    assert len(mixed) > 20
    assert (np.abs(mixed - 0.5) < 1.5 * high).all()
    assert not rims.mixed_tiles(globe, up, met, ~met, np.full(met.shape, 1 / len(up))).any()


@pytest.mark.parametrize("times", [1, 3])
def test_slits_beside_solids_whose_far_sides_are_large(monkeypatch, times):
    """Behind a front of small facets stand backs that nobody looks for: no ray that meets one comes through."""
    scene = box(BLACK, (3, 3, 3), without=("north",))
    low, high = np.array([0.1, 2.2, 0.05]), np.array([2.9, 2.7, 2.8])
    corners = np.append(box_corners(low, high), [[1.5, 2.2, 1.4]], axis=0)
    sides = [(2, 3, 7, 6), (1, 5, 7, 3), (0, 2, 6, 4), (0, 1, 3, 2), (4, 6, 7, 5)]
    front = [(0, 4, 8), (4, 5, 8), (5, 1, 8), (1, 0, 8)]
    halves = [half for a, b, c, d in sides for half in ((a, b, c), (a, c, d))]
    corners[8, 1] -= 0.01  # four planes
    scene.add("cabinet", corners, BLACK, faces=halves + front)
    one = prepare_coarse(scene, elements=100, bands=60).solve(EVEN)
    monkeypatch.setattr(facets, "MANY_OUTLINES", 5)
    monkeypatch.setattr(facets, "_FEWEST_LARGE", 10)
    monkeypatch.setattr(facets, "_MOST_LARGE", 10)
    monkeypatch.setattr(facets, "_FINENESS", ((None, times),))
    transfer = prepare_coarse(scene, elements=100, bands=60)
    assert len(transfer.geometry.outlines.facets.small) == 4
    other = transfer.solve(EVEN)
    for name in ("south", "floor", "ceiling"):
        assert other.mean(name) == pytest.approx(one.mean(name), rel=0.03)
