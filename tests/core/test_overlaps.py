"""Openings of any size and shape, against Lambert's formula for what the receivers see of the sky beyond."""

import numpy as np
import pytest
from builders import box_polygons, prepare_coarse
from test_visibility import seen_shares

import luzespecular as luz
from luzespecular import polygons
from luzespecular.bright import Source
from luzespecular.materials import Material
from luzespecular.outlines import Outlines
from luzespecular.sources import gather_sources
from luzespecular.tracing import ChainLimits

SIZE = np.array([4.0, 3.0, 2.5])
BEYOND = 500.0


def rectangle(axis, at, low, high, inward):
    """Corners of a rectangle across an axis, its normal along or against it."""
    others = [k for k in range(3) if k != axis]
    corners = np.zeros((4, 3))
    corners[:, axis] = at
    corners[:, others] = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    return corners if polygons.newell_normal(corners)[axis] * inward > 0 else corners[::-1]


def room_with(side, low, high):
    """A room of 4 m × 3 m × 2.5 m with a hole in one side, of which four rectangles are left."""
    axis, at, inward = {"ceiling": (2, SIZE[2], -1), "east": (0, SIZE[0], -1)}[side]
    far = SIZE[[k for k in range(3) if k != axis]]
    (a, c), (b, d) = low, high
    pieces = [((0, 0), (a, far[1])), ((b, 0), far), ((a, 0), (b, c)), ((a, d), (b, far[1]))]
    return [p for name, p in box_polygons(SIZE).items() if name != side] + [
        rectangle(axis, at, *piece, inward) for piece in pieces
    ]


def louvres(tilt):
    """Twenty slats of 6 cm, 6 cm apart, before a window in the east."""
    turn = np.radians(tilt)
    across = 0.03 * np.array([np.cos(turn), 0, np.sin(turn)])
    ends = np.array([[4.05, 0.4, 0.93], [4.05, 2.6, 0.93]])
    slat = np.stack([ends[0] - across, ends[0] + across, ends[1] + across, ends[1] - across])
    return [slat + np.array([0, 0, 0.06 * k]) for k in range(20)]


WINDOW = ((0.5, 0.9), (2.5, 2.1))
SCENES = {
    "hole of 1 m": (room_with("ceiling", (1.6, 0.9), (2.6, 1.9)), 0.05, 0.2),
    "hole of 30 cm": (room_with("ceiling", (1.98, 1.26), (2.28, 1.56)), 0.1, 0.4),
    "hole of 10 cm": (room_with("ceiling", (2.08, 1.36), (2.18, 1.46)), 0.15, 0.6),
    "hole of 3 cm": (room_with("ceiling", (2.115, 1.395), (2.145, 1.425)), 0.1, 0.4),
    "hole of 5 mm": (room_with("ceiling", (2.125, 1.405), (2.13, 1.41)), 0.1, 0.4),
    "slot of 1 cm": (room_with("east", (0.9, 0.02), (0.91, 2.4)), 0.05, 0.2),
    "gap below a door": (room_with("east", (0.5, 0.005), (1.4, 0.015)), 0.1, 0.4),
    "window": (room_with("east", *WINDOW), 0.03, 0.1),
    "level louvres": (room_with("east", *WINDOW) + louvres(0), 0.3, 1.0),
    "tilted louvres": (room_with("east", *WINDOW) + louvres(30), 0.3, 1.0),
    "bars": (
        room_with("east", *WINDOW)
        + [rectangle(0, 4.02, (0.6 + 0.2 * k, 0.8), (0.62 + 0.2 * k, 2.2), -1) for k in range(10)],
        0.03,
        0.1,
    ),
    "a plate above a hole": (
        [*room_with("ceiling", (1.5, 1.0), (2.5, 2.0)), rectangle(2, 2.7, (1.4, 0.9), (2.3, 2.1), -1)],
        0.15,
        0.5,
    ),
}


def exact_share(points, normal, outlines):
    """Form factors to a sheet far larger than the room, behind all outlines."""
    padded, _ = polygons.pad(outlines)
    normals = polygons.newell_normal(padded)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    count = len(padded)
    scene = Outlines(
        padded,
        normals,
        np.einsum("oc,oc->o", normals, padded[:, 0]),
        [Material()] * count,
        np.zeros(count, bool),
        1e-9,
    )
    sheets = [
        rectangle(axis, at, (-BEYOND, -BEYOND), (BEYOND, BEYOND), -1)
        for axis, at in ((0, SIZE[0] + 1), (2, SIZE[2] + 1))
    ]
    # no line of sight through a hole meets both within their edges but past the room
    seen = [gather_sources(scene, [Source(sheet, 1.0)], points, normal, ChainLimits(1e-6)) for sheet in sheets]
    return np.maximum(*seen)


