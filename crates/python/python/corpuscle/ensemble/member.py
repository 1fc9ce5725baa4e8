"""One member of an ensemble: its run in a worker, and its files."""

from __future__ import annotations

import csv
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import corpuscle

from .errors import EnsembleError
from .._files import read_json, remove_remains, replacing, write_json

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = ["Failure", "Member", "Task", "compute", "record_failure"]

MAPS, GAUGES, RECORD = "maps.npz", "gauges.csv", "member.json"
# Names of the axes in the file of maps.
X, Y = "axis:x", "axis:y"
_FORMAT = 1


@dataclass(frozen=True)
class Task:
    """What a worker needs to run one member. It can be pickled if the scene can."""

    scene: corpuscle.Scene
    member: int
    changes: dict[str, Any]
    folder: str
    threads: int
    attempt: int


@dataclass(frozen=True)
class Failure:
    """Error that ended a member: its type, and what `corpuscle.Error` tells."""

    type: str
    message: str
    key: str | None = None
    line: int | None = None
    remedy: str | None = None

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        """The failure that an exception tells of."""
        key, line, remedy = (getattr(error, name, None) for name in ("key", "line", "remedy"))
        message = getattr(error, "message", None) or str(error) or type(error).__name__
        return cls(
            type(error).__name__,
            str(message),
            None if key is None else str(key),
            line if isinstance(line, int) else None,
            None if remedy is None else str(remedy),
        )

    @property
    def what(self) -> str:
        """The message without the remedy, which some messages end with."""
        return self.message.removesuffix(self.remedy).rstrip("; \n") if self.remedy else self.message

    @property
    def where(self) -> str:
        """The key and the line, as far as they are known."""
        return ", ".join(part for part in (self.key, None if self.line is None else f"line {self.line}") if part)

    def __str__(self) -> str:
        where = f" ({self.where})" if self.where else ""
        remedy = f" {self.remedy}" if self.remedy and self.remedy not in self.message else ""
        return f"{self.type}: {self.message}{where}{remedy}"


@dataclass(frozen=True)
class Member:
    """A member's record, the content of `member.json`, which is written after the member's other files."""

    number: int
    status: str
    changes: dict[str, Any]
    attempts: int = 1
    error: Failure | None = None
    wall_time_s: float | None = None
    last_time_s: float | None = None
    version: str | None = None
    summary: dict[str, Any] | None = None
    final_gauges: dict[str, float | None] | None = None
    maps: dict[str, dict[str, Any]] | None = None
    coordinates: dict[str, dict[str, Any]] | None = None
    crs: str | None = None

    @property
    def finished(self) -> bool:
        """Whether the member's run came to its end and its files are complete."""
        return self.status == "finished"

    @classmethod
    def read(cls, folder: Path) -> Member | None:
        """The record in a member's folder; None where there is none."""
        try:
            content = read_json(folder / RECORD)
        except FileNotFoundError:
            return None
        except ValueError as error:
            raise EnsembleError(f"{folder / RECORD} is damaged: {error}.", remedy=f"Remove {folder} and call run again.") from error
        if content.pop("format") != _FORMAT:
            raise EnsembleError(
                f"{folder / RECORD} was written by another version of corpuscle.",
                remedy="Read it with that version, or run the ensemble in a new folder.",
            )
        failure = content.pop("error")
        return cls(**content, error=None if failure is None else Failure(**failure))

    def write(self, folder: Path) -> None:
        """Writes the record into the member's folder."""
        write_json(folder / RECORD, {"format": _FORMAT, **asdict(self)})


def compute(task: Task) -> Member:
    """Runs a member and writes its files; a run that fails is recorded as failed.

    Raises
    ------
    OSError
        Where a file could not be written.
    """
    folder = Path(task.folder)
    folder.mkdir(parents=True, exist_ok=True)
    remove_remains(folder)
    started = time.perf_counter()
    record = Member(task.member, "finished", task.changes, task.attempt, version=getattr(corpuscle, "__version__", None))
    try:
        summary, gauges, maps = _simulate(task)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # a panic of the native part is no Exception
        record = replace(record, status="failed", error=Failure.of(error))
    else:
        record = replace(_with_results(record, gauges, maps), summary=summary)
        _write_results(folder, gauges, maps)
    record = replace(record, wall_time_s=time.perf_counter() - started)
    record.write(folder)
    return record


