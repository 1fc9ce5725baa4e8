"""Scenes: what is computed."""

from __future__ import annotations

import copy
import difflib
import os
import shutil
import tempfile
from collections.abc import Mapping
from functools import cache
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Any

from . import _native
from ._errors import SceneError
from ._raster import as_file
from ._toml import written


def scenes() -> list[str]:
    """Names of the built-in scenes, such as ``"flood/valley"``."""
    return [name for name, _ in _native.builtin_scenes()]


class Scene:
    """A scene: a built-in one, a scene file, or TOML text, with changes.

    Parameters
    ----------
    source : str or path
        Name of a built-in scene (`scenes` lists them), path of a scene file, or the text of one (with a line break).
    folder : path, optional
        Folder that relative paths in the scene start from: by default that of the file, else the current one.
    **changes
        Values by their keys, as in ``Scene("flood/valley", **{"flood.manning": 0.04})``. Rows of lists are counted from 0:
        ``"flood.inflow.0.discharge_m3_per_s"``. Numbers, truth values, text, lists, dicts and arrays are understood; where the scene has
        the path of a raster a `Raster` or a two-dimensional `xarray.DataArray` can be given, and a `pandas.DataFrame` where it has that of a table.

    Raises
    ------
    SceneError
        Where the scene is not as it must be; `key` and `line` say where.

    Notes
    -----
    A scene does not change once made; it can be pickled and sent to another process.
    """

    def __init__(self, source: str | os.PathLike[str], *, folder: str | os.PathLike[str] | None = None, **changes: Any) -> None:
        text, name, base = _read(source)
        self._text, self._name = text, name
        self._folder = Path(folder).absolute() if folder is not None else base
        self._changes = {key: _kept(key, value) for key, value in changes.items()}
        self._native = self._parsed()

    def _parsed(self, inputs: Path | None = None) -> _native.Scene:
        """The checked scene; arrays that stand for files are written into a folder, by default one that is removed when Python ends."""
        changes = [(key, written(key, _filed(key, value, inputs))) for key, value in self._changes.items()]
        return _native.Scene(self._text, self._name, self._folder, changes)

    @property
    def _has_files(self) -> bool:
        return any(map(_holds_file, self._changes.values()))

    @property
    def name(self) -> str:
        """Name of the built-in scene or of the file."""
        return self._name

    @property
    def title(self) -> str:
        """The title, in words."""
        return self._native.title

    @property
    def model(self) -> str:
        """The model: ``"gas"``, ``"dew"`` or ``"flood"``."""
        return self._native.model

    @property
    def until(self) -> float:
        """The end of the run, s (in reduced units, of time)."""
        return self._native.until

    @property
    def toml(self) -> str:
        """The whole scene as TOML, with defaults and changes; paths are absolute."""
        return self._native.toml

    @property
    def changes(self) -> dict[str, Any]:
        """The changes that were given; arrays that stand for files as `Raster` or as a table of text."""
        return copy.deepcopy(self._changes)

    def changed(self, **changes: Any) -> Scene:
        """The scene with more changes; a key that was changed before takes the new value.

        Raises
        ------
        SceneError
            As `Scene` does.
        """
        other = object.__new__(Scene)
        kept = {key: _kept(key, value) for key, value in changes.items()}
        other.__setstate__({**self.__getstate__(), "_changes": {**self._changes, **kept}})
        return other

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key != "_native"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._native = self._parsed()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.toml == other.toml

    def __hash__(self) -> int:
        return hash(self.toml)

    def __repr__(self) -> str:
        changes = "".join(f", {key}={value!r}" for key, value in self._changes.items())
        return f"Scene({self._name!r}{changes})"


def _kept(key: str, value: Any) -> Any:
    """The value as it is now: a copy, or what stands for a file."""
    if isinstance(value, Mapping):
        return {name: _kept(f"{key}.{name}", item) for name, item in value.items()}
    try:
        given = as_file(value)
    except SceneError as error:
        raise SceneError(f"{key}: {error.message}", key) from error
    return copy.deepcopy(value) if given is None else given


def _holds_file(kept: Any) -> bool:
    return any(map(_holds_file, kept.values())) if isinstance(kept, Mapping) else as_file(kept) is not None


def _filed(key: str, kept: Any, inputs: Path | None) -> Any:
    """The value with the path of a file in place of each array that stands for one."""
    if isinstance(kept, Mapping):
        return {name: _filed(f"{key}.{name}", item, inputs) for name, item in kept.items()}
    given = as_file(kept)
    if given is None:
        return kept
    folder = inputs or _temporary_folder()
    path = folder / f"{key.replace('.', '_')}_{given.digest}{given._ending}"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        try:
            given.write(path)
        except SceneError as error:
            raise SceneError(f"{key}: {error.message}", key) from error
    return path


@cache
def _temporary_folder() -> Path:
    """The folder of this process for arrays of scenes that are not recorded."""
    folder = Path(tempfile.mkdtemp(prefix="corpuscle-"))
    # Unlike those of `atexit` these run when a worker process ends, and never in a child of the process that asked for them.
    Finalize(None, shutil.rmtree, args=(folder,), kwargs={"ignore_errors": True}, exitpriority=0)
    return folder


# A forked process has a folder of its own: that of its parent goes with the parent.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_temporary_folder.cache_clear)


def _read(source: str | os.PathLike[str]) -> tuple[str, str, Path]:
    """The text of a scene, its name and its folder."""
    given = os.fspath(source)
    builtin = dict(_native.builtin_scenes())
    if given in builtin:
        return builtin[given], given, Path.cwd()
    if "\n" in given:
        return given, "the scene's text", Path.cwd()
    path = Path(given)
    if path.is_file():
        try:
            return path.read_text(encoding="utf-8"), given, path.absolute().parent
        except (OSError, UnicodeDecodeError) as error:
            raise SceneError(f"cannot read the scene {given}: {error}") from error
    near = difflib.get_close_matches(given, builtin, 1)
    meant = f"; did you mean {near[0]}?" if near else ";"
    raise SceneError(f"there is no file and no built-in scene `{given}`{meant} (built in: {', '.join(builtin)})")
