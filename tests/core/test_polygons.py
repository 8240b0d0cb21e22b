"""Polygons: areas, clipping, convex parts, and Lambert's form factor against the corner formulas."""

import math

import numpy as np
import pytest
from builders import lambert_form_factor
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from luzespecular import polygons

NUMBERS = st.floats(-1.0, 1.0)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS).map(np.array)


def regular(corners, radius=1.0, height=0.0):
    turn = 2 * math.pi * np.arange(corners) / corners
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(corners, height)], axis=1)


@st.composite
def simple_loops(draw):
    """Star-shaped loops, so never self-crossing, mostly concave; counter-clockwise."""
    count = draw(st.integers(3, 14))
    radius = np.array(draw(st.lists(st.floats(0.1, 2.0), min_size=count, max_size=count)))
    shift = np.array(draw(st.lists(st.floats(0, 0.6), min_size=count, max_size=count)))
    turn = 2 * math.pi * (np.arange(count) + shift) / count
    gaps = np.diff(np.append(turn, turn[0] + 2 * math.pi))
    assume(gaps.max() < math.pi - 0.05)
    return radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1) + draw(st.floats(-5, 5))


def flat_area(loop):
    x, y = np.asarray(loop).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


@pytest.mark.parametrize("corners", [3, 4, 5, 64])
def test_area_and_normal_of_regular_polygons(corners):
    polygon = regular(corners, 2.0, 5.0)
    area = 0.5 * corners * 4 * math.sin(2 * math.pi / corners)
    assert polygons.areas(polygon) == pytest.approx(area)
    np.testing.assert_allclose(polygons.newell_normal(polygon), [0, 0, 2 * area], atol=1e-12)
    np.testing.assert_allclose(polygons.newell_normal(polygon[::-1]), [0, 0, -2 * area], atol=1e-12)


def test_area_far_from_the_origin():
    assert polygons.areas(regular(4) + 1e8) == pytest.approx(2, rel=1e-6)


def test_padding_changes_neither_area_nor_normal():
    padded, counts = polygons.pad([regular(3), regular(6)])
    assert padded.shape == (2, 6, 3) and counts.tolist() == [3, 6]
    np.testing.assert_allclose(polygons.areas(padded), [polygons.areas(regular(3)), polygons.areas(regular(6))])
    np.testing.assert_array_equal(padded[0, 3:], np.broadcast_to(regular(3)[-1], (3, 3)))
    empty, none = polygons.pad([])
    assert empty.shape == (0, 3, 3) and len(none) == 0


@given(VECTORS)
def test_plane_basis_is_right_handed(vector):
    length = np.linalg.norm(vector)
    assume(length > 1e-3)
    first, second = polygons.plane_basis(vector / length)
    np.testing.assert_allclose(np.cross(first, second), vector / length, atol=1e-12)
    assert abs(first @ second) < 1e-12 and np.linalg.norm(first) == pytest.approx(1)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)])
def test_plane_basis_follows_the_axes_of_rooms(normal):
    basis = polygons.plane_basis(np.array(normal, float))
    np.testing.assert_allclose(np.sort(np.abs(basis), axis=1), [[0, 0, 1], [0, 0, 1]])


def test_simplify_drops_repeated_and_collinear_corners():
    loop = [[0, 0], [0.5, 0], [1, 0], [1, 0], [1, 1], [1, 1], [0.3, 1], [0.2, 1], [0, 1], [0, 0.5]]
    kept = polygons.simplify(loop, 1e-9)
    assert {tuple(p) for p in kept} == {(0, 0), (1, 0), (1, 1), (0, 1)}
    assert flat_area(kept) == pytest.approx(1)


@given(simple_loops())
def test_simplify_keeps_the_area(loop):
    assert flat_area(polygons.simplify(loop, 1e-9)) == pytest.approx(flat_area(loop), abs=1e-7)


@given(simple_loops())
def test_simple_loops_do_not_cross_themselves(loop):
    assert not polygons.crosses_itself(loop)


@pytest.mark.parametrize(
    "loop",
    [
        [[0, 0], [2, 2], [2, 0], [0, 1]],
        [[0, 0], [1, 1], [1, 0], [0, 1]],
        [[math.cos(4 * math.pi * k / 5), math.sin(4 * math.pi * k / 5)] for k in range(5)],
        [[0, 0], [4, 0], [4, 2], [2, -1], [0, 2]],
    ],
    ids=["bow-tie", "even bow-tie", "pentagram", "dip"],
)
def test_crossing_loops(loop):
    assert polygons.crosses_itself(np.array(loop, float))


