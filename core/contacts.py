"""Contacts: elements divided along the lines where other surfaces touch them, so that each lies on one side.

A floor that runs on below a partition is bright on one side and dark on the other. An element across such a line would
send the light of both to either.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from . import polygons
from .fracture import Fracture
from .layout import Layout

_SLIVER = 1e-9
"""Parts smaller than this share of a cell are left out."""


def divided(cuts: Fracture, layouts: list[Layout]) -> Fracture:
    """Elements of cells that lines of contact cut in triangles on one side each.

    Parameters
    ----------
    cuts : Fracture
    layouts : list of Layout
        Of its runs.

    Returns
    -------
    Fracture
        One triangle of each such element has its number, the others follow after all elements.
    """
    found = [_triangles(cuts.elements, layout) for layout in layouts if layout.cut.any()]
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


def _triangles(elements: np.ndarray, layout: Layout) -> tuple[np.ndarray, np.ndarray]:
    """What elements of cut cells are divided into: the element of each ``(t,)``, and triangles ``(t, 3, 3)``.

    Those of one element follow each other. First is, where possible, one of the side that most of its cell lies on, so
    that the halves of a cell can be compared.
    """
    grid = layout.grid
    least = _SLIVER * float(grid.sides.prod())
    cells = np.flatnonzero(layout.cut)
    owner = grid.first + np.stack([2 * cells, 2 * cells + 1], axis=1).ravel()
    shapes = elements[owner]
    for line, crossed in zip(layout.contacts, layout.crossed, strict=True):
        mine = np.isin((owner - grid.first) // 2, crossed)
        begin, end = (grid.place(place) for place in line)
        wall = polygons.cross(grid.normal, end - begin)
        wall /= np.linalg.norm(wall)
        halves = [polygons.clip(shapes[mine], sign * wall, sign * float(wall @ begin)) for sign in (1.0, -1.0)]
        shapes = polygons.joined([shapes[~mine], *halves])
        owner = np.concatenate([owner[~mine], owner[mine], owner[mine]])
        kept = polygons.areas(shapes) > least
        shapes, owner = shapes[kept], owner[kept]
    fans = [shapes[:, [0, k, k + 1]] for k in range(1, shapes.shape[1] - 1)]
    triangles, owner = np.concatenate(fans), np.tile(owner, len(fans))
    areas = polygons.areas(triangles)
    kept = areas > least
    triangles, owner, areas = triangles[kept], owner[kept], areas[kept]
    side = layout.sides(grid.in_cells(triangles.mean(axis=1)))
    cell = (owner - grid.first) // 2
    _, part = np.unique(np.stack([cell, side]), axis=1, return_inverse=True)
    in_half = np.stack([np.bincount(part.reshape(-1), weights=areas * ((owner - grid.first) % 2 == h)) for h in (0, 1)])
    shared = np.where(in_half.min(axis=0) > 0, in_half.sum(axis=0), 0.0)[part.reshape(-1)]
    order = np.lexsort((-areas, -shared, owner))
    return owner[order], triangles[order]
