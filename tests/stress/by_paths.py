"""Rooms of odd make-up against light along random paths, surface by surface."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from builders import DARK, box_polygons
from paths import Paths
from sides import closed_rooms
from situations import Outcome, Situation, all_of, holds, near, solved

import luzespecular as luz

GREY = luz.Material(diffuse_reflectance=0.5)
WHITE = luz.Material(diffuse_reflectance=0.8)
GLASS = luz.Material(refractive_index=1.52, regular_transmittance=0.88)
CLOUDY = luz.Daylight(sky=luz.CIESky(16, horizontal_illuminance=1e4), ground_reflectance=0.2)
SUNNY = luz.Daylight(
    sky=luz.CIESky(12, sun_altitude=35, sun_azimuth=20, horizontal_illuminance=1e4),
    sun=luz.Sun(altitude=35, azimuth=20, normal_illuminance=5e4),
    ground_reflectance=0.2,
)
SIZE = (4.0, 5.0, 3.0)


def rectangle(corner, first, second) -> np.ndarray:
    """(4, 3): from a corner along two edges, towards whose cross product it looks."""
    corner, first, second = (np.array(v, float) for v in (corner, first, second))
    return np.array([corner, corner + first, corner + first + second, corner + second])


def room(x=(0.5, 3.5), z=(0.8, 2.6), material=GREY) -> luz.Scene:
    """Of 4 m × 5 m × 3 m, with a window to the north."""
    scene = luz.Scene()
    for name, polygon in box_polygons(SIZE).items():
        if name != "north":
            scene.add(name, polygon, material)
    width, depth, height = SIZE
    for name, (a, b, c, d) in {
        "sill": (0, width, 0, z[0]),
        "lintel": (0, width, z[1], height),
        "left": (0, x[0], *z),
        "right": (x[1], width, *z),
    }.items():
        if b > a:
            scene.add(name, rectangle([a, depth, c], [b - a, 0, 0], [0, 0, d - c]), material)
    return scene


def bar(scene, name, origin, size, material=WHITE) -> None:
    """A box seen from outside."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [0, 4, 7, 3], [1, 2, 6, 5]]
    scene.add(name, corners * size + np.array(origin), material, faces=faces)


def against_paths(scene, light, names, relative=0.01, count=300_000, backs=(), **options) -> Outcome:
    """Means of surfaces, and of some backs, within this and three standard errors of what paths tell."""
    result = solved(scene, light, **{"elements": 2000, "patches": 600, "bands": 40, **options})
    paths, outcomes = Paths(scene, light), []
    for name, back in [*((name, False) for name in names), *((name, True) for name in backs)]:
        faces, side = result.faces_of(name), result.back if back else result.front
        mean, error = paths.mean(name, count, back)
        got = np.average(side.illuminance[faces], weights=result.areas[faces])
        outcomes.append(near(got, mean, relative, relative * mean + 3 * error))
    return all_of(*outcomes)


def behind_a_blind(count: int) -> luz.Scene:
    scene = room()
    for k in range(count):
        z = 0.82 + 0.045 * k
        slat = [[0.5, 5.02, z + 0.02], [3.5, 5.02, z + 0.02], [3.5, 5.06, z], [0.5, 5.06, z]]
        scene.add(f"slat {k}", slat, luz.Material(diffuse_reflectance=0.7), two_sided=True)
    return scene


def framed() -> luz.Scene:
    """A frame of bars, half of each outside."""
    scene = room()
    for k, x in enumerate((0.5, 1.95, 3.4)):
        bar(scene, f"upright {k}", [x, 4.95, 0.8], [0.1, 0.1, 1.8])
    for k, z in enumerate((0.8, 2.5)):
        for j, (a, b) in enumerate(((0.6, 1.95), (2.05, 3.4))):
            bar(scene, f"level {k} {j}", [a, 4.95, z], [b - a, 0.1, 0.1])
    return scene


def screened() -> luz.Scene:
    """A screen that scatters and mirrors on both sides, and a wall that mirrors."""
    scene = room()
    scene.add(
        "screen",
        rectangle([2, 1, 0.01], [0, 2.5, 0], [0, 0, 2]),
        luz.Material(diffuse_reflectance=0.3, specular_reflectance=0.5),
        two_sided=True,
    )
    scene.add("mirror", rectangle([0.01, 1, 0.5], [0, 3, 0], [0, 0, 2]), luz.Material(specular_reflectance=0.85))
    return scene


def partitioned() -> luz.Scene:
    """A partition of glass, and walls that end on it from both sides."""
    scene = room()
    scene.add("glass", rectangle([0, 2.5, 0], [4, 0, 0], [0, 0, 3]), GLASS)
    scene.add("near", rectangle([2.5, 2.5, 0], [0, 2.5, 0], [0, 0, 3]), GREY, two_sided=True)
    scene.add("far", rectangle([1.5, 0, 0], [0, 2.5, 0], [0, 0, 2.2]), GREY, two_sided=True)
    return scene


