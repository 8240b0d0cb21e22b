"""What `prepare` is asked for besides the scene, checked."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from .errors import SceneError
from .globe import Globe
from .scene import Scene


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options that a transfer depends on; see `prepare`.

    Attributes
    ----------
    bands : int
    max_area : float or None
        [m²]
    specular_cutoff : float
    accuracy : float or None
    receivers : tuple of str or None
        Surfaces whose faces are wanted; None = all.
    """

    bands: int = 60
    max_area: float | None = None
    specular_cutoff: float = 1e-3
    accuracy: float | None = None
    receivers: tuple[str, ...] | None = None

    @classmethod
    def checked(cls, scene: Scene, *, bands, max_area, specular_cutoff, accuracy, receivers) -> Options:
        """Return the options as plain numbers and names.

        Raises
        ------
        SceneError
            Where one is out of range; the message names it and the remedy.
        """
        Globe(bands)  # says what is wrong with its number
        if max_area is not None:
            max_area = _positive("max_area", max_area, infinite=True)
        cutoff = _positive("specular_cutoff", specular_cutoff)
        if cutoff > 1:
            raise SceneError(
                f"specular_cutoff is {cutoff:g}; give a product of reflectances of at most 1 (1e-3 is usual)"
            )
        if accuracy is not None:
            accuracy = _positive("accuracy", accuracy)
            if not 1e-3 <= accuracy <= 0.2:
                raise SceneError(f"accuracy is {accuracy:g}; give a relative error from 0.001 to 0.2 (0.01 is usual)")
        names = None if receivers is None else _checked_names(scene, receivers)
        return cls(bands=int(bands), max_area=max_area, specular_cutoff=cutoff, accuracy=accuracy, receivers=names)


def _checked_names(scene: Scene, receivers) -> tuple[str, ...]:
    """Names of surfaces, in the scene's order."""
    if isinstance(receivers, str) or not isinstance(receivers, Iterable):
        raise SceneError(f"receivers must be a list of names of surfaces, not {receivers!r}")
    wanted = list(receivers)
    unknown = [name for name in wanted if name not in scene.surfaces]
    if unknown or not wanted:
        what = f"there is no surface {unknown[0]!r}" if unknown else "the list is empty"
        raise SceneError(f"receivers: {what}; name some of: {', '.join(list(scene.surfaces)[:20])}")
    return tuple(name for name in scene.surfaces if name in wanted)


def checked_scene(scene) -> Scene:
    """The scene, where it is one and has surfaces; else SceneError."""
    if not isinstance(scene, Scene):
        raise SceneError(f"prepare needs a luzespecular.Scene, not {type(scene).__name__}")
    if not scene.surfaces:
        raise SceneError("The scene has no surfaces; add at least one with scene.add(name, vertices, material)")
    return scene


def checked_threads(threads) -> int:
    """Number of threads, all cores for None; SceneError where it is no count."""
    if threads is None:
        return os.cpu_count() or 1
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        raise SceneError(f"threads must be a whole number of at least 1, not {threads!r}")
    return int(threads)


def checked_memory(memory) -> float | None:
    """Bytes, or None for no limit; SceneError where it is no positive number."""
    return None if memory is None else _positive("memory", memory, infinite=True)


def _positive(name: str, value, infinite: bool = False) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SceneError(f"{name} must be a number, not {value!r}") from None
    if not number > 0 or (math.isinf(number) and not infinite):
        raise SceneError(f"{name} must be above 0, not {number:g}")
    return number
