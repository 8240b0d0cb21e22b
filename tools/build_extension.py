"""Build the Blender extension from this folder and validate it, with Blender's own tool from its Python module."""

from __future__ import annotations

import argparse
import importlib.util
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def blender_tool() -> tuple[Path, Path]:
    """Return Blender's extension tool and its list of valid tags, found without importing Blender."""
    found = importlib.util.find_spec("bpy")
    if found is None or found.origin is None:
        raise SystemExit("Blender's Python module (bpy) is not installed: pip install -e '.[blender]'")
    folder = Path(found.origin).parent
    tools = sorted(folder.glob("[0-9]*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        raise SystemExit(f"no extension tool under {folder}")
    scripts = tools[-1].parents[3]
    return tools[-1], scripts / "modules" / "_bpy_internal" / "extensions" / "tags.py"


def build(output: Path, quiet: bool = False) -> Path:
    """Write ``luzespecular-<version>.zip`` into a folder and return its path; raise where Blender's tool objects."""
    tool, tags = blender_tool()
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["version"]
    output.mkdir(parents=True, exist_ok=True)
    archive = output.resolve() / f"luzespecular-{version}.zip"
    for command in (
        ("validate", "--valid-tags", str(tags), str(ROOT)),
        ("build", "--valid-tags", str(tags), "--source-dir", str(ROOT), "--output-filepath", str(archive)),
        ("validate", "--valid-tags", str(tags), str(archive)),
    ):
        done = subprocess.run([sys.executable, str(tool), *command], capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"Blender's extension tool objects to '{command[0]}':\n{done.stdout}{done.stderr}")
        if not quiet:
            print(done.stdout, end="")
    return archive


def main() -> int:
    """Read the command line and build."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "dist", help="folder for the archive (default: dist)")
    print(build(parser.parse_args().output))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
