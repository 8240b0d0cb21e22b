"""The stated errors of a result, which take a trial of their own: estimated when first asked for, in a thread."""

from __future__ import annotations

import threading
from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import core as luz
from .session import Session

_TICK = 0.1  # seconds between looks at the thread


def known(result: luz.Result) -> NDArray[np.float64] | None:
    """Return the errors of the faces, (n,) [lx], if they have been estimated; None otherwise."""
    return vars(result).get("error")  # where functools.cached_property keeps them


def find(scene_name: str, kept: Session, found: Callable[[str], None]) -> None:
    """Estimate the errors of the result that is shown in a scene, if it is still there, then call `found`.

    Parameters
    ----------
    scene_name : str
    kept : Session
    found : callable(scene_name)
        Called on the main thread; at once where there is no window. Not called where the errors are known already.
    """
    shown = kept.result_of(scene_name)
    if shown is None or known(shown[1]) is not None:
        return
    _, result = shown
    if bpy.app.background:
        result.error  # noqa: B018 - estimated by the asking, and kept
        found(scene_name)
        return
    thread = threading.Thread(target=lambda: result.error, name="LuzEspecular errors", daemon=True)

    def look() -> float | None:
        if thread.is_alive():
            return _TICK
        if known(result) is not None and kept.result_of(scene_name) == shown:
            found(scene_name)
        return None

    thread.start()
    bpy.app.timers.register(look, first_interval=_TICK)
