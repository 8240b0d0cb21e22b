"""Rims: slits of sky beside meshes: exact ones are seen below a flat ceiling."""

import numpy as np
import pytest
from builders import BLACK, prepare_coarse

import luzespecular as luz
from luzespecular import rims
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
