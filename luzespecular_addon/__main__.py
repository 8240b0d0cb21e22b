"""The headless command with Blender's Python module: ``python luzespecular_addon scene.blend solve …``."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "luzespecular_extension"


@contextmanager
def extension() -> Iterator[ModuleType]:
    """Import the folder above as a package, as Blender would, and keep it enabled meanwhile; yields its `commands`."""
    spec = importlib.util.spec_from_file_location(PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)])
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)
    package.register()
    try:
        yield importlib.import_module(f"{PACKAGE}.luzespecular_addon.commands")
    finally:
        package.unregister()


def main(arguments: list[str]) -> int:
    """Open the .blend named first and run the command on it."""
    try:
        import bpy
    except ImportError:
        sys.stderr.write("Blender's Python module is missing: pip install bpy\n")
        return 1
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with extension() as commands:
        if not arguments or arguments[0].startswith("-"):
            sys.stderr.write("usage: python luzespecular_addon scene.blend solve …\n")
            commands.parser().print_help(sys.stderr)
            return 0 if arguments[:1] in (["-h"], ["--help"]) else 2
        if not Path(arguments[0]).is_file():
            sys.stderr.write(f"luzespecular: failed: there is no file '{arguments[0]}'\n")
            return 1
        bpy.ops.wm.open_mainfile(filepath=str(Path(arguments[0]).resolve()))
        return commands.main(arguments[1:])


if __name__ == "__main__":
    try:
        status = main(sys.argv[1:])
    except SystemExit as exit_of_the_parser:
        status = exit_of_the_parser.code
    sys.stdout.flush()
    sys.stderr.flush()
    # Straight out: as a module, Blender 4.2 crashes in its own clean-up once a property had an update function.
    os._exit(status)
