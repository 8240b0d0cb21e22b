"""Form factors: what each receiver gathers from patches, sky and ground, summed over its sightings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .fracture import Patches
from .globe import Globe, Hemisphere
from .planes import Planes
from .specular import GroupSight, Sighting
from .visibility import OPEN


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


@dataclass(frozen=True, eq=False)
class Gathered:
    """Form factors of receivers.

    Attributes
    ----------
    patches : (r, p) float32
        Form factor to each patch, direct and through specular chains.
    sky_direct, sky_specular : (r, c) float32, or None where no mirror was seen
        Form factor to each sky parcel, and last to the ground.
    unlit : (r,) float32
        Form factor to sides that neither reflect nor emit diffusely.
    truncated : (r,) float32
        Form factor of the chains that were cut off.
    """

    patches: np.ndarray
    sky_direct: np.ndarray
    sky_specular: np.ndarray | None
    unlit: np.ndarray
    truncated: np.ndarray


def gather(sight: GroupSight, points, targets: Targets, checkpoint: Callable[[], None] = lambda: None) -> Gathered:
    """Form factors of receivers that share one plane.

    Parameters
    ----------
    sight : GroupSight
    points : (r, 3) float
    targets : Targets
    checkpoint : callable
        Called between sightings; may raise to stop.

    Returns
    -------
    Gathered
    """
    rows = len(points)
    patches = np.zeros((rows, targets.patches.count))
    direct = np.zeros((rows, targets.columns))
    specular = None
    unlit = np.zeros(rows)
    sightings, truncated = sight.sightings(points, checkpoint)
    for s in sightings:
        parts = s.part_weights()
        _add_patches(s, parts, targets, patches, unlit)
        if s.mirrored:
            specular = np.zeros_like(direct) if specular is None else specular
            _add_mirrored_sky(s, parts, targets, specular)
        else:
            _add_sky(s, parts, targets, sight.hemisphere, direct)
    as_float32 = np.float32
    return Gathered(
        patches.astype(as_float32),
        direct.astype(as_float32),
        None if specular is None else specular.astype(as_float32),
        unlit.astype(as_float32),
        truncated.astype(as_float32),
    )


def _add_patches(s: Sighting, parts: np.ndarray, targets: Targets, out: np.ndarray, unlit: np.ndarray) -> None:
    if not len(s.obstacles.outlines):
        return
    view, grid = s.view, targets.patches
    fronts = len(targets.planes.sheet_surface)
    sheet = targets.planes.outline_sheet[s.obstacles.outlines]
    whole = np.flatnonzero(view.seen >= 0)
    row, beam = np.divmod(whole, view.seen.shape[1])
    obstacle = view.seen.ravel()[whole]
    weight = s.weights[row, beam]
    mine = np.flatnonzero(view.part_seen >= 0)
    row = np.concatenate([row, view.part_row[mine]])
    obstacle = np.concatenate([obstacle, view.part_seen[mine]])
    weight = np.concatenate([weight, parts[mine]])
    height = view.heights[row, obstacle]
    side = sheet[obstacle] + np.where(height > 0, fronts, 0)
    base = grid.grid_base[side]
    dark = base < 0
    if dark.any():
        unlit[s.rows] += np.bincount(row[dark], weights=weight[dark], minlength=len(s.rows))
    axes, origin, scale = targets.planes.sheet_axes[sheet], grid.grid_origin, grid.grid_scale
    slope = s.beams.directions @ s.obstacles.normals.T
    # in-plane place = (axes · point) + distance · (axes · direction)
    at_point = np.einsum("oac,rc->roa", axes, s.points)
    along = np.einsum("oac,kc->koa", axes, s.beams.directions)
    count = len(whole)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        distance = height[:count] / slope[beam, obstacle[:count]]
        place = at_point[row[:count], obstacle[:count]] + distance[:, None] * along[beam, obstacle[:count]]
        to_part = view.part_direction[mine]
        o = obstacle[count:]
        far = height[count:] / np.einsum("nc,nc->n", to_part, s.obstacles.normals[o])
        part_place = at_point[row[count:], o] + far[:, None] * np.einsum("nac,nc->na", axes[o], to_part)
    place = np.nan_to_num(np.concatenate([place, part_place]), posinf=1e30, neginf=-1e30)
    shape = grid.grid_shape[side]
    cell = np.clip((place - origin[side]) * scale[side], 0, shape - 1).astype(np.int64)
    lit = ~dark
    patch = grid.grid[(base + cell[:, 0] * shape[:, 1] + cell[:, 1])[lit]]
    flat = row[lit] * targets.patches.count + patch
    sums = np.bincount(flat, weights=weight[lit], minlength=len(s.rows) * targets.patches.count)
    out[s.rows] += sums.reshape(len(s.rows), -1)


def _add_sky(s: Sighting, parts: np.ndarray, targets: Targets, hemisphere: Hemisphere, out: np.ndarray) -> None:
    parcels = hemisphere.parcels[s.beams.columns]
    free = np.where(s.view.seen == OPEN, s.weights, 0.0)
    above = parcels < targets.sky_parcels
    out[np.ix_(s.rows, parcels[above])] += free[:, above]
    out[s.rows, -1] += free[:, ~above].sum(axis=1)
    _splat(s, parts, targets, out)


def _add_mirrored_sky(s: Sighting, parts: np.ndarray, targets: Targets, out: np.ndarray) -> None:
    free = np.flatnonzero((s.view.seen == OPEN) & (s.weights > 0))
    row, beam = np.divmod(free, s.weights.shape[1])
    weight = s.weights[row, beam]
    parcels, shares = _columns(s.beams.directions, targets)
    for k in range(4):
        flat = row * targets.columns + parcels[beam, k]
        out[s.rows] += np.bincount(flat, weights=weight * shares[beam, k], minlength=len(s.rows) * targets.columns).reshape(len(s.rows), -1)
    _splat(s, parts, targets, out)


def _splat(s: Sighting, parts: np.ndarray, targets: Targets, out: np.ndarray) -> None:
    mine = np.flatnonzero(s.view.part_seen == OPEN)
    if not len(mine):
        return
    parcels, shares = _columns(s.view.part_direction[mine], targets)
    row = s.rows[s.view.part_row[mine]]
    for k in range(4):
        np.add.at(out, (row, parcels[:, k]), parts[mine] * shares[:, k])


def _columns(directions: np.ndarray, targets: Targets) -> tuple[np.ndarray, np.ndarray]:
    """Sky columns and shares that stand for directions; the ground's where they point below the horizon."""
    parcels, shares = targets.globe.interpolation(directions)
    return np.where(parcels < targets.sky_parcels, parcels, targets.sky_parcels), shares
