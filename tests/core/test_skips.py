"""What a scene does not need is left out, told with its reason, and changes no light."""

import numpy as np
import pytest
from builders import BLACK, UNIFORM, box, prepare_coarse

import luzespecular as luz
from luzespecular import outlines, specular, sunlight
from luzespecular.geometry import make_geometry
from luzespecular.globe import Globe
from luzespecular.nodes import Nodes
from luzespecular.planes import find_planes
from luzespecular.transfer import Transfer

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.8)
LAMP = luz.Material(diffuse_reflectance=0.5, exitance=100.0)
PANE = luz.Material(regular_transmittance=0.8, refractive_index=1.52)


def reasons(stages):
    return {stage.name: stage.skipped for stage in stages if stage.skipped}


def noon(azimuth=0.0):
    return luz.Daylight(
        sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=azimuth, horizontal_illuminance=10_000),
        sun=luz.Sun(altitude=40, azimuth=azimuth, normal_illuminance=70_000),
    )


def assert_same(one, other):
    for name, values in one.components.items():
        np.testing.assert_allclose(other.components[name], values, rtol=1e-12, err_msg=name)


def shelved():
    scene = box(WHITE, (3, 3, 3), without=("north",), ceiling=MIRROR, west=BLACK)
    scene.add("shelf", [[0, 2.2, 1.8], [3, 2.2, 1.8], [3, 3, 1.8], [0, 3, 1.8]], WHITE)
    return scene


def test_closed_scenes_hold_no_sky(monkeypatch):
    closed = prepare_coarse(box(WHITE, west=LAMP))
    assert "closed" in reasons(closed.stages)["form factors to the sky"]
    assert closed.sky_direct.packed()["values"].size == 0
    result = closed.solve(noon())
    assert reasons(result.stages)["sky"] == "nothing sees the sky or the ground"
    monkeypatch.setattr(Transfer, "sees_out", True)
    assert_same(result, closed.solve(noon()))


def test_closed_scenes_are_saved_too(tmp_path):
    closed = prepare_coarse(box(WHITE, west=LAMP))
    path = closed.save(tmp_path / "closed.npz")
    with np.load(path) as content:
        assert not content["sky_direct_values"].size


def test_open_scenes_look_out():
    transfer = prepare_coarse(box(WHITE, without=("north",)))
    assert "form factors to the sky" not in reasons(transfer.stages)
    assert "sky" not in reasons(transfer.solve(UNIFORM).stages)


def test_backs_that_receive_nothing_are_left_in_shadow(monkeypatch):
    """The Sun from behind lights the walls' outer sides alone: nobody asks how."""
    transfer = prepare_coarse(shelved(), max_area=0.3)
    assert "outlines have a back" in reasons(transfer.stages)["backs"]
    result = transfer.solve(noon(azimuth=180.0))
    assert reasons(result.stages)["sun patches"] == "the Sun reaches no side that receives"
    assert "sun patches" not in reasons(transfer.solve(noon()).stages)
    every = np.ones(len(transfer.geometry.outlines.vertices), bool)
    monkeypatch.setattr(outlines.Outlines, "back_counts", every)
    assert_same(result, transfer.solve(noon(azimuth=180.0)))
    with_backs = transfer.solve(noon())
    monkeypatch.undo()
    assert_same(transfer.solve(noon()), with_backs)


def test_backs_that_count_are_lit():
    scene = box(WHITE, (3, 3, 3), without=("north",))
    scene.add("pane", [[0, 3, 0], [3, 3, 0], [3, 3, 3], [0, 3, 3]], PANE)
    scene.add("leaf", [[1, 1, 1], [2, 1, 1], [2, 2, 1], [1, 2, 1]][::-1], WHITE, two_sided=True)
    outlines = prepare_coarse(scene).geometry.outlines
    assert outlines.back_counts.tolist() == [False] * 5 + [True, True]
    found = sunlight.trace_sun(outlines, np.array([0.0, 0.7, 0.7]), 1.0, 1e-3, lambda: None)
    assert any(patch.outline == 6 and not patch.front for patch in found.patches)


def test_black_surfaces_have_no_patches():
    transfer = prepare_coarse(shelved())
    assert reasons(transfer.stages)["patches of black surfaces"].startswith("2 of 6")
    patch = transfer.geometry.targets.patches.of_element
    surface = np.array(transfer.geometry.planes.surfaces)[transfer.geometry.element_surface]
    assert (patch[np.isin(surface, ["west", "ceiling"])] == -1).all()
    assert (patch[surface == "floor"] >= 0).all()


def test_planes_that_cannot_see_each_other_are_counted():
    """Each of the 5 walls and the shelf lies in its own plane, and the floor below the shelf's upper side."""
    told = reasons(prepare_coarse(shelved()).stages)["pairs that cannot see each other"]
    assert told.startswith("7 of 36")


def test_planes_behind_receivers_change_nothing(monkeypatch):
    """Beyond the rounding of single precision: outlines that are cut elsewhere have other corners."""
    scene = shelved()
    light = noon()
    usual = prepare_coarse(scene, max_area=0.5).solve(light)
    cut = specular.obstacles_within

    def uncut(outlines, normals, offsets, half_spaces, tolerance):
        return (
            cut(outlines, normals, offsets, half_spaces[1:], tolerance)
            if len(half_spaces) == 1
            else cut(outlines, normals, offsets, half_spaces, tolerance)
        )

    monkeypatch.setattr(specular, "obstacles_within", uncut)
    whole = prepare_coarse(scene, max_area=0.5).solve(light)
    for name, values in usual.components.items():
        np.testing.assert_allclose(whole.components[name], values, rtol=1e-4, atol=1e-2, err_msg=name)


