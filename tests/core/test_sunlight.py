"""Sunlight: patches, shadows, panes and chains of mirrors against closed forms."""

import math

import numpy as np
import pytest
from builders import BLACK, box, flux, prepare_coarse, scene_of
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import polygons
from luzespecular.sun_patches import lit_shares

DNI = 80_000.0
MIRROR = luz.Material(specular_reflectance=0.9)
GLASS = luz.Material(regular_transmittance=0.88, refractive_index=1.52)


def sun(*direction):
    return luz.Daylight(sun=luz.Sun(direction=direction, normal_illuminance=DNI))


def rectangle(x, y, z):
    """Horizontal rectangle that looks up; ``x`` and ``y`` are pairs."""
    return np.array([[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]], float)


FLOOR = rectangle((-5, 5), (-5, 5), 0)


def lit_share(triangles, polygon):
    return lit_shares(triangles, polygons.areas(triangles), [np.arange(len(triangles))], [polygon])[0]


def lit_area(result, name, lux):
    """Area of a surface that a beam of this illuminance lights."""
    return flux(result, name) / lux


@pytest.mark.parametrize(
    ("direction", "facing", "cosine"),
    [
        ((0, 0, 1), "up", 1),
        ((0, 0, 2), "up", 1),
        ((0, 1, 1), "up", math.sqrt(0.5)),
        ((0, 1, 1), "north", math.sqrt(0.5)),
        ((0, 1, 1), "south", 0),
        ((0, 1, 1), "east", 0),
        ((0, 0, 1), "down", 0),
        ((0, 1, 1e-9), "up", 1e-9),
        ((0, 1, -1e-3), "north", 0),
        ((0, 0, -1), "down", 0),
    ],
)
def test_cosine_law_on_faces_and_at_points(direction, facing, cosine):
    """Directions of any length; at or below the horizon the Sun gives nothing, whatever looks at it."""
    first, second = {
        "up": ((1, 0, 0), (0, 1, 0)),
        "down": ((0, 1, 0), (1, 0, 0)),
        "north": ((0, 0, 1), (1, 0, 0)),
        "south": ((1, 0, 0), (0, 0, 1)),
        "east": ((0, 1, 0), (0, 0, 1)),
    }[facing]
    plate = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ np.array([first, second])
    result = prepare_coarse(scene_of({"plate": plate}), bands=4).solve(sun(*direction))
    np.testing.assert_allclose(result.illuminance, DNI * cosine, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(result.at(result.centroids, result.normals), DNI * cosine, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(result.components["sun_direct"], result.illuminance)


@settings(max_examples=25, deadline=None)
@given(st.floats(0, 2 * math.pi), st.floats(20, 90), st.floats(0.2, 2.0))
def test_a_plates_shadow(azimuth, altitude, height):
    """Light lost on the floor is the plate's own area, wherever the shadow lies; the plate has the floor's light."""
    up = math.radians(altitude)
    towards = (math.cos(up) * math.sin(azimuth), math.cos(up) * math.cos(azimuth), math.sin(up))
    scene = scene_of({"floor": rectangle((-9, 9), (-9, 9), 0), "plate": rectangle((-0.5, 1), (-0.4, 0.2), height)})
    result = prepare_coarse(scene, bands=4).solve(sun(*towards))
    lux = DNI * math.sin(up)
    assert lit_area(result, "floor", lux) == pytest.approx(18 * 18 - 0.9, rel=1e-9)
    assert lit_area(result, "plate", lux) == pytest.approx(0.9, rel=1e-9)
    centre = np.array([0.25, -0.1, 0]) - np.array([*towards[:2], 0]) / towards[2] * height
    at = result.at([centre, np.add(centre, [2, 0, 0]), [0, 0, height + 1]], [[0, 0, 1]] * 3)
    np.testing.assert_allclose(at, [0, lux, lux], atol=1e-6)


def test_faces_at_a_shadows_edge_have_their_lit_share():
    scene = scene_of({"floor": rectangle((0, 1), (0, 1), 0), "plate": rectangle((0.3, 5), (-5, 5), 1)})
    result = prepare_coarse(scene, max_area=math.inf).solve(sun(0, 0, 1))
    floor = result.faces_of("floor")
    assert len(floor) == 2
    np.testing.assert_allclose(sorted(result.illuminance[floor] / DNI), [0.09, 0.51], rtol=1e-9)


def test_overlapping_shadows_count_once():
    plates = {f"plate {k}": rectangle((-1, 1), (-1, 1), k + 1) for k in range(3)}
    result = prepare_coarse(scene_of({"floor": FLOOR, **plates})).solve(sun(0, 0, 1))
    assert lit_area(result, "floor", DNI) == pytest.approx(96, rel=1e-9)
    assert [flux(result, f"plate {k}") for k in range(3)] == pytest.approx([0, 0, 4 * DNI], abs=1e-3)


def test_backs_block_too():
    plate = {"plate": rectangle((-1, 1), (-1, 1), 1)[::-1]}
    result = prepare_coarse(scene_of({"floor": FLOOR, **plate})).solve(sun(0, 0, 1))
    assert lit_area(result, "floor", DNI) == pytest.approx(96, rel=1e-9)
    assert flux(result, "plate") == 0


def test_concave_plates_cast_concave_shadows():
    plate = [[0, 0, 1], [3, 0, 1], [3, 1, 1], [1, 1, 1], [1, 3, 1], [0, 3, 1]]
    result = prepare_coarse(scene_of({"floor": FLOOR, "plate": plate})).solve(sun(0, 0, 1))
    assert lit_area(result, "floor", DNI) == pytest.approx(95, rel=1e-9)
    at = result.at([[2, 0.5, 0], [0.5, 2, 0], [2, 2, 0]], [[0, 0, 1]] * 3)
    np.testing.assert_allclose(at, [0, 0, DNI], atol=1e-6)


def test_a_window_throws_its_patch_on_the_floor():
    """Room 4 x 4 x 3 m, window 2 x 1 m in the south wall from z = 1, Sun in the south at 45 degrees."""
    room = {
        "floor": rectangle((0, 4), (0, 4), 0),
        "below": [[0, 0, 0], [0, 0, 1], [4, 0, 1], [4, 0, 0]],
        "above": [[0, 0, 2], [0, 0, 3], [4, 0, 3], [4, 0, 2]],
        "left": [[0, 0, 1], [0, 0, 2], [1, 0, 2], [1, 0, 1]],
        "right": [[3, 0, 1], [3, 0, 2], [4, 0, 2], [4, 0, 1]],
        "roof": rectangle((0, 4), (0, 4), 3)[::-1],
    }
    result = prepare_coarse(scene_of(room), elements=50).solve(sun(0, -1, 1))
    assert flux(result, "floor") == pytest.approx(2 * 1 * DNI * math.sqrt(0.5), rel=1e-9)
    points = [[2, 1.5, 0], [1.01, 1.01, 0], [2.99, 1.99, 0], [0.99, 1.5, 0], [2, 0.99, 0], [2, 2.01, 0], [3.01, 1.5, 0]]
    at = result.at(points, [[0, 0, 1]] * 7)
    np.testing.assert_allclose(at, DNI * math.sqrt(0.5) * np.array([1, 1, 1, 0, 0, 0, 0]), atol=1e-6)


def test_sunlight_through_a_pane():
    pane = rectangle((-1, 1), (-1, 1), 1)
    for altitude in (90, 60, 30, 10):
        up = math.radians(altitude)
        scene = luz.Scene()
        scene.add("floor", rectangle((-9, 9), (-9, 9), 0), BLACK)
        scene.add("pane", pane, GLASS)
        result = prepare_coarse(scene, bands=4).solve(sun(0, math.cos(up), math.sin(up)))
        lux, through = DNI * math.sin(up), float(GLASS.transmittance_at(math.sin(up)))
        assert flux(result, "floor") == pytest.approx((18 * 18 - 4 + 4 * through) * lux, rel=1e-9)
        under = np.array([[0, -1 / math.tan(up), 0]])
        assert result.at(under, [[0, 0, 1]])[0] == pytest.approx(lux * through, rel=1e-9)
        assert flux(result, "pane") == pytest.approx(4 * lux, rel=1e-9)


def test_two_panes_multiply_and_turn_no_beam():
    scene = luz.Scene()
    scene.add("floor", FLOOR, BLACK)
    plain = luz.Material(regular_transmittance=0.5)
    scene.add("upper", rectangle((-1, 1), (-1, 1), 2), plain)
    scene.add("lower", rectangle((0, 3), (-3, 3), 1)[::-1], plain)
    result = prepare_coarse(scene).solve(sun(0, 0, 1))
    at = result.at([[-0.5, 0, 0], [0.5, 0, 0], [2, 0, 0], [-2, 0, 0]], [[0, 0, 1]] * 4)
    np.testing.assert_allclose(at / DNI, [0.5, 0.25, 0.5, 1], rtol=1e-9)
    assert flux(result, "floor") / DNI == pytest.approx(100 - 2 + 2 * -0.5 + 2 * (0.25 - 1) + 16 * -0.5 + 2, rel=1e-9)


def test_a_pane_mirrors_part_of_the_beam():
    """A standing pane with the Sun at 45 degrees reflects on to the floor before it, by Fresnel."""
    scene = luz.Scene()
    scene.add("floor", FLOOR, BLACK)
    scene.add("pane", [[-1, 0, 0], [1, 0, 0], [1, 0, 1], [-1, 0, 1]], GLASS)
    result = prepare_coarse(scene).solve(sun(0, -1, 1))
    lux, share = DNI * math.sqrt(0.5), float(GLASS.specular_at(math.sqrt(0.5)))
    at = result.at([[0, -0.5, 0], [0, 0.5, 0], [0, -1.5, 0]], [[0, 0, 1]] * 3)
    np.testing.assert_allclose(
        at, lux * np.array([1 + share, float(GLASS.transmittance_at(math.sqrt(0.5))), 1]), rtol=1e-9
    )
    assert result.components["sun_specular"] @ result.areas == pytest.approx(2 * lux * share, rel=1e-9)


WALL = np.array([[2, 1, 0], [2, 1, 3], [-2, 1, 3], [-2, 1, 0]])  # looks south


def test_a_mirror_floor_lights_the_wall_above():
    scene = luz.Scene()
    scene.add("mirror", rectangle((-1, 1), (0, 1), 0), MIRROR)
    scene.add("wall", WALL, BLACK)
    result = prepare_coarse(scene).solve(sun(0, -1, 1))
    lux = DNI * math.sqrt(0.5)
    assert flux(result, "mirror") == pytest.approx(2 * lux, rel=1e-9)
    wall = result.faces_of("wall")
    direct, mirrored = (result.components[k][wall] @ result.areas[wall] for k in ("sun_direct", "sun_specular"))
    assert direct == pytest.approx(12 * lux, rel=1e-9)
    assert mirrored == pytest.approx(0.9 * 2 * lux, rel=1e-9)
    at = result.at([[0, 1, 0.5], [0, 1, 1.5], [1.5, 1, 0.5]], [[0, -1, 0]] * 3)
    np.testing.assert_allclose(at / lux, [1.9, 1, 1], rtol=1e-9)


@pytest.mark.parametrize(
    ("turned", "two_sided", "share"), [(1, False, 0.9), (-1, False, 0), (-1, True, 0.9), (1, True, 0.9)]
)
def test_mirrors_reflect_from_their_front_or_both_sides(turned, two_sided, share):
    scene = luz.Scene()
    scene.add("mirror", rectangle((-1, 1), (0, 1), 0)[::turned], MIRROR, two_sided=two_sided)
    scene.add("wall", WALL, BLACK)
    result = prepare_coarse(scene).solve(sun(0, -1, 1))
    mirrored = result.components["sun_specular"] @ result.areas
    assert mirrored == pytest.approx(share * 2 * DNI * math.sqrt(0.5), rel=1e-9, abs=1e-6)


@pytest.mark.parametrize("direction", [(1, 1.1, 0.93), (0.4, 0.8, 0.6), (0.9, 0.31, 1.17)])
def test_corner_of_three_mirrors_sends_the_light_back(direction):
    """Unit corner of three mirrors: at each point, the light by every order of mirrors, traced back by hand."""
    towards = np.array(direction) / np.linalg.norm(direction)
    squares = {
        "x": [[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]],
        "y": [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]],
        "z": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    }
    result = prepare_coarse(scene_of(squares, luz.Material(specular_reflectance=0.8))).solve(
        luz.Daylight(sun=luz.Sun(direction=towards, normal_illuminance=1.0))
    )
    step = (np.arange(400) + 0.5) / 400
    first, second = (x.ravel() for x in np.meshgrid(step, step))
    for axis, name in enumerate("xyz"):
        point = np.zeros((len(first), 3))
        point[:, (axis + 1) % 3], point[:, (axis + 2) % 3] = first, second
        expected = np.zeros(len(first))
        for order in _orders(axis):
            expected += towards[axis] * 0.8 ** len(order) * _path_is_whole(point, towards, order)
        assert flux(result, name) == pytest.approx(expected.mean(), rel=4e-3)
        some = np.arange(0, len(first), 2311)
        normal = np.eye(3)[axis]
        got = result.at(point[some], np.broadcast_to(normal, (len(some), 3)))
        np.testing.assert_allclose(got, expected[some], rtol=1e-9)


def _orders(axis):
    """Mirrors met backwards from a point of square ``axis``: none, each other one, both in either order."""
    one, two = [k for k in range(3) if k != axis]
    return [(), (one,), (two,), (one, two), (two, one)]


def _path_is_whole(point, towards, order):
    """Whether the path back from each point meets just these unit squares, one after the other, and then the Sun."""
    here, travel = point.copy(), towards.copy()
    for axis in order:
        travel[axis] *= -1  # before its last reflection there, light came from the mirrored side
    alive = np.ones(len(point), bool)
    for axis in order:
        distance = np.where(travel[axis] < 0, -here[:, axis] / travel[axis], np.inf)
        others = [k for k in range(3) if k != axis]
        for other in others:
            if travel[other] < 0:
                alive &= distance < np.where(here[:, other] > 0, -here[:, other] / travel[other], np.inf)
        with np.errstate(invalid="ignore"):
            here = here + distance[:, None] * travel
        here[:, axis] = 0
        alive &= (here[:, others] >= 0).all(axis=1) & (here[:, others] <= 1).all(axis=1)
        travel[axis] *= -1
    return alive


def test_a_point_where_two_mirrored_beams_meet_is_lit_by_one():
    """Corner of two mirrors, Sun on its diagonal: on the floor's diagonal the two twice-mirrored beams touch."""
    scene = luz.Scene()
    scene.add("x", [[0, 0, 0], [0, 9, 0], [0, 9, 9], [0, 0, 9]], MIRROR)
    scene.add("y", [[0, 0, 0], [0, 0, 9], [9, 0, 9], [9, 0, 0]], MIRROR)
    scene.add("floor", rectangle((0, 9), (0, 9), 0), BLACK)
    result = prepare_coarse(scene).solve(sun(1, 1, 1))
    beside, on, other = result.at([[0.9, 1, 0], [1, 1, 0], [1.1, 1, 0]], [[0, 0, 1]] * 3)
    assert beside == pytest.approx(other) == pytest.approx(on)


def test_chains_are_cut_where_they_are_weak_and_booked():
    """Two facing mirrors, each reflection halves the beam; the cut-off decides how many are followed.

    Light that slips in under the upper plate is 2 m wide on the lower one, then on the upper, and so on.
    """
    plates = {"low": rectangle((0, 20), (0, 1), 0), "high": rectangle((1, 20), (0, 1), 1)[::-1]}
    light = luz.Daylight(sun=luz.Sun(direction=(-1, 0, 1), normal_illuminance=1.0))
    lux = math.sqrt(0.5)
    for cutoff, on_high, lost in ((0.4, 1.0, 0.5), (0.2, 1.0, 0.25), (0.1, 1.25, 0.125)):
        scene = scene_of(plates, luz.Material(specular_reflectance=0.5))
        result = prepare_coarse(scene, specular_cutoff=cutoff, bands=4).solve(light)
        assert flux(result, "high") / lux == pytest.approx(on_high, rel=1e-9)
        assert result.sunlight.truncated / lux == pytest.approx(lost, rel=1e-9)


@given(st.floats(-0.5, 1.5), st.floats(-0.5, 1.5), st.floats(0.05, 1.0), st.floats(0, 6.28))
def test_lit_share_against_clipped_area(x, y, size, turn):
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0.2, 0.9, 0.0]])
    spin = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    square = np.c_[np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * size @ spin + [x, y], np.zeros(4)]
    points = np.random.default_rng(0).dirichlet([1, 1, 1], 20_000) @ triangle
    edge = np.roll(square, -1, axis=0) - square
    inside = np.ones(len(points), bool)
    for a, e in zip(square, edge, strict=True):
        inside &= e[0] * (points[:, 1] - a[1]) - e[1] * (points[:, 0] - a[0]) >= 0
    share = lit_share(triangle[None], square)[0]
    assert share == pytest.approx(inside.mean(), abs=0.015)
    assert lit_share(triangle[None], square[::-1])[0] == pytest.approx(share, abs=1e-12)


