"""Form factors: what each receiver gathers from patches, sky and ground, summed over its sightings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .arrays import dots, onto
from .globe import Globe
from .hemisphere import Hemisphere
from .patches import Patches
from .planes import Planes
from .sighting import Sighting
from .specular import GroupSight
from .tracing import RaySight
from .visibility import OPEN

_BESIDE_BORDERS = 2e-4
"""Shift of where beams end, in cells: in rooms of even measures many end exactly on borders between patches, and
rounding shall not decide to which side."""

_SKY_SUBDIVISION = 4

_WITHIN_BEAM = 5
"""Order of the lattice of rays that stand for a mirrored beam wider than the sky's parcels: five."""


@dataclass(frozen=True, eq=False)
class Targets:
    """What beams can end on.

    Attributes
    ----------
    planes : Planes
    patches : Patches
    globe : Globe
    sky_parcels : int
        Parcels on or above the horizon: the sky's columns; one more column holds the ground.
    """

    planes: Planes
    patches: Patches
    globe: Globe
    sky_parcels: int

    @classmethod
    def of(cls, planes: Planes, patches: Patches, globe: Globe) -> Targets:
        """Columns for a globe: every band with its centre on or above the horizon belongs to the sky."""
        return cls(planes, patches, globe, int(globe.band_starts[(globe.bands + 1) // 2]))

    @property
    def columns(self) -> int:
        """Columns of the sky and ground matrices."""
        return self.sky_parcels + 1

    @cached_property
    def sky_directions(self) -> np.ndarray:
        """(sky_parcels · n, 3) float: places in each sky parcel whose mean luminance is the parcel's."""
        parts = self.globe.subdirections(np.arange(self.sky_parcels), _SKY_SUBDIVISION)
        return parts.reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class Gathered:
    """Form factors of receivers.

    Attributes
    ----------
    patches : (r, p) float32
        Form factor to each patch, direct and through specular chains.
    deep : (r, p) float32, or None where there is none
        The part of ``patches`` that comes by more mirrors than bright polygons are followed through.
    sky_direct, sky_specular : (r, c) float32, or None where no mirror was seen
        Form factor to each sky parcel, and last to the ground.
    unlit : (r,) float32
        Form factor to sides that receive nothing, the backs of one-sided surfaces.
    truncated : (r,) float32
        Form factor of the chains that were cut off.
    """

    patches: np.ndarray
    deep: np.ndarray | None
    sky_direct: np.ndarray
    sky_specular: np.ndarray | None
    unlit: np.ndarray
    truncated: np.ndarray

    @property
    def sky(self) -> np.ndarray:
        """(r, c) float32: form factor to each sky parcel and the ground, straight and by mirrors."""
        return self.sky_direct if self.sky_specular is None else self.sky_direct + self.sky_specular


def gather(
    sight: GroupSight | RaySight, points, targets: Targets, checkpoint: Callable[[], None] = lambda: None
) -> Gathered:
    """Form factors of receivers that share one plane, or have rays of their own.

    Parameters
    ----------
    sight : GroupSight or RaySight
    points : (r, 3) float
    targets : Targets
    checkpoint : callable
        Called between sightings; may raise to stop.

    Returns
    -------
    Gathered
    """
    rows = len(points)
    patches = np.zeros((rows, targets.patches.columns))
    direct = np.zeros((rows, targets.columns), np.float32)
    deep = specular = None
    unlit = np.zeros(rows)
    sightings, truncated = sight.sightings(points, checkpoint)
    for s in sightings:
        parts = s.part_weights()
        if s.mirrors > sight.limits.exact_mirrors:
            deep = np.zeros(patches.shape) if deep is None else deep
            _add_patches(s, parts, targets, deep, unlit)
        else:
            _add_patches(s, parts, targets, patches, unlit)
        if s.mirrors:
            specular = np.zeros_like(direct) if specular is None else specular
            _add_mirrored_sky(s, targets, specular)
            _splat(s, parts, targets, specular)
        else:
            _add_sky(s, targets, direct)
            _splat(s, parts, targets, direct)
    if deep is not None:
        patches += deep
    return Gathered(
        patches=targets.patches.folded(patches).astype(np.float32),
        deep=None if deep is None else targets.patches.folded(deep).astype(np.float32),
        sky_direct=direct,
        sky_specular=specular,
        unlit=unlit.astype(np.float32),
        truncated=truncated.astype(np.float32),
    )


def _add_patches(s: Sighting, parts: np.ndarray, targets: Targets, out: np.ndarray, unlit: np.ndarray) -> None:
    _add_whole_beams(s, targets, out, unlit)
    row, patch, weight = _parts_of_beams(s, parts, targets, unlit)
    if len(row):
        _add(out, s.rows[row] * out.shape[1] + patch, weight)


def _add_whole_beams(s: Sighting, targets: Targets, out: np.ndarray, unlit: np.ndarray) -> None:
    """Add beams that see one obstacle wholly: in float32, obstacle by obstacle."""
    grid, fronts = targets.patches, len(targets.planes.sheet_surface)
    for k, columns in s.view.columns.items():
        sheet = targets.planes.outline_sheet[s.obstacles.outlines[k]]
        behind = s.view.heights[:, k] > 0
        for back in (False, True):
            rows = np.flatnonzero(behind == back)
            if not len(rows):
                continue
            base = int(grid.grid_base[sheet + back * fronts])
            dead = base < 0 and s.dead_share(k, back)
            if base < 0 and not dead:
                continue
            here = _picker(rows, len(behind), columns)  # beam after beam, as they lie in memory
            weights = np.where(here(s.view.seen) == k, here(s.weights), 0.0)
            if dead:
                unlit[s.rows[rows]] += dead * weights.sum(axis=0)
                continue
            cell = _grid_cells(s, targets, sheet, back * fronts, rows, columns, here(s.view.nearest))
            shape = grid.grid_shape[sheet + back * fronts]
            found = grid.grid[base : base + int(shape[0] * shape[1])]
            first, count = int(found.min()), int(np.ptp(found)) + 1
            place = (found - first).take(cell) + count * np.arange(len(rows))
            sums = np.bincount(place.ravel(), weights=weights.ravel(), minlength=len(rows) * count)
            out[s.rows[rows], first : first + count] += sums.reshape(-1, count)


def _picker(rows: np.ndarray, count: int, columns: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Picks some of ``count`` rows and some columns of a matrix; the result is transposed."""

    def pick(matrix: np.ndarray) -> np.ndarray:
        if matrix.strides[0] == 0:  # all rows are one
            return matrix[0, columns, None]
        found = matrix.T.take(columns, axis=0)
        return found if len(rows) == count else found.take(rows, axis=1)

    return pick


def _grid_cells(s: Sighting, targets: Targets, sheet: int, behind: int, rows, columns, distance) -> np.ndarray:
    """(k, r) int32: cell of the sheet's grid that each beam ends in; any where the distance is infinite."""
    grid, axes = targets.patches, targets.planes.sheet_axes[sheet]
    origin, scale, shape = (g[sheet + behind] for g in (grid.grid_origin, grid.grid_scale, grid.grid_shape))
    # in-plane place = axes · point + distance · (axes · direction), in cells
    start = ((s.points[rows] @ axes.T - origin) * scale + _BESIDE_BORDERS).astype(np.float32)
    along = ((s.beams.directions[columns] @ axes.T) * scale).astype(np.float32)
    cells = []
    with np.errstate(invalid="ignore"):
        for axis in (0, 1):
            place = distance * along[:, axis, None]
            place += start[:, axis]
            # whatever is not a number becomes 0 here
            np.fmax(place, 0, out=place)
            np.minimum(place, np.float32(shape[axis] - 0.5), out=place)
            cells.append(place.astype(np.int32))
    cells[0] *= np.int32(shape[1])
    return np.add(cells[0], cells[1], out=cells[0])


def _parts_of_beams(s: Sighting, parts: np.ndarray, targets: Targets, unlit: np.ndarray):
    """Rows, patches and weights of the parts of shared beams."""
    view, grid = s.view, targets.patches
    fronts = len(targets.planes.sheet_surface)
    mine = np.flatnonzero(view.part_seen >= 0)
    row, obstacle, weight = view.part_row[mine], view.part_seen[mine], parts[mine]
    towards = view.part_direction.take(mine, axis=0)
    sheet = targets.planes.outline_sheet[s.obstacles.outlines[obstacle]]
    height = view.heights[row, obstacle]
    side = sheet + np.where(height > 0, fronts, 0)
    base = grid.grid_base[side]
    dark = np.flatnonzero(base < 0)
    if len(dark):
        kinds, kind = np.unique(obstacle[dark] * 2 + (height[dark] > 0), return_inverse=True)
        dead = np.array([s.dead_share(int(k // 2), bool(k % 2)) for k in kinds])[kind.reshape(-1)]
        unlit += np.bincount(s.rows[row[dark]], weights=weight[dark] * dead, minlength=len(unlit))
    lit = np.flatnonzero(base >= 0)
    row, obstacle, weight, towards = row[lit], obstacle[lit], weight[lit], towards.take(lit, axis=0)
    sheet, side, base, height = sheet[lit], side[lit], base[lit], height[lit]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        distance = height / dots(towards, s.obstacles.normals.take(obstacle, axis=0))
    distance = np.nan_to_num(distance, posinf=1e30, neginf=-1e30)
    points = s.points.take(row, axis=0) + distance[:, None] * towards
    axes = targets.planes.sheet_axes.take(sheet, axis=0)
    place = np.stack([dots(axes[:, k], points) for k in (0, 1)], axis=1) - grid.grid_origin[side]
    place = place * grid.grid_scale[side] + _BESIDE_BORDERS
    strips = np.flatnonzero(grid.narrow[side] >= 0)
    if len(strips) and not s.rays:
        normals = s.obstacles.normals.take(obstacle[strips], axis=0)
        reach = _reach(s, targets, side[strips], place[strips], towards[strips], normals, np.abs(distance[strips]))
        every, place = _in_thirds(place, strips, grid.narrow[side[strips]], reach)
        weight = weight[every] * np.where(grid.narrow[side[every]] >= 0, 1 / 3, 1.0)
        row, base, side = row[every], base[every], side[every]
    cell = np.clip(place, 0, grid.grid_shape[side] - 0.5).astype(np.int64)
    return row, grid.grid[base + cell[:, 0] * grid.grid_shape[side, 1] + cell[:, 1]], weight


def _reach(s: Sighting, targets: Targets, side, place, towards, normals, distance) -> np.ndarray:
    """(n,) float: how far to either side of places ``(n, 2)`` parts of beams reach across narrow strips, in cells.

    What hides a strip in part mostly leaves one of its borders in sight: from its middle a part reaches as far as that,
    or as its beam is wide.
    """
    grid, every = targets.patches, np.arange(len(side))
    axis = grid.narrow[side]
    middle = place[every, axis]
    across = targets.planes.sheet_axes[side % len(targets.planes.sheet_surface), axis]
    slant = dots(across, towards) / np.maximum(np.abs(dots(normals, towards)), 1e-9)
    half = 0.5 * np.pi / s.beams.hemisphere.globe.bands * distance * np.sqrt(1 + slant**2)
    reach = np.minimum(half * grid.grid_scale[side, axis], np.minimum(middle, grid.grid_shape[side, axis] - middle))
    return np.maximum(reach, 0.0)


def _in_thirds(place, some, axis, reach) -> tuple[np.ndarray, np.ndarray]:
    """Which of places ``(n, 2)`` each is, and places, where ``some`` (k,) count in three along an axis.

    Chebyshev's rule: what runs as a parabola has its mean over the reach in either direction at these three.
    """
    every = np.concatenate([np.arange(len(place)), some, some])
    found = place[every]
    step = math.sqrt(0.5) * reach
    found[np.arange(len(place), len(every)), np.tile(axis, 2)] += np.concatenate([step, -step])
    return every, found


def _add_sky(s: Sighting, targets: Targets, out: np.ndarray) -> None:
    if s.rays:
        return
    parcels = s.beams.hemisphere.parcels[s.beams.columns]
    free = np.where(s.view.seen == OPEN, s.weights, 0.0)
    if s.beams.hemisphere.globe is targets.globe:
        above = parcels < targets.sky_parcels
        columns, weights = parcels[above], free[:, above]
        out[s.rows, -1] += free[:, ~above].sum(axis=1)
    else:
        columns, weights = _spread_over_sky(free, parcels, s.beams.hemisphere, targets)
    if len(s.rows) == len(out):
        out[:, columns] += weights
    else:
        out[np.ix_(s.rows, columns)] += weights


def _add_mirrored_sky(s: Sighting, targets: Targets, out: np.ndarray) -> None:
    if s.rays:
        return
    free = np.flatnonzero((s.view.seen == OPEN) & (s.weights > 0))
    row, beam = np.divmod(free, s.weights.shape[1])
    weight = s.weights[row, beam]
    if s.beams.hemisphere.globe is targets.globe:
        parcels, shares = _columns(s.beams.directions, targets)
    else:
        rays = s.beams.rays(np.arange(s.weights.shape[1]), _WITHIN_BEAM)
        parcels, shares = (found.reshape(len(rays), -1) for found in _columns(rays.reshape(-1, 3), targets))
        shares = shares / rays.shape[1]
    flat = s.rows[row, None] * targets.columns + parcels[beam]
    shares = weight[:, None] * shares[beam]
    _add(out, flat.ravel(), shares.ravel())


def _spread_over_sky(free: np.ndarray, parcels: np.ndarray, hemisphere: Hemisphere, targets: Targets):
    """Columns ``(c,)`` and weights ``(r, c)`` float32: those ``(r, k)`` of another globe's parcels, among the sky's."""
    lit = np.flatnonzero(free.any(axis=0))
    place = np.full(hemisphere.globe.count, -1)
    place[parcels[lit]] = np.arange(len(lit))
    own, others, solid_angle, direction = hemisphere.globe.shared_with(targets.globe)
    mine = np.flatnonzero(place[own] >= 0)
    beam, column = place[own[mine]], np.minimum(others[mine], targets.sky_parcels)
    share = solid_angle[mine] * np.maximum(onto(direction[mine], hemisphere.normal), 1e-9)
    share /= np.bincount(beam, weights=share, minlength=len(lit))[beam]
    order = np.argsort(column, kind="stable")
    beam, column, share = beam[order], column[order], share[order].astype(np.float32)
    first = np.flatnonzero(np.diff(column, prepend=-1))
    if not len(first):
        return column, np.zeros((len(free), 0), np.float32)
    parts = free.astype(np.float32).T.take(lit, axis=0).take(beam, axis=0)
    parts *= share[:, None]
    return column[first], np.add.reduceat(parts, first, axis=0).T


def _splat(s: Sighting, parts: np.ndarray, targets: Targets, out: np.ndarray) -> None:
    mine = np.flatnonzero(s.view.part_seen == OPEN)
    if not len(mine):
        return
    parcels, shares = _columns(s.view.part_direction[mine], targets)
    flat = s.rows[s.view.part_row[mine], None] * targets.columns + parcels
    weights = parts[mine, None] * shares
    _add(out, flat.ravel(), weights.ravel())


def _add(out: np.ndarray, place: np.ndarray, weights: np.ndarray) -> None:
    """Add weights at places of the flattened matrix, some of them to the same."""
    np.add.at(out.reshape(-1), place, weights.astype(out.dtype, copy=False))


def _columns(directions: np.ndarray, targets: Targets) -> tuple[np.ndarray, np.ndarray]:
    """Sky columns and shares that stand for directions; the ground's where they point below the horizon."""
    parcels, shares = targets.globe.interpolation(directions)
    return np.where(parcels < targets.sky_parcels, parcels, targets.sky_parcels), shares
