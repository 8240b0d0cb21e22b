"""Read lux under the mouse, and keep readings shown."""

from __future__ import annotations

from contextlib import ExitStack
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

from .. import display, drawing, probe
from . import loose_ends
from .polls import NeedsResults
from .reports import redraw

_OFFSET = 18


class LUZESPECULAR_OT_probe(NeedsResults, bpy.types.Operator):
    """Read the light under the mouse: total, components, error; click to keep a reading shown."""

    bl_idname = "luzespecular.probe"
    bl_label = "Probe"
    bl_description = "Read the light under the mouse: total, components, error. Click keeps a reading shown, Esc ends"

    _targets: list[probe.Target]
    _state: tuple
    _hit: probe.Hit | None
    _mouse: tuple[int, int]
    _region: bpy.types.Region | None
    _ends: ExitStack

    def invoke(self, context, event):
        """Begin to follow the mouse."""
        self._state, self._targets, self._hit, self._region = (), [], None, None
        self._mouse = (0, 0)
        handle = bpy.types.SpaceView3D.draw_handler_add(self._draw, (), "WINDOW", "POST_PIXEL")
        context.window.cursor_modal_set("CROSSHAIR")
        text = iface_("Probe: click keeps the reading shown; Esc or right click ends")
        context.workspace.status_text_set(text)
        self._ends = loose_ends.new()
        self._ends.callback(bpy.types.SpaceView3D.draw_handler_remove, handle, "WINDOW")
        self._ends.callback(_restore_cursors)
        self._ends.callback(loose_ends.clear_status)
        context.window_manager.modal_handler_add(self)
        self._look(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Read where the mouse is; views can be turned, and settings changed, meanwhile."""
        if not display.has_results(context.scene):
            return self._end(context)
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            return self._end(context)
        if event.type == "MOUSEMOVE":
            self._look(context, event)
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            self._look(context, event)
            if self._region is not None:
                if self._hit is not None:
                    probe.pin(context.scene, self._hit)
                    bpy.ops.ed.undo_push(message=iface_("Keep Reading"))
                    redraw(context)
                return {"RUNNING_MODAL"}
        return {"PASS_THROUGH"}

    def cancel(self, context):
        """Stop when Blender itself ends the operator."""
        self._end(context)

    def _end(self, context):
        self._ends.close()
        redraw(context)
        return {"FINISHED"}

    def _look(self, context, event) -> None:
        """Find the face under the mouse; none while the mouse is outside the views."""
        area, region = _view_under(context, event.mouse_x, event.mouse_y)
        self._region, self._hit = region, None
        if region is not None:
            state = probe.state(context)
            if state != self._state:
                self._state, self._targets = state, probe.targets(context)
            self._mouse = (event.mouse_x - region.x, event.mouse_y - region.y)
            view = area.spaces.active.region_3d
            origin = region_2d_to_origin_3d(region, view, self._mouse)
            along = region_2d_to_vector_3d(region, view, self._mouse)
            culls = area.spaces.active.shading.show_backface_culling
            self._hit = probe.pick(self._targets, origin, along, culls)
        redraw(context)

    def _draw(self) -> None:
        context = bpy.context
        if self._hit is None or context.region != self._region:
            return
        heading, rows = probe.rows(context, self._hit)
        size = drawing.size()
        width, height = drawing.table_size(rows, heading)
        x, y = self._mouse[0] + _OFFSET * size, self._mouse[1] - _OFFSET * size - height
        x = x if x + width < context.region.width else self._mouse[0] - _OFFSET * size - width
        drawing.table(rows, x, max(y, 0.0), heading)


class LUZESPECULAR_OT_clear_pins(bpy.types.Operator):
    """Take the kept readings away."""

    bl_idname = "luzespecular.clear_pins"
    bl_label = "Clear Readings"
    bl_description = "Take the kept readings away"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        """Grey without readings."""
        if len(context.scene.luzespecular.results.pins):
            return True
        cls.poll_message_set("No reading is kept: click while probing")
        return False

    def execute(self, context):
        """Clear."""
        context.scene.luzespecular.results.pins.clear()
        redraw(context)
        return {"FINISHED"}


def _restore_cursors() -> None:
    for window in bpy.context.window_manager.windows:
        window.cursor_modal_restore()


def _view_under(context, x: int, y: int) -> tuple[bpy.types.Area, bpy.types.Region] | tuple[None, None]:
    """Return the 3D view under a point of the window, where no toolbar, sidebar or header lies over it."""
    for area in context.window.screen.areas:
        if area.type != "VIEW_3D" or not _holds(area, x, y):
            continue
        over = [region for region in area.regions if region.type != "WINDOW" and min(region.width, region.height) > 1]
        views = [region for region in area.regions if region.type == "WINDOW" and _holds(region, x, y)]
        if views and not any(_holds(region, x, y) for region in over):
            return area, views[0]
    return None, None


def _holds(box, x: int, y: int) -> bool:
    return box.x <= x < box.x + box.width and box.y <= y < box.y + box.height


CLASSES = (LUZESPECULAR_OT_probe, LUZESPECULAR_OT_clear_pins)
