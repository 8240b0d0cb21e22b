"""What receivers see: the nearest obstacle in each parcel, against single rays and closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from builders import box_polygons, cosine_rays, first_hits, lambert_form_factor
from hypothesis import given, settings
from hypothesis import strategies as st

from luzespecular import polygons
from luzespecular.globe import Globe
from luzespecular.materials import Material
from luzespecular.outlines import Outlines
from luzespecular.specular import GroupSight
from luzespecular.tracing import ChainLimits
from luzespecular.visibility import OPEN

GLOBES = {bands: Globe(bands) for bands in (24, 60)}
TOLERANCE = 1e-9


def seen_shares(points, normal, outlines, bands=60):
    """(r, outlines + 1): cosine-weighted share that each point sees of each outline, and last of nothing."""
    padded, _ = polygons.pad([np.asarray(o, float) for o in outlines])
    normals = polygons.newell_normal(padded)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = np.einsum("oc,oc->o", normals, padded[:, 0])
    count = len(padded)
    scene = Outlines(padded, normals, offsets, [Material()] * count, np.zeros(count, bool), TOLERANCE)
    points = np.atleast_2d(points).astype(float)
    half = GLOBES[bands].hemisphere(normal)
    sightings, _ = GroupSight(scene, half, float(points[0] @ half.normal), ChainLimits()).sightings(points)
    (sight,) = sightings
    view = sight.view
    shares = np.zeros((len(points), count + 1))
    number = np.append(sight.obstacles.outlines, count)  # OPEN is -1, the last
    row, beam = np.nonzero(view.seen >= OPEN)
    np.add.at(shares, (row, number[view.seen[row, beam]]), sight.weights[row, beam])
    np.add.at(shares, (view.part_row, number[view.part_seen]), sight.part_weights())
    return shares


def by_rays(point, normal, outlines):
    hits = first_hits(np.asarray(point, float), cosine_rays(normal), outlines)
    return np.bincount(np.where(hits < 0, len(outlines), hits), minlength=len(outlines) + 1) / len(hits)


def lift(point, normal, height=1e-7):
    return np.asarray(point, float) + height * np.asarray(normal, float)


ROOM = box_polygons((4, 3, 2.5))
SHELF = np.array([[1, 0.5, 1.2], [3, 0.5, 1.2], [3, 1.5, 1.5], [1, 1.5, 1.5]])
SCREEN = np.array([[2, 2, 0], [2, 2, 2], [3.5, 1.5, 2], [3.5, 1.5, 0]])


def test_nothing_in_the_way():
    far = np.array([[0, 0, -9], [1, 0, -9], [1, 1, -9]])
    np.testing.assert_allclose(seen_shares([[0, 0, 0]], [0, 0, 1], [far]), [[0, 1]], atol=1e-12)


@pytest.mark.parametrize("bands", [24, 60])
@pytest.mark.parametrize("side", list(ROOM))
def test_a_closed_box_shows_no_sky(side, bands):
    corner = ROOM[side]
    normal = np.cross(corner[1] - corner[0], corner[3] - corner[0])
    place = np.array([[0.5, 0.5], [0.1, 0.3], [0.999, 0.5], [1e-6, 1e-6]])
    points = corner[0] + place[:, :1] * (corner[1] - corner[0]) + place[:, 1:] * (corner[3] - corner[0])
    shares = seen_shares(points, normal, ROOM.values(), bands)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=2e-6)
    np.testing.assert_allclose(shares[:, -1], 0, atol=3e-6)
    assert (shares[:, list(ROOM).index(side)] == 0).all(), "a plane does not see itself"


def test_surfaces_through_a_point_block_nothing():
    """At the foot of a wall and in a corner, the walls that the point lies in are looked past."""
    points = [[0, 1, 0], [0, 0, 0], [4, 3, 0]]
    shares = seen_shares(points, [0, 0, 1], ROOM.values())
    np.testing.assert_allclose(shares[:, -1], [0.5, 0.75, 0.75], atol=1e-4)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=2e-6)


@settings(max_examples=25, deadline=None)
@given(
    st.tuples(st.floats(0.1, 10), st.floats(0.1, 10), st.floats(0.1, 10)),
    st.tuples(st.floats(0.01, 0.99), st.floats(0.01, 0.99), st.floats(0.01, 0.99)),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(lambda v: np.linalg.norm(v) > 0.1),
)
def test_any_point_in_any_box_sees_exactly_one_of_everything(size, place, normal):
    shares = seen_shares([np.multiply(size, place)], normal, box_polygons(size).values(), 24)
    assert shares.sum() == pytest.approx(1, abs=1e-5)
    assert shares[0, -1] < 1e-5


def test_shares_in_a_box_are_its_form_factors():
    points = np.array([[1.0, 1.0, 0], [0.2, 2.8, 0], [2, 1.5, 0]])
    shares = seen_shares(points, [0, 0, 1], ROOM.values())
    for point, got in zip(points, shares, strict=True):
        exact = [lambert_form_factor((p - point)[None], [0, 0, 1])[0] for p in list(ROOM.values())[1:]]
        np.testing.assert_allclose(got[1:6], exact, atol=5e-4)


@pytest.mark.parametrize("point", [(0.7, 0.6, 0), (2, 1.2, 0), (2.5, 2.2, 0), (3.9, 0.1, 0)])
def test_a_furnished_room_against_rays(point):
    outlines = [*ROOM.values(), SHELF, SCREEN]
    got = seen_shares([point], [0, 0, 1], outlines)[0]
    expected = by_rays(lift(point, [0, 0, 1]), [0, 0, 1], outlines)
    np.testing.assert_allclose(got, expected, atol=8e-4)
    assert got[-1] < 3e-6


@pytest.mark.parametrize("point", [(0, 1, 1.0), (0, 1.4, 1.45), (0, 2.7, 0.3)])
def test_openings_against_rays(point):
    """Ceiling away, and no east wall: sky seen past the shelf and the screen."""
    outlines = [ROOM[k] for k in ("floor", "south", "north", "west")] + [SHELF, SCREEN]
    got = seen_shares([point], [1, 0, 0], outlines)[0]
    np.testing.assert_allclose(got, by_rays(lift(point, [1, 0, 0]), [1, 0, 0], outlines), atol=8e-4)
    assert got.sum() == pytest.approx(1, abs=1e-5)


def test_tilted_receivers_against_rays():
    normal = np.array([0.5, -0.3, 0.8]) / np.linalg.norm([0.5, -0.3, 0.8])
    point = np.array([1.2, 1.9, 0.4])
    outlines = [*ROOM.values(), SHELF, SCREEN]
    got = seen_shares([point], normal, outlines)[0]
    np.testing.assert_allclose(got, by_rays(point, normal, outlines), atol=8e-4)


def test_receivers_looked_at_together_or_alone_see_the_same():
    rng = np.random.default_rng(0)
    points = np.c_[rng.uniform(0, 4, 40), rng.uniform(0, 3, 40), np.zeros(40)]
    outlines = [*ROOM.values(), SHELF, SCREEN]
    together = seen_shares(points, [0, 0, 1], outlines)
    alone = np.concatenate([seen_shares([p], [0, 0, 1], outlines) for p in points])
    np.testing.assert_allclose(together, alone, atol=2e-6)


@pytest.mark.parametrize("columns", [1, 2, 5])
def test_edges_shared_by_obstacles_let_nothing_through(columns):
    """A ceiling of many strips hides the sky as one piece does; their shares add up to its share."""
    limits = np.linspace(0, 4, columns + 1)
    strips = [np.array([[b, 0, 2.5], [a, 0, 2.5], [a, 3, 2.5], [b, 3, 2.5]]) for a, b in pairwise(limits)]
    points = np.array([[1.3, 0.7, 0], [3.99, 2.99, 0], [2, 1.5, 0]])
    split = seen_shares(points, [0, 0, 1], strips)
    whole = seen_shares(points, [0, 0, 1], [ROOM["ceiling"]])
    np.testing.assert_allclose(split[:, :-1].sum(axis=1), whole[:, 0], atol=3e-4)
    walls = [ROOM[k] for k in ("south", "north", "west", "east")]
    closed = seen_shares(points, [0, 0, 1], [*strips, *walls])
    np.testing.assert_allclose(closed[:, -1], 0, atol=3e-6)
    np.testing.assert_allclose(closed.sum(axis=1), 1, atol=2e-6)


def test_three_planes_that_meet_leak_nothing():
    """A tent seen from inside: ridges and corners where three edges cross one parcel."""
    foot = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0.0]])
    top = np.array([0.3, -0.2, 1.5])
    tent = [np.array([foot[k], foot[(k + 1) % 4], top])[::-1] for k in range(4)]
    shares = seen_shares([[0.1, 0.2, 0], [-0.8, 0.7, 0]], [0, 0, 1], tent)
    np.testing.assert_allclose(shares[:, -1], 0, atol=1e-5)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=1e-5)


@pytest.mark.parametrize("bands", GLOBES)
def test_a_wall_seen_at_a_slant_hides_the_one_that_begins_at_its_edge(bands):
    """The corner of an L-shaped room: in parcels that several edges of the near wall cross, too."""
    near = np.array([[1, 2, 0], [1, 2, 1.2], [1, 1, 1.2], [1, 1, 0.0]])
    behind = np.array([[1, 1, 0], [1, 1, 1.2], [2, 1, 1.2], [2, 1, 0.0]])
    far = np.array([[2, 0, 0], [2, 0, 1.2], [0, 0, 1.2], [0, 0, 0.0]])
    x, z = np.meshgrid([0.6, 0.9, 0.96, 0.99, 0.999], np.linspace(0.03, 1.17, 9))
    points = np.stack([x.ravel(), np.full(x.size, 2.0), z.ravel()], axis=1)
    shares = seen_shares(points, [0, -1, 0], [near, behind, far], bands)
    assert shares[:, 0].min() > 0.01
    np.testing.assert_allclose(shares[:, 1], 0, atol=1e-9)


def with_hole(size, centre=(2.0, 1.5), height=2.5):
    """A ceiling of 40 m around a square hole."""
    (x, y), h, far = centre, size / 2, 40.0
    strips = [
        (-far, -far, x - h, far),
        (x + h, -far, far, far),
        (x - h, -far, x + h, y - h),
        (x - h, y + h, x + h, far),
    ]
    return [
        np.array([[b, s, height], [a, s, height], [a, n, height], [b, n, height]]) for a, s, b, n in strips
    ], np.array([[x - h, y + h, height], [x + h, y + h, height], [x + h, y - h, height], [x - h, y - h, height]])


@pytest.mark.parametrize(("size", "rms"), [(1.0, 1e-3), (0.5, 1e-3), (0.3, 2e-3), (0.1, 3e-3)])
def test_a_hole_in_the_ceiling(size, rms):
    """A square hole seen from all over a floor 2.5 m below; parcels are 0.13 m wide there."""
    around, hole = with_hole(size)
    points = np.random.default_rng(1).uniform([0.1, 0.1, 0], [3.9, 2.9, 0], (40, 3))
    ceiling = np.array([[-40, 40, 2.5], [40, 40, 2.5], [40, -40, 2.5], [-40, -40, 2.5]])
    around_the_ceiling = seen_shares(points, [0, 0, 1], [ceiling])[:, -1]
    got = seen_shares(points, [0, 0, 1], around)[:, -1] - around_the_ceiling
    exact = np.array([lambert_form_factor((hole - p)[None], [0, 0, 1])[0] for p in points])
    assert np.sqrt(np.mean((got / exact - 1) ** 2)) < rms
    assert got.sum() == pytest.approx(exact.sum(), rel=rms)


def test_the_nearest_of_two_prevails():
    near = np.array([[1, 0, 1], [0, 0, 1], [0, 1, 1], [1, 1, 1.0]])
    far = near * [3, 3, 2] - [1, 1, 0]
    alone = seen_shares([[0.4, 0.3, 0]], [0, 0, 1], [near])[0, 0]
    for outlines, first in (([near, far], 0), ([far, near], 1)):
        shares = seen_shares([[0.4, 0.3, 0]], [0, 0, 1], outlines)[0]
        assert shares[first] == pytest.approx(alone, rel=1e-3)
        np.testing.assert_allclose(shares, by_rays((0.4, 0.3, 0), (0, 0, 1), outlines), atol=8e-4)


def test_both_sides_of_an_outline_block():
    plate = np.array([[1, 0, 1], [0, 0, 1], [0, 1, 1], [1, 1, 1.0]])
    front = seen_shares([[0.4, 0.3, 0]], [0, 0, 1], [plate])
    np.testing.assert_allclose(seen_shares([[0.4, 0.3, 0]], [0, 0, 1], [plate[::-1]]), front, atol=1e-9)


def test_small_obstacles_are_not_lost():
    """A plate of a sixtieth of a parcel still covers its share of it, on the mean over many places."""
    rng = np.random.default_rng(5)
    size, total, exact = 0.01, 0.0, 0.0
    for _ in range(100):
        x, y = rng.uniform(-1, 1, 2)
        plate = np.array([[x + size, y, 1], [x, y, 1], [x, y + size, 1], [x + size, y + size, 1]])
        total += seen_shares([[0, 0, 0]], [0, 0, 1], [plate])[0, 0]
        exact += lambert_form_factor(plate[None], [0, 0, 1])[0]
    assert total == pytest.approx(exact, rel=0.5)
