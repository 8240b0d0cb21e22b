"""What the performance benchmark measures of the solver: its stages, how cost grows, what each skip saves.

Every function here is one task of ``performance.py``, done in a process of its own; it gives what goes into JSON.
"""

from __future__ import annotations

import itertools
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import apart
import numpy as np
import rooms

import luzespecular as luz

HOURS_OF_YEAR = 8_760
CONDITIONS = ("clear", "clear", "partly cloudy", "overcast", "partly cloudy")
"""Skies of days that follow each other, again and again."""

REPEATS = 5

GROWTH = {
    "faces": (0.04, 0.02, 0.01, 0.005, 0.0025, 0.00125),
    "bands": (20, 30, 40, 60, 90),
    "planes": (0, 1, 2, 4, 8, 16),
    "facets": (5, 10, 20, 40),
    "mirrors": (1, 2, 4, 8),
    "depth": (1, 2, 4, 8, 16),
}
"""What grows: largest face [m²], bands of the globe, boxes in the room, mirrors, reflections between mirrors."""

BANDS_OF_GROWTH = 30
"""Bands and, below, the largest face [m²] where planes and mirrors grow."""

FACE_OF_GROWTH = 0.02


def first_use(bands: int, max_area: float, threads: int, repeats: int, most_seconds: float) -> dict:
    """The first hour of a fresh process, and later ones: arrays in → lux out; and what importing takes."""
    room = rooms.light_shelf_room()

    def once() -> luz.Result:
        return luz.prepare(room.scene("S1"), bands=bands, max_area=max_area, threads=threads).solve(room.daylight(12.0))

    start = time.perf_counter()
    result = once()
    first, peak = time.perf_counter() - start, apart.peak_gb()
    later, runs = apart.medians({"later": once}, repeats, most_seconds)
    return {
        "import": import_seconds(repeats),
        "imports": repeats,
        "first": first,
        "seconds": later["later"],
        "runs": runs,
        "faces": len(result.areas),
        "peak_gb": peak,
    }


def import_seconds(repeats: int) -> float:
    """Seconds of ``import luzespecular`` in fresh processes that have imported NumPy, their median."""
    code = "import numpy, time; t = time.perf_counter(); import luzespecular; print(time.perf_counter() - t)"
    found = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(repeats)
    ]
    return statistics.median(float(done.stdout) for done in found)


def whole_run(bands: int, max_area: float, threads: int, repeats: int, most_seconds: float, transfer: str) -> dict:
    """Arrays in → lux out with its stages, medians; the transfer is kept for other tasks."""
    room, kept = rooms.light_shelf_room(), []
    stages: dict[str, list[float]] = {}

    def prepare() -> None:
        kept.clear()  # no more than one is held
        kept.append(luz.prepare(room.scene("S1"), bands=bands, max_area=max_area, threads=threads))

    def solve() -> None:
        kept.append(kept[0].solve(room.daylight(12.0)))
        for stage in kept[1].stages:
            if not stage.skipped:
                stages.setdefault(stage.name, []).append(stage.seconds)

    seconds, runs = apart.medians({"prepare": prepare, "solve": solve}, repeats, most_seconds)
    peak = apart.peak_gb()
    prepared, result = kept
    prepared.save(transfer)
    return {
        **seconds,
        "seconds": seconds["prepare"] + seconds["solve"],
        "runs": runs,
        "peak_gb": peak,
        "faces": len(result.areas),
        "receivers": len(prepared.nodes.points),
        "parcels": len(prepared.geometry.targets.globe.directions),
        "beams": len(prepared.geometry.beams.directions),
        "stages": {name: statistics.median(found) for name, found in stages.items()},
        "skipped": {stage.name: stage.skipped for stage in result.stages if stage.skipped},
    }


