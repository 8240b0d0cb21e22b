"""Sun patches: pieces of outlines that a beam lights evenly, and what share of each element lies in them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons

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
    near, some = [], []
    for number, patch in enumerate(patches):
        mine = elements.members.get(int(outline_sheet[patch.outline]) + (0 if patch.front else elements.sheets))
        if mine is not None:
            near.append(elements.around(mine, patch.polygon))
            some.append(number)
    out = np.zeros((2, len(elements.corners)))
    shapes = [patches[number].polygon for number in some]
    for number, mine, share in zip(some, near, lit_shares(elements.corners, elements.areas, near, shapes), strict=True):
        out[min(patches[number].order, 1), mine] += patches[number].illuminance * share
    return out[0], out[1]


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
    inward, offset = _borders(polygons.pad(shapes)[0])
    shares, parts = [], []
    for number, mine in enumerate(some):
        a, b, c = (inward[number] @ triangles[mine].transpose(1, 2, 0)) - offset[number][:, None]
        inside = (np.minimum(np.minimum(a, b), c) >= 0).all(axis=0)
        parts.append(np.flatnonzero(~inside & (np.maximum(np.maximum(a, b), c) > 0).all(axis=0)))
        shares.append(inside.astype(float))
    count = [len(part) for part in parts]
    of = np.repeat(np.arange(len(parts)), count)
    cut = np.concatenate([mine[part] for mine, part in zip(some, parts, strict=True)])
    lit = triangles[cut]
    for edge in range(inward.shape[1]):
        lit = polygons.clip(lit, inward[of, edge], offset[of, edge])
    for share, part, found in zip(
        shares, parts, np.split(polygons.areas(lit) / areas[cut], np.cumsum(count)[:-1]), strict=True
    ):
        share[part] = found
    return shares


def _borders(shapes) -> tuple[np.ndarray, np.ndarray]:
    """Half-planes of polygons ``(m, v, 3)``: inward unit normals (m, v, 3) and offsets (m, v)."""
    edge = polygons.following(shapes) - shapes
    inward = polygons.cross(polygons.newell_normal(shapes)[:, None], edge)
    length = np.linalg.norm(inward, axis=2)
    true = length > _ROUNDING * length.max(axis=1, keepdims=True)
    inward = np.where(true[..., None], inward / np.where(true, length, 1.0)[..., None], 0.0)
    return inward, np.where(true, np.einsum("mvc,mvc->mv", inward, shapes), -1.0)
