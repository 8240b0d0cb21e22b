"""Ways to look at results: units, shading, errors, iso-lux lines, renders; and that nothing of them stays behind."""

import math

import numpy as np
import pytest

OPEN_SKY = 10_000.0


def fine(addon, bpy):
    return addon.results_object.find(bpy.context.scene)


def values(addon, object_, name="illuminance"):
    return addon.mesh_arrays.read_face_values(object_.data, name, np.float32)


def shown(addon, object_):
    return addon.mesh_arrays.read_corner_floats(object_.data, "luzespecular_value")


def data_blocks(bpy):
    return {
        kind: sorted(block.name for block in getattr(bpy.data, kind))
        for kind in ("objects", "meshes", "curves", "fonts", "materials", "node_groups", "collections")
    }


# --- units -----------------------------------------------------------------------------------------------------------


def test_daylight_factor_is_the_share_of_the_open_sky(addon, bpy, solved):
    solved.display.unit = "FACTOR"
    part = fine(addon, bpy)
    np.testing.assert_allclose(
        shown(addon, part), np.repeat(values(addon, part) / OPEN_SKY * 100.0, 3), rtol=1e-5, atol=1e-5
    )
    assert solved.results.legend_high == pytest.approx(100.0)
    assert addon.legend.title(bpy.context.scene) == "Daylight factor: Total [%]"
    solved.display.use_fixed_range, solved.display.low_percent, solved.display.high_percent = True, 0.5, 20.0
    assert (solved.results.legend_low, solved.results.legend_high) == pytest.approx((0.5, 20.0))
    solved.display.unit = "LUX"
    assert solved.results.legend_high == pytest.approx(solved.display.high)


def test_with_the_sun_it_is_no_daylight_factor(addon, bpy, make, solved):
    solved.sky.use_sun, solved.site.hour = True, 12.0
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    solved.display.unit = "FACTOR"
    assert addon.legend.title(bpy.context.scene) == "Share of open sky: Total [%]"


def test_without_a_sky_there_is_no_factor(addon, bpy, make):
    make.square("Lamp", material=make.material("Lamp", diffuse_reflectance=0.0, exitance=1_000.0))
    settings = make.quick()
    settings.sky.kind = "NONE"
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    settings.display.unit = "FACTOR"
    assert (shown(addon, fine(addon, bpy)) == -1.0).all()  # not computed, not 0


# --- shading ---------------------------------------------------------------------------------------------------------


def test_smooth_colours_meet_at_the_corners(addon, bpy, solved):
    part = fine(addon, bpy)
    flat = shown(addon, part).reshape(-1, 3)
    assert np.ptp(flat, axis=1).max() == 0.0
    solved.display.shading = "SMOOTH"
    smooth = shown(addon, part)
    assert np.ptp(smooth.reshape(-1, 3), axis=1).max() > 100.0
    places = addon.mesh_arrays.vertex_positions(part.data)
    surface = np.repeat(values(addon, part, "surface"), 3)
    middle = np.flatnonzero((np.abs(places - [1.5, 1.5, 0.0]).max(axis=1) < 0.3) & (surface == surface[0]))
    for corner in middle:
        same = (np.abs(places - places[corner]).max(axis=1) < 1e-4) & (surface == surface[corner])
        assert np.ptp(smooth[same]) < 1e-2
    solved.display.shading = "FACES"
    np.testing.assert_array_equal(shown(addon, part).reshape(-1, 3), flat)


def test_smooth_works_on_own_meshes_too(addon, bpy, solved):
    solved.display.view, solved.display.shading = "OWN", "SMOOTH"
    floor = bpy.data.objects["Floor"]
    np.testing.assert_allclose(shown(addon, floor), values(addon, floor)[0], rtol=1e-5)


# --- quantities ------------------------------------------------------------------------------------------------------