def test_touching_is_no_crossing():
    bridged = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
    assert not polygons.crosses_itself(np.array(bridged, float))
    assert not polygons.crosses_itself(np.array([[0, 0], [1, 0], [0, 1]], float))


def test_convexity():
    assert polygons.is_convex(regular(7)[:, :2], 1e-9)
    assert polygons.is_convex(np.array([[0, 0], [1, 0], [2, 0], [2, 1], [0, 1]], float), 1e-9), "straight corners count"
    assert not polygons.is_convex(np.array([[0, 0], [2, 0], [2, 2], [1, 0.5]], float), 1e-9)
    assert not polygons.is_convex(np.concatenate([regular(5)[:, :2]] * 2), 1e-9), "twice around is not convex"


@given(simple_loops())
def test_triangles_cover_the_loop(loop):
    triangles = np.asarray(loop)[polygons.triangulate(loop)]
    signed = [flat_area(t) for t in triangles]
    assert min(signed) > 0
    assert sum(signed) == pytest.approx(flat_area(loop), rel=1e-9)


@given(simple_loops())
def test_convex_parts_cover_the_loop(loop):
    parts = polygons.convex_parts(loop, 1e-9)
    assert all(polygons.is_convex(part, 1e-7) for part in parts)
    assert sum(flat_area(part) for part in parts) == pytest.approx(flat_area(loop), rel=1e-7)
    assert len(parts) <= len(loop) - 2


@given(simple_loops(), NUMBERS, NUMBERS)
def test_convex_parts_overlap_nowhere(loop, x, y):
    point = np.array([2 * x, 2 * y]) + np.mean(loop, axis=0)

    def holds(polygon, margin):
        edge = np.roll(polygon, -1, axis=0) - polygon
        away = edge[:, 0] * (point - polygon)[:, 1] - edge[:, 1] * (point - polygon)[:, 0]
        return (away > margin).all()

    assert sum(holds(part, 1e-9) for part in polygons.convex_parts(loop, 1e-9)) <= 1


@given(simple_loops(), VECTORS, NUMBERS)
def test_clipping_shares_out_the_area(loop, normal, offset):
    assume(np.linalg.norm(normal[:2]) > 0.05)  # a polygon within the cutting plane belongs to both sides
    parts = [np.c_[part, np.zeros(len(part))] for part in polygons.convex_parts(loop, 1e-9)]
    batch, _ = polygons.pad(parts)
    one, other = polygons.clip(batch, normal, offset), polygons.clip(batch, -normal, -offset)
    np.testing.assert_allclose(polygons.areas(one) + polygons.areas(other), polygons.areas(batch), atol=1e-9)
    kept = polygons.areas(one) > 1e-9
    assert (one[kept] @ normal >= offset - 1e-9).all()
    up = polygons.newell_normal(one)[kept]
    assert (up[:, 2] > 0).all(), "orientation stays"


NOTCHED = np.array([[0, 0], [2, 0], [2, 1], [4, 1], [4, 3], [3, 3], [3, 4], [0, 4]], float)


def test_notched_floors():
    """Corners on a grid, where diagonals run exactly through other corners; wherever the loop begins."""
    for first in range(8):
        for turn in (np.eye(2), np.array([[0, 1], [-1, 0]])):
            parts = polygons.convex_parts(np.roll(NOTCHED, first, axis=0) @ turn, 1e-9)
            assert sum(flat_area(part) for part in parts) == pytest.approx(13)
            assert all(polygons.is_convex(part, 1e-9) for part in parts)


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(1, 5)), min_size=1, max_size=6), st.integers(0, 20))
def test_stairs(steps, first):
    """Rectilinear loops as plans have them: up and down in whole metres, closed along the axis."""
    x, corners = 0, [[0.0, 0.0]]
    for width, height in steps:
        corners += [[x, height], [x + width, height]]
        x += width
    loop = np.roll(np.array([*corners, [x, 0]], float)[::-1], first, axis=0)
    parts = polygons.convex_parts(loop, 1e-9)
    assert sum(flat_area(part) for part in parts) == pytest.approx(sum(w * h for w, h in steps))
    assert all(polygons.is_convex(part, 1e-7) for part in parts)


