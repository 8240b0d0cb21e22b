"""The package's face: its names are what they say, whatever is imported besides."""

import subprocess
import sys
from pathlib import Path

import luzespecular as luz

ROOT = Path(__file__).resolve().parents[2]


def test_no_room_hides_a_public_name():
    """Rooms may bear a function's name (`solve`, `availability`): importing them must leave the function in place."""
    rooms = sorted(path.stem for path in (ROOT / "core").glob("*.py") if path.stem != "__init__")
    lines = [
        "import importlib, luzespecular.availability, luzespecular.solve",
        "import luzespecular as luz",
        f"for room in {rooms!r}: importlib.import_module('luzespecular.' + room)",
        "modules = [name for name in luz.__all__ if type(getattr(luz, name)).__name__ == 'module']",
        "assert not modules, modules",
        "assert luz.availability('overcast', 90.0) == (0.0, 21300.0)",
    ]
    done = subprocess.run([sys.executable, "-c", "\n".join(lines)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_every_public_name_says_what_it_is():
    assert [name for name in luz.__all__ if name != "__version__" and not getattr(luz, name).__doc__] == []
    assert sorted(luz.__all__) == sorted(set(luz.__all__))
