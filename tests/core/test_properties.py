"""What must hold for any scene: moved, scaled, turned, mirrored, added up, closed."""

import math

import numpy as np
import pytest
from builders import DARK, UNIFORM, box, box_polygons, prepare_coarse
from hypothesis import example, given, settings
from hypothesis import strategies as st

import luzespecular as luz

FEW = settings(max_examples=6, deadline=None)
POINTS = np.array([[1.5, 0.7, 0], [0.4, 2.2, 0], [0, 1.5, 1.2], [3, 2.6, 0.4], [1, 1, 1.0]])
NORMALS = np.array([[0, 0, 1], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 0.6, 0.8]])
SHARES = st.tuples(*[st.floats(0.05, 0.9)] * 3)


def room(shares=(0.5, 0.6, 0.3), change=lambda p: p, flip=False):
    """Room open to the north with a mirror shelf and a lamp, its corners changed as asked for."""
    polygons = {k: p for k, p in box_polygons((3, 3, 3)).items() if k != "north"}
    polygons["shelf"] = np.array([[0, 2, 1.7], [3, 2, 1.7], [3, 3, 1.7], [0, 3, 1.7]])
    polygons["lamp"] = np.array([[1, 1.5, 2.5], [2, 1.5, 2.5], [2, 1, 2.5], [1, 1, 2.5]])
    floor, wall, mirror = shares
    scene = luz.Scene()
    for name, polygon in polygons.items():
        material = {
            "floor": luz.Material(diffuse_reflectance=floor),
            "shelf": luz.Material(specular_reflectance=mirror, diffuse_reflectance=0.1),
            "lamp": luz.Material(exitance=500.0),
        }.get(name, luz.Material(diffuse_reflectance=wall))
        changed = change(polygon)
        scene.add(name, changed[::-1] if flip else changed, material)
    return scene


def light(azimuth=0.0, altitude=40.0):
    sky = luz.CIESky(12, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=10_000)
    return luz.Daylight(sky=sky, sun=luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=50_000))


def lux(scene, points=POINTS, normals=NORMALS, daylight=None, **options):
    result = prepare_coarse(scene, **{"elements": 150, "patches": 80, **options}).solve(daylight or light(), cycles=3)
    return result.at(points, normals), {name: result.mean(name) for name in result.surfaces}


@pytest.fixture(scope="module")
def base():
    return lux(room())


def assert_alike(got, expected, rtol):
    np.testing.assert_allclose(got[0], expected[0], rtol=rtol, atol=0.02)
    for name, mean in expected[1].items():
        assert got[1][name] == pytest.approx(mean, rel=rtol, abs=0.02), name


@FEW
@given(st.floats(-4, 4))
def test_scale_changes_nothing(base, exponent):
    """From a doll's house to a canyon."""
    scale = 10.0**exponent
    assert_alike(lux(room(change=lambda p: p * scale), POINTS * scale), base, 1e-4)


@FEW
@given(st.tuples(*[st.floats(-1e5, 1e5)] * 3))
@example((0.0, 0.0, 32767.0))  # rounding parts edges that lie on one another
def test_place_changes_nothing(base, shift):
    assert_alike(lux(room(change=lambda p: p + shift), POINTS + shift), base, 1e-4)


def turned(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return lambda p: np.asarray(p) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])  # clockwise, as azimuths run


@pytest.mark.parametrize("degrees", [90, 180, 270])
def test_quarter_turns_with_the_sky_change_nothing(base, degrees):
    """Parcels are symmetric to quarter turns only roughly; sun and images of lamps turn exactly."""
    turn = turned(degrees)
    got = lux(room(change=turn), turn(POINTS), turn(NORMALS), light(azimuth=degrees))
    assert_alike(got, base, 0.02)


@FEW
@given(st.floats(0, 360))
@example(317.8160840602645)
def test_any_turn_with_the_sky_changes_no_more_than_the_globe_errs(base, degrees):
    turn = turned(degrees)
    assert_alike(lux(room(change=turn), turn(POINTS), turn(NORMALS), light(azimuth=degrees)), base, 0.04)


@settings(max_examples=5, deadline=None)
@given(st.floats(0, 360))
@example(8.09015540508944)
def test_any_turn_changes_nothing_in_exact_light(degrees):
    """Sun, lamps and their images by mirrors are clipped exactly, whichever way the room lies."""
    turn = turned(degrees)

    def initial(change, azimuth):
        sun = luz.Daylight(sun=luz.Sun(altitude=40, azimuth=azimuth, normal_illuminance=5e4))
        result = prepare_coarse(room(change=change), bands=4, max_area=0.5).solve(sun, cycles=0)
        return result.at(change(POINTS), change(NORMALS)), {n: result.mean(n) for n in result.surfaces}

    one, other = initial(turn, degrees), initial(turned(0), 0)
    np.testing.assert_allclose(one[0], other[0], rtol=1e-6, atol=1e-6)
    for name, mean in other[1].items():
        assert one[1][name] == pytest.approx(mean, rel=1e-6, abs=1e-6)


