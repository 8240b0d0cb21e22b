"""The stated errors of a result, which take a trial of their own: estimated when first asked for, in a thread."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import core as luz
from .export import Export

Kept = tuple[Export, luz.Result]

_on_their_way: weakref.WeakSet[luz.Result] = weakref.WeakSet()

_TICK = 0.1  # seconds between looks at the thread


def known(result: luz.Result) -> NDArray[np.float64] | None:
    """Return the errors of the faces, (n,) [lx], if they have been estimated; None otherwise."""
    return vars(result).get("error")  # where functools.cached_property keeps them


def find(scene: bpy.types.Scene, kept: Callable[[bpy.types.Scene], Kept | None], found: Callable) -> None:
    """Estimate the errors of the result that a scene shows, if it is still known, then call `found`.

    Parameters
    ----------
    scene : bpy.types.Scene
    kept : callable(scene) -> (export, result) or None
        What the scene shows.
    found : callable(scene, (export, result))
        Called on the main thread; at once where there is no window. Not called where the errors are known already, or
        the scene shows another result by then.
    """
    shown = kept(scene)
    if shown is None or known(shown[1]) is not None or shown[1] in _on_their_way:
        return
    result, name = shown[1], scene.name
    if bpy.app.background:
        result.error  # noqa: B018 - estimated by the asking, and kept
        found(scene, shown)
        return
    thread = threading.Thread(target=lambda: result.error, name="LuzEspecular errors", daemon=True)

    def look() -> float | None:
        if thread.is_alive():
            return _TICK
        _on_their_way.discard(result)
        now = bpy.data.scenes.get(name)
        if now is not None and known(result) is not None and (kept(now) or (None, None))[1] is result:
            found(now, shown)
        return None

    _on_their_way.add(result)
    thread.start()
    bpy.app.timers.register(look, first_interval=_TICK)
