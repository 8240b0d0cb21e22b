"""Single polygons: what they look like, and their convex parts."""

import math

import numpy as np
import pytest
from builders import lambert_form_factor
from hypothesis import given, settings
from hypothesis import strategies as st
from polygon_samples import NUMBERS, flat_area, regular, simple_loops

from luzespecular import clipping, polygons, rings


def test_simplify_drops_repeated_and_collinear_corners():
    loop = [[0, 0], [0.5, 0], [1, 0], [1, 0], [1, 1], [1, 1], [0.3, 1], [0.2, 1], [0, 1], [0, 0.5]]
    kept = rings.simplify(loop, 1e-9)
    assert {tuple(p) for p in kept} == {(0, 0), (1, 0), (1, 1), (0, 1)}
    assert flat_area(kept) == pytest.approx(1)


@given(simple_loops())
def test_simplify_keeps_the_area(loop):
    assert flat_area(rings.simplify(loop, 1e-9)) == pytest.approx(flat_area(loop), abs=1e-7)


@given(simple_loops())
def test_simple_loops_do_not_cross_themselves(loop):
    assert not rings.crosses_itself(loop)


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
    assert rings.crosses_itself(np.array(loop, float))


def test_touching_is_no_crossing():
    bridged = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
    assert not rings.crosses_itself(np.array(bridged, float))
    assert not rings.crosses_itself(np.array([[0, 0], [1, 0], [0, 1]], float))


def test_convexity():
    assert rings.is_convex(regular(7)[:, :2], 1e-9)
    assert rings.is_convex(np.array([[0, 0], [1, 0], [2, 0], [2, 1], [0, 1]], float), 1e-9), "straight corners count"
    assert not rings.is_convex(np.array([[0, 0], [2, 0], [2, 2], [1, 0.5]], float), 1e-9)
    assert not rings.is_convex(np.concatenate([regular(5)[:, :2]] * 2), 1e-9), "twice around is not convex"


@given(simple_loops())
def test_triangles_cover_the_loop(loop):
    triangles = np.asarray(loop)[rings.triangulate(loop)]
    signed = [flat_area(t) for t in triangles]
    assert min(signed) > 0
    assert sum(signed) == pytest.approx(flat_area(loop), rel=1e-9)


@given(simple_loops())
def test_convex_parts_cover_the_loop(loop):
    parts = rings.convex_parts(loop, 1e-9)
    assert all(rings.is_convex(part, 1e-7) for part in parts)
    assert sum(flat_area(part) for part in parts) == pytest.approx(flat_area(loop), rel=1e-7)
    assert len(parts) <= len(loop) - 2


@given(simple_loops(), NUMBERS, NUMBERS)
def test_convex_parts_overlap_nowhere(loop, x, y):
    point = np.array([2 * x, 2 * y]) + np.mean(loop, axis=0)

    def holds(polygon, margin):
        edge = np.roll(polygon, -1, axis=0) - polygon
        away = edge[:, 0] * (point - polygon)[:, 1] - edge[:, 1] * (point - polygon)[:, 0]
        return (away > margin).all()

    assert sum(holds(part, 1e-9) for part in rings.convex_parts(loop, 1e-9)) <= 1


NOTCHED = np.array([[0, 0], [2, 0], [2, 1], [4, 1], [4, 3], [3, 3], [3, 4], [0, 4]], float)


def test_notched_floors():
    """Corners on a grid, where diagonals run exactly through other corners; wherever the loop begins."""
    for first in range(8):
        for turn in (np.eye(2), np.array([[0, 1], [-1, 0]])):
            parts = rings.convex_parts(np.roll(NOTCHED, first, axis=0) @ turn, 1e-9)
            assert sum(flat_area(part) for part in parts) == pytest.approx(13)
            assert all(rings.is_convex(part, 1e-9) for part in parts)


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(1, 5)), min_size=1, max_size=6), st.integers(0, 20))
def test_stairs(steps, first):
    """Rectilinear loops as plans have them: up and down in whole metres, closed along the axis."""
    x, corners = 0, [[0.0, 0.0]]
    for width, height in steps:
        corners += [[x, height], [x + width, height]]
        x += width
    loop = np.roll(np.array([*corners, [x, 0]], float)[::-1], first, axis=0)
    parts = rings.convex_parts(loop, 1e-9)
    assert sum(flat_area(part) for part in parts) == pytest.approx(sum(w * h for w, h in steps))
    assert all(rings.is_convex(part, 1e-7) for part in parts)


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
    ((rows, found),) = rings.without_flat_corners([loop, loop + 7])
    assert rows.tolist() == [0, 1] and found.shape == (2, 4, 3)
    np.testing.assert_allclose(sorted(map(tuple, found[0])), sorted(map(tuple, ROOT)), atol=1e-14)
    np.testing.assert_allclose(polygons.newell_normal(found), [[0, 0, 24]] * 2)


