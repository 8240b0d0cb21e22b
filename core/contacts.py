"""Contacts: elements divided along the lines where other surfaces touch them, so that each lies on one side.

A floor that runs on below a partition is bright on one side and dark on the other. An element across such a line would
send the light of both to either.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from . import clipping, polygons
from .fracture import Fracture
from .layout import Layout
from .planes import Planes

_SLIVER = 1e-9
"""Parts smaller than this share of a cell, or element, are left out."""

_MOST_SHEETS = 300
"""Where more sheets than this have elements in no run, these are left whole."""


def divided(cuts: Fracture, layouts: list[Layout], planes: Planes) -> Fracture:
    """Elements that lines of contact cut in triangles on one side each.

    Parameters
    ----------
    cuts : Fracture
    layouts : list of Layout
        Of its runs, where all elements of cut cells are divided.
    planes : Planes

    Returns
    -------
    Fracture
        One triangle of each such element has its number, the others follow after all elements.
    """
    found = [_of_run(cuts.elements, layout) for layout in layouts if layout.cut.any()]
    loose = np.ones(len(cuts.elements), bool)
    for grid in cuts.grids:
        loose[grid.elements] = False
    for sheet in _large(cuts, loose):
        found.append(_of_sheet(cuts.elements, np.flatnonzero(loose & (cuts.element_sheet == sheet)), sheet, planes))
    if not found:
        return cuts
    owner, triangles = (np.concatenate(part) for part in zip(*found, strict=True))
    first = np.diff(owner, prepend=-1) != 0
    elements = cuts.elements.copy()
    elements[owner[first]] = triangles[first]
    elements = np.concatenate([elements, triangles[~first]])
    more = owner[~first]
    return replace(
        cuts,
        elements=elements,
        element_side=np.concatenate([cuts.element_side, cuts.element_side[more]]),
        element_sheet=np.concatenate([cuts.element_sheet, cuts.element_sheet[more]]),
        element_areas=polygons.areas(elements),
    )


def _large(cuts: Fracture, loose: np.ndarray) -> list[int]:
    """Sheets of several elements that lie in no run, none where there are very many."""
    sheets, count = np.unique(cuts.element_sheet[loose], return_counts=True)
    sheets = sheets[count > 1]
    return sheets.tolist() if len(sheets) <= _MOST_SHEETS else []


def _of_sheet(elements: np.ndarray, mine: np.ndarray, sheet: int, planes: Planes) -> tuple[np.ndarray, np.ndarray]:
    """The same as `_of_run` for elements ``mine`` of a sheet that lie in no run."""
    axes = planes.sheet_axes[sheet % len(planes.sheet_surface)]
    corners = elements[mine] @ axes.T
    low = corners.min(axis=(0, 1))
    layout = Layout.over(sheet, (1, 1), axes, low, corners.max(axis=(0, 1)) - low, planes)
    owner, shapes, cut = mine, elements[mine], np.zeros(len(elements), bool)
    least = _SLIVER * np.bincount(mine, polygons.areas(shapes), len(elements))
    for line in layout.contacts:
        begin, way, wall = _standing_on(layout, line)
        above = (shapes - begin) @ wall
        reach = 1e-9 * planes.size
        hit = (above.min(axis=1) < -reach) & (above.max(axis=1) > reach)
        # what of the line lies within each shape, as shares of the contact
        next_above, share = np.roll(above, -1, axis=1), (shapes - begin) @ way / (way @ way)
        with np.errstate(divide="ignore", invalid="ignore"):
            at = share + above / (above - next_above) * (np.roll(share, -1, axis=1) - share)
        between = above * next_above <= 0
        first = np.where(between & np.isfinite(at), at, np.inf).min(axis=1)
        last = np.where(between & np.isfinite(at), at, -np.inf).max(axis=1)
        hit &= np.minimum(last, 1) - np.maximum(first, 0) > 1e-6
        cut[owner[hit]] = True
        owner, shapes = _parted(owner, shapes, hit, wall, float(wall @ begin), least)
    owner, triangles, areas = _fans(owner[cut[owner]], shapes[cut[owner]], least)
    order = np.lexsort((-areas, owner))
    return owner[order], triangles[order]


def _standing_on(layout: Layout, line: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where a line ``(2, 2)`` in cells begins, the way to its end [m], and the unit normal of a wall upon it."""
    begin, end = (layout.grid.place(place) for place in line)
    wall = polygons.cross(layout.grid.normal, end - begin)
    return begin, end - begin, wall / np.linalg.norm(wall)


def _parted(owner, shapes, some, normal, offset: float, least) -> tuple[np.ndarray, np.ndarray]:
    """Shapes ``(k, v, 3)`` with their owners, some of them ``(k,)`` bool in two by the plane ``normal · x = offset``.

    Parts of less than ``least`` of their owner are left out.
    """
    halves = [clipping.clip(shapes[some], sign * normal, sign * offset) for sign in (1.0, -1.0)]
    shapes = polygons.joined([shapes[~some], *halves])
    owner = np.concatenate([owner[~some], owner[some], owner[some]])
    kept = polygons.areas(shapes) > least[owner]
    return owner[kept], shapes[kept]


def _fans(owner: np.ndarray, shapes: np.ndarray, least: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shapes ``(k, v, 3)`` in triangles, with their owners and areas, but for those of less than ``least`` of these."""
    fans = [shapes[:, [0, k, k + 1]] for k in range(1, shapes.shape[1] - 1)]
    triangles, owner = np.concatenate(fans), np.tile(owner, len(fans))
    areas = polygons.areas(triangles)
    kept = areas > least[owner]
    return owner[kept], triangles[kept], areas[kept]


def _of_run(elements: np.ndarray, layout: Layout) -> tuple[np.ndarray, np.ndarray]:
    """What elements of cut cells are divided into: the element of each ``(t,)``, and triangles ``(t, 3, 3)``.

    Those of one element follow each other. First is, where possible, one of the side that most of its cell lies on, so
    that the halves of a cell can be compared.
    """
    grid = layout.grid
    least = np.full(len(elements), _SLIVER * float(grid.sides.prod()))
    cells = np.flatnonzero(layout.cut)
    owner = grid.first + np.stack([2 * cells, 2 * cells + 1], axis=1).ravel()
    shapes = elements[owner]
    for line, crossed in zip(layout.contacts, layout.crossed, strict=True):
        mine = np.isin((owner - grid.first) // 2, crossed)
        begin, _, wall = _standing_on(layout, line)
        owner, shapes = _parted(owner, shapes, mine, wall, float(wall @ begin), least)
    owner, triangles, areas = _fans(owner, shapes, least)
    side = layout.sides(grid.in_cells(triangles.mean(axis=1)))
    cell = (owner - grid.first) // 2
    _, part = np.unique(np.stack([cell, side]), axis=1, return_inverse=True)
    in_half = np.stack([np.bincount(part.reshape(-1), weights=areas * ((owner - grid.first) % 2 == h)) for h in (0, 1)])
    shared = np.where(in_half.min(axis=0) > 0, in_half.sum(axis=0), 0.0)[part.reshape(-1)]
    order = np.lexsort((-areas, -shared, owner))
    return owner[order], triangles[order]
