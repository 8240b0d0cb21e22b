"""Result: illuminance per face and at free points, its components, and the lumen balance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, overload

import numpy as np

from .balance import Balance, lumen_balance
from .errors import SceneError
from .gather import gather
from .geometry import sight_of
from .sources import gather_sources
from .stages import Stage
from .sunlight import Sunlight

if TYPE_CHECKING:
    from .daylight import Daylight
    from .solve import Field
    from .transfer import Transfer

_TOGETHER = 64
"""Free points that are looked from together."""

INITIAL = ("sky_direct", "sky_specular", "sun_direct", "sun_specular", "emitted")
"""Components of the light that has met no diffuse surface."""

COMPONENTS = (*INITIAL, "interreflected")
"""Components of all light."""


@dataclass(frozen=True, eq=False)
class Side:
    """Values on one side of the faces, all of length n.

    Attributes
    ----------
    illuminance, initial, exitance : (n,) float
        [lx], [lx], [lm/m²]; NaN where that side is no receiver.
    components : dict of str to (n,) float [lx]
    centroids, normals : (n, 3) float
    areas : (n,) float [m²]
    """

    illuminance: np.ndarray
    initial: np.ndarray
    exitance: np.ndarray
    components: dict[str, np.ndarray]
    centroids: np.ndarray
    normals: np.ndarray
    areas: np.ndarray


@dataclass(frozen=True, eq=False)
class Result:
    """Light on a scene for one sky and Sun; made by `Transfer.solve`.

    Attributes
    ----------
    transfer : Transfer
    light : Daylight
    sky : (c,) float
        Luminance of the sky parcels, and last of the ground [cd/m²].
    sunlight : Sunlight
    field : Field
    front : Side
    back : Side or None
        The same for the backs of two-sided surfaces (NaN elsewhere); None where there are none.
    stages : tuple of Stage
        What ran, what was skipped and why, seconds each; preparation first.
    """

    transfer: Transfer
    light: Daylight
    sky: np.ndarray
    sunlight: Sunlight
    field: Field
    front: Side
    back: Side | None
    stages: tuple[Stage, ...]

    @classmethod
    def of(cls, transfer: Transfer, light: Daylight, sky, sunlight: Sunlight, field: Field, stages) -> Result:
        """Take element values together to faces."""
        cuts, planes, reported = transfer.geometry.fracture, transfer.geometry.planes, transfer.geometry.reported
        faces = len(cuts.faces)
        means = {name: cuts.side_means(values) for name, values in field.components.items()}
        total = np.sum(list(means.values()), axis=0)
        if not np.isfinite(total).all():
            worst = int(np.flatnonzero(~np.isfinite(total))[0])
            surface = planes.surfaces[cuts.face_surface[worst if worst < faces else cuts.back_of[worst - faces]]]
            raise ArithmeticError(f"Illuminance on '{surface}' is not finite; please report this scene")
        materials = transfer.geometry.surface_materials
        reflectance = np.array([m.diffuse_reflectance for m in materials])[cuts.face_surface][reported]
        emitted = np.array([m.exitance for m in materials])[cuts.face_surface][reported]
        centroids = cuts.faces[reported].mean(axis=1) + planes.centre

        def side(parts: dict[str, np.ndarray], normals: np.ndarray) -> Side:
            illuminance = np.sum(list(parts.values()), axis=0)
            initial = np.sum([parts[name] for name in INITIAL], axis=0)
            return Side(
                illuminance,
                initial,
                emitted + reflectance * illuminance,
                parts,
                centroids,
                normals,
                cuts.face_areas[reported],
            )

        normals = cuts.face_normals[reported]
        front = side({name: values[reported] for name, values in means.items()}, normals)
        back = None
        if np.isin(cuts.back_of, reported).any():
            parts = {}
            for name, values in means.items():
                parts[name] = np.full(faces, np.nan)
                parts[name][cuts.back_of] = values[faces:]
                parts[name] = parts[name][reported]
            back = side(parts, -normals)
        return cls(transfer, light, sky, sunlight, field, front, back, (*transfer.stages, *stages))

    @property
    def illuminance(self) -> np.ndarray:
        """(n,) float: illuminance per face, all light [lx]."""
        return self.front.illuminance

    @property
    def initial(self) -> np.ndarray:
        """(n,) float: illuminance before any diffuse reflection [lx]."""
        return self.front.initial

    @property
    def components(self) -> dict[str, np.ndarray]:
        """Illuminance by origin, each (n,) [lx]: they add up to `illuminance`."""
        return self.front.components

    @property
    def centroids(self) -> np.ndarray:
        """(n, 3) float [m]."""
        return self.front.centroids

    @property
    def normals(self) -> np.ndarray:
        """(n, 3) float, unit."""
        return self.front.normals

    @property
    def areas(self) -> np.ndarray:
        """(n,) float [m²]."""
        return self.front.areas

    @property
    def exitance(self) -> np.ndarray:
        """(n,) float: diffuse luminous exitance M₀ + ρ_d·E [lm/m²]."""
        return self.front.exitance

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3, 3) float: corners of the faces [m]."""
        geometry = self.transfer.geometry
        return geometry.fracture.faces[geometry.reported] + geometry.planes.centre

    @property
    def source_faces(self) -> np.ndarray:
        """(n,) int: for each face the index of the face given to `Scene.add` that it is a part of."""
        return self.transfer.geometry.fracture.face_source[self.transfer.geometry.reported]

    @property
    def surfaces(self) -> list[str]:
        """Names of the surfaces whose faces it holds."""
        geometry = self.transfer.geometry
        return [name for name, wanted in zip(geometry.planes.surfaces, geometry.wanted, strict=True) if wanted]

    @cached_property
    def error(self) -> np.ndarray:
        """(n,) float: estimate of what 95 of 100 faces' errors are below [lx]; see docs/method.md."""
        from .solve import estimate_errors

        errors = estimate_errors(self.transfer, self.light, self.sky, self.field)
        return self.transfer.geometry.fracture.side_means(errors)[self.transfer.geometry.reported]

    @property
    def notes(self) -> tuple[str, ...]:
        """What the scene check warns of; the same with surfaces and faces in ``transfer.findings``."""
        return tuple(str(finding) for finding in self.transfer.findings)

    def faces_of(self, name: str) -> np.ndarray:
        """(k,) int: faces of a surface.

        Raises
        ------
        SceneError
            Where no surface has this name, or its faces were not wanted.
        """
        return self.transfer.geometry.faces_of(name)

    def mean(self, name: str) -> float:
        """Area-weighted mean illuminance of a surface's front [lx]; `SceneError` for an unknown name."""
        faces = self.faces_of(name)
        return float(np.average(self.illuminance[faces], weights=self.areas[faces]))

    @overload
    def at(self, points, normals, initial: bool = False, components: Literal[False] = False) -> np.ndarray: ...

    @overload
    def at(self, points, normals, initial: bool = False, *, components: Literal[True]) -> dict[str, np.ndarray]: ...

    def at(self, points, normals, initial: bool = False, components: bool = False):
        """Illuminance at free points, gathered at the points themselves.

        Parameters
        ----------
        points, normals : (m, 3) array of float
            Normals of any length but zero; each point receives what lies above its plane. Surfaces through the point
            block nothing.
        initial : bool
            Leave out light that has met a diffuse surface.
        components : bool
            Tell it by origin.

        Returns
        -------
        (m,) float [lx], or dict of str to (m,) float [lx]
            With ``components`` the names of `Result.components` (``initial``: without "interreflected"), which add up
            to what comes without.

        Raises
        ------
        SceneError
            Where shapes differ, or a value is not finite, or a normal is zero.
        """
        place, normal = checked_points(points, normals)
        geometry, field = self.transfer.geometry, self.field
        place = place - geometry.planes.centre
        out = {name: np.zeros(len(place)) for name in (INITIAL if initial else COMPONENTS)}
        out["sun_direct"], out["sun_specular"] = self.sunlight.at(geometry.outlines, place, normal)
        sent = field.of_cells(geometry, initial)
        sources = {"emitted": field.sources[: field.emitters], "interreflected": field.sources[field.emitters :]}
        for rows in coplanar(place, normal, geometry.outlines.tolerance):
            n = normal[rows[0]]
            for start in range(0, len(rows), _TOGETHER):
                some = rows[start : start + _TOGETHER]
                for name, light in self._gathered(place[some], n, sent).items():
                    out[name][some] += light
                for name in sent:
                    limits = self.transfer.limits
                    out[name][some] += gather_sources(geometry.outlines, sources[name], place[some], n, limits)
        return out if components else np.sum(list(out.values()), axis=0)

    def _gathered(self, points, normal, sent: dict[str, tuple[np.ndarray, np.ndarray]]) -> dict[str, np.ndarray]:
        """Light of the sky, and of cells that ``sent`` it, on points of one plane by origin, (r,) float each [lx]."""
        transfer = self.transfer
        if transfer.unhidden_cells is not None and transfer.unhidden_cells.holds(points, normal).all():
            factors = transfer.unhidden_cells.factors(points, normal)[:, :-1]
            return {name: factors @ exitance for name, (exitance, _) in sent.items()}
        sight = sight_of(transfer.geometry, transfer.limits, normal, float(normal @ points[0]))
        seen = gather(sight, points, transfer.geometry.cells)
        light = {"sky_direct": np.pi * (seen.sky_direct @ self.sky)}
        if seen.sky_specular is not None:
            light["sky_specular"] = np.pi * (seen.sky_specular @ self.sky)
        for name, (exitance, deep) in sent.items():
            light[name] = seen.patches @ exitance + (0.0 if seen.deep is None else seen.deep @ deep)
        return light

    @cached_property
    def balance(self) -> Balance:
        """Lumens: entering, absorbed per surface, escaped, truncated, and the relative defect."""
        return lumen_balance(self)