def saw_tooth() -> luz.Scene:
    """Two teeth, white outside as well, each before the other's pane."""
    scene = luz.Scene()
    for name, polygon in box_polygons((4, 6, 3)).items():
        if name != "ceiling":
            scene.add(name, polygon, GREY)
    for k, y in enumerate((0, 3)):
        scene.add(f"slope {k}", [[0, y, 3], [0, y + 3, 5], [4, y + 3, 5], [4, y, 3]], WHITE, two_sided=True)
        for x in (0, 4):
            gable = np.array([[x, y, 3], [x, y + 3, 3], [x, y + 3, 5]], float)
            scene.add(f"gable {k} {x}", gable if x == 0 else gable[::-1], GREY, two_sided=True)
        scene.add(f"pane {k}", rectangle([0, y + 3, 3], [4, 0, 0], [0, 0, 2]), GLASS)
    return scene


def splayed() -> luz.Scene:
    """A window narrower outside, with slanting reveals."""
    scene = room((1, 3), (0.8, 2.2))
    wide = np.array([[1, 5, 0.8], [3, 5, 0.8], [3, 5, 2.2], [1, 5, 2.2]])
    narrow = np.array([2, 5.5, 1.5]) + (wide - [2, 5, 1.5]) * 0.6
    for k in range(4):
        j = (k + 1) % 4
        scene.add(f"reveal {k}", [wide[k], narrow[k], narrow[j], wide[j]], WHITE)
    return scene


def crowded() -> luz.Scene:
    """Boxes that stand on the floor, against walls and on each other."""
    scene = room((1, 3), (1, 2.4))
    for k, (origin, size) in enumerate(
        (([0, 0, 0], [0.6, 1.2, 2]), ([1.5, 1.5, 0], [1, 1, 0.7]), ([1.8, 1.8, 0.7], [0.3, 0.3, 0.3]))
    ):
        bar(scene, f"box {k}", origin, size, luz.Material(diffuse_reflectance=0.3 + 0.1 * k))
    return scene


def many_panes() -> luz.Scene:
    """A window of eight panes side by side, clear, tinted and mirroring."""
    scene = room((0, 4))
    for k in range(4):
        for j in range(2):
            tinted = luz.Material(regular_transmittance=0.2 + 0.17 * k, specular_reflectance=0.1 * j)
            pane = rectangle([k, 5, 0.8 + 0.9 * j], [1, 0, 0], [0, 0, 0.9])
            scene.add(f"pane {k} {j}", pane, tinted if (k + j) % 2 else GLASS, two_sided=True)
    return scene


def behind_mirroring_panes() -> luz.Scene:
    """Two panes across a room that mirror 0.3 of the light and let half of it through."""
    scene = room()
    for k, y in enumerate((1.7, 3.3)):
        pane = luz.Material(specular_reflectance=0.3, regular_transmittance=0.5)
        scene.add(f"pane {k}", rectangle([0, y, 0], [4, 0, 0], [0, 0, 3]), pane, two_sided=True)
    return scene


def plates_on_both_sides_of_a_wall(gap: float) -> Outcome:
    """Two small plates of one mesh, in a lit room and in the closed one beside it: that one stays dark."""
    scene = closed_rooms(3, {"lit": (0, 0, 0), "dark": (3 + gap, 0, 0)})
    plates = [rectangle([x, 1, 1], [0.1, 0, 0], [0, 0.2, 0]) for x in (2.8, 3.1 + gap)]
    scene.add("plates", np.concatenate(plates), GREY, faces=[[0, 1, 2, 3], [4, 5, 6, 7]], two_sided=True)
    result = solved(scene, DARK, bands=24, elements=600, patches=300)
    dark = max(result.illuminance[result.faces_of(f"dark {name}")].max() for name in box_polygons())
    lit = result.mean("lit floor")
    return all_of(near(dark, 0.0, 0, 1e-9 * lit), holds(lit > 100, "lit", f"{lit:.4g}"))


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("light", f"paths: {name}", run, long)

    walls = ("floor", "ceiling", "south", "west")
    yield row(
        "behind a blind of 10 slats",
        lambda: against_paths(behind_a_blind(10), CLOUDY, ("slat 4",), 0.02, 60_000, backs=("slat 4",)),
    )
    for name, scene, light, names, options in (
        (
            "behind a blind of 40 slats, in the Sun",
            lambda: behind_a_blind(40),
            SUNNY,
            walls,
            {"count": 1_200_000, "backs": ("slat 20",)},
        ),
        ("a window frame, half of it outside", framed, CLOUDY, ("lintel", "floor"), {"relative": 0.02}),
        ("a screen that mirrors in part", screened, CLOUDY, walls, {"backs": ("screen",)}),
        ("walls that end on glass", partitioned, CLOUDY, walls, {"backs": ("near",)}),
        ("a saw-tooth roof with panes", saw_tooth, CLOUDY, ("floor", "gable 1 4"), {}),
        ("slanting reveals in the Sun", splayed, SUNNY, (*walls, "reveal 0"), {}),
        ("boxes in contact, in the Sun", crowded, SUNNY, (*walls, "box 0"), {}),
        ("panes of all sorts side by side", many_panes, CLOUDY, walls, {}),
        ("behind two panes that mirror", behind_mirroring_panes, CLOUDY, walls, {"count": 600_000}),
    ):
        yield row(name, lambda s=scene, li=light, n=names, o=options: against_paths(s(), li, n, **o), True)
    for gap in (0.0, 0.1):
        yield row(f"plates on both sides of a wall of {gap:g} m", lambda gap=gap: plates_on_both_sides_of_a_wall(gap))
