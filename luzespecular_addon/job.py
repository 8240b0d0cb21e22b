"""What runs in a thread of its own, a study above all. No bpy: the thread may run while Blender draws."""

from __future__ import annotations

import math
import queue
import threading
import time
from collections.abc import Callable

from .. import core as luz
from .session import Session
from .study import Study
from .work_planes import Reading


class Task:
    """A function on its way in a thread of its own; knows nothing of Blender.

    Attributes
    ----------
    result : object
        What the function returned; None until then.
    error : Exception or None
        Why there is no result.
    lasted : float
        Seconds that the function took; infinite until it has ended.
    """

    def __init__(self, work: Callable[[], object]):
        self.result: object = None
        self.error: Exception | None = None
        self.lasted = math.inf
        self._work = work
        self._cancelled = threading.Event()
        self._thread = threading.Thread(target=self._run, name="LuzEspecular", daemon=True)
        self._started = 0.0

    def start(self) -> None:
        """Begin."""
        self._started = time.monotonic()
        self._thread.start()

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self._started

    def cancel(self) -> None:
        """Wait for it no longer: what it returns is not asked for."""
        self._cancelled.set()

    @property
    def finished(self) -> bool:
        """Whether there is a result or an error, or nobody waits for them."""
        return self._cancelled.is_set() or not self._thread.is_alive()

    def wait(self, timeout: float | None = None) -> None:
        """Block until it has stopped, or some seconds are over."""
        self._thread.join(timeout)

    def latest(self, timeout: float = 0.0) -> tuple[float, str] | None:
        """Return the last progress told since the last look, waiting up to `timeout` seconds; None without news."""
        return None

    def _run(self) -> None:
        try:
            self.result = self._work()
        except Exception as error:  # noqa: BLE001 - handed over to the main thread, which tells the user
            self.error = error
        self.lasted = self.elapsed


class Job(Task):
    """A study on its way.

    Attributes
    ----------
    result : luz.Result or None
    readings : list of work_planes.Reading
        What was read on the work planes.
    error : Exception or None
        Why there is no result.
    """

    result: luz.Result | None

    def __init__(self, planned: Study, kept: Session):
        super().__init__(self._solve)
        self.study = planned
        self.readings: list[Reading] = []
        self._progress: queue.SimpleQueue[tuple[float, str]] = queue.SimpleQueue()
        self._kept = kept

    def cancel(self) -> None:
        """Ask the solver to stop at its next step."""
        self._cancelled.set()

    @property
    def finished(self) -> bool:
        """Whether there is a result or an error."""
        return not self._thread.is_alive()

    def latest(self, timeout: float = 0.0) -> tuple[float, str] | None:
        """Return the last progress told since the last look, waiting up to `timeout` seconds; None without news."""
        latest = None
        try:
            latest = self._progress.get(timeout=timeout) if timeout else self._progress.get_nowait()
            while True:
                latest = self._progress.get_nowait()
        except queue.Empty:
            return latest

    def _tell(self, fraction: float, stage: str) -> bool:
        self._progress.put((fraction, stage))
        return not self._cancelled.is_set()

    def _solve(self) -> luz.Result:
        result = self.study.run(self._kept, self._tell)
        self.readings = self.study.read(result, self._tell)
        return result


def seconds_left(elapsed: float, fraction: float) -> float | None:
    """Return the seconds that are left if work goes on as it went; None while it is too early to tell.

    Parameters
    ----------
    elapsed : float
        Seconds since the start.
    fraction : float
        Share of the work that is done, 0 to 1.
    """
    if elapsed < 1.0 or fraction < 0.03:
        return None
    return elapsed * (1.0 - fraction) / fraction
