"""Solve, progress and cancel; live results."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import display, live
from ..operators.reports import time_left
from .drawing import Sidebar, draw_wrapped


class LUZESPECULAR_PT_solve(Sidebar, bpy.types.Panel):
    """Solve, progress and cancel."""

    bl_label = "Solve"
    bl_description = "Solve, progress and cancel"
    bl_idname = "LUZESPECULAR_PT_solve"

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        state = context.window_manager.luzespecular
        if state.running:
            _draw_progress(layout, state)
        else:
            row = layout.row()
            row.scale_y = 1.4
            row.operator("luzespecular.solve", icon="LIGHT_SUN")
        scene = context.scene
        layout.prop(scene.luzespecular, "live")
        if scene.luzespecular.live and display.has_results(scene):
            if state.live_remark:
                draw_wrapped(layout.column(align=True), state.live_remark, "ERROR", context.region.width)
            elif not live.current.follows(scene) and not state.running:
                draw_wrapped(
                    layout.column(align=True),
                    iface_("Solve once more to have results follow hour, date and sky"),
                    "INFO",
                    context.region.width,
                )
        if scene.animation_data is not None and scene.animation_data.action is not None:
            layout.prop(scene.render, "use_lock_interface")


def _draw_progress(layout: bpy.types.UILayout, state: bpy.types.PropertyGroup) -> None:
    row = layout.row(align=True)
    share = f"{100.0 * state.fraction:.0f} %  " if state.fraction else ""
    row.progress(factor=state.fraction, text=share + iface_(state.stage or "starting"))
    row.operator("luzespecular.cancel", text="", icon="CANCEL")
    if state.seconds_left < 0.0:
        layout.label(text="Cancel", icon="EVENT_ESC")
    else:
        layout.label(text=time_left(state.seconds_left), icon="TIME", translate=False)


CLASSES = (LUZESPECULAR_PT_solve,)
