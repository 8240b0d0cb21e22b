"""Random input, by number: each is refused in words or taken and sound, see `test_faults` and benchmarks/fuzz.py."""

from __future__ import annotations

import contextlib
import io
import json
import math
import random
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from builders import UNIFORM, prepare_coarse

import luzespecular as luz
from luzespecular import cli, files, polygons

GREY = luz.Material(diffuse_reflectance=0.5)
SOUND = {
    "materials": {"white": {"diffuse_reflectance": 0.5}, "glass": {"regular_transmittance": 0.8}},
    "surfaces": [
        {"name": "floor", "material": "white", "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]},
        {
            "name": "mesh",
            "material": "glass",
            "two_sided": True,
            "vertices": [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
            "faces": [[0, 1, 2], [0, 2, 3]],
        },
    ],
    "points": [{"name": "desk", "positions": [[0.5, 0.5, 0.1]], "normal": [0, 0, 1]}],
}
ODD = (None, True, -1, 0, 1e308, -1e308, math.nan, math.inf, "x", [], {}, [[]], [[0, 0, 0]], 1e-320, 10**400)


def trial(number: int, folder: Path) -> None:
    """Run one; raises where something is wrong."""
    one_of(TRIALS[number % len(TRIALS)], number, folder)


def one_of(kind: Callable, number: int, folder: Path) -> None:
    """Run one of a kind."""
    with np.errstate(divide="raise", invalid="raise"):
        kind(random.Random(number), np.random.default_rng(number), folder)


def read(path: Path) -> None:
    """Read a scene file, check what it holds and solve it; refusals name the file."""
    try:
        scene = files.read_scene(path).scene
    except luz.SceneError as error:
        assert path.name in str(error)
        return
    sound(scene, solve=False)


def sound(scene: luz.Scene, solve: bool) -> None:
    """The scene check, and what comes of a solution: finite or refused."""
    luz.check(scene)
    if not solve:
        return
    try:
        result = prepare_coarse(scene, elements=20, patches=10, bands=4).solve(UNIFORM)
    except luz.SceneError:
        return
    assert np.isfinite(result.illuminance).all() and (result.illuminance >= 0).all()


def bytes_changed(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    text = bytearray(json.dumps(SOUND).encode())
    for _ in range(chance.randrange(1, 8)):
        text[chance.randrange(len(text))] = chance.randrange(256)
    path = folder / "scene.json"
    path.write_bytes(bytes(text[: len(text) - chance.choice((0, 0, chance.randrange(len(text))))]))
    read(path)


def bytes_alone(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    path = folder / "noise.json"
    path.write_bytes(rng.bytes(chance.randrange(300)))
    read(path)


def values_changed(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    path = folder / "values.json"
    path.write_text(json.dumps(changed(SOUND, chance)), encoding="utf-8")
    read(path)


def changed(value, chance: random.Random):
    """A JSON value with parts exchanged for odd ones, lost or doubled."""
    if chance.random() < 0.08:
        return chance.choice(ODD)
    if isinstance(value, dict):
        kept = {k: v for k, v in value.items() if chance.random() > 0.03}
        return {(key if chance.random() > 0.03 else key + "x"): changed(v, chance) for key, v in kept.items()}
    if isinstance(value, list):
        kept = [changed(v, chance) for v in value if chance.random() > 0.04]
        return [*kept, chance.choice(kept)] if kept and chance.random() < 0.1 else kept
    if isinstance(value, int | float) and not isinstance(value, bool) and chance.random() < 0.3:
        return value + chance.choice([1e-9, 1e-3, 0.5, -1, 1e6, 1e150])
    return value


def mesh(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    """Random faces of random vertices: on a lattice, in a plane, or anywhere; some are solved as well."""
    vertices = rng.normal(size=(chance.randrange(3, 12), 3)) * 10.0 ** chance.randrange(-8, 9)
    if chance.random() < 0.5:
        vertices = np.rint(rng.normal(size=vertices.shape) * 2)
    if chance.random() < 0.3:
        vertices[:, 2] = 0
    faces = [
        [chance.randrange(len(vertices)) for _ in range(chance.randrange(3, 7))] for _ in range(chance.randrange(1, 15))
    ]
    material = luz.Material(diffuse_reflectance=0.5, specular_reflectance=chance.choice([0, 0.4]))
    scene = luz.Scene()
    try:
        scene.add("mesh", vertices, material, faces=faces, two_sided=chance.random() < 0.5)
    except luz.SceneError as error:
        assert "'mesh'" in str(error)
        return
    assert scene.surfaces["mesh"].source_faces.max() < len(faces)
    sound(scene, solve=chance.random() < 0.05)


def one_polygon(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    """Polygons on a small lattice, so that corners repeat, lie on edges and touch; their area is what was drawn."""
    flat = rng.integers(0, 5, (chance.randrange(3, 9), 2)).astype(float)
    size = 10.0 ** chance.randrange(-6, 7)
    scene = luz.Scene()
    try:
        surface = scene.add("bad", size * np.c_[flat, np.zeros(len(flat))], GREY)
    except luz.SceneError as error:
        assert "'bad'" in str(error)
        return
    x, y = flat.T
    drawn = abs(0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
    assert polygons.areas(surface.pieces).sum() == pytest.approx(drawn * size**2, rel=1e-6)
    sound(scene, solve=chance.random() < 0.1)


@cache
def saved(folder: Path) -> tuple[luz.Scene, bytes]:
    """A scene and the file of its transfer."""
    scene = luz.Scene()
    scene.add("floor", SOUND["surfaces"][0]["vertices"], GREY)
    scene.add("wall", [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], GREY)
    return scene, luz.prepare(scene, bands=2, max_area=math.inf).save(folder / "whole").read_bytes()


def kept(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    """A saved transfer with bytes changed, or cut off: it is refused, or all that it holds is as it was."""
    scene, whole = saved(folder)
    path, content = folder / "kept", bytearray(whole)
    for _ in range(chance.randrange(1, 6)):
        content[chance.randrange(len(content))] = chance.randrange(256)
    path.write_bytes(bytes(content[: len(content) - chance.choice((0, 0, chance.randrange(len(content))))]))
    try:
        loaded = luz.load(path, scene)
    except luz.TransferFileError as error:
        assert "kept" in str(error)
        return
    assert np.isfinite(loaded.solve(UNIFORM).illuminance).all()


def command(chance: random.Random, rng: np.random.Generator, folder: Path) -> None:
    """A table, a picture or an archive where the command wants a scene."""
    path = folder / chance.choice(("table.csv", "archive.npz", "scene.json"))
    if path.suffix == ".npz":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("a.npy", rng.bytes(40))
    elif path.suffix == ".csv":
        files.write_csv(path, ["surface", "lux"], [["floor", 1.0]] * chance.randrange(5))
    else:
        path.write_bytes(rng.bytes(chance.randrange(2000)))
    arguments = ["solve", str(path), "--out", str(folder / "out"), "--latitude", "-27", "--date", "2026-06-22"]
    with contextlib.redirect_stderr(io.StringIO()) as said:
        assert cli.main(arguments) == 2
    assert path.name in said.getvalue()
    assert not (folder / "out").exists()


TRIALS = (*5 * (bytes_changed, values_changed, mesh, one_polygon, mesh, one_polygon), bytes_alone, kept, command)
