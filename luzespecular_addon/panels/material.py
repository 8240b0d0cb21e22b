"""Photometric values of a material (Properties, tab Material)."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from .. import materials
from ..translations import CONTEXT
from .drawing import draw_notices
from .presets import LUZESPECULAR_PT_material_presets


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

    def draw_header_preset(self, _context):
        """Draw the button of presets."""
        LUZESPECULAR_PT_material_presets.draw_panel_header(self.layout)

    def draw(self, context):
        """Draw the panel."""
        layout = self.layout
        material = context.material
        settings = material.luzespecular
        layout.row().prop(settings, "source", expand=True)
        column = layout.column()  # sliders show their long names inside
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
            column.prop(settings, "reference", text="", placeholder=iface_("Reference", CONTEXT))
        else:
            _draw_optics(column.box().column(align=True), optics)
        _draw_sum(layout, optics)
        draw_notices(layout, materials.notices(material, optics), context.region.width)
        layout.menu("LUZESPECULAR_MT_library", icon="ASSET_MANAGER")
        layout.operator("luzespecular.values_from_shader", icon="COPYDOWN")


def _draw_sum(layout: bpy.types.UILayout, optics: materials.Optics) -> None:
    """Show what is not absorbed, which cannot be more than all; a pane's mirror reflection follows by itself."""
    allowed = optics.total <= 1.0
    terms = "τ" if optics.refractive_index is not None else "ρd + ρs + τ"
    row = layout.row(align=True)
    row.alert = not allowed
    row.progress(factor=min(optics.total, 1.0), text=f"{terms} = {optics.total:.3f} {'≤' if allowed else '>'} 1")
    row.label(text="", icon="CHECKMARK" if allowed else "ERROR")


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