def test_all_quantities_can_be_seen_on_own_meshes(addon, bpy, solved):
    solved.display.view = "OWN"
    floor, scene = bpy.data.objects["Floor"], bpy.context.scene
    for quantity, _, _ in addon.choices.QUANTITY_ITEMS:
        solved.display.quantity = quantity
        own = values(addon, floor, addon.writeback.attribute_of(quantity))
        np.testing.assert_allclose(shown(addon, floor), np.maximum(np.repeat(own, 4), 1e-6), rtol=1e-5)
        assert addon.legend.title(scene).endswith("[lx]")
    initial, interreflected = (values(addon, floor, f"illuminance_{name}") for name in ("initial", "interreflected"))
    assert initial + interreflected == pytest.approx(values(addon, floor), rel=1e-5)


def test_errors_are_estimated_when_asked_for(addon, bpy, solved):
    part = fine(addon, bpy)
    assert "illuminance_error" not in part.data.attributes
    solved.display.quantity = "error"
    result = addon.display.kept_result(bpy.context.scene)[1]
    front = values(addon, part, "illuminance_error")
    assert np.isin(front, result.error.astype(np.float32)).all()
    assert 0.0 < front.max() < 1_000.0
    assert (shown(addon, addon.results_object.find(bpy.context.scene, "back")) == -1.0).all()  # errors of fronts only
    own = values(addon, bpy.data.objects["Floor"], "illuminance_error")
    assert front.min() <= own[0] <= front.max()


def test_errors_of_another_run_are_not_mixed_in(addon, bpy, solved):
    scene = bpy.context.scene
    assert addon.display.kept_result(scene) is not None
    solved.results.run -= 1  # as after an undo
    solved.display.quantity = "error"
    assert "illuminance_error" not in fine(addon, bpy).data.attributes
    assert (shown(addon, fine(addon, bpy)) == -1.0).all()


# --- fine faces if asked ---------------------------------------------------------------------------------------------


def test_fine_faces_are_there_only_when_asked_for(addon, bpy, make):
    floor = make.square("Floor")
    settings = make.quick()
    settings.display.view = "OWN"
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert addon.results_object.all_of(bpy.context.scene) == []
    assert not floor.hide_get()
    settings.display.view = "RESULTS"
    assert len(addon.results_object.all_of(bpy.context.scene)) == 2
    assert floor.hide_get()
    assert values(addon, fine(addon, bpy)) == pytest.approx(OPEN_SKY, rel=1e-3)


def test_fine_faces_that_are_no_longer_known_are_missed_but_nothing_breaks(addon, bpy, make):
    floor = make.square("Floor")
    settings = make.quick()
    settings.display.view = "OWN"
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    addon.session.current.forget()
    settings.display.view = "RESULTS"
    assert addon.results_object.all_of(bpy.context.scene) == []
    assert not floor.hide_get()
    settings.display.quantity = "error"
    assert (shown(addon, floor) == -1.0).all()


def test_another_hour_keeps_the_fine_faces(addon, bpy, solved):
    part = fine(addon, bpy)
    pointer, before = part.as_pointer(), values(addon, part)
    solved.sky.horizontal_illuminance = 2 * OPEN_SKY
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert fine(addon, bpy).as_pointer() == pointer
    np.testing.assert_allclose(values(addon, fine(addon, bpy)), 2 * before, rtol=1e-4, atol=0.5)


def test_nothing_else_of_the_mesh_changes(addon, bpy, make):
    floor = make.square("Floor", size=2.0)
    mesh = floor.data
    mesh.uv_layers.new(name="Map")
    mesh.materials.append(make.material("Paint"))
    mesh.polygons[0].use_smooth = True
    floor.vertex_groups.new(name="Group").add([0, 1], 0.5, "REPLACE")
    floor["mark"] = 7

    def state():
        return (
            [tuple(vertex.co) for vertex in mesh.vertices],
            [tuple(edge.vertices) for edge in mesh.edges],
            [(tuple(p.vertices), p.material_index, p.use_smooth) for p in mesh.polygons],
            [tuple(loop.uv) for loop in mesh.uv_layers["Map"].data],
            [material.name for material in mesh.materials],
            [[(g.group, g.weight) for g in vertex.groups] for vertex in mesh.vertices],
            dict(floor.items()).get("mark"),
            sorted(a.name for a in mesh.attributes if a.name not in addon.writeback.ATTRIBUTES),
            floor.matrix_world.copy(),
            [modifier.name for modifier in floor.modifiers],
        )

    make.quick()
    before = state()
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert state() == before


