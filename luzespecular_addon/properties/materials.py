"""Photometric properties of materials."""

import bpy

from .kinds import BoolProperty, EnumProperty, FloatProperty, ShareProperty, StringProperty


class LuzMaterialSettings(bpy.types.PropertyGroup):
    """Photometric properties of a material."""

    source: EnumProperty(
        name="Values",
        description="Where the photometric values come from",
        items=(
            ("SHADER", "From Shader", "Read the values from the material's shader nodes"),
            ("CUSTOM", "Custom", "Use the values given here"),
        ),
        default="SHADER",
    )
    diffuse_reflectance: ShareProperty(
        name="Diffuse Reflectance",
        description="Share of the light that leaves evenly in all directions",
        default=0.5,
    )
    specular_reflectance: ShareProperty(
        name="Specular Reflectance",
        description="Share of the light that leaves as from a mirror",
        default=0.0,
    )
    regular_transmittance: ShareProperty(
        name="Regular Transmittance",
        description="Share of the light that passes straight through the whole pane at normal incidence",
        default=0.0,
    )
    use_refractive_index: BoolProperty(
        name="Clear Pane",
        description="Let reflection and transmission follow from the refractive index and the angle of incidence",
        default=False,
    )
    refractive_index: FloatProperty(
        name="Refractive Index",
        description="Of the pane; window glass has 1.52",
        min=1.001,
        max=3.0,
        default=1.52,
        precision=3,
    )
    exitance: FloatProperty(
        name="Exitance (lm/m²)",
        description="Luminous exitance that the surface emits by itself",
        min=0.0,
        default=0.0,
    )
    reference: StringProperty(
        name="Reference",
        description="Where the values come from: a measurement, a data sheet, a library",
    )


CLASSES = (LuzMaterialSettings,)
