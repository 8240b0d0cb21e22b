"""The buttons; a room per subject."""

from __future__ import annotations

import bpy

from . import materials, presets, results, site, solve, surfaces

_ROOMS = (solve, site, surfaces, results, materials, presets)

register, unregister = bpy.utils.register_classes_factory([cls for room in _ROOMS for cls in room.CLASSES])
