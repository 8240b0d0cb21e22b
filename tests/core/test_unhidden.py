"""Form factors past screens, against what is left when each screen's cone is cut away, piece by piece."""

import numpy as np
import pytest
from builders import lambert_form_factor
from hypothesis import given, settings
from hypothesis import strategies as st

from luzespecular import clipping, polygons, unhidden
from luzespecular.blockers import Blockers
from luzespecular.standing import Standing

UP = np.array([0.0, 0.0, 1.0])
EYES = np.array([[0.0, 0.0, 0.0], [0.7, -0.4, 0.0], [-0.9, 0.8, 0.0], [0.05, 1.3, 0.0]])
CORNERS = st.lists(st.floats(0, 6.2), min_size=3, max_size=5, unique_by=lambda a: round(a, 2))
SCREENS = st.tuples(
    CORNERS, st.floats(-1, 1), st.floats(-1, 1), st.floats(0.1, 0.8), st.floats(0.4, 1.5), st.booleans()
)


def ring(angles, x, y, size, height, turned=False):
    """Convex polygon on a circle that stands a little oblique."""
    a = np.sort(angles)
    corners = np.stack([x + size * np.cos(a), y + size * np.sin(a), height + 0.2 * size * np.cos(a)], axis=1)
    return corners[::-1] if turned else corners


LAMP = np.array([[-0.8, -0.7, 2.0], [-0.8, 0.9, 2.0], [0.9, 0.7, 2.0], [0.6, -0.9, 2.0]])


def blockers_of(screens):
    corners, _ = polygons.pad(screens)
    normals = polygons.newell_normal(corners)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return Blockers(
        corners,
        normals,
        np.einsum("kc,kc->k", normals, corners[:, 0]),
        np.arange(len(corners)),
        np.full(len(corners), -1),
    )


def past(screens, shape=LAMP, eyes=EYES, normal=UP):
    """By the room under test."""
    corners = blockers_of(screens).vertices
    facing = blockers_of(screens).facing(eyes, None, 0.0)
    relative = np.ascontiguousarray((corners[:, None] - eyes[:, None]).transpose(0, 3, 2, 1))
    shapes = np.ascontiguousarray((shape[None] - eyes[:, None]).transpose(2, 1, 0))
    return unhidden.form_factors(shapes, relative, facing, normal)


def cut_away(screens, shape=LAMP, eyes=EYES, normal=UP):
    """By cutting, eye after eye."""
    found = []
    for eye in eyes:
        pieces = [shape - eye]
        for screen in screens:
            corners, left = screen - eye, []
            around = polygons.newell_normal(corners) @ corners[0]
            if abs(around) < 1e-12:
                continue  # seen edge-on
            for piece in pieces:
                inside = piece[None]
                for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                    wall = np.sign(around) * np.cross(a, b)
                    left.append(clipping.clip(inside, -wall)[0])
                    inside = clipping.clip(inside, wall)
            pieces = left
        found.append(sum(float(lambert_form_factor(piece[None], normal)[0]) for piece in pieces))
    return np.array(found)


@settings(max_examples=40, deadline=None)
@given(st.lists(SCREENS, min_size=1, max_size=4))
def test_screens_that_overlap_anyhow(given):
    screens = [ring(*screen) for screen in given]
    np.testing.assert_allclose(past(screens), cut_away(screens), atol=1e-10)


def box(x, y, z, size, turn):
    """Faces of a cube."""
    corners = np.array([(i, j, k) for k in (-1, 1) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]) * size / 2
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    corners = corners @ rotation.T + [x, y, z]
    faces = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    return [corners[list(face)] for face in faces]


@settings(max_examples=12, deadline=None)
@given(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6), st.floats(0.1, 0.7), st.floats(0, 3))
def test_screens_that_share_edges(x, y, size, turn):
    screens = box(x, y, 1.0, size, turn)
    expected = cut_away(screens)
    np.testing.assert_allclose(past(screens), expected, atol=1e-10)
    np.testing.assert_allclose(past([*screens, *screens[::-1]]), expected, atol=1e-10, err_msg="each one twice")
    halves = [half for face in screens for half in (face[[0, 1, 2]], face[[0, 2, 3]])]
    np.testing.assert_allclose(past(halves), expected, atol=1e-10, err_msg="in halves")


def test_screens_with_edges_on_the_lamps_own():
    """As where furniture stands on a sunlit floor."""
    for screen in (LAMP, LAMP[::-1], LAMP[[0, 1, 2]], np.stack([LAMP[0], LAMP[1], LAMP[1] - UP, LAMP[0] - UP])):
        for more in ([], [ring([0.1, 2.0, 4.0], 0.1, 0.2, 0.4, 1.0)]):
            np.testing.assert_allclose(past([screen, *more]), cut_away([screen, *more]), atol=1e-10)
    assert np.abs(past([LAMP])).max() < 1e-12
    beside = LAMP[[1, 0]] - [[0.5, 0, 0]]
    beside = np.concatenate([LAMP[:2], beside])  # shares an edge, and hides nothing
    np.testing.assert_allclose(past([beside]), past([beside + np.array([5.0, 0, 0])]), atol=1e-12)


