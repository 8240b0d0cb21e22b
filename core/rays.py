"""Single rays: the nearest outline along each, for scenes of many outlines and the ends of deep specular chains."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons

_FEW = 48
_LEAF = 4
_MISS = -1


@dataclass(frozen=True, eq=False)
class RayScene:
    """Convex outlines to shoot rays at.

    Parameters
    ----------
    vertices : (o, w, 3) float, padded
    normals : (o, 3) float
    offsets : (o,) float
    tolerance : float
        Hits nearer than this do not count [m].
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    tolerance: float

    @cached_property
    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        edge = np.roll(self.vertices, -1, axis=1) - self.vertices
        inward = polygons.cross(self.normals[:, None], edge)
        length = np.linalg.norm(inward, axis=2, keepdims=True)
        inward = np.where(length > 0, inward / np.where(length > 0, length, 1.0), 0.0)
        start = np.einsum("owc,owc->ow", inward, self.vertices) - 1e-3 * self.tolerance
        return inward, np.where(length[:, :, 0] > 0, start, -np.inf)

    @cached_property
    def _tree(self) -> _Tree:
        return _Tree.over(self.vertices, self.tolerance)

    def nearest(self, points, directions) -> tuple[np.ndarray, np.ndarray]:
        """First outline that each ray meets.

        Parameters
        ----------
        points, directions : (n, 3) float

        Returns
        -------
        outline : (n,) int
            -1 where nothing is met.
        distance : (n,) float
            In lengths of the direction; inf where nothing is met.
        """
        outline = np.full(len(points), _MISS)
        distance = np.full(len(points), np.inf)
        if len(self.vertices) <= _FEW:
            for o in range(len(self.vertices)):
                self._meet(np.arange(len(points)), np.full(len(points), o), points, directions, outline, distance)
            return outline, distance
        for ray, candidate in self._tree.candidates(points, directions):
            self._meet(ray, candidate, points, directions, outline, distance)
        return outline, distance

    def pulled_inside(self, outline: int, places, margin) -> np.ndarray:
        """Places in an outline's plane, moved to within the outline where they lie outside.

        Parameters
        ----------
        outline : int
        places : (n, 3) float
        margin : (n,) float
            Distance to keep from the edges [m].

        Returns
        -------
        (n, 3) float
        """
        moved = np.array(places, float)
        inward, start = self._edges
        real = np.isfinite(start[outline])
        for _ in range(2):  # pushing in at one edge may push out at the next
            for across, least in zip(inward[outline][real], start[outline][real], strict=True):
                moved += np.maximum(least + margin - moved @ across, 0.0)[:, None] * across
        return moved

    def _meet(self, ray, candidate, points, directions, outline, distance) -> None:
        normal = self.normals[candidate]
        slope = np.einsum("nc,nc->n", directions[ray], normal)
        height = self.offsets[candidate] - np.einsum("nc,nc->n", points[ray], normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            along = height / slope
        near = (along > 0) & (np.abs(height) > self.tolerance) & (along < distance[ray])
        ray, candidate, along = ray[near], candidate[near], along[near]
        place = points[ray] + along[:, None] * directions[ray]
        inward, start = self._edges
        inside = (np.einsum("nwc,nc->nw", inward[candidate], place) >= start[candidate]).all(axis=1)
        ray, candidate, along = ray[inside], candidate[inside], along[inside]
        # several candidates of one ray may be here: write the nearest last
        order = np.argsort(-along, kind="stable")
        ray, candidate, along = ray[order], candidate[order], along[order]
        outline[ray], distance[ray] = candidate, along


@dataclass(frozen=True, eq=False)
class _Tree:
    """Complete binary tree of bounding boxes over outlines in Morton order."""

    order: np.ndarray
    boxes: list[np.ndarray]

    @classmethod
    def over(cls, vertices: np.ndarray, tolerance: float) -> _Tree:
        low, high = vertices.min(axis=1), vertices.max(axis=1)
        order = np.argsort(_morton(0.5 * (low + high)), kind="stable")
        leaves = 1 << max(0, int(np.ceil(np.log2(len(order) / _LEAF))))
        padded = np.full(leaves * _LEAF, _MISS)
        padded[: len(order)] = order
        pad = max(tolerance, 1e-12)
        lows = np.where((padded >= 0)[:, None], low[padded] - pad, np.inf).reshape(leaves, _LEAF, 3).min(axis=1)
        highs = np.where((padded >= 0)[:, None], high[padded] + pad, -np.inf).reshape(leaves, _LEAF, 3).max(axis=1)
        boxes = [np.stack([lows, highs], axis=1)]
        while len(boxes[0]) > 1:
            below = boxes[0].reshape(-1, 2, 2, 3)
            boxes.insert(0, np.stack([below[:, :, 0].min(axis=1), below[:, :, 1].max(axis=1)], axis=1))
        return cls(padded, boxes)

    def candidates(self, points, directions):
        """Pairs of ray and outline whose leaf's box the ray meets."""
        with np.errstate(divide="ignore"):
            inverse = 1.0 / np.where(directions == 0, 1e-300, directions)
        ray = np.arange(len(points))
        node = np.zeros(len(points), np.int64)
        for level, boxes in enumerate(self.boxes):
            with np.errstate(invalid="ignore", over="ignore"):
                a = (boxes[node, 0] - points[ray]) * inverse[ray]
                b = (boxes[node, 1] - points[ray]) * inverse[ray]
            enter, leave = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
            met = (leave >= enter) & (leave > 0)
            ray, node = ray[met], node[met]
            if level + 1 < len(self.boxes):
                ray = np.repeat(ray, 2)
                node = np.repeat(node * 2, 2)
                node[1::2] += 1
        for k in range(_LEAF):
            candidate = self.order[node * _LEAF + k]
            real = candidate >= 0
            yield ray[real], candidate[real]


def _morton(points: np.ndarray) -> np.ndarray:
    extent = np.maximum(np.ptp(points, axis=0), 1e-300)
    cell = ((points - points.min(axis=0)) / extent * 1023).astype(np.int64)
    code = np.zeros(len(points), np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code