def test_a_mirrored_room_under_a_mirrored_sky(base):
    """East and west exchanged: orientations turn over, light does not."""
    flip = np.array([-1, 1, 1])
    got = lux(room(change=lambda p: p * flip, flip=True), POINTS * flip, NORMALS * flip)
    assert_alike(got, base, 0.02)


@FEW
@given(SHARES, st.integers(0, 2), st.floats(0.0, 0.3))
def test_more_reflectance_is_never_less_light(shares, which, more):
    raised = tuple(min(s + more * (k == which), 0.89) if s < 0.89 else s for k, s in enumerate(shares))
    less, greater = lux(room(shares)), lux(room(raised))
    assert (greater[0] >= less[0] * (1 - 1e-5)).all()
    for name, mean in less[1].items():
        assert greater[1][name] >= mean * (1 - 1e-5)


@FEW
@given(st.floats(0, 2000), st.floats(0, 2000))
def test_lamps_superpose(one, two):
    def received(first, second):
        lamps = {"ceiling": luz.Material(exitance=first, diffuse_reflectance=0.5)}
        lamps["west"] = luz.Material(exitance=second, diffuse_reflectance=0.4)
        scene = box(luz.Material(diffuse_reflectance=0.6), (3, 3, 3), **lamps)
        result = prepare_coarse(scene, elements=150, patches=80, bands=16).solve(DARK, cycles=4)
        return np.append(result.at(POINTS, NORMALS), [result.mean(n) for n in result.surfaces])

    # surfaces that neither emit nor reflect are cut otherwise: a trifle of exitance keeps the faces the same
    none = received(1e-9, 1e-9)
    # receivers are chosen for the light at hand: sums hold to the error of interpolation between them
    np.testing.assert_allclose(
        received(one, two), received(one, 1e-9) + received(1e-9, two) - none, rtol=2e-3, atol=1e-4
    )


@settings(max_examples=8, deadline=None)
@given(
    st.tuples(*[st.floats(0.3, 5)] * 3),
    st.tuples(*[st.floats(-0.3, 0.3)] * 3),
    st.floats(0, 6.28),
    st.sampled_from([16, 25]),
)
def test_closed_leaning_boxes_see_only_themselves(size, lean, turn, bands):
    """Parallelepipeds at any angle: rows sum to one, and an even field stays even."""
    spin = np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    shear = np.array([[1, lean[0], lean[1]], [0, 1, lean[2]], [0, 0, 1]])
    scene = luz.Scene()
    for name, polygon in box_polygons(size).items():
        scene.add(name, polygon @ (spin @ shear).T, luz.Material(diffuse_reflectance=0.8, exitance=10))
    transfer = prepare_coarse(scene, elements=60, patches=40, bands=bands)
    np.testing.assert_allclose(transfer.form_factors.sum(axis=1), 1, atol=3e-5)
    assert transfer.sky_direct.dense().max() == 0
    np.testing.assert_allclose(transfer.solve(DARK, tolerance=1e-6).illuminance, 50, rtol=3e-4)


