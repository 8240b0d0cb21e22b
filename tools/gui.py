"""Drive a real Blender window: build the extension, install it in a passing user folder, run a file of steps.

    python tools/gui.py --blender /path/to/blender                       all of tests/gui
    python tools/gui.py --blender … tests/gui/steps_pictures.py --output docs/images

Needs a display, or ``xvfb-run`` to make one. Nothing of the user's own Blender is read or changed. Pictures go to
``build/gui`` unless told otherwise. Exit status 0 only if every step of every file was done.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import build_extension

ROOT = build_extension.ROOT
DRIVER = ROOT / "tests" / "gui" / "driver.py"
SIZE = (1600, 1000)


def run(blender: str, steps: Path, output: Path, archive: Path, size: tuple[int, int] = SIZE) -> bool:
    """Run one file of steps in a window of its own; tell whether all went well."""
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="luzespecular ") as folder:
        environment = {**os.environ, "BLENDER_USER_RESOURCES": folder}
        install = [blender, "--command", "extension", "install-file", "-r", "user_default", "-e", str(archive)]
        if subprocess.run(install, env=environment, check=False).returncode:
            return False
        command = [blender, "--enable-event-simulate", "--window-geometry", "0", "0", *map(str, size)]
        command += ["--python-exit-code", "3", "--python", str(DRIVER), "--", str(steps.resolve()), str(output)]
        if "DISPLAY" not in os.environ and "WAYLAND_DISPLAY" not in os.environ:
            if shutil.which("xvfb-run") is None:
                raise SystemExit("There is no display, and no xvfb-run to make one: install xvfb")
            command = ["xvfb-run", "-a", "-s", f"-screen 0 {size[0]}x{size[1]}x24", *command]
        return subprocess.run(command, env=environment, check=False).returncode == 0


def _size(text: str) -> tuple[int, int]:
    width, height = map(int, text.split("x"))
    return width, height


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("steps", type=Path, nargs="*", help="files of steps (default: all of tests/gui)")
    parser.add_argument("--blender", default="blender", help="Blender's program (default: blender)")
    parser.add_argument("--archive", type=Path, help="an extension built before (default: build this folder's)")
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "gui", help="folder for pictures")
    parser.add_argument("--size", type=_size, default=SIZE, help="of the window in pixels (default: 1600x1000)")
    options = parser.parse_args()
    archive = options.archive or build_extension.build(ROOT / "build" / "gui", quiet=True)
    files = options.steps or sorted(DRIVER.parent.glob("steps_*.py"))
    output, size = options.output.resolve(), options.size
    failed = [str(steps) for steps in files if not run(options.blender, steps, output, archive, size)]
    for steps in failed:
        print(f"failed: {steps}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
