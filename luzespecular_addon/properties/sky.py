"""Sky, Sun and ground."""

import bpy

from ..choices import CIE_ITEMS, SKY_ITEMS
from .kinds import BoolProperty, EnumProperty, FloatProperty, ShareProperty


class LuzSkySettings(bpy.types.PropertyGroup):
    """The light that comes from outside."""

    kind: EnumProperty(name="Sky", description="Sky and its illuminance", items=SKY_ITEMS, default="CLEAR")
    cie_type: EnumProperty(
        name="CIE Type", description="Type of the CIE standard general sky (ISO 15469)", items=CIE_ITEMS, default="12"
    )
    horizontal_illuminance: FloatProperty(
        name="Sky Illuminance (lx)",
        description="Diffuse illuminance of the sky alone on an open horizontal plane",
        min=0.0,
        default=10_000.0,
        step=10_000,
        precision=0,
    )
    use_sun: BoolProperty(name="Sun", description="Let the Sun shine", default=True)
    sun_illuminance: FloatProperty(
        name="Sun Illuminance (lx)",
        description="Illuminance by the Sun on a plane that faces it",
        min=0.0,
        default=80_000.0,
        step=100_000,
        precision=0,
    )
    ground_reflectance: ShareProperty(
        name="Ground Reflectance",
        description="Reflectance of the open ground around the scene: 0.2 for grass or soil, 0 for no light from below",
        default=0.2,
    )


CLASSES = (LuzSkySettings,)
