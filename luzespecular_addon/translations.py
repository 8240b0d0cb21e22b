"""The interface in other languages; so far Brazilian Portuguese. Keys are (context, English text)."""

from __future__ import annotations

import bpy

from .translations_pt_br import OPERATORS, STAGES, TEXTS

_BASE = __package__.rpartition(".")[0]


def table() -> dict[str, dict[tuple[str, str], str]]:
    """Return the translations as Blender registers them."""
    texts = {("*", english): text for english, text in (TEXTS | STAGES).items()}
    texts |= {("Operator", english): text for english, text in OPERATORS.items()}
    return {"pt_BR": texts}


def register() -> None:
    """Add the translations."""
    bpy.app.translations.register(_BASE, table())


def unregister() -> None:
    """Take the translations away."""
    bpy.app.translations.unregister(_BASE)
