"""The scene's outlines, with what light does at them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .facets import Facets
from .materials import Material
from .projection import Obstacles
from .rays import RayScene
from .solids import Solids


@dataclass(frozen=True, eq=False)
class Outlines:
    """The scene's convex outlines with what light does at them.

    Attributes
    ----------
    vertices : (o, w, 3) float, padded
    normals : (o, 3) float
    offsets : (o,) float
    materials : list of Material, one per outline
    two_sided : (o,) bool
    tolerance : float
        Length below which points count as lying on a plane [m].
    solids : Solids, optional
    facets : Facets, optional
        Where there are too many for each to be projected.
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    materials: list[Material]
    two_sided: np.ndarray
    tolerance: float
    solids: Solids | None = None
    facets: Facets | None = None

    @cached_property
    def rays(self) -> RayScene:
        """The outlines, to shoot single rays at."""
        return RayScene(self.vertices, self.normals, self.offsets, self.tolerance)

    @cached_property
    def plain_mirrors(self) -> np.ndarray:
        """(2, o) float: reflectance of fronts and backs that do nothing but mirror, 0 for all others."""
        plain = np.zeros((2, len(self.materials)))
        for o, m in enumerate(self.materials):
            if m.refractive_index is None and not (m.is_transparent or m.diffuse_reflectance or m.exitance):
                plain[0, o] = m.specular_reflectance
                plain[1, o] = m.specular_reflectance if self.two_sided[o] else 0.0
        return plain

    @cached_property
    def whole(self) -> Obstacles:
        """All outlines, uncut, as obstacles."""
        bounding = np.ones(self.vertices.shape[:2], bool)
        return Obstacles(np.arange(len(self.vertices)), self.vertices, bounding, self.normals, self.offsets)

    @cached_property
    def projected(self) -> np.ndarray:
        """(l,) int: outlines that are projected on the globe."""
        return np.arange(len(self.vertices)) if self.facets is None else self.facets.large

    @cached_property
    def transparent(self) -> np.ndarray:
        """(o,) bool: outlines that light passes straight through."""
        return np.array([m.is_transparent for m in self.materials], bool)

    @cached_property
    def back_counts(self) -> np.ndarray:
        """(o,) bool: whether light on the back goes anywhere, onto a receiver or on by a mirror."""
        return self.two_sided | np.array([m.reflects_both_sides for m in self.materials], bool)

    def unseen_backs(self, points: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """(o,) bool: outlines whose backs none of some receivers of one plane ``(r, 3)`` can see."""
        if self.solids is None:
            return np.zeros(len(self.vertices), bool)
        return self.solids.unseen_backs(points, normal)

    def ways(self, o: int, front: bool, cosine: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
        """How light goes on from a side of outline ``o`` where it comes at cosines ``(n,)``, and which share of it."""
        material = self.materials[o]
        if material.is_specular and (front or self.two_sided[o] or material.reflects_both_sides):
            yield "mirror", material.specular_at(cosine)
        if material.is_transparent:
            yield "through", material.transmittance_at(cosine)

    @cached_property
    def any_specular(self) -> bool:
        """Whether any surface mirrors or transmits regularly."""
        return any(m.is_specular or m.is_transparent for m in self.materials)

    @cached_property
    def splits_light(self) -> bool:
        """Whether any surface does both, so that chains may double at each."""
        return any(m.is_specular and m.is_transparent for m in self.materials)