def record_failure(task: Task, error: BaseException) -> Member:
    """Records as failed a member whose worker could not tell its error."""
    folder = Path(task.folder)
    folder.mkdir(parents=True, exist_ok=True)
    record = Member(task.member, "failed", task.changes, task.attempt, Failure.of(error))
    record.write(folder)
    return record


def _simulate(task: Task) -> tuple[dict[str, Any], pandas.DataFrame, xarray.Dataset]:
    simulation = corpuscle.Simulation(task.scene.changed(**task.changes), threads=task.threads)
    summary = simulation.run(output=None, progress=False)
    maps = simulation.maps()
    for name, values in maps.data_vars.items():
        if set(values.dims) != {"y", "x"}:
            raise EnsembleError(f"The map {name} has the dimensions {values.dims}; a map has y and x.")
    return summary, simulation.gauges(), maps


def _with_results(record: Member, gauges: pandas.DataFrame, maps: xarray.Dataset) -> Member:
    crs = maps.attrs.get("crs_wkt") or maps.attrs.get("crs")
    has_rows = len(gauges) > 0
    return replace(
        record,
        last_time_s=float(gauges.index[-1]) if has_rows else None,
        final_gauges={str(name): float(gauges[name].iloc[-1]) for name in gauges.columns} if has_rows else {},
        maps={str(name): dict(values.attrs) for name, values in maps.data_vars.items()},
        coordinates={name: dict(maps[name].attrs) for name in ("x", "y") if name in maps.coords},
        crs=None if crs is None else str(crs),
    )


def _write_results(folder: Path, gauges: pandas.DataFrame, maps: xarray.Dataset) -> None:
    if maps.data_vars:
        arrays = {str(name): values.transpose("y", "x").to_numpy() for name, values in maps.data_vars.items()}
        arrays = {name: np.ascontiguousarray(values, np.float32) for name, values in arrays.items()}
        axes = {axis: np.asarray(maps[name].to_numpy(), np.float64) for axis, name in ((X, "x"), (Y, "y"))}
        with replacing(folder / MAPS) as part:
            np.savez_compressed(part, **arrays, **axes)  # type: ignore[arg-type]
    with replacing(folder / GAUGES) as part:
        gauges.to_csv(part, index_label="time_s", lineterminator="\n")


def read_maps(folder: Path, *names: str) -> list[NDArray[Any]]:
    """A member's maps, shape (rows, columns), or its axes: `X` and `Y`, the x and y of the cell centres."""
    path = folder / MAPS
    name = ""
    try:
        with np.load(path, allow_pickle=False) as arrays:
            return [arrays[name := wanted] for wanted in names]
    except KeyError:
        raise EnsembleError(
            f"{path} has no map {name}, which other members have.",
            remedy="Ask for a map that all members have, or give all members the same settings of what is measured.",
        ) from None
    except (OSError, ValueError, EOFError) as error:
        raise _damaged(path, error) from error
    except Exception as error:
        if type(error).__name__ not in ("BadZipFile", "error"):  # zipfile's and zlib's
            raise
        raise _damaged(path, error) from error


def read_gauge(folder: Path, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times in s and values of a member's gauge."""
    path = folder / GAUGES
    try:
        with path.open(encoding="utf-8", newline="") as file:
            headings, *rows = csv.reader(file)
    except (OSError, ValueError) as error:
        raise _damaged(path, error) from error
    if name not in headings:
        raise EnsembleError(f"{path} has no column {name}, which other members have.", remedy="Ask for a gauge that all members have.")
    column = headings.index(name)
    try:
        # An empty cell is a time at which the gauge has no value.
        table = np.array([(float(row[0]), float(row[column] or "nan")) for row in rows], np.float64).reshape(-1, 2)
    except (ValueError, IndexError) as error:
        raise _damaged(path, error) from error
    return table[:, 0], table[:, 1]


def _damaged(path: Path, error: Exception) -> EnsembleError:
    return EnsembleError(
        f"{path} cannot be read: {error}.", remedy=f"Remove {path.parent} and call run again, which computes this member anew."
    )
