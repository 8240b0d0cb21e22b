"""What receivers get of bright polygons: gathered from many views, worked out together in long arrays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from . import unhidden
from .pieces import SeenShapes

_TOGETHER = 2_000
"""Polygons that nothing hides whose form factors are found together: they stay in cache."""

_MANY = 400
"""Of so many it costs less to work them out at once than to join them with others."""

_FEW = 64
"""Of so many behind screens it costs less to look at one screen twice than to look at them by themselves."""

_MOST = 100_000
"""Polygons, screens counted, that may wait."""


class Received:
    """Illuminance of some receivers, and the polygons whose light is not yet in it.

    Parameters
    ----------
    count : int
        Number of receivers.
    tolerance : float
        Distance at which corners may be meant to lie on an edge [m].
    """

    def __init__(self, count: int, tolerance: float) -> None:
        self._total = np.zeros(count)
        self._tolerance = tolerance
        self._waiting: dict[tuple[int, int], list[tuple[np.ndarray, ...]]] = {}
        self._held = 0

    def add(self, row, weight, shapes, normal, screens=None, facing=None) -> None:
        """Enter polygons that receivers see.

        Parameters
        ----------
        row : (n,) int
            Receivers.
        weight : (n,) float
            Exitance, times what mirrors and panes let through [lm/m²].
        shapes : (3, v, n) float, padded
            Relative to the receivers.
        normal : (3, n) or (3,) float, unit
            Of the receivers.
        screens : (k, 3, w, n) float, optional
            Before the shapes: see `unhidden.form_factors`.
        facing : (k, n) float, optional
        """
        if not len(row):
            return
        number = 0 if screens is None else len(screens)
        normals = np.broadcast_to(normal.reshape(3, -1), (3, len(row)))
        parts = (row, weight, normals, shapes) if screens is None else (row, weight, normals, shapes, facing, screens)
        self._waiting.setdefault((number, shapes.shape[1]), []).append(parts)
        self._held += len(row) * (1 + number)
        if self._held > _MOST:
            self._work_out()

    def add_seen(self, row, weight, seen: SeenShapes, counts, normal) -> None:
        """Enter polygons that nothing hides.

        Parameters
        ----------
        row, weight
            As of `add`.
        seen : SeenShapes
        counts : (s,) int
            Corners of its polygons.
        normal : (3, n) float, unit
            Of the receivers.
        """
        if seen.windows is not None and seen.cut.any():
            whole, cut = np.flatnonzero(~seen.cut), np.flatnonzero(seen.cut)
            some, windows = seen.take(cut), seen.windows
            screens = windows.corners.take(some.row, axis=2), windows.facing.take(some.row)
            of_cut = normal.take(cut, axis=1)
            factors = unhidden.form_factors_within(some.shape, *screens, of_cut, self._tolerance)
            self._sum(row[cut], weight[cut], factors)
            row, weight, seen, normal = row[whole], weight[whole], seen.take(whole), normal.take(whole, axis=1)
        corners = counts[seen.polygon]
        for count in np.flatnonzero(np.bincount(corners)).tolist():
            mine = np.flatnonzero(corners == count)
            some = replace(seen.take(mine), corners=seen.corners[:, :count])
            if len(mine) < _MANY:
                self.add(row[mine], weight[mine], some.shape, normal.take(mine, axis=1))
                continue
            for first in range(0, len(mine), _TOGETHER):
                part = slice(first, first + _TOGETHER)
                factors = unhidden.whole_form_factors(some.take(part).shape, normal.take(mine[part], axis=1))
                self._sum(row[mine[part]], weight[mine[part]], factors)

    def illuminance(self) -> np.ndarray:
        """(count,) float: all that was entered [lx]."""
        self._work_out()
        return self._total

    def _work_out(self) -> None:
        for number, corners in sorted(self._waiting):
            parts = self._waiting.pop((number, corners))
            others = [key for key in self._waiting if key[0] >= number > 0 and key[1] >= corners]
            if others and sum(len(part[0]) for part in parts) < _FEW:
                self._waiting[min(others)] += [_with_screens(part, min(others)[0]) for part in parts]
            elif number:
                self._enter(*(_joined(some) for some in zip(*parts, strict=True)))
            else:
                self._enter_whole(*(_joined(some) for some in zip(*parts, strict=True)))
        self._held = 0

    def _enter(self, row, weight, normals, shapes, facing, screens) -> None:
        factors = unhidden.form_factors(shapes, screens, facing, normals, self._tolerance)
        self._sum(row, weight, factors)

    def _enter_whole(self, row, weight, normals, shapes) -> None:
        for first in range(0, len(row), _TOGETHER):
            some = slice(first, first + _TOGETHER)
            factors = unhidden.whole_form_factors(shapes[..., some], normals[:, some])
            self._sum(row[some], weight[some], factors)

    def _sum(self, row, weight, factors) -> None:
        self._total += np.bincount(row, weights=weight * np.maximum(factors, 0.0), minlength=len(self._total))


def _with_screens(part: tuple[np.ndarray, ...], number: int) -> tuple[np.ndarray, ...]:
    """With so many screens, the last of them several times."""
    *others, facing, screens = part
    index = np.minimum(np.arange(number), len(screens) - 1)
    return (*others, facing[index], screens[index])


def _joined(parts: tuple[np.ndarray, ...]) -> np.ndarray:
    """Arrays joined along their last axis; corners, the last axis but one, are padded by repeating the last."""
    if len(parts) == 1:
        return parts[0]
    if parts[0].ndim > 2:
        width = max(part.shape[-2] for part in parts)
        parts = tuple(_padded(part, width) for part in parts)
    return np.concatenate(parts, axis=-1)


def _padded(corners: np.ndarray, width: int) -> np.ndarray:
    index = np.minimum(np.arange(width), corners.shape[-2] - 1)
    return corners if len(index) == corners.shape[-2] else corners.take(index, axis=-2)
