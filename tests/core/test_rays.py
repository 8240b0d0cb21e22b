"""Single rays against a search of every polygon."""

import numpy as np
import pytest
from builders import box_polygons, first_hits

from luzespecular import polygons
from luzespecular.rays import RayScene


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
