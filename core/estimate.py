"""Estimate of errors: how far illuminances may be from exact ones, told by a finer globe at some of the nodes.

The globe's error falls with the square of its bands. So a second look at some nodes of each sheet, on a globe of twice
as many, differs from the first by most of what that is wrong by; what differs for the light at hand tells its error. (A
coarser one would not see what both err by: a bright strip smaller than the parcels of either is one sample in both.)
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
from .scattered import scattered_sight
from .tracing import ChainLimits

_SHARE = 0.04
_FEWEST, _MOST = 4, 400
_BEAMS = 1_200_000
"""Receivers, times parcels, that one thread looks at together."""

_FACETS = 100
"""Facets that are looked from themselves, of those that share receivers."""

FINER = 2.0
"""Bands of the second look's globe, over those of the first."""

_COARSER = math.sqrt(0.5)
"""The same where facets that share a receiver are compared with each other."""

OF_DIFFERENCE = 2.2
"""What about 95 of 100 errors are below, over the root mean square difference of the two globes."""

OF_MERGING = 0.4
"""The same over what patches twice as wide change: errors fall with the square of their width."""

OF_SPREAD = 2.0
"""The same over the root mean square of what facets get more or less than the mean that they share."""

OF_DOUBT = 0.3
"""The same for interpolation, over the surprise of the nodes around."""

_NEAR, _FALL = 0.25, 1.5
"""How samples count for an element at a distance: as 1 / (0.25 + d²/D²) to that power, D² the area of each."""

_OF_ALL = 0.7
"""And the mean over the whole sheet: as one at nearly that distance."""

_BLOCK = 1_000_000

LEAST = 5e-4
"""No error is told to be less than this share of the illuminance: patches, rounding, tolerance of the cycles."""


