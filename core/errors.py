"""Exceptions that users meet: each message names the object at fault and the remedy."""


class LuzEspecularError(Exception):
    """Base of every error that this package raises on purpose."""


class SceneError(LuzEspecularError, ValueError):
    """Bad input (scene, material, light or option); raised before work starts."""


class Cancelled(LuzEspecularError):
    """The progress callback asked to stop; nothing was changed."""


class TransferFileError(LuzEspecularError):
    """A saved transfer that is stale, damaged, or none at all; the message names the file and the remedy."""