def test_lit_share_of_all_some_and_none():
    triangles = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]]) + np.array([[[0, 0, 0]], [[10, 0, 0]], [[1.5, 0, 0]]])
    square = np.array([[-1, -1, 0], [2, -1, 0], [2, 2, 0], [-1, 2, 0.0]])
    np.testing.assert_allclose(lit_share(triangles, square), [1, 0, 0.75])


def test_lit_share_of_polygons_with_doubled_corners():
    """Clipping leaves corners that differ by rounding alone; the edge between them points anywhere, bounds nothing."""
    triangles = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0.0]], [[3, 0, 0], [4, 0, 0], [3, 1, 0.0]]])
    square = np.array([[-1, -1, 0], [2, -1, 0], [2, 2, 0], [-1, 2, 0.0]])
    rng = np.random.default_rng(0)
    for _ in range(40):
        doubled = np.repeat(square, 2, axis=0)
        doubled[1::2, :2] += rng.integers(-2, 3, (4, 2)) * 2.2e-16
        np.testing.assert_allclose(lit_share(triangles, doubled), [1, 0], atol=1e-9)


def by_noon(light_shelf, variant):
    transfer = prepare_coarse(light_shelf.scene(variant), max_area=0.02, bands=4)
    return transfer.solve(light_shelf.daylight(12.0, sky=None), cycles=0)


