"""The legend in the 3D viewport: the colour bar with its values, crisp at every resolution, readable on every theme."""

from __future__ import annotations

import bpy
import gpu
import numpy as np
from bpy.app.translations import pgettext_iface as iface_
from gpu_extras.batch import batch_for_shader

from . import colours, display, drawing
from .choices import QUANTITY_ITEMS
from .translations import CONTEXT

_STEPS = 64
_MARGIN, _WIDTH, _HEIGHT = 24, 18, 220  # pixels at a resolution scale of 1

_APART = 0.075
"""Least distance of an end's value from a tick's, over the length of the bar."""

_handles: list[object] = []


def register() -> None:
    """Begin to draw; without a window there is nothing to draw on."""
    drawing.begin(_handles, (_draw, "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing."""
    drawing.end(_handles)


def label(value: float) -> str:
    """Return a value as a legend writes it: grouped thousands, no more digits than it needs."""
    return f"{value:,.0f}".replace(",", " ") if value >= 10 else f"{value:.3g}"


def entries(scale: colours.ColourScale) -> list[tuple[float, str]]:
    """Return position (0 to 1) and text of each tick of a scale, and of its ends where no tick is near."""
    found = dict(zip(scale.position(scale.ticks()).tolist(), map(label, scale.ticks()), strict=True))
    for end, value in ((0.0, scale.low), (1.0, scale.high)):
        if min(abs(end - position) for position in found) > _APART:
            found[end] = label(value)
    return sorted(found.items())


def title(scene: bpy.types.Scene) -> str:
    """Return the legend's heading: the quantity shown and its unit."""
    settings = scene.luzespecular.display
    name = next(name for key, name, _ in QUANTITY_ITEMS if key == settings.quantity)
    what = iface_("Illuminance") if settings.unit == "LUX" else display.factor_name(scene)
    return f"{what}: {iface_(name, CONTEXT)} [{display.unit_symbol(scene)}]"


def _draw() -> None:
    scene, space = bpy.context.scene, bpy.context.space_data
    settings = scene.luzespecular.display
    if not (settings.show_legend and space.overlay.show_overlays and display.has_results(scene)):
        return
    size = drawing.size()
    drawing.begin_texts()
    scale = display.current_scale(scene)
    lines = [title(scene), *scene.luzespecular.results.title.split("\n")]
    ticks, missing = entries(scale), iface_("not computed")
    margin, width, height, padding = (pixels * size for pixels in (_MARGIN, _WIDTH, _HEIGHT, drawing.PADDING))
    line = drawing.LINE * size
    beside = width + padding + drawing.width_of([missing, *(text for _, text in ticks)])
    panel_width = max(drawing.width_of(lines), beside) + 2 * padding
    panel_height = height + (len(lines) + 2) * line + 2 * padding
    left, bottom = round(_left_edge() + margin), round(_lower_edge() + margin)
    gpu.state.blend_set("ALPHA")
    drawing.rectangle(left, bottom, panel_width, panel_height, drawing.PANEL_COLOUR)
    bar_left, bar_bottom = round(left + padding), round(bottom + padding + 1.5 * line)
    _bar(scale.name, bar_left, bar_bottom, round(width), round(height))
    _hatch(bar_left, round(bottom + padding), round(width), round(0.8 * line))
    drawing.text(missing, bar_left + width + padding, bottom + padding + 0.2 * line)
    for position, text in ticks:
        y = bar_bottom + position * height
        drawing.rectangle(bar_left + width, y - 0.5 * size, 0.4 * padding, size, drawing.TEXT_COLOUR)
        drawing.text(text, bar_left + width + padding, y - 0.35 * drawing.TEXT * size)
    for row, text in enumerate(reversed(lines)):
        drawing.text(text, bar_left, bar_bottom + height + (row + 0.8) * line)
    gpu.state.blend_set("NONE")


def _left_edge() -> float:
    """Return where the viewport is free, beside the toolbar where that overlaps the view."""
    tools = drawing.region("TOOLS")
    return tools.width if tools is not None and bpy.context.preferences.system.use_region_overlap else 0


def _lower_edge() -> float:
    """Return where the viewport is free, above the panel of the last operation where that is shown."""
    panel = drawing.region("HUD")
    return panel.y + panel.height - bpy.context.region.y if panel is not None and panel.width > 1 else 0


def _bar(scale_name: str, left: float, bottom: float, width: float, height: float) -> None:
    steps = np.linspace(0.0, 1.0, _STEPS)
    rgba = np.column_stack([colours.scale_colours(scale_name, steps), np.ones(_STEPS)])
    heights = bottom + steps * height
    corners = [(x, y) for y in heights for x in (left, left + width)]
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch = batch_for_shader(shader, "TRI_STRIP", {"pos": corners, "color": np.repeat(rgba, 2, axis=0).tolist()})
    batch.draw(shader)


def _hatch(left: float, bottom: float, width: float, height: float) -> None:
    dark, light = ((*grey, 1.0) for grey in colours.NOT_COMPUTED_SRGB)
    corners = ((left, bottom), (left + width, bottom), (left, bottom + height), (left + width, bottom + height))
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch_for_shader(shader, "TRI_STRIP", {"pos": corners, "color": (dark, light, light, dark)}).draw(shader)
