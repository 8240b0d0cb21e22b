"""Work planes: where their points lie, what is read there, and its statistics."""

import csv

import numpy as np
import pytest

PARTS = ("sky_direct", "sky_specular", "sun_direct", "sun_specular", "emitted")
OPEN_SKY = 10_000.0


def triangles(*quads):
    """Two triangles for each quad of corners."""
    quads = np.array(quads, float)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def rectangle(x0, y0, x1, y1, z=0.0, up=True):
    corners = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return corners if up else corners[::-1]


def centres(lattice):
    return lattice.vertices[lattice.corners].mean(axis=1)


def test_grid_fills_the_floor_at_the_height(addon):
    lattice = addon.floor_grid.above_floor(triangles(rectangle(1, 2, 4, 4, z=0.2)), 0.75, 0.5, 0.0, 0.0)
    assert len(lattice.corners) == 6 * 4
    points = centres(lattice)
    assert points[:, 2] == pytest.approx(0.95)
    assert points[:, :2].min(axis=0) == pytest.approx([1.25, 2.25])
    assert points[:, :2].max(axis=0) == pytest.approx([3.75, 3.75])
    edge = lattice.vertices[lattice.corners]
    normals = np.cross(edge[:, 1] - edge[:, 0], edge[:, 2] - edge[:, 0])
    assert (normals[:, 2] > 0).all()


def test_grid_follows_the_outline_and_keeps_off_the_walls(addon):
    floor = triangles(rectangle(0, 0, 4, 2), rectangle(0, 2, 2, 4))  # an L
    points = centres(addon.floor_grid.above_floor(floor, 0.75, 0.5, 0.0, 0.0))
    assert len(points) == 48
    assert not ((points[:, 0] > 2) & (points[:, 1] > 2)).any()
    inner = centres(addon.floor_grid.above_floor(floor, 0.75, 0.5, 0.5, 0.0))
    assert 0 < len(inner) < 48
    assert inner[:, :2].min() > 0.5
    assert not ((inner[:, 0] > 1.5) & (inner[:, 1] > 1.5)).any()


def test_the_floor_is_the_lowest_large_level_that_looks_up(addon):
    house = triangles(
        rectangle(0, 0, 3, 3, z=0.0),
        rectangle(0, 0, 3, 3, z=3.0, up=False),  # ceiling
        rectangle(-1, -1, 4, 4, z=3.3),  # roof, larger
        rectangle(-1, -1, 4, 4, z=-0.2, up=False),  # underside
        rectangle(1, 1, 2, 2, z=-0.5),  # a pit, small
    )
    lattice = addon.floor_grid.above_floor(house, 0.75, 1.0, 0.0, 0.0)
    assert lattice.vertices[:, 2] == pytest.approx(3.3 + 0.75)  # half the roof's area is more than the floor's
    lattice = addon.floor_grid.above_floor(house[[0, 1, 3, 4, 5, 6, 8, 9]], 0.75, 1.0, 0.0, 0.0)
    assert lattice is not None


def test_grid_turns_with_the_room(addon):
    turn = np.radians(30.0)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    floor = triangles(rectangle(0, 0, 3, 2)) @ rotation.T
    lattice = addon.floor_grid.above_floor(floor, 0.75, 0.5, 0.0, turn)
    points = centres(lattice) @ rotation
    assert len(points) == 24
    assert points[:, 0].min() == pytest.approx(0.25)
    assert points[:, 1].max() == pytest.approx(1.75)


def test_no_floor_no_grid(addon):
    assert addon.floor_grid.above_floor(triangles(rectangle(0, 0, 1, 1, up=False)), 0.75, 0.5, 0.0, 0.0) is None
    assert addon.floor_grid.above_floor(np.zeros((0, 3, 3)), 0.75, 0.5, 0.0, 0.0) is None
    assert addon.floor_grid.above_floor(triangles(rectangle(0, 0, 1, 1)), 0.75, 0.5, 5.0, 0.0) is None
    with pytest.raises(ValueError, match="1000000"):
        addon.floor_grid.above_floor(triangles(rectangle(0, 0, 1, 1)), 0.75, 0.001, 0.0, 0.0)


def test_statistics(addon):
    found = addon.work_planes.statistics(np.array([100.0, 300.0, 500.0, np.nan]), np.array([1.0, 1.0, 2.0, 9.0]), 300.0)
    assert (found.area, found.minimum, found.maximum) == (4.0, 100.0, 500.0)
    assert found.mean == pytest.approx(350.0)
    assert found.uniformity == pytest.approx(100.0 / 350.0)
    assert found.share_above == pytest.approx(0.75)
    assert addon.work_planes.statistics(np.array([np.nan]), np.ones(1), 300.0) is None
    dark = addon.work_planes.statistics(np.zeros(2), np.ones(2), 300.0)
    assert np.isnan(dark.uniformity)
    assert dark.share_above == 0.0


