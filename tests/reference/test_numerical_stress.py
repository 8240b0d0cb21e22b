"""Situations that break numerics: extremes of scale and place, slivers, doubled faces, receivers on edges and planes.

Exact values by Lambert's formula; a scene with a blemish must give what the scene without it gives.
"""

import math

import numpy as np
import pytest
from builders import BLACK, DARK, prepare_coarse

import luzespecular as luz

SKY = luz.Daylight(sky=luz.UniformSky(5000.0))
ROOM = {
    "floor": [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]],
    "west": [[0, 0, 0], [0, 4, 0], [0, 4, 3], [0, 0, 3]],
    "east": [[4, 0, 3], [4, 4, 3], [4, 4, 0], [4, 0, 0]],
    "north": [[4, 4, 0], [4, 4, 3], [0, 4, 3], [0, 4, 0]],
    "south": [[0, 0, 0], [0, 0, 3], [4, 0, 3], [4, 0, 0]],
    "ceiling west": [[0, 4, 3], [1.5, 4, 3], [1.5, 0, 3], [0, 0, 3]],
    "ceiling east": [[2.5, 4, 3], [4, 4, 3], [4, 0, 3], [2.5, 0, 3]],
    "ceiling south": [[1.5, 1.5, 3], [2.5, 1.5, 3], [2.5, 0, 3], [1.5, 0, 3]],
    "ceiling north": [[1.5, 4, 3], [2.5, 4, 3], [2.5, 2.5, 3], [1.5, 2.5, 3]],
}
POINTS = np.array([[2, 2, 0], [0.2, 0.28, 0], [4, 2, 1.5], [2, 4, 2.85]])
NORMALS = np.array([[0, 0, 1], [0, 0, 1], [-1, 0, 0], [0, -1, 0]])
EXACT = np.array([535.748281472, 195.730376383, 381.470097302, 100.326816037])


def room(change=lambda p: p, without=(), **more):
    scene = luz.Scene()
    for name, polygon in ROOM.items():
        if name not in without:
            scene.add(name, change(np.array(polygon, float)), BLACK)
    for name, polygon in more.items():
        scene.add(name, change(np.array(polygon, float)), BLACK)
    return scene


def lux(scene, points=POINTS, normals=NORMALS):
    result = prepare_coarse(scene, elements=80, bands=60).solve(SKY)
    assert np.isfinite(result.illuminance).all()
    assert result.illuminance.max() <= 5000 * math.pi * (1 + 1e-6)
    return result.at(points, normals)


@pytest.fixture(scope="module")
def base():
    return lux(room())


def test_a_black_room_with_a_roof_opening(base):
    np.testing.assert_allclose(base[1:], EXACT[1:], rtol=3e-3)
    # straight below the opening, where parcels are wedges around the zenith
    assert base[0] == pytest.approx(EXACT[0], rel=0.01)


@pytest.mark.parametrize("scale", [0.00025, 0.01, 100, 2500])
def test_any_scale(base, scale):
    np.testing.assert_allclose(lux(room(lambda p: p * scale), POINTS * scale), base, rtol=1e-6)


@pytest.mark.parametrize("shift", [(1e3, -2e3, 500), (1e4, 1e4, -1e4), (1e5, -3e5, 2e5), (1e6, 1e6, 1e6)])
def test_any_place(base, shift):
    np.testing.assert_allclose(lux(room(lambda p: p + shift), POINTS + shift), base, rtol=1e-5)


FLAWS = {
    "sliver": {"sliver": [[1, 1, 1], [2, 1, 1], [2, 1 + 1e-9, 1], [1, 1 + 1e-9, 1]]},
    "floor twice": {"floor again": ROOM["floor"]},
    "floor's back": {"floor from below": ROOM["floor"][::-1]},
    "patch on the floor": {"patch": [[1, 1, 0], [3, 1, 0], [3, 3, 0], [1, 3, 0]]},
}


@pytest.mark.parametrize("flaw", list(FLAWS))
def test_flaws_that_change_nothing(base, flaw):
    np.testing.assert_allclose(lux(room(**FLAWS[flaw])), base, rtol=2e-3)


