"""Readings under the mouse, and those that are kept shown."""

import numpy as np
import pytest

OPEN_SKY = 10_000.0


@pytest.fixture
def look(addon, bpy):
    """Look straight down, or up, at a place."""

    def at(x, y, start=3.0, down=True, culls=True):
        vector = addon.probe.Vector
        return addon.probe.pick(
            addon.probe.targets(bpy.context), vector((x, y, start)), vector((0, 0, -1 if down else 1)), culls
        )

    return at


def test_the_nearest_lit_side_is_read(addon, bpy, solved, look):
    name, rows = addon.probe.rows(bpy.context, look(0.5, 0.5))
    assert name == "Canopy"
    assert dict(rows)["Illuminance"] == "10 000 lx"
    name, rows = addon.probe.rows(bpy.context, look(0.5, 0.5, start=0.3))
    assert name == "Floor"
    name, rows = addon.probe.rows(bpy.context, look(0.5, 0.5, start=0.3, down=False))
    assert name == "Canopy (back)"


def test_components_add_up_to_the_total(addon, bpy, solved, look):
    rows = dict(addon.probe.rows(bpy.context, look(1.2, 1.2))[1])
    lux = {key: float(value.split(" lx")[0].replace(" ", "")) for key, value in rows.items() if value.endswith(" lx")}
    assert lux["Illuminance"] == pytest.approx(lux["Initial"] + lux["Interreflected"], abs=2.0)
    assert lux["Sky, direct"] == pytest.approx(lux["Initial"])
    assert rows["Daylight factor"] == f"{lux['Illuminance'] / 100.0:,.0f} %"


def test_errors_are_told_once_they_are_known(addon, bpy, solved, look):
    assert "Error" not in dict(addon.probe.rows(bpy.context, look(1.2, 1.2))[1])
    solved.display.quantity = "error"
    assert dict(addon.probe.rows(bpy.context, look(1.2, 1.2))[1])["Error"].startswith("± ")


def test_what_was_not_computed_is_said_so(addon, bpy, make, solved, look):
    make.square("Newcomer", height=1.0)
    bpy.context.view_layer.update()
    assert addon.probe.rows(bpy.context, look(0.5, 0.5)) == ("Newcomer", [("not computed", "")])
    assert look(9.0, 9.0) is None


def test_own_meshes_are_read_through_modifiers(addon, bpy, make, look):
    floor = make.mesh(
        "Floor",
        [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0)],
        [(0, 1, 4, 3), (1, 2, 5, 4)],
    )
    cut = floor.modifiers.new("Subdivide", "SUBSURF")
    cut.subdivision_type, cut.levels = "SIMPLE", 2
    make.square("Roof", height=0.2).luzespecular.role = "OBSTRUCTION"
    settings = make.quick()
    settings.display.view = "OWN"
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    own = addon.mesh_arrays.read_face_values(floor.data, "illuminance", np.float32)
    for x, value in ((0.3, own[0]), (0.8, own[0]), (1.2, own[1]), (1.9, own[1])):
        name, rows = addon.probe.rows(bpy.context, look(x, 0.6, start=0.1))
        assert name == "Floor"
        assert rows[0][1] == f"{addon.legend.label(float(value))} lx"


def test_kept_readings_follow_new_results_and_other_views(addon, bpy, solved, look):
    scene = bpy.context.scene
    addon.probe.pin(scene, look(1.6, 1.6))
    (pin,) = scene.luzespecular.results.pins
    first = addon.probe.pinned_value(scene, pin)
    assert first == pytest.approx(OPEN_SKY, rel=0.1)
    solved.sky.horizontal_illuminance = 3 * OPEN_SKY
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert addon.probe.pinned_value(scene, pin) == pytest.approx(3 * first, rel=1e-3)
    solved.display.unit = "FACTOR"
    assert addon.probe.pinned_value(scene, pin) == pytest.approx(first / OPEN_SKY * 100.0, rel=1e-3)
    solved.display.view = "OWN"
    assert pin.name == "Floor"
    solved.display.view, solved.accuracy.max_area = "RESULTS", 0.5
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}  # other fine faces
    mesh = bpy.data.objects[pin.name].data
    centre = addon.mesh_arrays.polygon_centres(mesh)[pin.face]
    assert np.linalg.norm(centre - [1.6, 1.6, 0.0]) < 0.7
    assert bpy.ops.luzespecular.clear_pins() == {"FINISHED"}
    assert not scene.luzespecular.results.pins
    assert not bpy.ops.luzespecular.clear_pins.poll()


def test_a_pin_keeps_to_its_side(addon, bpy, solved, look):
    scene = bpy.context.scene
    addon.probe.pin(scene, look(0.5, 0.5, start=0.3, down=False))
    (pin,) = scene.luzespecular.results.pins
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    assert pin.name == "LuzEspecular results (backs)"
