"""The buttons: solve, cancel, clear, copy a shader's values, save the table."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_
from bpy_extras.io_utils import ExportHelper

from .. import core as luz
from ..core import files, tables
from . import display, materials, session, study
from .job import Job
from .notices import BadInput
from .translations import solver_message

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
        state.running, state.cancel, state.fraction, state.stage = True, False, 0.0, ""
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
        try:
            return study.collect(context)
        except BadInput as error:
            _report_all(self, error.notices)
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
            notices = study.finish(context, job.study, job.result)
        except BadInput as error:
            _report_all(self, error.notices)
            return {"CANCELLED"}
        _report_all(self, notices)
        count = len(job.result.illuminance)
        self.report({"INFO"}, rpt_("Solved: {title}; {count} faces").format(title=job.study.title, count=count))
        return {"FINISHED"}

    def _show_progress(self, context) -> None:
        state = context.window_manager.luzespecular
        latest = self._job.latest()
        if latest is None:
            return
        state.fraction, state.stage = latest
        text = iface_("LuzEspecular: {percent:.0f} % {stage} (Esc cancels)")
        context.workspace.status_text_set(text.format(percent=100.0 * state.fraction, stage=iface_(state.stage)))
        _redraw(context)

    def _tidy(self, context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.luzespecular.running = False
        context.workspace.status_text_set(None)
        _redraw(context)


class LUZESPECULAR_OT_cancel(bpy.types.Operator):
    """Stop the calculation; nothing is changed."""

    bl_idname = "luzespecular.cancel"
    bl_label = "Cancel"
    bl_description = "Stop the calculation; nothing is changed"

    @classmethod
    def poll(cls, context):
        """Only while something runs."""
        return context.window_manager.luzespecular.running

    def execute(self, context):
        """Leave word for the running operator."""
        context.window_manager.luzespecular.cancel = True
        return {"FINISHED"}


class LUZESPECULAR_OT_clear_results(bpy.types.Operator):
    """Remove all results from the scene: attributes, colours, the fine faces and the tables."""

    bl_idname = "luzespecular.clear_results"
    bl_label = "Clear Results"
    bl_description = "Remove all results from the scene: attributes, colours, the fine faces and the tables"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        """Grey without results."""
        if display.has_results(context.scene):
            return True
        cls.poll_message_set("There are no results yet: solve first")
        return False

    def execute(self, context):
        """Clear."""
        display.clear(context.scene)
        return {"FINISHED"}


class LUZESPECULAR_OT_values_from_shader(bpy.types.Operator):
    """Copy the values that the shader stands for, to change them by hand."""

    bl_idname = "luzespecular.values_from_shader"
    bl_label = "Copy from Shader"
    bl_description = "Copy the values that the shader stands for, to change them by hand"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        """Need a material."""
        return getattr(context, "material", None) is not None

    def execute(self, context):
        """Copy."""
        optics, settings = materials.from_shader(context.material), context.material.luzespecular
        settings.source = "CUSTOM"
        settings.diffuse_reflectance = optics.diffuse_reflectance
        settings.specular_reflectance = optics.specular_reflectance
        settings.regular_transmittance = optics.regular_transmittance
        settings.exitance = optics.exitance
        settings.use_refractive_index = optics.refractive_index is not None
        if optics.refractive_index is not None:
            settings.refractive_index = optics.refractive_index
        return {"FINISHED"}


class LUZESPECULAR_OT_save_table(bpy.types.Operator, ExportHelper):
    """Save the table of surfaces as a CSV file."""

    bl_idname = "luzespecular.save_table"
    bl_label = "Save Table"
    bl_description = "Save the table of surfaces as a CSV file"

    filename_ext = ".csv"
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        """Grey without results."""
        if len(context.scene.luzespecular.results.rows):
            return True
        cls.poll_message_set("There are no results yet: solve first")
        return False

    def execute(self, context):
        """Write the file."""
        rows = (
            tables.surface_row(
                tables.SurfaceStatistics(row.name, row.side, row.area, row.minimum, row.mean, row.maximum)
            )
            for row in context.scene.luzespecular.results.rows
        )
        try:
            files.write_csv(Path(self.filepath), tables.SURFACE_HEADER, rows)
        except OSError as error:
            self.report({"ERROR"}, rpt_("The table could not be saved: {error}").format(error=error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _report_all(operator: bpy.types.Operator, notices) -> None:
    for notice in notices:
        operator.report({notice.level}, notice.text)


def _redraw(context: bpy.types.Context) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


_CLASSES = (
    LUZESPECULAR_OT_solve,
    LUZESPECULAR_OT_cancel,
    LUZESPECULAR_OT_clear_results,
    LUZESPECULAR_OT_values_from_shader,
    LUZESPECULAR_OT_save_table,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
