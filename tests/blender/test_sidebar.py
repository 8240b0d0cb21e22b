"""Places, the clock, the scene's Sun light, roles, presets: what the sidebar's buttons do."""

import ast
import datetime as dt
import math
from pathlib import Path

import pytest

ADDON = Path(__file__).resolve().parents[2] / "luzespecular_addon"


@pytest.fixture
def site(bpy):
    return bpy.context.scene.luzespecular.site


def sun_light(bpy, name="Sol"):
    light = bpy.data.objects.new(name, bpy.data.lights.new(name, "SUN"))
    bpy.context.scene.collection.objects.link(light)
    return light


def towards(light):
    """Where a Sun light shines from."""
    return light.matrix_world.to_3x3().col[2]


def test_the_compass_looks_where_sun_lights_shine_from(addon, bpy):
    light = sun_light(bpy)
    for azimuth, altitude in ((0.0, 0.0), (90.0, 10.0), (200.0, 65.0), (330.0, -20.0)):
        addon.sun_light.point(light, altitude, azimuth)
        bpy.context.view_layer.update()
        assert addon.compass.towards(azimuth, altitude) == pytest.approx(tuple(towards(light)), abs=1e-6)
    assert addon.compass.towards(90.0) == pytest.approx((1.0, 0.0, 0.0))  # east of +Y, seen from above


def test_places_have_their_clocks_near_the_sun(addon):
    for place in addon.places.PLACES:
        assert -90 < place.latitude < 90, place
        assert abs(place.time_zone - place.longitude / 15) < 1.6, place
    assert len({place.name for place in addon.places.PLACES}) == len(addon.places.PLACES)


def test_a_place_sets_where_and_its_clock(bpy, site):
    site.hour = 9.0
    assert bpy.ops.luzespecular.set_place(place="São Paulo") == {"FINISHED"}
    assert (site.latitude, site.longitude, site.time_zone) == pytest.approx((-23.548, -46.636, -3.0), abs=1e-4)
    assert site.hour == 9.0
    with pytest.raises(RuntimeError, match="no place 'Atlantis'"):
        bpy.ops.luzespecular.set_place(place="Atlantis")


def test_now(addon, bpy, site):
    before = dt.datetime.now(dt.UTC)
    assert bpy.ops.luzespecular.set_now() == {"FINISHED"}
    assert site.time_kind == "CLOCK"
    told = dt.datetime.combine(addon.light.date_of(site), dt.time(), dt.UTC) + dt.timedelta(
        hours=site.hour - site.time_zone
    )
    assert abs((told - before).total_seconds()) < 120


def test_days_later_run_through_months(addon, site):
    site.year, site.month, site.day, site.days_later = 2026, 6, 22, 183
    assert addon.light.date_of(site) == dt.date(2026, 12, 22)


