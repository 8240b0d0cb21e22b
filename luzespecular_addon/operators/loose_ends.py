"""What running operators put back when they end, also where Blender drops them without a word: on disabling."""

from __future__ import annotations

from contextlib import ExitStack

import bpy

_open: list[ExitStack] = []


def new() -> ExitStack:
    """Return where an operator that begins to run leaves what is to be done at its end; closed by `close_all` too."""
    ends = ExitStack()
    _open.append(ends)
    ends.callback(_open.remove, ends)
    return ends


def close_all() -> None:
    """End all that runs."""
    while _open:
        _open[-1].close()


def clear_status() -> None:
    """Have the status bar show its own again, wherever the user has gone meanwhile."""
    for workspace in bpy.data.workspaces:
        workspace.status_text_set(None)
