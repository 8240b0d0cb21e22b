"""Check a room with faults by the button, go through the findings and select what they are about, in both languages."""

import bpy


def steps(window):
    yield from window.open_tab()
    state = bpy.context.window_manager.luzespecular
    room = faulty_room()
    yield 0.5
    with window.override():
        bpy.ops.luzespecular.check_scene("INVOKE_DEFAULT")
    yield from window.until(lambda: not state.running, 60)
    told = [(finding.level, finding.name, finding.text) for finding in state.findings]
    print(*told, sep="\n", flush=True)
    assert any(finding.name == "Room" for finding in state.findings)
    yield from window.scroll()
    window.shot("findings")

    # The button of a finding selects its faces; the next one's too, from Edit Mode.
    for index, finding in enumerate(state.findings):
        if finding.level != "INFO":
            state.active_finding = index
            with window.override():
                assert bpy.ops.luzespecular.select_finding("INVOKE_DEFAULT", index=index) == {"FINISHED"}
            yield 0.5
            window.shot(f"finding {index} selected")
    assert room.mode == "EDIT"
    view = bpy.context.preferences.view
    view.language, view.use_translate_interface = "pt_BR", True
    yield 1.0
    window.shot("findings pt")
    bpy.ops.object.mode_set(mode="OBJECT")

    # Solving lists them as well, and live results go on while a face is edited.
    bpy.context.scene.luzespecular.accuracy.fineness = "DRAFT"
    with window.override():
        bpy.ops.luzespecular.solve("INVOKE_DEFAULT")
    yield from window.until(lambda: not state.running, 120)
    assert len(state.findings)
    index = next(index for index, finding in enumerate(state.findings) if finding.name == "Room")
    with window.override():
        assert bpy.ops.luzespecular.select_finding("INVOKE_DEFAULT", index=index) == {"FINISHED"}
    assert not room.hide_get()
    yield 0.5
    bpy.context.scene.luzespecular.site.hour = 10.0
    yield 3.0
    window.shot("solved with findings")
    assert "10:00" not in bpy.context.scene.luzespecular.results.title
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.scene.luzespecular.site.hour = 10.5
    yield from window.until(lambda: "10:30" in bpy.context.scene.luzespecular.results.title, 60)
    window.shot("live again")


def faulty_room():
    """Make a room without its north wall of which one wall is turned over, and whose roof is 5 mm too high."""
    corners = [(x, y, z) for z in (0.0, 3.0) for y in (-2.0, 2.0) for x in (-2.0, 2.0)]
    faces = [(0, 1, 3, 2), (0, 4, 5, 1), (1, 5, 7, 3)[::-1], (0, 2, 6, 4)]
    paint = bpy.data.materials.new("Paint")
    made = []
    for name, vertices, polygons in (
        ("Room", corners, faces),
        ("Roof", [(x, y, 3.005) for _, (x, y, z) in enumerate(corners) if z], [(0, 2, 3, 1)]),
    ):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], polygons)
        mesh.materials.append(paint)
        made.append(bpy.data.objects.new(name, mesh))
        made[-1].luzespecular.sides = "FRONT"
        bpy.context.scene.collection.objects.link(made[-1])
    bpy.data.objects["Cube"].scale = (0.2, 0.2, 0.2)
    return made[0]
