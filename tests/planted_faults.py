"""Scenes with one fault each: how they are made, what the scene check calls the fault, and the faces concerned."""

import numpy as np
from builders import BLACK, box, box_polygons, scene_of

import luzespecular as luz

GREY = luz.Material(diffuse_reflectance=0.5)
WHITE = luz.Material(diffuse_reflectance=0.8)
LAMP = luz.Material(exitance=1000.0)
MIRROR = luz.Material(specular_reflectance=0.9)
GLASS = luz.Material(regular_transmittance=0.88, refractive_index=1.52)
SIZE = (4, 3, 2.5)


def rectangle(x=(0, 1), y=(0, 1), z=0.0):
    return np.array([[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]], float)


def room(change=None, without=("north",), material=GREY, **others):
    """A room of 4 m × 3 m × 2.5 m, open to the north, with some polygons changed."""
    polygons = {k: v for k, v in box_polygons(SIZE).items() if k not in without} | (change or {})
    return scene_of(polygons, material, **others)


def turned(*names):
    return {name: box_polygons(SIZE)[name][::-1] for name in names}


def moved(name, by):
    return {name: box_polygons(SIZE)[name] + np.array(by, float)}


def with_mesh(vertices, faces, material=GREY, name="mesh", **options):
    scene = room()
    scene.add(name, vertices, material, faces=faces, **options)
    return scene


