"""Means at corners, and lines of equal value: plain arrays, no Blender needed but to load the extension."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

UP, EAST = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)


def grid(columns, rows):
    """Corners of quads on a lattice of vertices, (4·columns·rows,)."""
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    return np.column_stack([corner, corner + 1, corner + columns + 2, corner + columns + 1]).ravel()


def naive(values, areas, normals, corners, vertices, angle):
    """The same means by a loop over corners."""
    face = np.repeat(np.arange(len(values)), corners)
    out = np.full(len(vertices), np.nan)
    for here in range(len(vertices)):
        if np.isnan(values[face[here]]):
            continue
        same = np.flatnonzero(vertices == vertices[here])
        near = [face[c] for c in same if normals[face[c]] @ normals[face[here]] >= np.cos(np.radians(angle)) - 1e-12]
        near = [f for f in near if not np.isnan(values[f])]
        out[here] = np.average(values[near], weights=areas[near])
    return out


def test_a_corner_has_the_mean_of_the_faces_that_meet_there(addon):
    means = addon.smoothing.corner_means([1.0, 3.0], [1.0, 3.0], [UP, UP], 4, grid(2, 1)).reshape(2, 4)
    assert means[0].tolist() == [1.0, 2.5, 2.5, 1.0]
    assert means[1].tolist() == [2.5, 3.0, 3.0, 2.5]


def test_a_wall_and_a_floor_keep_their_own_light(addon):
    means = addon.smoothing.corner_means([100.0, 900.0], [1.0, 1.0], [UP, EAST], 4, grid(2, 1)).reshape(2, 4)
    assert means[0].tolist() == [100.0] * 4
    assert means[1].tolist() == [900.0] * 4


def test_what_was_not_computed_takes_no_part_and_stays_so(addon):
    means = addon.smoothing.corner_means([np.nan, 5.0, 7.0], np.ones(3), [UP] * 3, 4, grid(3, 1)).reshape(3, 4)
    assert np.isnan(means[0]).all()
    assert means[1].tolist() == [5.0, 6.0, 6.0, 5.0]
    assert np.isnan(addon.smoothing.corner_means([np.nan], [1.0], [UP], 4, np.arange(4))).all()


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), bend=st.floats(0.0, 80.0))
def test_means_agree_with_a_plain_loop(addon_arrays, seed, bend):
    random = np.random.default_rng(seed)
    columns, rows = 4, 3
    count = columns * rows
    values = random.uniform(0.0, 1000.0, count)
    values[random.random(count) < 0.15] = np.nan
    tilt = np.radians(bend) * random.random(count)
    turn = random.uniform(0.0, 2.0 * np.pi, count)
    normals = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    areas, vertices = random.uniform(0.5, 2.0, count), grid(columns, rows)
    found = addon_arrays.smoothing.corner_means(values, areas, normals, 4, vertices)
    expected = naive(values, areas, normals, 4, vertices, addon_arrays.smoothing.SMOOTH_ANGLE)
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_points_are_welded_by_place_and_group(addon):
    points = [(0, 0, 0), (1, 0, 0), (1e-9, 0, 0), (0, 0, 0), (1e6, -1e6, 1e6)]
    number = addon.smoothing.weld(points, [0, 0, 0, 1, 0], 1e-5)
    assert number[0] == number[2]
    assert len(set(number.tolist())) == 4
    assert sorted(set(number.tolist())) == [0, 1, 2, 3]


def plane_values(triangles):
    return triangles @ np.array([2.0, -1.0, 0.5]) + 3.0


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), level=st.floats(-5.0, 10.0))
def test_lines_run_where_the_values_are(addon_arrays, seed, level):
    triangles = np.random.default_rng(seed).uniform(-2.0, 2.0, (30, 3, 3))
    values = plane_values(triangles)
    lines = addon_arrays.isolines.trace(triangles, values, [level])
    np.testing.assert_allclose(plane_values(lines.ends), level, atol=1e-9)
    crossed = np.flatnonzero((values.min(axis=1) < level) & (values.max(axis=1) >= level))
    assert sorted(lines.triangles.tolist()) == crossed.tolist()
    for ends, row in zip(lines.ends, lines.triangles, strict=True):
        assert (ends >= triangles[row].min(axis=0) - 1e-9).all()
        assert (ends <= triangles[row].max(axis=0) + 1e-9).all()


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), count=st.integers(0, 5))
def test_triangles_without_lines_are_known_before(addon_arrays, seed, count):
    random = np.random.default_rng(seed)
    values = random.integers(0, 6, (40, 3)).astype(float)  # levels that corners have exactly, too
    values[::7, 1] = np.nan
    levels = random.integers(0, 6, count).tolist()
    lines = addon_arrays.isolines.trace(np.zeros((40, 3, 3)), values, levels)
    known = addon_arrays.isolines.crossed(values, levels)
    assert np.flatnonzero(known).tolist() == sorted(set(lines.triangles.tolist()))


def test_no_lines_where_nothing_was_computed_or_wanted(addon):
    triangles = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], float)
    assert len(addon.isolines.trace(triangles, [[0.0, np.nan, 9.0]], [5.0]).ends) == 0
    assert len(addon.isolines.trace(triangles, [[0.0, 1.0, 9.0]], []).ends) == 0
    assert len(addon.isolines.trace(np.zeros((0, 3, 3)), np.zeros((0, 3)), [5.0]).ends) == 0


@pytest.mark.parametrize(
    ("text", "levels"),
    [("", []), ("300", [300.0]), ("500, 100; 300 100", [100.0, 300.0, 500.0]), ("0.5 2", [0.5, 2.0])],
)
def test_levels_as_people_write_them(addon, text, levels):
    assert addon.isolines.parse_levels(text) == levels


@pytest.mark.parametrize("text", ["much", "100 -5", "0", "nan", "1e999"])
def test_levels_that_are_none(addon, text):
    with pytest.raises(ValueError, match=text.split()[-1]):
        addon.isolines.parse_levels(text)


def test_labels_keep_their_distance_and_every_level_has_one(addon):
    x = np.linspace(0.0, 10.0, 101)
    ends = np.array([[(a, y, 0.0), (b, y, 0.0)] for y in (0.0, 5.0) for a, b in pairwise(x)])
    lines = addon.isolines.IsoLines(ends, np.repeat([100.0, 200.0], 100), np.arange(200))
    chosen = addon.isolines.label_edges(lines, 2.0)
    places = ends[chosen].mean(axis=1)
    apart = np.linalg.norm(places[:, None] - places, axis=2) + 10.0 * np.eye(len(places))
    assert apart.min() >= 2.0
    assert set(lines.values[chosen].tolist()) == {100.0, 200.0}
    assert len(addon.isolines.label_edges(lines, 0.0, most=7)) == 7


def test_no_labels_where_lines_crowd(addon):
    x = np.linspace(0.0, 10.0, 101)
    crowd = [[(a, y, 0.0), (b, y, 0.0)] for y in (0.0, 0.01) for a, b in pairwise(x)]
    alone = [[(a, 9.0, 0.0), (b, 9.0, 0.0)] for a, b in pairwise(x)]
    lines = addon.isolines.IsoLines(np.array(crowd + alone), np.repeat([100.0, 200.0, 100.0], 100), np.arange(300))
    assert (addon.isolines.label_edges(lines, 2.0) >= 200).all()
    assert len(addon.isolines.label_edges(lines, 2.0)) >= 2
