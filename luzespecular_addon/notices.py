"""What the user is told about the scene: errors that stop the work before it starts, warnings, and plain notes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

Level = Literal["ERROR", "WARNING", "INFO"]


@dataclass(frozen=True)
class Notice:
    """One remark, in the user's language, that names the thing and the remedy.

    Attributes
    ----------
    level : "ERROR", "WARNING" or "INFO"
    text : str
    objects : tuple of str
        Names of the objects concerned, where they are known.
    """

    level: Level
    text: str
    objects: tuple[str, ...] = ()


class BadInput(Exception):
    """Raised before work starts; carries every problem found, so that the user sees them all at once.

    Parameters
    ----------
    notices : iterable of Notice
        The problems, errors and warnings.
    """

    def __init__(self, notices: Iterable[Notice]):
        self.notices = tuple(notices)
        super().__init__("\n".join(notice.text for notice in self.notices if notice.level == "ERROR"))


def refuse(text: str) -> BadInput:
    """Return the exception for a single problem."""
    return BadInput([Notice("ERROR", text)])


def about(object_name: str, level: Level, text: str, **values: object) -> Notice:
    """Return a notice about an object, with its name and further values filled into a text."""
    return Notice(level, text.format(name=object_name, **values), (object_name,))


def stop_on_errors(notices: Iterable[Notice]) -> None:
    """Raise `BadInput` if any of the notices is an error."""
    notices = list(notices)
    if any(notice.level == "ERROR" for notice in notices):
        raise BadInput(notices)
