"""Convex rooms: closed and empty, so that nothing stands in the way and form factors to patches are Lambert's own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons, rings
from .arrays import dots
from .geometry import Geometry
from .nodes import Nodes
from .patches import Patches

_CLOSED = 1e-6
"""How far from one the form factors of receivers in a closed room may sum up to."""

_SOME = 64
"""Receivers that tell whether a room is closed."""

_CELLS = 200_000
"""Receivers times sides that are taken together: they stay in cache."""

_STRAIGHT = 1e-9
"""Sine of the angle between sides that are one."""


@dataclass(frozen=True, eq=False)
class ConvexRoom:
    """A room where every receiver sees all of every other surface.

    Attributes
    ----------
    normals, offsets : (s, 3) and (s,) float
        Planes of the sheets.
    begin, end : (k, 3) float
        Straight sides of patches' borders, which run right-handed about the direction that patches shine to.
    start : (g,) int
        Where the sides of each group begin. A group is the part of a patch that lies in one sheet; what shines nowhere
        is one more patch.
    group_sheet, group_patch : (g,) int
        The latter does not descend.
    patches : int
    tolerance : float [m]
    """

    normals: np.ndarray
    offsets: np.ndarray
    begin: np.ndarray
    end: np.ndarray
    start: np.ndarray
    group_sheet: np.ndarray
    group_patch: np.ndarray
    patches: int
    tolerance: float

    @classmethod
    def of(cls, geometry: Geometry, nodes: Nodes) -> ConvexRoom | None:
        """The room; None where it is open, not empty or not convex, or surfaces mirror, transmit or have two sides."""
        outlines, patches = geometry.outlines, geometry.targets.patches
        if outlines.any_specular or outlines.two_sided.any() or not patches.count or patches.profiles:
            return None
        corners, normals = outlines.vertices.reshape(-1, 3), geometry.planes.sheet_normal
        if not _all_before(corners, normals, _offsets(geometry), outlines.tolerance):
            return None
        room = cls.around(geometry, patches)
        return room if room._is_closed(nodes, geometry.element_normals) else None

    @classmethod
    def around(cls, geometry: Geometry, patches: Patches) -> ConvexRoom:
        """A room that is known to be one, in these patches."""
        patch = np.where(patches.of_element < 0, patches.count, patches.of_element)
        sheet = geometry.fracture.element_sheet
        (group_patch, group_sheet), group = np.unique(np.stack([patch, sheet]), axis=1, return_inverse=True)
        owner, begin, end = borders(geometry.fracture.elements, group.reshape(-1), geometry.planes.size)
        return cls(
            geometry.planes.sheet_normal,
            _offsets(geometry),
            begin,
            end,
            np.searchsorted(owner, np.arange(len(group_patch))),
            group_sheet,
            group_patch,
            patches.count,
            geometry.outlines.tolerance,
        )

    def holds(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """(r,) bool: which points of one plane lie on a surface of the room, off its border, and look inwards."""
        heights = points @ self.normals.T - self.offsets
        beside = self._beside(points, normal)
        return beside.any() & (heights[:, ~beside] > 10 * self.tolerance).all(axis=1)

    def factors(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """Form factors by Lambert's contour formula (Lambert 1760; e.g. Howell, C-1), exact near and far.

        Parameters
        ----------
        points : (r, 3) float
            In one plane.
        normal : (3,) float

        Returns
        -------
        (r, p + 1) float
            Last what shines nowhere.
        """
        beside = self._beside(points, normal)
        out = np.zeros((len(points), self.patches + 1))
        used, first = np.unique(self.group_patch, return_index=True)
        step = max(1, _CELLS // len(self.begin))
        for a in range(0, len(points), step):
            groups = np.add.reduceat(self._along_sides(points[a : a + step], normal), self.start, axis=1)
            groups[:, beside[self.group_sheet]] = 0.0
            out[a : a + step, used] = np.add.reduceat(groups, first, axis=1)
        return np.maximum(out, 0.0)

    def _beside(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """(s,) bool: sheets in the points' own plane."""
        heights = self.normals @ points[0] - self.offsets
        return (self.normals @ normal > 1 - 1e-9) & (np.abs(heights) <= self.tolerance)

    def _along_sides(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """(r, k) float: what each side adds to the form factor."""
        begin, end = self.begin, self.end
        squared = dots(points, points)[:, None]
        to_begin = squared - 2 * (points @ begin.T) + dots(begin, begin)
        to_end = squared - 2 * (points @ end.T) + dots(end, end)
        inner = squared - points @ (begin + end).T + dots(begin, end)
        # n · ((a - p) × (b - p)) = n · (a × b) - p · (n × (a - b)); that vector's length is by Lagrange's identity
        along = polygons.cross(begin, end) @ normal - points @ polygons.cross(normal, begin - end).T
        length = np.sqrt(np.maximum(to_begin * to_end - inner**2, 0.0))
        angle = np.arctan2(length, inner)
        return along * np.divide(angle, -2 * np.pi * length, out=np.zeros_like(angle), where=length > 0)

    def _is_closed(self, nodes: Nodes, element_normals: np.ndarray) -> bool:
        some = np.linspace(0, len(nodes.points) - 1, min(_SOME, len(nodes.points))).astype(int)
        return all(
            abs(self.factors(nodes.points[[node]], element_normals[nodes.element[node]]).sum() - 1) <= _CLOSED
            for node in some
        )


def _offsets(geometry: Geometry) -> np.ndarray:
    """(s,) float: those of sheets' planes; not a number for doubles, which are no part of such a room."""
    offsets = np.full(len(geometry.planes.sheet_normal), np.nan)
    offsets[geometry.planes.outline_sheet] = geometry.outlines.offsets
    return offsets


def _all_before(corners: np.ndarray, normals: np.ndarray, offsets: np.ndarray, tolerance: float) -> bool:
    """Whether no corner ``(v, 3)`` lies behind a plane."""
    step = max(1, _CELLS // len(corners))
    parts = (slice(first, first + step) for first in range(0, len(normals), step))
    return all((corners @ normals[some].T - offsets[some]).min() >= -tolerance for some in parts)


def borders(triangles: np.ndarray, group: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Straight sides around groups of triangles: sides that two of a group share are none of its border.

    Parameters
    ----------
    triangles : (e, 3, 3) float
    group : (e,) int
    size : float
        Of the scene [m].

    Returns
    -------
    owner : (k,) int
        Group of each side, ascending.
    begin, end : (k, 3) float
    """
    corners = triangles.reshape(-1, 3)
    first, vertex = rings.welded(corners, 1e-10 * size)
    places, one = corners[first], vertex.reshape(-1, 3)
    two, owner = np.roll(one, -1, axis=1).ravel(), np.repeat(group, 3)
    one = one.ravel()
    low, high = np.minimum(one, two), np.maximum(one, two)
    sides, which = np.unique(np.stack([owner, low, high]), axis=1, return_inverse=True)
    turns = np.bincount(which.reshape(-1), weights=np.sign(two - one)).astype(int)
    sides, turns = np.repeat(sides, np.abs(turns), axis=1), np.repeat(turns, np.abs(turns))
    owner = sides[0]
    one, two = np.where(turns > 0, sides[1:], sides[2:0:-1])
    onward = _onward(owner, one, two, places)
    last = np.where(onward < 0, np.arange(len(onward)), onward)
    while (last[last] != last).any():
        last = last[last]
    heads = np.ones(len(onward), bool)
    heads[onward[onward >= 0]] = False
    return owner[heads], places[one[heads]], places[two[last[heads]]]


def _onward(owner: np.ndarray, one: np.ndarray, two: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(k,) int: the side of the same group that goes straight on from each; -1 where there is none, or a choice."""
    comes, goes = owner * len(places) + two, owner * len(places) + one
    order = np.argsort(goes, kind="stable")
    left, right = (np.searchsorted(goes[order], comes, side=side) for side in ("left", "right"))
    _, which, many = np.unique(comes, return_inverse=True, return_counts=True)
    following = order[np.minimum(left, len(order) - 1)]
    way = places[two] - places[one]
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    turned = np.linalg.norm(polygons.cross(way, way[following]), axis=1)
    straight = (turned <= _STRAIGHT) & (dots(way, way[following]) > 0)
    return np.where((right - left == 1) & (many[which.reshape(-1)] == 1) & straight, following, -1)
