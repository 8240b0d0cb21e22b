"""The evaluated scene becomes surfaces: where they stand, what they are made of, and whose faces they were."""

import math

import numpy as np
import pytest


def exported(addon, bpy):
    return addon.export.export_scene(bpy.context)


def corners(export, name):
    """All triangles that the solver's scene holds of a surface, (k, 3, 3)."""
    surface = export.scene.surfaces[name]
    assert (surface.counts == 3).all()
    return surface.pieces[:, :3]


def area_vector(triangles):
    return 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]).sum(axis=0)


def texts(notices, level=None):
    return [notice.text for notice in notices if level in (None, notice.level)]


def test_transform_places_the_surface(addon, bpy, make):
    square = make.square("Floor", size=2.0)
    square.location = (1.0, 2.0, 3.0)
    square.rotation_euler = (0.0, 0.0, math.pi / 2)
    square.scale = (1.0, 2.0, 1.0)
    points = corners(exported(addon, bpy), "Floor").reshape(-1, 3)
    np.testing.assert_allclose(points.min(axis=0), (-3.0, 2.0, 3.0), atol=1e-6)
    np.testing.assert_allclose(points.max(axis=0), (1.0, 4.0, 3.0), atol=1e-6)


def test_parents_move_their_children(addon, bpy, make):
    parent = make.object("Parent", None)
    parent.location = (0.0, 0.0, 5.0)
    make.square("Floor").parent = parent
    assert corners(exported(addon, bpy), "Floor")[..., 2] == pytest.approx(5.0)


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (1, -2, 1), (-1, -1, 1), (1, 1, -1), (-1, -1, -1)])
def test_mirrored_objects_keep_looking_out(addon, bpy, make, scale):
    make.cube("Cube").scale = scale
    triangles = corners(exported(addon, bpy), "Cube")
    volume = np.einsum("tc,tc->t", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6
    assert volume == pytest.approx(abs(np.prod(scale)), rel=1e-6)


def test_mirrored_square_looks_to_where_blender_shows_its_normal(addon, bpy, make):
    make.square("Floor").scale = (-1.0, 1.0, 1.0)
    np.testing.assert_allclose(area_vector(corners(exported(addon, bpy), "Floor")), (0, 0, 1), atol=1e-7)


def test_concave_polygon_keeps_its_area(addon, bpy, make):
    loop = [(0, 0, 0), (3, 0, 0), (3, 3, 0), (2, 3, 0), (2, 1, 0), (1, 1, 0), (1, 3, 0), (0, 3, 0)]
    make.mesh("U", loop, [tuple(range(8))])
    triangles = corners(exported(addon, bpy), "U")
    assert area_vector(triangles)[2] == pytest.approx(7.0)
    inside_the_notch = np.all(np.abs(triangles.mean(axis=1) - (1.5, 2.0, 0.0)) < 0.45, axis=1)
    assert not inside_the_notch.any()


def test_bent_quad_is_taken_as_blender_cuts_it(addon, bpy, make):
    make.mesh("Sail", [(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)], [(0, 1, 2, 3)])
    export = exported(addon, bpy)
    assert len(corners(export, "Sail")) == 2
    assert export.surfaces[0].own_faces.tolist() == [0, 0]


def test_unit_scale_turns_units_into_metres(addon, bpy, make):
    make.square("Floor", size=300.0)
    bpy.context.scene.unit_settings.scale_length = 0.01
    export = exported(addon, bpy)
    assert area_vector(corners(export, "Floor"))[2] == pytest.approx(9.0)
    assert export.unit_scale == 0.01


def test_scenes_without_units_are_in_metres(addon, bpy, make):
    make.square("Floor", size=3.0)
    bpy.context.scene.unit_settings.scale_length = 0.01
    bpy.context.scene.unit_settings.system = "NONE"
    assert area_vector(corners(exported(addon, bpy), "Floor"))[2] == pytest.approx(9.0)


def test_each_material_of_an_object_is_a_surface(addon, bpy, make):
    cube = make.cube("Room", material=make.material("White", diffuse_reflectance=0.8))
    cube.data.materials.append(make.material("Mirror", diffuse_reflectance=0.0, specular_reflectance=0.9))
    cube.data.polygons[1].material_index = 1
    surfaces = exported(addon, bpy).scene.surfaces
    assert set(surfaces) == {"Room/White", "Room/Mirror"}
    assert surfaces["Room/White"].material.diffuse_reflectance == 0.8
    assert surfaces["Room/Mirror"].material.specular_reflectance == 0.9
    assert len(surfaces["Room/White"].pieces) == 10
    assert len(surfaces["Room/Mirror"].pieces) == 2
    assert (surfaces["Room/Mirror"].pieces[..., 2] == 1.0).all()


def test_material_index_beyond_the_slots_takes_the_last(addon, bpy, make):
    square = make.square("Floor", material=make.material("First", diffuse_reflectance=0.7))
    square.data.materials.append(make.material("Last", diffuse_reflectance=0.3))
    square.data.polygons[0].material_index = 9
    assert exported(addon, bpy).scene.surfaces["Floor"].material.diffuse_reflectance == 0.3


def test_material_linked_to_the_object_wins(addon, bpy, make):
    square = make.square("Floor", material=make.material("Mesh's", diffuse_reflectance=0.3))
    square.material_slots[0].link = "OBJECT"
    square.material_slots[0].material = make.material("Object's", diffuse_reflectance=0.7)
    assert exported(addon, bpy).scene.surfaces["Floor"].material.diffuse_reflectance == 0.7


def test_object_without_material_is_half_reflecting_and_said_so(addon, bpy, make):
    make.square("Piso à direita")
    export = exported(addon, bpy)
    assert export.scene.surfaces["Piso à direita"].material.diffuse_reflectance == 0.5
    assert any("Piso à direita" in text and "0.5" in text for text in texts(export.notices))


def test_modifiers_are_applied_and_faces_find_home(addon, bpy, make):
    square = make.mesh(
        "Floor", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0)], [(0, 1, 4, 3), (1, 2, 5, 4)]
    )
    array = square.modifiers.new("Array", "ARRAY")
    array.count, array.use_relative_offset, array.use_constant_offset = 3, False, True
    array.constant_offset_displace = (0.0, 0.0, 1.0)
    square.modifiers.new("Subdivide", "SUBSURF").subdivision_type = "SIMPLE"
    export = exported(addon, bpy)
    triangles, own = corners(export, "Floor"), export.surfaces[0].own_faces
    assert len(triangles) == len(own) == 2 * 3 * 4 * 2
    np.testing.assert_array_equal(own, (triangles.mean(axis=1)[:, 0] > 1.0).astype(int))


