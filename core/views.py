"""What receivers see along beams, in arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .projection import Beams, HalfSpace

OPEN = -1
"""Nothing in the way: sky or ground light."""

SHARED = -2
"""A parcel that an edge crosses: see the view's parts."""


@dataclass(frozen=True, eq=False)
class View:
    """What receivers see along beams.

    Attributes
    ----------
    seen : (r, k) int16 or int32
        Obstacle seen along the whole beam, OPEN, or SHARED.
    part_row, part_beam, part_seen : (p,) int
        Receiver, beam and obstacle (or OPEN) of each part of a shared beam.
    part_share : (p,) float
        Share of the beam's cosine-weighted solid angle; the shares of one beam sum to 1.
    part_direction : (p, 3) float
        Towards the part's centre, not normalised.
    nearest : (r, k) float32
        Distance along each beam to the obstacle seen wholly [m].
    columns : dict of int to (c,) int
        For each obstacle that may be seen wholly, the beams that may see it.
    heights : (r, o) float, or what can be indexed like it
        Signed distance from each receiver to each obstacle's plane, along the obstacle's normal [m].
    """

    seen: np.ndarray
    part_row: np.ndarray
    part_beam: np.ndarray
    part_seen: np.ndarray
    part_share: np.ndarray
    part_direction: np.ndarray
    nearest: np.ndarray
    columns: dict[int, np.ndarray]
    heights: Any


@dataclass(frozen=True, eq=False)
class Partial:
    """Beams that come through a mirror or pane in part.

    Attributes
    ----------
    row, beam : (n,) int
    direction : (n, 3) float
        Towards the centre of the part.
    window : (r, w, 3) float32
        For each receiver the planes through the edges of the mirror or pane, positive inside.
    """

    row: np.ndarray
    beam: np.ndarray
    direction: np.ndarray
    window: np.ndarray


@dataclass(frozen=True, eq=False)
class Eye:
    """Where receivers look from: what settling parts of beams needs to know of them."""

    points: np.ndarray
    planes: np.ndarray
    heights: np.ndarray
    normal: np.ndarray
    past: HalfSpace | None
    partial: Partial | None

    def part_of(self, row, beam, beams: int) -> np.ndarray:
        """(n,) int: which of the partial beams these are; -1 for those that get here wholly."""
        if self.partial is None:
            return np.full(len(row), -1)
        mark = np.full((len(self.points), beams), -1)
        mark[self.partial.row, self.partial.beam] = np.arange(len(self.partial.row))
        return mark[row, beam]

    def towards(self, row, beam, beams: Beams) -> np.ndarray:
        """(n, 3) float: the centre of each beam, or of the part of it that gets here."""
        directions = beams.directions[beam]
        if self.partial is not None:
            part = self.part_of(row, beam, len(beams.directions))
            directions[part >= 0] = self.partial.direction[part[part >= 0]]
        return directions


def with_partial(view: View, partial: Partial) -> View:
    """The view with beams that are partial, and see one thing or nothing, listed among the parts."""
    found = view.seen[partial.row, partial.beam]
    mine = np.flatnonzero(found != SHARED)
    row, beam = partial.row[mine], partial.beam[mine]
    view.seen[row, beam] = SHARED
    return replace(
        view,
        part_row=np.concatenate([view.part_row, row]),
        part_beam=np.concatenate([view.part_beam, beam]),
        part_seen=np.concatenate([view.part_seen, found[mine]]),
        part_share=np.concatenate([view.part_share, np.ones(len(mine))]),
        part_direction=np.concatenate([view.part_direction, partial.direction[mine]]),
    )


def along(plane: HalfSpace, points, directions) -> np.ndarray:
    """(n,) float: distance from each point along its direction to a plane, a little less."""
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (plane.offset - points @ plane.normal) / np.einsum("...c,c->...", directions, plane.normal)
    return distance * (1 - 1e-5)
