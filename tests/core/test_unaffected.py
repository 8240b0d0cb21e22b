"""Changed objects: receivers that see nothing of them keep their form factors, and light is as if all looked again."""

import numpy as np
import pytest
from builders import UNIFORM, box_polygons, prepare_coarse
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular.arrays import box_corners
from luzespecular.form_factors import Rows
from luzespecular.rays import RayScene
from luzespecular.unaffected import Unaffected

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.9)
ALIKE = 5e-3
"""Share of the mean light: what stands behind walls decides whether a parcel is divided exactly or counts as whole."""


def two_rooms(place=(0.5, 0.7, 0.4), door=False, mirror=None, cabinet=WHITE, size=0.4):
    """Rooms that are open to the north, on either side of a wall at x = 2; in the western one a cabinet, off the floor.

    With a door the wall ends 0.6 m before the northern side.
    """
    scene = luz.Scene()
    for room, at in (("western", 0.0), ("eastern", 2.0)):
        for side, polygon in box_polygons((2.0, 2.0, 2.0), (at, 0.0, 0.0)).items():
            if side == "north":
                continue
            polygon = polygon.copy()
            if door and (room, side) in (("western", "east"), ("eastern", "west")):
                polygon[:, 1] = np.minimum(polygon[:, 1], 1.4)
            scene.add(f"{room} {side}", polygon, MIRROR if mirror == f"{room} {side}" else WHITE)
    if cabinet is not None:
        for side, polygon in box_polygons((size,) * 3, place).items():
            scene.add(f"cabinet {side}", polygon[::-1], cabinet)
    return scene


def coarse(scene, **options):
    return prepare_coarse(scene, elements=300, patches=80, **{"bands": 12, "max_area": 0.3, **options})


def kept(transfer):
    """How many receivers, of how many, keep their form factors."""
    note = next(stage.skipped for stage in transfer.stages if stage.name == "reuse")
    words = note.split("; ")[1].split()
    return int(words[0]), int(words[2])


def assert_as_fresh(transfer, scene):
    one, other = (t.solve(UNIFORM) for t in (transfer, coarse(scene)))
    np.testing.assert_allclose(one.illuminance, other.illuminance, atol=ALIKE * other.illuminance.mean())


@pytest.fixture(scope="module")
def before():
    return coarse(two_rooms())


def test_the_other_room_is_not_looked_at_again(before):
    moved = two_rooms(place=(0.9, 0.6, 0.8))
    transfer = coarse(moved, reuse=before)
    east = [name.startswith("eastern") for name in transfer.geometry.planes.surfaces]
    there = np.array(east)[transfer.geometry.element_surface[transfer.nodes.element]]
    some, every = kept(transfer)
    assert every == len(transfer.nodes.points)
    assert there.sum() <= some < every
    assert_as_fresh(transfer, moved)
    assert "another shape of 'cabinet" in next(s.skipped for s in transfer.stages if s.name == "reuse")


def test_what_was_added_or_taken_away_counts_where_it_is_or_was(before):
    for earlier, scene in ((before, two_rooms(cabinet=None)), (coarse(two_rooms(cabinet=None)), two_rooms())):
        transfer = coarse(scene, reuse=earlier)
        assert_as_fresh(transfer, scene)


def test_through_a_door_some_are_looked_from_again():
    black = luz.Material()
    before = coarse(two_rooms(door=True, cabinet=black))
    moved = two_rooms(place=(1.2, 1.2, 0.4), door=True, cabinet=black)
    transfer = coarse(moved, reuse=before)
    shut, _ = kept(coarse(two_rooms(place=(1.2, 1.2, 0.4)), reuse=coarse(two_rooms())))
    some, _ = kept(transfer)
    assert 0 < some < shut
    assert_as_fresh(transfer, moved)


def test_light_by_mirrors_is_found_anew():
    before = coarse(two_rooms(mirror="eastern floor"))
    moved = two_rooms(place=(0.9, 0.6, 0.8), mirror="eastern floor")
    transfer = coarse(moved, reuse=before)
    nodes = transfer.nodes
    surface = transfer.geometry.element_surface[nodes.element]
    ceiling = np.count_nonzero(surface == transfer.geometry.planes.surfaces.index("eastern ceiling"))
    east = sum(
        np.count_nonzero(surface == k)
        for k, name in enumerate(transfer.geometry.planes.surfaces)
        if name.startswith("eastern")
    )
    some, _ = kept(transfer)
    assert ceiling and some <= len(nodes.points) - ceiling
    assert some < east
    assert_as_fresh(transfer, moved)


