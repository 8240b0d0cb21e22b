"""Live results: with the transfer ready, another hour, date or sky is solved and shown while one drags.

Requests come in faster than they can be answered: the newest counts, one at a time is solved in a thread of its own,
and Blender's timer writes what is done. While one drags, reflections are followed roughly and work planes left alone;
once the settings rest, all is brought to its end, unless they move again before. Frames to be rendered are solved to
the end before they are drawn.
"""

from __future__ import annotations

import logging
import time
from dataclasses import replace

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import core as luz
from . import display, session, study
from .job import Job
from .notices import BadInput
from .translations import solver_message

_log = logging.getLogger(__name__)

_TICK = 0.01  # seconds between looks at a job on its way
_REST = 0.4  # seconds without a change, and since a quick result is seen, after which it is settled
_AT_ONCE = 0.15  # a solution that took no longer may hold up playback
_CHEAP = 0.01  # a look at the scene that took no longer is taken again for each frame that is played
_MOMENT = 0.08  # a solution that took no longer is waited for while a setting changes: nothing is drawn twice then
_QUICK_TOLERANCE = 0.02


class Live:
    """Follows the light of one solved scene; used by the main thread, in a render by the render's.

    Attributes
    ----------
    rendering : bool
        Whether frames are being rendered.
    """

    def __init__(self):
        self.rendering = False
        self._study: study.Study | None = None
        self._job: Job | None = None
        self._quick = False
        self._wanted = False
        self._moved_at = 0.0
        self._verified_at = 0.0
        self._seconds = 0.0
        self._verifying = 0.0

    def arm(self, planned: study.Study) -> None:
        """Begin to follow: a study that was just solved and shown."""
        self.stop()
        self._study, self._quick, self._verified_at = planned, False, time.monotonic()

    def disarm(self) -> None:
        """Follow no longer."""
        self.stop()
        self._study = None

    def stop(self) -> None:
        """Leave off what is on its way."""
        self._wanted = False
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def follows(self, scene: bpy.types.Scene) -> bool:
        """Whether a scene's results are live."""
        return (
            self._study is not None
            and scene.name == self._study.scene_name
            and scene.luzespecular.live
            and session.current.get(self._study.key) is not None
            and display.has_results(scene)
        )

    @property
    def scene(self) -> bpy.types.Scene | None:
        """The scene that is followed."""
        return None if self._study is None else bpy.data.scenes.get(self._study.scene_name)

    def want(self) -> None:
        """Note that the settings changed."""
        self._wanted, self._moved_at = True, time.monotonic()

    def begin_at_once(self) -> None:
        """Begin what is wanted, where nothing is on its way; if it can be expected in a moment, bring it to its end.

        Called while the user's hand changes a setting, before all is drawn with it.
        """
        if self._job is None and self.advance() and self._job is not None and self._seconds < _MOMENT:
            self._job.wait(_MOMENT)
            if self._job.finished:
                self.advance()

    def advance(self) -> bool:
        """Do the next thing that is to be done; tell whether there is more to come."""
        scene = self.scene
        if scene is None or not self.follows(scene):
            self.stop()
            return False
        if self._job is not None:
            if not self._job.finished:
                if self._wanted and not self._quick:
                    self._job.cancel()  # the hand moves again: to settle has time
                return True
            # While one drags, a look now and then has to do: hidden objects are shown for it, and all is drawn anew.
            self._conclude(scene, looks=not self._quick or self._is_due)
            if self._study is None:
                return False
        try:
            return self._begin(scene)
        except BadInput as error:
            self._wanted = self._quick = False
            _tell(str(error))
            return False

    def frame(self, scene: bpy.types.Scene, evaluated: bpy.types.Scene) -> None:
        """Solve and show the light of a frame at once; in playback leave it for later where that would take long."""
        if not self.follows(scene):
            return
        whole = self.rendering or bpy.app.background
        if not whole and self._seconds > _AT_ONCE:
            request(scene)
            return
        try:
            planned = study.relit(self._study, evaluated)
        except BadInput as error:
            _tell(str(error))
            return
        exported = self._study.export
        remark = ""
        if exported.moving and scene.frame_current != exported.frame:
            if not self.rendering and not self._verify():
                return
            if self.rendering:  # one cannot look then
                text = iface_("Keyframes move or change {names}: the results are those of frame {frame}")
                remark = text.format(names=", ".join(exported.moving), frame=exported.frame)
        if planned.daylight == self._study.daylight and not (self._quick and whole):
            _tell(remark)
            return
        self.stop()
        self._start(planned, quick=not whole)
        self._job.wait()
        self._conclude(scene, looks=not (self.rendering or self._is_dear))  # while rendering one cannot look
        if remark:
            _tell(remark)
        if self._quick:
            request(scene)

    def _begin(self, scene: bpy.types.Scene) -> bool:
        now = time.monotonic()
        settle = self._quick and not self._wanted and now - self._moved_at > _REST
        if not (self._wanted or settle):
            return self._quick
        if bpy.context.mode.startswith("EDIT"):  # attributes cannot be written there
            self._wanted = self._quick = False
            _tell(iface_("Leave Edit Mode first (Tab)"))
            return False
        if (settle or self._is_due) and not self._verify():
            return False
        planned = study.relit(self._study, scene)
        wanted, self._wanted = self._wanted, False
        if settle or (wanted and planned.daylight != self._study.daylight):
            self._start(planned, quick=not settle)
            return True
        _tell("")
        return self._quick

    @property
    def _is_due(self) -> bool:
        """Whether it is time to look again if the scene stands as it did."""
        return time.monotonic() - self._verified_at > 2.0 * _REST

    @property
    def _is_dear(self) -> bool:
        """Whether a look at the scene would take longer than frames that are played have time for."""
        return self._verifying > _CHEAP and self._seconds < _AT_ONCE

    def _verify(self) -> bool:
        begun = time.monotonic()
        current_still = study.is_current(bpy.context, self._study)
        self._verified_at = time.monotonic()
        self._verifying = self._verified_at - begun
        if current_still:
            return True
        self.disarm()
        _tell(iface_("The scene changed since it was solved: solve again"))
        return False

    def _start(self, planned: study.Study, quick: bool) -> None:
        solved = planned
        if quick:
            tolerance = max(_QUICK_TOLERANCE, planned.solving.get("tolerance", 0.0))
            solved = replace(planned, grids=(), solving={**planned.solving, "tolerance": tolerance, "quick": True})
        self._quick = quick
        self._job = Job(solved, session.current)
        self._job.start()

    def _conclude(self, scene: bpy.types.Scene, looks: bool) -> None:
        job, self._job = self._job, None
        if isinstance(job.error, luz.Cancelled):
            self._quick = True  # what is shown has still to be settled
        elif isinstance(job.error, luz.LuzEspecularError | MemoryError):
            _tell(solver_message(job.error))
            self._quick = False
        elif job.error is not None:
            self.disarm()
            raise job.error
        elif not looks or self._verify():
            self._seconds = job.lasted
            self._study = replace(job.study, solving=self._study.solving)
            study.show(scene, job.study, job.result, None if self._quick else job.readings)
            self._moved_at = time.monotonic()  # who drags by what is seen needs a moment
            _tell("")


current = Live()
"""What this Blender follows; let go of when another file is loaded."""


def request(scene: bpy.types.Scene, at_once: bool = False) -> None:
    """Ask for results that fit a scene's settings as they are now; nothing happens where they are not live.

    With ``at_once`` they are begun here and now, not at the timer's next turn.
    """
    if bpy.app.background or not current.follows(scene):
        return
    current.want()
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_TICK)
    if at_once and not bpy.context.window_manager.luzespecular.running:
        current.begin_at_once()


def _tick() -> float | None:
    if bpy.context.window_manager.luzespecular.running:
        current.stop()
        return None
    return _TICK if current.advance() else None


def stop() -> None:
    """Leave off, timer and all."""
    current.disarm()
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)


def _tell(text: str) -> None:
    """Show a remark in the panel; in a render, where nobody looks at panels, log it."""
    state = bpy.data.window_managers[0].luzespecular
    if state.live_remark != text:
        state.live_remark = text
        if text and (current.rendering or bpy.app.background):
            _log.warning(text)
