"""The transfer prepared last, kept while Blender runs, so that another hour or sky needs no new preparation."""

from __future__ import annotations

from collections.abc import Hashable

from .. import core as luz


class Session:
    """Holds one prepared transfer and what it was prepared for."""

    def __init__(self):
        self._key: Hashable = None
        self._transfer: luz.Transfer | None = None

    def get(self, key: Hashable) -> luz.Transfer | None:
        """Return the transfer prepared for the same geometry, materials and options, if it is the one kept."""
        return self._transfer if self._transfer is not None and self._key == key else None

    def keep(self, key: Hashable, transfer: luz.Transfer) -> None:
        """Keep a transfer in place of the one before."""
        self._key, self._transfer = key, transfer

    def forget(self) -> None:
        """Let go of the transfer and its memory."""
        self._key = self._transfer = None


current = Session()
"""The session of this Blender; cleared when another file is loaded."""