@settings(max_examples=5, deadline=None)
@given(st.integers(0, 1000))
def test_closed_hulls_of_random_points_see_only_themselves(seed):
    """Triangles at all angles: convex hulls, by trying all planes through three of a few points."""
    points = np.random.default_rng(seed).normal(size=(9, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    faces = []
    for a in range(9):
        for b in range(9):
            for c in range(9):
                if a < b and a < c and b != c:
                    normal = np.cross(points[b] - points[a], points[c] - points[a])
                    if ((points - points[a]) @ normal > -1e-12).all():
                        faces.append((a, b, c))
    inside = points.mean(axis=0)
    scene = luz.Scene()
    scene.add("hull", points, luz.Material(diffuse_reflectance=0.5, exitance=10), faces=faces)
    transfer = prepare_coarse(scene, elements=100, patches=60)
    np.testing.assert_allclose(transfer.form_factors.sum(axis=1), 1, atol=1e-4)
    result = transfer.solve(DARK, tolerance=1e-6)
    np.testing.assert_allclose(result.illuminance, 20, rtol=1e-3)
    got = result.at([inside] * 6, np.concatenate([np.eye(3), -np.eye(3)]))
    np.testing.assert_allclose(got, 20, rtol=1e-3)


@FEW
@given(st.tuples(*[st.floats(0.5, 4)] * 3), st.floats(0.1, 0.9))
def test_an_opening_lets_in_what_it_shows(size, reflectance):
    """Flux through a roof opening of a black room, by the sky's own integral; brighter rooms send some back."""
    result = prepare_coarse(box(luz.Material(), size, without=("ceiling",)), elements=2000, bands=30).solve(UNIFORM)
    entering = 1000 * math.pi * size[0] * size[1]
    assert result.illuminance @ result.areas == pytest.approx(entering, rel=0.02)
    bright = prepare_coarse(
        box(luz.Material(diffuse_reflectance=reflectance), size, without=("ceiling",)), elements=400
    )
    balance = bright.solve(UNIFORM).balance
    assert balance.entering == pytest.approx(entering, rel=0.02)
    assert 0 < balance.escaped < reflectance * balance.entering


SIDES = st.tuples(*[st.floats(1, 4)] * 3)


@FEW
@given(SIDES, st.floats(0.05, 0.9))
def test_form_factors_are_reciprocal(size, reflectance):
    """A_i F_ij = A_j F_ji, for whole surfaces within what means over areas err."""
    transfer = prepare_coarse(box(luz.Material(diffuse_reflectance=reflectance), size), elements=600, patches=150)
    geometry = transfer.geometry
    areas = geometry.patch_areas
    surface = np.zeros(len(areas), int)
    patch = geometry.targets.patches.of_element
    surface[patch[patch >= 0]] = geometry.element_surface[patch >= 0]
    member = (surface == np.arange(6)[:, None]).astype(float)
    flux = member @ (areas[:, None] * transfer.patch_factors) @ member.T
    np.testing.assert_allclose(flux, flux.T, rtol=0.02, atol=1e-3 * areas.sum())


@FEW
@given(st.floats(0, 5000), st.floats(0, 9e4), st.floats(5, 85), st.floats(0, 360))
def test_sky_and_sun_superpose(luminance, normal_illuminance, altitude, azimuth):
    transfer = prepare_coarse(room(), elements=100, patches=60, bands=12)
    sky, sun = (
        luz.UniformSky(luminance),
        luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=normal_illuminance),
    )
    nothing = transfer.solve(luz.Daylight()).illuminance
    one, two, both = (
        transfer.solve(light, tolerance=1e-8).illuminance - nothing
        for light in (luz.Daylight(sky=sky), luz.Daylight(sun=sun), luz.Daylight(sky=sky, sun=sun))
    )
    np.testing.assert_allclose(both, one + two, rtol=1e-3, atol=1e-6 * (luminance + normal_illuminance) + 1e-3)


@FEW
@given(st.tuples(*[st.floats(0.3, 2.2)] * 3), st.floats(0.2, 0.7), st.booleans())
def test_a_black_blocker_never_adds_light(place, side, upright):
    corner = np.array(
        [[0, 0, 0], [side, 0, 0], [side, 0, side], [0, 0, side]]
        if upright
        else [[0, 0, 0], [side, 0, 0], [side, side, 0], [0, side, 0]]
    )
    with_it = room()
    with_it.add("blocker", corner + np.asarray(place), luz.Material())
    without, blocked = lux(room(), elements=300), lux(with_it, elements=300)
    for name, mean in without[1].items():
        assert blocked[1][name] <= mean * 1.01 + 0.5, name


@FEW
@given(SHARES)
def test_a_symmetric_room_is_lit_symmetrically(shares):
    """The room and the light are alike to the left and to the right."""
    _, means = lux(room(shares), daylight=light(azimuth=0.0))
    assert means["west"] == pytest.approx(means["east"], rel=0.02)


@FEW
@given(SIDES, SHARES)
def test_lumens_add_up(size, shares):
    floor, wall, mirror = shares
    scene = box(
        luz.Material(diffuse_reflectance=wall), size, without=("north",), floor=luz.Material(diffuse_reflectance=floor)
    )
    scene.add(
        "mirror",
        [
            [0, 0, size[2] / 2],
            [size[0], 0, size[2] / 2],
            [size[0], size[1] / 2, size[2] / 2],
            [0, size[1] / 2, size[2] / 2],
        ],
        luz.Material(specular_reflectance=mirror),
    )
    balance = prepare_coarse(scene, elements=600, patches=150).solve(light()).balance
    assert abs(balance.defect) < 5e-3
    assert min(balance.absorbed.values()) >= 0 and balance.escaped >= 0
