"""Doubles: what is given twice blocks, mirrors and shines once; what only overlaps, or differs, stays as it is."""

import numpy as np
import pytest
from builders import BLACK, UNIFORM, box_polygons, prepare_coarse

import luzespecular as luz
from luzespecular.doubles import seen_once
from luzespecular.planes import find_planes

GREY = luz.Material(diffuse_reflectance=0.5)
SQUARE = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)


def shown(*surfaces):
    """Names of the surfaces whose outlines are kept, and what stands for the sides."""
    scene = luz.Scene()
    scene.add("far", SQUARE * 3 - [0, 0, 3], BLACK)
    for number, (polygon, material, two_sided) in enumerate(surfaces):
        scene.add(f"{number}", polygon, material, two_sided=two_sided)
    planes = seen_once(find_planes(scene), list(scene.surfaces.values()))
    return [planes.surfaces[k] for k in planes.sheet_surface[planes.outline_sheet]][1:], planes.stands_for.tolist()


@pytest.mark.parametrize("shift", [0.0, 1e5, -1e-8])
def test_the_last_of_copies_is_seen(shift):
    names, stands_for = shown((SQUARE, GREY, False), (np.roll(SQUARE, 1, axis=0) + shift * 1e-12, GREY, False))
    assert names == ["1"] and stands_for == [0, 2, 2, 3, 5, 5]
    assert shown(*[(SQUARE, GREY, True)] * 4)[0] == ["3"]


def test_sides_of_copies_that_look_the_other_way():
    names, stands_for = shown((SQUARE, GREY, False), (SQUARE[::-1], GREY, True))
    assert names == ["1"] and stands_for == [0, 5, 2, 3, 2, 5]


@pytest.mark.parametrize(
    "surfaces",
    [
        [(SQUARE, GREY, False), (SQUARE[::-1], GREY, False)],
        [(SQUARE, GREY, False), (SQUARE, BLACK, False)],
        [(SQUARE, GREY, True), (SQUARE, GREY, False)],
        [(SQUARE, GREY, False), (np.add(SQUARE, [0, 0, 1e-4]), GREY, False)],
        [(SQUARE, GREY, False), (np.add(SQUARE, [1e-3, 0, 0]), GREY, False)],
        [(SQUARE, GREY, False), (SQUARE[[0, 1, 2]], GREY, False)],
        [(SQUARE, GREY, False), ((SQUARE - 0.5) @ [[0, 0, 1], [0, 1, 0], [-1, 0, 0]] + 0.5, GREY, False)],
    ],
    ids=["back to back", "of two materials", "one side of two", "above", "beside", "a part", "across"],
)
def test_what_is_no_copy_is_seen_besides(surfaces):
    assert shown(*surfaces)[0] == ["0", "1"]


@pytest.mark.parametrize("two_sided", [False, True])
def test_faces_twice_in_one_mesh_count_once(two_sided):
    """All faces of a box but one, each twice: as the box itself, but that receivers are shared among more faces."""
    sides = [polygon for name, polygon in box_polygons((3, 3, 3)).items() if name != "ceiling"]
    lux, absorbed = [], []
    for copies in (1, 2):
        scene = luz.Scene()
        faces = np.concatenate([np.arange(20).reshape(-1, 4)] * copies)
        scene.add("room", np.concatenate(sides), GREY, faces=faces, two_sided=two_sided)
        result = prepare_coarse(scene, elements=600, patches=150).solve(UNIFORM)
        lux.append(result.at([[1, 1, 0], [0, 2, 1.5]], [[0, 0, 1], [1, 0, 0]]))
        absorbed.append(result.balance.absorbed["room"])
        assert abs(result.balance.defect) < 1e-3
        assert ("overlap" in {finding.kind for finding in luz.check(scene)}) == (copies == 2)
    np.testing.assert_allclose(lux[1], lux[0], rtol=5e-3)
    assert absorbed[1] == pytest.approx(absorbed[0], rel=2e-3)


def test_a_saved_transfer_and_other_materials_keep_them(tmp_path):
    def scene(reflectance):
        made = luz.Scene()
        for name, polygon in box_polygons((2, 2, 2)).items():
            if name != "ceiling":
                for copy in "ab":
                    made.add(f"{name} {copy}", polygon, luz.Material(diffuse_reflectance=reflectance))
        return made

    transfer = luz.prepare(scene(0.5), bands=8, max_area=1.0)
    usual = transfer.solve(UNIFORM).illuminance
    loaded = luz.load(transfer.save(tmp_path / "twice"), scene(0.5))
    np.testing.assert_array_equal(loaded.solve(UNIFORM).illuminance, usual)
    other = transfer.with_materials(scene(0.3))
    np.testing.assert_allclose(
        other.solve(UNIFORM).illuminance, luz.prepare(scene(0.3), bands=8, max_area=1.0).solve(UNIFORM).illuminance
    )
    assert "overlap" in {finding.kind for finding in other.findings}
    many = transfer.solve_many([UNIFORM], sun_spacing=0)[0]
    np.testing.assert_allclose(many, usual, rtol=2e-3)
