"""Single rays against a search of every polygon."""

import numpy as np
import pytest
from builders import box_polygons, first_hits

from luzespecular import polygons
from luzespecular.rays import RayScene
from luzespecular.tree import Tree


def ray_scene(outlines):
    padded, _ = polygons.pad([np.asarray(o, float) for o in outlines])
    normals = polygons.newell_normal(padded)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return RayScene(padded, normals, np.einsum("oc,oc->o", normals, padded[:, 0]), 1e-9)


def leaves(count, seed=0):
    rng = np.random.default_rng(seed)
    centre = rng.uniform(0, 1, (count, 1, 3))
    return list(centre + rng.normal(0, 0.08, (count, 3, 3)))


@pytest.mark.parametrize("count", [1, 20, 49, 300])
def test_nearest_of_scattered_triangles(count):
    """Few outlines are searched one by one, many by a tree."""
    outlines = leaves(count)
    scene = ray_scene(outlines)
    rng = np.random.default_rng(1)
    for point in ([0.5, 0.5, 0.5], [-1, 0.4, 2], [0.1, 0.9, 0.0]):
        rays = rng.normal(size=(2000, 3))
        found, distance = scene.nearest(np.broadcast_to(point, rays.shape).astype(float), rays)
        np.testing.assert_array_equal(found, first_hits(np.array(point), rays, outlines))
        np.testing.assert_array_equal(np.isinf(distance), found < 0)
        place = point + np.where(found < 0, 0, distance)[:, None] * rays
        met = found >= 0
        off = np.einsum("nc,nc->n", place[met], scene.normals[found[met]]) - scene.offsets[found[met]]
        np.testing.assert_allclose(off, 0, atol=1e-9)


def test_rays_along_the_axes():
    """Directions with zeros, where a slab test divides by them."""
    outlines = [*box_polygons().values(), *(p * 0.5 + 3 for p in leaves(60))]
    scene = ray_scene(outlines)
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    found, distance = scene.nearest(np.full((6, 3), 0.25), axes)
    assert found.tolist() == [5, 3, 1, 4, 2, 0]
    np.testing.assert_allclose(distance, [0.75] * 3 + [0.25] * 3)
    outside, _ = scene.nearest(np.full((3, 3), -1.0), -np.eye(3))
    assert outside.tolist() == [-1, -1, -1]


def test_a_ray_does_not_meet_the_plane_it_starts_in():
    scene = ray_scene(box_polygons().values())
    found, _ = scene.nearest(np.array([[0.5, 0.5, 0.0], [0.0, 0.5, 0.5]]), np.array([[0.1, 0, 1], [1, 0.2, 0.1]]))
    assert found.tolist() == [1, 5]


def test_edges_let_no_ray_through():
    """Aimed at the edges and corners of a closed box, every ray meets something."""
    scene = ray_scene(box_polygons().values())
    corners = np.array(list(box_polygons().values())).reshape(-1, 3)
    rng = np.random.default_rng(2)
    share = rng.uniform(0, 1, (len(corners), 1))
    on_edges = corners * share + np.roll(corners.reshape(6, 4, 3), -1, axis=1).reshape(-1, 3) * (1 - share)
    for targets in (corners, on_edges):
        eye = np.array([0.3, 0.55, 0.41])
        found, _ = scene.nearest(np.broadcast_to(eye, targets.shape), targets - eye)
        assert (found >= 0).all()


@pytest.mark.parametrize("outside", [0, 60])
def test_flights_are_what_single_steps_make_of_them(outside):
    """Between four mirrors, past a leaf, out at the top; with few outlines and with many."""
    walls = box_polygons()
    del walls["ceiling"]
    leaf = np.array([[0.3, 0.3, 0.6], [0.6, 0.4, 0.6], [0.5, 0.7, 0.7]])
    scene = ray_scene([*walls.values(), leaf, *(p * 0.5 + 3 for p in leaves(outside))])
    reflectance = np.zeros((2, len(scene.vertices)))
    reflectance[0, 1:5] = 0.9, 0.8, 0.7, 0.6
    rng = np.random.default_rng(3)
    points, directions = rng.uniform(0.1, 0.9, (500, 3)), rng.normal(size=(500, 3))
    points[:, 2] *= 0.5
    brightness, before = rng.uniform(0.5, 1, 500), rng.integers(0, 3, 500)
    flight = scene.through_mirrors(points, directions, brightness, before, reflectance, 0.05, 8)
    place, way, factor, count = points.copy(), directions.copy(), np.ones(500), np.zeros(500, int)
    faint, flying = np.zeros(500, bool), np.ones(500, bool)
    while flying.any():
        outline, distance = scene.nearest(place, way)
        normal = scene.normals[outline]
        slope = np.einsum("nc,nc->n", normal, way)
        share = np.where((outline >= 0) & (slope < 0), reflectance[0, outline], 0.0)
        flying &= share > 0
        place[flying] += distance[flying, None] * way[flying]
        way[flying] -= 2 * slope[flying, None] * normal[flying]
        factor[flying] *= share[flying]
        count[flying] += 1
        faint |= flying & ((brightness * factor < 0.05) | (before + count >= 8))
        flying &= ~faint
    outline, distance = scene.nearest(place, way)
    np.testing.assert_array_equal(flight.faint, faint)
    assert 0 < faint.sum() < 500 and (flight.outline[~faint] == 0).any() and (flight.outline[~faint] == 5).any()
    np.testing.assert_array_equal(flight.mirrors, count)
    np.testing.assert_allclose(flight.factor, factor, rtol=1e-12)
    np.testing.assert_allclose(flight.points, place, atol=1e-11)
    np.testing.assert_allclose(flight.directions, way, atol=1e-11)
    np.testing.assert_array_equal(flight.outline[~faint], outline[~faint])
    np.testing.assert_allclose(flight.distance[~faint], distance[~faint], rtol=1e-9)


@pytest.mark.parametrize("count", [49, 65, 100, 300])
def test_empty_leaves_of_the_tree_are_never_gone_down(count):
    """Whatever the number of outlines leaves of room in the tree: rays meet few of its boxes."""
    rng = np.random.default_rng(count)
    corners = rng.uniform(-1, 1, (count, 1, 3)) + 0.01 * rng.normal(size=(count, 3, 3))
    tree = Tree.over(corners, 1e-9)
    points, directions = rng.uniform(-1, 1, (200, 3)), rng.normal(size=(200, 3))
    met = []
    tree.search(points, directions, np.full(200, np.inf), lambda ray, outline: met.append(len(ray)))
    assert sum(met) < 0.2 * count * len(points)
    empty = sum(int((boxes[:, 0] > boxes[:, 1]).any(axis=1).sum()) for boxes in tree.boxes)
    assert empty > 0
