"""False colours: lux to colour by a named scale, linear or logarithmic, and the ticks of its legend. Pure NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

# sRGB anchors, evenly spaced. Viridis, Cividis and Inferno are the matplotlib scales (CC0), perceptually uniform;
# the first two can be read by the colour-blind. "Spectrum" is the blue-to-red scale that lighting programs made common.
_ANCHORS = {
    "VIRIDIS": "440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b"
    " addc30 d8e219 fde725",
    "CIVIDIS": "00224e 002e6a 1a386f 32436d 434e6c 535a6d 61656f 6f7073 7d7c78 8c8878 9b9476 aba072 bcae6c cdbb63"
    " dec958 f0d846 fee838",
    "INFERNO": "000004 0b0724 210c4a 3d0965 57106e 71196e 8a226a a32c61 bc3754 d24644 e45a31 f1731d f98e09 fcac11"
    " f9cb35 f2ea69 fcffa4",
    "SPECTRUM": "0000a8 0038ff 00a0ff 00e0d0 00d060 70d800 e8e800 ffb000 ff6000 e80000 a00020",
    "GREY": "101010 f4f4f4",
}

# Faces without a value alternate these two greys from corner to corner: a gradient that no scale can produce,
# since a face with a value has one flat colour.
NOT_COMPUTED_SRGB = ((0.30, 0.30, 0.30), (0.62, 0.62, 0.62))

_TABLE = 4096  # colours of a scale that faces are given; far more than the eye tells apart

_ROUNDING = 1e-6  # ends of scales have been through float32

LOWEST_SHARE = 1e-3
"""Smallest value that an automatic logarithmic range shows, as a share of its largest."""


@dataclass(frozen=True)
class ColourScale:
    """A false-colour scale between two values.

    Attributes
    ----------
    name : str
        A key of `names()`.
    low, high : float
        Values at the two ends [lx]; what lies outside takes the end's colour.
    logarithmic : bool
        Whether equal ratios, not equal differences, are equally far apart; `low` is then above 0.
    """

    name: str
    low: float
    high: float
    logarithmic: bool

    def position(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return where values stand on the scale, 0 at `low` to 1 at `high`; NaN stays NaN."""
        values = np.asarray(values, float)
        if self.logarithmic:
            low, high = np.log(self.low), np.log(self.high)
            values = np.log(np.where(np.isnan(values), np.nan, np.maximum(values, self.low)))
        else:
            low, high = self.low, self.high
        return np.clip((values - low) / (high - low), 0.0, 1.0)

    def srgb(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return display colours, (..., 3) in 0..1, sRGB encoded; NaN for NaN."""
        return scale_colours(self.name, self.position(values))

    def ticks(self, most: int = 7) -> NDArray[np.float64]:
        """Return round values (1, 2 or 5 times a power of ten) for a legend, ends not forced."""
        return _log_ticks(self.low, self.high, most) if self.logarithmic else _linear_ticks(self.low, self.high, most)


def names() -> tuple[str, ...]:
    """Return the names of the scales, the default first."""
    return tuple(_ANCHORS)


def scale_colours(name: str, position: ArrayLike) -> NDArray[np.float64]:
    """Return the sRGB colour, (..., 3) in 0..1, at positions 0..1 of a scale."""
    hexadecimal = _ANCHORS[name].split()
    anchors = np.array([[int(code[i : i + 2], 16) for i in (0, 2, 4)] for code in hexadecimal]) / 255.0
    position = np.asarray(position, float)
    grid = np.linspace(0.0, 1.0, len(anchors))
    return np.stack([np.interp(position, grid, anchors[:, channel]) for channel in range(3)], axis=-1)


def srgb_to_linear(srgb: ArrayLike) -> NDArray[np.float64]:
    """Decode sRGB (IEC 61966-2-1) to scene-linear; Blender's colour attributes are scene-linear."""
    srgb = np.asarray(srgb, float)
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def relative_luminance(linear_rgb: ArrayLike) -> NDArray[np.float64]:
    """Return the luminous weight of linear Rec. 709 colours, (..., 3) -> (...) (ITU-R BT.709-6, item 3.2)."""
    return np.asarray(linear_rgb, float)[..., :3] @ np.array([0.2126, 0.7152, 0.0722])


def corner_colours(values: ArrayLike, corners: ArrayLike, scale: ColourScale) -> NDArray[np.float32]:
    """Return scene-linear RGBA per face corner, (sum of corners, 4).

    Parameters
    ----------
    values : (n,) float
        One value per face; NaN where it was not computed.
    corners : int or (n,) int
        Number of corners of each face.
    scale : ColourScale
        The scale to colour by.
    """
    values = np.asarray(values, float)
    table = _linear_table(scale.name)
    place = np.rint(np.nan_to_num(scale.position(values)) * (_TABLE - 1)).astype(np.int64)
    missing = np.repeat(np.isnan(values), corners)
    colours = np.repeat(table[place], corners, axis=0)
    if missing.any():
        hatch = srgb_to_linear(NOT_COMPUTED_SRGB).astype(np.float32)
        colours[missing, :3] = hatch[np.flatnonzero(missing) % 2]
    return colours


@lru_cache
def _linear_table(name: str) -> NDArray[np.float32]:
    """Scene-linear RGBA of a scale from end to end, (_TABLE, 4)."""
    table = np.ones((_TABLE, 4), np.float32)
    table[:, :3] = srgb_to_linear(scale_colours(name, np.linspace(0.0, 1.0, _TABLE)))
    return table


def automatic_range(values: ArrayLike, weights: ArrayLike, logarithmic: bool) -> tuple[float, float]:
    """Choose the ends of a scale for a set of values.

    Logarithmic: the whole span, but no more than three decades below the largest. Linear: 0 to the value that 98 % of
    the area lies below, so that a small sun patch does not turn all the rest to one colour. Both are rounded outwards
    to 1, 2 or 5 times a power of ten.

    Parameters
    ----------
    values : (n,) float
        Values [lx]; NaN is passed over.
    weights : (n,) float
        Area of each.
    logarithmic : bool
        Which of the two.

    Returns
    -------
    low, high : float
    """
    values, weights = np.asarray(values, float), np.asarray(weights, float)
    usable = np.isfinite(values) & (weights > 0) & (values > 0)
    if not usable.any():
        return (1.0, 10.0) if logarithmic else (0.0, 1.0)
    values, weights = values[usable], weights[usable]
    if not logarithmic:
        return 0.0, _round_up(_quantile(values, weights, 0.98))
    high = _round_up(values.max())
    low = _round_down(max(_quantile(values, weights, 0.01), high * LOWEST_SHARE))
    return (low, high) if low < high else (high / 10.0, high)


def _quantile(values: NDArray, weights: NDArray, share: float) -> float:
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(below, share * below[-1]).clip(max=len(values) - 1)])


def _round_up(value: float) -> float:
    decade = 10.0 ** np.floor(np.log10(value))
    return float(next(step * decade for step in (1, 2, 5, 10) if step * decade >= value * (1 - 1e-9)))


def _round_down(value: float) -> float:
    decade = 10.0 ** np.floor(np.log10(value))
    return float(next(step * decade for step in (5, 2, 1, 0.5) if step * decade <= value * (1 + 1e-9)))


def _log_ticks(low: float, high: float, most: int) -> NDArray[np.float64]:
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    for steps in ((1, 2, 5), (1, 5), (1,)):
        ticks = np.outer(decades, steps).ravel()
        ticks = ticks[(ticks >= low * (1 - _ROUNDING)) & (ticks <= high * (1 + _ROUNDING))]
        if len(ticks) <= most:
            break
    return ticks if len(ticks) >= 2 else np.array([low, high])


def _linear_ticks(low: float, high: float, most: int) -> NDArray[np.float64]:
    step = _round_up((high - low) / most)
    first, last = round(np.ceil(low / step - _ROUNDING)), round(np.floor(high / step + _ROUNDING))
    return step * np.arange(first, last + 1)