# Wanted faces alone


@pytest.fixture(scope="module")
def all_faces():
    return prepare_coarse(shelved(), elements=400, max_area=0.02)


@pytest.fixture(scope="module")
def floor_alone():
    return prepare_coarse(shelved(), elements=400, max_area=0.02, receivers=["floor"])


def test_wanted_faces_get_the_light_they_get_among_all(all_faces, floor_alone):
    among, alone = all_faces.solve(noon()), floor_alone.solve(noon())
    floor = among.faces_of("floor")
    np.testing.assert_allclose(alone.centroids, among.centroids[floor])
    np.testing.assert_allclose(alone.vertices, among.vertices[floor])
    np.testing.assert_array_equal(alone.source_faces, among.source_faces[floor])
    np.testing.assert_allclose(alone.areas, among.areas[floor])
    for name in ("sky_direct", "sun_direct", "sky_specular", "sun_specular"):
        np.testing.assert_allclose(alone.components[name], among.components[name][floor], rtol=1e-4, atol=0.5)
    assert alone.mean("floor") == pytest.approx(among.mean("floor"), rel=5e-3)
    assert np.median(np.abs(alone.illuminance / among.illuminance[floor] - 1)) < 5e-3
    assert alone.error.shape == alone.exitance.shape == alone.illuminance.shape
    assert abs(alone.balance.defect) < 1e-3
    assert set(alone.balance.absorbed) == set(among.balance.absorbed)
    np.testing.assert_allclose(alone.at([[1, 1, 1]], [[0, 0, 1]]), among.at([[1, 1, 1]], [[0, 0, 1]]), rtol=5e-3)


def test_fewer_receivers_look(floor_alone):
    scene = shelved()
    counts = []
    for receivers in (None, ["floor"]):
        geometry = make_geometry(scene, find_planes(scene), Globe(4), None, receivers=receivers)
        counts.append(len(Nodes.of(geometry.fracture, geometry.lattices).points))
    assert counts[1] < 0.9 * counts[0]
    assert "5 of 6 surfaces are no receivers" in reasons(floor_alone.stages)["faces"]


def test_other_faces_are_not_computed_rather_than_dark(floor_alone):
    result = floor_alone.solve(noon())
    assert result.surfaces == ["floor"]
    assert len(result.illuminance) == len(result.faces_of("floor"))
    for ask in (result.faces_of, result.mean):
        with pytest.raises(luz.SceneError, match="'ceiling' were not computed: prepare with it among the receivers"):
            ask("ceiling")
    with pytest.raises(luz.SceneError, match="no surface 'roof'"):
        result.mean("roof")
    with pytest.raises(luz.SceneError, match="'ceiling' were not computed"):
        floor_alone.annual([UNIFORM]).spatial_daylight_autonomy("ceiling")


def test_backs_of_wanted_faces_alone():
    scene = box(WHITE, without=("north",))
    leaf = [[0.3, 0.3, 0.5], [0.7, 0.3, 0.5], [0.7, 0.7, 0.5], [0.3, 0.7, 0.5]]
    scene.add("leaf", leaf, WHITE, two_sided=True)
    both = prepare_coarse(scene, receivers=["leaf", "floor"]).solve(UNIFORM)
    assert np.isnan(both.back.illuminance[both.faces_of("floor")]).all()
    assert (both.back.illuminance[both.faces_of("leaf")] > 0).all()
    assert prepare_coarse(scene, receivers=["floor"]).solve(UNIFORM).back is None


def test_many_lights_on_wanted_faces(floor_alone):
    found = floor_alone.solve_many([UNIFORM, noon()], sun_spacing=0)
    alone = np.array([floor_alone.solve(light).illuminance for light in (UNIFORM, noon())])
    assert found.shape == alone.shape
    np.testing.assert_allclose(found.mean(axis=1), alone.mean(axis=1), rtol=3e-3)


def test_order_of_names_does_not_matter():
    first = prepare_coarse(box(WHITE, without=("north",)), receivers=("west", "floor", "floor"))
    assert first.fingerprint.options["receivers"] == ("floor", "west")
    assert first.solve(UNIFORM).surfaces == ["floor", "west"]


@pytest.mark.parametrize(
    "receivers, message",
    [("floor", "must be a list"), (7, "must be a list"), ([], "the list is empty"), (["roof"], "no surface 'roof'")],
)
def test_receivers_that_are_none_are_refused(receivers, message):
    with pytest.raises(luz.SceneError, match=message):
        luz.prepare(box(WHITE), receivers=receivers)


def test_saved_with_its_receivers(tmp_path):
    cache = tmp_path / "cache.npz"
    scene = box(WHITE, without=("north",))
    first = prepare_coarse(scene, receivers=["floor"], cache=cache)
    again = prepare_coarse(scene, receivers=["floor"], cache=cache)
    assert "taken from" in reasons(again.stages)["visibility and form factors"]
    np.testing.assert_array_equal(again.solve(UNIFORM).illuminance, first.solve(UNIFORM).illuminance)
    assert "receivers" in reasons(prepare_coarse(scene, cache=cache).stages)["cache"]
