"""Prepared once and used again: saved and loaded, other materials, other lights, within memory, to an accuracy."""

from __future__ import annotations

import contextlib
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from builders import BLACK, DARK, box_polygons, prepare_coarse
from situations import Outcome, Situation, all_of, assert_sound, holds, near, refused

import luzespecular as luz

GREY = luz.Material(diffuse_reflectance=0.5)
NOON = luz.Daylight(
    sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=20, horizontal_illuminance=1e4),
    sun=luz.Sun(altitude=40, azimuth=20, normal_illuminance=8e4),
    ground_reflectance=0.2,
)
POINTS, NORMALS = [[1, 1, 0.7], [2.5, 1.2, 0]], [[0, 0, 1], [0, 0, 1]]
COARSE = {"elements": 200, "patches": 100, "bands": 16}


def room(floor: float = 0.4, mirror: float = 0.8, lamp: float = 0.0, glass: float = 0.8) -> luz.Scene:
    scene = luz.Scene()
    for name, polygon in box_polygons((3, 2, 2.5)).items():
        if name != "north":
            scene.add(name, polygon, luz.Material(diffuse_reflectance=floor) if name == "floor" else GREY)
    pane = luz.Material(regular_transmittance=glass, refractive_index=1.52)
    scene.add("window", box_polygons((3, 2, 2.5))["north"], pane)
    scene.add("mirror", [[0.01, 0.5, 0.5], [0.01, 1.5, 0.5], [0.01, 1.5, 1.5], [0.01, 0.5, 1.5]], _mirror(mirror))
    scene.add("shelf", [[1, 1, 1.2], [2, 1, 1.2], [2, 1.6, 1.2], [1, 1.6, 1.2]], GREY, two_sided=True)
    scene.add("lamp", [[1, 0.4, 2.4], [2, 0.4, 2.4], [2, 0.2, 2.4], [1, 0.2, 2.4]], luz.Material(exitance=lamp))
    return scene


def _mirror(reflectance: float) -> luz.Material:
    return luz.Material(specular_reflectance=reflectance)


def lux(transfer, light=NOON) -> np.ndarray:
    result = transfer.solve(light, tolerance=1e-6)
    assert_sound(result, balanced=False)  # so coarse a globe does not know what escapes well enough
    behind = result.back.illuminance[~np.isnan(result.back.illuminance)]
    return np.concatenate([result.illuminance, behind, result.at(POINTS, NORMALS)])


def saved(receivers=None) -> Outcome:
    """From a file: the same lux to the last bit."""
    transfer = prepare_coarse(room(), receivers=receivers, **COARSE)
    with tempfile.TemporaryDirectory() as folder, _as_coarse():
        path = transfer.save(Path(folder) / "Ätzküche à luz.npz")
        loaded = luz.load(path, room())
        again = luz.load(loaded.save(path), room())  # over itself
        left = sorted(p.name for p in Path(folder).iterdir())
    return all_of(
        near(lux(loaded), lux(transfer), 0.0),
        near(lux(again), lux(transfer), 0.0),
        holds(left == [path.name], "one file", f"{left}"),
    )


