"""What operators say, and where it is seen."""

from __future__ import annotations

from collections.abc import Iterable

import bpy
from bpy.app.translations import pgettext_iface as iface_

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


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Have the sidebars of all 3D viewports drawn anew; the views, which take longer, are left as they are."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions if area.type == "VIEW_3D" else ():
                if region.type == "UI":
                    region.tag_redraw()


def time_left(seconds: float) -> str:
    """Return for people how long something will still take, no more precise than it is known."""
    if seconds < 60.0:
        return iface_("about {seconds:.0f} s left").format(seconds=max(seconds, 1.0))
    return iface_("about {minutes:.0f} min left").format(minutes=seconds / 60.0)
