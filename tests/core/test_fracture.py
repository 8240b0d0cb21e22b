"""Fracture: areas, sizes, what is cut and what is not."""

import math

import numpy as np
import pytest
from builders import BLACK, box, box_polygons, scene_of
from hypothesis import given
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import fracture as fracture_room
from luzespecular import polygons
from luzespecular.fracture import Triangles, cut_pieces, fracture, halve
from luzespecular.planes import find_planes

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.9)


def cuts_of(scene, max_area):
    surfaces = list(scene.surfaces.values())
    cut = [s.material.diffuse_reflectance > 0 or s.material.exitance > 0 for s in surfaces]
    return fracture(find_planes(scene), cut, cut, [s.two_sided for s in surfaces], max_area)


def count(cuts, surface):
    return int((cuts.face_surface == surface).sum())


@given(st.floats(0.01, 5), st.floats(0.01, 5), st.floats(-2, 2), st.floats(1e-3, 10))
def test_parallelograms_are_cut_into_whole_grids(width, height, shear, limit):
    piece = np.array([[[0, 0, 0], [width, 0, 0], [width + shear, height, 0], [shear, height, 0.0]]])
    cut = cut_pieces(piece, [4], [limit])
    assert cut.areas.sum() == pytest.approx(width * height, rel=1e-9)
    assert cut.areas.max() <= limit * (1 + 1e-6)
    assert (polygons.newell_normal(cut.vertices)[:, 2] > 0).all()
    assert (cut.parent == 0).all()


@given(st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=3, max_size=3), st.floats(0.001, 1))
def test_triangles_are_halved_until_small(corners, limit):
    triangle = np.c_[np.array(corners), np.zeros(3)]
    area = float(polygons.areas(triangle))
    if area < 1e-6:
        return
    cut = halve(Triangles(triangle[None], np.array([0])), [limit])
    assert cut.areas.sum() == pytest.approx(area, rel=1e-9)
    assert cut.areas.max() <= limit * (1 + 1e-8)
    assert len(cut.parent) <= max(1, 2 * area / limit * 2)
    centroid = np.average(cut.vertices.mean(axis=1), axis=0, weights=cut.areas)
    np.testing.assert_allclose(centroid, triangle.mean(axis=0), atol=1e-9)


def test_one_limit_for_each_piece():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    pieces, counts = polygons.pad([square, square, square[:3], np.concatenate([square, [[-0.5, 0.5, 0]]])])
    cut = cut_pieces(pieces, counts, [0.005, math.inf, 0.1, math.inf])
    np.testing.assert_allclose(np.bincount(cut.parent, weights=cut.areas), [1, 1, 0.5, 1.25])
    assert np.bincount(cut.parent).tolist() == [200, 2, 8, 3]
    assert (np.diff(cut.parent) >= 0).all()


def test_the_papers_room_has_its_faces(light_shelf):
    """Squares of 7 cm at most, two triangles each: 10,800 for 54 m², and 60 more since 0.75 m is not 7.5 squares."""
    cuts = cuts_of(light_shelf.scene("D"), 0.005)
    assert len(cuts.faces) == 10_860
    assert cuts.face_areas.sum() == pytest.approx(54)
    assert cuts.face_areas.max() <= 0.005 * (1 + 1e-9)
    assert [count(cuts, k) for k in range(9)] == [1800] * 5 + [600, 300, 480, 480]


def test_without_a_limit_some_ten_thousand_faces(light_shelf):
    cuts = cuts_of(light_shelf.scene("D"), None)
    assert 10_000 <= len(cuts.faces) <= 12_000


def test_infinite_limit_only_triangulates(light_shelf):
    cuts = cuts_of(light_shelf.scene("D"), math.inf)
    assert len(cuts.faces) == 18
    hexagon = [[math.cos(k * math.pi / 3), math.sin(k * math.pi / 3), 0] for k in range(6)]
    assert len(cuts_of(scene_of({"hexagon": hexagon}, WHITE), math.inf).faces) == 4


@pytest.mark.parametrize("max_area", [None, 0.005])
def test_black_and_mirrors_are_not_cut_for_their_size(light_shelf, max_area):
    cuts = cuts_of(light_shelf.scene("S2"), max_area)
    names = list(light_shelf.SURFACES)
    assert count(cuts, names.index("ceiling")) == count(cuts, names.index("shelf_top")) == 2
    assert count(cuts, names.index("floor")) >= 1800
    large = scene_of({"plain": [[0, 0, 0], [400, 0, 0], [400, 400, 0], [0, 400, 0]]}, MIRROR)
    assert len(cuts_of(large, max_area).faces) == 2


