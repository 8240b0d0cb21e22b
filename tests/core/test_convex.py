"""Closed convex rooms: form factors without looking, exact, and only where nothing can stand in the way."""

import numpy as np
import pytest
from builders import DARK, box, box_polygons, lambert_form_factor, prepare_coarse, scene_of
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import convex, polygons
from luzespecular.convex import ConvexRoom, borders

WHITE = luz.Material(diffuse_reflectance=0.5)
LAMP = luz.Material(diffuse_reflectance=0.5, exitance=100.0)
MIRROR = luz.Material(specular_reflectance=0.8)
UP = np.array([0, 0, 3.0])
SIDE = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]


def triangles_of(*squares):
    """Two triangles for each unit square, by its corner nearest the origin."""
    found = []
    for x, y in squares:
        a, b, c, d = [x, y, 0], [x + 1, y, 0], [x + 1, y + 1, 0], [x, y + 1, 0]
        found += [[a, b, c], [a, c, d]]
    return np.array(found, float)


def ball(divisions=1, material=LAMP):
    """Closed polyhedron of 20 · 4^divisions facets that look inwards."""
    g = (1 + 5**0.5) / 2
    a = np.array([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0]], float)
    points = np.concatenate([a, a[:, [2, 0, 1]], a[:, [1, 2, 0]]])
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    facets = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if max(apart[i, j], apart[j, k], apart[i, k]) < 2.1
    ]
    corners = points[np.array(facets)]
    for _ in range(divisions):
        m = 0.5 * (corners + np.roll(corners, -1, axis=1))
        parts = [np.stack([corners[:, k], m[:, k], m[:, k - 1]], axis=1) for k in range(3)]
        corners = np.concatenate([m, *parts])
    corners /= np.linalg.norm(corners, axis=2, keepdims=True)
    outward = np.einsum("fc,fc->f", polygons.newell_normal(corners), corners.mean(axis=1)) > 0
    corners[outward] = corners[outward, ::-1]
    scene = luz.Scene()
    for number, facet in enumerate(corners):
        scene.add(f"facet {number}", facet, material)
    return scene


@pytest.mark.parametrize(
    ("squares", "sides"),
    [
        ([(0, 0)], 4),
        ([(x, y) for x in range(4) for y in range(3)], 4),
        ([(0, 0), (1, 0), (0, 1)], 6),
        ([(x, y) for x in range(3) for y in range(3) if (x, y) != (1, 1)], 8),
        ([(0, 0), (1, 1)], 8),
    ],
)
def test_borders_are_as_few_sides_as_can_be(squares, sides):
    owner, begin, end = borders(triangles_of(*squares), np.zeros(2 * len(squares), int), 10.0)
    assert len(owner) == len(begin) == sides
    area = 0.5 * polygons.cross(begin, end)[:, 2].sum()
    assert area == pytest.approx(len(squares), rel=1e-12)


def test_borders_part_groups():
    owner, begin, end = borders(triangles_of((0, 0), (1, 0)), np.array([0, 0, 1, 1]), 10.0)
    assert owner.tolist() == [0] * 4 + [1] * 4
    for group in (0, 1):
        mine = owner == group
        assert 0.5 * polygons.cross(begin[mine], end[mine])[:, 2].sum() == pytest.approx(1.0)


@settings(max_examples=15, deadline=None)
@given(st.tuples(*[st.floats(1.0, 2.0)] * 3), st.integers(0, 2**32 - 1))
def test_factors_are_those_of_each_triangle_by_itself(size, seed):
    transfer = prepare_coarse(box(WHITE, size), elements=60, patches=30)
    geometry, nodes = transfer.geometry, transfer.nodes
    room = ConvexRoom.of(geometry, nodes)
    node = np.random.default_rng(seed).integers(len(nodes.points))
    normal = geometry.element_normals[nodes.element[node]]
    found = room.factors(nodes.points[[node]], normal)[0]
    cuts = geometry.fracture
    facing = cuts.element_sheet != nodes.sheet[node]
    each = lambert_form_factor(cuts.elements - nodes.points[node], normal)
    patch = geometry.targets.patches.of_element
    told = np.bincount(patch[facing], weights=each[facing], minlength=len(found) - 1)
    np.testing.assert_allclose(found[:-1], told, atol=1e-9)
    assert found.sum() == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("scene", [box(WHITE, (3, 2, 1), ceiling=LAMP), ball()], ids=["box", "ball"])
