"""Bright few: luminous surfaces and sun patches as convex polygons, made ready for receivers anywhere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons
from .outlines import Outlines
from .pieces import tightened
from .standing import Shining
from .tracing import ChainLimits

FAINT = 1e-4
"""Of the illuminance that the sources' flux would be, spread over all surfaces: what gives less is not looked for."""

_TOGETHER = 32
"""Sources that are clipped at once, or a few more: all of one plane."""


@dataclass(frozen=True, eq=False)
class Source:
    """A convex polygon of even luminous exitance.

    Attributes
    ----------
    polygon : (v, 3) float
        Right-handed about the direction that it shines to.
    exitance : float [lm/m²]
    """

    polygon: np.ndarray
    exitance: float

    @property
    def plane(self) -> tuple[np.ndarray, float]:
        """Unit normal and offset of its plane."""
        normal = polygons.newell_normal(self.polygon)
        normal = normal / np.linalg.norm(normal)
        return normal, float(normal @ self.polygon.mean(axis=0))


def even_illuminance(outlines: Outlines, sources: list[Source]) -> float:
    """What the sources' flux would be, spread over all surfaces [lx]."""
    flux = sum(source.exitance * float(polygons.areas(source.polygon)) for source in sources)
    return flux / max(float(polygons.areas(outlines.vertices).sum()), 1e-300)


@dataclass(frozen=True, eq=False)
class Bright:
    """Sources made ready for receivers anywhere.

    Attributes
    ----------
    outlines : Outlines
    sources : list of Source
        At least one.
    limits : ChainLimits
    faint : float
        See `gather_sources`.
    """

    outlines: Outlines
    sources: list[Source]
    limits: ChainLimits
    faint: float = FAINT

    @cached_property
    def groups(self) -> list[_Group]:
        """Sources that are clipped at once."""
        return _groups(self.sources, self.outlines)

    @cached_property
    def least(self) -> float:
        """What gives no more is not looked for in mirrors [lx]."""
        return self.faint * even_illuminance(self.outlines, self.sources)

    @cached_property
    def mirrors(self) -> dict[int, float]:
        """Outlines that mirror, and their largest reflectance.

        One in the receivers' own plane too, since it comes into view by way of others.
        """
        cosines = np.linspace(0.05, 1.0, 8)
        every = enumerate(self.outlines.materials)
        return {o: float(material.specular_at(cosines).max()) for o, material in every if material.is_specular}

    @cached_property
    def brightest(self) -> float:
        """No less than the exitance that is seen along any one direction, all mirrors on the way together."""
        planes = [brightest for group in self.groups for brightest in group.brightest]
        mixed = any(
            (m.is_specular or m.is_transparent) and (m.diffuse_reflectance > 0 or m.exitance > 0)
            for m in self.outlines.materials
        )
        return (1 + self.limits.exact_mirrors) * sum(planes) if mixed else max(planes)


@dataclass(frozen=True, eq=False)
class _Group:
    """Sources that are clipped at once, plane after plane.

    Attributes
    ----------
    polygons : (s, v, 3) float, padded
    exitance : (s,) float
    plane : (s,) int
        Of those below.
    normals, offsets : (p, 3) and (p,) float
        Planes before which sources are seen.
    outlines : Outlines
    """

    polygons: np.ndarray
    exitance: np.ndarray
    plane: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    outlines: Outlines

    def heights(self, points) -> np.ndarray:
        """(p, r) float: of points ``(r, 3)`` before the planes."""
        return self.normals @ points.T - self.offsets[:, None]

    @cached_property
    def spheres(self) -> tuple[np.ndarray, np.ndarray]:
        """Centres (s, 3) and radii (s,) of spheres around the sources."""
        centres = self.polygons.mean(axis=1)
        return centres, np.linalg.norm(self.polygons - centres[:, None], axis=2).max(axis=1)

    @cached_property
    def fluxes(self) -> np.ndarray:
        """(s,) float [lm]."""
        return self.exitance * polygons.areas(self.polygons)

    def most(self, source, points, height) -> np.ndarray:
        """(n,) float: no less than what points ``(n, 3)`` at heights (n,) before sources (n,) get of these [lx]."""
        centres, radii = self.spheres
        height = np.maximum(height, 1e-100)
        away = points - centres[source]
        near = np.maximum(np.sqrt(np.einsum("nc,nc->n", away, away)) - radii[source], height)
        most = self.fluxes[source] * (height / near) / (np.pi * near**2)
        return np.minimum(most, self.exitance[source])

    @cached_property
    def brightest(self) -> list[float]:
        """No less than the exitance at any one place of each plane, where sources lie on one another."""
        found = []
        for number, normal in enumerate(self.normals):
            mine = self.plane == number
            flat = self.polygons[mine] @ polygons.plane_basis(normal).T
            low, high = flat.min(axis=1), flat.max(axis=1)
            meet = (np.minimum(high[:, None], high) > np.maximum(low[:, None], low)).all(axis=2)
            found.append(float((meet @ self.exitance[mine]).max()))
        return found

    @cached_property
    def shining(self) -> Shining:
        """The sources, and what of the outlines lies before each plane."""
        return Shining.of(self.outlines, self.polygons, self.plane, self.normals, self.offsets)


def _groups(sources: list[Source], outlines: Outlines) -> list[_Group]:
    planes: list[tuple[np.ndarray, float, list[Source]]] = []
    for source in sources:
        normal, offset = source.plane
        for other, at, members in planes:
            if other @ normal > 1 - 1e-12 and abs(at - offset) <= outlines.tolerance:
                members.append(source)
                break
        else:
            planes.append((normal, offset, [source]))
    together: list[list[tuple[np.ndarray, float, list[Source]]]] = []
    room = 0
    for plane in sorted(planes, key=lambda plane: max(len(source.polygon) for source in plane[2])):
        if room <= 0:
            together.append([])
            room = _TOGETHER
        together[-1].append(plane)
        room -= len(plane[2])
    return [
        _Group(
            tightened(polygons.pad([source.polygon for _, _, members in some for source in members])[0])[0],
            np.array([source.exitance for _, _, members in some for source in members]),
            np.repeat(np.arange(len(some)), [len(members) for _, _, members in some]),
            np.array([normal for normal, _, _ in some]),
            np.array([offset for _, offset, _ in some]),
            outlines,
        )
        for some in together
    ]
