"""Planes: coplanar pieces of a surface joined into as few convex polygons as possible.

What blocks the view is a plane's outline, not its mesh: a wall of a thousand coplanar quads is projected as one
polygon.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from . import polygons, rings
from .scene import Scene

_SAME_NORMAL = 1e-7
_JOIN_AT_MOST = 4000

_MOST_CORNERS = 32
"""Outlines of more are parted: arrays of outlines are as wide as the one of most corners."""


@dataclass(frozen=True, eq=False)
class Planes:
    """The scene's geometry, relative to ``centre``.

    A *sheet* is a set of coplanar, equally oriented pieces of one surface.

    Attributes
    ----------
    centre : (3,) float
        Middle of the scene's bounding box [m]; subtracted from all coordinates, so that far-off scenes lose no digits.
    size : float
        Diagonal of the bounding box [m].
    surfaces : list of str
    given, given_counts, given_sheet, given_source : (g, v, 3) float, (g,) int, (g,) int, (g,) int
        Pieces as added to the scene: what is fractured into faces.
    sheet_surface : (s,) int
    sheet_normal : (s, 3) float
    sheet_axes : (s, 2, 3) float
        In-plane axes, along the sheet's longest edge.
    outlines, outline_sheet : (o, w, 3) float, padded, and (o,) int
        Convex polygons that block the view.
    stands_for : (2 s,) int
        Of s sheets, side k is the front of sheet k, side s + k its back: the side that light meets there. Its own but
        for doubled sheets, whose outlines are left out (see `doubles.seen_once`).
    """

    centre: np.ndarray
    size: float
    surfaces: list[str]
    given: np.ndarray
    given_counts: np.ndarray
    given_sheet: np.ndarray
    given_source: np.ndarray
    sheet_surface: np.ndarray
    sheet_normal: np.ndarray
    sheet_axes: np.ndarray
    outlines: np.ndarray
    outline_sheet: np.ndarray
    stands_for: np.ndarray


def find_planes(scene: Scene) -> Planes:
    """Group the scene's pieces into sheets and join each sheet's outline.

    Parameters
    ----------
    scene : Scene
        With at least one surface.

    Returns
    -------
    Planes
    """
    surfaces = list(scene.surfaces.values())
    low = np.min([s.pieces.reshape(-1, 3).min(axis=0) for s in surfaces], axis=0)
    high = np.max([s.pieces.reshape(-1, 3).max(axis=0) for s in surfaces], axis=0)
    centre, size = 0.5 * (low + high), float(np.linalg.norm(high - low))
    given, counts, sheets, sources = [], [], [], []
    sheet_surface: list[int] = []
    sheet_normal: list[np.ndarray] = []
    outlines: list[np.ndarray] = []
    outline_of: list[int] = []
    for number, surface in enumerate(surfaces):
        pieces = surface.pieces - centre
        normal = polygons.newell_normal(pieces)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        offset = np.einsum("mc,mc->m", normal, pieces.mean(axis=1))
        key = np.concatenate([np.rint(normal / _SAME_NORMAL), np.rint(offset / (1e-7 * size))[:, None]], axis=1)
        key = np.concatenate([key, _copies(pieces, 1e-7 * size)[:, None]], axis=1)
        _, first, sheet = np.unique(key, axis=0, return_index=True, return_inverse=True)
        sheet = sheet.reshape(-1)
        given += list(zip(pieces, surface.counts, strict=True))
        counts.append(surface.counts)
        sheets.append(sheet + len(sheet_surface))
        sources.append(surface.source_faces)
        members = np.argsort(sheet, kind="stable")
        bounds = np.searchsorted(sheet[members], np.arange(len(first) + 1))
        for k, representative in enumerate(first):
            mine = members[bounds[k] : bounds[k + 1]]
            loops = [pieces[m, : surface.counts[m]] for m in mine]
            joined = join_outline(loops, normal[representative]) if 1 < len(mine) <= _JOIN_AT_MOST else loops
            outlines += joined
            outline_of += [len(sheet_surface)] * len(joined)
            sheet_surface.append(number)
            sheet_normal.append(normal[representative])
    padded, given_counts = polygons.pad([p[:c] for p, c in given])
    axes = _sheet_axes(np.array(sheet_normal), polygons.pad(outlines)[0], np.array(outline_of))
    parts = [rings.of_few_corners(outline, _MOST_CORNERS) for outline in outlines]
    outline_sheet = np.repeat(outline_of, [len(some) for some in parts])
    return Planes(
        centre=centre,
        size=size,
        surfaces=[s.name for s in surfaces],
        given=padded,
        given_counts=given_counts,
        given_sheet=np.concatenate(sheets),
        given_source=np.concatenate(sources),
        sheet_surface=np.array(sheet_surface),
        sheet_normal=np.array(sheet_normal),
        sheet_axes=axes,
        outlines=polygons.pad([part for some in parts for part in some])[0],
        outline_sheet=outline_sheet,
        stands_for=np.arange(2 * len(sheet_surface)),
    )


def _copies(pieces: np.ndarray, tolerance: float) -> np.ndarray:
    """(m,) int: how many earlier pieces each is a copy of, by middle and extent: copies are sheets of their own."""
    measures = np.concatenate([pieces.min(axis=1), pieces.max(axis=1), pieces.sum(axis=1) / pieces.shape[1]], axis=1)
    numbers = np.rint(measures / tolerance).astype(np.int64).view(np.uint64)
    mixed = np.zeros(len(pieces), np.uint64)
    for column in numbers.T:  # after Fowler, Noll & Vo
        mixed = (mixed ^ column) * np.uint64(0x9E3779B97F4A7C15)
        mixed ^= mixed >> np.uint64(29)
    _, of, counts = np.unique(mixed, return_inverse=True, return_counts=True)
    rank = np.zeros(len(pieces), np.int64)
    if counts.max() > 1:
        order = np.argsort(of.reshape(-1), kind="stable")
        rank[order] = np.arange(len(order)) - np.repeat(np.cumsum(counts) - counts, counts)
    return rank


def _sheet_axes(normals: np.ndarray, outlines: np.ndarray, outline_sheet: np.ndarray) -> np.ndarray:
    edges = np.roll(outlines, -1, axis=1) - outlines
    length = np.linalg.norm(edges, axis=2)
    longest = np.argmax(length, axis=1)
    rows = np.arange(len(outlines))
    order = np.argsort(length[rows, longest], kind="stable")
    first = np.zeros_like(normals)
    first[outline_sheet[order]] = edges[rows, longest][order]  # the longest of each sheet is written last
    first -= normals * np.einsum("sc,sc->s", first, normals)[:, None]
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, polygons.cross(normals, first)], axis=1)


def join_outline(loops: list[np.ndarray], normal: np.ndarray) -> list[np.ndarray]:
    """Convex polygons that cover the same area as edge-sharing coplanar loops.

    Edges walked both ways cancel; what is left are the outlines. Where these do not close into simple loops without
    holes (doubled faces, touching corners), the loops come back as they were.

    Parameters
    ----------
    loops : list of (k, 3) float arrays
    normal : (3,) float

    Returns
    -------
    list of (k, 3) float arrays
    """
    basis = polygons.plane_basis(normal)
    points = np.concatenate(loops)
    origin = points.mean(axis=0)
    flat = (points - origin) @ basis.T
    extent = np.ptp(flat, axis=0).max()
    first, ids = rings.welded(flat, 1e-7 * extent)
    starts = np.cumsum([0] + [len(p) for p in loops])
    nxt: dict[int, int] = {}
    edges = set()
    for a, b in itertools.pairwise(starts):
        loop = ids[a:b]
        for one, two in zip(loop, np.roll(loop, -1), strict=True):
            if one == two or (one, two) in edges:
                return loops
            edges.add((int(one), int(two)))
    for one, two in edges:
        if (two, one) not in edges:
            if one in nxt:
                return loops
            nxt[one] = two
    outer: list[np.ndarray] = []
    while nxt:
        start, here = next(iter(nxt.items()))
        ring = [start]
        del nxt[start]
        while here != start:
            ring.append(here)
            if here not in nxt:
                return loops
            here = nxt.pop(here)
        outer.append(rings.simplify(flat[first[ring]], 1e-9 * extent))
    signed = [0.5 * polygons.newell_normal(np.c_[ring, np.zeros(len(ring))])[2] for ring in outer]
    if any(area <= 0 for area in signed):
        return loops  # holes: the given faces describe them already
    parts = [part for ring in outer for part in rings.convex_parts(ring, 1e-9 * extent)]
    if abs(sum(signed) - sum(polygons.areas(p) for p in loops)) > 1e-9 * extent**2 or len(parts) >= len(loops):
        return loops
    if abs(sum(polygons.areas(np.c_[p, np.zeros(len(p))]) for p in parts) - sum(signed)) > 1e-9 * extent**2:
        return loops  # rings that touch themselves
    return [part @ basis + origin for part in parts]