def year(hours: int = HOURS_OF_YEAR) -> list[luz.Daylight | None]:
    """Hours of a year at the room's place: sky and Sun by the availability model, None in the night."""
    room = rooms.light_shelf_room()
    number = np.arange(hours)
    first = np.datetime64("2025-01-01T03:30", "m")  # half past midnight, three hours west
    when = first + number.astype("timedelta64[h]")
    altitude, azimuth = luz.sun_position(room.LATITUDE, room.LONGITUDE, when)
    days = number // 24 + 1
    return [
        luz.default_daylight(CONDITIONS[day % len(CONDITIONS)], a, z, day) if a > 0 else None
        for a, z, day in zip(altitude.tolist(), azimuth.tolist(), days.tolist(), strict=True)
    ]


def reuse(what: str, threads: int, repeats: int, most_seconds: float, transfer: str, hours: int) -> dict:
    """One thing done with a transfer that was loaded: median seconds, peak memory of the process."""
    room = rooms.light_shelf_room()
    start = time.perf_counter()
    prepared = luz.load(transfer, room.scene("S1"), threads=threads)
    loading, loaded = time.perf_counter() - start, apart.peak_gb()
    paler = rooms.paler()
    directions = np.resize(prepared.geometry.targets.globe.directions, (6000, 3))
    others = itertools.cycle([9.0, 10.0, 11.0, 12.0, 14.0])
    skies = itertools.cycle(["overcast", "uniform", "clear"])
    works: dict[str, Callable[[], object]] = {
        "another hour": lambda: prepared.solve(room.daylight(next(others))),
        "another hour, quick": lambda: prepared.solve(room.daylight(next(others)), quick=True),
        "another sky": lambda: prepared.solve(room.daylight(12.0, sky=next(skies), sun=False)),
        "a sky's luminance, 6,000 directions": lambda: room.daylight(12.0, sky=next(skies)).sky_luminance(directions),
        "another reflectance": lambda: prepared.with_materials(paler).solve(room.daylight(12.0)),
        "a year": lambda: prepared.annual(lights),
        "saved": lambda: prepared.save(Path(transfer).with_suffix(".again.npz")),
    }
    out = {"loaded_gb": loaded}
    if what == "loaded":
        return out | {"seconds": loading, "runs": 1, "peak_gb": loaded}
    lights = year(hours) if what.startswith("a year") else []
    if not what.startswith("a year"):
        works[what]()  # what is found once and kept, such as the globe's arrays, belongs to the first use
    seconds, runs = apart.medians({what: works[what]}, repeats, most_seconds)
    return out | {"seconds": seconds[what], "runs": runs, "peak_gb": apart.peak_gb()}


def growth(kind: str, value: float, bands: int, max_area: float, threads: int, repeats: int, most_seconds: float):
    """Seconds and peak memory of one size of what grows; ``bands`` and ``max_area`` where these do not grow."""
    room = rooms.light_shelf_room()
    options: dict = {"bands": bands, "max_area": max_area, "threads": threads}
    if kind == "faces":
        scene, options["max_area"] = room.scene("S1"), value
    elif kind == "bands":
        scene, options["bands"] = room.scene("S1"), int(value)
    elif kind == "planes":
        scene = rooms.with_boxes(int(value))
    elif kind == "facets":
        scene = rooms.with_ball(int(value))
    elif kind == "mirrors":
        scene = rooms.with_shelf_of(int(value))
    else:
        scene, options["specular_cutoff"] = rooms.between_mirrors(), rooms.cutoff_for(int(value))
    kept = []

    def prepare() -> None:
        kept.clear()
        kept.append(luz.prepare(scene, **options))

    seconds, runs = apart.medians(
        {"prepare": prepare, "solve": lambda: kept.append(kept[0].solve(room.daylight(12.0)))}, repeats, most_seconds
    )
    transfer, result = kept[0], kept[1]
    sizes = {
        "faces": len(result.areas),
        "bands": options["bands"],
        "planes": len(transfer.geometry.outlines.vertices),
        "facets": len(transfer.geometry.outlines.vertices),
        "mirrors": value,
        "depth": value,
    }
    return seconds | {
        "seconds": seconds["prepare"] + seconds["solve"],
        "runs": runs,
        "x": sizes[kind],
        "faces": sizes["faces"],
        "receivers": len(transfer.nodes.points),
        "peak_gb": apart.peak_gb(),
    }


