"""Solving and writing back, as a script or the button does it: lux on faces, colours, views, and leaving no trace."""

import csv
import math

import numpy as np
import pytest

OPEN_SKY = 10_000.0


@pytest.fixture
def solve(bpy):
    """Run the operator in the foreground."""

    def run():
        assert bpy.ops.luzespecular.solve() == {"FINISHED"}

    return run


def lux(addon, object_, name="illuminance"):
    return addon.mesh_arrays.read_face_values(object_.data, name, np.float32)


def fine(addon, bpy):
    return addon.results_object.find(bpy.context.scene)


def everything(bpy):
    """All that results could leave traces in, as plain values."""
    return {
        "objects": sorted(
            (
                o.name,
                o.hide_get(),
                o.hide_render,
                o.luzespecular.hidden_for_results,
                o.luzespecular.is_property_set("hidden_for_results"),
            )
            for o in bpy.data.objects
        ),
        "meshes": sorted(
            (
                mesh.name,
                tuple((a.name, a.domain, a.data_type) for a in mesh.attributes),
                mesh.attributes.active and mesh.attributes.active.name,
                mesh.color_attributes.active_color_name,
                mesh.color_attributes.default_color_name,
                tuple(mesh.keys()),
                mesh.is_property_set("luzespecular"),
            )
            for mesh in bpy.data.meshes
        ),
        "collections": sorted(collection.name for collection in bpy.data.collections),
        "results": [(p, getattr(bpy.context.scene.luzespecular.results, p)) for p in ("title", "legend_low")],
        "rows": len(bpy.context.scene.luzespecular.results.rows),
        "shading": [
            (s.type, s.light, s.color_type, s.show_backface_culling)
            for window in bpy.context.window_manager.windows
            for area in window.screen.areas
            if area.type == "VIEW_3D"
            for s in [area.spaces.active.shading]
        ],
    }


def test_open_square_receives_the_sky(addon, bpy, make, solve):
    floor = make.square("Floor")
    make.quick()
    solve()
    assert lux(addon, floor) == pytest.approx(OPEN_SKY, rel=1e-3)
    assert lux(addon, floor, "illuminance_back") == pytest.approx(0.0, abs=1.0)


def test_attributes_have_the_promised_kinds(addon, bpy, make, solve):
    floor = make.square("Floor")
    make.quick()
    solve()
    attributes = floor.data.attributes
    assert (attributes["illuminance"].data_type, attributes["illuminance"].domain) == ("FLOAT", "FACE")
    assert (attributes["luzespecular"].data_type, attributes["luzespecular"].domain) == ("FLOAT_COLOR", "CORNER")
    assert floor.data.color_attributes.active_color_name == "luzespecular"
    assert floor.data.color_attributes.default_color_name == "luzespecular"