# --- iso-lux lines ---------------------------------------------------------------------------------------------------


def test_lines_lie_where_the_surfaces_have_their_values(addon, bpy, solved):
    solved.display.line_levels, solved.display.show_lines = "3000 6000", True
    lines = addon.contours.find(bpy.context.scene)
    assert set(addon.mesh_arrays.read_edge_floats(lines.data, "illuminance").tolist()) <= {3000.0, 6000.0}
    places = addon.mesh_arrays.vertex_positions(lines.data)
    assert len(places) > 20
    normals = addon.mesh_arrays.read_edge_vectors(lines.data, "normal")
    lit_floor = (places[::2, 2] > 0.0) & (places[::2, 2] < 0.05)  # lines stand off the side that is lit
    assert lit_floor.sum() > 10
    np.testing.assert_allclose(np.abs(normals[lit_floor] - [0.0, 0.0, 1.0]).max(), 0.0, atol=1e-5)
    on_floor = places[np.abs(places[:, 2]) < 0.05]
    assert len(on_floor) > 10
    assert on_floor.min() > -0.05
    assert on_floor[:, :2].max() < 2.05
    solved.display.line_levels = "1e6"
    assert len(lines.data.edges) == 0
    solved.display.show_lines = False
    assert addon.contours.find(bpy.context.scene) is None
    assert not [mesh for mesh in bpy.data.meshes if "iso-lux" in mesh.name]


def test_lines_follow_the_legend_without_levels_of_their_own(addon, bpy, solved):
    scene = bpy.context.scene
    scale = addon.display.current_scale(scene)
    for text in ("", "nonsense"):
        solved.display.line_levels = text
        assert addon.contours.levels(scene, scale) == [tick for tick in scale.ticks() if tick > 0]


def test_lines_take_no_part_in_the_next_run(addon, bpy, solved):
    solved.display.show_lines = True
    assert {surface.object_name for surface in addon.export.export_scene(bpy.context).surfaces} == {"Floor", "Canopy"}


# --- renders ---------------------------------------------------------------------------------------------------------


def render_state(scene):
    view = scene.view_settings
    return (
        [layer.material_override and layer.material_override.name for layer in scene.view_layers],
        (view.view_transform, view.look, round(view.exposure, 5), round(view.gamma, 5)),
        {object_.name: (object_.hide_render, object_.visible_camera) for object_ in scene.objects},
    )


def test_renders_are_set_up_and_put_back(addon, bpy, make, solved):
    scene = bpy.context.scene
    scene.view_settings.exposure = 0.5
    scene.view_layers[0].material_override = make.material("Clay")
    before, blocks = render_state(scene), data_blocks(bpy)
    solved.display.in_renders = True
    assert scene.view_layers[0].material_override.name == addon.false_colour.NAME
    assert scene.view_settings.view_transform == "Standard"
    assert not fine(addon, bpy).hide_render
    assert not bpy.data.objects["Floor"].visible_camera
    solved.display.view = "OWN"
    assert fine(addon, bpy).hide_render
    assert bpy.data.objects["Floor"].visible_camera
    solved.display.view = "RESULTS"
    solved.display.in_renders = False
    assert render_state(scene) == before
    assert data_blocks(bpy) == blocks


def test_engines_that_override_no_material_have_the_colours_too(addon, bpy, make, solved):
    """EEVEE before Blender 5.0; what it renders is seen in windows, since it needs a graphics driver."""
    scene = bpy.context.scene
    scene.camera = make.object("Camera", bpy.data.cameras.new("Camera"))
    assert bpy.ops.luzespecular.add_work_plane() == {"FINISHED"}
    bare, painted = bpy.context.object, make.square("My grid", material=make.material("Mine"))
    painted.luzespecular.plane.enabled = True
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    solved.display.in_renders = True
    material = scene.luzespecular.results.false_colour
    for object_ in (fine(addon, bpy), bare, addon.render_legend.find(scene)):
        assert list(object_.data.materials) == [material], object_.name
    solved.display.scale = "GREY"  # a new legend
    assert list(addon.render_legend.find(scene).data.materials) == [material]
    assert [m.name for m in painted.data.materials] == ["Mine"]
    assert not bpy.data.objects["Floor"].data.materials
    solved.display.in_renders = False
    assert not fine(addon, bpy).data.materials and not bare.data.materials
    assert [m.name for m in painted.data.materials] == ["Mine"]