def slope(x: list[float], y: list[float]) -> float:
    """Of the straight line through points in log–log; NaN where they stand above one another."""
    if min(x) == max(x):
        return float("nan")
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


# What each skip saves: the work done with the skip and without it, in turn


def skip(name: str, bands: int, max_area: float, threads: int, repeats: int, most_seconds: float) -> dict:
    """Seconds of all threads with one skip and without it, in turn, and the largest relative change of illuminance."""
    options = {"bands": bands, "max_area": max_area, "threads": threads}
    with_it, without_it, note = SKIPS[name](options)
    found: dict[str, np.ndarray] = {}

    def work(key: str, run: Callable[[], np.ndarray]) -> Callable[[], None]:
        def timed() -> None:
            found[key] = run()

        return timed

    works = {"with": work("with", with_it), "without": work("without", without_it)}
    works["with"]()  # what is found once and kept belongs to neither
    seconds, runs = apart.medians(works, repeats, most_seconds, time.process_time)
    one, other = found["with"], found["without"]
    change = np.abs(one - other) / np.maximum(np.abs(other), 1e-3 * np.abs(other).mean())
    return {
        "with": seconds["with"],
        "without": seconds["without"],
        "runs": runs,
        "change": float(change.max()),
        "median_change": float(np.median(change)),
        "note": note() if callable(note) else note,
    }


Skip = tuple[Callable[[], np.ndarray], Callable[[], np.ndarray], str | Callable[[], str]]


def _without(run: Callable[[], np.ndarray], *patches) -> Callable[[], np.ndarray]:
    """The same work with parts of the solver replaced."""

    def patched() -> np.ndarray:
        for patch in patches:
            patch.start()
        try:
            return run()
        finally:
            for patch in patches:
                patch.stop()

    return patched


def _chains(options: dict) -> Skip:
    from luzespecular.outlines import Outlines

    room = rooms.light_shelf_room()
    sky = room.daylight(12.0, sun=False)

    def run() -> np.ndarray:
        return luz.prepare(room.scene("D"), **options).solve(sky).illuminance

    return run, _without(run, mock.patch.object(Outlines, "any_specular", True)), "all-diffuse room, prepare and solve"


def _closed(options: dict) -> Skip:
    from luzespecular.transfer import Transfer

    light = rooms.light_shelf_room().daylight(12.0)
    transfer = luz.prepare(rooms.closed(), **options)

    def run() -> np.ndarray:
        return transfer.solve(light).illuminance

    without = _without(run, mock.patch.object(Transfer, "sees_out", True))
    return run, without, "the room closed by a luminous panel, one solve"


def _night(options: dict) -> Skip:
    from luzespecular.sun import Sun

    room = rooms.light_shelf_room()
    transfer = luz.prepare(room.scene("S1"), **options)
    light = luz.Daylight(
        sky=luz.CIESky(16, horizontal_illuminance=100.0),
        sun=luz.Sun(altitude=-20.0, azimuth=180.0, normal_illuminance=80_000.0),
    )

    def run() -> np.ndarray:
        return transfer.solve(light).illuminance

    return run, _without(run, mock.patch.object(Sun, "is_up", True)), "Sun 20° below the southern horizon, one solve"


def _backs(options: dict) -> Skip:
    from luzespecular.outlines import Outlines

    room = rooms.light_shelf_room()
    transfer = luz.prepare(room.scene("S1"), **options)
    light = luz.Daylight(
        sky=luz.CIESky(16, horizontal_illuminance=10_000.0),
        sun=luz.Sun(altitude=40.0, azimuth=180.0, normal_illuminance=80_000.0),
    )
    every = np.ones(len(transfer.geometry.outlines.vertices), bool)

    def run() -> np.ndarray:
        return transfer.solve(light).illuminance

    return run, _without(run, mock.patch.object(Outlines, "back_counts", every)), "Sun behind the room, one solve"


