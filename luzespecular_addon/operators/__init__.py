"""The buttons; a room per subject."""

from __future__ import annotations

import bpy

from . import materials, pictures, presets, probe, results, scene_check, site, solve, surfaces, work_planes

_ROOMS = (solve, scene_check, site, surfaces, results, probe, work_planes, materials, pictures, presets)

register, unregister = bpy.utils.register_classes_factory([cls for room in _ROOMS for cls in room.CLASSES])
