"""The Sun's disc: penumbrae against closed forms, and against many collimated Suns."""

import dataclasses
import math

import numpy as np
import pytest
from builders import BLACK, box, flux, prepare_coarse, scene_of

import luzespecular as luz
from luzespecular import disc
from luzespecular.sunlight import trace_sun

DNI = 80_000.0
RADIUS = math.tan(math.radians(0.533 / 2))
GREY = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.9)


def sun(*direction, disc=True):
    return luz.Daylight(sun=luz.Sun(direction=direction, normal_illuminance=DNI, disc=disc))


def at_altitude(degrees, disc=True):
    return luz.Daylight(sun=luz.Sun(altitude=degrees, azimuth=180, normal_illuminance=DNI, disc=disc))


def rectangle(x, y, z):
    """Horizontal rectangle that looks up; ``x`` and ``y`` are pairs."""
    return np.array([[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]], float)


def above_chord(height):
    """Share of a unit disc above a chord at this signed height (closed form)."""
    h = np.clip(height, -1, 1)
    return (np.arccos(h) - h * np.sqrt(1 - h**2)) / math.pi


def under_a_half_plane(points, height, edge_direction, towards):
    """Illuminance on the floor under a half-plane at x > 0 turned by an angle about the vertical, per DNI.

    The plane's edge passes through the origin's Sun; the centroid of the visible segment sets the cosine.
    """
    along = np.array([-math.sin(edge_direction), math.cos(edge_direction), 0.0])
    towards = np.asarray(towards) / np.linalg.norm(towards)
    base = towards * height / towards[2]
    first = base - points
    normal = np.cross(first, along)  # of the plane through the point and the edge
    normal *= np.sign(normal @ np.array([-math.cos(edge_direction), -math.sin(edge_direction), 0.0]))[:, None]
    offset = normal @ towards
    across = normal - offset[:, None] * towards
    width = np.linalg.norm(across, axis=1)
    chord = np.clip(-offset / (width * RADIUS), -1, 1)
    moment = 2 / 3 * (1 - chord**2) ** 1.5 / math.pi * RADIUS
    return above_chord(chord) * towards[2] + moment * across[:, 2] / width


