"""The sidebar (3D View, tab LuzEspecular) and the panel of materials. Nothing is computed here."""

from __future__ import annotations

import bpy

from . import accuracy, material, presets, results, scene_check, site, sky, solve, surfaces, work_planes

_ROOMS = (
    presets,
    site,
    sky,
    surfaces,
    accuracy,
    scene_check,
    solve,
    results,
    work_planes,
    material,
)  # from top to bottom

register, unregister = bpy.utils.register_classes_factory([cls for room in _ROOMS for cls in room.CLASSES])
