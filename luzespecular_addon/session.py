"""What was prepared and solved last, kept while Blender runs.

With the transfer another hour or sky needs no new preparation; with the result more can be shown of it.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING

from .. import core as luz

if TYPE_CHECKING:
    from .export import Export
    from .scene_check import Place


class Session:
    """Holds one prepared transfer and what it was prepared for.

    Attributes
    ----------
    places : list of tuple of scene_check.Place
        Where in the user's objects the findings in the panel are.
    """

    def __init__(self):
        self._key: Hashable = None
        self._transfer: luz.Transfer | None = None
        self._result: tuple[tuple[str, int], Export, luz.Result] | None = None
        self._runs = 0
        self.places: list[tuple[Place, ...]] = []

    def get(self, key: Hashable) -> luz.Transfer | None:
        """Return the transfer prepared for the same geometry, materials and options, if it is the one kept."""
        return self._transfer if self._transfer is not None and self._key == key else None

    def keep(self, key: Hashable, transfer: luz.Transfer) -> None:
        """Keep a transfer in place of the one before."""
        self._key, self._transfer = key, transfer

    def forget(self) -> None:
        """Let go of the transfer and the result, and their memory, and of what was found."""
        self._key = self._transfer = self._result = None
        self.places = []

    def result_of(self, scene_name: str, run: int) -> tuple[Export, luz.Result] | None:
        """Return the result that a scene shows and what it was solved for, if it is the one kept.

        Parameters
        ----------
        scene_name : str
        run : int
            What `keep_result` returned when the result was shown; after an undo it is that of an earlier one.
        """
        kept = self._result
        return kept[1:] if kept is not None and kept[0] == (scene_name, run) else None

    def keep_result(self, scene_name: str, export: Export, result: luz.Result) -> int:
        """Keep the result that a scene shows in place of the one before; return a number that tells it from others."""
        self._runs += 1
        self._result = ((scene_name, self._runs), export, result)
        return self._runs

    def forget_result(self) -> None:
        """Let go of the result."""
        self._result = None


current = Session()
"""The session of this Blender; cleared when another file is loaded."""
