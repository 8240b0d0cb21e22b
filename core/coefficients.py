"""Daylight coefficients: light by each parcel of the sky and each position of the Sun, all reflections included.

Light adds up, so that any number of skies and hours is one matrix product with what unit lights give (Tregenza &
Waters 1983). Parcels of the sky are those of the globe. Sunlight falls exactly, as polygons; what it sends on goes from
patch to patch, like all other light here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .daylight import Daylight
from .form_factors import patch_means
from .gather import gather
from .geometry import sight_of
from .parallel import run_parallel
from .radiosity import all_settled
from .result import coplanar
from .solve import patch_properties
from .sunlight import light_points, trace_sun
from .transfer import Transfer
from .weights import Weights

_COLUMNS = 2048
"""Unit lights whose reflections are found together: all of them at first solve the same equations anew."""

_ROWS = 512
_POINTS = 64


@dataclass(frozen=True, eq=False)
class Places:
    """Free points that light is wanted at.

    Attributes
    ----------
    points : (r, 3) float
        Relative to the scene's centre.
    normals : (r, 3) float, unit
    """

    points: np.ndarray
    normals: np.ndarray


@dataclass(frozen=True, eq=False)
class Coefficients:
    """What receivers, faces or free points, get from unit lights.

    Attributes
    ----------
    parcels : (k,) int
        Parcels of the sky that are seen by anything; the ground counts as one more than all parcels.
    suns : (s, 3) float
        Directions to the Sun.
    diffuse : (m, k + s) float32
        Per unit of luminance [lx/(cd/m²)], and of the Sun's normal illuminance; of the Sun only what is reflected
        diffusely. At the nodes, or at free points.
    weights : Weights or None
        Receivers' values from those of ``diffuse``; None where its rows are the receivers.
    by_sun : (2, s, r) float32
        Sunlight per unit of its normal illuminance, straight and by mirrors.
    steady : (r,) float
        By luminous surfaces [lx].
    """

    parcels: np.ndarray
    suns: np.ndarray
    diffuse: np.ndarray
    weights: Weights | None
    by_sun: np.ndarray
    steady: np.ndarray

    @property
    def count(self) -> int:
        """Number of receivers."""
        return len(self.steady)

    def illuminance(self, some: slice, skies: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What some receivers get of many skies, and of each position of the Sun.

        Parameters
        ----------
        some : slice
        skies : (k, n) float32
            Luminances of the parcels [cd/m²].

        Returns
        -------
        by_skies : (r, n) float32 [lx]
        by_suns : (r, s) float32
            Per unit of the Sun's normal illuminance.
        """
        parcels = len(self.parcels)
        if self.weights is None:
            by_skies, by_suns = self.diffuse[some, :parcels] @ skies, self.diffuse[some, parcels:].copy()
        else:  # receivers share fewer nodes
            nodes, shares = shares_of_nodes(self.weights, some)
            diffuse = self.diffuse[nodes]
            by_skies, by_suns = shares @ (diffuse[:, :parcels] @ skies), shares @ diffuse[:, parcels:]
        by_suns += self.by_sun[:, :, some].sum(axis=0).T
        return by_skies, by_suns


def shares_of_nodes(weights: Weights, some: slice) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (u,) that some receivers follow from, and their shares (r, u) float32."""
    entries = slice(weights.start[some.start], weights.start[some.stop])
    used, column = np.unique(weights.node[entries], return_inverse=True)
    shares = np.zeros((some.stop - some.start, len(used)), np.float32)
    np.add.at(shares, (weights.rows_of(some), column.reshape(-1)), weights.weight[entries])
    return used, shares


def face_weights(transfer: Transfer) -> Weights:
    """Means over the faces' fronts from values at the nodes."""
    cuts, weights = transfer.geometry.fracture, transfer.nodes.weights
    reported, element = transfer.geometry.reported, weights.rows
    place = np.full(cuts.sides, -1)
    place[reported] = np.arange(len(reported))
    area = np.bincount(cuts.element_side, weights=cuts.element_areas, minlength=cuts.sides)
    side = cuts.element_side[element]
    share = weights.weight * cuts.element_areas[element] / area[side]
    mine = place[side] >= 0
    return Weights.of(place[side[mine]], weights.node[mine], share[mine], len(reported))


