"""A year of daylight: on each face or point the hours within limits, and what standards make of them.

- Daylight autonomy: share of the occupied hours with at least some illuminance (Reinhart & Walkenhorst 2001).
- Useful daylight illuminance: share of them within limits, 100 to 3,000 lx (Nabil & Mardaljevic 2005, 2006; Mardaljevic
  et al. 2012).
- Spatial daylight autonomy sDA300/50% and annual sunlight exposure ASE1000,250h: shares of an area (IES LM-83-12).
- Daylight provision by EN 17037:2018, method 2: illuminances that are reached over half, and over 95 %, of an area for
  half of the daylight hours.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .block import Block, checked_lights
from .daylight import Daylight
from .errors import SceneError
from .stages import Stage

if TYPE_CHECKING:
    from .transfer import Transfer

LIMITS = (100.0, 300.0, 500.0, 750.0, 1000.0, 2000.0, 3000.0)
"""Illuminances that hours are counted by [lx]: those that the standards name."""

DIRECT_SUNLIGHT = 1000.0
"""Direct sunlight that counts for the annual sunlight exposure [lx]."""

PROVISION = {"minimum": (300.0, 100.0), "medium": (500.0, 300.0), "high": (750.0, 500.0)}
"""EN 17037, vertical and inclined openings: target over half, minimum target over 95 %, of the area [lx]."""


@dataclass(frozen=True, eq=False)
class Annual:
    """Daylight of many hours, summed up; made by `Transfer.annual`.

    Attributes
    ----------
    transfer : Transfer
    hours : float
        That were counted.
    lux_hours : (r,) float
        [lx·h]
    limits : (t,) float
        [lx]
    reached : (t, r) float
        Hours with at least so much.
    sunny : (r,) float
        Hours with at least 1,000 lx of direct sunlight.
    of_faces : bool
        Whether receivers are the faces; else free points.
    stages : tuple of Stage
    """

    transfer: Transfer
    hours: float
    lux_hours: np.ndarray
    limits: np.ndarray
    reached: np.ndarray
    sunny: np.ndarray
    of_faces: bool
    stages: tuple[Stage, ...]

    @property
    def mean_illuminance(self) -> np.ndarray:
        """(r,) float: mean over the hours [lx]."""
        return self.lux_hours / self.hours

    def daylight_autonomy(self, illuminance: float = 300.0) -> np.ndarray:
        """(r,) float: share of the hours with at least so much, 0 to 1; `SceneError` where it is none of ``limits``."""
        return self._reached(illuminance) / self.hours

    def useful_daylight(self, low: float = 100.0, high: float = 3000.0) -> np.ndarray:
        """(r,) float: share of the hours with at least ``low`` and less than ``high`` lx, 0 to 1."""
        if not low < high:
            raise SceneError(f"useful_daylight: {low:g} lx is not below {high:g} lx")
        return (self._reached(low) - self._reached(high)) / self.hours

    def spatial_daylight_autonomy(
        self, surface: str | None = None, illuminance: float = 300.0, share: float = 0.5
    ) -> float:
        """Share of an area that has an illuminance for a share of the hours, 0 to 1.

        Parameters
        ----------
        surface : str, optional
            None = all points, each for the same area.
        illuminance : float
            One of ``limits`` [lx].
        share : float
            Of the hours. 300 lx for 0.5 of the hours from 8 to 18 h is sDA300/50% of IES LM-83-12.

        Returns
        -------
        float

        Raises
        ------
        SceneError
            For an unknown surface or illuminance.
        """
        rows, areas = self._area(surface)
        return float(areas @ (self.daylight_autonomy(illuminance)[rows] >= share) / areas.sum())

    def sunlight_exposure(self, surface: str | None = None, hours: float = 250.0) -> float:
        """Share of an area with 1,000 lx of direct sunlight for more hours than these: ASE1000,250h of IES LM-83-12."""
        rows, areas = self._area(surface)
        return float(areas @ (self.sunny[rows] > hours) / areas.sum())

    def provision(self, surface: str | None = None) -> str:
        """Level of daylight provision by EN 17037, method 2: "high", "medium", "minimum" or "none".

        The hours that were counted must be the daylight hours: the 4,380 with the most diffuse light outdoors.
        """
        reached = "none"
        for level, (target, least) in PROVISION.items():
            half = self.spatial_daylight_autonomy(surface, target, 0.5) >= 0.5
            if half and self.spatial_daylight_autonomy(surface, least, 0.5) >= 0.95:
                reached = level
        return reached

    def _reached(self, illuminance: float) -> np.ndarray:
        row = np.flatnonzero(self.limits == illuminance)
        if not len(row):
            known = ", ".join(f"{limit:g}" for limit in self.limits)
            raise SceneError(
                f"Hours were not counted by {illuminance:g} lx, only by {known}; name it in 'limits' of annual()"
            )
        return self.reached[row[0]]

    def _area(self, surface: str | None) -> tuple[np.ndarray, np.ndarray]:
        """Receivers, and the area that each stands for."""
        if not self.of_faces:
            if surface is not None:
                raise SceneError("These are free points, of no surface; leave out its name")
            return np.arange(len(self.lux_hours)), np.ones(len(self.lux_hours))
        geometry = self.transfer.geometry
        if surface is None:
            raise SceneError(f"Name a surface, one of: {', '.join(geometry.planes.surfaces[:20])}")
        rows = geometry.faces_of(surface)
        return rows, geometry.fracture.face_areas[geometry.reported[rows]]


def count_hours(transfer: Transfer, block: Block, hours: np.ndarray, limits: Iterable[float], of_faces: bool) -> Annual:
    """Sum up a block piece by piece.

    Parameters
    ----------
    transfer : Transfer
    block : Block
    hours : (n,) float
        That each light stands for; 0 = not counted.
    limits : iterable of float [lx]
    of_faces : bool

    Returns
    -------
    Annual
    """
    levels = np.unique(np.asarray(list(limits), float))
    _, receivers = block.shape
    lux_hours, sunny = np.zeros(receivers), np.zeros(receivers)
    reached = np.zeros((len(levels), receivers))
    counted = hours[block.order].astype(np.float32)
    for some, lux in block.pieces():
        lux_hours[some] = lux @ counted
        for level, out in zip(levels, reached, strict=True):
            out[some] = (lux >= level).astype(np.float32) @ counted
        lit, sunlight = block.sunlight(some)
        sunny[lit] = (sunlight >= DIRECT_SUNLIGHT).astype(np.float32) @ counted
    return Annual(transfer, float(hours.sum()), lux_hours, levels, reached, sunny, of_faces, block.stages)


def without_dark(lights: Iterable[Daylight | None], hours) -> tuple[list[Daylight | None], np.ndarray]:
    """Lights that count, all dark ones as one, and the hours that each stands for (see `Transfer.annual`)."""
    given = checked_lights(lights)
    if not given:
        raise SceneError("annual() was given no lights; give one for each hour, None for the dark ones")
    counted = _checked_hours(hours, len(given))
    dark = np.array([light is None or light.horizontal_illuminance == 0 for light in given], bool)
    lit = np.flatnonzero(~dark & (counted > 0))
    night = float(counted[dark].sum())
    many = [given[k] for k in lit]
    return (many, counted[lit]) if night == 0 else ([*many, None], np.append(counted[lit], night))


def _checked_hours(hours, count: int) -> np.ndarray:
    """(n,) float: hours that each light stands for; a mask counts as hours of 1; None = 1 each."""
    if hours is None:
        return np.ones(count)
    try:
        values = np.array(hours, float)
    except (TypeError, ValueError):
        raise SceneError("hours must be a number, or True or False, for each light") from None
    if values.shape != (count,) or not np.isfinite(values).all() or (values < 0).any() or not values.any():
        raise SceneError(
            f"hours must be {count} numbers, one for each light, none negative and not all 0; theirs is {values.shape}"
        )
    return values
