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

    Attributes
    ----------
    entering : float
        Emitted by surfaces, and arriving on them from sky, ground and Sun without any diffuse reflection.
    absorbed : dict of str to float
        By surface.
    unlit : float
        Lost on sides that receive nothing (the backs of one-sided surfaces).
    escaped : float
        Left through openings.
    truncated : float
        In specular chains that were cut off.
    defect : float
        What the balance fails to close by, relative to ``entering``.
    """

    entering: float
    absorbed: dict[str, float]
    unlit: float
    escaped: float
    truncated: float
    defect: float


def lumen_balance(result: Result) -> Balance:
    """Balance of a result; see `Balance`."""
    raise NotImplementedError