def test_looking_finds_the_same_light(scene, request):
    exact = prepare_coarse(scene, bands=40)
    assert exact.unhidden and any(stage.name == "occlusion" and stage.skipped for stage in exact.stages)
    request.getfixturevalue("by_globe")
    by_globe = prepare_coarse(scene, bands=40)
    assert not by_globe.unhidden
    one, other = exact.solve(DARK), by_globe.solve(DARK)
    for name, values in one.components.items():
        np.testing.assert_allclose(values, other.components[name], rtol=1e-2, err_msg=name)
        assert values.mean() == pytest.approx(other.components[name].mean(), rel=2e-3)


def test_even_light_in_a_ball_is_even():
    result = prepare_coarse(ball(divisions=2)).solve(DARK, tolerance=1e-8)
    np.testing.assert_allclose(result.illuminance, 200.0, rtol=2e-6)
    np.testing.assert_allclose(result.at([[0.1, 0.2, 0.0]], [[0, 0, 1.0]]), 200.0, rtol=2e-3)  # by the globe
    some = slice(0, None, 500)
    np.testing.assert_allclose(result.at(result.centroids[some], result.normals[some]), 200.0, rtol=2e-6)


def test_black_surfaces_of_closed_rooms_count_as_seen():
    transfer = prepare_coarse(box(WHITE, ceiling=LAMP, floor=luz.Material()))
    assert transfer.unhidden
    assert abs(transfer.solve(DARK).balance.defect) < 1e-6


def test_their_globe_errs_nowhere():
    transfer = prepare_coarse(box(WHITE, ceiling=LAMP))
    result = transfer.solve(DARK)
    assert np.isfinite(result.error).all()
    even = transfer.errors_by_globe()
    assert even.max() < 1e-5


def test_saved_rooms_stay_unhidden(tmp_path):
    scene = box(WHITE, ceiling=LAMP)
    transfer = prepare_coarse(scene)
    with pytest.MonkeyPatch.context() as patch:
        from luzespecular import fracture, geometry

        patch.setattr(fracture, "FEWEST_ELEMENTS", 200)
        patch.setattr(fracture, "ELEMENTS_PER_PLAIN_SURFACE", 20)
        patch.setattr(geometry, "PATCHES", 100)
        again = luz.load(transfer.save(tmp_path / "room.npz"), scene)
    assert again.unhidden
    np.testing.assert_array_equal(again.solve(DARK).illuminance, transfer.solve(DARK).illuminance)


def with_box_inside():
    scene = box(WHITE, (3, 3, 3), ceiling=LAMP)
    for name, polygon in box_polygons((0.5, 0.5, 0.5), (1, 1, 0)).items():
        scene.add(f"box {name}", polygon[::-1], WHITE)
    return scene


def with_slit():
    scene = box(WHITE, (4, 4, 3), without=("floor",), ceiling=LAMP)
    scene.add("floor", [[0, 0, 0], [3.999, 0, 0], [3.999, 4, 0], [0, 4, 0]], WHITE)
    return scene


def with_floor_twice():
    scene = box(WHITE, (4, 4, 3), ceiling=LAMP)
    scene.add("carpet", SIDE, WHITE)
    return scene


def with_two_sides():
    scene = box(WHITE, (4, 4, 3), without=("floor",), ceiling=LAMP)
    scene.add("floor", SIDE, WHITE, two_sided=True)
    return scene


def l_shaped():
    floor = np.array([[0, 0, 0], [4, 0, 0], [4, 2, 0], [2, 2, 0], [2, 4, 0], [0, 4, 0]], float)
    scene = luz.Scene()
    scene.add("floor", floor, WHITE)
    scene.add("ceiling", floor[::-1] + UP, LAMP)
    for k in range(len(floor)):
        a, b = floor[k], floor[(k + 1) % len(floor)]
        scene.add(f"wall {k}", [a, a + UP, b + UP, b], WHITE)
    return scene


@pytest.mark.parametrize(
    "scene",
    [
        box(WHITE, without=("north",), ceiling=LAMP),
        box(WHITE, floor=MIRROR, ceiling=LAMP),
        scene_of({k: v[::-1] for k, v in box_polygons().items()}, LAMP),
        with_box_inside(),
        with_slit(),
        with_floor_twice(),
        with_two_sides(),
        l_shaped(),
    ],
    ids=["open", "mirror", "seen from outside", "not empty", "slit", "floor twice", "two sides", "re-entrant"],
)
def test_others_are_looked_at(scene):
    transfer = prepare_coarse(scene, bands=10, elements=60, patches=40)
    assert not transfer.unhidden
    assert not any(stage.name == "occlusion" for stage in transfer.stages)


def test_the_sample_meets_all_planes(monkeypatch):
    monkeypatch.setattr(convex, "_SOME", 10_000)
    transfer = prepare_coarse(box(WHITE, ceiling=LAMP), elements=60, patches=40)
    assert ConvexRoom.of(transfer.geometry, transfer.nodes) is not None
