"""The cost of the hot path: bytes that its passes read and write, predicted against measured seconds.

Looking and gathering are passes of NumPy over arrays of one group of receivers, which stay in cache. How many passes
each step makes, and over how many bytes, is counted here by reading the code (`STEPS`; docs/performance.md tells it in
words). How often is counted while it runs; how fast the machine does such passes is measured in the same process. All
on one thread, in its own time, so that other work does not count.
"""

from __future__ import annotations

import contextlib
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from unittest import mock

import beside_embree
import numpy as np
import rooms

import luzespecular as luz
from luzespecular import gather, overlaps, parts, specular, visibility
from luzespecular.crossings import Candidates

EVERY = 4
"""One group of receivers of so many is looked at."""

LARGE = 64_000_000
"""Bytes that do not stay in cache."""


@dataclass(frozen=True)
class Step:
    """One step of the hot path.

    Attributes
    ----------
    name, where : str
        In words, and the function it is.
    bytes : dict of str to float
        Bytes read and written for each of what is counted.
    picks : dict of str to float
        Elements that are picked from or added to here and there, one by one, for each of what is counted.
    """

    name: str
    where: str
    bytes: dict[str, float]
    picks: dict[str, float]


STEPS = (
    Step(
        "beams that may meet an outline",
        "visibility._columns_within",
        # per beam and edge: products at four corners in float64 written, read for their largest and least; and tests
        {"beam edges": 4 * 8 * 3 + 24},
        {},
    ),
    Step("sides of edges", "visibility._edge_sines", {"cell edges": 4 + 4}, {}),
    Step(
        "nearest outline seen wholly",
        "visibility.look",
        {
            # seen and nearest are filled
            "directions": 8,
            # distance 4; nearest, seen: taken 16, compared 20, chosen 18, put back 16
            "cells": 4 + 70,
            # least of the edges' sines: first copied 8, others 12 each; compared, made positive, compared, searched 20
            "cell edges": 12,
            "open cells": 8 - 12 + 20,
            # row, beam, outline, sines (float32, 4 edges) of what an edge may cross: found, picked, joined
            "candidates": 216,
        },
        {"candidates": 6},
    ),
    Step("edges that cross beams", "Candidates.of", {"candidates": 400, "edges": 600}, {"candidates": 3, "edges": 12}),
    Step("shares by single edges", "parts.find_crossings", {"edges": 600, "crossed": 900}, {"crossed": 25}),
    Step("parts put together", "parts.settle_parts", {"crossed": 500, "parts": 200}, {"crossed": 10, "parts": 4}),
    Step("overlaps, exactly", "overlaps.settle", {}, {}),
    Step("overlaps, by rays", "lattice.sample", {}, {}),
    Step("what reaches mirrors", "GroupSight._continue", {}, {}),
    Step(
        "whole parcels to patches",
        "gather._add_whole_beams",
        # seen, nearest and weights taken 30; place on the grid 2 × 40 and joined 20; patch numbers and sums 44
        {"ended cells": 174},
        {"ended cells": 2},
    ),
    Step("parts to patches", "gather._parts_of_beams", {"parts": 700}, {"parts": 25}),
    Step("sky", "gather._add_sky", {"directions": 82}, {}),
    Step("mirrored sky", "gather._add_mirrored_sky", {}, {}),
    Step("parts of the sky", "gather._splat", {}, {}),
    Step("the rest", "gather.gather and what it calls", {}, {}),
)


class Watch:
    """Seconds of this thread by step, each without those of the steps inside it."""

    def __init__(self):
        self.seconds: Counter = Counter()
        self.inside = [STEPS[-1].where]
        self.since = time.thread_time()

    def _switch(self) -> None:
        now = time.thread_time()
        self.seconds[self.inside[-1]] += now - self.since
        self.since = now

    def timed(self, where: str, work: Callable, count: Callable | None = None) -> Callable:
        """The same function, watched; ``count`` gets what it was given and what it gave."""

        def watched(*given, **named):
            self._switch()
            self.inside.append(where)
            try:
                out = work(*given, **named)
            finally:
                self._switch()
                self.inside.pop()
            if count is not None:
                count(out, *given, **named)
                self.since = time.thread_time()
            return out

        return watched

    def stop(self) -> Counter:
        """The seconds so far."""
        self._switch()
        return self.seconds


