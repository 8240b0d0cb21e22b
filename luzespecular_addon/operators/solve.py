"""Solve in the background or at once, and cancel."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from ... import core as luz
from .. import live, scene_check, session, study
from ..job import Job, seconds_left
from ..notices import BadInput
from ..translations import solver_message
from .background import InBackground
from .reports import redraw_sidebars, report_all, time_left


class LUZESPECULAR_OT_solve(InBackground, bpy.types.Operator):
    """Calculate the daylight of the scene and show it in false colours."""

    bl_idname = "luzespecular.solve"
    bl_label = "Solve"
    bl_description = "Calculate the daylight of the scene and show it in false colours"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def prepare(self, context) -> Job | None:
        """Read the scene and its light; what stands in the way is told."""
        live.current.stop()
        try:
            return Job(study.collect(context), session.current)
        except BadInput as error:
            scene_check.show(context.window_manager, scene_check.of_notices(error.notices))
            report_all(self, error.notices)
            return None

    def conclude(self, context, job: Job):
        """Write and show the results, or say why there are none."""
        if isinstance(job.error, luz.Cancelled):
            self.report({"INFO"}, rpt_("Cancelled; nothing was changed"))
            return {"CANCELLED"}
        if isinstance(job.error, luz.SceneError | MemoryError):
            self.report({"ERROR"}, solver_message(job.error))
            return {"CANCELLED"}
        if job.error is not None:
            raise job.error
        try:
            notices = study.finish(context, job.study, job.result, job.readings)
            scene_check.show(context.window_manager, study.found(job.study, job.result))
        except BadInput as error:
            report_all(self, error.notices)
            return {"CANCELLED"}
        live.current.arm(job.study)
        live.request(bpy.data.scenes[job.study.scene_name])  # the settings may have moved on meanwhile
        report_all(self, notices)
        count = len(job.result.illuminance)
        self.report({"INFO"}, rpt_("Solved: {title}; {count} faces").format(title=job.study.title, count=count))
        return {"FINISHED"}

    def must_wait(self, context) -> bool:
        """Results cannot be written in Edit Mode; they wait until the user leaves it."""
        state = context.window_manager.luzespecular
        waits = context.mode.startswith("EDIT") and not state.cancel and self._task.error is None
        if waits and state.seconds_left >= 0.0:
            state.seconds_left, state.stage = -1.0, iface_("Leave Edit Mode first (Tab)")
            redraw_sidebars(context)
        if waits:
            context.workspace.status_text_set(iface_("LuzEspecular: solved; leave Edit Mode (Tab) to see the results"))
        return waits

    def show_progress(self, context, job: Job) -> None:
        """Tell stage, share and time left."""
        state = context.window_manager.luzespecular
        latest = job.latest()
        if latest is None:
            return
        state.fraction, state.stage = latest
        left = seconds_left(job.elapsed, state.fraction)
        state.seconds_left = -1.0 if left is None else left
        text = iface_("LuzEspecular: {percent:.0f} % {stage} (Esc cancels)")
        text = text.format(percent=100.0 * state.fraction, stage=iface_(state.stage))
        if left is not None:
            text = f"{text}  {time_left(left)}"
        context.workspace.status_text_set(text)
        redraw_sidebars(context)


class LUZESPECULAR_OT_cancel(bpy.types.Operator):
    """Stop the calculation; nothing is changed."""

    bl_idname = "luzespecular.cancel"
    bl_label = "Cancel"
    bl_description = "Stop the calculation; nothing is changed"

    @classmethod
    def poll(cls, context):
        """Only while something runs."""
        if context.window_manager.luzespecular.running:
            return True
        cls.poll_message_set("No calculation is running")
        return False

    def execute(self, context):
        """Leave word for the running operator."""
        context.window_manager.luzespecular.cancel = True
        return {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_solve, LUZESPECULAR_OT_cancel)
