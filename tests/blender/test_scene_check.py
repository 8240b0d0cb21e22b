"""The scene check in Blender: what is found, in which of the user's faces, and selecting it."""

import numpy as np
import pytest
from builders import box_polygons

SIZE = (4, 3, 2.5)


@pytest.fixture
def room(bpy, make):
    """Make a room of 4 m × 3 m × 2.5 m without its north wall, in one mesh; returns it and the names of its faces."""

    def build(**changes):
        polygons = {name: corners for name, corners in box_polygons(SIZE).items() if name != "north"} | changes
        corners = np.concatenate(list(polygons.values()))
        faces = np.arange(len(corners)).reshape(-1, 4)
        object_ = make.mesh("Room", corners.tolist(), faces.tolist(), make.material(diffuse_reflectance=0.5))
        object_.luzespecular.sides = "FRONT"
        return object_, list(polygons)

    return build


@pytest.fixture
def check(addon, bpy):
    """Run the operator in the foreground; returns what is listed."""

    def run():
        assert bpy.ops.luzespecular.check_scene() == {"FINISHED"}
        state = bpy.context.window_manager.luzespecular
        assert state.checked
        return list(state.findings)

    return run


def chosen_faces(addon, object_):
    """Faces selected in a mesh; Edit Mode keeps them to itself until it is left."""
    object_.update_from_editmode()
    return [polygon.index for polygon in object_.data.polygons if polygon.select]


def turned(name):
    return {name: box_polygons(SIZE)[name][::-1]}


def test_a_sound_scene_has_no_findings(bpy, room, check):
    room()
    assert check() == []


def test_a_face_turned_over_is_found_and_selected(addon, bpy, room, check):
    object_, names = room(**turned("west"))
    other = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(other)
    other.select_set(True)
    (finding,) = check()
    assert (finding.level, finding.name) == ("WARNING", "Room")
    assert "Room" in finding.text
    assert finding.remedy
    assert bpy.ops.luzespecular.select_finding(index=0) == {"FINISHED"}
    assert (bpy.context.mode, bpy.context.object) == ("EDIT_MESH", object_)
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)
    assert chosen_faces(addon, object_) == [names.index("west")]
    assert not other.select_get()


def test_findings_can_be_selected_one_after_another(addon, bpy, room, check):
    object_, names = room(**turned("west"), **turned("floor"))
    findings = check()
    assert findings
    for index in [*range(len(findings)), 0]:  # Edit Mode of the one before is left
        assert bpy.ops.luzespecular.select_finding(index=index) == {"FINISHED"}
        assert bpy.context.mode == "EDIT_MESH"
        assert set(chosen_faces(addon, object_)) <= {names.index("west"), names.index("floor")}
        assert chosen_faces(addon, object_)


def test_faces_behind_modifiers_are_found_in_the_own_mesh(addon, bpy, room, check):
    object_, names = room(**turned("west"))
    object_.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
    check()
    bpy.ops.luzespecular.select_finding(index=0)
    assert chosen_faces(addon, object_) == [names.index("west")]


def test_hidden_faces_are_shown_when_they_are_selected(addon, bpy, room, check):
    object_, names = room(**turned("west"))
    for polygon in object_.data.polygons:
        polygon.hide = True
    check()
    bpy.ops.luzespecular.select_finding(index=0)
    assert chosen_faces(addon, object_) == [names.index("west")]
    assert not any(polygon.hide for polygon in object_.data.polygons)


def test_whole_objects_are_selected_in_object_mode(bpy, make, check):
    paint = make.material(diffuse_reflectance=0.5)
    one, two = make.square("Floor", material=paint), make.square("Carpet", material=paint)
    two.scale = (0.5, 0.5, 1.0)
    bpy.context.view_layer.update()
    (finding,) = [finding for finding in check() if "lie on one another" in finding.text]
    assert finding.remedy == "remove what is doubled"
    assert bpy.ops.luzespecular.select_finding(index=0) == {"FINISHED"}
    assert bpy.context.mode == "OBJECT"
    assert set(bpy.context.selected_objects) == {one, two}


def test_edited_meshes_are_selected_as_a_whole(bpy, make, room, check):
    object_, _ = room(**turned("west"))
    check()
    object_.data.clear_geometry()
    object_.data.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [], [(0, 1, 2)])
    assert bpy.ops.luzespecular.select_finding(index=0) == {"FINISHED"}
    assert (bpy.context.mode, bpy.context.selected_objects) == ("OBJECT", [object_])


def test_what_stands_in_the_way_is_listed_with_its_objects(bpy, make, check):
    bad = make.material("Bad", diffuse_reflectance=0.7, specular_reflectance=0.6)
    objects = {make.square("A", material=bad), make.square("B", height=1.0, material=bad)}
    (finding,) = check()
    assert finding.level == "ERROR"
    assert "Bad" in finding.text
    assert bpy.ops.luzespecular.select_finding(index=0) == {"FINISHED"}
    assert set(bpy.context.selected_objects) == objects


def test_nothing_can_be_selected_of_the_scene_as_a_whole(bpy, make, check):
    room = make.cube(size=4_000.0, material=make.material(diffuse_reflectance=0.5))
    room.data.flip_normals()
    index = next(index for index, finding in enumerate(check()) if "millimetres" in finding.remedy)
    with pytest.raises(RuntimeError, match="scene as a whole"):
        bpy.ops.luzespecular.select_finding(index=index)
    with pytest.raises(RuntimeError, match="scene as a whole"):
        bpy.ops.luzespecular.select_finding(index=100)


def test_solving_lists_findings_and_selecting_shows_the_own_meshes(addon, bpy, make, room):
    object_, names = room(**turned("west"))
    settings = make.quick()
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert object_.hide_get()
    assert bpy.ops.luzespecular.select_finding(index=0) == {"FINISHED"}
    assert settings.display.view == "OWN"
    assert not object_.hide_get()
    assert chosen_faces(addon, object_) == [names.index("west")]


def test_hidden_objects_are_shown_and_lost_ones_are_told(bpy, make, room, check):
    object_, _ = room(**turned("west"))
    object_.hide_set(True)
    check()
    assert bpy.ops.luzespecular.select_finding(index=0) == {"FINISHED"}
    assert bpy.context.object == object_
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(object_)
    assert bpy.ops.luzespecular.select_finding(index=0) == {"CANCELLED"}


def test_checking_changes_nothing_and_another_file_empties_the_list(addon, bpy, room, check, tmp_path):
    object_, _ = room(**turned("west"))
    before = addon.export.current_fingerprint(bpy.context)
    check()
    assert addon.export.current_fingerprint(bpy.context) == before
    assert not object_.data.attributes.get("illuminance")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "checked.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "checked.blend"))
    state = bpy.context.window_manager.luzespecular
    assert (state.checked, len(state.findings)) == (False, 0)


def test_leaving_a_check_off_keeps_the_list_of_before(addon, bpy, room, check, monkeypatch):
    room(**turned("west"))
    check()
    monkeypatch.setattr(addon.job.Task, "start", addon.job.Task.cancel)
    monkeypatch.setattr(addon.job.Task, "wait", lambda _: None)
    assert bpy.ops.luzespecular.check_scene() == {"CANCELLED"}
    assert len(bpy.context.window_manager.luzespecular.findings) == 1
