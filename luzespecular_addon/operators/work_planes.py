"""Add work planes, save what was read on them."""

from __future__ import annotations

from typing import ClassVar

import bpy
import numpy as np
from bpy.app.translations import pgettext_data as data_
from bpy.app.translations import pgettext_rpt as rpt_

from .. import floor_grid, mesh_arrays, participants, placements, work_planes, writeback
from ..properties.kinds import FloatProperty
from .polls import NeedsObjectMode
from .saving import SavesTable


class LUZESPECULAR_OT_add_work_plane(NeedsObjectMode, bpy.types.Operator):
    """Lay a grid of points above the floor of the selected objects."""

    bl_idname = "luzespecular.add_work_plane"
    bl_label = "Add Work Plane"
    bl_description = (
        "Lay a grid of points above the floor of the selected objects, or of all; solving then reads the light there"
    )
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    height: FloatProperty(name="Height (m)", description="Above the floor", default=work_planes.HEIGHT, min=0.0)
    spacing: FloatProperty(name="Spacing (m)", description="Distance of the points", default=0.25, min=0.01)
    border: FloatProperty(name="Border (m)", description="Strip along the walls that is left out", default=0.0, min=0.0)

    def execute(self, context):
        """Add the plane."""
        triangles = _triangles(context, _floor_objects(context))
        turn = context.object.matrix_world.to_euler().z if context.object else 0.0
        try:
            lattice = floor_grid.above_floor(triangles, self.height, self.spacing, self.border, turn)
        except ValueError as error:
            text = rpt_("The grid would have {count} points: choose a larger spacing")
            self.report({"ERROR"}, text.format(count=error.args[0]))
            return {"CANCELLED"}
        if lattice is None:
            self.report(
                {"ERROR"},
                rpt_("No floor was found: select an object with faces that look up, or choose a smaller border"),
            )
            return {"CANCELLED"}
        name, scale = data_("Work plane"), placements.unit_scale(context.scene)
        mesh = mesh_arrays.new_mesh(
            name, lattice.vertices / scale, lattice.corners.reshape(-1), 4 * np.arange(len(lattice.corners))
        )
        object_ = bpy.data.objects.new(name, mesh)
        object_.luzespecular.plane.enabled = True
        object_.hide_render = True
        context.scene.collection.objects.link(object_)
        for other in context.selected_objects:
            other.select_set(False)
        object_.select_set(True)
        context.view_layer.objects.active = object_
        self.report({"INFO"}, rpt_("{count} points; solve to read them").format(count=len(lattice.corners)))
        return {"FINISHED"}


class LUZESPECULAR_OT_save_work_planes(SavesTable, bpy.types.Operator):
    """Save the points of all work planes and their illuminance as a CSV file."""

    bl_idname = "luzespecular.save_work_planes"
    bl_label = "Save Points"
    bl_description = "Save the points of all work planes and their illuminance as a CSV file"

    @classmethod
    def poll(cls, context):
        """Grey where nothing was read."""
        if any(writeback.holds_results(plane.data) for plane in work_planes.all_of(context.scene)):
            return True
        cls.poll_message_set("No work plane has been read yet: solve first")
        return False

    def table(self, context):
        """All quantities at all points."""
        return work_planes.HEADER, work_planes.rows(context.scene, placements.unit_scale(context.scene))


def _floor_objects(context) -> list[bpy.types.Object]:
    """Return the selected objects that take part in the light; all of them where none is selected."""
    everything = participants.rendered_objects(context.view_layer)
    selected = set(context.selected_objects)
    chosen = [object_ for object_ in everything if object_ in selected]
    return chosen or [object_ for object_ in everything if object_.luzespecular.role == "RECEIVER"]


def _triangles(context, objects: list[bpy.types.Object]) -> np.ndarray:
    """Return the lit sides of objects as triangles in world space [m], (t, 3, 3)."""
    parts = placements.collect(context, objects, track_faces=False)
    fronts = [(part, part.vertices[part.faces]) for part in parts]
    found = [corners for _, corners in fronts] + [corners[:, ::-1] for part, corners in fronts if part.two_sided]
    return np.concatenate(found) if found else np.zeros((0, 3, 3))


CLASSES = (LUZESPECULAR_OT_add_work_plane, LUZESPECULAR_OT_save_work_planes)