def watch(counted: Counter) -> tuple[Watch, contextlib.ExitStack]:
    """A watch on all steps, until the stack is closed."""
    clock, stack = Watch(), contextlib.ExitStack()

    def put(owner, name: str, where: str, count: Callable | None = None, wrap: Callable = lambda f: f) -> None:
        stack.enter_context(mock.patch.object(owner, name, wrap(clock.timed(where, getattr(owner, name), count))))

    def columns(out, hull, outline, bounded, heights, directions, reach) -> None:
        found, certain = out
        edges, cells = int(bounded.sum()), len(found) * len(heights)
        counted["beam edges"] += edges * len(directions)
        counted["cells"] += cells
        counted["outlines"] += bool(cells)
        if len(found) and not certain.all():
            counted["cell edges"] += edges * cells
            counted["open cells"] += cells

    def looked(view, *given, **named) -> None:
        counted["directions"] += view.seen.size
        counted["parts"] += len(view.part_row)
        counted["ended cells"] += sum(len(found) for found in view.columns.values()) * len(view.seen)

    def candidates(out, *given) -> None:
        counted["candidates"] += len(out.row)
        counted["edges"] += len(out.pair)

    def crossings(out, *given) -> None:
        counted["crossed"] += len(out.row)

    put(visibility, "_columns_within", "visibility._columns_within", columns)
    put(visibility, "_edge_sines", "visibility._edge_sines")
    put(specular, "look", "visibility.look", looked)
    put(Candidates, "of", "Candidates.of", candidates, staticmethod)
    put(parts, "find_crossings", "parts.find_crossings", crossings)
    put(visibility, "settle_parts", "parts.settle_parts")
    put(overlaps, "settle", "overlaps.settle")
    put(parts.lattice, "sample", "lattice.sample")
    put(specular.GroupSight, "_continue", "GroupSight._continue")
    for name in ("_add_whole_beams", "_parts_of_beams", "_add_sky", "_add_mirrored_sky", "_splat"):
        put(gather, name, f"gather.{name}")
    return clock, stack


def typical(work: Callable[[], object], seconds: float = 0.1) -> float:
    """Median seconds of a short work, of this thread."""
    found, start = [], time.perf_counter()
    while len(found) < 5 or time.perf_counter() - start < seconds:
        begun = time.thread_time()
        work()
        found.append(time.thread_time() - begun)
    return float(np.median(found))


def rates(cells: int) -> dict:
    """How fast this machine does passes over arrays of ``cells`` float32, and over such as do not stay in cache.

    ``fresh`` are passes whose result is a new array, as most of the solver's are; the others write into one that is
    there. ``picks`` are elements taken from, and summed to, places here and there.
    """
    out: dict = {"cells": cells}
    for name, count in (("cache", cells), ("memory", LARGE // 4)):
        a, b, c = (np.full(count, value, np.float32) for value in (1.0, 2.0, 0.0))
        out[f"copy_{name}"] = 8 * count / typical(lambda a=a, c=c: np.copyto(c, a))
        out[f"add_{name}"] = 12 * count / typical(lambda a=a, b=b, c=c: np.add(a, b, out=c))
        out[f"fresh_{name}"] = 12 * count / typical(lambda a=a, b=b: np.add(a, b))
    rng = np.random.default_rng(0)
    places, values = rng.integers(0, cells, cells), rng.random(cells)
    taken = typical(lambda: values.take(places))
    summed = typical(lambda: np.bincount(places, weights=values, minlength=cells))
    out["picks"] = 2 * cells / (taken + summed)
    return out


def measure(bands: int, max_area: float, most_seconds: float) -> dict:
    """Predicted and measured seconds of each step for the light-shelf room, on one thread."""
    transfer = luz.prepare(rooms.light_shelf_room().scene("S1"), bands=bands, max_area=max_area)
    every = beside_embree.groups_of(transfer, transfer.geometry.beams)
    groups, targets = every[::EVERY], transfer.geometry.targets
    for group in groups[:2]:
        gather.gather(group.sight, group.points, targets)  # what is found once belongs to no step
    counted: Counter = Counter()
    rounds, start = 0, time.perf_counter()
    seconds: Counter = Counter()
    while not rounds or (rounds < 5 and (time.perf_counter() - start) * (rounds + 1) / rounds < most_seconds):
        clock, stack = watch(counted)
        with stack:
            for group in groups:
                gather.gather(group.sight, group.points, targets)
            seconds.update(clock.stop())
        rounds += 1
    speed = rates(max(1, round(counted["cells"] / max(counted["outlines"], 1))))
    stream = 0.5 * (speed["copy_cache"] + speed["add_cache"])
    rows = []
    for step in STEPS:
        count = sum(counted[key] * n for key, n in step.bytes.items()) / rounds
        picks = sum(counted[key] * n for key, n in step.picks.items()) / rounds
        row = {"name": step.name, "where": step.where, "measured": seconds[step.where] / rounds}
        if step.bytes:
            row |= {"bytes": count, "picks": picks, "predicted": count / speed["fresh_cache"] + picks / speed["picks"]}
        rows.append(row)
    directions = counted["directions"] / rounds
    receivers = sum(len(group.points) for group in groups)
    wide = targets.patches.count + targets.columns * (2 if transfer.geometry.outlines.any_specular else 1)
    memory = 0.5 * (speed["copy_memory"] + speed["add_memory"])
    return {
        "rounds": rounds,
        "groups": len(groups),
        "of": len(every),
        "receivers": receivers,
        "counts": {key: value / rounds for key, value in counted.items()},
        "rates": speed,
        "rows": rows,
        "floor_passes": sum(row.get("bytes", 0.0) for row in rows) / stream,
        # each parcel's distance and surface written once and read once; and each row of form factors written once
        "floor_cache": 16 * directions / stream,
        "floor_memory": 4 * receivers * wide / memory,
    }
