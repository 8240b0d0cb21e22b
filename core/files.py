"""Files: scenes as plain JSON in; tables, JSON and arrays out, each of which appears only when it is complete."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from .errors import SceneError
from .materials import Material
from .scene import Scene
from .writing import complete


@dataclass(frozen=True, eq=False)
class Points:
    """Free points that illuminance is wanted at, such as the grid of a work plane.

    Attributes
    ----------
    positions, normals : (m, 3) float
        [m]; normals of any length but zero.
    """

    positions: np.ndarray
    normals: np.ndarray


@dataclass(frozen=True, eq=False)
class SceneFile:
    """What a scene file holds.

    Attributes
    ----------
    scene : Scene
    points : dict of str to Points
    """

    scene: Scene
    points: dict[str, Points]


def read_scene(path: Path) -> SceneFile:
    """Read a scene from a JSON file.

    Parameters
    ----------
    path : Path
        UTF-8. An object of ``materials`` (by name, with the parameters of `Material`), ``surfaces`` (a list of
        objects with ``name``, ``vertices`` [m], ``material``, and where wanted ``faces`` and ``two_sided``, as in
        `Scene.add`) and, where wanted, ``points`` (a list of objects with ``name``, ``positions`` [m] and ``normal``).

    Returns
    -------
    SceneFile

    Raises
    ------
    SceneError
        Where the file is no JSON, or something in it is missing, unknown, twice there or not as it must be.
    OSError
        Where the file cannot be read.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8-sig"), object_pairs_hook=_once)
        return _scene_file(content)
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from None
    except (ValueError, OverflowError, RecursionError) as error:  # what the readers of JSON and UTF-8 raise
        raise SceneError(f"{path}: this is no JSON file in UTF-8 that can be read: {error}") from None


def _scene_file(content: Any) -> SceneFile:
    _check_keys(content, "The file", {"surfaces"}, {"materials", "points"})
    materials = {}
    given = content.get("materials", {})
    if not isinstance(given, dict):
        raise SceneError("'materials' must be an object: a name and its values for each material")
    for name, values in given.items():
        _check_keys(values, f"Material '{name}'", set(), {field.name for field in fields(Material)})
        try:
            materials[name] = Material(**values)
        except SceneError as error:
            raise SceneError(f"Material '{name}': {str(error).removeprefix('Material: ')}") from None
    scene = Scene()
    for row, name, entry in _entries(content, "surfaces", {"vertices", "material"}, {"faces", "two_sided"}):
        material = entry["material"]
        if not isinstance(material, str) or material not in materials:
            known = ", ".join(map(repr, materials)) or "none"
            raise SceneError(f"{row}: there is no material {material!r}; 'materials' has: {known}")
        if not isinstance(entry.get("two_sided", False), bool):
            raise SceneError(f"{row}: two_sided must be true or false, not {entry['two_sided']!r}")
        scene.add(
            name,
            entry["vertices"],
            materials[material],
            faces=entry.get("faces"),
            two_sided=entry.get("two_sided", False),
        )
    points: dict[str, Points] = {}
    for row, name, entry in _entries(content, "points", {"positions", "normal"}, set()):
        if name in points:
            raise SceneError(f"{row} is there already; give each set of points a name of its own")
        positions = _vectors(f"{row}: positions", entry["positions"])
        normals = _vectors(f"{row}: normal", [entry["normal"]])
        if not normals.any():
            raise SceneError(f"{row}: normal has no length; [0, 0, 1] looks up")
        points[name] = Points(positions, np.broadcast_to(normals, positions.shape))
    return SceneFile(scene, points)


def _entries(content: dict, key: str, needed: set[str], allowed: set[str]) -> Iterator[tuple[str, Any, dict]]:
    """Yield what messages call it, name and values of each entry of a list."""
    entries = content.get(key, [])
    if not isinstance(entries, list):
        raise SceneError(f"'{key}' must be a list of objects")
    for number, entry in enumerate(entries):
        _check_keys(entry, f"Entry {number} of '{key}'", {"name", *needed}, allowed)
        if not isinstance(entry["name"], str):
            raise SceneError(f"Entry {number} of '{key}': name must be a text, not {entry['name']!r}")
        yield f"{key.removesuffix('s').capitalize()} '{entry['name']}'", entry["name"], entry


def _check_keys(entry: Any, what: str, needed: set[str], allowed: set[str]) -> None:
    if not isinstance(entry, dict):
        raise SceneError(f"{what} must be an object, {{…}}, not {type(entry).__name__}")
    missing, unknown = sorted(needed - set(entry)), sorted(set(entry) - needed - allowed)
    if missing:
        raise SceneError(f"{what} has no '{missing[0]}'; add it")
    if unknown:
        raise SceneError(
            f"{what} has an unknown entry '{unknown[0]}'; known are: {', '.join(sorted(needed | allowed))}"
        )


def _vectors(name: str, values: Any) -> np.ndarray:
    try:
        array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise SceneError(f"{name} must be rows of three numbers") from None
    if array.ndim != 2 or array.shape[1] != 3 or not np.isfinite(array).all():
        raise SceneError(f"{name} must be rows of three finite numbers")
    return array


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse what JSON readers let pass: the same key twice, of which one would be lost."""
    entries = dict(pairs)
    for key, _ in pairs if len(entries) < len(pairs) else ():
        if sum(key == other for other, _ in pairs) > 1:
            raise SceneError(f"'{key}' is there twice in one object; rename or remove one")
    return entries


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[str | float]]) -> Path:
    """Write a CSV file (UTF-8 with signature, so that spreadsheets read accents); NaN becomes an empty cell."""
    with complete(path) as unfinished, unfinished.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows([cell if isinstance(cell, str) else _number(cell) for cell in row] for row in rows)
    return path


def write_json(path: Path, content: Any) -> Path:
    """Write a JSON file; NaN becomes null."""
    with complete(path) as unfinished, unfinished.open("w", encoding="utf-8") as file:
        json.dump(_without_nan(content), file, ensure_ascii=False, allow_nan=False)
    return path


def write_arrays(path: Path, arrays: Mapping[str, np.ndarray]) -> Path:
    """Write NumPy's own .npz; read it with ``numpy.load(path)``."""
    with complete(path) as unfinished, unfinished.open("wb") as file:
        np.savez_compressed(file, **dict(arrays))
    return path


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.7g}"


def _without_nan(content: Any) -> Any:
    if isinstance(content, dict):
        return {key: _without_nan(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [_without_nan(value) for value in content]
    return None if isinstance(content, float) and np.isnan(content) else content
