"""Presets in the headers of panels: what comes along, and what users saved under names of their own."""

from __future__ import annotations

import bpy
from bl_ui.utils import PresetPanel
from bpy.app.translations import pgettext_iface as iface_

from .. import library, places


class _Presets(PresetPanel):
    preset_operator = "script.execute_preset"

    def draw(self, context):
        """Draw what users saved."""
        self.draw_saved(context)

    def draw_saved(self, context: bpy.types.Context) -> None:
        """Draw the presets that users saved, or where to save the first."""
        self.layout.label(text="Own presets")
        if bpy.utils.preset_paths(self.preset_subdir):
            super().draw(context)
            return
        # Blender would call it a missing path that none has been saved yet.
        row, state = self.layout.row(align=True), context.window_manager
        row.emboss = "NORMAL"
        row.prop(state, "preset_name", text="")
        row.operator(self.preset_add_operator, text="", icon="ADD").name = state.preset_name


class LUZESPECULAR_PT_site_presets(_Presets, bpy.types.Panel):
    """Cities, and places saved by the user."""

    bl_label = "Places"
    bl_description = "Cities, and places saved by the user"
    preset_subdir = "luzespecular/site"
    preset_add_operator = "luzespecular.site_preset"

    def draw(self, context):
        """Draw the cities in two columns, then the user's own places."""
        columns = self.layout.row()
        columns.emboss = "PULLDOWN_MENU"
        half = len(places.PLACES) // 2
        for some in (places.PLACES[:half], places.PLACES[half:]):
            column = columns.column(align=True)
            for place in some:
                button = column.operator("luzespecular.set_place", text=place.name, translate=False)
                button.place = place.name
        self.draw_saved(context)


class LUZESPECULAR_PT_sky_presets(_Presets, bpy.types.Panel):
    """Skies saved by the user."""

    bl_label = "Skies"
    bl_description = "Skies saved by the user"
    preset_subdir = "luzespecular/sky"
    preset_add_operator = "luzespecular.sky_preset"


class LUZESPECULAR_PT_accuracy_presets(_Presets, bpy.types.Panel):
    """Accuracies saved by the user."""

    bl_label = "Accuracies"
    bl_description = "Accuracies saved by the user"
    preset_subdir = "luzespecular/accuracy"
    preset_add_operator = "luzespecular.accuracy_preset"


class LUZESPECULAR_PT_material_presets(_Presets, bpy.types.Panel):
    """Materials saved by the user."""

    bl_label = "Materials"
    bl_description = "Materials saved by the user"
    preset_subdir = "luzespecular/material"
    preset_add_operator = "luzespecular.material_preset"


class LUZESPECULAR_MT_library(bpy.types.Menu):
    """Common building materials, group by group."""

    bl_label = "Library"
    bl_description = "Common building materials with their values and sources"
    bl_idname = "LUZESPECULAR_MT_library"

    def draw(self, _context):
        """Draw a column for each group."""
        row = self.layout.row()
        for group, entries in library.groups().items():
            column = row.column()
            column.label(text=iface_(group), translate=False)
            column.separator()
            for entry in entries:
                button = column.operator("luzespecular.apply_material", text=iface_(entry.name), translate=False)
                button.material = entry.key


CLASSES = (
    LUZESPECULAR_PT_site_presets,
    LUZESPECULAR_PT_sky_presets,
    LUZESPECULAR_PT_accuracy_presets,
    LUZESPECULAR_PT_material_presets,
    LUZESPECULAR_MT_library,
)
