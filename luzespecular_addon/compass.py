"""A compass in the 3D viewport: where north is and where the Sun stands, as the view is turned."""

from __future__ import annotations

import math

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import NDArray

from . import display, drawing, light
from .notices import BadInput

TAB = "LuzEspecular"

_RADIUS, _MARGIN = 42, 70  # pixels at a resolution scale of 1
_SUN = 5
_LINE, _DIM, _DARK = (0.95, 0.95, 0.95, 0.95), (0.95, 0.95, 0.95, 0.45), (0.0, 0.0, 0.0, 0.5)
_UP, _DOWN = (1.0, 0.82, 0.25, 1.0), (0.55, 0.55, 0.6, 1.0)
_CIRCLE = np.linspace(0.0, 2.0 * math.pi, 49)

_handles: list[object] = []


def register() -> None:
    """Begin to draw; without a window there is nothing to draw on."""
    drawing.begin(_handles, (_draw, "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing."""
    drawing.end(_handles)


def towards(azimuth: float, altitude: float = 0.0) -> NDArray[np.float64]:
    """Return the unit vector to an azimuth, clockwise from the scene's +Y axis, and an altitude [degrees]."""
    around, high = math.radians(azimuth), math.radians(altitude)
    return np.array([math.cos(high) * math.sin(around), math.cos(high) * math.cos(around), math.sin(high)])


def _draw() -> None:
    scene = bpy.context.scene
    if not _is_wanted(scene):
        return
    size = drawing.size()
    radius = _RADIUS * size
    turn = np.array(bpy.context.region_data.view_matrix)[:2, :3]
    middle = np.array([_right_edge() - _MARGIN * size, _MARGIN * size])

    def at(direction: NDArray, share: float = 1.0) -> NDArray[np.float64]:
        return middle + share * radius * (direction @ turn.T)

    site = scene.luzespecular.site
    around = [towards(site.north_offset + quarter) for quarter in (0.0, 90.0, 180.0, 270.0)]
    horizon = at(np.column_stack([np.sin(_CIRCLE), np.cos(_CIRCLE), np.zeros(len(_CIRCLE))]))
    horizon = np.stack([horizon[:-1], horizon[1:]], axis=1)
    marks = np.array([(at(direction, 0.85), at(direction)) for direction in around[1:]])
    needle = np.array([(middle, at(around[0]))])
    gpu.state.blend_set("ALPHA")
    for lines, colour in ((horizon, _DIM), (marks, _DIM), (needle, _LINE)):
        drawing.lines(lines, 3.0, _DARK)
        drawing.lines(lines, 1.4, colour)
    drawing.tag("N", *at(around[0], 1.28))
    _draw_sun(site, middle, at)
    gpu.state.blend_set("NONE")


def _draw_sun(site: bpy.types.PropertyGroup, middle: NDArray, at) -> None:
    """Draw the Sun, a ray from it, and how high it stands; grey where it is below the horizon."""
    try:
        place = light.sun_place(site)
    except BadInput:
        return  # Site & Time says what is wrong
    sun, foot = towards(place.scene_azimuth, place.altitude), towards(place.scene_azimuth)
    colour = _UP if place.is_up else _DOWN
    below = at(foot, math.cos(math.radians(place.altitude)))
    drawing.lines(np.array([(middle, below), (below, at(sun))]), 1.0, (*colour[:3], 0.6))
    drawing.lines(np.array([(middle, at(sun))]), 1.6, colour)
    for pixels, shade in ((_SUN + 1.5, _DARK), (_SUN, colour)):
        _disc(at(sun), pixels * drawing.size(), shade)


def _disc(middle: NDArray, radius: float, colour: tuple[float, ...]) -> None:
    edge = middle + radius * np.column_stack([np.cos(_CIRCLE), np.sin(_CIRCLE)])
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", colour)
    count = len(edge)
    corners = [tuple(map(float, place)) for place in (*edge, middle)]
    spokes = [(corner, corner + 1, count) for corner in range(count - 1)]
    batch_for_shader(shader, "TRIS", {"pos": corners}, indices=spokes).draw(shader)


def _is_wanted(scene: bpy.types.Scene) -> bool:
    """Whether it is switched on, and of use: with results, or while the sidebar shows our tab."""
    if not (scene.luzespecular.site.show_compass and bpy.context.space_data.overlay.show_overlays):
        return False
    sidebar = drawing.region("UI")
    shows_tab = sidebar is not None and sidebar.width > 1 and sidebar.active_panel_category == TAB
    return shows_tab or display.has_results(scene)


def _right_edge() -> float:
    """Return where the viewport is free, beside the sidebar where that overlaps the view."""
    sidebar = drawing.region("UI")
    overlaps = sidebar is not None and sidebar.width > 1 and bpy.context.preferences.system.use_region_overlap
    return bpy.context.region.width - (sidebar.width if overlaps else 0)
