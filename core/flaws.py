"""Flaws: what is odd in a scene's geometry though it can be solved. They are told, never mended."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons
from .planes import Planes
from .scene import Surface

ERROR, WARNING = "error", "warning"
OF_MESHES = ("no area", "not flat", "turned over in a mesh")
"""Kinds that are known, and told, as soon as a mesh is added."""

_SAME_NORMAL = 1e-6
_UPRIGHT, _ALIKE, _THIN_PANE, _EDGES = 1e-3, 0.1, 0.1, 3
_MOST_PAIRS = 5_000_000
_MOST_CONVEX_SHEETS = 2_000
_CLOSED_ENOUGH = 0.5
_CHUNK = 20_000


@dataclass(frozen=True, eq=False)
class Finding:
    """One thing that is odd in a scene.

    Attributes
    ----------
    severity : "error" or "warning"
        An error stops a solve, a warning goes with its result.
    kind : str
        What sort of thing it is, in two or three words, e.g. ``"gap"``.
    surface : str
        The surface to mend; empty where the whole scene is meant.
    faces : (k,) int
        Its faces concerned, by index as given to `Scene.add` (0 for a surface of one polygon).
    message, remedy : str
        What is odd, and what to do about it; ``str(finding)`` is both in one sentence.
    others : dict of str to (k,) int
        Further surfaces concerned and their faces.
    """

    severity: str
    kind: str
    surface: str
    faces: np.ndarray
    message: str
    remedy: str
    others: dict[str, np.ndarray]

    def __str__(self) -> str:
        return f"{self.message}; {self.remedy}"


def warning(kind: str, concerned: dict[str, np.ndarray], message: str, remedy: str, severity: str = WARNING) -> Finding:
    """Finding about the faces of some surfaces, of which the first is named first."""
    name = next(iter(concerned), "")
    others = {other: faces for other, faces in concerned.items() if other != name}
    return Finding(severity, kind, name, concerned.get(name, np.zeros(0, np.int64)), message, remedy, others)


def mesh_flaws(surface: Surface) -> list[Finding]:
    """What a mesh had to be mended of when it was added, and faces that look to the wrong side."""
    return [
        warning(kind, {surface.name: faces}, f"Surface '{surface.name}': {said}", remedy)
        for kind, (faces, said, remedy) in surface.flaws.items()
    ]


def thick_panes(surfaces: list[Surface], planes: Planes) -> list[Finding]:
    """Panes drawn as solids, whose light passes two sides with the whole pane's transmittance each."""
    areas = np.bincount(planes.outline_sheet, polygons.areas(planes.outlines), len(planes.sheet_surface))
    heights = np.einsum("oc,oc->o", planes.sheet_normal[planes.outline_sheet], planes.outlines[:, 0])
    height = np.zeros(len(areas))
    height[planes.outline_sheet] = heights
    found = []
    for number, surface in enumerate(surfaces):
        sheets = np.flatnonzero(planes.sheet_surface == number)
        if not surface.material.is_transparent or not 5 <= len(sheets) <= _MOST_CONVEX_SHEETS:
            continue
        front = sheets[np.argmax(areas[sheets])]
        cosine = planes.sheet_normal[sheets] @ planes.sheet_normal[front]
        backs, edges = sheets[cosine < _SAME_NORMAL - 1], sheets[np.abs(cosine) < _UPRIGHT]
        thick = np.abs(height[front] + height[backs])
        alike = np.abs(areas[backs] - areas[front]) < _ALIKE * areas[front]
        thin = backs[alike & (thick < _THIN_PANE * np.sqrt(areas[front]))]
        if len(thin) and len(edges) >= _EDGES:
            width = 1000 * float(np.abs(height[front] + height[thin]).min())
            concerned = np.isin(planes.given_sheet, [front, *thin])
            found.append(
                warning(
                    "glass twice",
                    {surface.name: np.unique(planes.given_source[concerned])},
                    f"Surface '{surface.name}' is a solid {width:.3g} mm thick that light goes straight through: it "
                    "passes two panes, each with the whole transmittance",
                    "draw the pane as one sheet",
                )
            )
    return found


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
