"""Solve in the background or at once, and cancel."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from ... import core as luz
from .. import live, session, study
from ..job import Job, seconds_left
from ..notices import BadInput
from ..translations import solver_message
from .reports import redraw, report_all, time_left

_TICK = 0.05  # seconds between looks at the solver


class LUZESPECULAR_OT_solve(bpy.types.Operator):
    """Calculate the daylight of the scene and show it in false colours."""

    bl_idname = "luzespecular.solve"
    bl_label = "Solve"
    bl_description = "Calculate the daylight of the scene and show it in false colours"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    _job: Job | None = None
    _timer: bpy.types.Timer | None = None

    @classmethod
    def poll(cls, context):
        """Grey while another run is on its way."""
        if context.window_manager.luzespecular.running:
            cls.poll_message_set("A calculation is running: wait for it, or cancel it")
            return False
        if context.mode.startswith("EDIT"):
            cls.poll_message_set("Leave Edit Mode first (Tab)")
            return False
        return True

    def invoke(self, context, _event):
        """Solve in the background, so that the window stays alive."""
        if bpy.app.background:
            return self.execute(context)
        planned = self._collect(context)
        if planned is None:
            return {"CANCELLED"}
        self._job = Job(planned, session.current)
        state = context.window_manager.luzespecular
        state.running, state.cancel, state.fraction, state.stage, state.seconds_left = True, False, 0.0, "", -1.0
        state.live_remark = ""
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        self._job.start()
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Follow the solver; Esc cancels."""
        state = context.window_manager.luzespecular
        escape = event.type == "ESC" and event.value == "PRESS"
        if state.cancel or escape:
            self._job.cancel()
        if escape:
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        self._show_progress(context)
        if not self._job.finished:
            return {"PASS_THROUGH"}
        self._tidy(context)
        return self._conclude(context, self._job)

    def execute(self, context):
        """Solve at once, for scripts."""
        planned = self._collect(context)
        if planned is None:
            return {"CANCELLED"}
        job = Job(planned, session.current)
        job.start()
        job.wait()
        return self._conclude(context, job)

    def cancel(self, context):
        """Stop when Blender itself ends the operator (a file is loaded, a window closed)."""
        self._job.cancel()
        self._job.wait()
        self._tidy(context)

    def _collect(self, context) -> study.Study | None:
        live.current.stop()
        try:
            return study.collect(context)
        except BadInput as error:
            report_all(self, error.notices)
            return None

    def _conclude(self, context, job: Job):
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
        except BadInput as error:
            report_all(self, error.notices)
            return {"CANCELLED"}
        live.current.arm(job.study)
        live.request(bpy.data.scenes[job.study.scene_name])  # the settings may have moved on meanwhile
        report_all(self, notices)
        count = len(job.result.illuminance)
        self.report({"INFO"}, rpt_("Solved: {title}; {count} faces").format(title=job.study.title, count=count))
        return {"FINISHED"}

    def _show_progress(self, context) -> None:
        state = context.window_manager.luzespecular
        latest = self._job.latest()
        if latest is None:
            return
        state.fraction, state.stage = latest
        left = seconds_left(self._job.elapsed, state.fraction)
        state.seconds_left = -1.0 if left is None else left
        text = iface_("LuzEspecular: {percent:.0f} % {stage} (Esc cancels)")
        text = text.format(percent=100.0 * state.fraction, stage=iface_(state.stage))
        if left is not None:
            text = f"{text}  {time_left(left)}"
        context.workspace.status_text_set(text)
        redraw(context)

    def _tidy(self, context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.luzespecular.running = False
        context.workspace.status_text_set(None)
        redraw(context)


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
