"""Files that are written whole or not at all."""

from __future__ import annotations

import contextlib
import json
import math
import os
import socket
import time
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["is_remains", "plain", "read_json", "remove_remains", "replacing", "write_json", "write_text"]

_REMAINS = ".part-"
# A file is written within seconds: remains that are older are of a process that was killed, on whatever machine.
_REMAINS_AGE_S = 3600.0


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary path beside `path`, which takes the place of `path` when the block ends without an error.

    The temporary name ends as `path` does, because some writers choose the format by the ending.
    """
    part = path.with_name(f"{_REMAINS}{_host()}-{os.getpid()}-{uuid.uuid4().hex}-{path.name}")
    try:
        yield part
        with part.open("rb+") as file:
            os.fsync(file.fileno())
        os.replace(part, path)
        _sync_folder(path.parent)
    finally:
        part.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Writes a text file in UTF-8 with line ends as in `text`."""
    with replacing(path) as part:
        part.write_bytes(text.encode("utf-8"))


def write_json(path: Path, value: Any) -> None:
    """Writes a JSON file. Numbers that are not finite become null, which JSON has in their place."""
    write_text(path, json.dumps(plain(value), indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def read_json(path: Path) -> Any:
    """The content of a JSON file."""
    return json.loads(path.read_text(encoding="utf-8"))


def plain(value: Any) -> Any:
    """The value in the types of JSON: NumPy numbers and arrays become Python's, numbers that are not finite None."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(item) for item in value]
    return str(value)


def remove_remains(folder: Path) -> None:
    """Removes temporary files in the folder that were left by killed processes."""
    for part in folder.glob(f"{_REMAINS}*"):
        with contextlib.suppress(OSError):
            if _writer_is_gone(part.name) or time.time() - part.stat().st_mtime > _REMAINS_AGE_S:
                part.unlink()


def _writer_is_gone(name: str) -> bool:
    """Whether the process that wrote a temporary file was on this machine and has ended."""
    host, pid, *_ = name.removeprefix(_REMAINS).split("-")
    if os.name != "posix" or host != _host():
        return False
    try:
        os.kill(int(pid), 0)
    except ProcessLookupError:
        return True
    except (OSError, ValueError):
        return False
    return False


def _host() -> str:
    """The machine's name without hyphens, which part the names of temporary files."""
    return socket.gethostname().replace("-", "_")


def is_remains(name: str) -> bool:
    """Whether a file's name is a temporary one of this module."""
    return name.startswith(_REMAINS)


def _sync_folder(folder: Path) -> None:
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        # Some network file systems cannot sync a folder.
        with contextlib.suppress(OSError):
            os.fsync(descriptor)
    finally:
        os.close(descriptor)