@pytest.mark.parametrize("name", SCENES)
def test_openings(name):
    """RMS and largest error of the light of an even sky, over receivers on the floor and two walls [%]."""
    outlines, rms, most = SCENES[name]
    rng = np.random.default_rng(3)
    errors = []
    for normal, axis in (((0, 0, 1), 2), ((1, 0, 0), 0), ((0, 1, 0), 1)):
        points = rng.uniform(0.05, 0.95, (20, 3)) * SIZE
        points[:, axis] = 0.0
        exact = exact_share(points, normal, outlines)
        got = seen_shares(points, normal, outlines)
        np.testing.assert_allclose(got.sum(axis=1), 1, atol=2e-6)
        lit = exact > 0.01 * exact.max()
        errors.append(got[lit, -1] / exact[lit] - 1)
    errors = 100 * np.concatenate(errors)
    assert np.sqrt(np.mean(errors**2)) < rms, f"RMS {np.sqrt(np.mean(errors**2)):.3f} %"
    assert np.abs(errors).max() < most, f"most {np.abs(errors).max():.3f} %"


def test_straight_below_an_opening():
    outlines = room_with("ceiling", (1.5, 1.0), (2.5, 2.0))
    points = np.c_[np.random.default_rng(1).uniform([1.6, 1.1], [2.4, 1.9], (20, 2)), np.zeros(20)]
    got = seen_shares(points, [0, 0, 1], outlines)[:, -1]
    np.testing.assert_allclose(got, exact_share(points, [0, 0, 1], outlines), rtol=1e-3)


def test_a_gap_between_planes_that_do_not_meet_in_line():
    """A shelf 1 cm before a window wall: sky past its edge from below, none of the wall's edges near it."""
    shelf = np.array([[3.2, 0, 1.2], [3.2, 3, 1.2], [3.99, 3, 1.2], [3.99, 0, 1.2]])
    outlines = [*room_with("east", (0.4, 0.3), (2.6, 2.2)), shelf]
    points = np.array([[1.0, 1.0, 0], [3.0, 2.0, 0], [3.9, 1.5, 0], [3.97, 0.5, 0]])
    got = seen_shares(points, [0, 0, 1], outlines)[:, -1]
    np.testing.assert_allclose(got, exact_share(points, [0, 0, 1], outlines), rtol=3e-3)


@pytest.mark.parametrize("bands", [24, 60])
def test_closed_solids_that_are_not_convex_show_no_backs(bands):
    """A prism with an L for its floor: what lies beyond its inner corner is hidden, to the last bit."""
    foot = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 2.5], [0, 2.5]])
    walls = []
    for a, b in zip(foot, np.roll(foot, -1, axis=0), strict=True):
        walls.append(np.array([[*b, 0], [*a, 0], [*a, 2.2], [*b, 2.2]]))
    flat = [np.array([[0, 0], [1, 0], [1, 2.5], [0, 2.5]]), np.array([[1, 0], [3, 0], [3, 1], [1, 1]])]
    floors = [np.c_[f, np.zeros(4)] for f in flat]
    ceilings = [np.c_[f, np.full(4, 2.2)][::-1] for f in flat]
    outlines = [*walls, *floors, *ceilings]
    points = np.array([[0, 1.667, 1.008], [0, 1.35, 0.9], [0, 2.0, 0.3]])
    shares = seen_shares(points, [1, 0, 0], outlines, bands)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=2e-6)
    assert shares[:, -1].max() < 1e-6
    assert shares[:, 2].max() < 1e-6, "the wall that shows its back"


@pytest.mark.parametrize("bands", [24, 60])
@pytest.mark.parametrize("width", [0.1, 0.03, 0.01])
def test_a_small_hole_straight_above(bands, width):
    """Its edges' normals cancel for whoever is right below, as if each edge were met by another."""
    scene = luz.Scene()
    a, b = 2 - 0.5 * width, 2 + 0.5 * width
    for name, ((x0, x1), (y0, y1)) in {
        "west": ((0, a), (0, 4)),
        "east": ((b, 4), (0, 4)),
        "south": ((a, b), (0, a)),
        "north": ((a, b), (b, 4)),
    }.items():
        scene.add(name, [[x0, y1, 3], [x1, y1, 3], [x1, y0, 3], [x0, y0, 3]], luz.Material())
    for name, polygon in box_polygons((4, 4, 3)).items():
        if name != "ceiling":
            scene.add(f"room {name}", polygon, luz.Material())
    result = prepare_coarse(scene, elements=40, bands=bands).solve(luz.Daylight(sky=luz.UniformSky(1e6)))
    points = np.array([[2, 2, 0], [2.0001, 2, 0], [2.1, 2.05, 0]])
    expected = 1e6 * width**2 * 9 / (((points - [2, 2, 3]) ** 2).sum(axis=1)) ** 2
    np.testing.assert_allclose(result.at(points, [[0, 0, 1.0]] * 3), expected, rtol=0.01)
