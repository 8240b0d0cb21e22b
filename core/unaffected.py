"""Unaffected: receivers of an earlier transfer that see nothing of what has changed, and so keep their form factors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons
from .arrays import box_corners
from .form_factors import Rows
from .geometry import Geometry
from .nodes import Nodes

_TOUCHING = 1e-9
"""Height beyond a wall's plane, over the scene's size, up to which what touches the wall counts as behind it."""

_MOST_BOXES = 40
"""If more surfaces than this changed, as they were and as they are, one box stands for all."""

_ROWS = 256


@dataclass(frozen=True, eq=False)
class Unaffected:
    """Rows of an earlier transfer, for those receivers that they hold for.

    Attributes
    ----------
    geometry, before : Geometry
        As it is, and as it was.
    nodes : Nodes
        The earlier receivers.
    rows : Rows
        Theirs.
    boxes : (b, 2, 3) float
        Around all that changed, as it was and as it is.
    screens : (s,) int
        Outlines that nothing is seen through, and that stood there before.
    patch : (q,) int
        Number that each earlier patch has now; -1 where it is cut otherwise.
    """

    geometry: Geometry
    before: Geometry
    nodes: Nodes
    rows: Rows
    boxes: np.ndarray
    screens: np.ndarray
    patch: np.ndarray

    @classmethod
    def of(cls, geometry: Geometry, before: Geometry, nodes: Nodes, rows: Rows, changed: set[str]) -> Unaffected:
        """Compare two scenes of the same bounding box.

        Parameters
        ----------
        geometry, before : Geometry
        nodes : Nodes
            The earlier receivers.
        rows : Rows
            Theirs.
        changed : set of str
            Surfaces that were added, taken away or moved, or that mirror or transmit otherwise.
        """
        boxes = np.array([box for one in (before, geometry) for box in _boxes(one, changed)]).reshape(-1, 2, 3)
        if len(boxes) > _MOST_BOXES:
            boxes = np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])[None]
        planes = geometry.planes
        lasting = np.array([name not in changed for name in planes.surfaces])
        clear = np.array([m.is_transparent for m in geometry.outlines.materials])
        screens = np.flatnonzero(lasting[planes.sheet_surface[planes.outline_sheet]] & ~clear)
        return cls(geometry, before, nodes, rows, boxes, screens, _same_patches(geometry, before, changed))

    def among(self, nodes: Nodes, members: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Those of some nodes that keep their rows, and their numbers among the earlier ones: both ``(k,)`` int."""
        now, then = _numbered(_places(nodes, self.geometry)[members], _places(self.nodes, self.before))
        earlier = np.full(int(max(now.max(initial=-1), then.max(initial=-1))) + 1, -1)
        earlier[then] = np.arange(len(then))
        mine, earlier = members[earlier[now] >= 0], earlier[now][earlier[now] >= 0]
        cut = np.flatnonzero(self.patch < 0)
        # light comes by mirrors from where nobody looks
        keep = ~self.rows.form_factors[np.ix_(earlier, cut)].any(axis=1) & ~self.rows.sky_specular.held()[earlier]
        mine, earlier = mine[keep], earlier[keep]
        points, normals = nodes.points[mine], self.geometry.element_normals[nodes.element[mine]]
        blind = np.ones(len(mine), bool)
        for low, high in self.boxes:
            blind &= self._hidden(points, normals, box_corners(low, high))
        return mine[blind], earlier[blind]

    def enter(self, rows: Rows, mine: np.ndarray, earlier: np.ndarray) -> None:
        """Copy rows of earlier nodes to those of these."""
        same = np.flatnonzero(self.patch >= 0)
        for first in range(0, len(mine), _ROWS):
            some, old = mine[first : first + _ROWS], earlier[first : first + _ROWS]
            rows.form_factors[some] = 0.0
            rows.form_factors[np.ix_(some, self.patch[same])] = self.rows.form_factors[np.ix_(old, same)]
            rows.sky_direct.enter(some, self.rows.sky_direct.some_rows(old))
        rows.unlit[mine] = self.rows.unlit[earlier]
        rows.truncated[mine] = self.rows.truncated[earlier]

    def _hidden(self, points: np.ndarray, normals: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """(k,) bool: whether a box is below the horizon of points, or one screen hides all of it."""
        outlines, size = self.geometry.outlines, self.geometry.planes.size
        level = np.einsum("kc,kc->k", points, normals)
        hidden = (normals @ corners.T <= level[:, None] + outlines.tolerance).all(axis=1)
        touching = outlines.tolerance + _TOUCHING * size
        for k in self.screens.tolist():
            normal, corner = outlines.normals[k], outlines.vertices[k]
            there = corners @ normal - outlines.offsets[k]
            side = -1.0 if there.mean() > 0 else 1.0
            if (side * there > touching).any():
                continue
            away = side * (points @ normal - outlines.offsets[k])
            mine = np.flatnonzero(~hidden & (away > touching))
            share = away[mine, None] / (away[mine, None] - np.minimum(side * there, 0.0))
            places = points[mine, None] + share[..., None] * (corners - points[mine, None])
            inward = polygons.cross(normal, polygons.following(corner, axis=0) - corner)
            above = np.einsum("kbc,wc->kbw", places, inward) >= np.einsum("wc,wc->w", inward, corner)
            hidden[mine] = above.all(axis=(1, 2))
        return hidden


def _boxes(geometry: Geometry, names: set[str]) -> list[np.ndarray]:
    """Lowest and highest corners of surfaces that are there."""
    planes = geometry.planes
    surface = planes.sheet_surface[planes.given_sheet]
    found = [planes.given[surface == k].reshape(-1, 3) for k, name in enumerate(planes.surfaces) if name in names]
    return [np.stack([points.min(axis=0), points.max(axis=0)]) for points in found]


def _places(nodes: Nodes, geometry: Geometry) -> np.ndarray:
    """(m, 6) float: where nodes lie and look."""
    return np.concatenate([nodes.points, geometry.element_normals[nodes.element]], axis=1)


def _numbered(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same number for the same row ``(c,)`` in either."""
    _, number = np.unique(np.concatenate([one, other]), axis=0, return_inverse=True)
    number = number.reshape(-1)
    return number[: len(one)], number[len(one) :]


def _same_patches(geometry: Geometry, before: Geometry, changed: set[str]) -> np.ndarray:
    """(q,) int: number that each earlier patch has now, where it has the same elements."""
    now, then = geometry.targets.patches, before.targets.patches
    new, old = _elements(geometry, changed), _elements(before, changed)
    numbers, known = _numbered(*(_corners(one, some) for one, some in ((geometry, new), (before, old))))
    patch = np.full(int(max(numbers.max(initial=-1), known.max(initial=-1))) + 1, -1)
    patch[numbers] = now.of_element[new]
    to, of = patch[known], then.of_element[old]
    least, most = np.full(then.count, now.count), np.full(then.count, -1)
    np.minimum.at(least, of, to)
    np.maximum.at(most, of, to)
    whole = np.bincount(then.of_element[then.of_element >= 0], minlength=then.count)
    there = np.bincount(now.of_element[now.of_element >= 0], minlength=now.count + 1)
    same = (least == most) & (least >= 0) & (np.bincount(of, minlength=then.count) == whole)
    same &= there[np.where(same, least, now.count)] == whole
    told = {p.first_patch: p.shares for p in now.profiles}
    for profile in then.profiles:
        count = profile.along * profile.shares.shape[1]
        mine = slice(profile.first_patch, profile.first_patch + count)
        same[mine] &= np.array_equal(told.get(int(least[profile.first_patch]), []), profile.shares)
    return np.where(same, least, -1)


def _elements(geometry: Geometry, changed: set[str]) -> np.ndarray:
    """(k,) int: elements of patches, of surfaces that have not changed."""
    lasting = np.array([name not in changed for name in geometry.planes.surfaces])
    return np.flatnonzero(lasting[geometry.element_surface] & (geometry.targets.patches.of_element >= 0))


def _corners(geometry: Geometry, some: np.ndarray) -> np.ndarray:
    """(k, 12) float: elements' corners and normals."""
    return np.concatenate([geometry.fracture.elements[some].reshape(-1, 9), geometry.element_normals[some]], axis=1)