def test_own_face_has_the_area_weighted_mean_of_its_parts(addon, bpy, make, solve):
    floor = make.mesh("Floor", [(0, 0, 0), (3, 0, 0), (2, 3, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    make.square("Canopy", size=1.5, height=1.0)
    make.quick(max_area=0.1)
    solve()
    part = fine(addon, bpy)
    rows = bpy.context.scene.luzespecular.results.rows
    row = next(index for index, row in enumerate(rows) if row.name == "Floor" and row.side == "front")
    on_floor = addon.mesh_arrays.read_face_values(part.data, "surface", np.int32) == row
    values, areas = lux(addon, part)[on_floor], addon.mesh_arrays.polygon_areas(part.data)[on_floor]
    assert len(values) > 50
    assert areas.max() > 1.1 * areas.min()
    assert np.ptp(values) > 1_000
    assert lux(addon, floor)[0] == pytest.approx(np.average(values, weights=areas), rel=1e-5)
    assert rows[row].mean == pytest.approx(np.average(values, weights=areas), rel=1e-5)
    assert rows[row].minimum == pytest.approx(values.min())
    assert rows[row].uniformity == pytest.approx(values.min() / rows[row].mean)


def test_results_follow_modifiers_back_to_the_own_faces(addon, bpy, make, solve):
    # Two faces, one under a roof; the modifier turns the order of faces about and cuts them.
    floor = make.mesh(
        "Floor",
        [(0, 0, 0), (1, 0, 0), (9, 0, 0), (10, 0, 0), (0, 1, 0), (1, 1, 0), (9, 1, 0), (10, 1, 0)],
        [(0, 1, 5, 4), (2, 3, 7, 6)],
    )
    mirror = floor.modifiers.new("Subdivide", "SUBSURF")
    mirror.subdivision_type, mirror.levels = "SIMPLE", 2
    make.square("Roof", height=0.1)
    make.quick()
    solve()
    values = lux(addon, floor)
    assert len(values) == 2
    assert values[1] == pytest.approx(OPEN_SKY, rel=0.02)
    assert values[0] < 0.3 * OPEN_SKY


def test_faces_that_were_not_computed_are_nan_and_hatched(addon, bpy, make, solve):
    wall = make.mesh("Wall", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], [(0, 1, 2, 3), (0, 1, 4)])
    make.quick()
    solve()
    values = lux(addon, wall)
    assert values[0] == pytest.approx(OPEN_SKY, rel=1e-3)
    assert math.isnan(values[1])
    colours = addon.mesh_arrays.read_corner_colours(wall.data, "luzespecular")[4:, :3]
    assert np.ptp(colours, axis=1).max() < 1e-6  # grey
    assert np.ptp(colours[:, 0]) > 0.1  # not of one colour, which every computed face is


def test_obstructions_get_no_results(addon, bpy, make, solve):
    floor, house = make.square("Floor"), make.square("House", height=1.0)
    house.luzespecular.role = "OBSTRUCTION"
    make.quick()
    solve()
    assert "illuminance" in floor.data.attributes
    assert "illuminance" not in house.data.attributes
    assert {row.name for row in bpy.context.scene.luzespecular.results.rows} == {"Floor"}
    assert not house.hide_get()
    assert lux(addon, floor)[0] < 0.9 * OPEN_SKY


def test_shared_meshes_are_left_alone_but_seen_on_the_fine_faces(addon, bpy, make, solve):
    first = make.square("Table")
    second = make.object("Table.001", first.data)
    second.location.x = 5.0
    make.quick()
    solve()
    assert "illuminance" not in first.data.attributes
    corners = np.empty(len(fine(addon, bpy).data.vertices) * 3, np.float32)
    fine(addon, bpy).data.vertices.foreach_get("co", corners)
    assert corners.reshape(-1, 3)[:, 0].max() == pytest.approx(6.0)


def test_fine_faces_stand_where_the_objects_stand_whatever_the_unit(addon, bpy, make, solve):
    bpy.context.scene.unit_settings.scale_length = 0.01
    make.square("Floor", size=200.0)
    make.quick()
    solve()
    corners = np.empty(len(fine(addon, bpy).data.vertices) * 3, np.float32)
    fine(addon, bpy).data.vertices.foreach_get("co", corners)
    assert corners.max() == pytest.approx(200.0)
    row = bpy.context.scene.luzespecular.results.rows[0]
    assert row.area == pytest.approx(4.0)


def test_backs_look_backwards_with_their_own_lux(addon, bpy, make, solve):
    make.square("Sheet")
    make.quick()
    solve()
    for side, up, value in (("front", 1.0, OPEN_SKY), ("back", -1.0, 0.0)):
        part = addon.results_object.find(bpy.context.scene, side)
        assert [polygon.normal[2] for polygon in part.data.polygons] == pytest.approx([up, up])
        assert lux(addon, part) == pytest.approx(value, rel=1e-3, abs=1.0)
    assert {(row.name, row.side) for row in bpy.context.scene.luzespecular.results.rows} == {
        ("Sheet", "front"),
        ("Sheet", "back"),
    }


def test_components_add_up_on_the_fine_faces(addon, bpy, make, solve):
    make.square("Floor", size=2.0)
    make.square("Canopy", height=0.5)
    make.quick()
    solve()
    part = fine(addon, bpy)
    names = ("sky_direct", "sky_specular", "sun_direct", "sun_specular", "emitted", "interreflected")
    total = sum(lux(addon, part, f"illuminance_{name}") for name in names)
    np.testing.assert_allclose(total, lux(addon, part), rtol=1e-5, atol=1e-3)


def test_table_knows_every_quantity(addon, bpy, make, solve, tmp_path):
    make.square("Floor", size=2.0)
    make.square("Canopy", height=0.5)
    settings = make.quick()
    solve()
    part, spread = fine(addon, bpy), addon.results_table.spread
    for number, row in enumerate(settings.results.rows):
        side = addon.results_object.find(bpy.context.scene, row.side)
        chosen = addon.mesh_arrays.read_face_values(side.data, addon.results_object.SURFACE, np.int32) == number
        for quantity in addon.luz.tables.QUANTITIES:
            values = lux(addon, side, addon.writeback.attribute_of(quantity))[chosen]
            found = spread(row, quantity)
            assert (found.minimum, found.maximum) == pytest.approx((values.min(), values.max())), quantity
            assert found.minimum <= found.mean * 1.000001 and found.mean <= found.maximum * 1.000001
        assert (row.minimum, row.mean, row.maximum) == spread(row, "illuminance")
        assert math.isnan(spread(row, "error").mean)  # nobody has asked for it
    assert part is not None
    settings.display.quantity = "error"
    known = {row.side: spread(row, "error").mean for row in settings.results.rows}
    assert known["front"] > 0.0 and math.isnan(known["back"])
    bpy.ops.luzespecular.save_table(filepath=str(tmp_path / "table.csv"))
    with (tmp_path / "table.csv").open(encoding="utf-8-sig", newline="") as file:
        saved = list(csv.DictReader(file))
    for line, row in zip(saved, settings.results.rows, strict=True):
        assert float(line["mean_lx"]) == pytest.approx(row.mean, rel=1e-5)
        assert float(line["sky_direct_mean_lx"]) == pytest.approx(spread(row, "sky_direct").mean, rel=1e-5)


def test_results_are_shown_at_once(addon, bpy, make, solve):
    floor = make.square("Floor")
    make.quick()
    solve()
    part = fine(addon, bpy)
    assert not part.hide_get()
    assert floor.hide_get()
    assert part.data.color_attributes.active_color_name == "luzespecular"
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                shading = area.spaces.active.shading
                assert (shading.type, shading.light, shading.color_type) == ("SOLID", "FLAT", "VERTEX")


def test_view_can_be_switched_to_the_own_meshes_and_back(addon, bpy, make, solve):
    floor, hidden = make.square("Floor"), make.square("Hidden by the user", height=4.0)
    hidden.hide_set(True)
    make.quick()
    solve()
    settings = bpy.context.scene.luzespecular.display
    settings.view = "OWN"
    assert not floor.hide_get()
    assert hidden.hide_get()
    assert fine(addon, bpy).hide_get()
    settings.view = "RESULTS"
    assert floor.hide_get()
    assert not fine(addon, bpy).hide_get()
    backs = addon.results_object.find(bpy.context.scene, "back")
    assert not backs.hide_get()
    settings.show_backs = False
    assert backs.hide_get()
    assert not fine(addon, bpy).hide_get()


def test_colours_follow_the_display_settings(addon, bpy, make, solve):
    make.square("Floor")
    make.quick()
    solve()
    settings = bpy.context.scene.luzespecular.display
    settings.use_fixed_range, settings.scaling = True, "LINEAR"
    settings.low, settings.high, settings.scale = 0.0, 2 * OPEN_SKY, "GREY"
    part = fine(addon, bpy)
    colours = addon.mesh_arrays.read_corner_colours(part.data, "luzespecular")
    upper = np.repeat(lux(addon, part), 3) > 1.0
    middle = (0x10 + 0xF4) / 2 / 255
    assert colours[upper, 0] == pytest.approx(float(addon.colours.srgb_to_linear(middle)), rel=2e-3)
    settings.quantity = "interreflected"
    colours = addon.mesh_arrays.read_corner_colours(part.data, "luzespecular")
    assert colours[:, 0] == pytest.approx(float(addon.colours.srgb_to_linear(0x10 / 255)), rel=1e-3)
    assert addon.legend.title(bpy.context.scene) == "Illuminance: Interreflected [lx]"


def test_solving_again_replaces_the_results(addon, bpy, make, solve):
    floor = make.square("Floor")
    settings = make.quick()
    solve()
    settings.sky.horizontal_illuminance = 20_000.0
    solve()
    assert lux(addon, floor) == pytest.approx(20_000.0, rel=1e-3)
    assert sorted(o.name for o in bpy.data.objects if o.luzespecular.is_results) == [
        "LuzEspecular results",
        "LuzEspecular results (backs)",
    ]
    assert sum(mesh.name.startswith("LuzEspecular") for mesh in bpy.data.meshes) == 2


def test_another_sky_does_not_prepare_again(addon, bpy, make, solve, monkeypatch):
    floor = make.square("Floor")
    settings = make.quick()
    prepared = []
    prepare = addon.luz.prepare
    monkeypatch.setattr(addon.luz, "prepare", lambda *args, **options: prepared.append(1) or prepare(*args, **options))
    solve()
    settings.sky.horizontal_illuminance = 5_000.0
    solve()
    assert len(prepared) == 1
    floor.location.z = 1.0
    solve()
    assert len(prepared) == 2
    settings.accuracy.bands = 14
    solve()
    assert len(prepared) == 3


def test_clear_leaves_no_trace(addon, bpy, make, solve):
    floor = make.square("Floor")
    floor.modifiers.new("Solid", "SOLIDIFY")
    painted = make.square("Painted", height=1.0)
    painted.data.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    painted.data.color_attributes.new("Other", "BYTE_COLOR", "CORNER")
    painted.data.color_attributes.active_color_name = "Paint"
    painted.data.color_attributes.default_color_name = "Other"
    make.square("Hidden", height=2.0).hide_set(True)
    make.quick()
    before = everything(bpy)
    solve()
    bpy.context.scene.luzespecular.display.view = "OWN"
    bpy.context.scene.luzespecular.display.view = "RESULTS"
    solve()
    assert everything(bpy) != before
    assert bpy.ops.luzespecular.clear_results() == {"FINISHED"}
    assert everything(bpy) == before


def test_clear_restores_the_viewport(addon, bpy, make, solve, shading):
    shading.light, shading.color_type, shading.type = "MATCAP", "RANDOM", "MATERIAL"
    make.square("Floor")
    make.quick()
    solve()
    assert shading.type == "SOLID"
    bpy.ops.luzespecular.clear_results()
    assert shading.type == "MATERIAL"
    shading.type = "SOLID"
    assert (shading.light, shading.color_type) == ("MATCAP", "RANDOM")


def test_viewports_follow_undo_and_redo(addon, bpy, make, solve, shading):
    scene = bpy.context.scene
    shading.light, shading.color_type = "MATCAP", "RANDOM"
    floor = make.square("Floor")
    make.quick()
    solve()
    shading.type = "MATERIAL"  # as the user likes it
    addon.display.settle_viewports(scene)  # some other step undone
    assert shading.type == "MATERIAL"
    kept = addon.session.current.result_of(scene.name, scene.luzespecular.results.run)
    addon.results_object.remove(scene)  # the run undone: undo takes all but the viewport's shading back
    addon.writeback.clear(floor.data)
    addon.display.settle_viewports(scene)
    assert (shading.type, shading.light, shading.color_type) == ("SOLID", "MATCAP", "RANDOM")
    addon.display.write(scene, *kept)  # and redone
    addon.display.settle_viewports(scene)
    assert (shading.type, shading.light, shading.color_type) == ("SOLID", "FLAT", "VERTEX")


def test_cancelling_leaves_nothing(addon, bpy, make, monkeypatch):
    make.square("Floor")
    make.quick()
    before = everything(bpy)

    def cancel(self, fraction, stage):
        return False

    monkeypatch.setattr(addon.job.Job, "_tell", cancel)
    assert bpy.ops.luzespecular.solve() == {"CANCELLED"}
    assert everything(bpy) == before


def test_cancelling_keeps_the_results_of_before(addon, bpy, make, solve, monkeypatch):
    floor = make.square("Floor")
    settings = make.quick()
    solve()
    before, values = everything(bpy), lux(addon, floor)
    settings.sky.horizontal_illuminance = 1.0
    settings.accuracy.bands = 20
    monkeypatch.setattr(addon.job.Job, "_tell", lambda *_: False)
    assert bpy.ops.luzespecular.solve() == {"CANCELLED"}
    assert everything(bpy) == before
    np.testing.assert_array_equal(lux(addon, floor), values)


def test_what_the_solver_finds_odd_is_told(addon, bpy, make, solve):
    make.square("Floor")
    make.square("Carpet", size=0.5)
    make.quick()
    solve()
    (notice,) = [n for n in bpy.context.scene.luzespecular.results.notices if n.level == "WARNING"]
    assert "'Carpet' and 'Floor' lie on one another" in notice.text or "'Floor' and 'Carpet' lie" in notice.text


@pytest.mark.parametrize(
    ("refusal", "told"),
    [
        ("SceneError", "A largest face of 1e-09 m² would cut"),
        ("MemoryError", "There is not enough memory: choose a coarser"),
    ],
)
def test_what_the_solver_cannot_do_is_told_and_changes_nothing(addon, bpy, make, monkeypatch, refusal, told):
    def no_memory(*_):
        raise MemoryError

    make.square("Floor", size=4.0)
    make.quick(max_area=1e-9)
    if refusal == "MemoryError":
        monkeypatch.setattr(addon.study.Study, "run", no_memory)
    before = everything(bpy)
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.luzespecular.solve()
    assert everything(bpy) == before


def test_a_job_in_its_thread_stops_when_asked(addon, bpy, make):
    make.square("Floor", size=4.0)
    make.quick(max_area=0.01, bands=40)
    job = addon.job.Job(addon.study.collect(bpy.context), addon.session.Session())
    job.cancel()
    job.start()
    job.wait()
    assert job.result is None
    assert isinstance(job.error, addon.luz.Cancelled)


def test_progress_rises_from_nothing_to_all(addon, bpy, make):
    make.square("Floor", size=2.0)
    make.square("Canopy", height=1.0)
    make.quick()
    told = []
    addon.study.collect(bpy.context).run(
        addon.session.Session(), lambda fraction, stage: told.append((fraction, stage)) or True
    )
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert fractions[0] < 0.05
    assert fractions[-1] == pytest.approx(1.0)
    assert {stage for _, stage in told} <= set(addon.translations.STAGES)


def test_results_are_thrown_away_when_the_scene_changed_meanwhile(addon, bpy, make):
    floor = make.square("Floor")
    make.quick()
    study = addon.study.collect(bpy.context)
    result = study.run(addon.session.Session(), lambda *_: True)
    floor.location.z += 1.0
    before = everything(bpy)
    with pytest.raises(addon.notices.BadInput, match="changed"):
        addon.study.finish(bpy.context, study, result)
    assert everything(bpy) == before


@pytest.mark.parametrize("name", ["illuminance", "luzespecular"])
def test_attributes_of_the_users_own_are_not_overwritten(addon, bpy, make, name):
    floor = make.square("Floor")
    floor.data.attributes.new(name, "FLOAT", "FACE").data[0].value = 7.0
    make.quick()
    with pytest.raises(RuntimeError, match=f"'Floor' has an attribute '{name}'"):
        bpy.ops.luzespecular.solve()
    assert floor.data.attributes[name].data[0].value == 7.0


def test_bad_input_leaves_the_scene_as_it_was(addon, bpy, make):
    make.square("Floor").modifiers.new("Solid", "SOLIDIFY")
    make.square("Broken", height=1.0).data.vertices[0].co.x = math.nan
    make.quick()
    before = everything(bpy)
    with pytest.raises(RuntimeError, match="Broken"):
        bpy.ops.luzespecular.solve()
    assert everything(bpy) == before


def test_no_light_at_all_is_refused(addon, bpy, make):
    make.square("Floor")
    settings = make.quick()
    settings.sky.kind, settings.sky.use_sun = "NONE", True
    settings.site.hour = 0.0
    with pytest.raises(RuntimeError, match="There is no light"):
        bpy.ops.luzespecular.solve()


def test_luminous_surfaces_need_no_sky(addon, bpy, make, solve):
    lamp = make.square("Lamp", material=make.material("Lamp", diffuse_reflectance=0.0, exitance=1_000.0))
    lamp.luzespecular.sides = "FRONT"
    floor = make.square("Floor", material=make.material("Black", diffuse_reflectance=0.0))
    lamp.rotation_euler.x = math.pi
    lamp.location = (0.0, 1.0, 2.0)
    settings = make.quick()
    settings.sky.kind, settings.site.hour = "NONE", 0.0
    solve()
    # Two parallel unit squares 2 m apart see each other by a form factor of 0.0686 (Howell, C-11).
    assert lux(addon, floor)[0] == pytest.approx(68.6, rel=0.1)


def test_run_of_another_is_refused_while_one_is_running(addon, bpy, make):
    make.square("Floor")
    bpy.context.window_manager.luzespecular.running = True
    try:
        assert not bpy.ops.luzespecular.solve.poll()
    finally:
        bpy.context.window_manager.luzespecular.running = False
    assert not bpy.ops.luzespecular.cancel.poll()
    assert not bpy.ops.luzespecular.clear_results.poll()


def test_results_survive_saving_and_loading(addon, bpy, make, solve, tmp_path):
    floor = make.square("Floor")
    make.quick()
    solve()
    path = tmp_path / "Área de Trabalho" / "casa à luz.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    before = lux(addon, floor)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    np.testing.assert_array_equal(lux(addon, bpy.data.objects["Floor"]), before)
    assert bpy.context.scene.luzespecular.results.rows[0].name == "Floor"
    bpy.ops.luzespecular.clear_results()
    assert not bpy.data.objects["Floor"].hide_get()
    assert "illuminance" not in bpy.data.objects["Floor"].data.attributes


def test_errors_of_meshes_edited_meanwhile_are_not_written(addon, bpy, make, solve):
    floor, slab = make.square("Floor"), make.square("Slab", height=1.0)
    settings = make.quick()
    solve()
    floor.data.clear_geometry()
    floor.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)] * 3)
    settings.display.quantity = "error"
    assert "illuminance_error" not in floor.data.attributes
    assert "illuminance_error" in slab.data.attributes
    slab.name = "Laje"
    settings.display.quantity = "illuminance"
    solve()
    settings.display.quantity = "error"
    assert np.isfinite(lux(addon, slab, "illuminance_error")).all()


