"""Exceptions."""

from __future__ import annotations


class Error(Exception):
    """What went wrong, where, and what to do.

    Attributes
    ----------
    message : str
        The whole text.
    key : str or None
        The key of the scene at fault, such as ``"flood.manning"``.
    line : int or None
        The line of the scene's text, counted from 1.
    remedy : str or None
        The part of the message that says what to do.
    """

    def __init__(self, message: str, key: str | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.key = key or None
        self.line = line
        first = message.split("\n", 1)[0]
        self.remedy = first.split("; ", 1)[1] if "; " in first else None

    def __reduce__(self) -> tuple:
        # Attributes are kept when an executor hands the exception from one process to another.
        return type(self), (self.message, self.key, self.line)


class SceneError(Error, ValueError):
    """The input was refused: a scene, a key, a value, an array or a file."""


class RunError(Error, RuntimeError):
    """An accepted run failed, or a call came at the wrong moment."""
