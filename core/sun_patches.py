"""Sun patches: pieces of outlines that a beam lights evenly, and what share of each element lies in them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import clipping, polygons

_ROUNDING = 1e-11


@dataclass(frozen=True, eq=False)
class SunPatch:
    """A convex piece of an outline that a beam lights evenly.

    Attributes
    ----------
    outline : int
    front : bool
    polygon : (v, 3) float
    illuminance : float
        Incident on the surface [lx].
    order : int
        Mirrors on the way.
    """

    outline: int
    front: bool
    polygon: np.ndarray
    illuminance: float
    order: int


@dataclass(frozen=True, eq=False)
class Triangles:
    """Elements, sheet by sheet.

    Attributes
    ----------
    corners : (e, 3, 3) float
    sheet : (e,) int, plus ``sheets`` for backs
    sheets : int
    """

    corners: np.ndarray
    sheet: np.ndarray
    sheets: int

    @cached_property
    def members(self) -> dict[int, np.ndarray]:
        """Elements of each side of a sheet that has some."""
        order = np.argsort(self.sheet, kind="stable")
        parts = np.split(order, np.flatnonzero(np.diff(self.sheet[order])) + 1)
        return {int(self.sheet[part[0]]): part for part in parts if len(part)}

    @cached_property
    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """(3, e) float twice: lowest and highest coordinates of each."""
        return np.ascontiguousarray(self.corners.min(axis=1).T), np.ascontiguousarray(self.corners.max(axis=1).T)

    @cached_property
    def areas(self) -> np.ndarray:
        """(e,) float [m²]."""
        return polygons.areas(self.corners)

    def around(self, some: np.ndarray, polygon) -> np.ndarray:
        """(k,) int: of some of them those that may lie within a polygon, by the boxes that bound them."""
        low, high = polygon.min(axis=0), polygon.max(axis=0)
        rounding = 1e-6 * (high - low).max()
        lowest, highest = self.boxes
        for axis in range(3):
            mine = highest[axis].take(some) >= low[axis] - rounding
            mine &= lowest[axis].take(some) <= high[axis] + rounding
            some = some[mine]
        return some


def light_elements(patches: list[SunPatch], elements: Triangles, outline_sheet) -> tuple[np.ndarray, np.ndarray]:
    """Mean illuminance on elements from sun patches: exactly the lit share of each.

    Parameters
    ----------
    patches : list of SunPatch
    elements : Triangles
    outline_sheet : (o,) int

    Returns
    -------
    direct, specular : (e,) float [lx]
        By patches that came straight, and by mirrors.
    """
    lit, near = _nearby(patches, elements, outline_sheet)
    out = np.zeros((2, len(elements.corners)))
    shapes = [patch.polygon for patch in lit]
    for patch, mine, share in zip(lit, near, lit_shares(elements.corners, elements.areas, near, shapes), strict=True):
        out[min(patch.order, 1), mine] += patch.illuminance * share
    return out[0], out[1]


def shifts(patches: list[SunPatch], elements: Triangles, outline_sheet) -> np.ndarray:
    """Where within elements sunlight falls: its illuminance times the way from the element's centroid to its own.

    Parameters
    ----------
    patches, elements, outline_sheet
        As for `light_elements`.

    Returns
    -------
    (e, 3) float [lx · m]
    """
    lit, near = _nearby(patches, elements, outline_sheet)
    out = np.zeros((len(elements.corners), 3))
    if not lit:
        return out
    _, parts, pieces = _lit_parts(elements.corners, near, [patch.polygon for patch in lit])
    cut = np.concatenate([mine[part] for mine, part in zip(near, parts, strict=True)])
    lux = np.repeat([patch.illuminance for patch in lit], [len(part) for part in parts])
    away = polygons.centroids(pieces) - elements.corners[cut].mean(axis=1)
    np.add.at(out, cut, (lux * polygons.areas(pieces) / elements.areas[cut])[:, None] * away)
    return out


def _nearby(patches: list[SunPatch], elements: Triangles, outline_sheet) -> tuple[list[SunPatch], list[np.ndarray]]:
    """Patches on sides that have elements, and the elements that may lie in each."""
    lit, near = [], []
    for patch in patches:
        mine = elements.members.get(int(outline_sheet[patch.outline]) + (0 if patch.front else elements.sheets))
        if mine is not None:
            near.append(elements.around(mine, patch.polygon))
            lit.append(patch)
    return lit, near


def lit_shares(triangles, areas, some: list[np.ndarray], shapes: list[np.ndarray]) -> list[np.ndarray]:
    """Shares of triangles' areas inside coplanar convex polygons.

    Parameters
    ----------
    triangles : (e, 3, 3) float
    areas : (e,) float
    some : list of (n,) int
        For each polygon, the triangles that count.
    shapes : list of (v, 3) float

    Returns
    -------
    list of (n,) float
    """
    if not shapes:
        return []
    shares, parts, pieces = _lit_parts(triangles, some, shapes)
    found = np.split(polygons.areas(pieces), np.cumsum([len(part) for part in parts])[:-1])
    for mine, share, part, lit in zip(some, shares, parts, found, strict=True):
        share[part] = lit / areas[mine[part]]
    return shares


def _lit_parts(triangles, some: list[np.ndarray], shapes: list[np.ndarray]):
    """What of some triangles lies inside polygons, at least one, as for `lit_shares`.

    Returns
    -------
    inside : list of (n,) float
        1 for triangles that lie wholly inside each polygon.
    parts : list of (k,) int
        Those, of the ``some``, that each polygon cuts.
    pieces : (sum of k, v, 3) float
        What of these is inside.
    """
    inward, offset = _borders(polygons.pad(shapes)[0])
    insides, parts = [], []
    for number, mine in enumerate(some):
        a, b, c = (inward[number] @ triangles[mine].transpose(1, 2, 0)) - offset[number][:, None]
        inside = (np.minimum(np.minimum(a, b), c) >= 0).all(axis=0)
        parts.append(np.flatnonzero(~inside & (np.maximum(np.maximum(a, b), c) > 0).all(axis=0)))
        insides.append(inside.astype(float))
    of = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    pieces = triangles[np.concatenate([mine[part] for mine, part in zip(some, parts, strict=True)])]
    for edge in range(inward.shape[1]):
        pieces = clipping.clip(pieces, inward[of, edge], offset[of, edge])
    return insides, parts, pieces


def _borders(shapes) -> tuple[np.ndarray, np.ndarray]:
    """Half-planes of polygons ``(m, v, 3)``: inward unit normals (m, v, 3) and offsets (m, v)."""
    edge = polygons.following(shapes) - shapes
    inward = polygons.cross(polygons.newell_normal(shapes)[:, None], edge)
    length = np.linalg.norm(inward, axis=2)
    true = length > _ROUNDING * length.max(axis=1, keepdims=True)
    inward = np.where(true[..., None], inward / np.where(true, length, 1.0)[..., None], 0.0)
    return inward, np.where(true, np.einsum("mvc,mvc->mv", inward, shapes), -1.0)
