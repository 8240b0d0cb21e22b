"""Energy: nearly white boxes, perfect mirrors, long pipes, dim light beside bright."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from builders import DARK, box, box_polygons
from situations import BALANCE, GLOBE, Outcome, Situation, all_of, near, refused, solved, told

import luzespecular as luz

EVEN = luz.Daylight(sky=luz.UniformSky(1000.0))


def white_box(reflectance: float, size) -> Outcome:
    """Every surface sends 1000 lm/m² of its own: lux are 1000 / (1 − ρ) everywhere."""
    scene = box(luz.Material(diffuse_reflectance=reflectance, exitance=1000.0), size)
    result = solved(scene, DARK, bands=24, elements=150)
    return near(result.illuminance, np.full(len(result.areas), 1000 / (1 - reflectance)), 1e-4)


def white_room_by_a_lamp(reflectance: float) -> Outcome:
    """A lamp of few lumens in a nearly white box: absorbed is what is emitted."""
    scene = box(luz.Material(diffuse_reflectance=reflectance), (3, 3, 3))
    scene.add("lamp", [[1, 2, 2.9], [2, 2, 2.9], [2, 1, 2.9], [1, 1, 2.9]], luz.Material(exitance=1000.0))
    scene.add(
        "lamp's back",
        [[1, 1, 2.9], [2, 1, 2.9], [2, 2, 2.9], [1, 2, 2.9]],
        luz.Material(diffuse_reflectance=reflectance),
    )
    balance = solved(scene, DARK, bands=24, elements=300).balance
    return near(sum(balance.absorbed.values()) + balance.unlit, 1000.0, 1e-3)


def endless() -> Outcome:
    scene = box(luz.Material(diffuse_reflectance=1.0, exitance=1.0))
    return all_of(told(scene, "endless reflection"), refused(lambda: solved(scene, DARK, bands=8), "without end"))


def pipe(ratio: float, reflectance: float, width: float = 0.5) -> luz.Scene:
    scene = luz.Scene()
    for name, polygon in box_polygons((width, width, ratio * width)).items():
        if name != "ceiling":
            material = luz.Material(specular_reflectance=0.0 if name == "floor" else reflectance)
            scene.add(name, polygon, material)
    return scene


def perfect_pipe(ratio: float) -> Outcome:
    """A pipe without loss under an even sky: its bottom is as bright as the open ground, but for chains cut off."""
    result = solved(pipe(ratio, 1.0), EVEN, bands=40, elements=20)
    entering = 1000 * math.pi * 0.25
    got = result.mean("floor") + result.balance.truncated / 0.25
    return all_of(near(got, 1000 * math.pi, GLOBE), near(result.balance.truncated / entering, 0.0, 0, 0.25))


def pipe_in_sun(ratio: float) -> Outcome:
    """A beam of 45° down a square pipe: it meets as many walls as the pipe is long, everywhere the same."""
    sun = luz.Sun(direction=(1, 0, 1), normal_illuminance=math.sqrt(2) * 1e4)
    result = solved(pipe(ratio, 0.9), luz.Daylight(sun=sun), bands=8, elements=20, specular_cutoff=1e-4)
    whole = math.floor(ratio)
    share = ratio - whole
    expected = 1e4 * (0.9**whole * (1 - share) + 0.9 ** (whole + 1) * share)
    return near(result.mean("floor"), expected, 1e-6)


def dim_beside_bright() -> Outcome:
    """Two closed boxes, one of 1e5 lx and one of 1e-3 lx."""
    scene = luz.Scene()
    for title, exitance, origin in (("bright", 5e4, (0, 0, 0)), ("dim", 5e-4, (1.5, 0, 0))):
        for name, polygon in box_polygons((1, 1, 1), origin).items():
            scene.add(f"{title} {name}", polygon, luz.Material(diffuse_reflectance=0.5, exitance=exitance))
    result = solved(scene, DARK, bands=24, elements=150, tolerance=1e-9)
    # what means over areas err by is made up for in all of the scene: a billionth of the brightest, or less
    return near([result.mean("bright floor"), result.mean("dim floor")], [1e5, 1e-3], 1e-4, 1e-9 * 1e5)


def lamp_beside_dim_room() -> Outcome:
    """Two closed boxes under lamps, one lit 1e8 times as much: in the other all is as if it were alone."""

    def floor(bright: float) -> float:
        scene = luz.Scene()
        for title, exitance, origin in (("bright", bright, (0, 0, 0)), ("dim", 5e-4, (1.5, 0, 0))):
            for name, polygon in box_polygons((1, 1, 1), origin).items():
                own = exitance if name == "ceiling" else 0.0
                scene.add(f"{title} {name}", polygon, luz.Material(diffuse_reflectance=0.5, exitance=own))
        return solved(scene, DARK, bands=24, elements=300, tolerance=1e-9).mean("dim floor")

    return near(floor(5e4), floor(5e-4), 1e-2)


def luminous_mirrors(reflectance: float) -> Outcome:
    """A closed box of mirrors that shine, with a black lid: all light ends there, in mirrors or in chains cut off."""
    scene = luz.Scene()
    for name, polygon in box_polygons((4, 4, 3)).items():
        material = (
            luz.Material() if name == "ceiling" else luz.Material(specular_reflectance=reflectance, exitance=100.0)
        )
        scene.add(name, polygon, material)
    balance = solved(scene, DARK, bands=8, elements=20, patches=5).balance
    return near(sum(balance.absorbed.values()) + balance.truncated, balance.entering, BALANCE)


def white_well(height: float, opening: float = 1.0, mirrored=()) -> Outcome:
    """All surfaces white or perfect mirrors: a cavity is as bright as the sky, whatever its shape."""
    low, high = 0.5 - opening / 2, 0.5 + opening / 2
    white = luz.Material(diffuse_reflectance=1.0)
    scene = luz.Scene()
    for name, polygon in box_polygons((1, 1, height)).items():
        if name != "ceiling":
            scene.add(name, polygon, luz.Material(specular_reflectance=1.0) if name in mirrored else white)
    for number, (x, y) in enumerate(
        (((0, low), (0, 1)), ((high, 1), (0, 1)), ((low, high), (0, low)), ((low, high), (high, 1)))
    ):
        if opening < 1:
            corners = [[x[0], y[1], height], [x[1], y[1], height], [x[1], y[0], height], [x[0], y[0], height]]
            scene.add(f"ceiling {number}", np.array(corners, float), white)
    result = solved(scene, EVEN, elements=600, patches=300, bands=40)
    return near(result.illuminance, np.full(len(result.areas), 1000 * math.pi), GLOBE)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("energy", name, run, long)

    for reflectance in (0.5, 0.99, 0.999, 0.99999):
        yield row(f"a closed box of ρ = {reflectance}", lambda r=reflectance: white_box(r, (2, 3, 2.5)))
    yield row("a flat closed box of ρ = 0.999", lambda: white_box(0.999, (4, 4, 0.05)))
    yield row("a lamp in a room of ρ = 0.999", lambda: white_room_by_a_lamp(0.999))
    yield row("a closed box of ρ = 1", endless)
    yield row("a well of ρ = 1", lambda: white_well(2.0))
    yield row("a deep well of ρ = 1", lambda: white_well(8.0))
    yield row("a box of ρ = 1 with a hole of 10 cm", lambda: white_well(1.0, 0.1))
    yield row("a well of white and perfect mirrors", lambda: white_well(2.0, mirrored=("west", "north")))
    for reflectance in (0.9, 0.999, 1.0):
        yield row(f"luminous mirrors of {reflectance:g} with a black lid", lambda r=reflectance: luminous_mirrors(r))
    yield row("a pipe of length 5 without loss", lambda: perfect_pipe(5))
    yield row("a pipe of length 20 without loss", lambda: perfect_pipe(20), True)
    for ratio in (1, 4.5, 20):
        yield row(f"sunlight down a pipe of length {ratio}", lambda ratio=ratio: pipe_in_sun(ratio))
    yield row("1e5 lx beside 1e-3 lx", dim_beside_bright)
    yield row("a room of 1e5 lx beside one of 1e-3 lx", lamp_beside_dim_room)
