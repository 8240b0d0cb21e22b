"""Flaws: what is odd in a scene's geometry though it can be solved. They are told, never mended."""

from __future__ import annotations

import numpy as np

from . import polygons
from .scene import Surface

_SAME_NORMAL = 1e-6
_TOLD = 10
_MOST_PAIRS = 5_000_000
_MOST_CONVEX_SHEETS = 2_000
_CLOSED_ENOUGH = 0.5
_CHUNK = 20_000


def find_flaws(surfaces: list[Surface], size: float, outlines, outline_sheet, sheet_surface, sheet_normal) -> list[str]:
    """Say what is odd, in sentences that name the surfaces and the remedy.

    Parameters
    ----------
    surfaces : list of Surface
    size : float
        Diagonal of the scene [m]; what is smaller than a millionth of it counts as rounding.
    outlines : (o, w, 3) float, padded
    outline_sheet, sheet_surface : (o,) int, (s,) int
    sheet_normal : (s, 3) float

    Returns
    -------
    list of str
    """
    tolerance = 1e-6 * size
    first = np.full(len(sheet_normal), -1)
    first[outline_sheet[::-1]] = np.arange(len(outlines))[::-1]
    offsets = np.einsum("sc,sc->s", sheet_normal, outlines[first, 0])
    two_sided = np.array([surface.two_sided for surface in surfaces])[sheet_surface]
    pairs = overlapping_outlines(outlines, sheet_normal[outline_sheet], offsets[outline_sheet], tolerance)
    sheets = outline_sheet[pairs]
    same_side = np.einsum("pc,pc->p", sheet_normal[sheets[:, 0]], sheet_normal[sheets[:, 1]]) > 0
    meeting = same_side | two_sided[sheets].any(axis=1)  # one-sided faces back to back are a sheet with two sides
    told = _overlap_sentences(surfaces, sheet_surface[sheets[meeting]])
    if not two_sided.any() and looks_outward(outlines, outline_sheet, sheet_normal, offsets, tolerance):
        told.append(
            "All surfaces look outward and none sees another; if this is a room seen from inside, turn its normals "
            "(reverse the order of the vertices)"
        )
    return told


def _overlap_sentences(surfaces: list[Surface], pairs: np.ndarray) -> list[str]:
    told = []
    for one, two in np.unique(np.sort(pairs, axis=1), axis=0):
        a, b = surfaces[one], surfaces[two]
        if one == two:
            told.append(f"Surface '{a.name}': some of its faces lie on one another; remove the doubles")
        elif a.material == b.material:
            told.append(f"Surfaces '{a.name}' and '{b.name}' lie on one another in one plane; remove what is doubled")
        else:
            told.append(
                f"Surfaces '{a.name}' and '{b.name}' lie on one another in one plane with different materials, so "
                "which of them light meets is not defined; remove one, or move them apart"
            )
    if len(told) > _TOLD:
        more = len(told) - _TOLD
        del told[_TOLD:]
        told.append(f"{more} more pairs of surfaces lie on one another")
    return told


def overlapping_outlines(outlines, normals, offsets, tolerance: float) -> np.ndarray:
    """Pairs of convex polygons of one plane that overlap, whichever way they look.

    Parameters
    ----------
    outlines : (o, w, 3) float, padded
    normals : (o, 3) float, unit
    offsets : (o,) float
        Of the polygons' planes along their normals [m].
    tolerance : float
        How deep they may lie in each other, and how far apart their planes, and still only touch [m].

    Returns
    -------
    (p, 2) int
    """
    side = np.rint(normals / _SAME_NORMAL)
    leading = np.take_along_axis(side, (side != 0).argmax(axis=1)[:, None], axis=1)[:, 0]
    sign = np.where(leading < 0, -1.0, 1.0)
    _, direction = np.unique(side * sign[:, None] + 0.0, axis=0, return_inverse=True)
    height = offsets * sign
    order = np.lexsort((height, direction.reshape(-1)))
    apart = (np.diff(direction.reshape(-1)[order]) != 0) | (np.diff(height[order]) > tolerance)
    found = [np.zeros((0, 2), np.int64)]
    bounds = np.concatenate([[0], np.flatnonzero(apart) + 1, [len(order)]])
    for k in np.flatnonzero(np.diff(bounds) > 1):
        members = order[bounds[k] : bounds[k + 1]]
        flat = outlines[members] @ polygons.plane_basis(normals[members[0]]).T
        found.append(members[_overlapping(flat, tolerance)])
    return np.concatenate(found)


def _overlapping(flat: np.ndarray, tolerance: float) -> np.ndarray:
    """Pairs among convex polygons (n, w, 2): first by their boxes, sorted along x, then by separating axes."""
    low, high = flat.min(axis=1), flat.max(axis=1)
    order = np.argsort(low[:, 0], kind="stable")
    last = np.searchsorted(low[order, 0], high[order, 0] - tolerance)
    count = np.maximum(last - np.arange(1, len(order) + 1), 0)
    if count.sum() > _MOST_PAIRS:
        return np.zeros((0, 2), np.int64)  # a mesh so fine is no drawing with a sheet laid on another
    one = np.repeat(np.arange(len(order)), count)
    two = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count)
    a, b = order[one], order[two]
    near = np.minimum(high[a, 1], high[b, 1]) - np.maximum(low[a, 1], low[b, 1]) > tolerance
    pairs = np.stack([a[near], b[near]], axis=1)
    deep = [_depth(flat[part[:, 0]], flat[part[:, 1]]) > tolerance for part in _parts(pairs)]
    return pairs[np.concatenate(deep)] if deep else pairs


def _parts(pairs: np.ndarray) -> list[np.ndarray]:
    return [pairs[start : start + _CHUNK] for start in range(0, len(pairs), _CHUNK)]


def _depth(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(p,) float: how far convex polygons (p, w, 2) must move to part; not above 0 where they are apart."""
    edges = np.concatenate([np.roll(a, -1, axis=1) - a, np.roll(b, -1, axis=1) - b], axis=1)
    length = np.linalg.norm(edges, axis=2)
    axes = np.stack([-edges[..., 1], edges[..., 0]], axis=2) / np.where(length > 0, length, 1.0)[..., None]
    along_a, along_b = np.einsum("pec,pvc->pev", axes, a), np.einsum("pec,pvc->pev", axes, b)
    shared = np.minimum(along_a.max(axis=2), along_b.max(axis=2)) - np.maximum(along_a.min(axis=2), along_b.min(axis=2))
    return np.where(length > 0, shared, np.inf).min(axis=1)


def looks_outward(outlines, outline_sheet, sheet_normal, offsets, tolerance: float) -> bool:
    """Whether the sheets stand around a space and all turn their backs to it: the fronts see one another nowhere."""
    area = polygons.areas(outlines)
    if len(sheet_normal) > _MOST_CONVEX_SHEETS:
        return False
    sum_of_areas = (area[:, None] * sheet_normal[outline_sheet]).sum(axis=0)
    if len(np.unique(np.rint(sheet_normal), axis=0)) < 4 or np.linalg.norm(sum_of_areas) > _CLOSED_ENOUGH * area.sum():
        return False
    points = outlines.reshape(-1, 3)
    return all(
        (points @ normal - offset).max() <= tolerance for normal, offset in zip(sheet_normal, offsets, strict=True)
    )
