"""What happens by itself: another file lets go of what was prepared for the one before."""

from __future__ import annotations

import bpy

from . import session


@bpy.app.handlers.persistent
def _forget_transfer(_file: str, *_unused: object) -> None:
    session.current.forget()


def register() -> None:
    """Listen to the loading of files."""
    bpy.app.handlers.load_post.append(_forget_transfer)


def unregister() -> None:
    """Listen no longer, and let go of the memory."""
    bpy.app.handlers.load_post.remove(_forget_transfer)
    session.current.forget()