def test_t_junctions_change_nothing_and_leak_nothing(base):
    parts = {
        "one": [[0, 0, 0], [4, 0, 0], [4, 2, 0], [0, 2, 0]],
        "two": [[0, 2, 0], [1, 2, 0], [1, 4, 0], [0, 4, 0]],
        "three": [[1, 2, 0], [4, 2, 0], [4, 4, 0], [1, 4, 0]],
    }
    scene = room(without=("floor",), **parts)
    np.testing.assert_allclose(lux(scene), base, rtol=1e-6)
    # below the floor, near the junction, looking up: the floor's backs close the view but for its surroundings
    below = lux(scene, [[1, 2, -1e-3], [2, 2, -1e-3]], [[0, 0, 1]] * 2)
    np.testing.assert_allclose(below, 0, atol=0.05)


def test_a_grain_in_the_floor_changes_nothing(base):
    """A triangle of a micrometre, and the mesh around it."""
    e = 1e-6
    corners = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 2, 0], [2 + e, 2, 0], [2, 2 + e, 0]]
    faces = [[4, 5, 6], [0, 1, 5, 4], [1, 2, 5], [2, 6, 5], [2, 3, 6], [3, 0, 4, 6]]
    scene = room(without=("floor",))
    scene.add("floor", corners, BLACK, faces=faces)
    np.testing.assert_allclose(lux(scene), base, rtol=1e-5)


def test_inside_out_blocks_alike():
    """Every wall turned over: nothing is lit on its inner side but free points, which see the same opening."""
    turned = room(lambda p: p[::-1])
    result = prepare_coarse(turned, elements=80, bands=60).solve(SKY)
    assert result.mean("floor") == pytest.approx(0, abs=1e-6), "it looks down"
    np.testing.assert_allclose(result.at(POINTS[1:], NORMALS[1:]), EXACT[1:], rtol=3e-3)


def test_a_screen_with_its_back_to_the_room_closes_the_opening():
    screen = [[1.5, 1.5, 3], [2.5, 1.5, 3], [2.5, 2.5, 3], [1.5, 2.5, 3]]
    np.testing.assert_allclose(lux(room(screen=screen)), 0, atol=0.02)


def test_below_a_very_large_floor():
    """Half a metre under 800 m of floor: what little sky shows beyond its edges."""
    scene = luz.Scene()
    scene.add("floor", np.array([[-400, -400, 0], [400, -400, 0], [400, 400, 0], [-400, 400, 0]], float), BLACK)
    assert 0 <= lux(scene, [[2, 2, -0.5]], [[0, 0, 1]])[0] < 0.03


WALL = [[0, 0, 0], [0, 4, 0], [0, 4, 3], [0, 0, 3]]
LAMP = luz.Material(exitance=1000.0)
AT, EXACT_AT = np.array([[1.2, 1.6, 0.0]]), 258.851758068941


def by_lamp(points=AT, normals=((0, 0, 1),), change=lambda p: p, turn=lambda v: v, **more):
    scene = luz.Scene()
    scene.add("floor", change(np.array(ROOM["floor"], float)), BLACK)
    scene.add("wall", change(np.array(WALL, float)), LAMP)
    for name, (polygon, material) in more.items():
        scene.add(name, change(np.array(polygon, float)), material)
    result = prepare_coarse(scene, elements=500, patches=20, bands=4).solve(DARK)
    return result.at(change(np.array(points, float)), turn(np.array(normals, float))), result


def test_a_luminous_wall():
    at, result = by_lamp()
    assert at[0] == pytest.approx(EXACT_AT, rel=1e-9)
    assert result.mean("floor") == pytest.approx(179.316803150633, rel=0.02)


@pytest.mark.parametrize("angles", [(37, 51, -23), (90, 0, 45), (1e-7, 0, 0)])
def test_a_luminous_wall_turned_and_moved(angles):
    a, b, c = np.radians(angles)
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    turn = lambda v: v @ (z @ y @ x).T  # noqa: E731
    at, _ = by_lamp(change=lambda p: np.add(turn(p), [10, -20, 30]), turn=turn)
    assert at[0] == pytest.approx(EXACT_AT, rel=1e-9)


@pytest.mark.parametrize(
    "more",
    [
        {"leaf": ([[0, 0, 0], [0, 4, 0], [-2, 4, 2], [-2, 0, 2]], BLACK)},
        {"mirror": ([[4, 0, 0], [4, 4, 0], [4, 4, 3], [4, 0, 3]], luz.Material(specular_reflectance=0.9))},
        {"mirror": ([[0, 4, 0], [0, 8, 0], [0, 8, 3], [0, 4, 3]], luz.Material(specular_reflectance=0.9))},
    ],
    ids=["a third leaf at the edge", "a mirror's back", "a mirror in the lamp's own plane"],
)
def test_what_adds_nothing_to_a_luminous_wall(more):
    assert by_lamp(**more)[0][0] == pytest.approx(EXACT_AT, rel=1e-9)


