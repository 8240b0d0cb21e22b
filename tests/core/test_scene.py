"""Scenes: what surfaces are made of after they are added, and what is refused."""

import logging
import math

import numpy as np
import pytest
from builders import BLACK, box_polygons

import luzespecular as luz
from luzespecular import polygons, rings
from luzespecular.errors import SceneError
from luzespecular.scene import Scene

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
L_SHAPE = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]]
COMB_TOP = [(5, 3), (4, 3), (4, 1), (3, 1), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
COMB = [[0, 0, 0], [5, 0, 0], *([x, y, 0] for x, y in COMB_TOP)]
STAR = [[math.cos(k * math.pi / 5) * (2 - k % 2), math.sin(k * math.pi / 5) * (2 - k % 2), 0] for k in range(10)]
FRAME = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 0], [1, 1, 0], [1, 3, 0], [3, 3, 0], [3, 1, 0], [1, 1, 0]]
TILT = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


def area_of(surface):
    return polygons.areas(surface.pieces).sum()


def normals_of(surface):
    vector = polygons.newell_normal(surface.pieces)
    return vector / np.linalg.norm(vector, axis=1, keepdims=True)


def test_one_convex_polygon_stays_as_given():
    surface = Scene().add("floor", SQUARE, BLACK)
    np.testing.assert_array_equal(surface.pieces, [SQUARE])
    assert surface.counts.tolist() == [4] and surface.source_faces.tolist() == [0]
    assert surface.name == "floor" and surface.material is BLACK and surface.two_sided is False
    np.testing.assert_allclose(normals_of(surface), [[0, 0, 1]])


def test_the_scene_keeps_its_own_copy():
    corners = np.array(SQUARE, float)
    surface = Scene().add("floor", corners, BLACK)
    corners[0] = 99
    np.testing.assert_array_equal(surface.pieces[0, 0], [0, 0, 0])


@pytest.mark.parametrize(
    ("polygon", "area"),
    [(L_SHAPE, 3), (COMB, 11), (STAR, 10 * math.sin(math.pi / 5)), (FRAME, 12)],
    ids=["L", "comb", "star", "frame"],
)
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("turned", [False, True])
def test_concave_polygons_keep_area_and_orientation(polygon, area, reverse, turned):
    corners = np.array(polygon, float)[:: -1 if reverse else 1]
    up = np.array([0, 0, -1.0 if reverse else 1.0])
    if turned:
        corners, up = corners @ TILT.T + [100, -50, 7], TILT @ up
    surface = Scene().add("shape", corners, BLACK)
    assert area_of(surface) == pytest.approx(area, rel=1e-12)
    np.testing.assert_allclose(normals_of(surface), np.broadcast_to(up, (len(surface.pieces), 3)), atol=1e-9)
    given = {tuple(c) for c in corners}
    assert all(tuple(c) in given for c in surface.pieces.reshape(-1, 3)), "corners are kept to the last bit"
    assert len(surface.pieces) < len(polygon) - 2, "triangles are merged where that is convex"


def test_mesh_of_triangles_quads_and_ngons():
    vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0], [3, 0, 0], [4, 0.5, 0], [3, 1, 0]]
    faces = [[0, 1, 2, 3], [1, 4, 5], [1, 5, 2], [4, 6, 7, 8, 5]]
    surface = Scene().add("mesh", vertices, BLACK, faces=faces, two_sided=True)
    by_source = np.bincount(surface.source_faces, weights=polygons.areas(surface.pieces))
    np.testing.assert_allclose(by_source, [1, 0.5, 0.5, 1.5])
    assert surface.two_sided is True and surface.notes == ()
    assert sorted(surface.counts.tolist()) == [3, 3, 4, 5]


@pytest.mark.parametrize("as_array", [False, True])
def test_mesh_faces_as_lists_or_array(as_array):
    corners = np.array(list(box_polygons().values()))
    faces = np.arange(24).reshape(6, 4)
    surface = Scene().add("box", corners.reshape(-1, 3), BLACK, faces=faces if as_array else faces.tolist())
    np.testing.assert_array_equal(surface.pieces, corners)
    np.testing.assert_array_equal(surface.source_faces, np.arange(6))


def test_concave_and_repeating_ngons_of_a_mesh():
    surface = Scene().add("L and C", L_SHAPE + COMB, BLACK, faces=[list(range(6)), list(range(6, 18))])
    by_source = np.bincount(surface.source_faces, weights=polygons.areas(surface.pieces))
    np.testing.assert_allclose(by_source, [3, 11])
    np.testing.assert_allclose(normals_of(surface)[:, 2], 1)


