"""The bundled room: where the mirrored Sun must stand (closed form), and surface means of independent engines."""

import math

import numpy as np
import pytest

import luzespecular as luz

NOON = math.radians(90 - abs(-27.0 - 23.44))  # the Sun's altitude at solar noon
EDGE = 0.001  # m, how near to its closed-form edge a patch is probed


@pytest.fixture(scope="module")
def room(example):
    return example("light_shelf/room.py")


@pytest.fixture(scope="module")
def transfers(room):
    """The three variants, prepared once for all tests."""
    return {key: luz.prepare(room.scene(key), max_area=0.02) for key in room.VARIANTS}


@pytest.fixture(scope="module")
def sunlit(room, transfers):
    """Solutions for the noon Sun alone, without diffuse reflections: patches and nothing else."""
    light = room.daylight(12.0, sky=None)
    return {key: transfer.solve(light, cycles=0) for key, transfer in transfers.items()}


def edges(low, high):
    """Four probes along a line across a patch, and which of them must lie in it."""
    return np.array([low - EDGE, low + EDGE, high - EDGE, high + EDGE]), np.array([0.0, 1.0, 1.0, 0.0])


def test_the_room_is_what_the_paper_describes(room):
    areas = {}
    faces = 0
    for name, vertices in room.SURFACES.items():
        a, b, _, d = np.array(vertices, float)
        normal = np.cross(b - a, d - a)
        areas[name] = np.linalg.norm(normal)
        centre = np.mean(vertices, axis=0)
        inwards = np.array([1.5, 1.5, {"shelf_bottom": 0.0, "shelf_top": 3.0}.get(name, 1.5)]) - centre
        assert normal @ inwards > 0, f"{name} looks away from the room"
        points, squares = room.grid(vertices)
        corners = np.array(points)[np.array(squares)]
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0])
        np.testing.assert_allclose(cross.sum(axis=0), normal, atol=1e-12)
        assert np.all(cross @ normal > 0) and np.linalg.norm(cross, axis=1).max() / 2 <= room.FACE_AREA + 1e-12
        faces += 2 * len(squares)
    assert sum(areas.values()) == pytest.approx(54.0)
    assert faces == 10_860
    assert set(room.REFLECTANCE) == set(room.SURFACES)


def test_sun_of_the_three_hours(room):
    for hour in room.HOURS:
        altitude, azimuth = room.sun_position(hour)
        lat, dec, angle = map(math.radians, (room.LATITUDE, room.DECLINATION, 15 * (hour - 12)))
        sine = math.sin(lat) * math.sin(dec) + math.cos(lat) * math.cos(dec) * math.cos(angle)
        assert math.sin(math.radians(altitude)) == pytest.approx(sine, abs=1e-12)
        east = -math.cos(dec) * math.sin(angle)
        assert math.cos(math.radians(altitude)) * math.sin(math.radians(azimuth)) == pytest.approx(east, abs=1e-12)


def test_once_mirrored_sun_on_the_ceiling_at_noon(sunlit):
    rise = (3.0 - 1.775) / math.tan(NOON)  # how far south a ray gets from the shelf up to the ceiling
    y, lit = edges(2.25 - rise, 3.0 - rise)
    assert (3 - y[1], 3 - y[2]) == pytest.approx((2.23, 1.48), abs=0.01)
    points, down = [[1.4, v, 3.0] for v in y], [[0, 0, -1]] * 4
    expected = 0.9 * 80_000 * math.sin(NOON) * lit
    np.testing.assert_allclose(sunlit["S1"].at(points, down), expected, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(sunlit["D"].at(points, down), 0.0, atol=1e-6)


def test_twice_mirrored_sun_on_the_back_wall_at_noon(sunlit):
    slope = math.tan(NOON)
    fallen = [3.0 - (y - 1.225 / slope) * slope for y in (3.0, 2.25)]  # from the ceiling's patch down to y = 0
    z, lit = edges(*fallen)
    assert (z[1], z[2]) == pytest.approx((1.75, 2.37), abs=0.01)
    points, north = [[1.6, 0.0, v] for v in z], [[0, 1, 0]] * 4
    expected = 0.9 * 0.6 * 80_000 * math.cos(NOON) * lit
    np.testing.assert_allclose(sunlit["S2"].at(points, north), expected, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(sunlit["S1"].at(points, north), 0.0, atol=1e-6)


def test_lumens_of_the_mirrored_sun(sunlit):
    """Sun patches hold their flux: what falls on the ceiling is what the shelf mirrors, and so on."""
    shelf = 80_000 * math.sin(NOON) * 3 * 0.75

    def flux(result, name):
        index = result.faces_of(name)
        return float(result.illuminance[index] @ result.areas[index])

    assert flux(sunlit["S1"], "shelf_top") == pytest.approx(shelf, rel=2e-3)
    assert flux(sunlit["S1"], "ceiling") == pytest.approx(0.9 * shelf, rel=2e-3)
    direct = flux(sunlit["S1"], "wall_south")
    assert flux(sunlit["S2"], "wall_south") - direct == pytest.approx(0.9 * 0.6 * shelf, rel=2e-3)


# Means over 10 x 10 points of independent engines (their own uncertainty is about 0.5 %): total, and initial alone.
REFERENCE = {
    ("S1", "overcast"): {"floor": (723.0, 452.3), "ceiling": (588.8, 339.7), "wall_south": (562.9, 327.6)},
    ("S1", "sun"): {"floor": (18995.6, 15285.3), "ceiling": (12445.5, 9171.2), "wall_south": (4731.8, 0.0)},
    ("S2", "clear"): {"floor": (1701.6, 994.5), "wall_south": (2361.1, 1814.2)},
}


@pytest.mark.parametrize(("variant", "light"), REFERENCE)
def test_surface_means_of_independent_engines(room, transfers, variant, light):
    daylight = room.daylight(12.0, sky=None if light == "sun" else light, sun=light == "sun")
    result = transfers[variant].solve(daylight)
    steps = 0.15 + 0.3 * np.arange(10)
    u, v = (a.ravel() for a in np.meshgrid(steps, steps))
    w = np.zeros_like(u)
    places = {
        "floor": (np.stack([u, v, w], axis=1), [0, 0, 1]),
        "ceiling": (np.stack([u, v, w + 3], axis=1), [0, 0, -1]),
        "wall_south": (np.stack([u, w, v], axis=1), [0, 1, 0]),
    }
    for name, (total, initial) in REFERENCE[variant, light].items():
        points, normal = places[name]
        normals = np.broadcast_to(np.array(normal, float), points.shape)
        assert result.at(points, normals).mean() == pytest.approx(total, rel=0.03), name
        assert result.at(points, normals, initial=True).mean() == pytest.approx(initial, rel=0.03, abs=1.0), name