def test_objects_show_again_where_the_fine_faces_are_deleted(addon, bpy, make, solve):
    floor = make.square("Floor")
    make.quick()
    solve()
    assert floor.hide_get()
    with bpy.context.temp_override(selected_objects=addon.results_object.all_of(bpy.context.scene)):
        bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert not addon.results_object.all_of(bpy.context.scene)
    assert not floor.hide_get()
    bpy.ops.luzespecular.clear_results()
    assert "illuminance" not in floor.data.attributes


def test_renamed_objects_stay_hidden_behind_their_fine_faces(addon, bpy, make, solve):
    floor = make.square("Floor")
    settings = make.quick()
    solve()
    floor.name = "Piso"
    settings.display.view = "OWN"
    assert not floor.hide_get()
    settings.display.view = "RESULTS"
    assert floor.hide_get()


def test_scenes_that_share_objects_clear_for_both(addon, bpy, make, solve):
    floor = make.square("Floor")
    make.quick()
    solve()
    first = bpy.context.scene
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.scene.new(type="LINK_COPY")
    second = next(scene for scene in bpy.data.scenes if scene != first)
    with bpy.context.temp_override(scene=second, view_layer=second.view_layers[0]):
        bpy.ops.luzespecular.clear_results()
    assert not floor.hide_get(view_layer=first.view_layers[0])
    assert not floor.hide_get(view_layer=second.view_layers[0])


def test_scenes_of_one_file_do_not_meddle(addon, bpy, make, solve):
    first = make.square("Floor")
    make.quick()
    solve()
    other = bpy.data.scenes.new("Other")
    bpy.context.window_manager.windows[0].scene = other
    second = make.square("Floor of the other")
    make.quick()
    solve()
    assert len([object_ for object_ in bpy.data.objects if object_.luzespecular.is_results]) == 4
    bpy.ops.luzespecular.clear_results()
    assert "illuminance" not in second.data.attributes
    assert "illuminance" in first.data.attributes
