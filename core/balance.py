"""Lumen balance: where the light went."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .result import Result


@dataclass(frozen=True)
class Balance:
    """Lumens of a scene.

    Light counts where it lands, after any specular chain. What lands is absorbed or diffusely reflected; what is
    reflected or emitted lands again, escapes, is lost on dark backs, or is cut off with its chain.

    Attributes
    ----------
    entering : float
        Emitted by surfaces, plus what of sky, ground and Sun lands without any diffuse reflection [lm].
    absorbed : dict of str to float
        By surface, fronts and receiving backs together [lm].
    unlit : float
        Lost on sides that receive nothing, the backs of one-sided surfaces [lm].
    escaped : float
        Emitted or reflected diffusely, and out through openings [lm].
    truncated : float
        In specular chains that were cut off: sunlight exactly, other light as if what is behind the cut were as
        bright as the mean [lm].
    defect : float
        What fails to close the balance, relative to ``entering``.
    adjusted : float
        What failed to close it before the small errors of means over areas were made up for, where light arrives and
        where it escapes (see `Conservation`), relative to ``entering``: how well the scene is resolved.
    """

    entering: float
    absorbed: dict[str, float]
    unlit: float
    escaped: float
    truncated: float
    defect: float
    adjusted: float


def lumen_balance(result: Result) -> Balance:
    """Balance of a result on its elements; see `Balance`."""
    transfer, components = result.transfer, result.field.components
    geometry = transfer.geometry
    area, surface = geometry.areas, geometry.element_surface
    absorptance, reflectance = (
        geometry.of_elements(name) for name in ("hemispherical_absorptance", "diffuse_reflectance")
    )
    emitted = geometry.of_elements("exitance")

    illuminance = sum(components.values())
    outside = sum(components[name] for name in ("sky_direct", "sky_specular", "sun_direct", "sun_specular"))
    entering = float((area * (emitted + outside * (absorptance + reflectance))).sum())
    flux = area * (emitted + reflectance * illuminance)
    open_share = transfer.sky_direct.row_totals() + transfer.sky_specular.row_totals()
    # not `on_elements`, which leaves out what is interpolated below nothing: what stays is told with it
    escaped, unlit, lost = (
        float(flux @ transfer.nodes.weights.apply(share)) for share in (open_share, transfer.unlit, transfer.truncated)
    )
    gone = escaped + unlit + lost
    if gone > 0:  # shared alike by all that does not stay
        escaped, unlit, lost = (part * (1 + result.field.beyond / gone) for part in (escaped, unlit, lost))
    absorbed = np.bincount(surface, weights=area * illuminance * absorptance, minlength=len(geometry.surface_materials))
    # light from outside that is cut with its chain never lands, so it is no part of entering
    truncated = lost
    if entering == 0:
        return Balance(
            0.0,
            dict(zip(geometry.planes.surfaces, absorbed.tolist(), strict=True)),
            0.0,
            0.0,
            result.sunlight.truncated,
            0.0,
            0.0,
        )
    defect = (entering - absorbed.sum() - escaped - unlit - truncated) / entering
    return Balance(
        entering=entering,
        absorbed=dict(zip(geometry.planes.surfaces, absorbed.tolist(), strict=True)),
        unlit=unlit,
        escaped=escaped,
        truncated=truncated + result.sunlight.truncated + _cut_sky(result),
        defect=float(defect),
        adjusted=result.field.adjusted / entering,
    )


def _cut_sky(result: Result) -> float:
    """Lumens of sky and ground light in the cut chains, as if these ended in the mean luminance of the open parcels."""
    transfer = result.transfer
    kept = transfer.geometry.areas_kept  # what mirrors pass on is cut where it lands
    if not transfer.truncated.any() or not result.sky.any():
        return 0.0
    weight = transfer.sky_direct.sums()
    total = float(weight.sum())
    mean = float(weight @ result.sky) / total if total else 0.0
    return float(np.pi * mean * (kept @ transfer.on_elements(transfer.truncated)))