def half_plane_scene(height, turn, towards, floor):
    towards = np.asarray(towards) / np.linalg.norm(towards)
    spin = np.array([[math.cos(turn), math.sin(turn), 0], [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    size = 30 * height
    plate = rectangle((0, size), (-size, size), height) @ spin
    plate[:, :2] += height * towards[:2] / towards[2]
    return scene_of({"floor": floor, "plate": plate}, BLACK, floor=GREY)


DIRECTIONS = [(0, 0, 1), (0.3, -0.5, 0.8), (1, 0.2, 0.4)]


@pytest.mark.parametrize("towards", DIRECTIONS)
@pytest.mark.parametrize("height", [0.5, 4, 60])
def test_penumbra_of_an_edge_at_points(towards, height):
    """Share of the disc above the chord, at points right across the penumbra; never more than the Sun gives."""
    wide = height * RADIUS / (np.asarray(towards) / np.linalg.norm(towards))[2] ** 2
    floor = rectangle((-4 * wide, 4 * wide), (-4 * wide, 4 * wide), 0)
    result = prepare_coarse(half_plane_scene(height, 0.3, towards, floor), bands=4).solve(sun(*towards), cycles=0)
    x = np.linspace(-1.9 * wide, 1.9 * wide, 41)
    points = np.stack([x, 0.3 * x, 0 * x], axis=1)
    exact = DNI * under_a_half_plane(points, height, 0.3, towards)
    assert exact.min() == 0 and exact.max() == pytest.approx(DNI * towards[2] / np.linalg.norm(towards))
    assert 10 < ((exact > 1) & (exact < exact.max() - 1)).sum() < 40
    got = result.at(points, np.broadcast_to([0, 0, 1], points.shape))
    np.testing.assert_allclose(got, exact, atol=1e-3 * exact.max())


@pytest.mark.parametrize("towards", DIRECTIONS)
@pytest.mark.parametrize("turn", [0.0, 0.3])
@pytest.mark.parametrize("height", [0.3, 2, 5, 9, 14, 20, 100])
def test_penumbra_of_an_edge_on_faces(towards, turn, height):
    """Faces of 0.1 m and penumbrae from 0.03 to 60 times as wide: means within 0.5 % of the full illuminance."""
    floor = rectangle((-0.3, 0.3), (-0.3, 0.3), 0)
    scene = half_plane_scene(height, turn, towards, floor)
    result = prepare_coarse(scene, elements=10, patches=10, bands=4, max_area=0.00501).solve(sun(*towards), cycles=0)
    faces = result.faces_of("floor")
    assert len(faces) == 72
    side = 40
    places = [((i + 1 / 3) / side, (j + 1 / 3) / side) for i in range(side) for j in range(side - i)]
    places += [((i + 2 / 3) / side, (j + 2 / 3) / side) for i in range(side) for j in range(side - 1 - i)]
    places = np.array(places)
    corners = result.vertices[faces]
    points = np.einsum("qt,ntc->nqc", np.column_stack([1 - places.sum(axis=1), places]), corners)
    exact = under_a_half_plane(points.reshape(-1, 3), height, turn, towards).reshape(len(faces), -1).mean(axis=1)
    full = towards[2] / np.linalg.norm(towards)
    error = (result.illuminance[faces] / DNI - exact) / full
    assert np.abs(error).max() < 5e-3
    assert abs(error.mean()) < 1e-3


def test_a_plate_too_small_to_hide_the_disc():
    """0.1 m at 50 m: the shadow has no core, and takes away the plate's own lumens."""
    scene = scene_of({"floor": rectangle((-1, 1), (-1, 1), 0), "plate": rectangle((-0.05, 0.05), (-0.05, 0.05), 50)})
    result = prepare_coarse(scene, bands=4).solve(sun(0, 0, 1))
    darkest = 1 - 0.01 / (math.pi * (50 * RADIUS) ** 2)
    assert result.at([[0, 0, 0]], [[0, 0, 1]])[0] / DNI == pytest.approx(darkest, rel=1e-4)
    assert 4 - flux(result, "floor") / DNI == pytest.approx(0.01, rel=5e-3)


def test_a_pinhole_draws_the_sun():
    """A hole of 2 mm at 5 m: a round patch 47 mm across, where parallel rays would light 2 mm."""
    hole, high = 0.001, 5.0
    sides = [((-1, -hole), (-1, 1)), ((hole, 1), (-1, 1)), ((-hole, hole), (-1, -hole)), ((-hole, hole), (hole, 1))]
    roof = {f"roof {k}": rectangle(x, y, high) for k, (x, y) in enumerate(sides)}
    scene = scene_of({"floor": rectangle((-0.05, 0.05), (-0.05, 0.05), 0), **roof}, floor=GREY)
    result = prepare_coarse(scene, elements=1000, bands=4).solve(sun(0, 0, 1), cycles=0)
    inside = 4 * hole**2 / (math.pi * (high * RADIUS) ** 2)
    at = result.at([[0, 0, 0], [0.02, 0, 0], [0.015, 0.015, 0], [0.026, 0, 0]], [[0, 0, 1]] * 4)
    np.testing.assert_allclose(at / DNI, [inside, inside, inside, 0], rtol=1e-3, atol=1e-9)
    assert flux(result, "floor") / DNI == pytest.approx(4 * hole**2, rel=5e-3)


def test_half_the_disc_behind_a_pane():
    """Under the edge of a pane half of the disc comes through it, half comes straight."""
    scene = scene_of(
        {"floor": rectangle((-1, 1), (-1, 1), 0), "pane": rectangle((0, 2), (-2, 2), 3)},
        pane=luz.Material(regular_transmittance=0.6),
    )
    result = prepare_coarse(scene, bands=4).solve(sun(0, 0, 1))
    at = result.at([[0, 0, 0], [0.1, 0, 0], [-0.1, 0, 0], [1.5 * RADIUS, 0, 0]], [[0, 0, 1]] * 4)
    np.testing.assert_allclose(at / DNI, [0.8, 0.6, 1, 0.6 + 0.4 * above_chord(0.5)], rtol=1e-4)
    assert flux(result, "floor") / DNI == pytest.approx(2 * (1 + 0.6), rel=1e-4)


@pytest.mark.parametrize("mirrors", [1, 2])
def test_penumbra_of_a_mirrors_edge(mirrors):
    """The patch of a mirror is as blurred as the whole way from its edge asks for, by one mirror and by two."""
    scene = luz.Scene()
    scene.add("mirror", rectangle((-1, 1), (0, 1), 0), MIRROR)
    if mirrors == 2:
        scene.add("ceiling", rectangle((-3, 3), (2, 9), 3)[::-1], MIRROR)
    up = math.radians(45)
    height = 1.0 + 6.0 * (mirrors - 1)  # the ray over the mirror's far edge: 1 m up, or up and down again between
    wall = 1.0 + height / math.tan(up)
    scene.add("wall", [[3, wall, -3], [3, wall, 2.9], [-3, wall, 2.9], [-3, wall, -3]], BLACK)
    result = prepare_coarse(scene, bands=4).solve(at_altitude(45))
    edge = 1.0 if mirrors == 1 else -1.0
    share = 0.9**mirrors
    where = np.linspace(-1.5, 1.5, 7)
    way = height / math.sin(up)
    z = edge + where * RADIUS * way / math.cos(up)
    points = np.stack([0 * z, 0 * z + wall, z], axis=1)
    normals = np.broadcast_to([0.0, -1.0, 0.0], points.shape)
    got = result.at(points, normals)
    plain = prepare_coarse(scene, bands=4).solve(at_altitude(45, disc=False))
    behind = plain.at(points[[0, -1]] + [[0, 0, -0.3], [0, 0, 0.3]], normals[[0, -1]])
    level = behind.min()
    assert behind.max() - level == pytest.approx(share * DNI * math.cos(up), rel=1e-9)
    lit = above_chord(where if behind[0] > behind[1] else -where)
    np.testing.assert_allclose((got - level) / (share * DNI * math.cos(up)), lit, atol=0.01)


def room(mirror=MIRROR):
    """A room with a window, a mirror on the floor and one on the ceiling, and something in the way."""
    return scene_of(
        {
            "floor": rectangle((0, 4), (0, 4), 0),
            "mirror": rectangle((1.1, 2.9), (0.4, 1.9), 0.2),
            "ceiling": rectangle((0, 4), (0, 4), 3)[::-1],
            "below": [[0, 0, 0], [0, 0, 1], [4, 0, 1], [4, 0, 0]],
            "above": [[0, 0, 2], [0, 0, 3], [4, 0, 3], [4, 0, 2]],
            "bar": [[1.8, 0.1, 0.9], [2.1, 0.1, 0.9], [2.2, 0.1, 2.2], [1.9, 0.1, 2.2]],
            "north": [[4, 4, 0], [4, 4, 3], [0, 4, 3], [0, 4, 0]],
        },
        GREY,
        mirror=mirror,
        ceiling=MIRROR,
    )


SLANTED = luz.Daylight(sun=luz.Sun(altitude=50, azimuth=170, normal_illuminance=1.0, disc=True))


def many_suns(light, count=100):
    """Collimated Suns that make up the disc: equal shares on a spiral (Vogel 1979)."""
    number = np.arange(count) + 0.5
    turn = number * math.pi * (3 - math.sqrt(5))
    place = np.sqrt(number / count) * [np.cos(turn), np.sin(turn)]
    centre = np.asarray(light.sun.direction)
    east = np.array([-centre[1], centre[0], 0]) / math.hypot(centre[0], centre[1])
    axes = RADIUS * np.stack([east, np.cross(centre, east)])
    directions = centre + place.T @ axes
    return directions / np.linalg.norm(directions, axis=1)[:, None]


def test_a_room_with_mirrors_against_many_suns():
    transfer = prepare_coarse(room(), elements=600, bands=4)
    geometry, sunlight = transfer.geometry, transfer.solve(SLANTED, cycles=0).sunlight
    points = geometry.element_points[::5]
    normals = geometry.element_normals[::5]
    where = geometry.triangles, geometry.planes.outline_sheet
    mean, at = np.zeros((2, len(geometry.element_points))), np.zeros((2, len(points)))
    for direction in many_suns(SLANTED):
        one = trace_sun(geometry.outlines, direction, 1 / 100, 1e-3, lambda: None)
        mean += one.on_elements(*where)
        at += one.at(geometry.outlines, points, normals)
    got = np.array(sunlight.on_elements())
    assert (mean > 0.05).any(axis=1).all()
    assert np.abs(got - mean).max() < 3e-3
    assert np.abs(np.array(sunlight.at(geometry.outlines, points, normals)) - at).max() < 1.5e-2
    area = geometry.fracture.element_areas
    np.testing.assert_allclose(got @ area, mean @ area, rtol=2e-4)


def test_interreflected_light_follows_the_disc():
    """The patches' edges are blurred, their lumens stay: what they send on is that of many Suns within 0.1 %."""
    scene = scene_of(
        {
            "floor": rectangle((0, 4), (0, 4), 0),
            "wall": [[4, 4, 0], [4, 4, 3], [0, 4, 3], [0, 4, 0]],
            "roof": rectangle((0, 4), (0, 2), 3)[::-1],
        },
        GREY,
    )
    transfer = prepare_coarse(scene, elements=250, patches=60, bands=6)
    points, normals = [[2, 3, 1.5], [1, 3, 0.5]], [[0, 1, 0], [0, -1, 0.5]]
    light, components = at_altitude(50), 0.0
    places, weights = disc.quadrature(-1.0)
    for direction, weight in zip(places @ light.sun.disc_axes, weights, strict=True):
        one = transfer.solve(luz.Daylight(sun=luz.Sun(direction=direction, normal_illuminance=weight * DNI)), cycles=1)
        components = components + one.components["interreflected"]
    result = transfer.solve(light, cycles=1)
    got = result.components["interreflected"]
    assert got @ result.areas == pytest.approx(components @ result.areas, rel=1e-3)
    np.testing.assert_allclose(got, components, atol=3e-3 * components.max())
    plain = transfer.solve(at_altitude(50, disc=False), cycles=1)
    np.testing.assert_allclose(result.at(points, normals), plain.at(points, normals), rtol=3e-3)
    assert got @ result.areas > 1000 and abs(transfer.solve(light).balance.defect) < 0.02


def test_light_that_only_the_rim_of_the_sun_gives_is_sent_on():
    """A pad in the core of the collimated shadow, but lit by the disc's rim: it lights the wall beside it."""
    pads = {
        "pad": rectangle((-0.04, 0.04), (-0.04, 0.04), 0),
        "wall": [[0.06, 0.04, 0], [0.06, -0.04, 0], [0.06, -0.04, 0.05], [0.06, 0.04, 0.05]],
        "other": rectangle((-3, -2), (-1, 1), 0),
    }
    plate = {"plate": rectangle((-0.05, 0.05), (-0.05, 0.05), 50)}
    found = []
    for polygons, light in ((pads, sun(0, 0, 1, disc=False)), (pads | plate, sun(0, 0, 1))):
        result = prepare_coarse(scene_of(polygons, GREY), bands=24).solve(light, cycles=1)
        wall = result.faces_of("wall")
        assert result.sunlight.patches
        found.append(result.components["interreflected"][wall] @ result.areas[wall])
    assert found[0] > 1
    assert found[1] / found[0] == pytest.approx(1 - 0.01 / (math.pi * (50 * RADIUS) ** 2), rel=0.05)


@pytest.mark.parametrize("altitude", [20, 50, 80])
def test_what_is_beneath_the_floor_casts_no_shadow(altitude):
    """A plate that stands through the floor takes away what its upper part is struck by."""
    plate = [[-0.5, 0.13, -3], [0.5, 0.13, -3], [0.5, 0.13, 0.7], [-0.5, 0.13, 0.7]]
    scene = scene_of({"floor": rectangle((-9, 9), (-9, 9), 0), "plate": plate}, BLACK)
    result = prepare_coarse(scene, bands=4).solve(at_altitude(altitude))
    up = math.radians(altitude)
    lost = 18 * 18 * math.sin(up) - flux(result, "floor") / DNI
    assert lost == pytest.approx(0.7 * math.cos(up), rel=1e-3)
    points = [[0.3, 0.33, 0], [0.3, -0.07, 0], [0.3, -2, 0]]
    got = result.at(points, [[0, 0, 1]] * 3)
    np.testing.assert_allclose(got / (DNI * math.sin(up)), [0.2 > 0.7 / math.tan(up), 1, 1], atol=1e-4)


def test_what_is_behind_a_mirror_is_not_in_the_way():
    """Behind the mirror's plane, where its image of the Sun stands, a plate hides nothing."""
    scene = luz.Scene()
    scene.add("mirror", rectangle((-1, 1), (0, 1), 0), MIRROR)
    scene.add("plate", [[-3, -0.5, -3], [3, -0.5, -3], [3, -0.5, 0.1], [-3, -0.5, 0.1]], BLACK)
    scene.add("wall", [[3, 1.5, 0], [3, 1.5, 3], [-3, 1.5, 3], [-3, 1.5, 0]], BLACK)
    result = prepare_coarse(scene, bands=4).solve(at_altitude(45))
    cosine = math.sqrt(0.5)
    assert result.components["sun_specular"] @ result.areas == pytest.approx(0.9 * 2 * DNI * cosine, rel=1e-4)
    both = result.at([[0, 1.5, 1.0]], [[0, -1, 0]])
    np.testing.assert_allclose(both / DNI, 1.9 * cosine, rtol=1e-4)


def test_lumens_are_those_of_the_collimated_sun():
    transfer = prepare_coarse(room(), elements=600, bands=4, max_area=0.02)
    parallel = dataclasses.replace(SLANTED, sun=dataclasses.replace(SLANTED.sun, disc=False))
    round_, sharp = transfer.solve(SLANTED, cycles=0), transfer.solve(parallel, cycles=0)
    for name in ("sun_direct", "sun_specular"):
        assert round_.components[name] @ round_.areas == pytest.approx(sharp.components[name] @ sharp.areas, rel=1e-3)
    assert np.abs(round_.illuminance - sharp.illuminance).max() > 0.01


def test_beams_below_the_cutoff_are_booked():
    """Between two mirrors the beam goes on until it is weaker than the cut-off."""
    scene = luz.Scene()
    scene.add("mirror", rectangle((-1, 1), (-9, 9), 0), luz.Material(specular_reflectance=0.12))
    scene.add("opposite", rectangle((-2, 2), (-8, 9), 1)[::-1], luz.Material(specular_reflectance=0.12))
    transfer = prepare_coarse(scene, bands=4)
    round_, sharp = (transfer.solve(at_altitude(60, disc=kind)) for kind in (True, False))
    assert round_.sunlight.truncated == pytest.approx(sharp.sunlight.truncated, rel=5e-3)
    assert 0 < round_.sunlight.truncated < 0.01 * DNI


@pytest.mark.parametrize(
    ("altitude", "visible"), [(3, 1), (0.2665, 1), (0.1, above_chord(-0.1 / 0.2665)), (0, 0.5), (-0.2665, 0), (-9, 0)]
)
def test_a_disc_that_the_horizon_cuts(altitude, visible):
    """A wall that faces the Sun gets the share of the disc that is up, the ground the part's own sine."""
    scene = scene_of({"wall": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], "ground": rectangle((0, 1), (-2, -1), 0)})
    light = at_altitude(altitude)
    result = prepare_coarse(scene, bands=4).solve(light)
    for values in (result.illuminance, result.at(result.centroids, result.normals)):
        np.testing.assert_allclose(values[result.faces_of("wall")] / DNI, visible, atol=2e-3)
        np.testing.assert_allclose(values[result.faces_of("ground")], light.sun.horizontal_illuminance, rtol=1e-6)
    assert (result.sunlight.beams != []) == (visible > 0)


def test_one_disc_lights_both_sides_of_a_plate_on_edge():
    """A standing plate along the Sun: each side gets half of the disc, 2/(3π) of its radius."""
    scene = luz.Scene()
    scene.add("plate", [[0, -1, 0], [0, 1, 0], [0, 1, 1], [0, -1, 1]], GREY, two_sided=True)
    result = prepare_coarse(scene, bands=4).solve(at_altitude(40), cycles=0)
    exact = DNI * RADIUS * 2 / (3 * math.pi)
    np.testing.assert_allclose(result.illuminance, exact, rtol=1e-6)
    np.testing.assert_allclose(result.back.illuminance, exact, rtol=1e-6)


def test_a_closed_box_keeps_the_disc_out():
    result = prepare_coarse(box(GREY), bands=4).solve(sun(0.3, 0.2, 1))
    np.testing.assert_allclose(result.illuminance, 0, atol=1e-6)
    np.testing.assert_allclose(result.at([[0.5, 0.5, 0.5]], [[0, 0, 1]]), 0, atol=1e-6)
