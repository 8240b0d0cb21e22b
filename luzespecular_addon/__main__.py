"""The headless command with Blender's Python module: ``python luzespecular_addon scene.blend solve …``."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "luzespecular_extension"


def load_extension():
    """Import the folder above as a package, as Blender would, and enable it."""
    spec = importlib.util.spec_from_file_location(PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)])
    extension = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = extension
    spec.loader.exec_module(extension)
    extension.register()
    return importlib.import_module(f"{PACKAGE}.luzespecular_addon.commands")


def main(arguments: list[str]) -> int:
    """Open the .blend named first and run the command on it."""
    try:
        import bpy
    except ImportError:
        sys.stderr.write("Blender's Python module is missing: pip install bpy\n")
        return 1
    bpy.ops.wm.read_factory_settings(use_empty=True)
    commands = load_extension()
    if not arguments or arguments[0].startswith("-"):
        sys.stderr.write("usage: python luzespecular_addon scene.blend solve …\n")
        commands.parser().print_help(sys.stderr)
        return 0 if arguments[:1] in (["-h"], ["--help"]) else 2
    if not Path(arguments[0]).is_file():
        sys.stderr.write(f"luzespecular: there is no file {arguments[0]}\n")
        return 1
    bpy.ops.wm.open_mainfile(filepath=str(Path(arguments[0]).resolve()))
    return commands.main(arguments[1:])


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
