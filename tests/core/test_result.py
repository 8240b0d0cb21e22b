"""Results: values per face, at free points, of backs; names; and how they hang together."""

import math

import numpy as np
import pytest
from builders import BLACK, DARK, UNIFORM, box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz

WHITE = luz.Material(diffuse_reflectance=0.6)
UP = [0.0, 0.0, 1.0]
LIGHT = luz.Daylight(
    sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=0, horizontal_illuminance=10_000),
    sun=luz.Sun(altitude=40, azimuth=0, normal_illuminance=80_000),
)


def room(shift=(0, 0, 0)):
    scene = luz.Scene()
    for name, surface in box(WHITE, (3, 3, 3), without=("north",)).surfaces.items():
        scene.add(name, surface.pieces[0] + shift, WHITE)
    shelf = np.array([[0, 2, 1.5], [3, 2, 1.5], [3, 3, 1.5], [0, 3, 1.5]]) + shift
    scene.add("shelf", shelf, luz.Material(specular_reflectance=0.9))
    screen = np.array([[1, 1, 0.5], [2, 1, 0.5], [2, 1, 1.5], [1, 1, 1.5]]) + shift
    scene.add("screen", screen, luz.Material(diffuse_reflectance=0.4, exitance=50.0), two_sided=True)
    return scene


@pytest.fixture(scope="module")
def result():
    return prepare_coarse(room(), elements=400, patches=200, max_area=0.2).solve(LIGHT)


def test_arrays_have_one_row_for_each_face(result):
    n = len(result.illuminance)
    for name in ("illuminance", "initial", "exitance", "areas"):
        values = getattr(result, name)
        assert values.shape == (n,) and values.dtype == np.float64, name
    for name in ("centroids", "normals"):
        assert getattr(result, name).shape == (n, 3), name
    assert result.vertices.shape == (n, 3, 3) and result.source_faces.shape == (n,)
    assert all(values.shape == (n,) for values in result.components.values())
    np.testing.assert_allclose(result.vertices.mean(axis=1), result.centroids, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(result.normals, axis=1), 1)


def test_faces_lie_where_the_surfaces_were_given(result):
    assert result.surfaces == ["floor", "ceiling", "south", "west", "east", "shelf", "screen"]
    assert sum(len(result.faces_of(name)) for name in result.surfaces) == len(result.areas)
    for name, axis, place, area in (("floor", 2, 0, 9), ("ceiling", 2, 3, 9), ("west", 0, 0, 9), ("screen", 1, 1, 1)):
        faces = result.faces_of(name)
        np.testing.assert_allclose(result.vertices[faces, :, axis], place, atol=1e-12)
        assert result.areas[faces].sum() == pytest.approx(area)
    np.testing.assert_allclose(
        result.normals[result.faces_of("ceiling")], [[0, 0, -1]] * len(result.faces_of("ceiling"))
    )
    edges = result.vertices[:, 1:] - result.vertices[:, :1]
    np.testing.assert_allclose(
        np.cross(edges[:, 0], edges[:, 1]), 2 * result.areas[:, None] * result.normals, atol=1e-9
    )


def test_components_add_up(result):
    total = sum(result.components.values())
    np.testing.assert_allclose(result.illuminance, total, rtol=1e-12)
    np.testing.assert_allclose(result.initial, total - result.components["interreflected"], rtol=1e-9, atol=1e-6)
    assert result.components["interreflected"].min() > 0
    assert np.isfinite(total).all() and total.min() >= 0


def test_exitance_is_what_the_diffuse_part_sends_out(result):
    rho = np.zeros(len(result.areas))
    for name, share in (
        ("floor", 0.6),
        ("ceiling", 0.6),
        ("south", 0.6),
        ("west", 0.6),
        ("east", 0.6),
        ("screen", 0.4),
    ):
        rho[result.faces_of(name)] = share
    own = np.zeros(len(rho))
    own[result.faces_of("screen")] = 50
    np.testing.assert_allclose(result.exitance, own + rho * result.illuminance)
    assert (result.exitance[result.faces_of("shelf")] == 0).all(), "a mirror's reflection is no exitance"


def test_mirrors_are_lit_too(result):
    assert result.mean("shelf") > 1000