def test_the_papers_patch_on_the_ceiling(light_shelf):
    """Noon, mirror shelf: between 3 - 2.23 and 3 - 1.48 m from the back, over the full width."""
    result = by_noon(light_shelf, "S1")
    faces = result.faces_of("ceiling")
    altitude = math.radians(light_shelf.sun_position(12.0)[0])
    lux = 0.9 * 80_000 * math.sin(altitude)
    up = (3 - light_shelf.SHELF_TOP) / math.tan(altitude)
    near, far = 3 - up, 2.25 - up
    assert (far, near) == (pytest.approx(3 - 2.23, abs=0.005), pytest.approx(3 - 1.48, abs=0.005))
    mirrored = result.components["sun_specular"][faces]
    assert mirrored @ result.areas[faces] == pytest.approx(lux * 3 * 0.75, rel=1e-9)
    y = result.vertices[faces, :, 1]
    np.testing.assert_allclose(mirrored[(y.min(axis=1) > far) & (y.max(axis=1) < near)], lux, rtol=1e-9)
    assert not mirrored[(y.max(axis=1) < far) | (y.min(axis=1) > near)].any()
    straddling = (y.min(axis=1) < far) & (y.max(axis=1) > far)
    assert (mirrored[straddling] > 0).any() and (mirrored[straddling] < lux).all()


