"""Put the demo's pictures side by side on one sheet, with captions and the colour legend."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

PAPER, INK, QUIET = "#ffffff", "#1a1a1a", "#5f5f5f"
MARGIN, GAP, CAPTION, HEADING = 28, 10, 34, 40


@dataclass(frozen=True)
class Legend:
    """A colour scale as the sheet draws it.

    Attributes
    ----------
    low, high : float
        Ends of the scale [lx].
    logarithmic : bool
        Whether equal ratios, not equal differences, are equally far apart.
    ticks : sequence of float
        Values to write [lx].
    position : callable
        Values [lx] to places 0..1 along the scale.
    colours : callable
        Values [lx] to sRGB in 0..1, (n,) -> (n, 3).
    """

    low: float
    high: float
    logarithmic: bool
    ticks: Sequence[float]
    position: Callable[[np.ndarray], np.ndarray]
    colours: Callable[[np.ndarray], np.ndarray]

    def bar(self, length: int, thickness: int) -> Image.Image:
        """Return the scale as a horizontal bar."""
        span = (np.geomspace if self.logarithmic else np.linspace)(self.low, self.high, length)
        row = np.uint8(np.rint(255 * self.colours(span)))
        return Image.fromarray(np.repeat(row[None], thickness, axis=0))


@dataclass(frozen=True)
class Cell:
    """A picture and what is written under it."""

    picture: Path
    caption: str
    remark: str = ""


def compose(
    rows: Sequence[tuple[str, Sequence[Cell]]], legend: Legend, title: str, notes: Sequence[str], size: int = 300
):
    """Return the sheet: one row of cells per heading, and the legend below.

    Parameters
    ----------
    rows : sequence of (str, sequence of Cell)
        Heading and cells of each row.
    legend : Legend
        The colour scale that all pictures share.
    title : str
        Written at the top.
    notes : sequence of str
        Lines written at the bottom.
    size : int
        Width and height of a picture on the sheet [pixels].

    Returns
    -------
    PIL.Image.Image
    """
    columns = max(len(cells) for _, cells in rows)
    width = 2 * MARGIN + columns * size + (columns - 1) * GAP
    row_height = HEADING + size + CAPTION + GAP
    height = 2 * MARGIN + 44 + len(rows) * row_height + 90 + 22 * len(notes)
    sheet = Image.new("RGB", (width, height), PAPER)
    draw = ImageDraw.Draw(sheet)
    large, normal, small = (ImageFont.load_default(points) for points in (26, 18, 15))
    draw.text((MARGIN, MARGIN), title, INK, large)
    top = MARGIN + 44
    for heading, cells in rows:
        draw.text((MARGIN, top + 12), heading, INK, normal)
        for column, cell in enumerate(cells):
            left = MARGIN + column * (size + GAP)
            with Image.open(cell.picture) as picture:
                shown = Image.new("RGB", picture.size, PAPER)
                shown.paste(picture, mask=picture.getchannel("A") if picture.mode == "RGBA" else None)
                sheet.paste(shown.resize((size, size), Image.Resampling.LANCZOS), (left, top + HEADING))
            draw.text((left, top + HEADING + size + 6), cell.caption, INK, small)
            draw.text((left + size, top + HEADING + size + 6), cell.remark, QUIET, small, anchor="ra")
        top += row_height
    top += 14
    length = min(width - 2 * MARGIN, 900)
    sheet.paste(legend.bar(length, 22), (MARGIN, top))
    for tick in legend.ticks:
        x = MARGIN + float(legend.position(np.array([tick]))[0]) * (length - 1)
        draw.line((x, top + 22, x, top + 29), INK)
        draw.text((x, top + 32), f"{tick:,.0f}", INK, small, anchor="ma")
    draw.text((MARGIN + length + 40, top + 2), "lux", INK, normal)
    top += 66
    for line in notes:
        draw.text((MARGIN, top), line, QUIET, small)
        top += 22
    return sheet