def checked_points(points, normals) -> tuple[np.ndarray, np.ndarray]:
    """Points and unit normals, both (m, 3) float; `SceneError` where they are none."""
    try:
        place, normal = np.array(points, float), np.array(normals, float)
    except (TypeError, ValueError):
        raise SceneError("at(points, normals): both must be (m, 3) arrays of numbers") from None
    if place.ndim == 1 and place.shape == (0,):
        return np.zeros((0, 3)), np.zeros((0, 3))
    if place.ndim != 2 or place.shape[1] != 3 or normal.shape != place.shape:
        raise SceneError(f"at(points, normals): both must be of shape (m, 3), not {place.shape} and {normal.shape}")
    length = np.linalg.norm(normal, axis=1)
    bad = np.flatnonzero(~np.isfinite(place).all(axis=1) | ~np.isfinite(length) | (length == 0))
    if len(bad):
        raise SceneError(
            f"at(points, normals): point {bad[0]} is {place[bad[0]].tolist()} with normal {normal[bad[0]].tolist()}; "
            "points must be finite, normals finite and not zero"
        )
    return place, normal / length[:, None]


def coplanar(points: np.ndarray, normals: np.ndarray, tolerance: float) -> list[np.ndarray]:
    """Rows of points that share a plane."""
    if not len(points):
        return []
    height = np.einsum("mc,mc->m", points, normals)
    key = np.concatenate([np.rint(normals / 1e-9), np.rint(height / max(tolerance, 1e-300))[:, None]], axis=1)
    _, group = np.unique(key, axis=0, return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(group, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(group[order])) + 1)
