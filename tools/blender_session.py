"""Blender from its Python module, apart from the user's own Blender, with this checkout's extension installed in it."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import build_extension

PACKAGE = "bl_ext.user_default.luzespecular"


@contextmanager
def session() -> Iterator[None]:
    """Build the extension, start Blender with its user files in a passing folder, install the archive and enable it.

    Call it before anything imports ``bpy``: Blender reads the place of its user files only once.
    """
    if "bpy" in sys.modules:
        raise RuntimeError("Blender runs already: start the session before importing bpy")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["BLENDER_USER_RESOURCES"] = folder
        archive = build_extension.build(Path(folder), quiet=True)
        import bpy  # first: it makes Blender's own modules known

        import addon_utils  # isort: skip

        bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)
        if PACKAGE not in bpy.context.preferences.addons:
            raise RuntimeError("Blender did not enable the extension; its messages above say why")
        bpy.context.preferences.filepaths.save_version = 0  # no .blend1 beside what is saved
        try:
            yield
        finally:  # while its files are still there
            addon_utils.disable(PACKAGE, default_set=True)


def enable() -> None:
    """Enable the extension again, after Blender went back to factory settings."""
    import addon_utils

    addon_utils.enable(PACKAGE, default_set=True)