def _black(options: dict) -> Skip:
    def room(reflectance: float) -> luz.Scene:
        dark = luz.Material(diffuse_reflectance=reflectance)
        return rooms.shell(wall_west=dark, wall_east=dark, wall_south=dark)

    light = rooms.light_shelf_room().daylight(12.0, sun=False)

    def run(reflectance: float) -> np.ndarray:
        result = luz.prepare(room(reflectance), **options).solve(light)
        return np.concatenate([result.illuminance[result.faces_of(name)] for name in ("floor", "ceiling")])

    return (
        lambda: run(0.0),
        lambda: run(1e-9),
        "three black walls, against reflectance 1e-9; floor and ceiling, whose patches differ",
    )


def _behind(options: dict) -> Skip:
    from luzespecular import specular

    room, cut = rooms.light_shelf_room(), specular.obstacles_within
    light = room.daylight(12.0, sun=False)

    def uncut(outlines, normals, offsets, half_spaces, tolerance):
        return cut(outlines, normals, offsets, half_spaces[1:] if len(half_spaces) == 1 else half_spaces, tolerance)

    def run() -> np.ndarray:
        return luz.prepare(room.scene("S1"), **options).solve(light).illuminance

    return run, _without(run, mock.patch.object(specular, "obstacles_within", uncut)), "prepare and solve"


def _occlusion(options: dict) -> Skip:
    from luzespecular.convex import ConvexRoom

    def run() -> np.ndarray:
        return luz.prepare(rooms.closed(), **options).solve(luz.Daylight()).illuminance

    looked = mock.patch.object(ConvexRoom, "of", lambda geometry, nodes: None)
    return run, _without(run, looked), "the room closed by a luminous panel, prepare and solve"


def _far_sides(options: dict) -> Skip:
    from luzespecular import geometry

    scene, light = rooms.with_boxes(2), rooms.light_shelf_room().daylight(12.0, sun=False)

    def run() -> np.ndarray:
        return luz.prepare(scene, **options).solve(light).illuminance

    looked = mock.patch.object(geometry, "find_solids", lambda planes, opaque: None)
    return run, _without(run, looked), "two boxes in the room, prepare and solve"


def _receivers(options: dict) -> Skip:
    room = rooms.light_shelf_room()
    light = room.daylight(12.0, sun=False)

    def run(receivers: list[str] | None) -> np.ndarray:
        result = luz.prepare(room.scene("S1"), receivers=receivers, **options).solve(light)
        return result.illuminance[result.faces_of("floor")]

    return lambda: run(["floor"]), lambda: run(None), 'receivers=["floor"], prepare and solve; the floor'


def _kept(options: dict) -> Skip:
    room = rooms.light_shelf_room()
    light = room.daylight(12.0, sun=False)
    paler = rooms.paler()
    earlier = luz.prepare(room.scene("S1"), **options)

    def run(reuse: luz.Transfer | None) -> np.ndarray:
        return luz.prepare(paler, reuse=reuse, **options).solve(light).illuminance

    return lambda: run(earlier), lambda: run(None), "all reflectances lowered by a tenth, prepare(reuse=…) and solve"


def _cached(options: dict) -> Skip:
    room = rooms.light_shelf_room()
    light = room.daylight(12.0, sun=False)
    folder = tempfile.TemporaryDirectory()
    cache = Path(folder.name) / "transfer.npz"

    def run(cache: Path | None) -> np.ndarray:
        assert folder  # lives as long as this
        return luz.prepare(room.scene("S1"), cache=cache, **options).solve(light).illuminance

    run(cache)
    return lambda: run(cache), lambda: run(None), "the same scene again, prepare(cache=…) and solve"


SKIPS: dict[str, Callable[[dict], Skip]] = {
    "specular chains": _chains,
    "sky of a closed scene": _closed,
    "Sun below the horizon": _night,
    "shadows on backs, sun patches": _backs,
    "patches and fine faces of black surfaces": _black,
    "occlusion in a closed, convex, empty room": _occlusion,
    "the far sides of closed solids": _far_sides,
    "outlines behind a receiver's plane": _behind,
    "faces of surfaces that are no receivers": _receivers,
    "visibility, where reflectances change": _kept,
    "visibility, from a file": _cached,
}
