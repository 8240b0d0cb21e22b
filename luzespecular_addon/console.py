"""Blender's console: what the solver logs is shown as findings, and would be printed there once more, in English."""

from __future__ import annotations

import logging

from .. import core as luz

_HANDLER = logging.NullHandler()


def register() -> None:
    """Keep Python from printing what nobody else handles."""
    logging.getLogger(luz.__name__).addHandler(_HANDLER)


def unregister() -> None:
    """Leave the log as it was."""
    logging.getLogger(luz.__name__).removeHandler(_HANDLER)