def test_export_changes_nothing_of_the_mesh(addon, bpy, make):
    square = make.square("Floor")
    square.modifiers.new("Solid", "SOLIDIFY")
    mesh = square.data
    mesh.color_attributes.new("first", "FLOAT_COLOR", "CORNER")
    mesh.color_attributes.new("second", "BYTE_COLOR", "POINT")
    mesh.color_attributes.active_color_name = "first"
    mesh.color_attributes.default_color_name = "second"
    mesh.attributes.active = mesh.attributes["second"]

    def state():
        return (
            [(a.name, a.domain, a.data_type) for a in mesh.attributes],
            mesh.attributes.active.name,
            mesh.color_attributes.active_color_name,
            mesh.color_attributes.default_color_name,
            list(mesh.keys()),
        )

    before = state()
    exported(addon, bpy)
    assert state() == before


def test_numbers_are_taken_away_when_the_export_fails(addon, bpy, make, monkeypatch):
    square = make.square("Floor")
    square.modifiers.new("Solid", "SOLIDIFY")
    names = [attribute.name for attribute in square.data.attributes]

    def fail(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(addon.mesh_arrays, "read_triangles", fail)
    with pytest.raises(ZeroDivisionError):
        exported(addon, bpy)
    assert [attribute.name for attribute in square.data.attributes] == names


def test_hidden_from_render_is_left_out(addon, bpy, make):
    make.square("Floor")
    make.square("Ghost", height=1.0).hide_render = True
    hidden = bpy.data.collections.new("Hidden")
    hidden.hide_render = True
    bpy.context.scene.collection.children.link(hidden)
    buried = make.square("Buried", height=2.0)
    bpy.context.scene.collection.objects.unlink(buried)
    hidden.objects.link(buried)
    excluded = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(excluded)
    away = make.square("Away", height=3.0)
    bpy.context.scene.collection.objects.unlink(away)
    excluded.objects.link(away)
    bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True
    assert set(exported(addon, bpy).scene.surfaces) == {"Floor"}


def test_hidden_in_the_viewport_takes_part_and_stays_hidden(addon, bpy, make):
    eye, screen = make.square("Eye"), make.square("Screen", height=1.0)
    eye.hide_set(True)
    screen.hide_viewport = True
    collection = bpy.data.collections.new("Closed eye")
    bpy.context.scene.collection.children.link(collection)
    inside = make.square("Inside", height=2.0)
    bpy.context.scene.collection.objects.unlink(inside)
    collection.objects.link(inside)
    layer = bpy.context.view_layer.layer_collection.children["Closed eye"]
    layer.hide_viewport = True
    assert set(exported(addon, bpy).scene.surfaces) == {"Eye", "Screen", "Inside"}
    assert eye.hide_get()
    assert screen.hide_viewport
    assert layer.hide_viewport


def test_roles(addon, bpy, make):
    make.square("Floor")
    make.square("House over the street", height=1.0).luzespecular.role = "OBSTRUCTION"
    make.square("Helper", height=2.0).luzespecular.role = "IGNORE"
    export = exported(addon, bpy)
    assert {surface.name: surface.receiver for surface in export.surfaces} == {
        "Floor": True,
        "House over the street": False,
    }


def test_sides(addon, bpy, make):
    make.cube("Closed")
    make.square("Open", height=2.0)
    make.square("Front", height=3.0).luzespecular.sides = "FRONT"
    make.cube("Both").luzespecular.sides = "BOTH"
    surfaces = exported(addon, bpy).scene.surfaces
    assert {name: surface.two_sided for name, surface in surfaces.items()} == {
        "Closed": False,
        "Open": True,
        "Front": False,
        "Both": True,
    }


def test_linked_duplicates_are_surfaces_without_own_results(addon, bpy, make):
    first = make.square("Table")
    second = make.object("Table.001", first.data)
    second.location = (0.0, 0.0, 1.0)
    export = exported(addon, bpy)
    assert {surface.name for surface in export.surfaces} == {"Table", "Table.001"}
    assert all(surface.own_faces is None for surface in export.surfaces)
    assert corners(export, "Table.001")[..., 2] == pytest.approx(1.0)
    assert any("Table" in text and "fine faces" in text for text in texts(export.notices, "INFO"))


def test_fake_user_does_not_make_a_mesh_shared(addon, bpy, make):
    make.square("Floor").data.use_fake_user = True
    assert exported(addon, bpy).surfaces[0].own_faces is not None


def test_collection_instances(addon, bpy, make):
    library = bpy.data.collections.new("Chair library")
    seat = make.square("Seat", material=make.material("Wood", diffuse_reflectance=0.4))
    ghost = make.square("Ghost")
    ghost.hide_render = True
    for object_ in (seat, ghost):
        bpy.context.scene.collection.objects.unlink(object_)
        library.objects.link(object_)
    for name, x in (("Chair", 0.0), ("Chair.001", 5.0)):
        empty = make.object(name, None)
        empty.instance_type, empty.instance_collection = "COLLECTION", library
        empty.location = (x, 0.0, 0.0)
    export = exported(addon, bpy)
    assert set(export.scene.surfaces) == {"Chair > Seat", "Chair.001 > Seat"}
    assert corners(export, "Chair.001 > Seat")[..., 0].min() == pytest.approx(5.0)
    assert {surface.object_name for surface in export.surfaces} == {"Chair", "Chair.001"}


def test_many_instances_of_one_object_are_one_surface(addon, bpy, make):
    leaf = make.square("Leaf", size=0.1)
    tree = make.mesh("Tree", [(0, 0, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    leaf.parent = tree
    tree.instance_type = "VERTS"
    tree.show_instancer_for_viewport = True
    export = exported(addon, bpy)
    assert "Tree > Leaf" in export.scene.surfaces
    assert len(corners(export, "Tree > Leaf")) == 4 * 2


def test_geometry_nodes_instances(addon, bpy, make):
    square = make.square("Scatter")
    group = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    instance, cube = nodes.new("GeometryNodeInstanceOnPoints"), nodes.new("GeometryNodeMeshCube")
    links.new(start.outputs[0], instance.inputs["Points"])
    links.new(cube.outputs["Mesh"], instance.inputs["Instance"])
    links.new(instance.outputs[0], end.inputs[0])
    square.modifiers.new("Scatter", "NODES").node_group = group
    export = exported(addon, bpy)
    assert set(export.scene.surfaces) == {"Scatter"}
    triangles = corners(export, "Scatter")
    assert len(triangles) == 4 * 12
    np.testing.assert_allclose(triangles.reshape(-1, 3).max(axis=0), (1.5, 1.5, 0.5))
    assert export.surfaces[0].own_faces is None


@pytest.mark.parametrize("kind", ["FONT", "CURVE", "META"])
def test_text_curves_and_metaballs_are_taken_once(addon, bpy, make, kind):
    if kind == "FONT":
        data = bpy.data.curves.new("Sign", "FONT")
        data.body = "Luz"
    elif kind == "CURVE":
        data = bpy.data.curves.new("Sign", "CURVE")
        data.dimensions, data.fill_mode = "2D", "BOTH"
        spline = data.splines.new("POLY")
        spline.points.add(3)
        for point, place in zip(spline.points, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
            point.co = (*place, 0.0, 1.0)
        spline.use_cyclic_u = True
    else:
        data = bpy.data.metaballs.new("Sign")
        data.elements.new()
    sign = make.object("Sign", data)
    export = exported(addon, bpy)
    assert set(export.scene.surfaces) == {"Sign"}
    mesh = sign.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    expected = sum(polygon.area for polygon in mesh.polygons)
    triangles = corners(export, "Sign")
    total = (
        0.5
        * np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).sum()
    )
    assert total == pytest.approx(expected, rel=1e-4)


def test_names_stay_unique(addon, bpy, make):
    grey, white = make.material("Grey"), make.material("White")
    room = make.cube("A", material=grey)
    room.data.materials.append(white)
    room.data.polygons[0].material_index = 1
    make.square("A/Grey", material=grey)
    export = exported(addon, bpy)
    names = [surface.name for surface in export.surfaces]
    assert len(set(names)) == 3
    assert set(export.scene.surfaces) == set(names)


def test_fingerprint_follows_what_the_solver_sees(addon, bpy, make):
    square = make.square("Floor", material=make.material("Grey", diffuse_reflectance=0.5))
    first = exported(addon, bpy).fingerprint
    assert addon.export.current_fingerprint(bpy.context) == first
    bpy.context.scene.luzespecular.site.hour = 9.0
    assert exported(addon, bpy).fingerprint == first
    square.location.x += 0.001
    moved = exported(addon, bpy).fingerprint
    assert moved != first
    square.material_slots[0].material.luzespecular.diffuse_reflectance = 0.6
    assert exported(addon, bpy).fingerprint not in (first, moved)


def test_nothing_to_light_is_refused(addon, bpy):
    with pytest.raises(addon.notices.BadInput, match="no object with faces"):
        exported(addon, bpy)


def test_nan_is_refused_by_name(addon, bpy, make):
    make.square("Floor")
    make.square("Broken wall", height=1.0).data.vertices[2].co.x = math.nan
    with pytest.raises(addon.notices.BadInput, match=r"Broken wall.*not finite"):
        exported(addon, bpy)


def test_impossible_material_is_refused_by_name(addon, bpy, make):
    make.square("Floor", material=make.material("Too bright", diffuse_reflectance=0.7, specular_reflectance=0.5))
    with pytest.raises(addon.notices.BadInput, match=r"Too bright.*1\.2"):
        exported(addon, bpy)


def test_all_errors_come_at_once(addon, bpy, make):
    make.square("Broken", material=make.material("Fine")).data.vertices[0].co.z = math.inf
    make.square("Floor", material=make.material("Too bright", diffuse_reflectance=0.7, specular_reflectance=0.5))
    with pytest.raises(addon.notices.BadInput) as caught:
        exported(addon, bpy)
    assert len(texts(caught.value.notices, "ERROR")) == 2


def test_objects_without_faces_are_named(addon, bpy, make):
    make.square("Floor")
    make.mesh("Guides", [(0, 0, 0), (1, 0, 0)], [])
    make.object("Smoke", bpy.data.volumes.new("Smoke"))
    make.object("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    notices = exported(addon, bpy).notices
    assert any("'Guides'" in text and "no faces" in text for text in texts(notices, "WARNING"))
    assert any("'Smoke'" in text and "no mesh data" in text for text in texts(notices, "WARNING"))
    assert any("'Lamp'" in text for text in texts(notices, "INFO"))


def test_faces_without_area_are_left_out_and_named(addon, bpy, make):
    make.mesh("Wall", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], [(0, 1, 2, 3), (0, 1, 4)])
    make.square("Flattened").scale = (1.0, 0.0, 1.0)
    export = exported(addon, bpy)
    assert set(export.scene.surfaces) == {"Wall"}
    assert export.surfaces[0].own_faces.tolist() == [0, 0]
    assert any("'Wall': 1 faces" in text for text in texts(export.notices, "WARNING"))
    assert any("'Flattened'" in text for text in texts(export.notices, "WARNING"))


def test_edit_mode_is_refused(addon, bpy, make):
    floor = make.square("Floor")
    bpy.context.view_layer.objects.active = floor
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(addon.notices.BadInput, match="'Floor' is in Edit Mode"):
        exported(addon, bpy)


def test_solid_pane_passes_as_much_as_the_pane(addon, bpy, make):
    glass = make.material("Glass", use_refractive_index=True, regular_transmittance=0.81, refractive_index=1.52)
    make.cube("Window", material=glass)
    make.square("Sheet", height=3.0, material=glass)
    export = exported(addon, bpy)
    surfaces = export.scene.surfaces
    assert surfaces["Window"].material.regular_transmittance == pytest.approx(0.9)
    assert surfaces["Window"].material.refractive_index is None
    assert surfaces["Sheet"].material.refractive_index == 1.52
    assert any("'Window' is a solid pane" in text for text in texts(export.notices, "WARNING"))
