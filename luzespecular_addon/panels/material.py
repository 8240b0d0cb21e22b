"""Photometric values of a material (Properties, tab Material)."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import materials
from .drawing import draw_notices


class LUZESPECULAR_PT_material(bpy.types.Panel):
    """Photometric values of the active material."""

    bl_label = "LuzEspecular"
    bl_description = "Photometric values of the active material"
    bl_idname = "LUZESPECULAR_PT_material"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        """Only with a material."""
        return context.material is not None

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        material = context.material
        settings = material.luzespecular
        layout.row().prop(settings, "source", expand=True)
        column = layout.column(align=True)
        optics = materials.read(material)
        if settings.source == "CUSTOM":
            column.prop(settings, "use_refractive_index")
            if settings.use_refractive_index:
                column.prop(settings, "regular_transmittance")
                column.prop(settings, "refractive_index")
            else:
                column.prop(settings, "diffuse_reflectance")
                column.prop(settings, "specular_reflectance")
                column.prop(settings, "regular_transmittance")
            column.prop(settings, "exitance")
        else:
            _draw_optics(column.column(align=True), optics)
        draw_notices(layout, materials.notices(material, optics), context.region.width)
        layout.label(text=iface_("Not absorbed: {share:.3f} of 1").format(share=optics.total), translate=False)
        layout.operator("luzespecular.values_from_shader", icon="COPYDOWN")


def _draw_optics(column: bpy.types.UILayout, optics: materials.Optics) -> None:
    rows = (
        ("Diffuse Reflectance", optics.diffuse_reflectance),
        ("Specular Reflectance", optics.specular_reflectance),
        ("Regular Transmittance", optics.regular_transmittance),
        ("Refractive Index", optics.refractive_index),
        ("Exitance (lm/m²)", optics.exitance),
    )
    for name, value in rows:
        if value:
            column.label(text=f"{iface_(name)}: {value:.4g}", translate=False)
    if not any(value for _, value in rows):
        column.label(text="Black: absorbs all light")


CLASSES = (LUZESPECULAR_PT_material,)
