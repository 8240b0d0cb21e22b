"""Brazilian Portuguese, a room per subject: names of operators, and all other texts of the interface."""

from __future__ import annotations

from . import (
    accuracy,
    library,
    materials,
    notices,
    probe,
    results,
    scene_check,
    site,
    sky,
    solve,
    surfaces,
    work_planes,
)
from .solver import KINDS, SOLVER, STAGES

_ROOMS = (site, sky, surfaces, materials, library, accuracy, scene_check, solve, results, probe, work_planes, notices)

OPERATORS = {english: text for room in _ROOMS for english, text in getattr(room, "OPERATORS", {}).items()}

TEXTS = {english: text for room in _ROOMS for english, text in room.TEXTS.items()}

__all__ = ["KINDS", "OPERATORS", "SOLVER", "STAGES", "TEXTS"]