@dataclass(frozen=True, eq=False)
class Trial:
    """Some nodes, looked from on a finer globe.

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
    facets: Facets


@dataclass(frozen=True, eq=False)
class Facets:
    """Some facets that share a receiver, and what they see more of than its mean.

    Attributes
    ----------
    element : (f,) int
    targets : Targets
        As in `Trial`, on a coarser globe.
    cells : (f, c) float32
        Differences of form factors.
    sky : (f, s) float32
    sharing : (e,) bool
        Elements that share a receiver.
    """

    element: np.ndarray
    targets: Targets
    cells: np.ndarray
    sky: np.ndarray
    sharing: np.ndarray


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
    finer = _on_globe(geometry, FINER)
    targets = finer.targets
    own = np.setdiff1d(np.arange(len(nodes.points)), nodes.shared)
    some = own[_sample(nodes.sheet[own])]
    cells = np.zeros((len(some), targets.patches.count), np.float32)
    sky = np.zeros((len(some), targets.columns), np.float32)

    def work(chunk, checkpoint) -> None:
        rows = some[chunk]
        normal = geometry.element_normals[nodes.element[rows[0]]]
        if unhidden is not None:
            cells[chunk] = unhidden.factors(nodes.points[rows], normal)[:, :-1]
            return
        sight = sight_of(finer, limits, normal, float(normal @ nodes.points[rows[0]]))
        found = gather(sight, nodes.points[rows], targets, checkpoint)
        cells[chunk] = found.patches
        sky[chunk] = found.sky

    together = max(4, _BEAMS // targets.globe.count)
    chunks = chunks_of_receivers(nodes.points[some], nodes.sheet[some], geometry.planes, together)
    run_parallel(work, chunks, threads, lambda done: None)
    facets = _look_from_facets(_on_globe(geometry, _COARSER), nodes, limits, threads)
    return Trial(some, targets, cells, sky, facets)


def _on_globe(geometry: Geometry, times: float) -> Geometry:
    """With beams of so many times as many bands, on a sky of as many, and cells as patches."""
    globe = Globe.cut_at_horizon(max(2, round(times * geometry.beams.bands)))
    targets = Targets.of(geometry.planes, geometry.cells.patches, globe)
    return replace(geometry, targets=targets, beams=globe)


def _look_from_facets(geometry: Geometry, nodes: Nodes, limits: ChainLimits, threads: int) -> Facets:
    """Look from some of the facets that share a receiver, and from all of these together."""
    targets, served = geometry.targets, nodes.weights.turned(nodes.shared)
    several = np.diff(served.start)[served.rows] > 1
    facets, node = served.node[several], nodes.shared[served.rows[several]]
    sharing = np.zeros(len(geometry.element_points), bool)
    sharing[facets] = True
    pick = np.unique(np.linspace(0, len(facets) - 1, min(len(facets), _FACETS)).astype(int))
    cells = np.zeros((len(pick), targets.patches.count), np.float32)
    sky = np.zeros((len(pick), targets.columns), np.float32)

    def work(number: int, checkpoint) -> None:
        facet, shared = facets[pick[number]], node[pick[number]]
        point, normal = geometry.element_points[[facet]], geometry.element_normals[facet]
        its = sight_of(geometry, limits, normal, float(normal @ point[0]))
        for sign, sight in ((1.0, its), (-1.0, scattered_sight(geometry, limits, nodes.weights.turned([shared])))):
            found = gather(sight, point, targets, checkpoint)
            cells[number] += sign * found.patches[0]
            sky[number] += sign * found.sky[0]

    run_parallel(work, list(range(len(pick))), threads, lambda done: None)
    return Facets(facets[pick], targets, cells, sky, sharing)


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
    points: np.ndarray,
    sheet: np.ndarray,
    ours: np.ndarray,
    finer: np.ndarray,
    merging: np.ndarray,
    where: np.ndarray,
    where_sheet: np.ndarray,
) -> np.ndarray:
    """Errors of elements over their illuminance.

    Parameters
    ----------
    points : (k, 3) float
        Of the trial's nodes.
    sheet : (k,) int
    ours, finer : (k,) float
        Illuminance of these nodes, by both globes [lx].
    merging : (k,) float
        What they get more where neighbouring patches do not share their exitance [lx].
    where : (e, 3) float
        Of the elements.
    where_sheet : (e,) int

    Returns
    -------
    (e,) float
    """
    if not len(ours):
        return np.full(len(where), LEAST)
    floor = 1e-3 * max(float(ours.mean()), 1e-300)
    scale = np.maximum(ours, floor)
    by_globe, by_patches = (OF_DIFFERENCE * (ours - finer) / scale) ** 2, (OF_MERGING * merging / scale) ** 2
    found = np.full(len(where), float(by_globe.mean() + by_patches.mean()))
    samples, elements = (np.argsort(number, kind="stable") for number in (sheet, where_sheet))
    for one in np.unique(sheet):
        mine, its = (
            order[slice(*np.searchsorted(number, [one, one + 1], sorter=order))]
            for number, order in ((sheet, samples), (where_sheet, elements))
        )
        # few samples of a sheet tell little: they are weighed against all
        globe, patches = ((some[mine].sum() + 2 * some.mean()) / (len(mine) + 2) for some in (by_globe, by_patches))
        found[its] = _around(points[mine], by_globe[mine], globe, where[its]) + patches
    return np.sqrt(found)


def _around(points: np.ndarray, values: np.ndarray, mean: float, where: np.ndarray) -> np.ndarray:
    """(e,) float: means around places ``(e, 3)`` of a plane, of values at points ``(k, 3)`` and of their ``mean``."""
    found = np.empty(len(where))
    # six times their mean square is the area of a square's points, around its middle
    area = 6 * np.square(where - where.mean(axis=0)).sum(axis=1).mean() if len(where) else 0.0
    each = max(float(area) / len(points), 1e-300)
    step = max(1, _BLOCK // len(points))
    for first in range(0, len(where), step):
        some = slice(first, first + step)
        apart = np.square(where[some, None] - points).sum(axis=2)
        weight = (_NEAR + apart / each) ** -_FALL
        found[some] = (weight @ values + _OF_ALL * mean) / (weight.sum(axis=1) + _OF_ALL)
    return found


def spread_of_facets(facets: Facets, surface: np.ndarray, more: np.ndarray) -> np.ndarray:
    """(e,) float: what facets that share receivers differ by, surface by surface; 0 for all others [lx].

    Parameters
    ----------
    facets : Facets
    surface : (e,) int
        Of all elements.
    more : (f,) float
        What those that were looked from get more than the receivers that they share [lx].
    """
    if not len(more):
        return np.zeros(len(surface))
    count = np.bincount(surface[facets.element], minlength=surface.max() + 1)
    known = np.bincount(surface[facets.element], weights=more**2, minlength=len(count))
    # few samples of a surface tell little: they are weighed against all
    apart = np.sqrt((known + 2 * float((more**2).mean())) / (count + 2))
    return np.where(facets.sharing, OF_SPREAD * apart[surface], 0.0)