def test_a_sun_light_follows_the_hour(addon, bpy, site):
    light = sun_light(bpy)
    light.location, light.scale = (1.0, 2.0, 3.0), (1.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    site.north_offset = 25.0
    site.sun_object, site.sun_link = light, "SET"
    for hour in (8.0, 12.0, 16.5):
        site.hour = hour
        bpy.context.view_layer.update()
        place = addon.light.sun_place(site)
        high, around = math.radians(place.altitude), math.radians(place.scene_azimuth)
        expected = (math.cos(high) * math.sin(around), math.cos(high) * math.cos(around), math.sin(high))
        assert tuple(towards(light)) == pytest.approx(expected, abs=1e-5)
    assert tuple(light.location) == (1.0, 2.0, 3.0)


def test_a_sun_light_is_read(addon, bpy, site):
    light = sun_light(bpy)
    light.rotation_euler = (math.radians(50), 0.0, math.radians(30))  # tilted to -Y, then turned anticlockwise
    bpy.context.view_layer.update()
    site.sun_object, site.sun_link, site.north_offset = light, "READ", 10.0
    place = addon.light.sun_place(site)
    assert place.altitude == pytest.approx(40.0, abs=1e-3)
    assert place.scene_azimuth == pytest.approx(180.0 - 30.0, abs=1e-3)
    assert place.azimuth == pytest.approx(140.0, abs=1e-3)
    x, y, z = addon.light.daylight(bpy.context.scene)[0].sun.direction
    assert (x, y, z) == pytest.approx(tuple(towards(light)), abs=1e-5)


def test_reading_no_sun_light_is_refused_by_name_of_the_remedy(addon, bpy, site):
    site.sun_link = "READ"
    with pytest.raises(addon.notices.BadInput, match="choose one in Site & Time"):
        addon.light.sun_place(site)


def test_a_sun_light_is_chosen_or_made(bpy, site):
    assert bpy.ops.luzespecular.add_sun_light() == {"FINISHED"}
    made = site.sun_object
    assert (made.data.type, site.sun_link) == ("SUN", "SET")
    assert math.degrees(made.data.angle) == pytest.approx(0.533, abs=1e-4)
    site.sun_object = None
    bpy.ops.luzespecular.add_sun_light()
    assert site.sun_object == made
    assert len(bpy.data.lights) == 1


def test_a_sun_light_with_a_part_is_not_called_left_out(addon, bpy, make, site):
    make.square()
    make.quick()
    light = sun_light(bpy)
    assert any("Sol" in notice.text for notice in addon.study.collect(bpy.context).notices)
    site.sun_object, site.sun_link = light, "SET"
    assert not any("Sol" in notice.text for notice in addon.study.collect(bpy.context).notices)


def test_roles_of_many_objects(bpy, make):
    objects = [make.square(name) for name in ("A", "B", "C")]
    for object_ in objects[:2]:
        object_.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    objects[0].luzespecular.role, objects[0].luzespecular.sides = "OBSTRUCTION", "BOTH"
    assert bpy.ops.luzespecular.set_role() == {"FINISHED"}
    assert [(o.luzespecular.role, o.luzespecular.sides) for o in objects] == [
        ("OBSTRUCTION", "BOTH"),
        ("OBSTRUCTION", "BOTH"),
        ("RECEIVER", "AUTO"),
    ]
    assert bpy.ops.luzespecular.select_role(role="RECEIVER") == {"FINISHED"}
    assert [o.select_get() for o in objects] == [False, False, True]
    with pytest.raises(RuntimeError, match="Select several objects"):
        bpy.ops.luzespecular.set_role()


def test_expert_numbers_reach_the_solver(addon, bpy, make):
    make.square()
    accuracy = make.quick().accuracy
    accuracy.cycles, accuracy.specular_cutoff, accuracy.threads = 3, 0.01, 1
    study = addon.study.collect(bpy.context)
    assert study.options == {"bands": 12, "max_area": 1e6, "specular_cutoff": 0.01, "threads": 1}
    assert study.solving == {"tolerance": 1e-4, "cycles": 3}
    accuracy.cycles = -1
    assert addon.study.collect(bpy.context).solving["cycles"] is None
    accuracy.fineness, accuracy.error = "ERROR", 5.0
    study = addon.study.collect(bpy.context)
    assert (study.options, study.solving) == ({"accuracy": 0.05}, {})


@pytest.mark.parametrize(
    ("operator", "group", "changes"),
    [
        ("site_preset", "site", {"latitude": 12.5, "longitude": -33.0, "north_offset": 7.0}),
        ("sky_preset", "sky", {"kind": "CIE", "cie_type": "7", "horizontal_illuminance": 4321.0, "sun_disc": True}),
        ("sky_preset", "sky", {"kind": "CLEAR", "illuminance_from": "VALUE", "horizontal_illuminance": 4321.0}),
        ("accuracy_preset", "accuracy", {"fineness": "EXPERT", "bands": 36, "max_area": 0.5, "cycles": 2}),
    ],
)
def test_presets_bring_settings_back(bpy, operator, group, changes):
    settings = getattr(bpy.context.scene.luzespecular, group)
    for name, value in changes.items():
        setattr(settings, name, value)
    call = getattr(bpy.ops.luzespecular, operator)
    assert call(name="Casa à luz") == {"FINISHED"}
    try:
        kind = getattr(bpy.types, f"LUZESPECULAR_PT_{group}_presets")
        path = bpy.utils.preset_find("Casa à luz", kind.preset_subdir, display_name=True)
        assert path
        for name in changes:
            settings.property_unset(name)
        bpy.ops.script.execute_preset(filepath=path, menu_idname=kind.__name__)
        for name, value in changes.items():
            assert getattr(settings, name) == (pytest.approx(value) if isinstance(value, float) else value), name
    finally:
        call(name="Casa à luz", remove_name=True)
    assert not bpy.utils.preset_find("Casa à luz", kind.preset_subdir, display_name=True)


def test_every_preset_value_exists(addon, bpy):
    import importlib

    presets = importlib.import_module(f"{addon.PACKAGE}.operators.presets")
    owners = {
        "site": bpy.context.scene.luzespecular.site,
        "sky": bpy.context.scene.luzespecular.sky,
        "accuracy": bpy.context.scene.luzespecular.accuracy,
        "material": bpy.data.materials.new("M").luzespecular,
    }
    for cls in presets.CLASSES:
        owner = owners[cls.preset_subdir.rpartition("/")[2]]
        assert all(hasattr(owner, value.removeprefix("settings.")) for value in cls.preset_values), cls


def test_grey_buttons_say_why():
    """Every poll of an operator that can refuse gives its reason."""
    silent = []
    for path in (ADDON / "operators").glob("*.py"):
        for cls in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(cls, ast.ClassDef) and "_OT_" in cls.name:
                for method in cls.body:
                    if isinstance(method, ast.FunctionDef) and method.name == "poll":
                        text = ast.unparse(method)
                        if "poll_message_set" not in text and "(cls, context)" not in text.split("\n", 1)[1]:
                            silent.append(cls.name)
    assert not silent
