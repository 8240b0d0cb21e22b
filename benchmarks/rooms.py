"""Rooms of the performance benchmark: the light-shelf room, and what grows out of it."""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import sys
from collections.abc import Iterator
from unittest import mock

import numpy as np
from apart import ROOT

import luzespecular as luz
from luzespecular import fracture, geometry

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.9)

_BOX_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


@contextlib.contextmanager
def coarsely() -> Iterator[None]:
    """Few receivers and patches, whatever is asked for: only to see that things run."""
    with (
        mock.patch.object(fracture, "FEWEST_ELEMENTS", 100),
        mock.patch.object(fracture, "ELEMENTS_PER_PLAIN_SURFACE", 10),
        mock.patch.object(geometry, "PATCHES", 60),
    ):
        yield


@functools.cache
def light_shelf_room():
    """The module of ``examples/light_shelf/room.py``: geometry, materials and hours of the light-shelf room."""
    spec = importlib.util.spec_from_file_location("light_shelf_room", ROOT / "examples" / "light_shelf" / "room.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def paler() -> luz.Scene:
    """The room with its mirror shelf, its diffuse reflectances lowered by a tenth."""
    room, scene = light_shelf_room(), luz.Scene()
    for name, vertices in room.SURFACES.items():
        rho = room.REFLECTANCE[name]
        specular = name in room.VARIANTS["S1"].specular
        material = luz.Material(specular_reflectance=rho) if specular else luz.Material(diffuse_reflectance=0.9 * rho)
        scene.add(name, vertices, material)
    return scene


def shell(**materials: luz.Material) -> luz.Scene:
    """The room without its shelf, all diffuse but for what is given by surface."""
    room, scene = light_shelf_room(), luz.Scene()
    for name, vertices in room.SURFACES.items():
        if not name.startswith("shelf"):
            usual = luz.Material(diffuse_reflectance=room.REFLECTANCE[name])
            scene.add(name, vertices, materials.get(name, usual))
    return scene


def with_boxes(count: int) -> luz.Scene:
    """The room with boxes of 0.3 m hung in it on a grid, each turned by an angle of its own."""
    scene = shell()
    side = max(1, int(np.ceil(count ** (1 / 3) - 1e-9)))
    for k in range(count):
        place = np.array([k % side, k // side % side, k // side**2])
        centre = 3.0 * (place + 0.5) / side
        angle = 0.3 + 0.7 * k
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        corners = np.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]) * 0.15
        scene.add(f"box {k}", centre + corners @ turn.T, WHITE, faces=[list(face) for face in _BOX_FACES])
    return scene


def with_ball(rings: int) -> luz.Scene:
    """The room with a ball of 1.2 m hung in it, whose facets all receive: twice the square of its rings."""
    scene = shell()
    polar, turn = np.pi * np.arange(rings + 1) / rings, np.pi * np.arange(2 * rings) / rings
    level = np.sin(polar)[:, None]
    up = np.broadcast_to(np.cos(polar)[:, None], (rings + 1, 2 * rings))
    corners = np.stack([level * np.cos(turn), level * np.sin(turn), up], axis=2)
    below, after = np.roll(corners, -1, axis=0)[:-1], np.roll(corners, -1, axis=1)
    quads = np.stack([corners[:-1], below, np.roll(below, -1, axis=1), after[:-1]], axis=2).reshape(-1, 4, 3)
    caps = 2 * rings
    pieces = [quads[:caps, :3], quads[caps:-caps], quads[-caps:][:, [0, 1, 3]]]
    vertices = 0.6 * np.concatenate([piece.reshape(-1, 3) for piece in pieces]) + [1.5, 1.4, 1.2]
    first, faces = 0, []
    for piece in pieces:
        sides = piece.shape[1]
        faces += (first + np.arange(len(piece) * sides).reshape(-1, sides)).tolist()
        first += len(piece) * sides
    scene.add("ball", vertices, WHITE, faces=faces)
    return scene


def with_shelf_of(count: int) -> luz.Scene:
    """The room with its light shelf cut in strips, each a mirror of its own plane, a centimetre above the last."""
    room, scene = light_shelf_room(), shell()
    scene.add("shelf_bottom", room.SURFACES["shelf_bottom"], luz.Material(diffuse_reflectance=0.8))
    edges = np.linspace(0, room.SIZE, count + 1)
    inner = room.SIZE - room.SHELF_DEPTH
    for k in range(count):
        a, b, z = edges[k], edges[k + 1], room.SHELF_TOP + 0.01 * k
        corners = [(a, inner, z), (b, inner, z), (b, room.SIZE, z), (a, room.SIZE, z)]
        scene.add(f"strip {k}", corners, MIRROR)
    return scene


def closed() -> luz.Scene:
    """The room without its shelf, its opening closed by a luminous panel."""
    scene, corners = shell(), light_shelf_room().SURFACES
    opening = [corners["sill"][2], corners["sill"][1], corners["lintel"][0], corners["lintel"][3]]
    scene.add("panel", opening, luz.Material(diffuse_reflectance=0.5, exitance=1000.0))
    return scene


def between_mirrors() -> luz.Scene:
    """The room with mirrors for its west and east walls, which face each other."""
    return shell(wall_west=MIRROR, wall_east=MIRROR)


def cutoff_for(depth: int) -> float:
    """``specular_cutoff`` that ends chains between mirrors of `between_mirrors` after so many reflections."""
    return MIRROR.specular_reflectance ** (depth + 0.5)