def test_the_papers_second_patch_on_the_back_wall(light_shelf):
    """Mirror ceiling: the twice-reflected Sun between z = 1.75 and 2.37 m on the back wall."""
    result = by_noon(light_shelf, "S2")
    faces = result.faces_of("wall_south")
    altitude = math.radians(light_shelf.sun_position(12.0)[0])
    lux = 0.9 * 0.6 * 80_000 * math.cos(altitude)
    near = 3 - (3 - light_shelf.SHELF_TOP) / math.tan(altitude)
    low, high = 3 - near * math.tan(altitude), 3 - (near - 0.75) * math.tan(altitude)
    assert (low, high) == (pytest.approx(1.75, abs=0.005), pytest.approx(2.37, abs=0.005))
    mirrored = result.components["sun_specular"][faces]
    z = result.vertices[faces, :, 2]
    np.testing.assert_allclose(mirrored[(z.min(axis=1) > low) & (z.max(axis=1) < high)], lux, rtol=1e-9)
    assert not mirrored[(z.max(axis=1) < low) | (z.min(axis=1) > high)].any()
    assert mirrored @ result.areas[faces] == pytest.approx(lux * 3 * (high - low), rel=1e-6)


def test_sunlight_in_the_paper_room_is_conserved(light_shelf):
    """What passes the opening lands: floor and wall below the shelf, the shelf itself, its black underside's back."""
    result = by_noon(light_shelf, "D")
    altitude = math.radians(light_shelf.sun_position(12.0)[0])
    through = 3 * 1.5 * 80_000 * math.cos(altitude)
    inside = [flux(result, k) for k in ("floor", "wall_south", "wall_west", "wall_east", "ceiling", "shelf_top")]
    slot = 3 * 0.05 * 80_000 * math.cos(altitude)  # between the shelf's sheets, on the lower one's back
    sheltered = slot if 0.05 / math.tan(altitude) < 0.75 else 0.0
    assert sum(inside) + sheltered == pytest.approx(through, rel=1e-9)


