"""Materials: how a surface reflects, transmits and emits light, and the optics of a clear pane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .checks import checked_number
from .errors import SceneError

_ROUNDING = 1e-12


@dataclass(frozen=True, kw_only=True)
class Material:
    """Optical properties of a surface.

    Parameters
    ----------
    diffuse_reflectance : float
        Share of the incident light that leaves evenly in all directions (Lambert), 0 to 1.
    specular_reflectance : float
        Share that leaves as from a mirror, 0 to 1.
    regular_transmittance : float
        Share that goes straight through a clear pane at normal incidence, 0 to 1.
    diffuse_transmittance : float
        Reserved for translucent materials; anything but 0 raises.
    exitance : float
        Luminous exitance that the surface emits by itself [lm/m²].
    refractive_index : float, optional
        Of a clear pane, above 1: reflection and transmission then follow Fresnel's equations and depend on the angle.
        Absorption inside follows from ``regular_transmittance``; the mirror reflection follows and is not given
        besides.

    Raises
    ------
    SceneError
        Where a value is out of range or the shares add up to more than 1.
    """

    diffuse_reflectance: float = 0.0
    specular_reflectance: float = 0.0
    regular_transmittance: float = 0.0
    diffuse_transmittance: float = 0.0
    exitance: float = 0.0
    refractive_index: float | None = None

    def __post_init__(self):
        for name in (
            "diffuse_reflectance",
            "specular_reflectance",
            "regular_transmittance",
            "diffuse_transmittance",
            "exitance",
        ):
            value = _number(name, getattr(self, name))
            object.__setattr__(self, name, value)
            if value < 0:
                raise SceneError(f"Material: {name} is {value:g}; it cannot be negative")
            if name != "exitance" and value > 1:
                raise SceneError(f"Material: {name} is {value:g}; give a share between 0 and 1 (not percent)")
        if self.diffuse_transmittance > 0:
            raise SceneError(
                "Material: diffuse_transmittance (translucent materials) is not available yet; set it to 0"
            )
        total = self.diffuse_reflectance + self.specular_reflectance + self.regular_transmittance
        if total > 1 + _ROUNDING:
            raise SceneError(
                "Material: diffuse_reflectance + specular_reflectance + regular_transmittance "
                f"= {total:g}; lower them to at most 1"
            )
        if self.refractive_index is not None:
            self._check_pane()

    def _check_pane(self):
        index = _number("refractive_index", self.refractive_index)
        object.__setattr__(self, "refractive_index", index)
        if index <= 1:
            raise SceneError(f"Material: refractive_index is {index:g}; it must be above 1 (window glass: 1.52)")
        if self.specular_reflectance > 0:
            raise SceneError(
                "Material: with refractive_index the mirror reflection follows; leave out specular_reflectance"
            )
        if self.diffuse_reflectance > 0:
            raise SceneError(
                "Material: refractive_index is for clear panes; leave out diffuse_reflectance or refractive_index"
            )
        r = normal_interface_reflectance(index)
        clearest = (1 - r) ** 2 / (1 - r**2)
        if self.regular_transmittance > clearest * (1 + 1e-9):
            raise SceneError(
                f"Material: regular_transmittance {self.regular_transmittance:g} is more than the {clearest:.4f} that "
                f"a pane of refractive index {index:g} can have; lower one of the two"
            )

    @property
    def is_specular(self) -> bool:
        """Whether light is reflected as from a mirror (a pane's own reflection included)."""
        return self.specular_reflectance > 0 or self.refractive_index is not None

    @property
    def is_transparent(self) -> bool:
        """Whether light goes straight through."""
        return self.regular_transmittance > 0

    @property
    def reflects_both_sides(self) -> bool:
        """A pane's interfaces mirror on both sides, whatever the surface's ``two_sided``."""
        return self.refractive_index is not None and self.is_transparent

    def specular_at(self, cosine) -> np.ndarray:
        """Specular reflectance at an angle of incidence.

        Parameters
        ----------
        cosine : array of float
            Cosine of the angle of incidence; its sign does not matter.

        Returns
        -------
        array of float, same shape
        """
        if self.refractive_index is None:
            return np.full(np.shape(cosine), self.specular_reflectance)
        return pane_optics(cosine, self.refractive_index, self._inner)[0]

    def transmittance_at(self, cosine) -> np.ndarray:
        """Regular transmittance at an angle of incidence; parameters as for `specular_at`."""
        if self.refractive_index is None:
            return np.full(np.shape(cosine), self.regular_transmittance)
        return pane_optics(cosine, self.refractive_index, self._inner)[1]

    @cached_property
    def hemispherical_absorptance(self) -> float:
        """Share of evenly diffuse incident light that is absorbed."""
        if self.refractive_index is None:
            return 1.0 - self.diffuse_reflectance - self.specular_reflectance - self.regular_transmittance
        nodes, weights = np.polynomial.legendre.leggauss(64)
        cosine = 0.5 * (nodes + 1)
        reflectance, transmittance = pane_optics(cosine, self.refractive_index, self._inner)
        return float(1.0 - (weights * cosine * (reflectance + transmittance)).sum())

    @property
    def _inner(self) -> float:
        return inner_transmittance(self.regular_transmittance, float(self.refractive_index or 1.0))


def normal_interface_reflectance(refractive_index: float) -> float:
    """Fresnel reflectance of one interface with air at normal incidence."""
    return ((refractive_index - 1) / (refractive_index + 1)) ** 2


def inner_transmittance(transmittance: float, refractive_index: float) -> float:
    """Bouguer's inner transmittance of one crossing at normal incidence, from the whole pane's transmittance.

    Solves T = (1 − r)² a / (1 − r² a²) for a.
    """
    r = normal_interface_reflectance(refractive_index)
    if transmittance <= 0:
        return 0.0
    b = (1 - r) ** 2
    return min(1.0, 2 * transmittance / (b + math.sqrt(b * b + 4 * (transmittance * r) ** 2)))


def pane_optics(cosine, refractive_index: float, inner: float) -> tuple[np.ndarray, np.ndarray]:
    """Reflectance and regular transmittance of a pane with two interfaces, for unpolarised light.

    The whole series of inner reflections for each polarisation, then their mean (e.g. Born & Wolf, Principles of
    Optics, 1.6; Duffie & Beckman 2013, eq. 5.3.1).

    Parameters
    ----------
    cosine : array of float
        Cosine of the angle of incidence; its sign does not matter.
    refractive_index : float
    inner : float
        Bouguer's transmittance of one crossing at normal incidence.

    Returns
    -------
    reflectance, transmittance : arrays of float
    """
    outside = np.clip(np.abs(np.asarray(cosine, float)), 1e-12, 1.0)
    inside = np.sqrt(1 - (1 - outside**2) / refractive_index**2)
    once = inner ** (1 / inside) if inner > 0 else np.zeros_like(inside)
    reflectance, transmittance = np.zeros_like(outside), np.zeros_like(outside)
    for amplitude in (
        (outside - refractive_index * inside) / (outside + refractive_index * inside),
        (refractive_index * outside - inside) / (refractive_index * outside + inside),
    ):
        r = amplitude**2
        series = (1 - r) ** 2 / (1 - (r * once) ** 2)
        transmittance += 0.5 * series * once
        reflectance += 0.5 * (r + r * series * once**2)
    return reflectance, transmittance


def _number(name: str, value) -> float:
    if isinstance(value, tuple | list | np.ndarray):
        raise SceneError(f"Material: {name} is given per colour channel, which is not available yet; give one number")
    return checked_number(value, f"Material: {name}")
