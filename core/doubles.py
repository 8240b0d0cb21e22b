"""Doubles: sheets that lie in another of the same shape and material, and so are seen once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from . import polygons
from .gaps import ways
from .planes import Planes
from .scene import Surface

_SAME_PLACE = 1e-6
"""Over the scene's size: what lies nearer than this to another sheet's outline, lies on it."""


def seen_once(planes: Planes, surfaces: Sequence[Surface]) -> Planes:
    """Planes without the outlines of doubled sheets, of which the last is kept: it blocks, mirrors and shines for all.

    Parameters
    ----------
    planes : Planes
    surfaces : sequence of Surface

    Returns
    -------
    Planes
        With ``stands_for`` of the doubled sheets' sides.
    """
    count = len(planes.sheet_surface)
    stands_for = planes.stands_for.copy()
    for group in _alike(planes):
        for sheet in group.tolist():
            for other in group[group > sheet][::-1].tolist():
                one, two = surfaces[planes.sheet_surface[sheet]], surfaces[planes.sheet_surface[other]]
                same_way = float(planes.sheet_normal[sheet] @ planes.sheet_normal[other]) > 0
                replaces = two.two_sided or (same_way and not one.two_sided)
                if one.material == two.material and replaces and _lies_on(planes, sheet, other):
                    sides = [other, other + count] if same_way else [other + count, other]
                    stands_for[[sheet, sheet + count]] = sides
                    break
    if (stands_for == planes.stands_for).all():
        return planes
    shown = stands_for[:count] == np.arange(count)
    kept = shown[planes.outline_sheet]
    return replace(
        planes, outlines=planes.outlines[kept], outline_sheet=planes.outline_sheet[kept], stands_for=stands_for
    )


def _alike(planes: Planes) -> list[np.ndarray]:
    """Groups of sheets, rising, of the same middle, area and plane as far as numbers tell."""
    count = len(planes.sheet_surface)
    area = polygons.areas(planes.outlines)
    total = np.maximum(np.bincount(planes.outline_sheet, area, count), 1e-300)
    middle = polygons.centroids(planes.outlines) * area[:, None]
    places = [np.bincount(planes.outline_sheet, middle[:, axis], count) / total for axis in range(3)]
    # what rounding parts here may have a neighbour's number
    numbers = np.rint(np.stack([*places, np.sqrt(total)], axis=1) / (4 * _SAME_PLACE * planes.size) + 0.25)
    _, group = np.unique(numbers.astype(np.int64) @ [1, 1_000_003, 998_244_353, 7_368_787], return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(group, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(group[order])) + 1)
    return [part for part in parts if len(part) > 1]


def _lies_on(planes: Planes, sheet: int, other: int) -> bool:
    """Whether two sheets of equal area lie in one plane, all corners of the one on the other."""
    if abs(float(planes.sheet_normal[sheet] @ planes.sheet_normal[other])) < 1 - 1e-9:
        return False
    corners = planes.outlines[planes.outline_sheet == sheet].reshape(-1, 3)
    on = planes.outlines[planes.outline_sheet == other]
    normals = np.repeat(planes.sheet_normal[other][None], len(on), axis=0)
    distance = np.linalg.norm(ways(corners, on, normals), axis=2).min(axis=0)
    return bool(distance.max() < _SAME_PLACE * planes.size)
