"""Values for a material: from its shader, or from the library."""

from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from .. import library, materials


class LUZESPECULAR_OT_values_from_shader(bpy.types.Operator):
    """Copy the values that the shader stands for, to change them by hand."""

    bl_idname = "luzespecular.values_from_shader"
    bl_label = "Copy from Shader"
    bl_description = "Copy the values that the shader stands for, to change them by hand"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        """Need a material."""
        return has_material(cls, context)

    def execute(self, context):
        """Copy."""
        material = active_material(context)
        materials.write(material.luzespecular, materials.from_shader(material))
        material.luzespecular.reference = ""
        return {"FINISHED"}


class LUZESPECULAR_OT_apply_material(bpy.types.Operator):
    """Give the active material the photometric values of a common building material."""

    bl_idname = "luzespecular.apply_material"
    bl_label = "Apply Material"
    bl_description = "Give the active material the photometric values of a common building material"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    material: bpy.props.StringProperty(name="Material", description="Key of the material in the library")

    @classmethod
    def poll(cls, context):
        """Need a material."""
        return has_material(cls, context)

    @classmethod
    def description(cls, _context, properties):
        """Tell values and source under the mouse."""
        entry = library.entry_of(properties.material)
        return (
            ""
            if entry is None
            else rpt_("{stated}. Source: {source}").format(stated=entry.stated, source=library.SOURCES[entry.source])
        )

    def execute(self, context):
        """Apply."""
        entry = library.entry_of(self.material)
        if entry is None:
            known = ", ".join(entry.key for entry in library.LIBRARY)
            text = rpt_("There is no material '{key}' in the library: choose one of {known}")
            self.report({"ERROR"}, text.format(key=self.material, known=known))
            return {"CANCELLED"}
        settings = active_material(context).luzespecular
        materials.write(settings, materials.of_entry(entry))
        settings.reference = f"{iface_(entry.name)}: {entry.stated} ({library.SOURCES[entry.source]})"
        return {"FINISHED"}


def active_material(context: bpy.types.Context) -> bpy.types.Material | None:
    """Return the material of the Properties editor, or that of the active object."""
    if getattr(context, "material", None) is not None:
        return context.material
    return context.object and context.object.active_material


def has_material(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether there is a material that can be changed; a grey button says why not."""
    material = active_material(context)
    if material is None:
        cls.poll_message_set("There is no material: add one to the object first")
        return False
    if not material.is_editable:
        cls.poll_message_set("The material is linked from another file: make it local first")
        return False
    return True


CLASSES = (LUZESPECULAR_OT_values_from_shader, LUZESPECULAR_OT_apply_material)
