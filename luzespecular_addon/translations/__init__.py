"""The interface in other languages; so far Brazilian Portuguese. Keys are (context, English text)."""

from __future__ import annotations

import re

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .in_blender import IN_BLENDER
from .pt_br import KINDS, OPERATORS, SOLVER, STAGES, TEXTS

CONTEXT = "LuzEspecular"
"""Context of the names of properties and of the items to choose from."""

_CONTEXTS = ("*", CONTEXT, "Operator")  # the last is asked where a button has a text of its own

_BASE = __package__.rsplit(".", 2)[0]


def table() -> dict[str, dict[tuple[str, str], str]]:
    """Return the translations as Blender registers them."""
    everywhere = TEXTS | STAGES | KINDS | SOLVER
    texts = {(context, english): text for context in _CONTEXTS for english, text in everywhere.items()}
    texts |= {("Operator", english): text for english, text in OPERATORS.items()}
    return {"pt_BR": texts}


def solver_message(said: Exception | str) -> str:
    """Return what the solver refuses or remarks, in Blender's words and the interface's language where they are known.

    The solver knows English alone: its message is matched with the templates that have translations, and what stood in
    the places of their {fields} goes into the translation. A lack of memory, which says nothing itself, is named.
    """
    if isinstance(said, MemoryError):
        return rpt_("There is not enough memory: choose a coarser fineness, or a larger largest face")
    said = str(said)
    known = _known(said)
    for end in re.finditer("; ", said) if known is None else ():  # a finding's message and its remedy
        parts = _known(said[: end.start()]), _known(said[end.end() :])
        if None not in parts:
            return "; ".join(parts)
    return known or said


def _known(said: str) -> str | None:
    """Return the translation of what the templates know, also of what stands in their fields; None of all else."""
    for template, pattern in _PATTERNS:
        match = pattern.fullmatch(said)
        if match:
            fields = {name: _known(value) or value for name, value in match.groupdict().items()}
            return rpt_(IN_BLENDER.get(template, template)).format(**fields)
    return None


def _pattern(template: str) -> re.Pattern[str]:
    fields = re.sub(r"\\{(\w+)\\}", r"(?P<\1>.+?)", re.escape(template))
    return re.compile(fields.replace("(?P<more>.+?)", r"(?P<more>( \(.+\))?)"), re.DOTALL)


SAID_BY_SOLVER = (*(text for text in SOLVER if text not in IN_BLENDER.values()), *IN_BLENDER)
"""Templates of all that is known of what the solver says."""

_PATTERNS = tuple((template, _pattern(template)) for template in SAID_BY_SOLVER)


def register() -> None:
    """Add the translations."""
    bpy.app.translations.register(_BASE, table())


def unregister() -> None:
    """Take the translations away."""
    bpy.app.translations.unregister(_BASE)