def test_clipping_by_hand():
    batch = regular(4) + np.array([[[0, 0, 0]], [[5, 0, 0]], [[-5, 0, 0]]])
    np.testing.assert_allclose(polygons.areas(polygons.clip(batch, [1, 0, 0])), [1, 2, 0], atol=1e-15)
    np.testing.assert_allclose(polygons.areas(polygons.clip(batch, [1, 0, 0], [0.5, 4.5, -4.5])), [0.25, 1.75, 0.25])
    each = polygons.clip(batch, [[1, 0, 0], [-1, 0, 0], [-1, 0, 0]])
    np.testing.assert_allclose(polygons.areas(each), [1, 0, 2], atol=1e-15)
    assert polygons.clip(batch[:0], [1, 0, 0]).shape[0] == 0


def parallel_corner(a, b, c):
    """Element under the corner of a parallel rectangle a × b at distance c (Howell's catalogue B-3)."""
    x, y = a / c, b / c
    one = x / math.hypot(1, x) * math.atan(y / math.hypot(1, x))
    return (one + y / math.hypot(1, y) * math.atan(x / math.hypot(1, y))) / (2 * math.pi)


def perpendicular_corner(a, b, c):
    """Element at distance c from the lower corner of a perpendicular rectangle, a high and b wide (Howell B-4)."""
    x, y = a / b, c / b
    root = math.hypot(x, y)
    return (math.atan(1 / y) - y / root * math.atan(1 / root)) / (2 * math.pi)


SIZES = st.floats(0.01, 50.0)


@given(SIZES, SIZES, SIZES)
def test_lambert_parallel_rectangle(a, b, c):
    ceiling = np.array([[[0, b, c], [a, b, c], [a, 0, c], [0, 0, c]]])
    got = lambert_form_factor(ceiling, [0, 0, 1])[0]
    assert got == pytest.approx(parallel_corner(a, b, c), rel=1e-6, abs=1e-12)
    assert lambert_form_factor(ceiling[:, ::-1], [0, 0, 1])[0] == pytest.approx(-got)


@given(SIZES, SIZES, SIZES)
def test_lambert_perpendicular_rectangle(a, b, c):
    wall = np.array([[[c, 0, 0], [c, 0, a], [c, b, a], [c, b, 0]]])[:, ::-1]
    got = abs(lambert_form_factor(wall, [0, 0, 1])[0])
    assert got == pytest.approx(perpendicular_corner(a, b, c), rel=1e-5, abs=1e-12)


def test_lambert_adds_up_over_parts_and_turns_with_the_scene():
    whole = np.add(regular(5, 1.0, 0.5)[::-1], [0.2, 0.1, 0])
    parts, _ = polygons.pad([whole[:3], whole[[0, 2, 3]], whole[[0, 3, 4]]])
    one = lambert_form_factor(whole[None], [0, 0, 1])[0]
    assert lambert_form_factor(parts, [0, 0, 1]).sum() == pytest.approx(one, rel=1e-12)
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    assert lambert_form_factor(whole[None] @ turn.T, turn @ [0, 0, 1])[0] == pytest.approx(one, rel=1e-12)
    assert lambert_form_factor(whole[None] * 1e-6, [0, 0, 1])[0] == pytest.approx(one, rel=1e-12)


def test_lambert_of_a_disc():
    """Element on the axis of a parallel disc: sin² of the half angle; a polygon of many sides is nearly one."""
    for radius, height in ((1, 1), (0.5, 2), (3, 0.2)):
        disc = regular(400, radius, height)[::-1]
        exact = radius**2 / (radius**2 + height**2)
        assert lambert_form_factor(disc[None], [0, 0, 1])[0] == pytest.approx(exact, rel=1e-4)


def test_lambert_takes_one_normal_for_each():
    ceiling = np.array([[[0, 1, 1], [1, 1, 1], [1, 0, 1], [0, 0, 1.0]]] * 2)
    got = lambert_form_factor(ceiling, [[0, 0, 1], [1, 0, 0]])
    assert got[0] == pytest.approx(parallel_corner(1, 1, 1))
    assert got[1] == pytest.approx(perpendicular_corner(1, 1, 1))
    assert len(lambert_form_factor(ceiling[:0], [0, 0, 1])) == 0


def random_lines(rng, m, count):
    turn = rng.uniform(0, 2 * np.pi, (m, count))
    return np.stack([rng.uniform(-0.5, 0.8, (m, count)), np.cos(turn), np.sin(turn)], axis=2)


