"""The interface in other languages; so far Brazilian Portuguese. Keys are (context, English text)."""

from __future__ import annotations

import bpy

from .translations_pt_br import OPERATORS, STAGES, TEXTS

CONTEXT = "LuzEspecular"
"""Context of the names of properties and of the items to choose from."""

_BASE = __package__.rpartition(".")[0]


def table() -> dict[str, dict[tuple[str, str], str]]:
    """Return the translations as Blender registers them."""
    everywhere = TEXTS | STAGES
    texts = {(context, english): text for context in ("*", CONTEXT) for english, text in everywhere.items()}
    texts |= {("Operator", english): text for english, text in OPERATORS.items()}
    return {"pt_BR": texts}


def register() -> None:
    """Add the translations."""
    bpy.app.translations.register(_BASE, table())


def unregister() -> None:
    """Take the translations away."""
    bpy.app.translations.unregister(_BASE)
