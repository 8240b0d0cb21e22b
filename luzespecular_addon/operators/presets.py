"""Presets: settings saved under a name, by Blender's own system, in the user's folder of presets."""

import bpy
from bl_operators.presets import AddPresetBase


class LUZESPECULAR_OT_site_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the place."""

    bl_idname = "luzespecular.site_preset"
    bl_label = "Add Place Preset"
    bl_description = "Save or remove a preset: latitude, longitude, time zone and north offset"
    preset_menu = "LUZESPECULAR_PT_site_presets"
    preset_subdir = "luzespecular/site"
    preset_defines = ("settings = bpy.context.scene.luzespecular.site",)
    preset_values = ("settings.latitude", "settings.longitude", "settings.time_zone", "settings.north_offset")


class LUZESPECULAR_OT_sky_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the sky."""

    bl_idname = "luzespecular.sky_preset"
    bl_label = "Add Sky Preset"
    bl_description = "Save or remove a preset: sky, Sun and ground"
    preset_menu = "LUZESPECULAR_PT_sky_presets"
    preset_subdir = "luzespecular/sky"
    preset_defines = ("settings = bpy.context.scene.luzespecular.sky",)
    preset_values = (
        "settings.kind",  # first: it sets where illuminances come from
        "settings.cie_type",
        "settings.illuminance_from",
        "settings.horizontal_illuminance",
        "settings.use_sun",
        "settings.sun_disc",
        "settings.sun_illuminance",
        "settings.ground_reflectance",
    )


class LUZESPECULAR_OT_accuracy_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the accuracy."""

    bl_idname = "luzespecular.accuracy_preset"
    bl_label = "Add Accuracy Preset"
    bl_description = "Save or remove a preset: fineness and all numbers of the solver"
    preset_menu = "LUZESPECULAR_PT_accuracy_presets"
    preset_subdir = "luzespecular/accuracy"
    preset_defines = ("settings = bpy.context.scene.luzespecular.accuracy",)
    preset_values = (
        "settings.fineness",
        "settings.error",
        "settings.bands",
        "settings.max_area",
        "settings.cycles",
        "settings.tolerance",
        "settings.specular_cutoff",
        "settings.threads",
    )


class LUZESPECULAR_OT_material_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of photometric values."""

    bl_idname = "luzespecular.material_preset"
    bl_label = "Add Material Preset"
    bl_description = "Save or remove a preset: the photometric values of a material"
    preset_menu = "LUZESPECULAR_PT_material_presets"
    preset_subdir = "luzespecular/material"
    preset_defines = ("settings = bpy.context.material.luzespecular",)
    preset_values = (
        "settings.source",
        "settings.diffuse_reflectance",
        "settings.specular_reflectance",
        "settings.regular_transmittance",
        "settings.use_refractive_index",
        "settings.refractive_index",
        "settings.exitance",
        "settings.reference",
    )


CLASSES = (
    LUZESPECULAR_OT_site_preset,
    LUZESPECULAR_OT_sky_preset,
    LUZESPECULAR_OT_accuracy_preset,
    LUZESPECULAR_OT_material_preset,
)