def test_a_receiver_across_the_lamps_plane():
    """The half of the rectangle behind the wall gets nothing, faces that the plane crosses their share."""
    scene = luz.Scene()
    scene.add("rectangle", [[-4, 0, 0], [4, 0, 0], [4, 4, 0], [-4, 4, 0]], BLACK)
    scene.add("wall", WALL, LAMP)
    result = prepare_coarse(scene, elements=5000, patches=20, bands=4).solve(DARK)
    assert result.mean("rectangle") == pytest.approx(89.6584015753, rel=0.02)


def test_a_lamp_partly_below_the_horizon():
    """Only what is above the receiver's plane counts, however the lamp is cut by it."""
    wall = [[1, -1, -2], [1, -1, 1.5], [1, 1, 1.5], [1, 1, -2]]
    scene = luz.Scene()
    scene.add("wall", wall, LAMP)
    got = prepare_coarse(scene, elements=20, patches=5, bands=4).solve(DARK).at([[0, 0, 0]], [[0, 0, 1]])
    scene = luz.Scene()
    scene.add("wall", np.maximum(wall, [-9, -9, 0]), LAMP)
    above = prepare_coarse(scene, elements=20, patches=5, bands=4).solve(DARK).at([[0, 0, 0]], [[0, 0, 1]])
    assert got[0] == pytest.approx(above[0], rel=1e-9) and got[0] > 0


def test_perfect_parallel_mirrors_have_a_limit():
    """Two mirrors without loss: the series of images converges, for light spreads."""
    mirror = luz.Material(specular_reflectance=1.0)
    scene = luz.Scene()
    scene.add("west", [[0, 0, 0], [0, 3, 0], [0, 3, 2.5], [0, 0, 2.5]], mirror)
    scene.add("east", [[2, 0, 2.5], [2, 3, 2.5], [2, 3, 0], [2, 0, 0]], mirror)
    scene.add("strip", [[0.6, 3, 2.5], [0.9, 3, 2.5], [0.9, 0, 2.5], [0.6, 0, 2.5]], LAMP)
    got = prepare_coarse(scene, elements=20, patches=5, bands=4).solve(DARK).at([[1, 1.2, 0]], [[0, 0, 1]])
    assert got[0] == pytest.approx(76.539990123, rel=1e-4)


def test_a_closed_box_of_luminous_mirrors_comes_to_an_end():
    """All light ends on the mirrors, on the black lid, or in chains that are cut off and booked as such."""
    scene = luz.Scene()
    for name, polygon in ROOM.items():
        scene.add(name, polygon, luz.Material(specular_reflectance=0.9, exitance=100.0))
    scene.add("lid", [[1.5, 2.5, 3], [2.5, 2.5, 3], [2.5, 1.5, 3], [1.5, 1.5, 3]], BLACK)
    assert "deep mirror chains" in {finding.kind for finding in luz.check(scene)}
    transfer = prepare_coarse(scene, elements=20, patches=5, bands=8, specular_cutoff=1e-2)
    balance = transfer.solve(DARK).balance
    ended = sum(balance.absorbed.values()) + balance.truncated
    assert balance.entering == pytest.approx(7900) and ended == pytest.approx(7900, rel=0.01)


@pytest.mark.parametrize(
    ("direction", "plate", "wall"),
    [((0, 0, 1), 1, 0), ((1, 0, math.tan(math.radians(30))), 0.5, 0), ((0, 1, 1e-9), 1e-9, 1), ((0, 1, 0), 0, 0)],
    ids=["zenith", "along the wall", "grazing", "on the horizon"],
)
def test_sun_in_odd_places(direction, plate, wall):
    scene = luz.Scene()
    scene.add("plate", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], BLACK)
    scene.add("wall", [[5, 5, 0], [5, 5, 1], [6, 5, 1], [6, 5, 0]], BLACK)  # looks north
    light = luz.Daylight(sun=luz.Sun(direction=direction, normal_illuminance=80_000))
    result = prepare_coarse(scene, bands=4).solve(light)
    assert result.mean("plate") == pytest.approx(80_000 * plate, rel=1e-9, abs=1e-6)
    assert result.mean("wall") == pytest.approx(80_000 * wall, rel=1e-9, abs=1e-6)
