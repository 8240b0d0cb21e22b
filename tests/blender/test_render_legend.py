"""The legend in renders: its colours and words, where it stands in the picture, and that it has no part in anything."""

import numpy as np
import pytest


def in_picture(bpy, legend):
    """Left, bottom, right and top of the legend in the picture, each 0 to 1, and its nearest distance."""
    from bpy_extras.object_utils import world_to_camera_view

    scene, depsgraph = bpy.context.scene, bpy.context.evaluated_depsgraph_get()
    world, camera = legend.evaluated_get(depsgraph).matrix_world, scene.camera.evaluated_get(depsgraph)
    seen = [world_to_camera_view(scene, camera, world @ vertex.co) for vertex in legend.data.vertices]
    places = np.array(seen)
    return (*places[:, :2].min(axis=0), *places[:, :2].max(axis=0), places[:, 2].min())


def test_the_legend_is_rendered_in_its_own_colours(addon, bpy, make, solved, tmp_path):
    make.look_down(240, 180)
    solved.display.scale, solved.display.in_renders = "CIVIDIS", True
    left, bottom, right, top, _ = in_picture(bpy, addon.render_legend.find(bpy.context.scene))
    pixels = make.rendered(tmp_path)
    part = pixels[round(bottom * 180) : round(top * 180), round(left * 240) : round(right * 240)]
    colours = addon.colours
    for position in (0.02, 0.25, 0.5, 0.75, 0.98):
        assert (np.abs(part - colours.scale_colours("CIVIDIS", position)).max(axis=2) < 0.02).sum() >= 3, position
    assert (np.abs(part - addon.render_legend._PAPER).max(axis=2) < 0.02).mean() > 0.4
    assert (part.min(axis=2) > 0.9).sum() > 20  # letters
    solved.display.legend_in_renders = False
    without = make.rendered(tmp_path)
    changed = np.abs(without - pixels).max(axis=2) > 0.02
    rows, columns = np.nonzero(changed)
    assert changed.any() and rows.max() < top * 180 + 1 and columns.max() < right * 240 + 1


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
@pytest.mark.parametrize("corner", ["BOTTOM_LEFT", "TOP_RIGHT"])
def test_the_legend_stands_in_its_corner_of_the_picture(addon, bpy, make, solved, kind, corner):
    scene, settings = bpy.context.scene, solved.display
    make.look_down(400, 200)
    camera = scene.camera
    settings.legend_corner, settings.legend_size, settings.in_renders = corner, 50.0, True
    legend = addon.render_legend.find(scene)
    camera.data.type, camera.data.lens, camera.data.shift_x, camera.data.clip_start = kind, 24.0, 0.2, 0.3
    camera.location, camera.rotation_euler, camera.scale = (3.0, -2.0, 7.0), (0.4, 0.1, 0.7), (2.0, 2.0, 2.0)
    scene.render.resolution_x = 500
    for lens in (24.0, 80.0):
        camera.data.lens = lens
        bpy.context.view_layer.update()
        bpy.context.view_layer.update()  # the legend moved after the camera
        left, bottom, right, top, nearest = in_picture(bpy, legend)
        assert top - bottom == pytest.approx(0.5, rel=5e-3)
        assert nearest == pytest.approx(0.3 * 1.01, rel=0.02)
        if corner == "BOTTOM_LEFT":
            assert (left, bottom) == pytest.approx((0.02 * 200 / 500, 0.02), abs=2e-3)
        else:
            assert (right, top) == pytest.approx((1.0 - 0.02 * 200 / 500, 0.98), abs=2e-3)


def test_the_legend_fits_narrow_pictures(addon, bpy, make, solved):
    make.look_down(100, 800)
    solved.display.in_renders = True
    left, _, right, _, _ = in_picture(bpy, addon.render_legend.find(bpy.context.scene))
    assert right - left == pytest.approx(0.9, abs=1e-3)


def test_the_legend_follows_what_is_shown(addon, bpy, make, solved):
    scene, settings = bpy.context.scene, solved.display
    make.look_down(100, 100)
    settings.in_renders = True
    legend = addon.render_legend.find(scene)
    states = [legend.luzespecular.state]

    def expect(*words):
        state = legend.luzespecular.state
        assert state not in states and all(word in state for word in words), state
        states.append(state)
        said = addon.render_legend.Words.of(scene, addon.display.current_scale(scene))
        assert state == f"({settings.scale!r}, {said!r})" == said.state(settings.scale)
        corners = addon.mesh_arrays.read_corner_colours(legend.data, "luzespecular")
        top = addon.colours.srgb_to_linear(addon.colours.scale_colours(settings.scale, 1.0))
        assert (np.abs(corners[:, :3] - top).max(axis=1) < 1e-4).any()

    assert "Total [lx]" in states[0]
    settings.scale = "SPECTRUM"
    expect("SPECTRUM")
    settings.quantity = "interreflected"
    expect("Interreflected [lx]")
    settings.unit = "FACTOR"
    expect("Daylight factor", "[%]")
    settings.use_fixed_range, settings.low_percent, settings.high_percent = True, 1.0, 50.0
    expect("'50'")
    solved.site.hour = 9.0
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    expect("09:00")
    assert len([mesh for mesh in bpy.data.meshes if addon.render_legend.NAME in mesh.name]) == 1


def test_the_legend_goes_with_keyframes_of_the_lens(addon, bpy, make, solved):
    scene = bpy.context.scene
    make.look_down(100, 100)
    camera = scene.camera.data
    camera.type = "PERSP"
    for frame, lens in ((1, 20.0), (10, 100.0)):
        camera.lens = lens
        camera.keyframe_insert("lens", frame=frame)
    solved.display.in_renders = True
    for frame in (1, 5, 10):
        scene.frame_set(frame)
        _, bottom, _, top, _ = in_picture(bpy, addon.render_legend.find(scene))
        assert top - bottom == pytest.approx(0.45, rel=5e-3), frame


def test_the_legend_waits_for_a_camera_that_it_can_stand_before(addon, bpy, make, solved):
    scene = bpy.context.scene
    solved.display.in_renders = True
    legend = addon.render_legend.find(scene)
    assert legend.hide_render
    make.look_down(100, 100)
    bpy.context.view_layer.update()
    assert not legend.hide_render and legend.parent == scene.camera
    scene.camera.data.type = "PANO"
    bpy.context.view_layer.update()
    assert legend.hide_render


def test_the_legend_takes_no_part(addon, bpy, make, solved):
    scene = bpy.context.scene
    make.look_down(100, 100)
    key = addon.study.collect(bpy.context).key
    solved.display.in_renders = True
    assert addon.study.collect(bpy.context).key == key
    assert addon.render_legend.find(scene).hide_get()
    assert not any(one.object_.name == addon.render_legend.NAME for one in addon.display.shown_meshes(scene))
    assert bpy.ops.luzespecular.check_scene() == {"FINISHED"}
    findings = bpy.context.window_manager.luzespecular.findings
    assert not [finding for finding in findings if addon.render_legend.NAME in finding.text]
    assert {row.object_name for row in solved.results.rows} == {"Floor", "Canopy"}