def test_means_are_weighted_by_area():
    scene = luz.Scene()
    scene.add(
        "steps",
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [4, 0, 0], [4, 1, 0]],
        BLACK,
        faces=[[0, 1, 2, 3], [1, 4, 5, 2]],
    )
    scene.add("roof", [[1, 2, 1], [9, 2, 1], [9, -2, 1], [1, -2, 1]], BLACK)
    result = prepare_coarse(scene).solve(luz.Daylight(sun=luz.Sun(direction=(0, 0, 1), normal_illuminance=100.0)))
    assert result.mean("steps") == pytest.approx(25)
    assert result.illuminance[result.faces_of("steps")].mean() == pytest.approx(50)


@pytest.mark.parametrize("name", ["Floor", "", None, 3, "chair"])
def test_unknown_names_are_refused(result, name):
    for ask in (result.faces_of, result.mean):
        with pytest.raises(luz.SceneError, match=r"There is no surface .* its surfaces are: floor, ceiling, south"):
            ask(name)


def test_points_agree_with_faces():
    """`at` gathers afresh at centroids, faces follow from receivers near by; errors relative to a surface's mean."""
    scene = box(WHITE, (3, 3, 3), without=("north",))
    result = prepare_coarse(scene, max_area=0.05, elements=4000, patches=400).solve(UNIFORM)
    for initial in (True, False):
        values = result.initial if initial else result.illuminance
        got = result.at(result.centroids, result.normals, initial=initial)
        for name in ("floor", "south", "west", "east"):
            faces = result.faces_of(name)
            error = (values[faces] - got[faces]) / got[faces].mean()
            assert np.sqrt(np.mean(error**2)) < 0.006, name
            assert np.abs(error).max() < 0.05, name
        assert values @ result.areas == pytest.approx(got @ result.areas, rel=3e-3)


def test_initial_at_points_is_that_of_no_cycles(result):
    points, normals = [[1.5, 0.5, 0], [0.5, 2.5, 1], [3, 1, 1]], [UP, [0, 0.6, 0.8], [-1, 0, 0]]
    none = result.transfer.solve(LIGHT, cycles=0)
    np.testing.assert_allclose(result.at(points, normals, initial=True), none.at(points, normals), rtol=1e-12)
    assert (result.at(points, normals) > none.at(points, normals)).all()


def test_components_at_points_add_up(result):
    rng = np.random.default_rng(5)
    points, normals = rng.uniform(0.1, 2.9, (30, 3)), rng.normal(size=(30, 3))
    parts = result.at(points, normals, components=True)
    assert list(parts) == list(result.components)
    assert all(values.shape == (30,) and values.min() >= 0 for values in parts.values())
    assert all(parts[name].max() > 1 for name in parts)
    np.testing.assert_allclose(sum(parts.values()), result.at(points, normals), rtol=1e-12)
    initial = result.at(points, normals, initial=True, components=True)
    assert list(initial) == [name for name in parts if name != "interreflected"]
    for name, values in initial.items():
        np.testing.assert_allclose(values, parts[name], rtol=1e-12)
    assert all(len(values) == 0 for values in result.at([], [], components=True).values())


def test_components_at_points_agree_with_faces():
    """Means over the floor of each by itself: what `at` gathers at centroids, and what faces follow from."""
    fine = prepare_coarse(room(), max_area=0.02, elements=2000, patches=400).solve(LIGHT)
    faces = fine.faces_of("floor")
    got = fine.at(fine.centroids[faces], fine.normals[faces], components=True)
    for name, values in fine.components.items():
        mean = np.average(values[faces], weights=fine.areas[faces])
        assert np.average(got[name], weights=fine.areas[faces]) == pytest.approx(mean, rel=0.03, abs=2.0), name


@pytest.mark.parametrize("without", ["sky", "sun", "emitted"])
def test_components_at_points_are_each_their_own_light(without):
    """What one light gives comes in its own components, and in interreflection."""
    scene = room() if without != "emitted" else box(WHITE, (3, 3, 3), without=("north",))
    kept = {name: getattr(LIGHT, name) for name in ("sky", "sun") if name != without}
    solved = prepare_coarse(scene, elements=400, patches=200).solve(luz.Daylight(**kept))
    parts = solved.at([[1.5, 2.0, 0.0], [0.5, 2.5, 1.0]], [UP, [0, 0.6, 0.8]], components=True)
    for name, values in parts.items():
        assert (values == 0).all() if name.startswith(without) else name.endswith("_specular") or values.any(), name


