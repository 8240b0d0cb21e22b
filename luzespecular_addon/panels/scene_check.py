"""What is wrong or odd in the scene, before it is solved."""

from __future__ import annotations

from typing import ClassVar

import bpy

from .. import scene_check
from .drawing import LEVEL_ICONS, Sidebar, draw_wrapped


class LUZESPECULAR_UL_findings(bpy.types.UIList):
    """Rows of the findings."""

    def draw_item(self, context, layout, _data, item, _icon, _active_data, _active_property, index):
        """Draw one finding, with a button that selects what it is about."""
        row = layout.row(align=True)
        said = ": ".join(filter(None, (item.name, item.kind))) if item.kind else item.text
        row.label(text=said, icon=LEVEL_ICONS[item.level], translate=False)
        if scene_check.places_of(context.window_manager, index):
            row.operator("luzespecular.select_finding", text="", icon="RESTRICT_SELECT_OFF").index = index


class LUZESPECULAR_PT_scene_check(Sidebar, bpy.types.Panel):
    """What is wrong or odd in the scene, before it is solved."""

    bl_label = "Scene Check"
    bl_description = "What is wrong or odd in the scene, before it is solved"
    bl_idname = "LUZESPECULAR_PT_scene_check"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context):
        """Draw how many findings there are, since the panel may be closed."""
        levels = [finding.level for finding in context.window_manager.luzespecular.findings]
        for level in ("ERROR", "WARNING"):
            if level in levels:
                self.layout.label(text=str(levels.count(level)), icon=LEVEL_ICONS[level], translate=False)

    def draw(self, context):
        """Draw the panel."""
        layout, state = self.layout, context.window_manager.luzespecular
        layout.operator("luzespecular.check_scene", icon="VIEWZOOM")
        if not state.checked:
            return
        if not len(state.findings):
            layout.label(text="Nothing found", icon="CHECKMARK")
            return
        rows = min(max(len(state.findings), 2), 6)
        layout.template_list(
            "LUZESPECULAR_UL_findings", "", state, "findings", state, "active_finding", rows=rows, maxrows=rows
        )
        if 0 <= state.active_finding < len(state.findings):
            _draw_finding(layout.box(), state, context.region.width)


def _draw_finding(box: bpy.types.UILayout, state: bpy.types.PropertyGroup, width: float) -> None:
    """Draw all of the chosen finding: surface, text, remedy, and the button."""
    finding = state.findings[state.active_finding]
    column = box.column(align=True)
    if finding.name:
        column.label(text=finding.name, icon="OBJECT_DATA", translate=False)
    draw_wrapped(column, finding.text, LEVEL_ICONS[finding.level], width)
    if finding.remedy:
        draw_wrapped(column, finding.remedy, "TOOL_SETTINGS", width)
    if scene_check.places_of(bpy.context.window_manager, state.active_finding):
        button = box.operator("luzespecular.select_finding", icon="RESTRICT_SELECT_OFF")
        button.index = state.active_finding


CLASSES = (LUZESPECULAR_UL_findings, LUZESPECULAR_PT_scene_check)
