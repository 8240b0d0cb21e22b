"""Fingerprint: what form factors depend on, so that they are used again only where they hold.

Diffuse reflectances and exitances are no part of it, only whether there are any: light that diffuse surfaces send out
is multiplied by form factors, not contained in them.
"""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass

import numpy as np

from .options import Options
from .scene import Scene, Surface


@dataclass(frozen=True)
class Fingerprint:
    """What a transfer was prepared for.

    Attributes
    ----------
    options : dict
        Of `Options`, by name.
    surfaces : tuple of (name, shape, optics)
        In the scene's order: SHA-256 of the shape, and of how the surface mirrors and transmits.
    """

    options: dict
    surfaces: tuple[tuple[str, str, str], ...]

    @classmethod
    def of(cls, scene: Scene, options: Options) -> Fingerprint:
        """Fingerprint of a scene and options."""
        return cls(asdict(options), tuple((s.name, _shape(s), _optics(s)) for s in scene.surfaces.values()))

    def difference(self, other: Fingerprint) -> str:
        """In what the other differs, in words that follow "prepared for …"; empty where it does not."""
        for name, mine in self.options.items():
            theirs = other.options.get(name)
            if mine != theirs:
                return f"{name}={mine}, not {name}={theirs}"
        before, now = self._by_name, other._by_name
        for name in now:
            if name not in before:
                return f"a scene without the surface '{name}'"
        for name, (shape, optics) in before.items():
            if name not in now:
                return f"a scene with a surface '{name}'"
            if now[name][0] != shape:
                return f"another shape of '{name}'"
            if now[name][1] != optics:
                return (
                    f"a '{name}' that mirrors, transmits, or sends out diffuse light where it does not, "
                    "or the other way round, or by other shares"
                )
        if self.surfaces != other.surfaces:
            return "the same surfaces in another order"
        return ""

    @property
    def _by_name(self) -> dict[str, tuple[str, str]]:
        return {name: (shape, optics) for name, shape, optics in self.surfaces}

    def changed(self, other: Fingerprint) -> set[str]:
        """Surfaces that only one of the two has, or that are of another shape or mirror or transmit otherwise there."""
        before, now = self._by_name, other._by_name
        return {name for name in before.keys() | now.keys() if before.get(name) != now.get(name)}


def _shape(surface: Surface) -> str:
    digest = hashlib.sha256()
    for array in (surface.pieces.astype("<f8"), surface.counts.astype("<i8"), surface.source_faces.astype("<i8")):
        digest.update(str(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    digest.update(b"two-sided" if surface.two_sided else b"one-sided")
    return digest.hexdigest()


def _optics(surface: Surface) -> str:
    material = surface.material
    values = (
        material.specular_reflectance,
        material.regular_transmittance,
        material.refractive_index,
        material.diffuse_reflectance > 0,
        material.exitance > 0,
        # the dark back of a pane takes what this leaves
        material.diffuse_reflectance if material.is_transparent else None,
    )
    return hashlib.sha256(repr(values).encode()).hexdigest()