def test_sunlight_of_a_disc_is_told_apart_too():
    sun = luz.Sun(altitude=40, azimuth=0, normal_illuminance=80_000, disc=True)
    transfer = prepare_coarse(room(), elements=400, patches=200)
    points, normals = [[1.5, 1.8, 0.0], [1.5, 0.7, 2.9], [1.5, 2.7, 1.6]], [UP, [0, 0, -1], UP]
    broad, sharp = (
        transfer.solve(luz.Daylight(sun=one)).at(points, normals, components=True) for one in (sun, LIGHT.sun)
    )
    for name in ("sun_direct", "sun_specular"):
        np.testing.assert_allclose(broad[name], sharp[name], rtol=1e-3, atol=1e-6)
        assert sharp[name].max() > 1_000


def test_points_are_each_their_own(result):
    rng = np.random.default_rng(2)
    points = rng.uniform(0.1, 2.9, (40, 3))
    normals = np.where(np.arange(40)[:, None] % 2, UP, rng.normal(size=(40, 3)))
    points[::4, 2] = 0.8
    together = result.at(points, normals)
    alone = np.concatenate([result.at(points[k : k + 1], normals[k : k + 1]) for k in range(40)])
    np.testing.assert_allclose(together, alone, rtol=1e-4)
    order = rng.permutation(40)
    np.testing.assert_allclose(result.at(points[order], normals[order]), together[order], rtol=1e-4)


def test_normals_of_any_length(result):
    points = [[1.5, 0.5, 0.8]] * 3
    lux = result.at(points, [[0, 0.3, 0.4], [0, 3e5, 4e5], [0, 3e-5, 4e-5]])
    np.testing.assert_allclose(lux, lux[0], rtol=1e-9)


def test_no_points_no_values(result):
    assert result.at([], []).shape == (0,)
    assert result.at(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)


@pytest.mark.parametrize(
    ("points", "normals", "message"),
    [
        ([[0, 0, 0]], [[0, 0, 0]], r"point 0 is \[0\.0, 0\.0, 0\.0\] with normal \[0\.0, 0\.0, 0\.0\]; .*not zero"),
        ([[0, 0, 0], [0, math.nan, 0]], [UP, UP], "point 1 is"),
        ([[0, 0, 0]], [[0, 0, math.inf]], "normals finite and not zero"),
        ([[0, 0, 0]], [UP, UP], r"shape \(m, 3\), not \(1, 3\) and \(2, 3\)"),
        ([0, 0, 0], UP, r"shape \(m, 3\), not \(3,\) and \(3,\)"),
        ([[0, 0]], [[0, 1]], r"shape \(m, 3\)"),
        ("here", UP, "arrays of numbers"),
        ([[0, 0, 0], [1, 2]], [UP, UP], "arrays of numbers"),
        (None, None, "at"),
    ],
)
def test_points_that_are_none_are_refused(result, points, normals, message):
    with pytest.raises(luz.SceneError, match=r"at\(points, normals\): .*" + message if message != "at" else "at"):
        result.at(points, normals)


def test_points_on_surfaces_edges_corners_and_in_the_air(result):
    """Everywhere a number, and continuous where the light is: just off the surface is like on it."""
    lying = [[1, 1.4, 0], [1e-4, 1.4, 0], [1e-4, 1e-4, 0]]
    on, off = result.at(lying, [UP] * 3), result.at(np.add(lying, [0, 0, 1e-5]), [UP] * 3)
    np.testing.assert_allclose(on, off, rtol=2e-2)
    anywhere = [[0, 1.4, 0], [0, 0, 0], [1.5, 3, 1.0], [1.5, 10, 1], [1.5, 1, 1], [1, 1, 0.5], [1.5, 1.5, 9]]
    values = result.at(anywhere * 2, [UP] * 7 + [[0, 1, 0]] * 7)
    assert np.isfinite(values).all() and (values >= 0).all()


