"""Rectangles, lines and texts on a 3D viewport, in pixels, sRGB; sizes are for a resolution scale of 1."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix
from numpy.typing import NDArray

FONT = 0
TEXT = 12
LINE = 1.5 * TEXT
PADDING = 10
PANEL_COLOUR = (0.06, 0.06, 0.06, 0.93)
TEXT_COLOUR = (0.95, 0.95, 0.95, 1.0)
"""The panel brings its own background, so that texts can be read on every theme."""


def begin(handles: list[object], *draws: tuple[Callable[[], None], str]) -> None:
    """Begin to draw on all 3D viewports, each at its moment; without a window there is nothing to draw on."""
    if not bpy.app.background:
        add = bpy.types.SpaceView3D.draw_handler_add
        handles += [add(draw, (), "WINDOW", moment) for draw, moment in draws]


def end(handles: list[object]) -> None:
    """Stop drawing."""
    while handles:
        bpy.types.SpaceView3D.draw_handler_remove(handles.pop(), "WINDOW")


def size() -> float:
    """Return the resolution scale: screen pixels, and the user's own setting, over a plain screen."""
    return bpy.context.preferences.system.ui_scale or 1.0


def region(kind: str) -> bpy.types.Region | None:
    """Return a region of the area that is drawn, such as its sidebar."""
    return next((one for one in bpy.context.area.regions if one.type == kind), None)


def begin_texts() -> None:
    """Choose the size of texts."""
    blf.size(FONT, TEXT * size())


def width_of(texts: Iterable[str]) -> float:
    """Return the width of the widest text [pixels]."""
    return max((blf.dimensions(FONT, text)[0] for text in texts), default=0.0)


def text(words: str, x: float, y: float, colour: tuple[float, ...] = TEXT_COLOUR) -> None:
    """Write a text from a point on its base line."""
    blf.color(FONT, *colour)
    blf.position(FONT, round(x), round(y), 0)
    blf.draw(FONT, words)


def rectangle(left: float, bottom: float, width: float, height: float, colour: tuple[float, ...]) -> None:
    """Fill a rectangle; its edges are put on whole pixels, so that they are sharp."""
    right, top = round(left + width), round(bottom + height)
    left, bottom = round(left), round(bottom)
    top, right = max(top, bottom + 1), max(right, left + 1)
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", colour)
    corners = ((left, bottom), (right, bottom), (right, top), (left, top))
    batch_for_shader(shader, "TRIS", {"pos": corners}, indices=((0, 1, 2), (0, 2, 3))).draw(shader)


def table_size(rows: list[tuple[str, str]], heading: str = "") -> tuple[float, float]:
    """Return width and height of `table` [pixels]."""
    begin_texts()
    names, values = width_of(name for name, _ in rows), width_of(value for _, value in rows)
    width = max(names + 2 * PADDING * size() + values, width_of([heading]))
    return width + 2 * PADDING * size(), ((len(rows) + bool(heading)) * LINE + 1.5 * PADDING) * size()


def table(rows: list[tuple[str, str]], left: float, bottom: float, heading: str = "") -> None:
    """Draw names on the left and values on the right on a panel of their own, first row at the top."""
    width, height = table_size(rows, heading)
    padding, line = PADDING * size(), LINE * size()
    gpu.state.blend_set("ALPHA")
    rectangle(left, bottom, width, height, (*PANEL_COLOUR[:3], 1.0))  # labels below it would disturb
    y = bottom + height - line
    if heading:
        text(heading, left + padding, y)
        y -= line
    for name, value in rows:
        text(name, left + padding, y, (0.75, 0.75, 0.75, 1.0))
        text(value, left + width - padding - width_of([value]), y)
        y -= line
    gpu.state.blend_set("NONE")


def tag(words: str, x: float, y: float) -> None:
    """Write a text on a small panel, centred on a point."""
    scale = size()
    begin_texts()
    width, height = width_of([words]) + 0.8 * PADDING * scale, 1.35 * TEXT * scale
    gpu.state.blend_set("ALPHA")
    rectangle(x - width / 2, y - height / 2, width, height, PANEL_COLOUR)
    text(words, x - width / 2 + 0.4 * PADDING * scale, y - 0.35 * TEXT * scale)
    gpu.state.blend_set("NONE")


@contextmanager
def in_pixels() -> Iterator[None]:
    """Draw in pixels of the region while the context lasts, where the view's matrices are in force."""
    region = bpy.context.region
    scale = Matrix.Diagonal((2.0 / region.width, 2.0 / region.height, 1.0, 1.0))
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_identity()
        gpu.matrix.load_projection_matrix(Matrix.Translation((-1.0, -1.0, 0.0)) @ scale)
        yield


def lines(ends: NDArray[np.float32], width: float, colour: tuple[float, ...]) -> None:
    """Draw separate lines, (k, 2, 3) or (k, 2, 2), where the view's matrices put them."""
    if not len(ends):
        return
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width * size())
    shader.uniform_float("color", colour)
    positions = np.ascontiguousarray(ends.reshape(-1, ends.shape[-1]), np.float32)
    if positions.shape[1] == 2:
        positions = np.column_stack([positions, np.zeros(len(positions), np.float32)])
    batch_for_shader(shader, "LINES", {"pos": positions}).draw(shader)
