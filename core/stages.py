"""Stages of a run: what ran, what was skipped and why, seconds each; progress and cancellation."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from .errors import Cancelled

logger = logging.getLogger(__name__)

Progress = Callable[[float, str], bool]


@dataclass(frozen=True)
class Stage:
    """One stage of a run.

    Attributes
    ----------
    name : str
    seconds : float
    skipped : str
        Why it was skipped; empty where it ran.
    """

    name: str
    seconds: float = 0.0
    skipped: str = ""


@dataclass
class Recorder:
    """Keeps the list of stages, reports progress and stops where the caller wants to.

    Parameters
    ----------
    progress : callable(fraction, stage_name) -> bool, optional
        True to go on, False to cancel.
    """

    progress: Progress | None = None
    stages: list[Stage] = field(default_factory=list)

    @contextmanager
    def stage(self, name: str, fraction: float) -> Iterator[None]:
        """Time a stage that begins at ``fraction`` of the whole run."""
        self.report(fraction, name)
        start = time.perf_counter()
        yield
        self.stages.append(Stage(name, time.perf_counter() - start))
        logger.debug("%s: %.3f s", name, self.stages[-1].seconds)

    def part(self, first: float, last: float) -> Progress:
        """Progress of a step that covers a stretch of the whole run."""

        def report(fraction: float, name: str) -> bool:
            self.report(first + (last - first) * fraction, name)
            return True

        return report

    def skip(self, name: str, why: str) -> None:
        """Note a stage that the scene does not need."""
        self.stages.append(Stage(name, 0.0, why))
        logger.debug("%s skipped: %s", name, why)

    def report(self, fraction: float, name: str) -> None:
        """Tell the caller how far the run is.

        Raises
        ------
        Cancelled
            Where the caller answers False.
        """
        if self.progress is not None and self.progress(min(1.0, max(0.0, fraction)), name) is False:
            raise Cancelled(f"Cancelled during '{name}'")
