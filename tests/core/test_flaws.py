"""What is odd in a scene is told, by name, and nothing else is."""

import logging

import numpy as np
import pytest
from builders import BLACK, box, box_polygons, prepare_coarse, scene_of
from hypothesis import given
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import clipping, flaws, polygons

GREY = luz.Material(diffuse_reflectance=0.5)
FLOOR = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
PATCH = np.add(0.5 * FLOOR, [0.25, 0.25, 0])


def notes(scene):
    """What is said of overlaps and of rooms inside out."""
    return tuple(str(f) for f in luz.check(scene) if f.kind in ("overlap", "inside out"))


def test_sound_scenes_have_no_notes(light_shelf):
    for variant in light_shelf.VARIANTS:
        assert notes(light_shelf.scene(variant)) == ()
    assert notes(box()) == notes(box(without=("ceiling",))) == ()
    touching = scene_of({"one": FLOOR, "two": np.add(FLOOR, [1, 0, 0]), "above": np.add(FLOOR, [0, 0, 1e-3])})
    assert notes(touching) == ()


@pytest.mark.parametrize("other", [FLOOR, np.roll(FLOOR, 1, axis=0), PATCH, np.add(FLOOR, [0.5, 0.5, 1e-9])])
def test_surfaces_on_one_another(other, caplog):
    with caplog.at_level(logging.WARNING, logger="luzespecular"):
        scene = scene_of({"floor": FLOOR, "carpet": other})
        (note,) = notes(scene)
        prepare_coarse(scene, elements=8, bands=4)
    assert note == "Surfaces 'floor' and 'carpet' lie on one another in one plane; remove what is doubled"
    assert note in caplog.text


def test_of_different_materials():
    (note,) = notes(scene_of({"floor": FLOOR, "carpet": PATCH}, carpet=GREY))
    assert "'floor' and 'carpet'" in note and "different materials" in note


def test_back_to_back_is_a_sheet_with_two_sides():
    assert notes(scene_of({"floor": FLOOR, "from below": FLOOR[::-1]})) == ()
    scene = scene_of({"floor": FLOOR})
    scene.add("plate", PATCH[::-1], GREY, two_sided=True)
    assert "different materials" in notes(scene)[0]


def test_faces_doubled_within_a_mesh():
    scene = luz.Scene()
    scene.add("mesh", [*FLOOR, *PATCH], BLACK, faces=[[0, 1, 2, 3], [4, 5, 6, 7]])
    assert notes(scene) == ("Surface 'mesh': some of its faces lie on one another; remove the doubles",)


def test_a_sliver_and_many_pairs():
    assert notes(scene_of({"floor": FLOOR, "sliver": [[0, 0, 0], [1, 0, 0], [1, 1e-9, 0], [0, 1e-9, 0]]})) == ()
    many = notes(scene_of({f"sheet {k}": FLOOR for k in range(9)}))
    assert len(many) == 11 and many[-1].startswith("26 more pairs of surfaces lie on one another")


def test_a_room_inside_out():
    turned = {name: polygon[::-1] for name, polygon in box_polygons().items() if name != "ceiling"}
    (note,) = notes(scene_of(turned))
    assert note.startswith("All surfaces look outward") and "reverse the order of the vertices" in note
    with_a_chair = turned | {"chair": np.add(PATCH, [0, 0, 0.5])}
    assert notes(scene_of(with_a_chair)) == ()  # something within sees the walls' backs, and may be meant to
    assert notes(scene_of({"floor": FLOOR, "canopy": np.add(FLOOR, [0, 0, 1])})) == ()


@given(
    st.integers(3, 7),
    st.integers(3, 7),
    st.floats(0, 6.28),
    st.floats(0, 3),
    st.floats(0, 6.28),
)
def test_overlap_agrees_with_clipping(m, n, turn, distance, towards):
    def regular(k, angle):
        angles = angle + 2 * np.pi * np.arange(k) / k
        return np.c_[np.cos(angles), np.sin(angles), np.zeros(k)]

    one, two = regular(m, 0.0), regular(n, turn) + distance * np.array([np.cos(towards), np.sin(towards), 0])
    clipped = two[None]
    for a, b in zip(one, np.roll(one, -1, axis=0), strict=True):
        inward = np.array([-(b - a)[1], (b - a)[0], 0.0])
        clipped = clipping.clip(clipped, inward / np.linalg.norm(inward), a @ inward / np.linalg.norm(inward))
    area = float(polygons.areas(clipped).sum()) if clipped.size else 0.0
    outlines, _ = polygons.pad([one, two])
    found = flaws.overlapping_outlines(outlines, np.tile([0.0, 0, 1], (2, 1)), np.zeros(2), 1e-6)
    if area > 1e-3 or area == 0.0:
        assert (len(found) == 1) == (area > 0)


def test_all_pairs_of_a_heap_are_found():
    rng = np.random.default_rng(5)
    low = rng.random((60, 2)) * 5
    size = 0.1 + rng.random((60, 2))
    corners = low[:, None] + size[:, None] * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    outlines = np.concatenate([corners, np.zeros((60, 4, 1))], axis=2)
    found = flaws.overlapping_outlines(outlines, np.tile([0.0, 0, 1], (60, 1)), np.zeros(60), 1e-9)
    high = low + size
    expected = {
        (i, j)
        for i in range(60)
        for j in range(i + 1, 60)
        if (np.minimum(high[i], high[j]) - np.maximum(low[i], low[j])).min() > 1e-9
    }
    assert {tuple(sorted(pair)) for pair in found.tolist()} == expected and len(expected) > 50


@pytest.mark.parametrize(
    ("faces", "turned"),
    [
        ([[0, 1, 2], [0, 2, 3]], 0),
        ([[0, 1, 2], [0, 3, 2]], 1),
        ([[0, 1, 2], [2, 1, 0]], 0),  # a sheet given from both sides
        ([[0, 1, 2], [0, 2, 3], [0, 2, 4]], 0),  # three faces meet: none is wrong
    ],
)
def test_faces_of_a_mesh_turned_over(faces, turned, caplog):
    corners = [*FLOOR, [0.5, 0.5, 1]]
    surface = luz.Scene().add("mesh", corners, BLACK, faces=faces)
    assert len(surface.notes) == turned == len(caplog.records)
    if turned:
        assert "across 1 edges neighbours are turned over; recalculate its normals" in surface.notes[0]
    assert luz.Scene().add("mesh", corners, BLACK, faces=faces, two_sided=True).notes == ()