def test_a_box_keeps_the_sun_out():
    result = prepare_coarse(box(luz.Material(diffuse_reflectance=0.5))).solve(sun(0.3, 0.2, 1))
    np.testing.assert_allclose(result.illuminance, 0, atol=1e-6)
    np.testing.assert_allclose(result.at([[0.5, 0.5, 0.5]], [[0, 0, 1]]), 0, atol=1e-6)


def area_inside(triangle, low, high):
    """Area of a plane triangle inside a rectangle, by clipping its loop at one side after the other."""
    loop = [np.asarray(corner, float) for corner in triangle]
    for axis, sign, level in ((0, 1, low[0]), (0, -1, -high[0]), (1, 1, low[1]), (1, -1, -high[1])):
        kept = []
        for a, b in zip(loop, [*loop[1:], *loop[:1]], strict=True):
            here, there = sign * a[axis] - level, sign * b[axis] - level
            if here >= 0:
                kept.append(a)
            if (here >= 0) != (there >= 0):
                kept.append(a + here / (here - there) * (b - a))
        loop = kept
    x, y = np.array(loop).reshape(-1, 2).T
    return 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))


@settings(max_examples=25, deadline=None)
@given(st.floats(35, 60), st.floats(-40, 40), st.sampled_from([1, 2]), st.floats(0.01, 0.5))
def test_faces_have_the_lit_share_of_a_patch_by_one_mirror_and_two(altitude, azimuth, mirrors, half_width):
    """A mirror at the ground throws its own outline, moved along; its corners lie anywhere inside coarse faces."""
    up, around = math.radians(altitude), math.radians(azimuth)
    step = -np.array([math.sin(around), math.cos(around)]) / math.tan(up)
    low, high = np.array([-half_width, -0.3]), np.array([half_width, 0.4])

    def plate(way, level):
        return rectangle(*((low[k] + way * step[k] - 0.7, high[k] + way * step[k] + 0.9) for k in (0, 1)), level)

    grey = luz.Material(diffuse_reflectance=0.5)
    scene = luz.Scene()
    scene.add("first", rectangle((low[0], high[0]), (low[1], high[1]), 0), MIRROR)
    scene.add("above", plate(3, 3)[::-1], MIRROR if mirrors == 2 else grey)
    scene.add("below", plate(7, -1), grey)
    result = prepare_coarse(scene, elements=20, patches=5, bands=4, max_area=0.9).solve(
        sun(math.sin(around), math.cos(around), math.tan(up)), cycles=0
    )
    faces = result.faces_of("below" if mirrors == 2 else "above")
    moved = (7 if mirrors == 2 else 3) * step
    share = [
        area_inside(corners[:, :2], low + moved, high + moved) / area
        for corners, area in zip(result.vertices[faces], result.areas[faces], strict=True)
    ]
    assert any(0 < s < 1 for s in share)
    lux = 0.9**mirrors * DNI * math.sin(up)
    np.testing.assert_allclose(result.components["sun_specular"][faces] / lux, share, atol=1e-9)