@pytest.fixture
def plane(addon, bpy, make):
    """A floor of 2 m, a canopy over a part of it, and a work plane of 0.5 m, solved."""
    make.square("Floor", size=2.0)
    make.square("Canopy", height=1.5)
    make.quick()
    assert bpy.ops.luzespecular.add_work_plane(spacing=0.5) == {"FINISHED"}
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    return bpy.context.object


def lux(addon, object_, name="illuminance"):
    return addon.mesh_arrays.read_face_values(object_.data, name, np.float32)


def test_points_are_read_where_they_are(addon, bpy, plane):
    result = addon.display.kept_result(bpy.context.scene)[1]
    points = addon.mesh_arrays.polygon_centres(plane.data)
    assert len(points) == 16
    assert points[:, 2] == pytest.approx(0.75)
    expected = result.at(points.astype(float), np.tile([0.0, 0.0, 1.0], (16, 1)))
    np.testing.assert_allclose(lux(addon, plane), expected, rtol=1e-4)
    assert np.ptp(expected) > 1_000
    found = addon.work_planes.statistics_of(plane, 1.0)
    assert found.area == pytest.approx(4.0)
    assert found.mean == pytest.approx(expected.mean(), rel=1e-4)
    assert found.minimum == pytest.approx(expected.min(), rel=1e-4)


def test_parts_of_the_light_are_read_too(addon, bpy, plane):
    result = addon.display.kept_result(bpy.context.scene)[1]
    points = addon.mesh_arrays.polygon_centres(plane.data).astype(float)
    initial = result.at(points, np.tile([0.0, 0.0, 1.0], (16, 1)), initial=True)
    np.testing.assert_allclose(lux(addon, plane, "illuminance_initial"), initial, rtol=1e-4)
    parts = result.at(points, np.tile([0.0, 0.0, 1.0], (16, 1)), components=True)
    for name, values in parts.items():
        np.testing.assert_allclose(lux(addon, plane, f"illuminance_{name}"), values, rtol=1e-4, err_msg=name)
    assert parts["sky_direct"].max() > 1_000
    reflected = lux(addon, plane, "illuminance_interreflected")
    assert reflected.max() > 10.0
    np.testing.assert_allclose(lux(addon, plane), initial + reflected, rtol=1e-4)
    found = addon.work_planes.statistics_of(plane, 1.0, "interreflected")
    assert found.maximum == pytest.approx(reflected.max())

    settings = bpy.context.scene.luzespecular.display
    settings.quantity = "initial"
    (shown,) = [one for one in addon.display.shown_meshes(bpy.context.scene) if one.object_ == plane]
    np.testing.assert_allclose(shown.values, initial, rtol=1e-4)
    settings.quantity, settings.unit = "interreflected", "FACTOR"
    (shown,) = [one for one in addon.display.shown_meshes(bpy.context.scene) if one.object_ == plane]
    np.testing.assert_allclose(shown.values, 100.0 * reflected / OPEN_SKY, rtol=1e-3)
    settings.quantity, settings.unit = "sky_direct", "LUX"
    (shown,) = [one for one in addon.display.shown_meshes(bpy.context.scene) if one.object_ == plane]
    np.testing.assert_allclose(shown.values, parts["sky_direct"], rtol=1e-4)
    settings.quantity = "error"
    (shown,) = [one for one in addon.display.shown_meshes(bpy.context.scene) if one.object_ == plane]
    assert np.isnan(shown.values).all()
    bpy.ops.luzespecular.clear_results()
    assert not [name for name in plane.data.attributes.keys() if "illuminance" in name]


def test_a_plane_changes_no_light_and_appears_in_no_table(addon, bpy, plane):
    scene = bpy.context.scene
    assert {row.name for row in scene.luzespecular.results.rows} == {"Floor", "Canopy"}
    assert {surface.object_name for surface in addon.export.export_scene(bpy.context).surfaces} == {"Floor", "Canopy"}
    assert not plane.hide_get()
    assert plane.data.color_attributes.active_color_name == "luzespecular"


def test_a_moved_plane_is_told_and_read_anew(addon, bpy, plane):
    assert not addon.work_planes.is_stale(plane)
    before = lux(addon, plane)
    plane.location.z += 1.0
    bpy.context.view_layer.update()
    assert addon.work_planes.is_stale(plane)
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert not addon.work_planes.is_stale(plane)
    assert lux(addon, plane) == pytest.approx(OPEN_SKY, rel=1e-3)  # above the canopy
    assert before.min() < 0.9 * OPEN_SKY


def test_scale_turn_and_unit_of_a_plane_count(addon, bpy, make):
    bpy.context.scene.unit_settings.scale_length = 0.01
    make.square("Floor", size=200.0)
    make.quick()
    assert bpy.ops.luzespecular.add_work_plane(height=0.5, spacing=1.0) == {"FINISHED"}
    plane = bpy.context.object
    assert addon.mesh_arrays.vertex_positions(plane.data)[:, 2] == pytest.approx(50.0)
    plane.scale = (0.5, 1.0, 1.0)
    plane.rotation_euler.x = np.pi
    bpy.context.view_layer.update()
    (grid,) = addon.work_planes.grids(bpy.context.scene, 0.01)
    assert grid.normals[:, 2] == pytest.approx(-1.0)
    assert grid.points[:, 0] == pytest.approx([0.25, 0.25, 0.75, 0.75], abs=1e-6)
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert addon.work_planes.statistics_of(plane, 0.01).area == pytest.approx(2.0)


