"""Closed solids: found whatever they are made of, and their far sides not looked for where nobody can see them."""

import numpy as np
import pytest
from builders import UNIFORM, box, box_polygons, prepare_coarse, scene_of
from hypothesis import given, settings
from hypothesis import strategies as st
from test_convex import ball

import luzespecular as luz
from luzespecular.planes import find_planes
from luzespecular.solids import Solids, find_solids

WHITE = luz.Material(diffuse_reflectance=0.5)
PANE = luz.Material(regular_transmittance=0.8)


def block(size=(1.0, 1.0, 1.0), origin=(-0.5, -0.5, -0.5)):
    """Sides of a box, normals outwards."""
    return {f"block {name}": polygon[::-1] for name, polygon in box_polygons(size, origin).items()}


def solids_of(scene):
    opaque = np.array([not s.material.is_transparent for s in scene.surfaces.values()])
    return find_solids(find_planes(scene), opaque)


def room_with(polygons, material=WHITE):
    scene = box(WHITE, (3, 3, 3), without=("north",))
    for name, polygon in polygons.items():
        scene.add(name, polygon, material)
    return scene


def test_a_block_of_separate_surfaces_is_one_solid():
    solids = solids_of(room_with(block((0.5, 0.5, 0.5), (1, 1, 1))))
    assert len(solids.solids) == 1
    np.testing.assert_array_equal(solids.of_outline, [-1] * 5 + [0] * 6)


def test_a_mesh_of_many_facets_is_one_solid():
    facets = np.concatenate([s.pieces for s in ball(2).surfaces.values()])[:, ::-1]
    scene = luz.Scene()
    scene.add("ball", facets.reshape(-1, 3), WHITE, faces=np.arange(facets.size // 3).reshape(-1, 3))
    solids = solids_of(scene)
    assert len(solids.solids) == 1 and (solids.of_outline == 0).all()


def test_solids_are_told_apart():
    solids = solids_of(scene_of({**block(), **{f"{k} 2": v for k, v in block(origin=(2, 0.5, 0.3)).items()}}))
    assert len(solids.solids) == 2
    assert sorted(np.bincount(solids.of_outline)) == [6, 6]


@pytest.mark.parametrize(
    "scene",
    [
        box(WHITE),
        scene_of({k: v for k, v in block().items() if k != "block floor"}),
        scene_of(block(), WHITE, **{"block floor": PANE}),
        scene_of({**block(), "again": block()["block floor"]}),
        scene_of({**block(), "block west": block()["block west"][::-1]}),
    ],
    ids=["room", "open", "with a pane", "a side twice", "a side inside out"],
)
def test_what_is_not_closed_all_around_is_no_solid(scene):
    solids = solids_of(scene)
    assert not solids.solids and (solids.of_outline == -1).all()


@settings(max_examples=60, deadline=None)
@given(st.tuples(*[st.floats(-1, 1)] * 3))
def test_points_inside_and_outside(point):
    (solid,) = solids_of(scene_of(block())).solids
    if np.abs(np.abs(point) - 0.5).min() > 1e-6:
        inside = np.abs(point).max() < 0.5
        assert solid.all_outside(np.array([point])) != inside


def test_one_inside_is_enough():
    (solid,) = solids_of(scene_of(block())).solids
    assert not solid.all_outside(np.array([[2, 2, 2], [0.2, 0.1, 0.3]]))


def test_hollows_of_a_solid_are_outside():
    floor = np.array([[0, 0, 0], [3, 0, 0], [3, 3, 0], [2, 3, 0], [2, 1, 0], [1, 1, 0], [1, 3, 0], [0, 3, 0]], float)
    floor -= [1.5, 1.5, 0.5]  # scenes are kept relative to their middle
    up = np.array([0, 0, 1.0])
    scene = luz.Scene()
    scene.add("bottom", floor[::-1], WHITE)
    scene.add("top", floor + up, WHITE)
    for k in range(len(floor)):
        a, b = floor[k], floor[(k + 1) % len(floor)]
        scene.add(f"side {k}", [a, b, b + up, a + up], WHITE)
    (solid,) = solids_of(scene).solids
    assert solid.all_outside(np.array([[0, 0.5, 0]]))
    assert not solid.all_outside(np.array([[-1, 0.5, 0]]))


def looked_at_wholly(scene, monkeypatch, **options):
    with monkeypatch.context() as patch:
        patch.setattr(Solids, "unseen_backs", lambda self, *_: np.zeros(len(self.of_outline), bool))
        return prepare_coarse(scene, **options)


@pytest.mark.parametrize("mirrored", [False, True])
def test_far_sides_change_no_light(monkeypatch, mirrored):
    scene = room_with(block((0.6, 0.8, 1.1), (1.1, 0.9, 0.4)))
    if mirrored:
        glass = luz.Material(specular_reflectance=0.8)
        scene.add("mirror", [[2.99, 0.5, 0.5], [2.99, 2.5, 0.5], [2.99, 2.5, 2.5], [2.99, 0.5, 2.5]], glass)
    quick = prepare_coarse(scene, bands=40).solve(UNIFORM)
    whole = looked_at_wholly(scene, monkeypatch, bands=40).solve(UNIFORM)
    for name in quick.surfaces:
        assert quick.mean(name) == pytest.approx(whole.mean(name), rel=3e-3, abs=0.5), name
    if not mirrored:  # whose own back is dark
        assert quick.balance.unlit < 1e-3 * quick.balance.entering


def test_no_light_is_lost_behind_a_balls_facets(monkeypatch):
    facets = np.concatenate([s.pieces for s in ball(1).surfaces.values()])[:, ::-1] * 0.6 + [1.5, 1.5, 1.2]
    scene = room_with({})
    scene.add("ball", facets.reshape(-1, 3), WHITE, faces=np.arange(facets.size // 3).reshape(-1, 3))
    quick = prepare_coarse(scene, bands=30).solve(UNIFORM)
    whole = looked_at_wholly(scene, monkeypatch, bands=30).solve(UNIFORM)
    finer = prepare_coarse(scene, bands=90).solve(UNIFORM)
    assert quick.balance.unlit < 1e-6 * quick.balance.entering < whole.balance.unlit
    for result in (quick, whole):
        assert result.mean("ball") == pytest.approx(finer.mean("ball"), rel=1e-3)


def test_what_a_block_stands_on_stays_dark():
    scene = room_with(block((1, 1, 1), (1, 1, 0)))
    result = prepare_coarse(scene, max_area=0.02).solve(UNIFORM)
    floor = result.faces_of("floor")
    place = result.centroids[floor]
    under = ((place[:, :2] > 1.05) & (place[:, :2] < 1.95)).all(axis=1)
    assert under.sum() > 10
    assert result.illuminance[floor][under].max() < 1e-2 * result.illuminance[floor][~under].mean()
