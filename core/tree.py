"""A tree of boxes around outlines: which of many outlines rays may meet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

LEAF = 4
"""Outlines in a box of the last level."""

_SUBTREE = 12
"""Levels of the tree below boxes that rays go through one after the other, nearest first."""

_PRUNED = 12
"""Level of boxes that are asked whether they lie above planes."""

_COARSE = 6
"""Level whose boxes stand for all below, where many rays are asked about at once."""

_ROUNDING = 1e-6
"""By which boxes are wider than what they hold, over the size of all."""

_NOWHERE = 1e18
"""Where empty boxes are [m]."""


@dataclass(frozen=True, eq=False)
class Tree:
    """Complete binary tree of bounding boxes over outlines in Morton order.

    Attributes
    ----------
    order : (n,) int
        Outlines, or -1; `LEAF` after the other share a box of the last level.
    middle : (3,) float
        Boxes are measured from here, so that float32 will do.
    boxes : list of (2^level, 2, 3) float32
        Lowest and highest corners; of empty boxes the lowest are above the highest.
    """

    order: np.ndarray
    middle: np.ndarray
    boxes: list[np.ndarray]

    @classmethod
    def over(cls, vertices: np.ndarray, tolerance: float) -> Tree:
        """The tree of outlines ``(o, w, 3)``."""
        low, high = vertices.min(axis=1), vertices.max(axis=1)
        order = np.argsort(_morton(0.5 * (low + high)), kind="stable")
        leaves = 1 << max(0, int(np.ceil(np.log2(len(order) / LEAF))))
        padded = np.full(leaves * LEAF, -1)
        padded[: len(order)] = order
        middle = 0.5 * (low.min(axis=0) + high.max(axis=0))
        pad = max(tolerance, _ROUNDING * float((high.max(axis=0) - low.min(axis=0)).max()), 1e-30)
        real = (padded >= 0)[:, None]
        lows = np.where(real, low[padded] - middle - pad, _NOWHERE).reshape(leaves, LEAF, 3).min(axis=1)
        highs = np.where(real, high[padded] - middle + pad, -_NOWHERE).reshape(leaves, LEAF, 3).max(axis=1)
        return cls(padded, middle, _around(np.stack([lows, highs], axis=1).astype(np.float32)))

    def of(self, alive: np.ndarray) -> Tree:
        """The tree of some outlines ``(o,)`` bool."""
        kept = ((self.order >= 0) & alive[self.order]).reshape(-1, LEAF).any(axis=1)
        return self._without(len(self.boxes) - 1, ~kept)

    def above(self, normals, offsets) -> Tree:
        """The tree without boxes that lie wholly below a plane ``normals (h, 3) · x = offsets (h,)``."""
        level = min(len(self.boxes) - 1, _PRUNED)
        boxes, below = self.boxes[level], np.zeros(len(self.boxes[level]), bool)
        for normal, offset in zip(normals, offsets, strict=True):
            below |= np.where(normal > 0, boxes[:, 1], boxes[:, 0]) @ normal <= offset - self.middle @ normal
        return self._without(level, below)

    def _without(self, level: int, dead: np.ndarray) -> Tree:
        boxes = self.boxes[level].copy()
        boxes[dead, 0], boxes[dead, 1] = _NOWHERE, -_NOWHERE
        return Tree(self.order, self.middle, _around(boxes) + self.boxes[level + 1 :])

    @property
    def is_empty(self) -> bool:
        """Whether it holds nothing."""
        return bool(self.boxes[0][0, 0, 0] > self.boxes[0][0, 1, 0])

    @cached_property
    def held(self) -> np.ndarray:
        """(n,) int: outlines in its boxes."""
        boxes = self.boxes[-1]
        candidate = self.order.reshape(-1, LEAF)[boxes[:, 0, 0] <= boxes[:, 1, 0]].ravel()
        return candidate[candidate >= 0]

    def may_meet(self, points, directions) -> np.ndarray:
        """(r, k) bool: whether beams of directions ``(k, 3)`` from points ``(r, 3)`` meet a box of a coarse level."""
        boxes = self.boxes[min(len(self.boxes) - 1, _COARSE)]
        at = (points - self.middle).astype(np.float32).T
        inverse = _inverse(directions).T
        met = np.zeros((len(directions), len(points)), bool)
        for low, high in boxes[boxes[:, 0, 0] <= boxes[:, 1, 0]]:
            enter, leave = _between(low - at.max(axis=1), high - at.min(axis=1), inverse)
            columns = np.flatnonzero(enter <= leave)
            if len(columns):
                enter, leave = _between(low[:, None] - at, high[:, None] - at, inverse[:, columns, None])
                met[columns] |= enter <= leave
        return met.T

    def search(self, points, directions, distance, meet: Callable[[np.ndarray, np.ndarray], None]) -> None:
        """Find outlines that rays may meet, nearest boxes first.

        Parameters
        ----------
        points, directions : (n, 3) float
        distance : (n,) float
            To the nearest hit so far: what is farther is not looked at.
        meet : callable(ray, outline)
            Called with pairs whose leaf's box the ray meets; lowers ``distance``.
        """
        rays = (points - self.middle).astype(np.float32), _inverse(directions), distance
        first = max(0, len(self.boxes) - 1 - _SUBTREE)
        every = np.arange(len(points))
        ray, node, enter = self._down(rays, every, np.zeros(len(points), np.int64), range(1, first + 1))
        order = np.lexsort((enter, ray))
        ray, node, enter = ray[order], node[order], enter[order]
        turn = np.arange(len(ray)) - np.searchsorted(ray, ray)
        level = np.frexp(turn + 1.0)[1]  # the first, the next two, the next four ...
        for now in range(1, int(level.max(initial=0)) + 1):
            mine = np.flatnonzero((level == now) & (enter < distance[ray]))
            some, leaf, _ = self._down(rays, ray[mine], node[mine], range(first + 1, len(self.boxes)))
            for k in range(LEAF):
                candidate = self.order[leaf * LEAF + k]
                real = np.flatnonzero(candidate >= 0)
                meet(some[real], candidate[real])

    def _down(self, rays, ray, node, levels: range):
        """Pairs of ray and box on the last of some levels that are met before what is known; and how far they are."""
        points, inverse, distance = rays
        distance = distance.astype(np.float32)
        enter = np.zeros(len(ray), np.float32)
        for level in levels:
            halves = self.boxes[level].reshape(-1, 2, 2, 3).take(node, axis=0)
            ends = halves - points.take(ray, axis=0)[:, None, None]
            ends *= inverse.take(ray, axis=0)[:, None, None]
            near, far = np.minimum(ends[:, :, 0], ends[:, :, 1]), np.maximum(ends[:, :, 0], ends[:, :, 1])
            enter = np.maximum(np.maximum(near[..., 0], near[..., 1]), near[..., 2])
            leave = np.minimum(np.minimum(far[..., 0], far[..., 1]), far[..., 2])
            met = (leave >= np.maximum(enter, 0)) & (enter < distance.take(ray)[:, None])
            met &= halves[:, :, 0, 0] <= halves[:, :, 1, 0]  # empty boxes have no sides
            pair = np.flatnonzero(met)
            ray, node, enter = ray.take(pair >> 1), 2 * node.take(pair >> 1) + (pair & 1), enter.ravel().take(pair)
        return ray, node, enter


def _inverse(directions: np.ndarray) -> np.ndarray:
    return (1.0 / np.where(np.abs(directions) < 1e-15, 1e-15, directions)).astype(np.float32)


def _around(boxes: np.ndarray) -> list[np.ndarray]:
    """Levels of a tree from its last, ``(2^level, 2, 3)``."""
    levels = [boxes]
    while len(levels[0]) > 1:
        below = levels[0].reshape(-1, 2, 2, 3)
        levels.insert(0, np.stack([below[:, :, 0].min(axis=1), below[:, :, 1].max(axis=1)], axis=1))
    return levels


def _between(low, high, inverse) -> tuple[np.ndarray, np.ndarray]:
    """Where rays of inverse directions ``(3, ...)`` enter and leave boxes, given from where they start."""
    ends = [(low[axis] * inverse[axis], high[axis] * inverse[axis]) for axis in range(3)]
    enter = np.maximum(np.maximum(*(np.minimum(a, b) for a, b in ends[:2])), np.minimum(*ends[2]))
    leave = np.minimum(np.minimum(*(np.maximum(a, b) for a, b in ends[:2])), np.maximum(*ends[2]))
    return np.maximum(enter, 0, out=enter), leave


def _morton(points: np.ndarray) -> np.ndarray:
    extent = np.maximum(np.ptp(points, axis=0), 1e-300)
    cell = ((points - points.min(axis=0)) / extent * 1023).astype(np.int64)
    code = np.zeros(len(points), np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code