@pytest.mark.parametrize("width", [1e-6, 1e-12, 1e-14])
def test_slivers_keep_their_corners(width):
    loop = np.array([[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [1, width, 0], [0, width, 0]])
    found = rings.without_flat_corners([loop, ROOT[[0, 0, 1, 2, 3]]])
    by_row = {int(row): p for rows, some in found for row, p in zip(rows, some, strict=True)}
    assert polygons.areas(by_row[0]) == pytest.approx(width, rel=1e-6)
    assert polygons.areas(by_row[1]) == pytest.approx(12)
    (part,) = rings.convex_parts(loop[:, :2], 1e-9)
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
        halves = [clipping.clip(p[None], s * wall, s * offset)[0] for p in pieces for s in (1.0, -1.0)]
        pieces = [half for half in halves if polygons.areas(half) > 1e-6]
    kept = [piece for piece in pieces if rng.uniform() < 0.8] or pieces
    merged = rings.merged(kept)
    assert len(merged) <= len(kept)
    assert sum(map(polygons.areas, merged)) == pytest.approx(sum(map(polygons.areas, kept)), rel=1e-9)
    for piece in merged:
        assert rings.is_convex(piece[:, :2], 1e-9)
    eye, down = np.array([0.3, 0.4, -0.5]), np.array([0, 0, 1.0])
    seen = [sum(lambert_form_factor((p - eye)[None], down)[0] for p in parts) for parts in (kept, merged)]
    assert seen[0] == pytest.approx(seen[1], rel=1e-9)
    if len(kept) == len(pieces):
        assert len(merged) < len(pieces), "all cuts of a square can be mended, in part at least"


@pytest.mark.parametrize(("count", "most", "parts"), [(5, 8, 1), (8, 8, 1), (9, 8, 3), (1000, 32, 34)])
def test_polygons_of_many_corners_are_parted_into_sectors(count, most, parts):
    whole = regular(count, 2.0, 1.0)
    sectors = rings.of_few_corners(whole, most)
    assert len(sectors) == parts
    assert max(len(p) for p in sectors) <= most
    assert sum(polygons.areas(p) for p in sectors) == pytest.approx(polygons.areas(whole))
    assert all(rings.is_convex(p[:, :2], 1e-12) for p in sectors)


@pytest.mark.parametrize("arc", [0.3, 2.0, 3.1, 5.0])
def test_sectors_of_parts_of_discs_are_convex(arc):
    turn = np.linspace(0, arc, 90)
    segment = np.stack([np.cos(turn), np.sin(turn), np.zeros(90)], axis=1)
    sectors = rings.of_few_corners(segment, 32)
    assert max(len(p) for p in sectors) <= 32
    assert sum(polygons.areas(p) for p in sectors) == pytest.approx(polygons.areas(segment))
    assert all(rings.is_convex(p[:, :2], 1e-12) for p in sectors)
    assert all(flat_area(p[:, :2]) > 0 for p in sectors)


@pytest.mark.parametrize("points", [40, 200])
def test_stars_of_many_points_are_parted_in_few_steps(points, monkeypatch):
    asked, convex = [], rings.is_convex
    monkeypatch.setattr(rings, "is_convex", lambda *a: asked.append(None) or convex(*a))
    turn = math.pi * np.arange(2 * points) / points
    radius = np.where(np.arange(2 * points) % 2, 1.0, 2.0)
    star = radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    parts = rings.convex_parts(star, 1e-9)
    assert sum(flat_area(p) for p in parts) == pytest.approx(flat_area(star))
    assert len(parts) <= points + 3
    assert len(asked) < points**2 / 3  # neighbours that neither grew are tried once, not after each join