def test_nothing_in_the_way():
    shapes = np.ascontiguousarray((LAMP[None] - EYES[:, None]).transpose(2, 1, 0))
    whole = lambert_form_factor(LAMP[None] - EYES[:, None], UP)
    np.testing.assert_allclose(unhidden.whole_form_factors(shapes, UP), whole, rtol=1e-12)
    np.testing.assert_allclose(past([ring([0, 2, 4], 9.0, 0.0, 0.5, 1.0)]), whole, rtol=1e-12)
    padded = np.concatenate([LAMP, LAMP[-1:], LAMP[-1:]])
    np.testing.assert_allclose(past([box(0, 0, 1, 0.3, 0.4)[0]], padded), past([box(0, 0, 1, 0.3, 0.4)[0]]), rtol=1e-12)


def within(window, shape=LAMP, eyes=EYES, normal=UP):
    """By the room under test: what of a shape is seen through a window."""
    relative = [np.ascontiguousarray((one[None] - eyes[:, None]).transpose(2, 1, 0)) for one in (shape, window)]
    return unhidden.form_factors_within(*relative, blockers_of([window]).facing(eyes, None, 0.0)[0], normal)


@settings(max_examples=60, deadline=None)
@given(SCREENS)
def test_what_a_window_shows_is_what_a_screen_of_its_shape_hides(given):
    window = ring(*given)
    expected = cut_away([]) - cut_away([window])
    np.testing.assert_allclose(within(window), expected, atol=1e-10)
    padded = np.concatenate([window, window[-1:], window[-1:]])
    np.testing.assert_allclose(within(padded), expected, atol=1e-10)


def test_windows_with_edges_on_the_lamps_own():
    """As where a mirror ends at the wall that the Sun shines on."""
    whole, beside = cut_away([]), np.concatenate([LAMP[:2], LAMP[[1, 0]] - [[0.5, 0, 0]]])
    np.testing.assert_allclose(within(LAMP), whole, rtol=1e-12)
    np.testing.assert_allclose(within(LAMP[::-1]), whole, rtol=1e-12)
    np.testing.assert_allclose(within(LAMP[[0, 1, 2]]), whole - cut_away([LAMP[[0, 1, 2]]]), atol=1e-10)
    np.testing.assert_allclose(within(beside), 0, atol=1e-12)
    far = LAMP * [1, 1, 0.5] + [9.0, 0, 0]
    np.testing.assert_allclose(within(far), 0, atol=1e-12)


def overlaps(blockers, lamp, facing):
    """(k, r) bool twice: what hides and what crosses the lamp, those told apart beforehand left out."""
    one = np.zeros(1, int)
    standing = Standing.of(blockers, np.zeros(len(blockers), int), lamp[None], one, one, one, EYES[None], 1e-12)
    hides, crosses = np.zeros((2, len(blockers), len(EYES)), bool)
    for lookout in standing.lookouts:
        mine = standing.blockers.outline[lookout.overlaps.outer]
        hides[mine], crosses[mine] = lookout.overlaps.seen(EYES, facing[standing.blockers.outline])
    return hides, crosses


@settings(max_examples=30, deadline=None)
@given(st.lists(SCREENS, min_size=1, max_size=4), st.floats(0.05, 0.8))
def test_blockers_that_are_passed_over_hide_nothing(given, size):
    screens, lamp = [ring(*screen) for screen in given], LAMP * [size, size, 1]
    blockers = blockers_of(screens)
    facing = blockers.facing(EYES, None, 1e-12)
    hides, crosses = overlaps(blockers, lamp, facing)
    whole, parts = past([screens[0] + np.array([50.0, 0, 0])], lamp), past(screens, lamp)
    for eye in range(len(EYES)):
        if hides[:, eye].any():
            assert abs(parts[eye]) < 1e-8
        some = [screens[k] for k in np.flatnonzero((hides | crosses)[:, eye])]
        expected = past(some, lamp, EYES[eye : eye + 1])[0] if some else whole[eye]
        assert parts[eye] == pytest.approx(expected, abs=1e-8)


def test_blockers_that_only_touch_are_passed_over():
    beside = np.concatenate([LAMP[:2], LAMP[[1, 0]] - [[0.5, 0, 0]]])
    touching = blockers_of([beside, LAMP[::-1], LAMP[[0, 1, 2]]])
    hides, crosses = overlaps(touching, LAMP, touching.facing(EYES, None, 1e-12))
    np.testing.assert_array_equal(hides.all(axis=1), [False, True, False])
    np.testing.assert_array_equal(crosses.all(axis=1), [False, False, True])
    assert not (hides[0].any() or crosses[0].any())
