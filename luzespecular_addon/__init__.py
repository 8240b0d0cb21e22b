"""The Blender side: scene to solver, solver to scene, and what the user sees in between.

Data goes one way: `participants`, `materials`, `export` read Blender; `study` runs the solver; `writeback`,
`results_object` and `display` write; `operators`, `panels`, `legend` and `commands` are the faces it shows.
"""

from __future__ import annotations

from . import commands, compass, console, handlers, legend, operators, overlays, panels, properties, translations

_ROOMS = (console, translations, properties, operators, panels, legend, compass, overlays, handlers, commands)


def register() -> None:
    """Enable everything; where one part fails, what was enabled before it is disabled again."""
    registered = []
    try:
        for room in _ROOMS:
            room.register()
            registered.append(room)
    except Exception:
        for room in reversed(registered):
            room.unregister()
        raise


def unregister() -> None:
    """Disable everything, the last part first."""
    for room in reversed(_ROOMS):
        room.unregister()
