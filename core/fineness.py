"""Fineness: how finely a scene is resolved, for an error that the user asks for."""

from __future__ import annotations

import numpy as np

TRIAL_BANDS = 30
TRIAL_TIMES = 0.25
"""A trial solution's fineness."""

FEWEST_BANDS, MOST_BANDS = 20, 160

_ENOUGH_BANDS, _OF_BANDS = 24, 0.4
"""What sees the edges of the sky exactly sees surfaces well enough by so many bands, and by this share of the sky's."""

_USUAL_ACCURACY = 0.01
_SHARE_OF_GLOBE = 0.5
"""What of the error asked for the globe may take; the rest is for means over faces and patches."""


def receiver_bands(bands: int) -> int:
    """Bands by which faces' receivers look at a sky of ``bands``: fewer, where these are enough.

    What of a beam an edge leaves is exact however wide it is. So wider beams cost little but the sky's and the
    surfaces' unevenness within them, and faces' values are means over their neighbourhood anyway.
    """
    return max(min(bands, _ENOUGH_BANDS), round(_OF_BANDS * bands))


def times_for(accuracy: float) -> float:
    """How many times as many faces and patches as usual, and less doubt in interpolation, a relative error asks for."""
    return float(np.clip(1.5 * _USUAL_ACCURACY / accuracy, 0.25, 6.0))


def bands_for(accuracy: float, bands: int, errors: np.ndarray, areas: np.ndarray) -> int:
    """Number of bands for a relative error, from a trial solution: errors fall with the square of the bands.

    Parameters
    ----------
    accuracy : float
        Relative error of about 95 of 100 faces.
    bands : int
        Of the trial solution.
    errors, areas : (e,) float
        Relative errors by the globe alone, and areas.

    Returns
    -------
    int
    """
    order = np.argsort(errors)
    below = np.cumsum(areas[order]) / areas.sum()
    most = float(errors[order][np.searchsorted(below, 0.95)])
    wanted = bands * np.sqrt(most / (_SHARE_OF_GLOBE * accuracy))
    return int(np.clip(2 * np.ceil(wanted / 2), FEWEST_BANDS, MOST_BANDS))
