"""What operators say, and where it is seen."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..notices import Notice


def report_all(operator: bpy.types.Operator, notices: Iterable[Notice]) -> None:
    """Report each notice at its level."""
    for notice in notices:
        operator.report({notice.level}, notice.text)


def redraw(context: bpy.types.Context) -> None:
    """Have all 3D viewports and their sidebars drawn anew."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
