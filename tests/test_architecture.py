"""The floors of docs/architecture.md: each room of the solver imports only from its own floor or from below."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def floors():
    """Room -> height of its floor, from the table in the docs (the top floor is written first)."""
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    table = text.split("## The solver's floors")[1].split("## ")[0]
    rows = re.findall(r"^\| [^|]+ \| ([^|]+) \|", table, re.M)[1:]
    return {room: -height for height, row in enumerate(rows) for room in re.findall(r"`(\w+)`", row)}


def imports(path):
    """Rooms that a module imports when it is loaded (imports for type checking and inside functions are left out)."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            yield from [node.module] if node.module else [alias.name for alias in node.names]


def test_every_room_has_its_floor():
    assert set(floors()) == {path.stem for path in (ROOT / "core").glob("*.py")}


def test_rooms_import_only_from_below():
    height = floors()
    upward = [
        f"{path.stem} -> {room}"
        for path in sorted((ROOT / "core").glob("*.py"))
        for room in imports(path)
        if height[room] > height[path.stem]
    ]
    assert not upward


def test_the_solver_needs_numpy_alone():
    allowed = {"numpy", "__future__"}
    import sys

    for path in (ROOT / "core").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module]
            else:
                continue
            for name in names:
                top = name.split(".")[0]
                assert top in allowed or top in sys.stdlib_module_names, f"{path.name} imports {name}"