def find_coefficients(
    transfer: Transfer, suns: np.ndarray, places: Places | None, report: Callable[[float, str], None]
) -> Coefficients:
    """What faces, or free points, get from unit lights.

    Parameters
    ----------
    transfer : Transfer
    suns : (s, 3) float, unit
        Directions to the Sun.
    places : Places or None
        None = the faces' fronts.
    report : callable(fraction, stage)

    Returns
    -------
    Coefficients

    Raises
    ------
    SceneError
        Where light multiplies without end.
    """
    geometry = transfer.geometry
    looked = None if places is None else _look(transfer, places)
    seen = transfer.sky_direct.columns() | transfer.sky_specular.columns()
    parcels = np.flatnonzero(seen if looked is None else seen | _seen(looked[0]))
    receivers = len(geometry.reported) if places is None else len(places.points)
    by_sun = np.zeros((2, len(suns), receivers), np.float32)
    on_patches = np.zeros((len(suns), geometry.targets.patches.count), np.float32)
    stays = _Stays(transfer)
    lumens = np.zeros(len(suns))

    def follow(one: int, checkpoint: Callable[[], None]) -> None:
        sunlight = trace_sun(geometry.outlines, suns[one], 1.0, transfer.limits.cutoff, checkpoint)
        direct, by_mirrors = sunlight.on_elements(geometry.triangles, geometry.planes.outline_sheet)
        on_patches[one] = geometry.patch_means(direct + by_mirrors)
        lumens[one] = stays.elements @ (direct + by_mirrors)
        if places is None:
            by_sun[:, one] = [
                geometry.fracture.side_means(values)[geometry.reported] for values in (direct, by_mirrors)
            ]
        else:
            by_sun[:, one] = light_points(geometry.outlines, sunlight.beams, places.points, places.normals)

    if len(suns):
        run_parallel(follow, list(range(len(suns))), transfer.threads, lambda done: report(0.6 * done, "sun"))
    report(0.6, "interreflection")
    columns = len(parcels) + len(suns)
    diffuse = np.zeros((len(transfer.nodes.points) if looked is None else receivers, columns), np.float32)
    reflectance, _ = patch_properties(geometry)
    reflects = reflectance.any()
    for first in range(0, columns, _COLUMNS):
        some = np.arange(first, min(first + _COLUMNS, columns))
        sky, sun = some[some < len(parcels)], some[some >= len(parcels)] - len(parcels)
        direct = _sky_rows(transfer, parcels[sky])
        out = diffuse[:, first : first + len(some)]
        if looked is not None:
            out[:, : len(sky)] += np.float32(np.pi) * looked[0][:, parcels[sky]]
        if reflects:
            initial = np.concatenate(
                [patch_means(geometry, transfer.nodes, direct).astype(np.float32), on_patches[sun].T], axis=1
            )
            exitance = reflectance[:, None].astype(np.float32) * all_settled(transfer.exchange, reflectance, initial)
            if looked is not None:
                out += looked[1] @ exitance
            else:
                reflected = _from_patches(transfer, exitance)
                # sunlight's first reflection escapes as elements see it, as where a single Sun is solved
                exitance[:, len(sky) :] -= reflectance[:, None].astype(np.float32) * on_patches[sun].T
                out += stays.settled(reflected, exitance, direct, lumens[sun])
        if looked is None:
            out[:, : len(sky)] += direct
        report(0.6 + 0.4 * (first + len(some)) / columns, "interreflection")
    return Coefficients(
        parcels,
        suns,
        diffuse,
        face_weights(transfer) if places is None else None,
        by_sun,
        _steady(transfer, places),
    )


def _seen(matrix: np.ndarray) -> np.ndarray:
    """(c,) bool: columns with anything but zeros."""
    seen = np.zeros(matrix.shape[1], bool)
    for first in range(0, len(matrix), _ROWS):
        seen |= (matrix[first : first + _ROWS] != 0).any(axis=0)
    return seen


