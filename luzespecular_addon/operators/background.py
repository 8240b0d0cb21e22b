"""Operators whose work runs in a thread of its own while the window lives on; without a window they wait for it."""

from __future__ import annotations

from contextlib import ExitStack

import bpy

from ..job import Task
from . import loose_ends
from .reports import redraw_sidebars

_TICK = 0.05  # seconds between looks at the thread


class InBackground:
    """An operator whose `prepare` returns a task, or None where there is none, and whose `conclude` ends it."""

    _task: Task | None = None
    _ends: ExitStack | None = None

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
        """Work in the background, so that the window stays alive."""
        if bpy.app.background:
            return self.execute(context)
        self._task = self.prepare(context)
        if self._task is None:
            return {"CANCELLED"}
        state = context.window_manager.luzespecular
        state.running, state.cancel, state.fraction, state.stage, state.seconds_left = True, False, 0.0, "", -1.0
        state.live_remark = ""
        manager = context.window_manager
        timer = manager.event_timer_add(_TICK, window=context.window)
        manager.modal_handler_add(self)
        self._ends = loose_ends.new()
        self._ends.callback(_stopped)
        self._ends.callback(manager.event_timer_remove, timer)
        self._ends.callback(self._task.cancel)
        self._task.start()
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Follow the work; Esc cancels."""
        state = context.window_manager.luzespecular
        escape = event.type == "ESC" and event.value == "PRESS"
        if state.cancel or escape:
            self._task.cancel()
        if escape:
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            self.show_progress(context, self._task)
        except Exception:
            self._tidy(context)  # else all buttons would stay grey
            raise
        if not self._task.finished or self.must_wait(context):
            return {"PASS_THROUGH"}
        self._tidy(context)
        return self.conclude(context, self._task)

    def must_wait(self, _context) -> bool:
        """Whether what is done cannot be brought to its end yet."""
        return False

    def execute(self, context):
        """Work at once, for scripts."""
        task = self.prepare(context)
        if task is None:
            return {"CANCELLED"}
        task.start()
        task.wait()
        return self.conclude(context, task)

    def cancel(self, context):
        """Stop when Blender itself ends the operator (a file is loaded, a window closed)."""
        self._task.cancel()
        self._task.wait()
        self._tidy(context)

    def _tidy(self, context) -> None:
        self._ends.close()
        redraw_sidebars(context)


def _stopped() -> None:
    bpy.context.window_manager.luzespecular.running = False
    loose_ends.clear_status()
