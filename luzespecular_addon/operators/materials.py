"""Copy a shader's values."""

from __future__ import annotations

from typing import ClassVar

import bpy

from .. import materials


class LUZESPECULAR_OT_values_from_shader(bpy.types.Operator):
    """Copy the values that the shader stands for, to change them by hand."""

    bl_idname = "luzespecular.values_from_shader"
    bl_label = "Copy from Shader"
    bl_description = "Copy the values that the shader stands for, to change them by hand"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        """Need a material."""
        return getattr(context, "material", None) is not None

    def execute(self, context):
        """Copy."""
        optics, settings = materials.from_shader(context.material), context.material.luzespecular
        settings.source = "CUSTOM"
        settings.diffuse_reflectance = optics.diffuse_reflectance
        settings.specular_reflectance = optics.specular_reflectance
        settings.regular_transmittance = optics.regular_transmittance
        settings.exitance = optics.exitance
        settings.use_refractive_index = optics.refractive_index is not None
        if optics.refractive_index is not None:
            settings.refractive_index = optics.refractive_index
        return {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_values_from_shader,)