def test_any_mesh_can_be_a_work_plane(addon, bpy, make):
    make.square("Floor")
    own = make.square("My grid", size=0.5, height=0.4)
    make.quick()
    own.luzespecular.plane.enabled = True
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert lux(addon, own) == pytest.approx(OPEN_SKY, rel=1e-3)
    own.luzespecular.plane.enabled = False
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert {row.name for row in bpy.context.scene.luzespecular.results.rows} == {"Floor", "My grid"}


def test_selected_objects_choose_the_floor(addon, bpy, make):
    make.square("Ground", size=50.0)
    room = make.square("Room", size=2.0, height=1.0)
    room.select_set(True)
    assert bpy.ops.luzespecular.add_work_plane(spacing=1.0) == {"FINISHED"}
    points = addon.mesh_arrays.polygon_centres(bpy.context.object.data)
    assert len(points) == 4
    assert points[:, 2] == pytest.approx(1.75)


def test_the_floor_of_an_open_box_is_inside_whatever_its_normals(addon, bpy, make):
    box = make.cube("Room", size=3.0)
    box.data.clear_geometry()
    corners = [(x, y, z) for z in (0, 3) for y in (0, 3) for x in (0, 3)]
    box.data.from_pydata(corners, [], [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (0, 4, 6, 2), (1, 3, 7, 5)])
    assert bpy.ops.luzespecular.add_work_plane() == {"FINISHED"}
    (plane,) = addon.work_planes.all_of(bpy.context.scene)
    assert [vertex.co.z for vertex in plane.data.vertices] == pytest.approx([0.75] * len(plane.data.vertices))


def test_refusals_name_the_remedy(addon, bpy, make):
    make.square("Floor", size=50.0)
    with pytest.raises(RuntimeError, match="choose a larger spacing"):
        bpy.ops.luzespecular.add_work_plane(spacing=0.01)
    with pytest.raises(RuntimeError, match="smaller border"):
        bpy.ops.luzespecular.add_work_plane(border=40.0)
    assert addon.work_planes.all_of(bpy.context.scene) == []


def test_planes_that_share_a_mesh_are_refused(addon, bpy, make, plane):
    make.object("Second", plane.data).luzespecular.plane.enabled = True
    with pytest.raises(RuntimeError, match="Make Single User"):
        bpy.ops.luzespecular.solve()


def test_attributes_of_the_users_own_grid_are_not_overwritten(addon, bpy, make):
    make.square("Floor")
    own = make.square("My grid", size=0.5, height=0.4)
    own.luzespecular.plane.enabled = True
    own.data.attributes.new("illuminance", "FLOAT", "FACE").data[0].value = 7.0
    make.quick()
    with pytest.raises(RuntimeError, match="'My grid' has an attribute 'illuminance'"):
        bpy.ops.luzespecular.solve()
    assert lux(addon, own)[0] == 7.0


def test_points_are_saved(addon, bpy, plane, tmp_path):
    path = tmp_path / "pontos à mesa.csv"
    assert bpy.ops.luzespecular.save_work_planes(filepath=str(path)) == {"FINISHED"}
    rows = list(csv.DictReader(path.open(encoding="utf-8")))
    assert len(rows) == 16
    assert [float(row["illuminance_lx"]) for row in rows] == pytest.approx(lux(addon, plane).tolist(), rel=1e-4)
    assert {row["z_m"] for row in rows} == {"0.75"}
    for row in rows:
        known = {name: float(row[f"{name}_lx"]) for name in ("illuminance", "initial", *PARTS, "interreflected")}
        assert known["illuminance"] == pytest.approx(known["initial"] + known["interreflected"], rel=1e-4)
        assert known["initial"] == pytest.approx(sum(known[name] for name in PARTS), rel=1e-4)
    bpy.ops.luzespecular.clear_results()
    assert not bpy.ops.luzespecular.save_work_planes.poll()


def test_reading_tells_how_far_it_is(addon, bpy, plane):
    result = addon.display.kept_result(bpy.context.scene)[1]
    (grid,) = addon.work_planes.grids(bpy.context.scene, 1.0)
    told = []
    addon.work_planes.read(result, [grid] * 4, lambda fraction, stage: told.append((fraction, stage)) or True)
    assert told == [(share, "work planes") for share in (0.0, 0.25, 0.5, 0.75)]


def test_reading_can_be_cancelled(addon, bpy, plane):
    result = addon.display.kept_result(bpy.context.scene)[1]
    grids = addon.work_planes.grids(bpy.context.scene, 1.0)
    with pytest.raises(addon.luz.Cancelled):
        addon.work_planes.read(result, grids, lambda *_: False)
