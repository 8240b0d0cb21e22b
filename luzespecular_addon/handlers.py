"""What happens by itself: on another file, another frame, an undo, a turn of the Sun light."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from . import display, following, live, render_legend, scene_check, session


@persistent
def _file_loaded(_file: str, *_unused: object) -> None:
    session.current.forget()
    live.stop()
    for manager in bpy.data.window_managers:
        scene_check.clear(manager)


@persistent
def _frame_changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    evaluated = scene.evaluated_get(depsgraph)  # in a render, keyframes reach only this copy
    following.point_sun_light(evaluated.luzespecular.site)
    live.current.frame(scene, evaluated)
    render_legend.follow(scene, depsgraph)


@persistent
def _scene_updated(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if scene.luzespecular.site.sun_link == "READ" and live.current.follows(scene):
        light = scene.luzespecular.site.sun_object
        if any(update.is_updated_transform and update.id.original == light for update in depsgraph.updates):
            live.request(scene)
    if depsgraph.id_type_updated("COLLECTION"):
        display.settle_objects(scene)
    render_legend.follow(scene, depsgraph)


@persistent
def _stepped_back(scene: bpy.types.Scene, *_unused: object) -> None:
    display.settle_viewports(scene)
    live.request(scene)


@persistent
def _render_begins(_scene: bpy.types.Scene, *_unused: object) -> None:
    live.current.rendering = True


@persistent
def _render_ends(_scene: bpy.types.Scene, *_unused: object) -> None:
    live.current.rendering = False


_HANDLERS = (
    ("load_post", _file_loaded),
    ("frame_change_post", _frame_changed),
    ("depsgraph_update_post", _scene_updated),
    ("undo_post", _stepped_back),
    ("redo_post", _stepped_back),
    ("render_init", _render_begins),
    ("render_complete", _render_ends),
    ("render_cancel", _render_ends),
)


def register() -> None:
    """Listen."""
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)


def unregister() -> None:
    """Listen no longer, and let go of the memory."""
    for event, handler in _HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    live.stop()
    session.current.forget()
