"""Facets that rays find before large outlines: as if all were projected, but for what a ray stands for."""

import numpy as np
import pytest
from builders import box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st
from test_convex import ball

import luzespecular as luz
from luzespecular import facets
from luzespecular.rays import RayScene

GREY = luz.Material(diffuse_reflectance=0.5)
OVERCAST = luz.Daylight(sky=luz.CIESky(1, horizontal_illuminance=10_000.0))


def with_ball(divisions, radius=0.5, centre=(1.5, 1.4, 0.9), material=GREY, **materials):
    """A room, open to the north, with a ball of ``20 · 4^divisions`` facets."""
    scene = box(GREY, (3, 3, 3), without=("north",), **materials)
    pieces = [np.array(surface.pieces[0][:3]) for surface in ball(divisions).surfaces.values()]
    corners = np.concatenate([piece[::-1] for piece in pieces]) * radius + np.array(centre)
    scene.add("ball", corners, material, faces=np.arange(len(corners)).reshape(-1, 3))
    return scene


def by_rays(monkeypatch, times=1, large=6):
    monkeypatch.setattr(facets, "MANY_OUTLINES", 50)
    monkeypatch.setattr(facets, "_FEWEST_LARGE", large)
    monkeypatch.setattr(facets, "_FINENESS", ((None, times),))


@pytest.mark.parametrize(("times", "rms"), [(1, 0.006), (3, 0.04)])
def test_facets_by_rays_are_as_if_projected(monkeypatch, times, rms):
    scene = with_ball(1)
    one = prepare_coarse(scene, elements=300, bands=60).solve(OVERCAST)
    by_rays(monkeypatch, times)
    other = prepare_coarse(scene, elements=300, bands=60)
    assert len(other.geometry.outlines.facets.small) == 80, "not one of the ball's, all alike, is projected"
    other = other.solve(OVERCAST)
    apart = other.illuminance / one.illuminance - 1
    assert not np.array_equal(one.illuminance, other.illuminance), "two ways"
    assert np.sqrt((apart**2).mean()) < rms
    for name in ("ball", "floor", "south"):
        assert other.mean(name) == pytest.approx(one.mean(name), rel=0.01)


@pytest.mark.parametrize("times", [1, 3])
@pytest.mark.parametrize("kind", ["mirror", "mirror ball", "pane", "plain"])
def test_nothing_is_lost_or_found_twice(monkeypatch, kind, times):
    """Whatever is mirrored or seen through glass: all that a receiver sees adds up to one."""
    mirror, pane = luz.Material(specular_reflectance=1.0), luz.Material(regular_transmittance=1.0)
    scene = with_ball(1, material=mirror if kind == "mirror ball" else GREY, south=mirror if kind == "mirror" else GREY)
    if kind == "pane":
        scene.add("pane", [[0, 2, 0], [3, 2, 0], [3, 2, 3], [0, 2, 3]], pane)
    by_rays(monkeypatch, times)
    transfer = prepare_coarse(scene, elements=60, patches=40, bands=24)
    assert transfer.geometry.outlines.facets is not None
    sums = transfer.form_factors.sum(axis=1) + transfer.truncated + transfer.unlit
    sums += transfer.sky_direct.dense().sum(axis=1) + transfer.sky_specular.dense().sum(axis=1)
    np.testing.assert_allclose(sums, 1, atol=2e-3)


def test_a_mirror_shows_facets_where_they_are(monkeypatch):
    """A luminous ball lights the wall beside it straight and by a mirror opposite."""
    lamp = luz.Material(exitance=1000.0)
    scene = with_ball(1, material=lamp, south=luz.Material(specular_reflectance=0.9))
    one = prepare_coarse(scene, elements=300, bands=60)
    by_rays(monkeypatch)
    other = prepare_coarse(scene, elements=300, bands=60)
    dark = luz.Daylight()
    for name in ("floor", "east", "ceiling"):
        assert other.solve(dark).mean(name) == pytest.approx(one.solve(dark).mean(name), rel=0.01)


@given(st.integers(0, 1_000))
@settings(max_examples=20, deadline=None)
def test_a_pruned_tree_finds_what_stands_above(seed):
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-1, 1, (300, 1, 3)) + 0.1 * rng.normal(size=(300, 3, 3))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    rays = RayScene(corners, normals, np.einsum("oc,oc->o", normals, corners[:, 0]), 1e-12)
    up = rng.normal(size=3)
    up /= np.linalg.norm(up)
    points = rng.uniform(-1, 1, (200, 3))
    points -= np.outer(points @ up - 0.3, up)  # all in one plane
    directions = rng.normal(size=(200, 3))
    directions *= np.sign(directions @ up)[:, None]
    for tree in (rays.above([up], [0.3]), rays._tree.above([up], [0.3])):
        outline, distance = rays.nearest(points, directions, among=tree)
        every, far = rays.nearest(points, directions)
        np.testing.assert_array_equal(outline, every)
        np.testing.assert_array_equal(distance, far)
        met = outline >= 0
        assert tree.may_meet(points, directions)[np.arange(200), np.arange(200)][met].all()
    assert rays.above([up], [10.0]).is_empty
    near, _ = rays.nearest(points, directions, within=0.5 * far)
    assert (near == -1).all()


def test_of_a_mesh_of_even_facets_none_is_projected():
    """Beside one that is, rays to what it leaves of a parcel would pass through its place: a closed ball would leak."""
    corners = np.array([surface.pieces[0][:3] for surface in ball(2).surfaces.values()]).reshape(-1, 3)
    scene = luz.Scene()
    scene.add("ball", corners, GREY, faces=np.arange(960).reshape(-1, 3))
    scene.add("leaf", [[0, 0, 0], [0.3, 0, 0], [0, 0.3, 0.1]], GREY, two_sided=True)
    transfer = prepare_coarse(scene, bands=8)
    assert not len(transfer.geometry.outlines.facets.large)
    assert not transfer.sky_direct.any()
    np.testing.assert_allclose(transfer.form_factors.sum(axis=1), 1.0, atol=1e-5)