def test_luminous_surfaces_are_cut():
    scene = box(luz.Material(exitance=10), without=("north",))
    assert len(cuts_of(scene, 0.005).faces) == 5 * 200


@pytest.mark.parametrize("max_area", [1e-9, 1e-5, 1e-320])
def test_a_slip_in_max_area_is_refused_before_cutting(light_shelf, max_area):
    with pytest.raises(luz.SceneError, match=r"max_area .* faces, more than 5,000,000; raise it to .* m² or more"):
        cuts_of(light_shelf.scene("D"), max_area)


def test_the_max_area_that_the_message_asks_for_is_enough(light_shelf, monkeypatch):
    strip = [[0, 0, 0], [100, 0, 0], [100, 1e-3, 0], [0, 1e-3, 0]]  # cells along it: more than by its area
    monkeypatch.setattr(fracture_room, "MOST_FACES", 1000)
    for scene in (light_shelf.scene("D"), scene_of({"strip": strip}, WHITE)):
        with pytest.raises(luz.SceneError) as caught:
            cuts_of(scene, 0.0005)
        enough = float(str(caught.value).split("raise it to ")[1].split()[0])
        assert len(cuts_of(scene, enough).faces) <= 1000
    assert len(cuts_of(box(BLACK), 1e-9).faces) == 12, "what is not cut does not count"
    monkeypatch.setattr(fracture_room, "MOST_FACES", 5)
    assert len(cuts_of(light_shelf.scene("D"), math.inf).faces) == 18, "faces as given are never too many"


def test_elements_resolve_what_is_not_cut():
    cuts = cuts_of(box(BLACK), math.inf)
    assert len(cuts.faces) == 12
    assert (np.bincount(cuts.element_side) >= 32).all()
    assert cuts.element_areas.sum() == pytest.approx(6)


def test_elements_are_parts_of_their_faces():
    cuts = cuts_of(box(WHITE, (3, 2, 1)), 0.05)
    np.testing.assert_allclose(np.bincount(cuts.element_side, weights=cuts.element_areas), cuts.face_areas)
    np.testing.assert_allclose(cuts.side_means(np.ones(len(cuts.elements))), 1)


def test_means_over_sides_are_weighted_by_area():
    cuts = cuts_of(box(WHITE), math.inf)
    values = cuts.elements.mean(axis=1) @ [1.0, 2.0, 3.0]  # linear: its mean is its value at the centroid
    np.testing.assert_allclose(cuts.side_means(values), cuts.faces.mean(axis=1) @ [1.0, 2.0, 3.0], atol=1e-12)


def test_backs_follow_the_fronts():
    scene = luz.Scene()
    scene.add("one", box_polygons()["floor"], WHITE)
    scene.add("two", box_polygons()["ceiling"], WHITE, two_sided=True)
    cuts = cuts_of(scene, 0.1)
    faces = len(cuts.faces)
    np.testing.assert_array_equal(cuts.back_of, np.flatnonzero(cuts.face_surface == 1))
    assert cuts.sides == faces + len(cuts.back_of)
    assert cuts.element_side.max() == cuts.sides - 1
    behind = cuts.element_side >= faces
    assert behind.sum() == (cuts.face_surface[cuts.element_side[~behind]] == 1).sum()
    np.testing.assert_array_equal(cuts.element_sheet[behind], 1 + 2)
    assert (polygons.newell_normal(cuts.elements[behind])[:, 2] > 0).all(), "the ceiling's back looks up"
    by_side = np.bincount(cuts.element_side, weights=cuts.element_areas)
    np.testing.assert_allclose(by_side[faces:], cuts.face_areas[cuts.back_of])


def test_faces_know_the_given_face():
    scene = luz.Scene()
    corners = np.array(list(box_polygons().values()))
    scene.add("box", corners.reshape(-1, 3), WHITE, faces=np.arange(24).reshape(6, 4))
    cuts = cuts_of(scene, 0.05)
    np.testing.assert_allclose(np.bincount(cuts.face_source, weights=cuts.face_areas), np.ones(6))
    inward = corners.mean(axis=1) - 0.5
    towards = np.einsum("fc,fc->f", cuts.face_normals, inward[cuts.face_source])
    assert (towards < 0).all()
