"""The folder of an ensemble: its scene, its plan, and a folder for each member."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import corpuscle

from .errors import EnsembleError
from .._files import is_remains, read_json, remove_remains, write_json, write_text
from .member import Member
from .plans import Plan

__all__ = ["Folder"]

_ABOUT, _SCENE, _PLAN, _MEMBERS, _INPUTS = "ensemble.json", "scene.toml", "plan.csv", "members", "inputs"
_FORMAT = 1


@dataclass(frozen=True)
class Folder:
    """An ensemble's folder on disk.

    It has `ensemble.json` (version of the format, chosen statistics), `scene.toml`, `plan.csv`, and for each member
    that was run `members/NNNNNN/` with `maps.npz`, `gauges.csv` and `member.json`. Arrays that the scene was
    given for files are in `inputs`.
    """

    path: Path
    scene: str
    plan: Plan

    @classmethod
    def open(cls, path: Path) -> Folder:
        """The folder of an existing ensemble."""
        path = path.absolute()
        _check_format(path)
        try:
            return cls(path, _read(path / _SCENE), Plan.from_csv(_read(path / _PLAN)))
        except FileNotFoundError as error:
            raise EnsembleError(
                f"The ensemble in {path} has no {Path(error.filename).name}.",
                remedy="Call run with its scene and plan again.",
            ) from error

    @classmethod
    def prepare(cls, path: Path, scene: corpuscle.Scene, plan: Plan) -> Folder:
        """The folder for a scene and a plan: a new one, or the one that has both already.

        Raises
        ------
        EnsembleError
            Where the folder holds something else.
        """
        path = path.absolute()
        if path.exists() and not path.is_dir():
            raise EnsembleError(f"{path} is a file, not a folder.", remedy="Name another folder.")
        path.mkdir(parents=True, exist_ok=True)
        if not (path / _ABOUT).exists():
            # Another task of a job array may make the folder at the same moment.
            own = (_ABOUT, _SCENE, _PLAN, _MEMBERS, _INPUTS)
            names = (entry.name for entry in path.iterdir())
            if others := sorted(name for name in names if name not in own and not is_remains(name)):
                raise EnsembleError(
                    f"The folder {path} is no ensemble's: it holds {', '.join(others[:3])}{' and more' if len(others) > 3 else ''}.",
                    remedy="Name another folder, or empty this one.",
                )
            write_json(path / _ABOUT, {"format": _FORMAT, "name": str(scene.name), "statistics": None})
        _check_format(path)
        remove_remains(path)
        text = _scene_text(scene, path)
        _store(path / _SCENE, text, lambda stored: _scene_difference(stored, text), path, "scene")
        _store(path / _PLAN, plan.csv(), lambda stored: Plan.from_csv(stored).difference(plan), path, "plan")
        return cls(path, text, plan)

    def about(self) -> dict[str, Any]:
        """The content of `ensemble.json`."""
        return read_json(self.path / _ABOUT)

    def keep_statistics(self, statistics: dict[str, Any]) -> None:
        """Stores the chosen statistics."""
        write_json(self.path / _ABOUT, {**self.about(), "statistics": statistics})

    def member(self, number: int) -> Path:
        """The folder of a member."""
        return self.path / _MEMBERS / f"{number:06d}"

    def record(self, number: int) -> Member | None:
        """The record of a member; None where it has not been run to an end."""
        record = Member.read(self.member(number))
        if record is not None and (record.number != number or record.changes != self.plan.changes(number)):
            raise EnsembleError(
                f"{self.member(number)} holds another member: its changes are not those of row {number} of the plan.",
                remedy=f"Remove {self.member(number)} and call run again.",
            )
        return record

    def records(self) -> Iterator[Member | None]:
        """The records of all members in order."""
        return (self.record(number) for number in range(len(self.plan.rows)))


def _check_format(path: Path) -> None:
    try:
        about = read_json(path / _ABOUT)
    except FileNotFoundError:
        raise EnsembleError(
            f"{path} is no ensemble's folder: it has no {_ABOUT}.", remedy="Name the folder that was given to run."
        ) from None
    except ValueError as error:
        raise EnsembleError(f"{path / _ABOUT} is damaged: {error}.") from error
    if about.get("format") != _FORMAT:
        raise EnsembleError(
            f"The ensemble in {path} was written by another version of corpuscle.",
            remedy="Use that version, or name another folder.",
        )


def _store(path: Path, text: str, difference: Any, folder: Path, what: str) -> None:
    """Writes the text, or refuses where another is stored."""
    if not path.exists():
        write_text(path, text)
        return
    if (how := difference(_read(path))) is not None:
        raise EnsembleError(
            f"The folder {folder} holds an ensemble of another {what}: {how}.",
            remedy=f"Name another folder for this {what}, or remove {folder} if its members are no longer needed.",
        )


def _scene_text(scene: corpuscle.Scene, path: Path) -> str:
    """The scene as TOML; arrays that stand for files are written into the ensemble's folder."""
    if getattr(scene, "_has_files", False):
        return str(scene._parsed(path / _INPUTS).toml)  # type: ignore[attr-defined]
    return str(scene.toml)


def _scene_difference(stored: str, given: str) -> str | None:
    if stored == given:
        return None
    left, right = stored.splitlines(), given.splitlines()
    for number, (mine, theirs) in enumerate(zip(left, right, strict=False), start=1):
        if mine != theirs:
            return f"line {number} of {_SCENE} is `{mine.strip()}` in the stored scene, `{theirs.strip()}` in the given one"
    return f"the stored {_SCENE} has {len(left)} lines, the given scene {len(right)}"


def _read(path: Path) -> str:
    return path.read_bytes().decode("utf-8")
