"""Equilibrium: where everything shines with the share of an even field that it absorbs, the field stays as it is.

Surroundings of luminance L all around, sky and ground alike, and surfaces of exitance a·π·L, a being their absorptance:
whatever their shape, reflectance and number, all receivers get π·L (Kirchhoff). So do those in closed rooms without any
sky. Nothing of the solver is left out: what is lost, counted twice or leaks shows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import DARK, box_polygons
from situations import GLOBE, Outcome, Situation, all_of, near, solved

import luzespecular as luz

LUMINANCE = 1000.0
FIELD = math.pi * LUMINANCE
AROUND = luz.Daylight(sky=luz.UniformSky(LUMINANCE), ground_reflectance=1.0)
AS_COARSE = 5e-3
"""What means over areas err by on so few receivers and so coarse a globe, where boxes stand in a room."""

LEAST = 2e-3
"""What chains of mirrors that are cut off, and light too faint to be looked for, may take of the field."""


def warm(diffuse=0.0, specular=0.0, through=0.0) -> luz.Material:
    """A material that shines with what it absorbs of the field."""
    return luz.Material(
        diffuse_reflectance=diffuse,
        specular_reflectance=specular,
        regular_transmittance=through,
        exitance=max(0.0, 1 - diffuse - specular - through) * FIELD,
    )


def clear(index: float) -> luz.Material:
    """A pane that swallows nothing."""
    r = ((index - 1) / (index + 1)) ** 2
    return luz.Material(refractive_index=index, regular_transmittance=(1 - r) ** 2 / (1 - r**2))


def even(scene, light=AROUND, points=None, allowed: float = LEAST, **options) -> Outcome:
    """All faces, fronts and backs, and free points get the field."""
    result = solved(scene, light, **{"elements": 200, "patches": 100, "bands": 24, **options})
    outcomes = [near(result.illuminance, np.full(len(result.areas), FIELD), allowed)]
    if result.back is not None:
        behind = result.back.illuminance[~np.isnan(result.back.illuminance)]
        outcomes.append(near(behind, np.full(len(behind), FIELD), allowed))
    if points is not None:
        normals = np.random.default_rng(5).normal(size=(len(points), 3))
        outcomes.append(near(result.at(points, normals), np.full(len(points), FIELD), GLOBE))
    return all_of(*outcomes)


def plates(materials, seed: int, count: int = 5) -> luz.Scene:
    """Rectangles of both sides, anywhere and at any angle; they may cross each other."""
    rng = np.random.default_rng(seed)
    scene = luz.Scene()
    for k in range(count):
        axes = np.linalg.qr(rng.normal(size=(3, 3)))[0][:2] * rng.uniform(0.5, 2, (2, 1))
        place = rng.uniform(-1.5, 1.5, 3)
        corners = place + np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) @ axes
        scene.add(f"plate {k}", corners, materials[k % len(materials)], two_sided=True)
    return scene


def closed(material, size=(3, 2, 2.5), **others) -> luz.Scene:
    scene = luz.Scene()
    for name, polygon in box_polygons(size).items():
        scene.add(name, polygon, others.get(name, material))
    return scene


def solid(scene, name, low, size, material) -> None:
    """A box seen from outside."""
    for side, polygon in box_polygons(size, low).items():
        scene.add(f"{name} {side}", polygon[::-1], material)


def furnished(material, piece, count: int = 2) -> luz.Scene:
    scene = closed(material)
    for k in range(count):
        solid(scene, f"box {k}", (0.4 + 1.3 * k, 0.5 + 0.3 * k, 0.2), (0.7, 0.6, 0.8 + 0.5 * k), piece)
    return scene


def louvres(material, slats: int = 6) -> luz.Scene:
    """Slats of both sides in an opening, and a room behind."""
    scene = luz.Scene()
    for name, polygon in box_polygons((2, 2, 1.2)).items():
        if name != "north":
            scene.add(name, polygon, warm(0.6), two_sided=True)
    for k in range(slats):
        z = 0.1 + 0.2 * k
        scene.add(f"slat {k}", [[0, 2, z], [2, 2, z], [2, 2.15, z + 0.1], [0, 2.15, z + 0.1]], material, two_sided=True)
    return scene


def in_glass(material, boxes: int = 1) -> luz.Scene:
    """A plate within boxes of glass, one in the other."""
    scene = luz.Scene()
    for k in range(boxes):
        size = 2.0 + k
        for name, polygon in box_polygons((size,) * 3, (-size / 2,) * 3).items():
            scene.add(f"glass {k} {name}", polygon, material, two_sided=True)
    scene.add("plate", [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0.2], [-0.5, 0.5, 0.2]], warm(0.5), two_sided=True)
    return scene


def corridor(material) -> luz.Scene:
    """Three rooms in a row with doors between: closed."""
    scene = luz.Scene()
    for k in range(3):
        for name, polygon in box_polygons((2, 3, 2.5), (2.0 * k, 0, 0)).items():
            inner = (name == "east" and k < 2) or (name == "west" and k > 0)
            if not inner:
                scene.add(f"{name} {k}", polygon, material)
            elif name == "west":
                door = [[0, 1, 0], [0, 1, 2], [0, 2, 2], [0, 2, 0]]
                loop = np.array([*polygon[:1], *door, *polygon[1:]], float) - [0, 0, 0]
                loop[1:5, 0] = 2.0 * k
                scene.add(f"wall {k}", loop, material, two_sided=True)
    return scene


def ball(material, inward: bool) -> luz.Scene:
    """An icosphere of 80 facets, one mesh."""
    phi = (1 + math.sqrt(5)) / 2
    corner = np.array([[-1, phi, 0], [1, phi, 0], [-1, -phi, 0], [1, -phi, 0]], float)
    corner = np.concatenate([corner, corner[:, [2, 0, 1]], corner[:, [1, 2, 0]]])
    corner /= np.linalg.norm(corner[0])
    near_ = np.linalg.norm(corner[:, None] - corner, axis=2)
    edge = np.sort(np.unique(near_.round(6)))[1]
    faces = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if max(near_[a, b], near_[b, c], near_[a, c]) < edge + 1e-3:
                    faces.append((a, b, c))
    triangles = corner[np.array(faces)]
    middle = 0.5 * (triangles + np.roll(triangles, -1, axis=1))
    middle /= np.linalg.norm(middle, axis=2, keepdims=True)
    a, b, c = np.moveaxis(triangles, 1, 0)
    ab, bc, ca = np.moveaxis(middle, 1, 0)
    parts = np.concatenate([np.stack(p, axis=1) for p in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    outward = np.einsum("tc,tc->t", np.cross(parts[:, 1] - parts[:, 0], parts[:, 2] - parts[:, 0]), parts.mean(axis=1))
    parts[(outward > 0) == inward] = parts[(outward > 0) == inward][:, ::-1]
    scene = luz.Scene()
    scene.add("ball", parts.reshape(-1, 3), material, faces=np.arange(3 * len(parts)).reshape(-1, 3))
    return scene


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("energy", f"equilibrium: {name}", run, long)

    inside = np.random.default_rng(1).uniform(-1, 1, (6, 3))
    white = luz.Material(diffuse_reflectance=1.0)
    for name, materials in {
        "white plates": [white],
        "grey plates": [warm(0.5), warm(0.1)],
        "perfect mirrors": [warm(0, 1.0), white],
        "mirrors and grey plates": [warm(0, 0.7), warm(0.6), warm(0.2, 0.5)],
        "panes and grey plates": [warm(0, 0.1, 0.8), warm(0.5)],
        "clear panes by Fresnel": [clear(1.52), warm(0.5)],
        "all sorts": [warm(0, 0.9), clear(1.8), warm(0.3, 0.2, 0.4), warm(0.95)],
    }.items():
        yield row(f"{name} in the open", lambda m=materials: even(plates(m, 7), points=inside))
    crossing = [warm(0.5), warm(0.2, 0.6)]
    for name, count, allowed in (("four", 4, LEAST), ("six", 6, LEAST), ("twelve", 12, AS_COARSE)):
        yield row(
            f"{name} plates that cross",
            lambda n=count, a=allowed: even(plates(crossing, 3, n), points=inside, allowed=a),
            count > 4,
        )
    within = inside * 0.3 + [1.5, 1.0, 1.9]
    yield row("a closed room of mixed walls", lambda: even(closed(warm(0.7), floor=warm(0.1)), DARK, within))
    yield row("a closed room with a mirror", lambda: even(closed(warm(0.7), west=warm(0, 0.8)), DARK, within))
    between = warm(0.2, 0.1, 0.5)
    yield row("two mirrors and a partly diffuse pane between", lambda: even(_facing(between), DARK, within), True)
    for name, wall, piece in (
        ("grey boxes", warm(0.7), warm(0.3)),
        ("mirror boxes", warm(0.5), warm(0, 0.7)),
        ("white boxes", warm(0.3), white),
    ):
        yield row(f"a closed room with {name}", lambda w=wall, p=piece: even(furnished(w, p), DARK, within, AS_COARSE))
    yield row("a room behind grey slats", lambda: even(louvres(warm(0.5))))
    yield row(
        "a room behind mirror slats", lambda: even(louvres(warm(0, 0.6)), specular_cutoff=1e-2, allowed=1e-2), True
    )
    yield row("a plate in a box of glass", lambda: even(in_glass(warm(0, 0, 0.8)), points=0.6 * inside))
    yield row("a plate in a box of Fresnel's glass", lambda: even(in_glass(clear(1.52)), points=0.6 * inside), True)
    yield row("a plate in two boxes of glass", lambda: even(in_glass(warm(0, 0, 0.7), 2), points=0.6 * inside), True)
    yield row("three rooms with doors", lambda: even(corridor(warm(0.6)), DARK))
    yield row("a ball from inside", lambda: even(ball(warm(0.8), True), DARK, 0.3 * inside))
    yield row(
        "a ball from outside", lambda: even(ball(warm(0.8), False), AROUND, 2 * inside / np.abs(inside).max(1)[:, None])
    )
    yield row("a ball in a room", lambda: even(_ball_in_a_room(white), DARK, within), True)
    yield row("a luminous mirror ball in a room", lambda: even(_ball_in_a_room(warm(0, 0.6)), DARK, within))
    finer = _ball_in_a_room(warm(0, 0.6), True)
    yield row("a luminous ball of 320 mirrors in a room", lambda: even(finer, DARK, within), True)
    between = 1.3 * inside / np.linalg.norm(inside, axis=1, keepdims=True)
    yield row("a ball of 320 in another", lambda: even(_ball_in_a_ball(), DARK, between, max_area=None), True)
    yield row("a ball of 320 in another with a hole", lambda: even(_ball_in_a_ball(True), AROUND, between), True)


def _facing(pane: luz.Material) -> luz.Scene:
    scene = closed(warm(0.5), west=warm(0, 0.9), east=warm(0, 0.9))
    scene.add("pane", [[1.4, 0, 0], [1.4, 2, 0], [1.4, 2, 2.5], [1.4, 0, 2.5]], pane, two_sided=True)
    return scene


def _in_four(facets: np.ndarray) -> np.ndarray:
    """Facets of a ball ``(f, 3, 3)``, each cut in four and pushed out."""
    middles = 0.5 * (facets + np.roll(facets, -1, axis=1))
    before = np.roll(middles, 1, axis=1)
    parts = np.concatenate([middles, *np.stack([facets, middles, before], axis=2).swapaxes(0, 1)])
    return parts / np.linalg.norm(parts, axis=2, keepdims=True)


def _ball_in_a_ball(hole: bool = False) -> luz.Scene:
    """Of 320 facets each, the outer one seen from inside; a hole in its top lets the field in."""
    facets = _in_four(ball(warm(), False).surfaces["ball"].pieces)
    outer = 2 * facets[facets[:, :, 2].mean(axis=1) < 0.85, ::-1] if hole else 2 * facets[:, ::-1]
    scene = luz.Scene()
    for name, corners, material in (("outer", outer, warm(0.5)), ("inner", facets, warm(0.7))):
        scene.add(name, corners.reshape(-1, 3), material, faces=np.arange(3 * len(corners)).reshape(-1, 3))
    return scene


def _ball_in_a_room(material: luz.Material, finer: bool = False) -> luz.Scene:
    scene = closed(warm(0.6))
    facets = ball(warm(), False).surfaces["ball"].pieces
    if finer:
        facets = _in_four(facets)
    corners = 0.4 * facets.reshape(-1, 3) + [1.5, 1, 0.9]
    scene.add("ball", corners, material, faces=np.arange(len(corners)).reshape(-1, 3))
    return scene
