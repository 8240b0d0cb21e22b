"""Check the scene without solving it, and select what was found."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from ... import core as luz
from .. import export, scene_check, writeback
from ..job import Task
from ..notices import BadInput, Notice, stop_on_errors
from .background import InBackground
from .reports import redraw_sidebars


class LUZESPECULAR_OT_check_scene(InBackground, bpy.types.Operator):
    """Look for what is wrong or odd in the scene, without solving it."""

    bl_idname = "luzespecular.check_scene"
    bl_label = "Check Scene"
    bl_description = (
        "Look for what is wrong or odd, without solving: inverted normals, gaps, overlaps, units, materials and more"
    )

    _exported: export.Export | None = None
    _notices: tuple[Notice, ...] = ()

    def prepare(self, context) -> Task:
        """Read the scene; where that fails, its errors are all that can be told."""
        try:
            stop_on_errors(writeback.refusals(context.scene.objects))
            exported = export.export_scene(context)
        except BadInput as error:
            self._exported, self._notices = None, error.notices
            return Task(tuple)
        self._exported, self._notices = exported, exported.notices
        return Task(lambda: luz.check(exported.scene))

    def show_progress(self, context, _task: Task) -> None:
        """Say what goes on; how far it is, is not known."""
        state = context.window_manager.luzespecular
        if not state.stage:
            state.stage = "scene check"
            context.workspace.status_text_set(iface_("LuzEspecular: checking the scene (Esc cancels)"))
            redraw_sidebars(context)

    def conclude(self, context, task: Task):
        """List what was found."""
        if task.error is not None:
            raise task.error
        if task.result is None:
            self.report({"INFO"}, rpt_("Cancelled; nothing was changed"))
            return {"CANCELLED"}
        found = scene_check.of_notices(self._notices)
        if self._exported is not None:
            found += scene_check.of_solver(self._exported, task.result)
        scene_check.show(context.window_manager, found)
        redraw_sidebars(context)
        errors, warnings = (sum(one.level == level for one in found) for level in ("ERROR", "WARNING"))
        text = rpt_("Scene checked: {errors} errors, {warnings} warnings")
        self.report({"WARNING"} if errors else {"INFO"}, text.format(errors=errors, warnings=warnings))
        return {"FINISHED"}


class LUZESPECULAR_OT_select_finding(bpy.types.Operator):
    """Select the objects and the faces that a finding is about."""

    bl_idname = "luzespecular.select_finding"
    bl_label = "Select"
    bl_description = (
        "Select the objects concerned; where single faces are meant, select them in Edit Mode (Numpad . shows them)"
    )
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    index: bpy.props.IntProperty(name="Finding", description="Its place in the list, from 0", options={"SKIP_SAVE"})

    def execute(self, context):
        """Select."""
        places = scene_check.places_of(context.window_manager, self.index)
        if not places:
            self.report({"ERROR"}, rpt_("It concerns the scene as a whole: there is nothing to select"))
            return {"CANCELLED"}
        missing = scene_check.select(context, places)
        for name in missing:
            self.report({"WARNING"}, rpt_("Object '{name}' cannot be selected: it is gone or hidden").format(name=name))
        return {"CANCELLED"} if len(missing) == len(places) else {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_check_scene, LUZESPECULAR_OT_select_finding)
