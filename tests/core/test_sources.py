"""Luminous polygons: direct, behind obstacles, in mirrors and through panes, against closed forms."""

import math
import sys
import time

import numpy as np
import pytest
from builders import BLACK, DARK, box, box_polygons, cosine_rays, first_hits, flux, lambert_form_factor, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import clipping, sources
from luzespecular.bright import Source, even_illuminance
from luzespecular.sources import gather_sources
from luzespecular.tracing import ChainLimits

GLOW = luz.Material(exitance=1000.0)
UP = np.array([0.0, 0.0, 1.0])


def ceiling(x, y, z):
    """Horizontal rectangle that looks down; ``x`` and ``y`` are pairs."""
    return np.array([[x[0], y[1], z], [x[1], y[1], z], [x[1], y[0], z], [x[0], y[0], z]], float)


def floor(x, y, z):
    return ceiling(x, y, z)[::-1]


def scene_with(polygons_, materials):
    scene = luz.Scene()
    for name, polygon in polygons_.items():
        scene.add(name, polygon, materials.get(name, BLACK))
    return scene


def lux_at(polygons_, materials, points, normals=UP, initial=True):
    result = prepare_coarse(scene_with(polygons_, materials), elements=20, patches=10, bands=4).solve(DARK)
    points = np.atleast_2d(points).astype(float)
    return result.at(points, np.broadcast_to(normals, points.shape), initial=initial)


def factor(polygon, point, normal=UP):
    """Form factor of the part above the point's horizon; Lambert's formula is tested with the polygons."""
    above = clipping.clip((np.asarray(polygon, float) - point)[None], normal)
    return float(lambert_form_factor(above, normal)[0])


PLACES = st.floats(-3, 3)


@settings(max_examples=30, deadline=None)
@given(PLACES, PLACES, st.floats(-1, 1), st.floats(0, 6.28))
def test_a_luminous_rectangle_above_a_tilted_receiver(x, y, tilt, turn):
    normal = np.array([math.sqrt(1 - tilt**2) * math.cos(turn), math.sqrt(1 - tilt**2) * math.sin(turn), tilt])
    lamp = ceiling((-1, 2), (-0.5, 0.5), 1.5)
    got = lux_at({"lamp": lamp}, {"lamp": GLOW}, [x, y, 0], normal)[0]
    assert got == pytest.approx(1000 * factor(lamp, [x, y, 0], normal), rel=1e-9, abs=1e-9)


def test_a_lamp_shines_from_its_front_alone_unless_two_sided():
    lamp = ceiling((-1, 1), (-1, 1), 1)
    points, normals = [[0, 0, 0], [0, 0, 2]], [[0, 0, 1], [0, 0, -1]]
    np.testing.assert_allclose(lux_at({"lamp": lamp[::-1]}, {"lamp": GLOW}, points, normals)[0], 0, atol=1e-12)
    one = lux_at({"lamp": lamp}, {"lamp": GLOW}, points, normals)
    assert one[0] == pytest.approx(1000 * factor(lamp, [0, 0, 0])) and one[1] == 0
    scene = luz.Scene()
    scene.add("lamp", lamp, GLOW, two_sided=True)
    both = prepare_coarse(scene, elements=20, patches=10, bands=4).solve(DARK).at(points, normals)
    np.testing.assert_allclose(both, one[0], rtol=1e-9)


def test_concave_lamps_are_the_sum_of_their_parts():
    shape = np.array([[0, 2, 1], [1, 2, 1], [1, 1, 1], [2, 1, 1], [2, 0, 1], [0, 0, 1.0]])
    parts = [ceiling((0, 1), (0, 2), 1), ceiling((1, 2), (0, 1), 1)]
    got = lux_at({"lamp": shape}, {"lamp": GLOW}, [0.3, -0.2, 0])[0]
    assert got == pytest.approx(1000 * sum(factor(p, [0.3, -0.2, 0]) for p in parts), rel=1e-9)


def overlap(a, b):
    low, high = max(a[0], b[0]), min(a[1], b[1])
    return (low, max(low, high))


