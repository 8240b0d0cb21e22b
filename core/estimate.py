"""Estimate of errors: how far illuminances may be from exact ones, told by a coarser globe at some of the nodes.

The globe's error falls with the square of its bands. So a second look at some nodes of each sheet, on a globe of half
as many parcels, differs from the first by more than that is wrong; what differs for the light at hand tells its error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from .convex import ConvexRoom
from .gather import Targets, gather
from .geometry import Geometry, sight_of
from .globe import Globe
from .nodes import Nodes
from .parallel import chunks_of_receivers, run_parallel
from .specular import ChainLimits

_SHARE = 0.04
_FEWEST, _MOST = 4, 400
_TOGETHER = 200

OF_DIFFERENCE = 1.4
"""What about 95 of 100 errors are below, over the root mean square difference of the two globes."""

OF_MERGING = 0.35
"""The same over what patches twice as wide change: errors fall with the square of their width."""

OF_DOUBT = 0.5
"""The same for interpolation, over the surprise of the nodes around."""

LEAST = 5e-4
"""No error is told to be less than this share of the illuminance: patches, rounding, tolerance of the cycles."""


@dataclass(frozen=True, eq=False)
class Trial:
    """Some nodes, looked from on a coarser globe.

    Attributes
    ----------
    nodes : (k,) int
    targets : Targets
        With `Geometry.cells` as patches.
    cells : (k, c) float32
    sky : (k, s) float32
        Straight and by mirrors.
    """

    nodes: np.ndarray
    targets: Targets
    cells: np.ndarray
    sky: np.ndarray


def make_trial(
    geometry: Geometry, nodes: Nodes, limits: ChainLimits, threads: int, unhidden: ConvexRoom | None
) -> Trial:
    """Look once more from some nodes of each sheet.

    Parameters
    ----------
    geometry : Geometry
    nodes : Nodes
    limits : ChainLimits
    threads : int
    unhidden : ConvexRoom or None
        In cells: the globe has no part in what receivers see, so that it errs nowhere.

    Returns
    -------
    Trial
    """
    bands = max(2, round(geometry.targets.globe.bands / math.sqrt(2)))
    targets = Targets.of(geometry.planes, geometry.cells.patches, Globe.cut_at_horizon(bands))
    coarse = replace(geometry, targets=targets)
    some = _sample(nodes.sheet)
    cells = np.zeros((len(some), targets.patches.count), np.float32)
    sky = np.zeros((len(some), targets.columns), np.float32)

    def work(chunk, checkpoint) -> None:
        rows = some[chunk]
        normal = geometry.element_normals[nodes.element[rows[0]]]
        if unhidden is not None:
            cells[chunk] = unhidden.factors(nodes.points[rows], normal)[:, :-1]
            return
        sight = sight_of(coarse, limits, normal, float(normal @ nodes.points[rows[0]]))
        found = gather(sight, nodes.points[rows], targets, checkpoint)
        cells[chunk] = found.patches
        sky[chunk] = found.sky

    chunks = chunks_of_receivers(nodes.points[some], nodes.sheet[some], geometry.planes, _TOGETHER)
    run_parallel(work, chunks, threads, lambda done: None)
    return Trial(some, targets, cells, sky)


def _sample(sheet: np.ndarray) -> np.ndarray:
    """Numbers of some nodes of each sheet, evenly among them; of few sheets' where there are very many."""
    order = np.argsort(sheet, kind="stable")
    starts = np.flatnonzero(np.concatenate(([True], np.diff(sheet[order]) > 0))) if len(order) else np.zeros(0, int)
    sizes = np.diff(np.append(starts, len(order)))
    picked = []
    step = max(1, math.ceil(len(starts) * _FEWEST / _MOST))
    for start, size in zip(starts[::step], sizes[::step], strict=True):
        count = min(size, max(_FEWEST, round(_SHARE * size)))
        picked.append(order[start + ((np.arange(count) + 0.5) * size / count).astype(int)])
    return np.sort(np.concatenate(picked)) if picked else np.zeros(0, np.int64)


def relative_errors(
    trial: Trial, sheet: np.ndarray, ours: np.ndarray, coarser: np.ndarray, merging: np.ndarray, sheets: int
) -> np.ndarray:
    """(sheets,) float: error of each sheet's nodes over their illuminance.

    Parameters
    ----------
    trial : Trial
    sheet : (m,) int, of all nodes
    ours, coarser : (k,) float
        Illuminance of the trial's nodes, by both globes [lx].
    merging : (k,) float
        What they get more where neighbouring patches do not share their exitance [lx].
    sheets : int
    """
    if not len(ours):
        return np.full(sheets, LEAST)
    floor = 1e-3 * max(float(ours.mean()), 1e-300)
    scale = np.maximum(ours, floor)
    squared = (OF_DIFFERENCE * (ours - coarser) / scale) ** 2 + (OF_MERGING * merging / scale) ** 2
    mine = sheet[trial.nodes]
    count = np.bincount(mine, minlength=sheets)
    known = np.bincount(mine, weights=squared, minlength=sheets)
    # few samples of a sheet tell little: they are weighed against all
    return np.sqrt((known + 2 * squared.mean()) / (count + 2))
