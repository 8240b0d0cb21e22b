"""Every setting and stored result of the extension, as properties of Blender's own data blocks; a room per subject.

No postponed annotations here: Blender reads the annotations of property groups as values.
"""

import bpy
from bpy.props import PointerProperty

from .. import live
from . import accuracy, materials, progress, results, site, sky, surfaces, work_planes
from .accuracy import LuzAccuracySettings
from .kinds import BoolProperty
from .materials import LuzMaterialSettings
from .progress import LuzProgress
from .results import LuzDisplaySettings, LuzResults, LuzScreenSettings
from .site import LuzSiteSettings
from .sky import LuzSkySettings
from .surfaces import LuzMeshSettings, LuzObjectSettings


def _live_changed(settings: "LuzSceneSettings", _context: bpy.types.Context) -> None:
    live.request(settings.id_data)


class LuzSceneSettings(bpy.types.PropertyGroup):
    """All settings of a scene."""

    site: PointerProperty(type=LuzSiteSettings)
    sky: PointerProperty(type=LuzSkySettings)
    accuracy: PointerProperty(type=LuzAccuracySettings)
    display: PointerProperty(type=LuzDisplaySettings)
    results: PointerProperty(type=LuzResults)
    live: BoolProperty(
        name="Live",
        description="Once solved, show another hour, date or sky at once, as one drags or plays; solve again when "
        "anything else changes",
        default=True,
        update=_live_changed,
    )


_ROOMS = (materials, work_planes, surfaces, site, sky, accuracy, results, progress)

_CLASSES = (*(cls for room in _ROOMS for cls in room.CLASSES), LuzSceneSettings)

_POINTERS = (
    (bpy.types.Material, LuzMaterialSettings),
    (bpy.types.Object, LuzObjectSettings),
    (bpy.types.Mesh, LuzMeshSettings),
    (bpy.types.Scene, LuzSceneSettings),
    (bpy.types.Screen, LuzScreenSettings),
    (bpy.types.WindowManager, LuzProgress),
)


def register() -> None:
    """Add the properties to Blender's data blocks."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for owner, cls in _POINTERS:
        owner.luzespecular = PointerProperty(type=cls)


def unregister() -> None:
    """Take the properties away; saved values stay in the file until it is saved without the extension."""
    for owner, _cls in reversed(_POINTERS):
        del owner.luzespecular
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
