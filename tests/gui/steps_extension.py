"""Disable, enable, update and remove the extension in the middle of work: nothing stays behind, nothing breaks.

The update is this extension once more with a higher version, installed by what Blender calls when a file is dropped.
"""

import sys
import zipfile
from pathlib import Path

import addon_utils
import bpy
from driver import PACKAGE

ID = "luzespecular"
NEWER = "99.0.0"


def steps(window):
    yield from window.open_tab()
    scene = bpy.context.scene

    # Off while results are shown and live, and a run is on its way; on again: what the file holds is still there.
    with window.override():
        assert bpy.ops.luzespecular.solve() == {"FINISHED"}
    scene.luzespecular.site.hour = 10.0  # sets the live timer going
    for way in ("solve", "check_scene", "probe"):
        with window.override():
            assert getattr(bpy.ops.luzespecular, way)("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
        yield 0.2
        addon_utils.disable(PACKAGE, default_set=True)
        yield 1.0
        window.move(600, 500)
        yield 0.5
        assert left_behind() == [], left_behind()
        window.shot(f"disabled during {way}")
        addon_utils.enable(PACKAGE, default_set=True)
        yield 0.5
        assert scene.luzespecular.results.rows
        assert not bpy.context.window_manager.luzespecular.running
    yield from window.open_tab()
    with window.override():
        assert bpy.ops.luzespecular.solve("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from window.until(lambda: not bpy.context.window_manager.luzespecular.running, 60)
    assert "10:00" in scene.luzespecular.results.title
    window.shot("enabled again")

    # An update while results are shown.
    folder = Path(sys.modules[PACKAGE].__file__).parent
    archive = newer(folder, window.folder / "update.zip")
    with window.override():  # what Blender does with a dropped file; Return is its dialog's OK
        done = bpy.ops.extensions.package_install_files("INVOKE_DEFAULT", url=str(archive), repo="user_default")
    assert done == {"RUNNING_MODAL"}, done
    yield 1.0
    window.shot("dropped")
    window.press("RET")
    manifest = folder / "blender_manifest.toml"
    yield from window.until(lambda: manifest.exists() and NEWER in manifest.read_text(encoding="utf-8"), 30)
    yield 1.0
    assert sys.modules[f"{PACKAGE}.luzespecular_addon.places"].UPDATED
    assert scene.luzespecular.results.rows
    yield from window.open_tab()
    with window.override():
        assert bpy.ops.luzespecular.solve("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from window.until(lambda: not bpy.context.window_manager.luzespecular.running, 60)
    window.shot("updated")

    # Results cleared, the extension removed: the file is as it was, and so is the folder of extensions.
    with window.override():
        assert bpy.ops.luzespecular.clear_results() == {"FINISHED"}
        repository = next(
            index
            for index, repo in enumerate(bpy.context.preferences.extensions.repos)
            if repo.module == "user_default"
        )
        assert bpy.ops.extensions.package_uninstall(repo_index=repository, pkg_id=ID) == {"FINISHED"}
    yield 1.0
    assert left_behind() == [], left_behind()
    assert not folder.exists()
    assert sorted(object_.name for object_ in scene.objects) == ["Camera", "Cube", "Light"]
    assert not scene.objects["Cube"].hide_get()
    assert not [name for name in scene.objects["Cube"].data.attributes.keys() if "luz" in name or "illum" in name]
    assert not [name for name in sys.modules if name.startswith(PACKAGE)]
    window.shot("removed")


def newer(folder, path):
    """Pack an installed extension once more with a higher version and a mark in one of its rooms."""
    with zipfile.ZipFile(path, "w") as archive:
        for file in sorted(folder.rglob("*")):
            name = str(file.relative_to(folder))
            if not file.is_file() or "__pycache__" in name:
                continue
            text = file.read_text(encoding="utf-8")
            if name == "blender_manifest.toml":
                text = "\n".join(
                    f'version = "{NEWER}"' if line.startswith("version =") else line for line in text.splitlines()
                )
            if name.endswith("places.py") and "luzespecular_addon/places" in name:
                text += "\nUPDATED = True\n"
            archive.writestr(name, text)
    return path


def left_behind():
    """Names of classes, handlers and properties of ours that Blender still knows."""
    found = [name for name in dir(bpy.types) if "LUZESPECULAR" in name or name.startswith("Luz")]
    for name in dir(bpy.app.handlers):
        handlers = getattr(bpy.app.handlers, name)
        if isinstance(handlers, list):
            found += [name for handler in handlers if ID in (getattr(handler, "__module__", None) or "")]
    for owner in ("Scene", "Screen", "Object", "Mesh", "Material", "WindowManager"):
        if hasattr(getattr(bpy.types, owner), ID):
            found.append(owner)
    return found