def _sky_rows(transfer: Transfer, parcels: np.ndarray) -> np.ndarray:
    """(m, k) float32: illuminance of the nodes by parcels of unit luminance, without diffuse reflection."""
    rows = transfer.sky_direct.some_columns(parcels)
    rows += transfer.sky_specular.some_columns(parcels)
    rows *= np.float32(np.pi)
    return rows


def _from_patches(transfer: Transfer, exitance: np.ndarray) -> np.ndarray:
    """(m, c) float32: illuminance of the nodes by patches of exitances ``(p, c)``; see `solve.gather_patches`."""
    return transfer.form_factors @ exitance + transfer.conservation.made_up(exitance)


class _Stays:
    """What of light stays in the scene, as sums over its nodes: see `solve.settled_home`, for many lights at once."""

    def __init__(self, transfer: Transfer) -> None:
        geometry, conservation = transfer.geometry, transfer.conservation
        area, share = geometry.areas, geometry.of_elements("diffuse_reflectance")
        self.elements = area * share * (1 - conservation.lost)
        self.nodes = transfer.nodes.weights.gathered(self.elements, len(transfer.nodes.points))
        self.kept = transfer.nodes.weights.gathered(conservation.kept, len(transfer.nodes.points))
        self.parts = conservation.enclosures
        self.held = self.parts.sums(self.parts.of_nodes, self.kept * conservation.spread)
        self.spread = conservation.spread / np.maximum(self.held, 1e-300)[self.parts.of_nodes]
        self.stay = self.parts.sums(self.parts.of_nodes, self.nodes * self.spread)
        self.beyond = conservation.beyond

    def settled(
        self, reflected: np.ndarray, exitance: np.ndarray, direct: np.ndarray, lumens: np.ndarray
    ) -> np.ndarray:
        """Interreflected light ``(m, c)`` that adds up, for light that comes to the nodes, or as lumens to elements.

        ``exitance`` (p, c) of the patches that it comes from, as far as they tell what escapes of it.
        """
        missing = (self.nodes - self.kept) @ reflected - self.beyond @ exitance
        missing[: direct.shape[1]] += self.nodes @ direct
        missing[direct.shape[1] :] += lumens
        landed = np.array(
            [np.where(self.parts.of_nodes == part, self.kept, 0.0) @ reflected for part in range(self.parts.count)]
        )
        landed[self.held <= 0] = 0.0
        shares = landed / np.maximum(landed.sum(axis=0), 1e-300)
        shares *= missing / np.maximum(1 - self.stay @ shares, 1e-12)
        return reflected + self.spread[:, None] * shares[self.parts.of_nodes]


def _look(transfer: Transfer, places: Places) -> tuple[np.ndarray, np.ndarray]:
    """Form factors from free points to the sky's parcels and to patches, both float32."""
    geometry = transfer.geometry
    targets = geometry.targets
    sky = np.zeros((len(places.points), targets.columns), np.float32)
    patches = np.zeros((len(places.points), targets.patches.count), np.float32)
    for rows in coplanar(places.points, places.normals, geometry.outlines.tolerance):
        normal = places.normals[rows[0]]
        sight = sight_of(geometry, transfer.limits, normal, float(normal @ places.points[rows[0]]))
        for first in range(0, len(rows), _POINTS):
            some = rows[first : first + _POINTS]
            found = gather(sight, places.points[some], targets)
            sky[some], patches[some] = found.sky, found.patches
    return sky, patches


def _steady(transfer: Transfer, places: Places | None) -> np.ndarray:
    """(r,) float: illuminance by luminous surfaces alone."""
    count = len(transfer.geometry.reported) if places is None else len(places.points)
    if not any(material.exitance > 0 for material in transfer.geometry.surface_materials):
        return np.zeros(count)
    dark = transfer.solve(Daylight())
    if places is None:
        return dark.illuminance
    return dark.at(places.points + transfer.geometry.planes.centre, places.normals)