@settings(max_examples=30, deadline=None)
@given(PLACES, PLACES, st.floats(-1, 1), st.floats(-1, 1), st.floats(0.1, 1.5), st.floats(0.2, 1.8), st.booleans())
def test_a_rectangle_less_the_shadow_of_a_rectangle(x, y, u, v, size, height, turned):
    """Both parallel to the receiver: the blocker's shadow on the lamp's plane is a rectangle again."""
    point, z = np.array([x, y, 0.0]), 2.0
    lamp, blocker = ((-1, 1), (-0.7, 0.7)), ((u - size / 2, u + size / 2), (v - size / 3, v + size / 3))
    shape = ceiling(*blocker, height)
    got = lux_at({"lamp": ceiling(*lamp, z), "blocker": shape[::-1] if turned else shape}, {"lamp": GLOW}, point)[0]
    shadow = [tuple(c + (p - c) * z / height for p in pair) for pair, c in zip(blocker, (x, y), strict=True)]
    hidden = ceiling(*(overlap(a, b) for a, b in zip(lamp, shadow, strict=True)), z)
    expected = factor(ceiling(*lamp, z), point) - factor(hidden, point)
    assert got == pytest.approx(1000 * expected, rel=1e-8, abs=1e-7)


def test_overlapping_blockers_count_once():
    lamp = ceiling((-1, 1), (-1, 1), 2)
    blockers = {"one": ceiling((-0.5, 0.25), (-0.5, 0.5), 1), "two": ceiling((-0.2, 0.4), (-0.4, 0.4), 0.8)}
    # shadows on the lamp: (-1, 0.5) x (-1, 1), and (-0.5, 1) x (-1, 1): together all of it
    got = lux_at({"lamp": lamp, **blockers}, {"lamp": GLOW}, [0, 0, 0])[0]
    assert got == pytest.approx(0, abs=1e-9)
    apart = {"one": ceiling((-0.5, 0), (-0.5, 0.5), 1), "two": ceiling((0.1, 0.3), (-0.4, 0.4), 0.8)}
    seen = [((0, 0.25), (-1, 1)), ((0.75, 1), (-1, 1))]
    expected = 1000 * sum(factor(ceiling(*s, 2), [0, 0, 0]) for s in seen)
    assert lux_at({"lamp": lamp, **apart}, {"lamp": GLOW}, [0, 0, 0])[0] == pytest.approx(expected, rel=1e-9)


def test_a_cluttered_lamp_against_rays():
    """Tilted screens, some through the receiver's horizon and through the lamp's plane."""
    rng = np.random.default_rng(4)
    outlines = {"lamp": ceiling((-1, 1), (-1, 1), 1.5)}
    for k in range(6):
        corners = rng.uniform([-1, -1, -0.2], [1, 1, 1.7], (3, 3))
        outlines[f"screen {k}"] = corners
    for point in ([0.1, 0.2, 0], [-0.6, 0.5, 0.0]):
        got = lux_at(outlines, {"lamp": GLOW}, point)[0]
        hits = first_hits(np.array(point), cosine_rays(UP, 400_000), outlines.values())
        assert got == pytest.approx(1000 * np.mean(hits == 0), abs=0.6)


