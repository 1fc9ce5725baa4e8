"""Values of Python as TOML."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from ._errors import SceneError


def written(key: str, value: Any) -> str:
    """A value as it is written in a scene.

    Numbers, truth values, text, paths, lists, mappings and arrays of NumPy are understood.

    Raises
    ------
    SceneError
        For anything else, and for numbers that are not finite.
    """
    if hasattr(value, "tolist"):  # a scalar or an array of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(key, value)
    if isinstance(value, (str, os.PathLike)):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_word(name)} = {written(key, item)}" for name, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(written(key, item) for item in value) + "]"
    kind = type(value).__name__
    raise SceneError(f"{key}: a {kind} cannot be written in a scene; give a number, text, a list or a dict", key)


def _number(key: str, value: float) -> str:
    if value != value or value in (float("inf"), float("-inf")):
        raise SceneError(f"{key} = {value}: this is no finite number; give one", key)
    return repr(value)


def _text(value: str) -> str:
    # A basic string of TOML has the escapes of JSON; the one character that JSON leaves is not allowed in TOML.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _word(name: str) -> str:
    plain = name.replace("_", "").replace("-", "")
    return name if plain.isascii() and plain.isalnum() else _text(name)