def test_the_node_group_has_the_colours_of_the_legend(addon, bpy, solved):
    solved.display.in_renders = True
    solved.display.scale, solved.display.scaling = "CIVIDIS", "LINEAR"
    solved.display.use_fixed_range, solved.display.low, solved.display.high = True, 100.0, 5_000.0
    nodes = bpy.data.node_groups[addon.false_colour.NAME].nodes
    assert [nodes[name].outputs[0].default_value for name in ("Logarithmic", "Low", "High")] == [0.0, 100.0, 5_000.0]
    solved.display.scaling = "LOG"
    assert nodes["Logarithmic"].outputs[0].default_value == 1.0
    assert nodes["High"].outputs[0].default_value == pytest.approx(math.log(5_000.0))
    for position in (0.0, 0.3, 0.5, 1.0):
        expected = addon.colours.srgb_to_linear(addon.colours.scale_colours("CIVIDIS", position))
        np.testing.assert_allclose(nodes["Scale"].color_ramp.evaluate(position)[:3], expected, atol=5e-3)


def test_cycles_renders_the_colours_of_the_viewport(addon, bpy, make, solved, tmp_path):
    scene = bpy.context.scene
    make.look_down(16, 16)
    solved.display.legend_in_renders, solved.display.in_renders = False, True
    pixels = make.rendered(tmp_path)
    # The far quarter of the floor is under the open sky, and so are its colours.
    part = fine(addon, bpy)
    scale = addon.display.current_scale(scene)
    centres = addon.mesh_arrays.polygon_centres(part.data)
    for x, y in ((1.94, 1.94), (1.69, 0.31), (0.31, 1.69)):
        distance = np.linalg.norm(centres - [x, y, 0.0], axis=1)
        near = values(addon, part)[distance < 0.3]
        expected = scale.srgb([near.min(), near.max()])
        pixel = pixels[int(y * 8), int(x * 8)]
        assert (pixel > expected.min(axis=0) - 0.03).all()
        assert (pixel < expected.max(axis=0) + 0.03).all()


# --- no trace --------------------------------------------------------------------------------------------------------


def test_clear_takes_all_ways_of_seeing_away(addon, bpy, make):
    scene = bpy.context.scene
    floor = make.square("Floor", size=2.0)
    make.square("Canopy", height=0.5)
    settings = make.quick(max_area=0.1)
    assert bpy.ops.luzespecular.add_work_plane() == {"FINISHED"}
    scene.camera = make.object("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.data.dof.use_dof = True
    before = data_blocks(bpy), render_state(scene), sorted(a.name for a in floor.data.attributes)
    plane_before = sorted(a.name for a in bpy.context.object.data.attributes)
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    display = settings.display
    display.show_lines = display.in_renders = True
    display.quantity, display.shading, display.unit = "error", "SMOOTH", "FACTOR"
    display.quantity = "illuminance"
    origin = addon.probe.Vector((1.5, 1.5, 3.0))
    hit = addon.probe.pick(addon.probe.targets(bpy.context), origin, addon.probe.Vector((0, 0, -1)), True)
    addon.probe.pin(scene, hit)
    assert addon.render_legend.find(scene) is not None
    assert not scene.camera.data.dof.use_dof
    assert bpy.ops.luzespecular.clear_results() == {"FINISHED"}
    assert scene.camera.data.dof.use_dof
    assert (data_blocks(bpy), render_state(scene), sorted(a.name for a in floor.data.attributes)) == before
    plane = addon.work_planes.all_of(scene)[0]
    assert sorted(a.name for a in plane.data.attributes) == plane_before
    assert plane.luzespecular.plane.state == ""
    assert not scene.luzespecular.is_property_set("results")
    assert addon.display.kept_result(scene) is None
    assert not addon.display.has_results(scene)
