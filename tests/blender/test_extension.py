"""The extension as Blender gets it: what the zip holds, and that switching it on and off leaves nothing behind."""

import ast
import logging
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "bl_ext.user_default.luzespecular"
WANTED = {"blender_manifest.toml", "__init__.py", "LICENSE", "README.md", "core", "luzespecular_addon"}


def test_zip_holds_only_what_it_needs(archive):
    names = [name for name in zipfile.ZipFile(archive).namelist() if not name.endswith("/")]
    assert {name.split("/")[0] for name in names} <= WANTED
    assert {
        "blender_manifest.toml",
        "__init__.py",
        "LICENSE",
        "core/__init__.py",
        "luzespecular_addon/__init__.py",
    } <= set(names)
    for name in names:
        assert name.endswith((".py", ".toml", ".md")) or name == "LICENSE", name
    sources = {
        str(path.relative_to(ROOT))
        for folder in ("core", "luzespecular_addon")
        for path in (ROOT / folder).rglob("*.py")
    }
    assert sources <= set(names)


def test_versions_agree():
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert manifest["version"] == project["project"]["version"]


def test_root_imports_without_blender():
    code = f"import importlib.util as u, sys; s = u.spec_from_file_location('root', {str(ROOT / '__init__.py')!r});"
    code += "m = u.module_from_spec(s); s.loader.exec_module(m); assert 'bpy' not in sys.modules;"
    code += "print(m.register.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "register"


def test_solver_knows_nothing_of_blender_and_the_addon_imports_relatively():
    for path in (ROOT / "core").rglob("*.py"):
        assert not _imported(path) & {"bpy", "bmesh", "mathutils", "luzespecular_addon"}, path
    for path in (ROOT / "luzespecular_addon").rglob("*.py"):
        assert not _imported(path) & {"luzespecular", "core", "luzespecular_addon"}, path


def _imported(path):
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names.add(node.module.split(".")[0])
    return names


def test_only_one_room_touches_the_buffers():
    for path in (ROOT / "luzespecular_addon").rglob("*.py"):
        if path.name != "mesh_arrays.py":
            text = path.read_text(encoding="utf-8")
            assert "foreach_" not in text.replace("``foreach_", ""), path


def test_enabled_from_the_zip(bpy, addon):
    assert PACKAGE in bpy.context.preferences.addons
    assert hasattr(bpy.types, "LUZESPECULAR_PT_solve")
    assert addon.luz.__name__ == f"{PACKAGE}.core"


def test_switching_off_leaves_nothing_behind(bpy):
    import addon_utils

    def ours():
        types = {name for name in dir(bpy.types) if "LUZESPECULAR" in name or name.startswith("Luz")}
        lists = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)]
        handlers = [
            handler
            for handlers in lists
            if isinstance(handlers, list)
            for handler in handlers
            if "luzespecular" in (getattr(handler, "__module__", None) or "")
        ]
        pointers = [
            t
            for t in ("Scene", "Screen", "Object", "Mesh", "Material", "WindowManager")
            if hasattr(getattr(bpy.types, t), "luzespecular")
        ]
        handlers += logging.getLogger(f"{PACKAGE}.core").handlers
        return types, handlers, pointers

    for _ in range(3):
        addon_utils.disable(PACKAGE, default_set=True)
        assert ours() == (set(), [], [])
        addon_utils.enable(PACKAGE, default_set=True)
        types, handlers, pointers = ours()
        assert len(types) > 10
        assert len(handlers) >= 9
        assert len(pointers) == 6


def test_switching_off_ends_what_operators_left_open(addon):
    """Blender drops running operators then without calling them; tests/gui/steps_extension.py does so in a window."""
    import addon_utils

    done = []
    ends, kept = addon.operators.loose_ends.new(), addon.operators.loose_ends.new()
    ends.callback(done.append, "second")
    ends.callback(done.append, "first")
    kept.callback(done.append, "ended by itself")
    kept.close()
    addon_utils.disable(PACKAGE, default_set=True)
    assert done == ["ended by itself", "first", "second"]
    addon_utils.enable(PACKAGE, default_set=True)