def test_faces_that_are_not_flat_are_cut_and_said(caplog):
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0.01], [0, 1, 0]]
    with caplog.at_level(logging.WARNING, logger="luzespecular"):
        surface = Scene().add("bent", corners, BLACK, faces=[[0, 1, 2, 3]])
    assert surface.counts.tolist() == [3, 3] and surface.source_faces.tolist() == [0, 0]
    assert surface.notes[0].startswith("1 faces that are not flat cut into triangles; ")
    assert "Surface 'bent': 1 faces that are not flat" in caplog.text


def test_faces_without_area_are_left_out_and_said(caplog):
    corners = [*SQUARE, [2, 0, 0], [2, 0, 0]]
    with caplog.at_level(logging.WARNING, logger="luzespecular"):
        surface = Scene().add("mesh", corners, BLACK, faces=[[0, 1, 4], [0, 1, 2, 3], [1, 4, 5], [0, 0, 0, 0]])
    assert surface.source_faces.tolist() == [1]
    assert surface.notes[0].startswith("3 faces without area left out; ")
    assert "Surface 'mesh': 3 faces without area" in caplog.text


@pytest.mark.parametrize("name", ["", "   ", None, 5])
def test_a_surface_needs_a_name(name):
    with pytest.raises(SceneError, match="needs a name"):
        Scene().add(name, SQUARE, BLACK)


def test_names_are_unique_and_a_refused_surface_leaves_nothing():
    scene = Scene()
    scene.add("floor", SQUARE, BLACK)
    with pytest.raises(SceneError, match="Surface 'floor' is in the scene already; give each"):
        scene.add("floor", L_SHAPE, BLACK)
    with pytest.raises(SceneError):
        scene.add("bad", SQUARE[:2], BLACK)
    assert list(scene.surfaces) == ["floor"]
    np.testing.assert_array_equal(scene.surfaces["floor"].pieces, [SQUARE])
    assert not Scene().surfaces, "scenes share nothing"


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        ([[0, 0, 0], [1, 0, 0], [math.nan, 1, 0]], None, r"vertex 2 is \[nan, 1\.0, 0\.0\]; mend.* \(1 in all\)"),
        ([[0, 0, 0], [1, math.inf, 0], [0, -math.inf, 0]], None, r"vertex 1 is \[1\.0, inf, 0\.0\].*\(2 in all\)"),
        ([[0, 0, 0], [1e308, 0, 0], [0, 1e308, 0]], None, "vertex 1 is"),
        ([[0, 0, 0], [1, 0, 0], [math.nan, 1, 0]], [[0, 1, 2]], "vertex 2 is"),
        ([], None, r"\(n, 3\) array"),
        ([[0, 0], [1, 0], [1, 1]], None, r"must be an \(n, 3\) array, not of shape \(3, 2\)"),
        ([0, 1, 2], None, r"\(n, 3\) array"),
        ([[0, 0, 0], [1, 0, 0], [1, 1]], None, r"must be an \(n, 3\) array of numbers"),
        ("square", None, r"must be an \(n, 3\) array of numbers"),
        (SQUARE[:2], None, "has 2 vertices; a polygon needs at least 3"),
        (SQUARE[:2], [[0, 1, 0]], "has 2 vertices; a mesh needs at least 3"),
        ([[0, 0, 0], [1, 1, 1], [2, 2, 2]], None, "has no area"),
        ([[0, 0, 0], [1, 0, 0], [1, 0, 0]], None, "has no area"),
        ([[3, 3, 3]] * 3, None, "has no area"),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0.01], [0, 1, 0]], None, r"is not flat: a vertex lies 0\.00\d+ m off its plane"),
        ([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]], None, "edges cross each other"),
        (SQUARE, [], "has no faces"),
        (SQUARE, np.zeros((0, 3), int), "has no faces"),
        (SQUARE, [[0, 1]], "face 0 has 2 vertices"),
        (SQUARE, [[0, 1, 2], [0, 1, 4]], r"face 1 names a vertex outside 0 … 3"),
        (SQUARE, [[0, 1, -1]], r"face 0 names a vertex outside 0 … 3"),
        (SQUARE, [[0, 1, 2.5]], "faces must hold whole numbers"),
        (SQUARE, [[0, 1, "c"]], "faces must hold whole numbers"),
        (SQUARE, [[0, 1, 2], "abc"], "faces must hold whole numbers"),
        (SQUARE, np.array([[0.0, 1.0, 2.0]]), "faces must hold whole numbers"),
        (SQUARE, [[0, 0, 1], [1, 1, 1]], "has no face with an area"),
    ],
)
def test_refusals_name_the_surface_and_what_is_wrong(vertices, faces, message):
    scene = Scene()
    with pytest.raises(SceneError, match="^Surface 'here'.*" + message):
        scene.add("here", vertices, BLACK, faces=faces)
    assert not scene.surfaces


