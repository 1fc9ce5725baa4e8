"""Running the members of an ensemble on an executor."""

from __future__ import annotations

import operator
import os
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import corpuscle

from .errors import EnsembleError, WorkerLost
from .folder import Folder
from .member import Member, Task, compute, record_failure
from .plans import Plan
from .results import Ensemble, Statistics

if TYPE_CHECKING:
    import pandas

__all__ = ["Progress", "run"]

# Where the executor does not tell its number of workers.
_PENDING = 64
# Time that a network file system may take until a worker's file is seen here.
_SEEN_WITHIN_S = 60.0


@dataclass(frozen=True)
class Progress:
    """Numbers of members: finished, failed (so far), and in the plan."""

    finished: int
    failed: int
    members: int


def run(
    scene: corpuscle.Scene | str | os.PathLike[str],
    plan: pandas.DataFrame,
    folder: str | os.PathLike[str],
    executor: Executor | None = None,
    *,
    members: Iterable[int] | None = None,
    statistics: Statistics | None = None,
    threads: int = 1,
    retries: int = 0,
    pending: int | None = None,
    progress: Callable[[Progress], object] | bool | None = None,
) -> Ensemble:
    """Runs the members of a plan that are not finished yet, and returns the ensemble.

    Each member is the scene with one row's changes. Its files appear in ``folder/members/NNNNNN/``, complete or not at
    all, so a call that was interrupted is continued by the same call. Members that failed are run again.

    Parameters
    ----------
    scene : corpuscle.Scene, str or path
        The scene, or a source of one: a built-in name, a scene file, or TOML text.
    plan : pandas.DataFrame
        One row for each member, one column for each dotted scene key; see `grid`, `latin_hypercube` and `sobol`. Members
        are numbered by rows from 0; the table's index does not matter.
    folder : path
        Folder of the ensemble: a new or empty one, or that of the same scene and plan. Workers on other machines must see
        it under the same absolute path. Calls that run at the same time must have different `members`.
    executor : concurrent.futures.Executor, optional
        Where members run: a ThreadPoolExecutor, a ProcessPoolExecutor, dask.distributed's ``client.get_executor()``,
        mpi4py.futures' MPIPoolExecutor, or any other with `submit` and futures. None is this thread, one member after
        another. The files are the same for any.
    members : iterable of int, optional
        Numbers of the members that this call runs, if they are not finished: by default all of the plan. Each task of a job array names its own.
    statistics : Statistics, optional
        Which statistics `Ensemble.report` and `Ensemble.to_netcdf` have. They are stored, and can be changed by a later call.
    threads : int
        Threads of each simulation, at least 1. The results do not depend on it.
    retries : int
        How often a member that fails is run again within this call.
    pending : int, optional
        Largest number of members handed to the executor at once: by default twice its workers, or 64 where it does not
        tell them.
    progress : callable or bool, optional
        Called with a `Progress` after each member. True prints a line to standard error instead.

    Returns
    -------
    Ensemble
        Members that failed are in `Ensemble.failed` with their errors.

    Raises
    ------
    EnsembleError
        For a wrong plan, and for a folder that holds another plan, another scene, or something else.
    WorkerLost
        Where a worker ended or a future was cancelled. All members that had finished are kept.
    OSError
        Where a file could not be written.
    KeyboardInterrupt
        After Ctrl-C: no further member is submitted. Those that workers have begun are kept if they finish.
    """
    if threads < 1 or retries < 0 or (pending is not None and pending < 1):
        raise EnsembleError(
            f"threads is {threads}, retries {retries}, pending {pending}; threads and pending must be at least 1, retries at least 0."
        )
    checked = Plan.of(plan)
    scene = scene if isinstance(scene, corpuscle.Scene) else corpuscle.Scene(os.fspath(scene))
    place = Folder.prepare(Path(folder), scene, checked)
    if statistics is not None:
        place.keep_statistics(statistics.stored())
    work = _Work(scene, place, _chosen(members, len(checked.rows)), threads, retries, progress)
    if executor is None:
        work.here()
    else:
        executor = executor.get_executor() if hasattr(executor, "get_executor") else executor
        work.on(executor, pending or _default_pending(executor))
    return Ensemble(place)


