"""Blender for the tests: its Python module with the built extension, back at factory settings for each test."""

import importlib
import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "bl_ext.user_default.luzespecular"
ROOMS = (
    "choices",
    "colours",
    "contours",
    "commands",
    "compass",
    "display",
    "errors",
    "export",
    "false_colour",
    "floor_grid",
    "isolines",
    "job",
    "legend",
    "library",
    "light",
    "live",
    "materials",
    "mesh_arrays",
    "notices",
    "operators",
    "pictures",
    "places",
    "pins",
    "probe",
    "render_legend",
    "results_object",
    "results_table",
    "scene_check",
    "session",
    "smoothing",
    "study",
    "sun_light",
    "translations",
    "work_planes",
    "writeback",
)

EXIT_STATUS = pytest.StashKey[int]()

if importlib.util.find_spec("bpy") is None:
    collect_ignore_glob = ["test_*.py"]


def pytest_report_header():
    if importlib.util.find_spec("bpy") is None:
        return "Blender tests: left out, Blender's Python module (bpy) is not installed"
    return None


def pytest_sessionfinish(session, exitstatus):
    session.config.stash[EXIT_STATUS] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    # As a module, Blender 4.2 crashes in its own clean-up once a property had an update function.
    if "bpy" in sys.modules and sys.modules["bpy"].app.version < (5, 0, 0):
        sys.stdout.flush()
        os._exit(config.stash.get(EXIT_STATUS, 1))


@pytest.fixture(scope="session")
def archive(tmp_path_factory):
    """The extension as it is handed to Blender, built and validated by Blender's own tool."""
    spec = importlib.util.spec_from_file_location("build_extension", ROOT / "tools" / "build_extension.py")
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    return tool.build(tmp_path_factory.mktemp("dist"), quiet=True)


@pytest.fixture(scope="session")
def blender(archive):
    """Blender with its user files in a folder of the tests' own, and the extension installed from its zip."""
    if "bpy" in sys.modules:
        pytest.skip("Blender runs already, with user files that are not the tests' own")
    with tempfile.TemporaryDirectory(prefix="luzespecular tests é ", ignore_cleanup_errors=True) as folder:
        os.environ["BLENDER_USER_RESOURCES"] = folder
        import bpy

        bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)
        assert PACKAGE in bpy.context.preferences.addons
        yield bpy


@pytest.fixture
def bpy(blender):
    """Blender at factory settings with an empty scene and the extension enabled."""
    import addon_utils

    blender.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable(PACKAGE, default_set=True)
    yield blender
    addon_utils.disable(PACKAGE, default_set=True)


@pytest.fixture
def addon(bpy):
    """The extension's rooms by name, and the solver as `luz`."""
    rooms = {name: importlib.import_module(f"{PACKAGE}.luzespecular_addon.{name}") for name in ROOMS}
    return SimpleNamespace(
        PACKAGE=f"{PACKAGE}.luzespecular_addon", luz=importlib.import_module(f"{PACKAGE}.core"), **rooms
    )


@pytest.fixture(scope="session")
def addon_arrays(blender):
    """Rooms that know arrays alone, for tests that run many times without Blender being reset between."""
    return SimpleNamespace(
        **{name: importlib.import_module(f"{PACKAGE}.luzespecular_addon.{name}") for name in ("isolines", "smoothing")}
    )


@pytest.fixture
def make(bpy):
    """Makers of scene contents."""
    return Maker(bpy)


@pytest.fixture
def solved(addon, bpy, make):
    """A floor of 2 m with a canopy of 1 m over a quarter of it, solved in a moment; returns the scene's settings."""
    make.square("Floor", size=2.0)
    make.square("Canopy", height=0.5)
    settings = make.quick(max_area=0.05)
    assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    return settings


@pytest.fixture
def shading(bpy):
    """The shading of the first 3D viewport."""
    areas = [area for window in bpy.context.window_manager.windows for area in window.screen.areas]
    views = [area for area in areas if area.type == "VIEW_3D"]
    if not views:
        pytest.skip("no viewport in this Blender")
    return views[0].spaces.active.shading


class Maker:
    """Makes objects with few words."""

    def __init__(self, bpy):
        self._bpy = bpy

    def mesh(self, name, vertices, faces, material=None):
        """An object of the given vertices and faces, linked to the scene."""
        mesh = self._bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], faces)
        return self.object(name, mesh, material)

    def object(self, name, data, material=None):
        """An object of the given data, linked to the scene."""
        made = self._bpy.data.objects.new(name, data)
        self._bpy.context.scene.collection.objects.link(made)
        if material is not None:
            data.materials.append(material)
        return made

    def square(self, name="Square", size=1.0, height=0.0, material=None):
        """A horizontal square that looks up, one corner at the origin."""
        corners = [(0, 0, height), (size, 0, height), (size, size, height), (0, size, height)]
        return self.mesh(name, corners, [(0, 1, 2, 3)], material)

    def cube(self, name="Cube", size=1.0, material=None):
        """A closed cube that looks outwards, one corner at the origin."""
        corners = [(x, y, z) for z in (0, size) for y in (0, size) for x in (0, size)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        return self.mesh(name, corners, faces, material)

    def material(self, name="Paint", **values):
        """A material with our own photometric values."""
        made = self._bpy.data.materials.new(name)
        made.luzespecular.source = "CUSTOM"
        for key, value in values.items():
            setattr(made.luzespecular, key, value)
        return made

    def quick(self, max_area=1e6, bands=12):
        """Settings that solve in a moment: uniform sky of 10,000 lx, a coarse globe, faces as given."""
        settings = self._bpy.context.scene.luzespecular
        settings.sky.kind, settings.sky.cie_type, settings.sky.horizontal_illuminance = "CIE", "5", 10_000.0
        settings.sky.use_sun, settings.sky.ground_reflectance = False, 0.0
        settings.accuracy.fineness, settings.accuracy.bands = "EXPERT", bands
        settings.accuracy.max_area = max_area
        return settings

    def look_down(self, width, height):
        """An orthographic camera 5 m above (1, 1), and pictures without any smoothing."""
        scene = self._bpy.context.scene
        scene.camera = self.object("Camera", self._bpy.data.cameras.new("Camera"))
        scene.camera.data.type, scene.camera.data.ortho_scale, scene.camera.location = "ORTHO", 2.0, (1.0, 1.0, 5.0)
        scene.render.engine, scene.cycles.samples, scene.cycles.device = "CYCLES", 1, "CPU"
        scene.cycles.use_denoising = False
        scene.render.resolution_x, scene.render.resolution_y = width, height
        scene.render.image_settings.file_format, scene.render.filter_size = "PNG", 0.01

    def rendered(self, folder):
        """Render the scene: (height, width, 3), sRGB, lowest row first."""
        render = self._bpy.context.scene.render
        render.filepath = str(folder / "rendered.png")
        self._bpy.ops.render.render(write_still=True)
        image = self._bpy.data.images.load(render.filepath)
        pixels = np.array(image.pixels[:]).reshape(render.resolution_y, render.resolution_x, 4)[..., :3]
        self._bpy.data.images.remove(image)
        return pixels