@pytest.mark.parametrize("material", [None, 0.5, "white", {"diffuse_reflectance": 0.5}])
def test_a_material_is_a_material(material):
    with pytest.raises(SceneError, match=r"^Surface 'here': material must be a luzespecular\.Material, not"):
        Scene().add("here", SQUARE, material)


def test_an_even_bow_tie_is_told_that_it_crosses_itself():
    with pytest.raises(SceneError, match="edges cross each other"):
        Scene().add("bow-tie", [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], BLACK)


def test_a_mesh_face_that_crosses_itself_is_refused_or_said():
    try:
        surface = Scene().add("mesh", [[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]], BLACK, faces=[[0, 1, 2, 3]])
    except SceneError:
        return
    assert surface.notes


@pytest.mark.parametrize("faces", [5, [5, 6, 7], [None], [[0, 1, [2]]]])
def test_faces_of_no_known_form_are_refused(faces):
    with pytest.raises(SceneError, match=r"^Surface 'here'"):
        Scene().add("here", SQUARE, BLACK, faces=faces)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_size_does_not_matter(scale):
    surface = Scene().add("shape", np.array(COMB) * scale, BLACK)
    assert area_of(surface) == pytest.approx(11 * scale**2, rel=1e-12)
    with pytest.raises(SceneError, match="has no area"):
        Scene().add("line", np.array([[0, 0, 0], [1, 0, 0], [2, 1e-15, 0]]) * scale, BLACK)


L_WIDE = [[0, 0, 0], [4, 0, 0], [4, 2, 0], [2, 2, 0], [2, 4, 0], [0, 4, 0]]


@pytest.mark.parametrize(
    ("polygon", "area"),
    [
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0], [4, 0, 0], [4, 4, 0], [3, 4, 0], [0, 4, 0], [0, 1.7, 0]], 16),
        ([[0, 0, 0], [4, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], 16),
        ([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 0]], 16),
        ([*L_WIDE[:4], [2, 2, 0], *L_WIDE[4:5], [1, 4, 0], *L_WIDE[5:]], 12),
        ([*L_WIDE[:4], [2 + 1e-11, 2 + 1e-11, 0], *L_WIDE[4:]], 12),
        ([*L_WIDE[:4], [2, 2 + 1e-10, 0], *L_WIDE[4:]], 12),
    ],
    ids=[
        "straight corners",
        "a corner twice",
        "closed by its first",
        "L, corner twice",
        "L, corners near",
        "L, nearer",
    ],
)
@pytest.mark.parametrize("mesh", [False, True])
def test_corners_that_repeat_or_lie_on_edges_count_for_nothing(polygon, area, mesh):
    scene = luz.Scene()
    surface = scene.add(
        "a",
        np.array(polygon, float),
        luz.Material(diffuse_reflectance=0.5),
        faces=[range(len(polygon))] if mesh else None,
    )
    for piece, count in zip(surface.pieces, surface.counts, strict=True):
        assert rings.is_convex(piece[:count, :2], 1e-9 * 4)
        assert polygons.areas(piece) > 1e-9
    assert polygons.areas(surface.pieces).sum() == pytest.approx(area, rel=1e-9)
    light = luz.Daylight(sky=luz.UniformSky(1000.0))
    result = luz.prepare(scene, bands=8, max_area=np.inf).solve(light)
    np.testing.assert_allclose(result.illuminance, 1000 * np.pi, rtol=1e-6)


@pytest.mark.parametrize(
    "loop",
    [
        [[3, 4], [0, 4], [2, 2], [3, 1], [4, 0], [1, 1], [2, 2]],
        [[2, 2], [4, 4], [4, 0], [2, 2], [1, 1], [3, 0]],
        [[0, 2], [0, 1], [1, 3], [4, 3], [3, 1], [0, 4]],
    ],
    ids=["at a corner", "at its first", "an edge through a corner"],
)
@pytest.mark.parametrize("mesh", [False, True])
def test_loops_that_cross_at_corners_are_refused(loop, mesh):
    """Found by random trials: edges that only touch, but change sides there; a part of them was lost."""
    scene = Scene()
    with pytest.raises(SceneError, match=r"'loop'.*cross"):
        scene.add("loop", np.c_[loop, np.zeros(len(loop))], BLACK, faces=[range(len(loop))] if mesh else None)