@pytest.mark.parametrize(
    "options, scene",
    [
        ({"bands": 14}, two_rooms()),
        ({}, two_rooms(place=(0.5, 0.7, 2.4))),  # above the roof: the middle of the scene has moved
    ],
)
def test_nothing_is_kept_where_nothing_can(before, options, scene):
    transfer = coarse(scene, reuse=before, **options)
    assert kept(transfer)[0] == 0
    assert_as_fresh(transfer, scene) if not options else None


@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.tuples(st.floats(0.1, 3.5), st.floats(0.1, 1.5), st.floats(0.1, 1.5)), st.booleans())
def test_wherever_it_goes_the_light_is_as_if_all_looked_again(place, door):
    """In the open, beside walls, through the wall between; black, so that no patches tell who sees it."""
    black = luz.Material()
    before = coarse(two_rooms(cabinet=black, door=door))
    moved = two_rooms(place=np.round(place, 2), cabinet=black, door=door)
    assert_as_fresh(coarse(moved, reuse=before), moved)


@pytest.mark.parametrize("seed", range(6))
def test_what_counts_as_hidden_is_met_by_no_ray(seed):
    """And what one ray gets to is not hidden."""
    rng = np.random.default_rng(seed)
    scene = luz.Scene()
    scene.add("cabinet", box_polygons((0.5, 0.5, 0.5), (0.2, 0.2, 0.2))["floor"], WHITE)
    for k in range(12):
        corners = rng.normal(size=(3, 3)) * 1.5
        scene.add(f"screen {k}", corners + 1.5, luz.Material(regular_transmittance=0.9) if k == 0 else WHITE)
    transfer = coarse(scene)
    one = transfer.geometry
    unaffected = Unaffected.of(one, one, transfer.nodes, Rows.empty(0, one), {"cabinet"})
    points = rng.uniform(-4, 6, size=(400, 3)) - one.planes.centre
    normals = rng.normal(size=(400, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    (low, high), *_ = unaffected.boxes + np.array([[0, 0, 0], [0, 0, 0.4]])
    hidden = unaffected._hidden(points, normals, box_corners(low, high))
    assert 20 < hidden.sum() < 380
    towards = rng.uniform(low, high, size=(400, 60, 3)) - points[:, None]
    above = np.einsum("kbc,kc->kb", towards, normals) > 1e-9
    row, ray = np.nonzero(above)
    vertices, normal = one.outlines.vertices[unaffected.screens], one.outlines.normals[unaffected.screens]
    screens = RayScene(vertices, normal, one.outlines.offsets[unaffected.screens], one.outlines.tolerance)
    gets_there = screens.nearest(points[row], towards[row, ray])[1] > 1.0
    assert not hidden[row[gets_there]].any()
    assert len(unaffected.screens) == len(one.outlines.vertices) - 2


def test_why_nothing_is_kept_is_told(before, tmp_path, monkeypatch):
    def told(transfer):
        return [stage.skipped for stage in transfer.stages if stage.name == "reuse"]

    (bounds,) = told(coarse(two_rooms(place=(0.5, 0.7, 2.4)), reuse=before))
    assert bounds.endswith("receivers keep their form factors, as the scene's bounding box has changed")
    moved = two_rooms(place=(0.9, 0.6, 0.8))
    accurate = coarse(two_rooms(), accuracy=0.1)
    assert "another shape of 'cabinet" in told(coarse(moved, accuracy=0.1, reuse=accurate))[0]
    assert told(coarse(moved, accuracy=0.1, reuse=accurate))[0].endswith("chosen anew for the accuracy")
    path = tmp_path / "moved.npz"
    coarse(moved, cache=path)
    (from_file,) = told(coarse(moved, reuse=before, cache=path))
    assert "another shape of 'cabinet" in from_file
    monkeypatch.setattr("luzespecular.facets.MANY_OUTLINES", 5)
    (many,) = told(coarse(moved, reuse=before))
    assert many.endswith("as there are more outlines than are projected")


def test_chains_of_changes_add_up_to_nothing(before):
    """There and back, each step from the one before."""
    transfer = before
    for place in ((0.9, 0.6, 0.8), (1.6, 1.6, 0.0), (0.5, 0.7, 0.4)):
        transfer = coarse(two_rooms(place=place), reuse=transfer)
    one, other = transfer.solve(UNIFORM), before.solve(UNIFORM)
    np.testing.assert_allclose(one.illuminance, other.illuminance, atol=ALIKE * other.illuminance.mean())
