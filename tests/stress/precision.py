"""Float32 in the bulk against float64 throughout; threads and chunks."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest
from builders import prepare_coarse
from invariance import NORMALS, POINTS, light, room
from situations import SINGLE, Outcome, Situation, near

import luzespecular as luz
from luzespecular import form_factors


def lux(threads: int = 2, cells: int | None = None, double: bool = False) -> np.ndarray:
    """Lux of all faces and of points, coarse."""
    with pytest.MonkeyPatch.context() as patch:
        if cells is not None:
            patch.setattr(form_factors, "_CHUNK_CELLS", cells)
        if double:
            patch.setattr(np, "float32", np.float64)
        result = prepare_coarse(room(), elements=300, patches=100, bands=24, threads=threads).solve(light())
        return np.concatenate([result.illuminance, result.at(POINTS, NORMALS)])


@cache
def usual() -> np.ndarray:
    return lux()


def against_double() -> Outcome:
    return near(usual(), lux(double=True), SINGLE)


def threads(count: int) -> Outcome:
    """Chunks are the same for any number of threads, and each writes rows of its own: nothing differs."""
    return near(lux(threads=count), usual(), 0.0)


def chunks(cells: int) -> Outcome:
    """Matrix products of other shapes add up in another order: float32 rounding, no more."""
    return near(lux(cells=cells), usual(), SINGLE)


def again() -> Outcome:
    return near(lux(), usual(), 0.0)


def prepared_twice() -> Outcome:
    """One transfer for many lights: the order of solving changes nothing."""
    transfer = prepare_coarse(room(), elements=100, patches=60, bands=16)
    first = transfer.solve(light()).illuminance
    transfer.solve(luz.Daylight(sky=luz.UniformSky(7.0)))
    return near(transfer.solve(light()).illuminance, first, 0.0)


def situations() -> Iterator[Situation]:
    def row(name, run, long=False):
        return Situation("precision", name, run, long)

    yield row("float32 in the bulk", against_double)
    for count in (1, 3, 8):
        yield row(f"{count} threads", lambda count=count: threads(count))
    for cells in (3_000, 50_000, 2_000_000):
        yield row(f"chunks of {cells} cells", lambda cells=cells: chunks(cells))
    yield row("the same run again", again)
    yield row("other lights in between", prepared_twice)