@pytest.mark.parametrize("count", [0, 1, 2, 3, 5])
def test_moments_of_what_half_planes_leave_of_polygons(count):
    """Against clipping one half-plane after the other; among the lines are doubled, opposite and touching ones."""
    rng = np.random.default_rng(count)
    corners = np.array([[-1, -1], [1, -1], [1.2, 0.5], [0.3, 1], [-1, 1], [-1, 1.0]]) * rng.uniform(0.5, 2, (400, 1, 1))
    lines = random_lines(rng, 400, count)
    if count > 1:
        lines[:50, 1] = lines[:50, 0]
        lines[50:100, 1] = -lines[50:100, 0]
        lines[100:150, 0] = np.stack([corners[100:150, 0, 0] * -1, np.full(50, 1.0), np.zeros(50)], axis=1)
        lines[150:200, 1] = np.stack([corners[150:200, 0, 1], np.zeros(50), np.full(50, -1.0)], axis=1)
    left = np.concatenate([corners, np.zeros((400, 6, 1))], axis=2)
    for k in range(count):
        left = polygons.clip(left, lines[:, k, [1, 2, 2]] * [1, 1, 0], -lines[:, k, 0])
    x, y = left[..., 0], left[..., 1]
    following = np.roll(left, -1, axis=1)
    twice = x * following[..., 1] - y * following[..., 0]
    exact = [
        twice.sum(axis=1) / 2,
        (twice * (x + following[..., 0])).sum(axis=1) / 6,
        (twice * (y + following[..., 1])).sum(axis=1) / 6,
    ]
    got = polygons.convex_moments(corners.transpose(2, 1, 0), lines.transpose(2, 1, 0))
    np.testing.assert_allclose(got, exact, atol=1e-12)


ROOT = np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]], float)


@pytest.mark.parametrize(
    "extra",
    [
        [[0, 0, 0]],
        [[1, 0, 0]],
        [[1, 0, 0], [2, 0, 0], [2, 0, 0]],
        [[0, 0, 0], [0, 0, 0]],
        [[1e-15, 0, 0], [3, 1e-15, 0]],
    ],
)
@pytest.mark.parametrize("roll", range(4))
def test_corners_that_are_none_are_dropped(extra, roll):
    loop = np.roll(np.concatenate([ROOT[:1], np.array(extra, float), ROOT[1:]]), roll, axis=0)
    ((rows, found),) = polygons.without_flat_corners([loop, loop + 7])
    assert rows.tolist() == [0, 1] and found.shape == (2, 4, 3)
    np.testing.assert_allclose(sorted(map(tuple, found[0])), sorted(map(tuple, ROOT)), atol=1e-14)
    np.testing.assert_allclose(polygons.newell_normal(found), [[0, 0, 24]] * 2)


@pytest.mark.parametrize("width", [1e-6, 1e-12, 1e-14])
def test_slivers_keep_their_corners(width):
    loop = np.array([[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [1, width, 0], [0, width, 0]])
    found = polygons.without_flat_corners([loop, ROOT[[0, 0, 1, 2, 3]]])
    by_row = {int(row): p for rows, some in found for row, p in zip(rows, some, strict=True)}
    assert polygons.areas(by_row[0]) == pytest.approx(width, rel=1e-6)
    assert polygons.areas(by_row[1]) == pytest.approx(12)
    (part,) = polygons.convex_parts(loop[:, :2], 1e-9)
    assert flat_area(part) == pytest.approx(width)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 5))
def test_pieces_merged_cover_the_same_and_are_convex_and_fewer(seed, cuts):
    """A square cut along lines in turn, some parts left out: areas, and what is seen of it, stay."""
    rng = np.random.default_rng(seed)
    pieces = [np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)]
    for _ in range(cuts):
        angle, place = rng.uniform(0, np.pi), rng.uniform(0.2, 0.8, 2)
        wall = np.array([np.cos(angle), np.sin(angle), 0.0])
        offset = float(wall[:2] @ place)
        halves = [polygons.clip(p[None], s * wall, s * offset)[0] for p in pieces for s in (1.0, -1.0)]
        pieces = [half for half in halves if polygons.areas(half) > 1e-6]
    kept = [piece for piece in pieces if rng.uniform() < 0.8] or pieces
    merged = polygons.merged(kept)
    assert len(merged) <= len(kept)
    assert sum(map(polygons.areas, merged)) == pytest.approx(sum(map(polygons.areas, kept)), rel=1e-9)
    for piece in merged:
        assert polygons.is_convex(piece[:, :2], 1e-9)
    eye, down = np.array([0.3, 0.4, -0.5]), np.array([0, 0, 1.0])
    seen = [sum(lambert_form_factor((p - eye)[None], down)[0] for p in parts) for parts in (kept, merged)]
    assert seen[0] == pytest.approx(seen[1], rel=1e-9)
    if len(kept) == len(pieces):
        assert len(merged) < len(pieces), "all cuts of a square can be mended, in part at least"