@contextlib.contextmanager
def _as_coarse() -> Iterator[None]:
    """Loading cuts the scene again, and must do so as coarsely."""
    from luzespecular import fracture, geometry

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fracture, "FEWEST_ELEMENTS", COARSE["elements"])
        patch.setattr(fracture, "ELEMENTS_PER_PLAIN_SURFACE", COARSE["elements"] // 10)
        patch.setattr(geometry, "PATCHES", COARSE["patches"])
        yield


def loaded_for(change: dict, *words) -> Outcome:
    """A file of another scene is refused, with what differs; of other paint it holds."""
    transfer = prepare_coarse(room(), **COARSE)
    with tempfile.TemporaryDirectory() as folder, _as_coarse():
        path = transfer.save(Path(folder) / "room")
        if words:
            try:
                luz.load(path, room(**change))
            except luz.TransferFileError as error:
                return holds(all(w in str(error) for w in words), f"refused: {words}", str(error)[:90])
            return holds(False, "refused", "accepted")
        return near(lux(luz.load(path, room(**change))), lux(prepare_coarse(room(**change), **COARSE)), 1e-5)


def reused(change: dict, kept: bool) -> Outcome:
    """Prepared with an earlier transfer: as prepared anew; and it is said what was kept."""
    old = prepare_coarse(room(), **COARSE)
    new = prepare_coarse(room(**change), reuse=old, **COARSE)
    said = [stage for stage in new.stages if stage.name == "reuse"]
    return all_of(
        near(lux(new), lux(prepare_coarse(room(**change), **COARSE)), 1e-5),
        holds(bool(said) != kept, "kept" if kept else "anew", f"{[s.skipped for s in said]}"),
    )


def scaled_light(factor: float) -> Outcome:
    """Light so many times as bright: so many times the lux, and the same share open in the balance."""

    def light(times: float) -> luz.Daylight:
        sky = luz.CIESky(12, sun_altitude=40, sun_azimuth=20, horizontal_illuminance=1e4 * times)
        sun = luz.Sun(altitude=40, azimuth=20, normal_illuminance=8e4 * times)
        return luz.Daylight(sky=sky, sun=sun, ground_reflectance=0.2)

    transfer = prepare_coarse(room(), **COARSE)
    one, many = (transfer.solve(light(times), tolerance=1e-6) for times in (1.0, factor))
    return all_of(
        near(many.illuminance / factor, one.illuminance, 1e-5),
        near(many.error / factor, one.error, 1e-4),
        near(many.balance.defect, one.balance.defect, 0, 1e-5),
    )


def scaled_lamp(factor: float) -> Outcome:
    transfers = [prepare_coarse(room(lamp=500.0 * times), **COARSE) for times in (1.0, factor)]
    one, many = (transfer.solve(DARK, tolerance=1e-6) for transfer in transfers)
    return all_of(
        near(many.illuminance / factor, one.illuminance, 1e-5),
        near(many.balance.defect, one.balance.defect, 0, 1e-5),
    )


def sum_of_lights() -> Outcome:
    """Lamp and sky, lamp and Sun, less the lamp that is in both: as all together."""
    transfer, sky, sun = prepare_coarse(room(lamp=500.0), **COARSE), NOON.sky, NOON.sun
    both = lux(transfer, luz.Daylight(sky=sky)) + lux(transfer, luz.Daylight(sun=sun)) - lux(transfer, DARK)
    return near(both, lux(transfer, luz.Daylight(sky=sky, sun=sun)), 1e-4)


def enough_memory(share: float) -> Outcome:
    """What it needs is enough; a little less is refused, with what helps."""
    from luzespecular.preparation import bytes_held

    transfer = prepare_coarse(room(), **COARSE)
    needed = bytes_held(transfer.geometry, int(1.5 * len(transfer.nodes.points)))
    if share >= 1:
        return near(lux(prepare_coarse(room(), memory=share * needed, **COARSE)), lux(transfer), 1e-6)
    return refused(lambda: prepare_coarse(room(), memory=share * needed, **COARSE), "'memory'", "max_area")


def window_factors(points, width: float, low: float, high: float) -> np.ndarray:
    """Lux on a level place at the foot of a wall's window under an even sky of 1 cd/m², by summing small parts."""
    x, z = np.meshgrid((np.arange(600) + 0.5) / 600 * width, low + (np.arange(400) + 0.5) / 400 * (high - low))
    out = []
    for px, py in points:
        squared = (x - px) ** 2 + py**2 + z**2
        out.append(float((z * py / squared**2).mean() * width * (high - low)))
    return np.array(out)


def as_accurate_as_asked(accuracy: float) -> Outcome:
    """The floor of a black room with a window under an even sky: 95 of 100 points, and the error told, keep to it."""
    scene = luz.Scene()
    for name, polygon in box_polygons((3, 4, 2.5)).items():
        if name != "south":
            scene.add(name, polygon, BLACK)
    for name, (x, z) in {"sill": ((0, 3), (0, 1)), "lintel": ((0, 3), (2.2, 2.5))}.items():
        scene.add(name, [[x[0], 0, z[0]], [x[0], 0, z[1]], [x[1], 0, z[1]], [x[1], 0, z[0]]], BLACK)
    result = luz.prepare(scene, accuracy=accuracy).solve(luz.Daylight(sky=luz.UniformSky(1000.0)))
    places = np.random.default_rng(3).uniform((0.2, 0.4), (2.8, 3.8), (60, 2))
    got = result.at(np.c_[places, np.zeros(60)], np.tile([0.0, 0, 1], (60, 1)))
    exact = 1000 * window_factors(places, 3.0, 1.0, 2.2)
    off = np.abs(got / exact - 1)
    return holds(
        float(np.quantile(off, 0.95)) <= accuracy, f"95 of 100 within {accuracy:g}", f"{np.quantile(off, 0.95):.2g}"
    )


def accuracy_refused(value) -> Outcome:
    return refused(lambda: luz.prepare(room(), accuracy=value), "accuracy")


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("precision", f"kept: {name}", run, long)

    yield row("saved and loaded", saved)
    yield row("saved and loaded with some receivers", lambda: saved(["floor", "shelf"]), True)
    yield row("loaded for other paint", lambda: loaded_for({"floor": 0.1, "lamp": 0.0}))
    yield row("loaded for another mirror", lambda: loaded_for({"mirror": 0.7}, "room"))
    yield row("loaded for another pane", lambda: loaded_for({"glass": 0.7}, "room"), True)
    yield row("used again with other paint", lambda: reused({"floor": 0.9}, True))
    yield row("used again with another mirror", lambda: reused({"mirror": 0.5}, False), True)
    yield row("used again with a lamp switched on", lambda: reused({"lamp": 100.0}, False), True)
    for factor in (1e-30, 1e-6, 1e6, 1e30):
        yield row(f"light times {factor:g}", lambda f=factor: scaled_light(f), factor != 1e30)
        yield row(f"a lamp times {factor:g}", lambda f=factor: scaled_lamp(f), factor != 1e-30)
    yield row("lights one by one", sum_of_lights, True)
    yield row("as much memory as it takes", lambda: enough_memory(1.01))
    yield row("half the memory", lambda: enough_memory(0.5))
    for accuracy in (0.02, 0.1):
        yield row(f"an accuracy of {accuracy:g}", lambda a=accuracy: as_accurate_as_asked(a), accuracy < 0.05)
    for value in (0.0, -1, 0.5, math.nan, "fine"):
        yield row(f"an accuracy of {value!r}", lambda v=value: accuracy_refused(v))