def solid(origin, size, turn=False):
    """Vertices and faces of a closed box seen from outside."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
    faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [0, 4, 7, 3], [1, 2, 6, 5]]
    return corners * size + origin, [face[::-1] for face in faces] if turn else faces


def grid(n, size=1.0, at=(1.5, 1.5, 1.0), relief=0.0):
    """A bumpy square of 2 n² triangles."""
    steps = np.linspace(0, size, n + 1)
    x, y = np.meshgrid(steps, steps)
    height = relief * np.random.default_rng(3).random(x.shape)
    vertices = np.stack([x, y, height], axis=2).reshape(-1, 3) + at
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    lower = np.stack([corner, corner + 1, corner + n + 2], axis=1)
    return vertices, np.concatenate([lower, np.stack([corner, corner + n + 2, corner + n + 1], axis=1)])


def unwelded():
    polygons = [p for name, p in box_polygons(SIZE).items() if name != "north"]
    polygons[2] = polygons[2][::-1]
    scene = luz.Scene()
    scene.add("room", np.concatenate(polygons), GREY, faces=np.arange(20).reshape(-1, 4))
    return scene


def side_by_side():
    scene = room(without=("north", "floor"))
    scene.add("left", rectangle((0, 2), (0, 3)), GREY)
    scene.add("right", rectangle((2, 4), (0, 3))[::-1], GREY)
    return scene


def t_room():
    """Two rooms side by side, of which one has no window."""
    scene = room(without=("north", "east"), change={"wall": box_polygons(SIZE)["east"]})
    for name, polygon in box_polygons(SIZE, (4, 0, 0)).items():
        scene.add(f"dark {name}", polygon, GREY)
    return scene


def dented():
    vertices, faces = solid([1, 1, 0.5], 0.4)
    vertices[6] += [0.1, 0, 0]
    return with_mesh(vertices, faces)


def turned_mesh():
    vertices, faces = solid([1, 1, 0.5], 0.4)
    faces[3] = faces[3][::-1]
    return with_mesh(vertices, faces)


FAULTS = {
    "a wall turned over": (lambda: room(turned("west")), "inverted normals", {"west": [0]}),
    "a black floor turned over": (lambda: room(turned("floor"), floor=BLACK), "inverted normals", {"floor": [0]}),
    "two walls turned over": (lambda: room(turned("west", "floor")), "inverted normals", {"west": [0]}),
    "a face of an unwelded room turned over": (unwelded, "inverted normals", {"room": [2]}),
    "all walls turned over": (
        lambda: room(turned("floor", "west", "east", "south", "ceiling")),
        "inside out",
        {"west": [0], "floor": [0]},
    ),
    "an inside-out room with a table": (
        lambda: room({**turned("floor", "west", "east", "south", "ceiling"), "table": rectangle((1, 3), (1, 2), 0.8)}),
        "inverted normals",
        {"ceiling": [0]},
    ),
    "a solid turned inside out": (
        lambda: with_mesh(*solid([1, 1, 0.5], 0.4, turn=True)),
        "inverted normals",
        {"mesh": [0, 1, 2, 3, 4, 5]},
    ),
    "a face of a mesh turned over": (turned_mesh, "turned over in a mesh", {"mesh": [3]}),
    "two halves that look apart": (side_by_side, "turned over", {"left": [0], "right": [0]}),
    "a one-sided partition": (
        lambda: room({"screen": np.array([[2, 0, 0], [2, 2, 0], [2, 2, 2], [2, 0, 2]], float)}),
        "seen from behind",
        {"screen": [0]},
    ),
    "a one-sided canopy": (
        lambda: scene_of({"ground": rectangle((-5, 5), (-5, 5)), "canopy": rectangle((-1, 1), (-1, 1), 1.0)}, GREY),
        "inverted normals",
        {"canopy": [0]},
    ),
    "a wall 1 mm above the floor": (lambda: room(moved("west", (0, 0, 1e-3))), "gap", {"west": [0], "floor": [0]}),
    "a wall 2 cm beside the floor": (lambda: room(moved("west", (-0.02, 0, 0))), "gap", {"west": [0], "floor": [0]}),
    "a ceiling 5 mm too high": (lambda: room(moved("ceiling", (0, 0, 5e-3))), "gap", {"ceiling": [0]}),
    "a ceiling that hangs": (
        lambda: room({"ceiling": box_polygons(SIZE)["ceiling"] + [[0, 0, 0], [0, 0, 0], [0, 0, 0.01], [0, 0, 0.01]]}),
        "gap",
        {"ceiling": [0]},
    ),
    "a floor in two parts": (
        lambda: room(
            {"one": rectangle((0, 2), (0, 3)), "two": rectangle((2.008, 4), (0, 3))}, without=("floor", "north")
        ),
        "gap",
        {"one": [0], "two": [0]},
    ),
    "a floor twice": (lambda: room({"again": rectangle((0, 4), (0, 3))}), "overlap", {"again": [0], "floor": [0]}),
    "a carpet in the floor's plane": (
        lambda: room({"carpet": rectangle((1, 2))}, carpet=WHITE),
        "overlap",
        {"carpet": [0]},
    ),
    "a face twice in a mesh": (
        lambda: with_mesh(
            [*rectangle(z=1), *rectangle(z=2), *rectangle(z=1)], [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]]
        ),
        "overlap",
        {"mesh": [0, 2]},
    ),
    "a window without a hole": (
        lambda: room({"pane": np.array([[1, 0, 1], [2, 0, 1], [2, 0, 2], [1, 0, 2]], float)}, pane=GLASS),
        "overlap",
        {"pane": [0], "south": [0]},
    ),
    "a pane drawn as a solid": (
        lambda: with_mesh(*solid([0.01, 2.9, 0.01], [3.98, 0.006, 2.48]), GLASS),
        "glass twice",
        {"mesh": [2, 3]},
    ),
    "a bent face": (dented, "not flat", {"mesh": [5]}),
    "a face without area": (
        lambda: with_mesh(rectangle(z=1), [[0, 1, 2, 3], [0, 1, 1]]),
        "no area",
        {"mesh": [1]},
    ),
    "a grain": (
        lambda: with_mesh([*rectangle(z=1), *rectangle((2, 2 + 1e-6), (2, 2 + 1e-6), 1)], [[0, 1, 2, 3], [4, 5, 6, 7]]),
        "tiny faces",
        {"mesh": [1]},
    ),
    "a sliver": (
        lambda: with_mesh([[0, 1, 1], [2, 1, 1], [1, 1 + 1e-6, 1]], [[0, 1, 2]]),
        "tiny faces",
        {"mesh": [0]},
    ),
    "a screw": (lambda: with_mesh(*grid(40, 0.02, relief=1e-3)), "costly detail", {"mesh": None}),
    "millimetres": (
        lambda: scene_of({k: 1000 * v for k, v in box_polygons(SIZE).items() if k != "north"}, GREY),
        "unit",
        {},
    ),
    "centimetres": (
        lambda: scene_of({k: 100 * v for k, v in box_polygons(SIZE).items() if k != "north"}, GREY),
        "unit",
        {},
    ),
    "kilometres": (
        lambda: scene_of({k: 1e-3 * v for k, v in box_polygons(SIZE).items() if k != "north"}, GREY),
        "unit",
        {},
    ),
    "another planet": (
        lambda: scene_of({k: v + 1e9 for k, v in box_polygons(SIZE).items() if k != "north"}, GREY),
        "far away",
        {},
    ),
    "no window": (lambda: box(GREY, SIZE), "no opening", {"floor": [0], "north": [0]}),
    "no window, with a table": (
        lambda: room({"table": rectangle((1, 3), (1, 2), 0.8)}, without=()),
        "no opening",
        {"floor": [0]},
    ),
    "one room of two without a window": (t_room, "no opening", {"dark floor": [0], "dark west": [0]}),
    "a floor without settings": (lambda: room(floor=BLACK), "no material", {"floor": [0]}),
    "paint too white": (lambda: room(west=luz.Material(diffuse_reflectance=0.97)), "reflectance", {"west": [0]}),
    "a mirror too good": (lambda: room(west=luz.Material(specular_reflectance=0.99)), "reflectance", {"west": [0]}),
    "mirrors face to face": (
        lambda: box(luz.Material(specular_reflectance=0.98, exitance=1.0)),
        "deep mirror chains",
        {"west": [0], "east": [0]},
    ),
    "fifteen panes": (
        lambda: room(
            {f"pane {k}": rectangle((0, 3), (0, 3), 0.5 + 0.1 * k) for k in range(15)},
            **{f"pane {k}": luz.Material(regular_transmittance=0.9) for k in range(15)},
        ),
        "many panes",
        {"pane 12": [0]},
    ),
    "a closed box that absorbs nothing": (
        lambda: box(luz.Material(diffuse_reflectance=1.0, exitance=1.0)),
        "endless reflection",
        {"floor": [0]},
    ),
    "a closed box of perfect mirrors": (
        lambda: box(luz.Material(specular_reflectance=1.0, exitance=1.0)),
        "endless mirrors",
        {"floor": [0]},
    ),
    "nothing": (luz.Scene, "empty", {}),
}