@settings(max_examples=60, deadline=None)
@given(
    st.integers(1, 3),
    st.integers(3, 6),
    st.integers(0, 2**31),
    st.floats(-1.2, 1.2),
)
def test_few_polygons_are_clipped_like_many(count, corners, seed, offset):
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * np.arange(corners) / corners
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(corners)], axis=1)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    few = (ring + rng.uniform(-0.5, 0.5, (count, 1, 3))) @ turn.T
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    assert few.size <= polygons._FEWEST
    clipped = polygons.clip(few, normal, offset)
    many = polygons.clip(np.tile(few, (30, 1, 1)), normal, offset)
    np.testing.assert_allclose(polygons.areas(clipped), polygons.areas(many)[:count], atol=1e-12)
    left = clipped[polygons.areas(clipped) > 0]  # of the others one corner stays, wherever it is
    assert (left @ normal - offset).min(initial=0.0) > -1e-12
    np.testing.assert_allclose(polygons.widen(clipped, many.shape[1]), many[:count], atol=1e-12)


@pytest.mark.parametrize(("count", "most", "parts"), [(5, 8, 1), (8, 8, 1), (9, 8, 3), (1000, 32, 34)])
def test_polygons_of_many_corners_are_parted_into_sectors(count, most, parts):
    whole = regular(count, 2.0, 1.0)
    sectors = polygons.of_few_corners(whole, most)
    assert len(sectors) == parts
    assert max(len(p) for p in sectors) <= most
    assert sum(polygons.areas(p) for p in sectors) == pytest.approx(polygons.areas(whole))
    assert all(polygons.is_convex(p[:, :2], 1e-12) for p in sectors)


@pytest.mark.parametrize("arc", [0.3, 2.0, 3.1, 5.0])
def test_sectors_of_parts_of_discs_are_convex(arc):
    turn = np.linspace(0, arc, 90)
    segment = np.stack([np.cos(turn), np.sin(turn), np.zeros(90)], axis=1)
    sectors = polygons.of_few_corners(segment, 32)
    assert max(len(p) for p in sectors) <= 32
    assert sum(polygons.areas(p) for p in sectors) == pytest.approx(polygons.areas(segment))
    assert all(polygons.is_convex(p[:, :2], 1e-12) for p in sectors)
    assert all(flat_area(p[:, :2]) > 0 for p in sectors)


@pytest.mark.parametrize("points", [40, 200])
def test_stars_of_many_points_are_parted_in_few_steps(points, monkeypatch):
    asked, convex = [], polygons.is_convex
    monkeypatch.setattr(polygons, "is_convex", lambda *a: asked.append(None) or convex(*a))
    turn = math.pi * np.arange(2 * points) / points
    radius = np.where(np.arange(2 * points) % 2, 1.0, 2.0)
    star = radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    parts = polygons.convex_parts(star, 1e-9)
    assert sum(flat_area(p) for p in parts) == pytest.approx(flat_area(star))
    assert len(parts) <= points + 3
    assert len(asked) < points**2 / 3  # neighbours that neither grew are tried once, not after each join


@pytest.mark.parametrize("count", [1, 40])
def test_both_sides_of_a_plane_at_once(count):
    rng = np.random.default_rng(count)
    shapes = np.cumsum(rng.uniform(0, 1, (count, 4, 3)), axis=1)
    for offset in (-9.0, 0.7, 9.0):
        normal = np.array([0.6, 0.0, -0.8])
        beyond, within = polygons.parted(shapes, normal, offset)
        np.testing.assert_array_equal(beyond, polygons.clip(shapes, -normal, -offset))
        np.testing.assert_array_equal(within, polygons.clip(shapes, normal, offset))