def test_all_light_of_a_lamp_lands_in_a_black_box():
    """Faces' means: flux out of the lamp equals flux on to the walls."""
    room = box_polygons((3, 2, 2.5))
    room["lamp"] = ceiling((1, 1.5), (0.5, 1.5), 2.2)
    transfer = prepare_coarse(scene_with(room, {"lamp": GLOW}), elements=1000, patches=10, bands=4)
    result = transfer.solve(DARK)
    total = sum(flux(result, name) for name in room)
    assert total == pytest.approx(500, rel=0.01)
    assert result.mean("lamp") == 0


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-8])
def test_close_to_the_foot_of_a_luminous_wall(distance):
    """No explosion and no hole as the receiver nears an edge; in the wall's plane it sees the lamp edge-on: none."""
    wall = [[0, 0, 0], [0, 4, 0], [0, 4, 3], [0, 0, 3]]
    at = lux_at({"wall": wall}, {"wall": GLOW}, [[distance, 1.6, 0], [0, 1.6, 0], [-distance, 1.6, 0]])
    parts = [
        (math.atan(b / distance) - distance / math.hypot(3, distance) * math.atan(b / math.hypot(3, distance)))
        for b in (1.6, 2.4)  # Howell's catalogue B-4, left and right of the receiver
    ]
    assert at[0] == pytest.approx(1000 * sum(parts) / (2 * math.pi), rel=1e-6)
    np.testing.assert_allclose(at[1:], 0, atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(PLACES, PLACES, st.floats(0.1, 1.0), st.floats(0.2, 3.0))
def test_a_mirror_shows_the_lamps_image(x, y, reflectance, size):
    """Receiver looking down at a mirror floor 1 m below; the lamp's image is as far below it as the lamp above."""
    lamp = ceiling((-1, 1), (-0.5, 0.5), 2)
    mirror = ((-size, size), (-size / 2, size))
    point = np.array([x, y, 1.0])
    got = lux_at(
        {"lamp": lamp, "mirror": floor(*mirror, 0)},
        {"lamp": GLOW, "mirror": luz.Material(specular_reflectance=reflectance)},
        point,
        -UP,
    )[0]
    # through the mirror as a window, seen from the point: on the image's plane, 3 m below the point
    window = [tuple(c + (p - c) * 3 for p in pair) for pair, c in zip(mirror, (x, y), strict=True)]
    image = floor(*(overlap(a, b) for a, b in zip(((-1, 1), (-0.5, 0.5)), window, strict=True)), -2)
    assert got == pytest.approx(1000 * reflectance * factor(image, point, -UP), rel=1e-8, abs=1e-7)


def test_a_mirror_behind_the_receiver_or_seen_from_its_back_shows_nothing():
    lamp, glow = ceiling((-1, 1), (-1, 1), 2), {"lamp": GLOW, "mirror": luz.Material(specular_reflectance=0.9)}
    plain = lux_at({"lamp": lamp}, glow, [0.3, 0, 1])[0]
    assert lux_at({"lamp": lamp, "mirror": floor((-5, 5), (-5, 5), 0)}, glow, [0.3, 0, 1])[0] == pytest.approx(plain)
    assert lux_at({"lamp": lamp, "mirror": ceiling((-5, 5), (-5, 5), 0)}, glow, [0.3, 0, 1], -UP)[0] == 0


def test_what_stands_before_the_mirror_hides_the_image():
    lamp = ceiling((-1, 1), (-1, 1), 2)
    scene = {"lamp": lamp, "mirror": floor((-9, 9), (-9, 9), 0), "plate": floor((-5, 5), (-5, 5), 0.5)}
    materials = {"lamp": GLOW, "mirror": luz.Material(specular_reflectance=0.9)}
    assert lux_at(scene, materials, [0, 0, 1], -UP)[0] == 0
    # a plate between lamp and mirror only: seen from the point, its image stands before the lamp's image
    scene["plate"] = ceiling((-5, 5), (-5, 5), 1.5)
    assert lux_at(scene, materials, [0, 0, 1], -UP)[0] == 0


def test_two_parallel_mirrors_show_all_images():
    """Walls x = 0 and x = 2, both mirrors and very large; the images of the lamp are strips ever farther away."""
    reflectance = 0.8
    lamp = ((0.6, 0.9), (-1, 1))
    walls = {
        "west": [[0, -400, -1], [0, 400, -1], [0, 400, 400], [0, -400, 400]],
        "east": [[2, -400, 400], [2, 400, 400], [2, 400, -1], [2, -400, -1]],
    }
    mirror = luz.Material(specular_reflectance=reflectance)
    scene = scene_with({"lamp": ceiling(*lamp, 2.5), **walls}, {"lamp": GLOW, "west": mirror, "east": mirror})
    transfer = prepare_coarse(scene, elements=20, patches=10, bands=4, specular_cutoff=1e-3)
    point = np.array([1.3, 0.2, 0])
    got = transfer.solve(DARK).at(point[None], UP[None])[0]
    expected, first, second = 0.0, [lamp[0]], [lamp[0]]
    for _ in range(30):  # 0.8 ** 31 is the first below the cut-off
        first.append(tuple(sorted(-x if len(first) % 2 else 4 - x for x in first[-1])))
        second.append(tuple(sorted(4 - x if len(second) % 2 else -x for x in second[-1])))
    for order, images in enumerate(zip(first, second, strict=True)):
        for x in images[: 1 if order == 0 else 2]:
            expected += 1000 * reflectance**order * factor(ceiling(x, lamp[1], 2.5), point)
    assert got == pytest.approx(expected, rel=1e-5)


def test_corner_of_two_mirrors():
    """Four quarters: the lamp, its two images, and the image of an image."""
    lamp = ((0.4, 0.9), (0.3, 1.1))
    mirror = luz.Material(specular_reflectance=0.7)
    walls = {
        "west": [[0, 0, -1], [0, 400, -1], [0, 400, 400], [0, 0, 400]],
        "south": [[0, 0, -1], [0, 0, 400], [400, 0, 400], [400, 0, -1]],
    }
    got = lux_at({"lamp": ceiling(*lamp, 2), **walls}, {"lamp": GLOW, "west": mirror, "south": mirror}, [0.8, 0.5, 0])[
        0
    ]
    flip = [tuple(sorted(-v for v in pair)) for pair in lamp]
    point = np.array([0.8, 0.5, 0])
    expected = sum(
        1000 * share * factor(ceiling(x, y, 2), point)
        for x, y, share in ((*lamp, 1), (flip[0], lamp[1], 0.7), (lamp[0], flip[1], 0.7), (*flip, 0.49))
    )
    assert got == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_a_luminous_mirrors_own_back_does_not_show_in_it(seed):
    """Between mirrors face to face it matters not whether they have, and light, their outer sides."""
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    low, high = floor((-1, 1), (-1, 1), 0.0) @ turn.T, ceiling((-1, 1), (-1, 1), 1.3) @ turn.T
    points = np.array([[0.2, 0.1, 0.0], [-0.6, 0.4, 0.7]]) @ turn.T
    lux = []
    for both in (False, True):
        scene = luz.Scene()
        for name, polygon in (("low", low), ("high", high)):
            scene.add(name, polygon, luz.Material(specular_reflectance=0.6, exitance=400.0), two_sided=both)
        lux.append(prepare_coarse(scene, elements=20, patches=5, bands=4).solve(DARK).at(points, turn[:, [2, 2]].T))
    np.testing.assert_allclose(lux[1], lux[0], rtol=1e-3)  # twice the flux: what is too faint to look for is more


def test_a_small_lamp_through_a_pane():
    glass = luz.Material(regular_transmittance=0.85, refractive_index=1.52)
    for x in (0.0, 1.0, 4.0):
        lamp = ceiling((x - 0.01, x + 0.01), (-0.01, 0.01), 2)
        plain = lux_at({"lamp": lamp}, {"lamp": GLOW}, [0, 0, 0])[0]
        pane = floor((-9, 9), (-9, 9), 1)
        got = lux_at({"lamp": lamp, "pane": pane}, {"lamp": GLOW, "pane": glass}, [0, 0, 0])[0]
        cosine = 2 / math.hypot(2, x)
        assert got == pytest.approx(plain * float(glass.transmittance_at(cosine)), rel=1e-4)
        turned = lux_at({"lamp": lamp, "pane": pane[::-1]}, {"lamp": GLOW, "pane": glass}, [0, 0, 0])[0]
        assert turned == pytest.approx(got, rel=1e-9)


def test_a_pane_mirrors_a_small_lamp():
    glass = luz.Material(regular_transmittance=0.85, refractive_index=1.52)
    for turned in (1, -1):
        lamp = ceiling((2.99, 3.01), (-0.01, 0.01), 2)
        pane = floor((-9, 9), (-9, 9), 0)[::turned]
        got = lux_at({"lamp": lamp, "pane": pane}, {"lamp": GLOW, "pane": glass}, [0, 0, 1], -UP)[0]
        image = floor((2.99, 3.01), (-0.01, 0.01), -2)
        cosine = 3 / math.hypot(3, 3)
        assert got == pytest.approx(1000 * factor(image, [0, 0, 1], -UP) * float(glass.specular_at(cosine)), rel=1e-4)


@pytest.mark.parametrize("board", [False, True])
def test_large_lamps_before_a_pane_whose_share_of_light_changes_over_them(board):
    """Near the pane a lamp is mirrored by 5 % from one end and by 70 % from the other: summed point by point."""
    pane = luz.Material(regular_transmittance=0.88, refractive_index=1.52)
    lamp, hidden = floor((0.3, 1.9), (0.5, 2.5), 0), floor((1, 1.5), (1, 2), 0.3)
    given = {"lamp": lamp, "pane": np.array([[2, 0, 0], [2, 3, 0], [2, 3, 3], [2, 0, 3]])}
    given |= {"board": hidden} if board else {}
    rng = np.random.default_rng(1)
    places = rng.uniform((0.1, 0.25), (2.9, 2.9), (6, 2))
    near, across = np.column_stack([np.zeros(6), places]), np.array([4.0, 0, 0])
    normals = np.repeat([[1.0, 0, 0], [-1.0, 0, 0]], 6, axis=0)
    got = lux_at(given, {"lamp": GLOW, "pane": pane}, np.concatenate([near, near + across]), normals)
    count = 800
    x, y = np.meshgrid(0.3 + 1.6 * (np.arange(count) + 0.5) / count, 0.5 + 2 * (np.arange(count) + 0.5) / count)
    here = np.stack([x, y, np.zeros_like(x)], axis=-1)
    image = here * [-1, 1, 1] + across

    def seen(eye, place):
        """Whether the board leaves a way between two points."""
        at = eye + (place - eye) * ((0.3 - eye[2]) / (place[..., 2] - eye[2]))[..., None]
        inside = (at[..., 0] > 1) & (at[..., 0] < 1.5) & (at[..., 1] > 1) & (at[..., 1] < 2)
        return ~(inside & board & (eye[2] > 0.3))

    def lux(eye, place, share):
        way = place - eye
        distance = np.linalg.norm(way, axis=-1)
        cosine = np.abs(way[..., 0]) / distance
        factors = share(cosine) * cosine * np.abs(way[..., 2]) / (np.pi * distance**3)
        return 1000 * 3.2 * float(factors.mean())

    for k, eye in enumerate(near):
        far, mirrored = eye + across, eye * [-1, 1, 1] + across
        through = lux(far, here, lambda cosine, far=far: pane.transmittance_at(cosine) * seen(far, here))
        straight = lux(eye, here, lambda _, eye=eye: seen(eye, here))
        ways = seen(eye, image) & seen(mirrored, here)
        back = lux(eye, image, lambda cosine, ways=ways: pane.specular_at(cosine) * ways)
        assert got[k] == pytest.approx(straight + back, rel=2e-3)
        assert got[6 + k] == pytest.approx(through, rel=2e-3)


def test_lamps_add_up():
    one, two = ceiling((-1, 0), (-1, 1), 2), ceiling((0, 1), (-1, 1), 2)
    both = lux_at({"one": one, "two": two}, {"one": GLOW, "two": luz.Material(exitance=300)}, [0.5, 0.2, 0])[0]
    assert both == pytest.approx(1000 * factor(one, [0.5, 0.2, 0]) + 300 * factor(two, [0.5, 0.2, 0]), rel=1e-9)


def test_many_lamps_go_by_the_globe(monkeypatch):
    """Where there are too many outlines to clip exactly, the globe gathers the same light, at its own accuracy."""
    room = box_polygons((3, 2, 2.5))
    lamps = {"ceiling": GLOW, "lamp": luz.Material(exitance=3000.0, diffuse_reflectance=0.5)}
    room["lamp"] = ceiling((1, 1.8), (0.5, 1.5), 2.0)
    transfer = prepare_coarse(scene_with(room, lamps), elements=400, patches=200, bands=60)
    points, normals = [[0.5, 0.4, 0], [1.4, 1, 0], [0, 1, 1]], [[0, 0, 1], [0, 0, 1], [1, 0, 0]]
    exact = transfer.solve(DARK)
    monkeypatch.setattr(sys.modules["luzespecular.solve"], "EXACT_OUTLINES", 6)
    globe = transfer.solve(DARK)
    for name in ("floor", "west", "north", "lamp"):
        assert globe.mean(name) == pytest.approx(exact.mean(name), rel=0.01, abs=0.01)
    np.testing.assert_allclose(globe.at(points, normals), exact.at(points, normals), rtol=0.02)
    assert abs(globe.at(points, normals) - exact.at(points, normals)).max() > 0, "two ways"


def mirror_box(share=0.8):
    """Six luminous mirrors that look at each other."""
    return box(luz.Material(specular_reflectance=share, diffuse_reflectance=0.1, exitance=100.0), (1, 1.3, 0.9))


def test_luminous_mirrors_of_a_box_can_be_cancelled_soon():
    """Images in images in images: seconds of work in one chunk, which asks now and then whether to go on."""
    transfer = prepare_coarse(mirror_box(), elements=60, patches=20, bands=4, specular_cutoff=1e-2)
    for work in (
        lambda progress: prepare_coarse(mirror_box(), elements=2000, bands=40, threads=1, progress=progress),
        lambda progress: transfer.solve(DARK, progress=progress),
    ):
        begin = time.perf_counter()
        with pytest.raises(luz.Cancelled):
            work(lambda fraction, stage: time.perf_counter() - begin < 0.3)  # noqa: B023
        assert time.perf_counter() - begin < 2.3


def test_threads_that_need_the_same_images_wait_for_each_other(monkeypatch):
    """Ways by a mirror are looked for from all planes at once, by one thread; no other may see them half made."""

    def slowly(*args):
        time.sleep(2e-3)
        return by(*args)

    by = sources._Path._by
    for least in ("_SOURCE_ROWS", "_SOURCE_PAIRS"):
        monkeypatch.setattr(sys.modules["luzespecular.solve"], least, 8)
    alone, together = (prepare_coarse(mirror_box(), elements=60, bands=4, threads=n).solve(DARK) for n in (1, 2))
    np.testing.assert_array_equal(together.illuminance, alone.illuminance)
    monkeypatch.setattr(sources._Path, "_by", slowly)
    beside = prepare_coarse(mirror_box(), elements=60, bands=4, threads=4).solve(DARK)
    np.testing.assert_array_equal(beside.illuminance, alone.illuminance)


def test_images_by_many_mirrors_come_by_the_globe():
    """An even closed field between six mirrors, M / (1 - rho_d - rho_s): exact images alone would miss most of it."""
    transfer = prepare_coarse(mirror_box(0.7), elements=30, patches=40, bands=12, specular_cutoff=1e-2)
    assert transfer.limits.exact_mirrors == 3 and len(transfer.deep_rows) > 0
    result = transfer.solve(DARK, cycles=0)
    initial = 100 / (1 - 0.7)
    np.testing.assert_allclose(result.illuminance, initial * (1 - 0.7**14), rtol=0.03)
    exact_alone = 100 * (1 - 0.7**4) / (1 - 0.7)
    assert result.illuminance.min() > 1.2 * exact_alone
    points, normals = [[0.5, 0.6, 0], [0.2, 1.1, 0]], [UP, UP]
    np.testing.assert_allclose(result.at(points, normals), initial * (1 - 0.7**14), rtol=0.03)
    seen = transfer.form_factors.sum(axis=1) + transfer.truncated  # each meeting counts, as each side shines
    np.testing.assert_allclose(seen, initial / 100, rtol=0.02)
    every = transfer.solve(DARK, tolerance=1e-8)
    np.testing.assert_allclose(every.illuminance, 100 / (1 - 0.7 - 0.1), rtol=0.03, err_msg="reflected light too")


def on_floor(count):
    return np.column_stack([np.random.default_rng(1).uniform(0.05, 1.95, (count, 2)), np.zeros(count)])


def mirrored_lamps(lamps, points, faint):
    """Lux from lamps ``(polygon, exitance)`` on upright points of height nought between four mirrors, past a screen."""
    walls = box_polygons((2.0, 2.0, 2.0))
    room = scene_with(
        {**walls, "screen": ceiling((0.5, 0.9), (0.4, 1.3), 1.1)},
        {name: luz.Material(specular_reflectance=0.9) for name in list(walls)[2:]},
    )
    outlines = luz.prepare(room, bands=4, max_area=math.inf).geometry.outlines
    centre = 0.5 * (outlines.vertices.reshape(-1, 3).min(axis=0) + outlines.vertices.reshape(-1, 3).max(axis=0))
    middle = centre - [1.0, 1.0, 1.0]
    given = [Source(polygon + middle, exitance) for polygon, exitance in lamps]
    limits = ChainLimits(1e-3, 4)
    got = gather_sources(outlines, given, points + middle, UP, limits, faint=faint)
    return got, even_illuminance(outlines, given)


LAMPS = [
    (ceiling((0.2, 0.7), (0.3, 0.6), 1.9), 900.0),
    (ceiling((1.1, 1.7), (0.2, 1.6), 1.9), 300.0),
    (ceiling((1.2, 1.5), (0.4, 1.9), 1.9), 500.0),
    (ceiling((1.4, 1.8), (0.1, 0.3), 1.5), 700.0),
]


def test_lamps_of_one_plane_are_gathered_together_as_one_by_one():
    points = on_floor(40)
    together, _ = mirrored_lamps(LAMPS, points, 0.0)
    one_by_one = sum(mirrored_lamps([lamp], points, 0.0)[0] for lamp in LAMPS)
    np.testing.assert_allclose(together, one_by_one, rtol=1e-11)


@pytest.mark.parametrize("faint", [3e-4, 1e-3, 1e-2])
def test_images_left_out_are_as_faint_as_is_said(faint):
    points = on_floor(40)
    every, even = mirrored_lamps(LAMPS, points, 0.0)
    some, _ = mirrored_lamps(LAMPS, points, faint)
    missing = every - some
    assert (missing >= -1e-9 * every).all() and missing.max() > 0
    # among a few dozen images each gives no more than that
    assert missing.max() < 30 * faint * even
