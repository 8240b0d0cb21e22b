"""What panels share: the sidebar they stand in, and texts that fit."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..compass import TAB
from ..translations import CONTEXT

LEVEL_ICONS = {"ERROR": "CANCEL", "WARNING": "ERROR", "INFO": "INFO"}


class Sidebar:
    """Where the panels of the sidebar stand."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = TAB
    bl_translation_context = CONTEXT


def draw_wrapped(column: bpy.types.UILayout, text: str, icon: str, width: float) -> None:
    """Draw a text on as many lines as the region's width asks for, since labels do not wrap."""
    size = bpy.context.preferences.system.ui_scale or 1.0  # 0 without a window
    letters = max(int(width / (7.0 * size)) - 6, 20)
    line = ""
    for word in text.split():
        if line and len(line) + 1 + len(word) > letters:
            column.label(text=line, icon=icon, translate=False)
            line, icon = "", "BLANK1"
        line = f"{line} {word}".strip()
    column.label(text=line, icon=icon, translate=False)


def draw_notices(layout: bpy.types.UILayout, notices: Iterable, width: float) -> None:
    """Draw remarks, each with a `level` and a `text`, below one another."""
    column = layout.column(align=True)
    for notice in notices:
        draw_wrapped(column, notice.text, LEVEL_ICONS[notice.level], width)
