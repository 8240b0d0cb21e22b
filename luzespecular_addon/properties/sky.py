"""Sky, Sun and ground."""

import bpy

from .. import following
from ..choices import CIE_ITEMS, SKY_ITEMS
from .kinds import BoolProperty, EnumProperty, FloatProperty, ShareProperty


def _changed(settings: "LuzSkySettings", _context: bpy.types.Context) -> None:
    following.settings_changed(settings.id_data)


def _kind_changed(settings: "LuzSkySettings", context: bpy.types.Context) -> None:
    # Presets bring their illuminances along; who chooses a CIE type or no sky mostly has some to give.
    settings.illuminance_from = "VALUE" if settings.kind in {"CIE", "NONE"} else "MODEL"
    _changed(settings, context)


class LuzSkySettings(bpy.types.PropertyGroup):
    """The light that comes from outside."""

    kind: EnumProperty(
        name="Sky", description="Sky and its illuminance", items=SKY_ITEMS, default="CLEAR", update=_kind_changed
    )
    cie_type: EnumProperty(
        name="CIE Type",
        description="Type of the CIE standard general sky (ISO 15469)",
        items=CIE_ITEMS,
        default="12",
        update=_changed,
    )
    illuminance_from: EnumProperty(
        name="Illuminance",
        description="Where the illuminances of sky and Sun come from",
        items=(
            ("MODEL", "By Model", "Mean illuminances by date and Sun altitude (IES daylight availability, RP-21)"),
            ("VALUE", "By Value", "The illuminances given here"),
        ),
        default="MODEL",
        update=_changed,
    )
    horizontal_illuminance: FloatProperty(
        name="Sky (lx)",
        description="Diffuse illuminance of the sky alone on an open horizontal plane",
        min=0.0,
        default=10_000.0,
        step=10_000,
        precision=0,
        update=_changed,
    )
    use_sun: BoolProperty(name="Sun", description="Let the Sun shine", default=True, update=_changed)
    sun_disc: BoolProperty(
        name="Solar Disc",
        description="Soft edges of shadows by the disc of 0.533° that the Sun is; takes longer",
        default=False,
        update=_changed,
    )
    sun_illuminance: FloatProperty(
        name="Sun (lx)",
        description="Illuminance by the Sun on a plane that faces it",
        min=0.0,
        default=80_000.0,
        step=100_000,
        precision=0,
        update=_changed,
    )
    ground_reflectance: ShareProperty(
        name="Ground Reflectance",
        description="Reflectance of the open ground around the scene: 0.2 for grass or soil, 0 for no light from below",
        default=0.2,
        update=_changed,
    )


CLASSES = (LuzSkySettings,)