def test_an_open_point_sees_the_whole_sky(result):
    assert result.at([[1.5, 50, 100]], [UP], initial=True)[0] == pytest.approx(
        10_000 + 80_000 * math.sin(math.radians(40)), rel=2e-2
    )


def test_two_sided_surfaces_have_backs(result):
    back, screen = result.back, result.faces_of("screen")
    others = np.setdiff1d(np.arange(len(result.areas)), screen)
    assert np.isnan(back.illuminance[others]).all() and np.isnan(back.initial[others]).all()
    assert np.isnan(back.exitance[others]).all()
    assert np.isfinite(back.illuminance[screen]).all()
    np.testing.assert_array_equal(back.normals, -result.normals)
    np.testing.assert_array_equal(back.areas, result.areas)
    np.testing.assert_array_equal(back.centroids, result.centroids)
    np.testing.assert_allclose(back.illuminance[screen], sum(v[screen] for v in back.components.values()))
    np.testing.assert_allclose(back.exitance[screen], 50 + 0.4 * back.illuminance[screen])
    # the front looks south into the room, the back north to the Sun
    assert (back.components["sun_direct"][screen] > 0).any() != (result.components["sun_direct"][screen] > 0).any()


def test_a_back_is_what_a_turned_surface_would_get():
    def screen_values(turned):
        scene = box(WHITE, (3, 3, 3), without=("north",))
        corners = np.array([[1, 1, 0.5], [2, 1, 0.5], [2, 1, 1.5], [1, 1, 1.5]])
        scene.add("screen", corners[::turned], luz.Material(diffuse_reflectance=0.4), two_sided=True)
        return prepare_coarse(scene, elements=400, patches=200).solve(LIGHT), scene

    (one, _), (other, _) = screen_values(1), screen_values(-1)
    faces = one.faces_of("screen")
    area = one.areas[faces]
    front, back = one.illuminance[faces] @ area, one.back.illuminance[faces] @ area
    turned_front, turned_back = other.illuminance[faces] @ area, other.back.illuminance[faces] @ area
    assert front == pytest.approx(turned_back, rel=1e-3)
    assert back == pytest.approx(turned_front, rel=1e-3)
    assert abs(front / back - 1) > 0.1


def test_no_two_sided_surface_no_back():
    assert prepare_coarse(box(WHITE)).solve(DARK).back is None


def test_lit_from_behind_one_sided_surfaces_stay_dark():
    scene = luz.Scene()
    scene.add("down", [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]], WHITE)
    result = prepare_coarse(scene).solve(UNIFORM)
    np.testing.assert_allclose(result.illuminance, 0, atol=1e-9)


@pytest.mark.parametrize("shift", [(1000.0, -2000.0, 500.0), (1e6, 1e6, 1e6)])
def test_results_of_far_off_scenes(result, shift):
    far = prepare_coarse(room(shift), elements=400, patches=200, max_area=0.2).solve(LIGHT)
    np.testing.assert_allclose(far.centroids, result.centroids + shift, atol=1e-9 * max(np.abs(shift)))
    np.testing.assert_allclose(far.areas, result.areas, rtol=1e-6)
    np.testing.assert_allclose(far.illuminance, result.illuminance, rtol=1e-4, atol=0.01)
    points, normals = np.array([[1.5, 0.5, 0], [0.5, 2.5, 1]]), [UP, [0, 0.6, 0.8]]
    np.testing.assert_allclose(far.at(points + shift, normals), result.at(points, normals), rtol=1e-4)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.05, 2.95), st.floats(0.05, 2.95), st.floats(0.0, 3.0), st.floats(-1, 1), st.floats(0, 6.28))
def test_points_are_lit_by_no_more_than_there_is(result, x, y, z, tilt, turn):
    normal = [math.sqrt(1 - tilt**2) * math.cos(turn), math.sqrt(1 - tilt**2) * math.sin(turn), tilt]
    initial, total = (result.at([[x, y, z]], [normal], initial=i)[0] for i in (True, False))
    assert 0 <= initial <= total + 1e-6
    assert total < 80_000 * 1.9 + 10_000 * 5
