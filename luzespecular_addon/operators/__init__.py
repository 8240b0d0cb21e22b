"""The buttons; a room per subject."""

from __future__ import annotations

import bpy

from . import loose_ends, materials, pictures, presets, probe, results, scene_check, site, solve, surfaces, work_planes

_ROOMS = (solve, scene_check, site, surfaces, results, probe, work_planes, materials, pictures, presets)

register, _unregister_classes = bpy.utils.register_classes_factory([cls for room in _ROOMS for cls in room.CLASSES])


def unregister() -> None:
    """End what runs, which Blender would drop as it is, and take the buttons away."""
    loose_ends.close_all()
    _unregister_classes()
