"""Rays along shared directions against each ray by itself."""

import numpy as np
import pytest
from builders import prepare_coarse
from test_convex import ball
from test_rays import leaves, ray_scene

import luzespecular as luz
from luzespecular import bundles, facets
from luzespecular import rays as rays_module
from luzespecular.bundles import Bundle


def from_a_plane(count, rng):
    """Points of a small patch, directions above it, and some of their pairs between two distances."""
    points = [0.4, 0.5, 0.1] + 0.2 * rng.uniform(-1, 1, (count, 3)) * [1, 1, 0]
    directions = rng.normal(size=(400, 3))
    directions[:, 2] = np.abs(directions[:, 2])
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    row, way = np.nonzero(rng.random((count, 400)) < 0.7)
    return points, directions, row, way


@pytest.mark.parametrize("count", [1, 3, 16])
@pytest.mark.parametrize("outlines", [60, 700])
@pytest.mark.parametrize("between", [False, True])
def test_each_ray_meets_what_it_would_by_itself(count, outlines, between, monkeypatch):
    monkeypatch.setattr(bundles, "_PER_SEARCH", np.inf)
    rng = np.random.default_rng(count)
    scene = ray_scene(leaves(outlines))
    points, directions, row, way = from_a_plane(count, rng)
    start = rng.uniform(0, 0.3, len(row)) if between else np.zeros(len(row))
    within = start + rng.uniform(0, 0.6, len(row)) if between else np.full(len(row), np.inf)
    among = scene.above(np.array([[0, 0, 1.0]]), np.array([0.1]))
    bundle = Bundle.of(scene, points, directions, among, len(row))
    assert bundle.way is not None
    outline, distance = bundle.nearest(row, way, start, within)
    origins = points[row] + start[:, None] * directions[way]
    alone, away = scene.nearest(origins, directions[way], within - start, among)
    np.testing.assert_array_equal(outline, alone)
    np.testing.assert_allclose(distance, away + start, rtol=1e-9)
    assert 0 < np.count_nonzero(outline >= 0) < len(outline)
    assert np.broadcast_to(bundle.may_meet(), (count, 400))[row, way][outline >= 0].all()


def test_of_very_many_outlines_each_ray_looks_for_its_own():
    """Some receivers side by side, and a thicket around them: what may be met from some is far more than any meets."""
    rng = np.random.default_rng(0)
    scene = ray_scene([0.02 * leaf for leaf in leaves(8_000)])
    points, directions, row, way = from_a_plane(16, rng)
    points *= 0.02
    among = scene.above(np.array([[0, 0, 1.0]]), np.array([-1.0]))
    bundle = Bundle.of(scene, points, directions, among, len(row))
    assert bundle.way is None
    outline, distance = bundle.nearest(row, way, np.zeros(len(row)), np.full(len(row), np.inf))
    alone, away = scene.nearest(points[row], directions[way])
    np.testing.assert_array_equal(outline, alone)
    np.testing.assert_array_equal(distance, away)
    assert np.broadcast_to(bundle.may_meet(), (16, 400))[row, way][outline >= 0].all()


def test_few_rays_go_down_the_tree_between_meshes(monkeypatch):
    """A ball in a ball: without bundles each receiver would look for what is met along each parcel by itself."""
    rays = 0
    alone = rays_module.RayScene.nearest

    def counted(self, points, directions, within=np.inf, among=None):
        nonlocal rays
        rays += 0 if among is None else len(points)
        return alone(self, points, directions, within, among)

    monkeypatch.setattr(rays_module.RayScene, "nearest", counted)
    monkeypatch.setattr(facets, "MANY_OUTLINES", 50)
    monkeypatch.setattr(facets, "_MOST_LARGE", 1)
    scene = luz.Scene()
    inward = np.array([surface.pieces[0][:3] for surface in ball(1).surfaces.values()])
    for name, size, turn in (("outer", 2.0, 1), ("inner", 1.0, -1)):
        corners = size * inward[:, ::turn].reshape(-1, 3)
        scene.add(name, corners, luz.Material(diffuse_reflectance=0.5), faces=np.arange(len(corners)).reshape(-1, 3))
    transfer = prepare_coarse(scene, bands=16)
    parcels = transfer.geometry.beams.count // 2
    assert transfer.geometry.outlines.facets is not None
    assert rays < 0.1 * len(transfer.nodes.points) * parcels