def test_failed_registration_is_undone(bpy, addon, monkeypatch):
    import importlib

    import addon_utils

    package = importlib.import_module(f"{PACKAGE}.luzespecular_addon")
    addon_utils.disable(PACKAGE, default_set=True)

    def fail():
        raise ZeroDivisionError

    monkeypatch.setattr(package.commands, "register", fail)
    with pytest.raises(ZeroDivisionError):
        package.register()
    assert not hasattr(bpy.types.Scene, "luzespecular")
    assert not hasattr(bpy.types, "LUZESPECULAR_PT_solve")
    monkeypatch.undo()
    addon_utils.enable(PACKAGE, default_set=True)


def test_panels_draw_in_every_state(addon, bpy, make):
    """Panels are drawn on a stand-in layout, since there is no window here: no missing property, no raising."""
    panels = [
        getattr(bpy.types, name)
        for name in dir(bpy.types)
        if name.startswith("LUZESPECULAR_PT_") and hasattr(getattr(bpy.types, name), "draw")
    ]
    assert len(panels) >= 12
    floor = make.square("Floor", material=make.material("Glass", use_refractive_index=True, regular_transmittance=0.8))
    settings = make.quick()

    def draw_all():
        context = _Context(bpy.context, floor, floor.data.materials[0])
        for panel in panels:
            panel.draw(_Panel(), context)
            if hasattr(panel, "draw_header_preset"):
                panel.draw_header_preset(_Panel(), context)

    bpy.context.view_layer.objects.active = floor
    draw_all()
    settings.accuracy.fineness, settings.sky.kind, settings.site.time_kind = "NORMAL", "CLEAR", "CLOCK"
    settings.site.day, settings.site.month = 31, 2
    draw_all()
    settings.site.day, settings.site.hour, settings.site.latitude = 1, 0.0, 89.0
    floor.data.materials[0].luzespecular.use_refractive_index = False
    floor.data.materials[0].luzespecular.diffuse_reflectance = 0.9
    draw_all()
    make.quick()
    floor.data.materials[0].luzespecular.source = "SHADER"
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    draw_all()
    display = settings.display
    display.unit, display.use_fixed_range, display.show_lines, display.line_levels = "FACTOR", True, True, "100 much"
    assert bpy.ops.luzespecular.add_work_plane() == {"FINISHED"}
    draw_all()
    display.line_levels, display.view = "100", "OWN"
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    draw_all()
    bpy.context.object.location.z += 1.0
    bpy.context.view_layer.update()
    draw_all()
    bpy.context.window_manager.luzespecular.running = True
    draw_all()
    bpy.context.window_manager.luzespecular.running = False
    assert bpy.ops.luzespecular.check_scene() == {"FINISHED"}
    draw_all()


def test_every_button_stands_in_a_panel(addon):
    folder = ROOT / "luzespecular_addon" / "panels"
    drawn = "".join(path.read_text(encoding="utf-8") for path in folder.glob("*.py"))
    names = [cls.bl_idname for room in addon.operators._ROOMS for cls in room.CLASSES if hasattr(cls, "bl_label")]
    assert len(names) > 15
    assert not [name for name in names if f'"{name}"' not in drawn]


class _Context:
    """A context with an object and a material, as in the properties editor."""

    def __init__(self, context, object_, material):
        self.scene, self.window_manager = context.scene, context.window_manager
        self.object, self.material = object_, material
        self.region = type("Region", (), {"width": 300})


class _Layout:
    """Takes whatever a panel draws, and checks that the properties drawn exist."""

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *args, **kwargs: _Layout()

    def prop(self, data, name, **kwargs):
        assert name in data.bl_rna.properties, name

    def label(self, text="", **kwargs):
        assert isinstance(text, str)


class _Panel:
    layout = _Layout()

    def draw_saved(self, context):
        """Blender's own drawing of saved presets needs a window."""