class _Work:
    """The members still to run, and what became of the others."""

    def __init__(
        self,
        scene: corpuscle.Scene,
        place: Folder,
        chosen: range | set[int],
        threads: int,
        retries: int,
        progress: Callable[[Progress], object] | bool | None,
    ) -> None:
        self._scene, self._place, self._threads, self._retries = scene, place, threads, retries
        self._progress = _print if progress is True else (progress or None)
        self._attempts: dict[int, int] = {}
        self._tries: dict[int, int] = {}
        self._queue: deque[int] = deque()
        self._failed: set[int] = set()
        self._lost: list[int] = []
        self._members = len(place.plan.rows)
        self._finished = 0
        for number, record in enumerate(place.records()):
            if record is not None and record.finished:
                self._finished += 1
            elif number in chosen:
                self._attempts[number] = 0 if record is None else record.attempts
                self._queue.append(number)

    def here(self) -> None:
        """Runs the members in this thread, one after another."""
        while self._queue:
            self._settle(compute(self._task(self._queue.popleft())))

    def on(self, executor: Executor, pending: int) -> None:
        """Runs the members on an executor, at most `pending` submitted at once."""
        submitted: dict[Future[Member], Task] = {}
        try:
            while self._queue or submitted:
                while self._queue and len(submitted) < pending:
                    task = self._task(self._queue[0])
                    submitted[executor.submit(compute, task)] = task
                    self._queue.popleft()
                done, _ = wait(submitted, return_when=FIRST_COMPLETED)
                for future in sorted(done, key=lambda future: submitted[future].member):
                    self._take(future, submitted[future])
                    del submitted[future]
        except BrokenExecutor as error:
            raise self._broken(error, submitted) from error
        finally:
            for future in submitted:
                future.cancel()
        if self._lost:
            raise WorkerLost(
                f"The executor cancelled {_numbered(self._lost)} of the ensemble in {self._place.path}; {self._kept()}",
                remedy="Call run again with the same arguments and a working executor; it continues from there.",
            )

    def _task(self, number: int) -> Task:
        self._attempts[number] += 1
        self._tries[number] = self._tries.get(number, 0) + 1
        changes = self._place.plan.changes(number)
        return Task(self._scene, number, changes, str(self._place.member(number)), self._threads, self._attempts[number])

    def _take(self, future: Future[Member], task: Task) -> None:
        """Takes a future's member, or its error."""
        try:
            record = future.result()
        except (BrokenExecutor, KeyboardInterrupt, OSError):
            raise
        except Exception as error:
            if isinstance(error, CancelledError) or type(error).__name__ in ("CancelledError", "FutureCancelledError"):
                self._lost.append(task.member)
                return
            if type(error).__name__ != "KilledWorker":  # dask: the member ended several workers
                raise EnsembleError(
                    f"The executor could not run member {task.member} of the ensemble in {self._place.path}: "
                    f"{type(error).__name__}: {error}; {self._kept()}",
                    remedy="See that the workers have the same packages installed and that the executor is open, then call run again.",
                ) from error
            record = record_failure(task, error)
        self._await_record(task.member)
        self._settle(record)

    def _await_record(self, number: int) -> None:
        """Waits until the member's record is seen here."""
        end = time.monotonic() + _SEEN_WITHIN_S
        while self._place.record(number) is None:
            if time.monotonic() > end:
                raise EnsembleError(
                    f"A worker has run member {number}, but {self._place.member(number)} is not on this machine.",
                    remedy="Name a folder that all workers and this machine see under the same absolute path.",
                )
            time.sleep(0.2)

    def _settle(self, record: Member) -> None:
        if record.finished:
            self._finished += 1
            self._failed.discard(record.number)
        elif self._tries[record.number] <= self._retries:
            self._queue.append(record.number)
            return
        else:
            self._failed.add(record.number)
        if self._progress is not None:
            self._progress(Progress(self._finished, len(self._failed), self._members))

    def _broken(self, error: BaseException, submitted: dict[Future[Member], Task]) -> WorkerLost:
        """The error of an executor that ended; counts what its workers had finished."""
        running = sorted(task.member for task in submitted.values())
        records = list(self._place.records())
        self._finished = sum(record is not None and record.finished for record in records)
        unfinished = [number for number in running if records[number] is None]
        return WorkerLost(
            f"A worker of the ensemble in {self._place.path} ended before its member was done "
            f"({type(error).__name__}: {error}). Submitted and not done: {_numbered(unfinished)}; {self._kept()}",
            remedy="A worker is ended by the system when memory is short, among other causes: use fewer workers if so. "
            "Call run again with the same arguments and a new executor; it continues from there.",
        )

    def _kept(self) -> str:
        return f"{self._finished} of {self._members} members are finished and kept."


def _chosen(members: Iterable[int] | None, count: int) -> range | set[int]:
    if members is None:
        return range(count)
    chosen = {operator.index(member) for member in members}
    if wrong := sorted(member for member in chosen if not 0 <= member < count):
        raise EnsembleError(f"The plan has no member {wrong[0]}: they are numbered from 0 to {count - 1}.", remedy="Name members of the plan.")
    return chosen


def _default_pending(executor: Any) -> int:
    """Twice the number of the executor's workers."""
    workers = getattr(executor, "_max_workers", None) or getattr(executor, "num_workers", None)
    client = getattr(executor, "_client", None)
    if not isinstance(workers, int) and client is not None and hasattr(client, "nthreads"):
        workers = sum(client.nthreads().values())
    return 2 * workers if isinstance(workers, int) and workers > 0 else _PENDING


def _numbered(members: list[int]) -> str:
    if not members:
        return "no member"
    shown = ", ".join(map(str, sorted(members)[:10]))
    return f"member{'s' if len(members) > 1 else ''} {shown}{' and more' if len(members) > 10 else ''}"


def _print(progress: Progress) -> None:
    failed = f", {progress.failed} failed" if progress.failed else ""
    print(f"{progress.finished} of {progress.members} members finished{failed}", file=sys.stderr, flush=True)
