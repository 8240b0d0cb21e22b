"""Facets in their tens of thousands share receivers."""

import numpy as np
from builders import UNIFORM, box, prepare_coarse
from test_convex import ball

import luzespecular as luz
from luzespecular import clusters, nodes
from luzespecular.clusters import clustered

WHITE = luz.Material(diffuse_reflectance=0.5)


def facets(count, seed=0):
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(count, 3))
    return rng.uniform(size=(count, 3)), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_no_more_groups_than_asked_for_and_none_without_a_middle():
    points, normals = facets(5_000)
    surface = np.arange(5_000) % 2
    group, middle = clustered(points, normals, surface, 1_500)
    assert 500 < len(middle) <= 1_500
    np.testing.assert_array_equal(group[middle], np.arange(len(middle)))


def test_groups_are_of_one_surface_face_alike_and_lie_together():
    points, normals = facets(3_000)
    points[:, 0] *= 100
    surface = np.arange(3_000) % 3
    group, middle = clustered(points, normals, surface, 2_500)
    own = middle[group]
    np.testing.assert_array_equal(surface[own], surface)
    assert np.einsum("kc,kc->k", normals[own], normals).min() > 0.6
    assert np.abs(points[own] - points).max() < 25


def test_few_facets_stay_by_themselves():
    points, normals = facets(40)
    group, middle = clustered(points, normals, np.zeros(40, int), 40)
    assert len(middle) == 40 and len(set(group.tolist())) == 40


def test_shared_receivers_give_nearly_the_same_light(monkeypatch):
    """A ball of 1,280 facets with 400 receivers."""
    corners = np.concatenate([s.pieces for s in ball(3).surfaces.values()])[:, ::-1] * 0.5 + [1.5, 1.2, 1.0]
    scene = box(WHITE, (3, 3, 3), without=("north",))
    scene.add("ball", corners.reshape(-1, 3), WHITE, faces=np.arange(corners.size // 3).reshape(-1, 3))
    own = prepare_coarse(scene, bands=16)
    monkeypatch.setattr(nodes, "MANY_FACETS", 1_000)
    monkeypatch.setattr(nodes, "_SHARED", 400)
    shared = prepare_coarse(scene, bands=16)
    assert len(shared.nodes.points) < len(own.nodes.points) - 800
    one, other = own.solve(UNIFORM), shared.solve(UNIFORM)
    ball_ = one.faces_of("ball")
    assert abs(other.mean("ball") / one.mean("ball") - 1) < 0.01
    assert abs(other.mean("floor") / one.mean("floor") - 1) < 0.003
    apart = other.illuminance[ball_] - one.illuminance[ball_]
    assert np.sqrt(np.mean(apart**2)) < 0.1 * one.mean("ball")
    assert abs(other.balance.defect) < 2e-3


def test_the_limit_is_where_it_says():
    assert clusters.MANY_FACETS == nodes.MANY_FACETS == 20_000
