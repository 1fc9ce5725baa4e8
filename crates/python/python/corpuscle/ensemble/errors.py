"""Errors of `corpuscle.ensemble`, and the import of optional packages."""

from __future__ import annotations

import importlib
from typing import Any

import corpuscle

__all__ = ["EnsembleError", "MissingPackage", "WorkerLost", "require"]


class EnsembleError(corpuscle.Error):
    """Error of an ensemble: of its plan, its folder, its workers or a statistic.

    Attributes
    ----------
    message : str
        What is wrong, and where.
    key : str or None
        The plan's column (a dotted scene key) that the error is about.
    line : int or None
        Always None; present because `corpuscle.Error` has it.
    remedy : str or None
        What to do.
    """

    message: str = ""
    key: str | None = None
    line: int | None = None
    remedy: str | None = None

    def __init__(self, message: str, *, key: str | None = None, remedy: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.key = key
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.message}\n{self.remedy}" if self.remedy else self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), self.message, self.key, self.remedy)


def _rebuild(kind: type[EnsembleError], message: str, key: str | None, remedy: str | None) -> EnsembleError:
    return kind(message, key=key, remedy=remedy)


class MissingPackage(EnsembleError, ImportError):
    """Error of a Python package that is needed and not installed."""


class WorkerLost(EnsembleError):
    """Error of an executor whose worker ended, or whose futures were cancelled, before all members were done."""


def require(module: str, use: str, install: str = "corpuscle[ensemble]") -> Any:
    """The imported module, or `MissingPackage` with the command that installs it.

    `use` completes the sentence "... needs the package ...".
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        if error.name is not None and error.name.partition(".")[0] != package:
            raise
        raise MissingPackage(
            f"{use} needs the Python package {package}, which is not installed.",
            remedy=f"Install it with: pip install {install}",
        ) from error