@pytest.mark.parametrize("altitude", [10, 1, 0.1, 0.01])
def test_a_mirror_at_grazing_sun_keeps_its_lumens(altitude):
    """The mirrored strip on the wall is as narrow as the Sun is low; all of it arrives."""
    scene = luz.Scene()
    scene.add("mirror", rectangle((-1, 1), (-1, 1), 0), MIRROR)
    scene.add("wall", [[2, 1, -1], [2, 1, 3], [-2, 1, 3], [-2, 1, -1]], BLACK)
    up = math.radians(altitude)
    result = prepare_coarse(scene, bands=4).solve(sun(0, -math.cos(up), math.sin(up)))
    mirrored = result.components["sun_specular"] @ result.areas
    assert flux(result, "mirror") == pytest.approx(4 * DNI * math.sin(up), rel=1e-9)
    assert mirrored == pytest.approx(0.9 * 4 * DNI * math.sin(up), rel=1e-6)


@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-5])
def test_the_lumens_of_slits(width):
    """A slit between two plates, slanted across the faces beneath it."""
    turn = np.array([[math.cos(0.4), math.sin(0.4), 0], [-math.sin(0.4), math.cos(0.4), 0], [0, 0, 1]])
    scene = scene_of(
        {
            "floor": rectangle((-1, 1), (-1, 1), 0),
            "left": rectangle((-9, -width / 2), (-9, 9), 1) @ turn,
            "right": rectangle((width / 2, 9), (-9, 9), 1) @ turn,
        }
    )
    result = prepare_coarse(scene, bands=4).solve(sun(0, 0, 1))
    length = 2 / math.cos(0.4)
    assert flux(result, "floor") / DNI == pytest.approx(width * length, rel=1e-4)
