"""Tests of `corpuscle.ensemble` with a stand-in for the native package (`fake/corpuscle`).

They need a process of their own: the stand-in takes the place of an installed `corpuscle`.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import signal
import subprocess
import sys
import time
import tracemalloc
import warnings
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray

FAKE = str(Path(__file__).parent / "fake")
assert "corpuscle" not in sys.modules, "run these tests in a process of their own: pytest tests/test_ensemble.py"
sys.path.insert(0, FAKE)
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [FAKE, os.environ.get("PYTHONPATH")]))  # for worker processes

import corpuscle  # noqa: E402
from corpuscle import _files as files  # noqa: E402
from corpuscle import ensemble  # noqa: E402
from corpuscle.ensemble import export, member, streaming  # noqa: E402

LEVELS = ensemble.grid({"flood.level": [0.4, 0.7, 1.0, 1.3], "flood.manning": [0.02, 0.05]})


def digest(folder: Path) -> dict[str, str]:
    """Hashes of the members' results."""
    paths = [path for path in sorted((folder / "members").rglob("*")) if path.suffix in (".npz", ".csv")]
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in paths}


def statistics_bits(result: ensemble.Ensemble) -> list[bytes]:
    return [
        result.probability("max_depth", above=0.3).to_numpy().tobytes(),
        result.percentiles("max_depth", [5, 50, 95]).to_numpy().tobytes(),
        result.percentiles("max_depth", [5, 50, 95], method="histogram").to_numpy().tobytes(),
        result.mean("arrival_time").to_numpy().tobytes(),
        result.standard_error("max_level").to_numpy().tobytes(),
        result.gauges("P1.depth_m").to_numpy().tobytes(),
    ]


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> ensemble.Ensemble:
    """An ensemble of eight members that ran in this process."""
    return ensemble.run("flood/test", LEVELS, tmp_path_factory.mktemp("finished"))


def exact_maps(result: ensemble.Ensemble, name: str) -> np.ndarray:
    """The maps of all finished members, from the model itself."""
    scene = corpuscle.Scene("flood/test")
    rows = [result.plan.loc[number].to_dict() for number in result.finished]
    rows = [{key: getattr(value, "item", lambda value=value: value)() for key, value in row.items()} for row in rows]
    return np.array([corpuscle.Simulation(scene.changed(**row)).maps()[name].to_numpy() for row in rows])


# Plans


def test_grid_has_all_combinations_in_order() -> None:
    plan = ensemble.grid({"a.b": [1, 2], "c": ["x", "y", "z"]})
    assert list(plan.columns) == ["a.b", "c"]
    assert plan.values.tolist() == [[1, "x"], [1, "y"], [1, "z"], [2, "x"], [2, "y"], [2, "z"]]


@pytest.mark.parametrize("sampled", [ensemble.latin_hypercube, ensemble.sobol])
def test_samples_are_in_their_ranges_and_repeat(sampled) -> None:
    stats = pytest.importorskip("scipy.stats")
    ranges = {"a": (2.0, 3.0), "b": stats.norm(10, 1), "c": stats.randint(1, 7)}
    plan = sampled(ranges, 64, 5)
    assert plan.equals(sampled(ranges, 64, 5)) and not plan.equals(sampled(ranges, 64, 6))
    assert plan["a"].between(2, 3).all() and set(plan["c"]) == set(range(1, 7)) and plan["c"].dtype == np.int64
    assert sorted(np.floor((plan["a"] - 2) * 64).astype(int)) == list(range(64))  # one in each stratum
    assert abs(plan["b"].mean() - 10) < 0.1


@pytest.mark.parametrize(
    ("plan", "words"),
    [
        (pandas.DataFrame(), "empty"),
        (pandas.DataFrame({"a": []}), "empty"),
        (pandas.DataFrame({"a": [1.0, math.nan]}), "a of the plan's row 1 is nan"),
        (pandas.DataFrame({"a": [1.0, math.inf]}), "must be a finite number"),
        (pandas.DataFrame({"a": pandas.array([1, None], dtype="Int64")}), "row 1 is missing"),
        (pandas.DataFrame({"a": pandas.to_datetime(["2020-01-01"])}), "Timestamp"),
        (pandas.DataFrame({"a": [1 + 2j]}), "complex"),
        (pandas.DataFrame({"a": [{"b": 1}]}), "dict"),
        (pandas.DataFrame([[1, 2]], columns=["a", "a"]), "two columns a"),
        (pandas.DataFrame({7: [1]}), "named 7"),
        ({"a": [1]}, "must be a pandas.DataFrame"),
    ],
)
def test_wrong_plan_is_refused(plan, words: str, tmp_path: Path) -> None:
    with pytest.raises(ensemble.EnsembleError, match=words.replace("(", r"\(")):
        ensemble.run("flood/test", plan, tmp_path / "e")
    assert not (tmp_path / "e").exists()


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: ensemble.grid({}),
        lambda: ensemble.grid({"a": []}),
        lambda: ensemble.grid({"a": "text"}),
        lambda: ensemble.latin_hypercube({"a": (3, 2)}, 4, 1),
        lambda: ensemble.latin_hypercube({"a": 3}, 4, 1),
        lambda: ensemble.latin_hypercube({"a": (0, math.nan)}, 4, 1),
        lambda: ensemble.latin_hypercube({"a": (0, 1)}, 0, 1),
        lambda: ensemble.sobol({}, 4, 1),
    ],
)
def test_wrong_ranges_are_refused(wrong) -> None:
    with pytest.raises(ensemble.EnsembleError) as caught:
        wrong()
    assert isinstance(caught.value, corpuscle.Error) and caught.value.message


def test_plan_survives_its_file(tmp_path: Path) -> None:
    values = [0.1 + 0.2, 3, True, "text", "3", "true", 'a "quoted", one\nof two lines', [1, [2.5, "x"]], "NaN"]
    plan = ensemble.plans.Plan.of(pandas.DataFrame({"a.b": pandas.Series(values, dtype=object)}))
    back = ensemble.plans.Plan.from_csv(plan.csv())
    assert back == plan and [type(row[0]) for row in back.rows] == [type(value) for value in values]


# Running


def test_statistics_agree_with_all_maps_at_once(finished: ensemble.Ensemble) -> None:
    depth, arrival, level = (exact_maps(finished, name).astype(float) for name in ("max_depth", "arrival_time", "max_level"))
    wet = np.where(np.isnan(depth), 0.0, depth)
    assert 0 < np.isnan(depth).mean() < 1
    np.testing.assert_array_equal(finished.probability("max_depth", above=0.3), (wet > 0.3).mean(axis=0))
    np.testing.assert_array_equal(finished.probability("arrival_time", below=5.0), (arrival < 5.0).mean(axis=0))
    np.testing.assert_allclose(finished.mean("max_depth"), wet.mean(axis=0), rtol=1e-13)
    np.testing.assert_allclose(finished.standard_error("max_depth"), wet.std(axis=0, ddof=1) / np.sqrt(8), rtol=1e-12)
    np.testing.assert_allclose(
        finished.percentiles("max_depth", [0, 5, 50, 95, 100]), np.percentile(wet, [0, 5, 50, 95, 100], axis=0), rtol=1e-13
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        np.testing.assert_allclose(finished.mean("arrival_time"), np.nanmean(arrival, axis=0), rtol=1e-13)
        np.testing.assert_allclose(finished.percentiles("max_level", [30])[0], np.nanpercentile(level, 30, axis=0), rtol=1e-13)
    # Never is above all times: where half of the members stay dry, the median arrival is never.
    never = finished.percentiles("arrival_time", [50])[0].to_numpy()
    dry = np.isnan(arrival).sum(axis=0)
    assert np.isinf(never[dry >= 4]).all() and np.isfinite(never[dry < 4]).all() and (dry < 4).any()


def test_means_tell_units_and_coordinates(finished: ensemble.Ensemble) -> None:
    mean = finished.mean("max_depth")
    assert mean.dims == ("y", "x") and mean.attrs["units"] == "m" and mean.attrs["members"] == 8
    assert float(mean["x"][0]) == 1000.0 and float(mean["y"][1]) == 1990.0 and finished.crs == corpuscle.CRS
    with pytest.raises(ensemble.EnsembleError, match="no map 'depht'") as caught:
        finished.mean("depht")
    assert "max_depth" in caught.value.remedy


def test_gauges(finished: ensemble.Ensemble) -> None:
    table = finished.gauges("P1.depth_m", [10, 90])
    scene = corpuscle.Scene("flood/test")
    rows = finished.plan.to_dict("records")
    values = np.array([corpuscle.Simulation(scene.changed(**row)).gauges()["P1.depth_m"] for row in rows])
    assert table.index.name == "time_s" and list(table) == ["mean", "standard_error", "members", "p10", "p90", "error"]
    np.testing.assert_allclose(table["mean"], values.mean(axis=0), rtol=1e-13)
    np.testing.assert_allclose(table[["p10", "p90"]].T, np.percentile(values, [10, 90], axis=0), rtol=1e-13)
    means = finished.gauge_means()
    assert means.loc["P1.depth_m", "mean"] == pytest.approx(values[:, -1].mean())
    assert means.loc["P1.depth_m", "standard_error"] == pytest.approx(values[:, -1].std(ddof=1) / math.sqrt(8))
    assert finished.summary()["P1.depth_m"].tolist() == values[:, -1].tolist()


def test_gauges_of_runs_of_other_lengths(tmp_path: Path) -> None:
    result = ensemble.run("flood/test", ensemble.grid({"run.until_s": [4.0, 9.0, 6.0]}), tmp_path)
    table = result.gauges("P1.depth_m")
    assert table.index.tolist() == list(range(10))
    assert table["members"].tolist() == [3, 3, 3, 3, 3, 2, 2, 1, 1, 1]
    assert table["mean"].notna().all() and table["standard_error"].isna().tolist() == [False] * 7 + [True] * 3


def test_same_bits_with_threads_and_processes(finished: ensemble.Ensemble, tmp_path: Path) -> None:
    expected = digest(finished.folder)
    assert len(expected) == 16
    for name, executor in (("threads", ThreadPoolExecutor(3)), ("processes", ProcessPoolExecutor(2))):
        with executor:
            result = ensemble.run("flood/test", LEVELS, tmp_path / name, executor)
        assert digest(tmp_path / name) == expected
        assert statistics_bits(result) == statistics_bits(finished)


def test_same_bits_with_dask(finished: ensemble.Ensemble, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        result = ensemble.run("flood/test", LEVELS, tmp_path / "whole", client.get_executor())
        assert digest(tmp_path / "whole") == digest(finished.folder)
        assert statistics_bits(result) == statistics_bits(finished)
        # A worker that dies is replaced, and its member computed by another.
        plan = ensemble.grid({"test.die": ["", str(tmp_path / "died"), ""]})
        assert ensemble.run("flood/test", plan, tmp_path / "died-once", client).finished == [0, 1, 2]
        assert (tmp_path / "died").exists()


def test_killed_and_resumed_gives_the_same_bits(finished: ensemble.Ensemble, tmp_path: Path) -> None:
    scene = corpuscle.Scene("flood/test", **{"test.sleep_s": 0.15})
    LEVELS.to_pickle(tmp_path / "plan")
    script = (
        "import corpuscle, pandas, sys\nfrom corpuscle import ensemble\n"
        "scene = corpuscle.Scene('flood/test', **{'test.sleep_s': 0.15})\n"
        "ensemble.run(scene, pandas.read_pickle(sys.argv[1]), sys.argv[2])\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script, str(tmp_path / "plan"), str(tmp_path / "e")])
    marks = tmp_path / "e" / "members"
    while len(list(marks.glob("*/member.json"))) < 3:
        assert process.poll() is None, "ended before it was killed"
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = {path: path.stat().st_mtime_ns for path in marks.glob("*/member.json")}
    assert 3 <= len(before) < 8
    assert len(ensemble.open(tmp_path / "e").finished) == len(before)
    result = ensemble.run(scene, LEVELS, tmp_path / "e")
    assert all(path.stat().st_mtime_ns == when for path, when in before.items()), "a finished member was run again"
    assert digest(tmp_path / "e") == digest(finished.folder)
    assert statistics_bits(result) == statistics_bits(finished) == statistics_bits(ensemble.open(tmp_path / "e"))


def test_failed_member_is_told_and_others_go_on(tmp_path: Path) -> None:
    plan = ensemble.grid({"test.fail": [False, True, False]})
    seen: list[ensemble.Progress] = []
    with ThreadPoolExecutor(1) as executor:
        result = ensemble.run("flood/test", plan, tmp_path, executor, retries=2, progress=seen.append)
    assert result.finished == [0, 2]
    assert seen[-1] == ensemble.Progress(2, 1, 3) and len(seen) == 3
    error = result.failed[1]
    assert (error.type, error.key, error.line, error.remedy) == ("Error", "flood.level", 7, "Lower it.")
    record = json.loads((tmp_path / "members/000001/member.json").read_text())
    assert record["status"] == "failed" and record["attempts"] == 3 and record["error"]["message"] == error.message
    assert result.summary()["status"].tolist() == ["finished", "failed", "finished"]
    assert "Lower it." in result.summary().loc[1, "error"] and result.mean("max_depth").attrs["members"] == 2
    ensemble.run("flood/test", plan, tmp_path)  # tried again
    assert json.loads((tmp_path / "members/000001/member.json").read_text())["attempts"] == 4


def test_wrong_key_fails_each_member_with_its_remedy(tmp_path: Path) -> None:
    result = ensemble.run("flood/test", ensemble.grid({"flood.maning": [1, 2]}), tmp_path)
    assert list(result.failed) == [0, 1] and result.failed[0].key == "flood.maning"
    with pytest.raises(ensemble.EnsembleError, match="Did you mean flood.manning"):
        result.mean("max_depth")


def test_remedy_that_is_part_of_the_message_is_told_once() -> None:
    failure = ensemble.Failure("SceneError", "flood.maning is not known; did you mean manning?", remedy="did you mean manning?")
    assert str(failure).count("did you mean") == 1
    assert failure.what == "flood.maning is not known"


def test_dead_worker_process_is_told_and_resumed(finished: ensemble.Ensemble, tmp_path: Path) -> None:
    plan = LEVELS.assign(**{"test.die": ["", "", "", str(tmp_path / "died"), "", "", "", ""]})
    with ProcessPoolExecutor(2) as executor, pytest.raises(ensemble.WorkerLost) as caught:
        ensemble.run("flood/test", plan, tmp_path / "e", executor)
    assert isinstance(caught.value.__cause__, BrokenProcessPool)
    kept = ensemble.open(tmp_path / "e").finished
    assert f"{len(kept)} of 8 members are finished and kept" in str(caught.value) and "3" in str(caught.value)
    assert 3 not in kept
    with ProcessPoolExecutor(2) as executor:
        result = ensemble.run("flood/test", plan, tmp_path / "e", executor)
    assert digest(tmp_path / "e") == digest(finished.folder) and len(result.finished) == 8


class Cancelling(ThreadPoolExecutor):
    """An executor that cancels its third future."""

    submitted = 0

    def submit(self, *args, **kwargs):
        self.submitted += 1
        if self.submitted == 3:
            future: Future = Future()
            future.set_exception(CancelledError())
            return future
        return super().submit(*args, **kwargs)


def test_cancelled_future_loses_nothing_else(tmp_path: Path) -> None:
    with Cancelling(1) as executor, pytest.raises(ensemble.WorkerLost, match="member 2.*7 of 8 members are finished"):
        ensemble.run("flood/test", LEVELS, tmp_path, executor)
    assert ensemble.open(tmp_path).finished == [0, 1, 3, 4, 5, 6, 7]


class Counting(ThreadPoolExecutor):
    """An executor that counts the futures that are not done."""

    flying = most = 0

    def submit(self, *args, **kwargs):
        self.flying += 1
        self.most = max(self.most, self.flying)
        future = super().submit(*args, **kwargs)
        future.add_done_callback(lambda _: setattr(self, "flying", self.flying - 1))
        return future


def test_few_futures_at_once(tmp_path: Path) -> None:
    plan = ensemble.grid({"test.sleep_s": [0.005], "flood.level": np.linspace(0.5, 1.5, 30)})
    with Counting(2) as executor:
        ensemble.run("flood/test", plan, tmp_path / "default", executor)
        assert executor.most <= 4
        executor.most = 0
        ensemble.run("flood/test", plan, tmp_path / "seven", executor, pending=7)
        assert 4 < executor.most <= 7


@pytest.mark.parametrize("kind", ["here", "threads", "processes"])
def test_interrupt_keeps_what_is_done(kind: str, tmp_path: Path) -> None:
    plan = ensemble.grid({"flood.level": np.linspace(0.5, 1.5, 40), "test.sleep_s": [0.05]})
    script = (
        "import pandas, sys\nfrom concurrent.futures import *\nfrom corpuscle import ensemble\n"
        "executor = {'here': lambda: None, 'threads': lambda: ThreadPoolExecutor(2), 'processes': lambda: ProcessPoolExecutor(2)}\n"
        "try:\n    ensemble.run('flood/test', pandas.read_pickle(sys.argv[1]), sys.argv[2], executor[sys.argv[3]]())\n"
        "except KeyboardInterrupt:\n    sys.exit(77)\n"
    )
    plan.to_pickle(tmp_path / "plan")
    command = [sys.executable, "-c", script, str(tmp_path / "plan"), str(tmp_path / "e"), kind]
    # A group of its own, whose every process is interrupted, as a terminal does.
    process = subprocess.Popen(command, start_new_session=True, stderr=subprocess.DEVNULL)
    marks = tmp_path / "e" / "members"
    while len(list(marks.glob("*/member.json"))) < 4:
        assert process.poll() is None
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(timeout=20) == 77
    result = ensemble.open(tmp_path / "e")
    assert 4 <= len(result.finished) < 30 and not result.failed
    assert result.mean("max_depth").attrs["members"] == len(result.finished)


# The folder


def test_tasks_of_a_job_array_run_their_own_members_at_once(finished: ensemble.Ensemble, tmp_path: Path) -> None:
    text = """
import sys
from pathlib import Path
from corpuscle import ensemble
plan = ensemble.grid({"flood.level": [0.4, 0.7, 1.0, 1.3], "flood.manning": [0.02, 0.05]})
ensemble.run("flood/test", plan, Path(sys.argv[1]), members=map(int, sys.argv[2:]))
"""
    shares = [["0", "1", "2"], ["3", "4"], ["6", "7"]]
    tasks = [subprocess.Popen([sys.executable, "-c", text, str(tmp_path / "array"), *share]) for share in shares]
    assert [task.wait(timeout=60) for task in tasks] == [0, 0, 0]
    assert ensemble.open(tmp_path / "array").finished == [0, 1, 2, 3, 4, 6, 7]
    whole = ensemble.run("flood/test", LEVELS, tmp_path / "array")
    assert statistics_bits(whole) == statistics_bits(finished)
    with pytest.raises(ensemble.EnsembleError, match="no member 8: they are numbered from 0 to 7"):
        ensemble.run("flood/test", LEVELS, tmp_path / "array", members=[8])


def test_another_plan_or_scene_is_refused(finished: ensemble.Ensemble) -> None:
    before = digest(finished.folder)
    other = LEVELS.copy()
    other.loc[3, "flood.level"] = 0.75
    for plan, words in (
        (other, "flood.level of member 3 is 0.7 in the stored plan, 0.75 in the given one"),
        (LEVELS[:5], "8 members, the given one 5"),
        (LEVELS[["flood.level"]], "has the columns flood.level, flood.manning, the given one flood.level"),
    ):
        with pytest.raises(ensemble.EnsembleError, match=f"another plan: .*{words}") as caught:
            ensemble.run("flood/test", plan, finished.folder)
        assert "Name another folder" in caught.value.remedy
    with pytest.raises(ensemble.EnsembleError, match="another scene: line 3 of scene.toml"):
        ensemble.run(corpuscle.Scene("flood/test", **{"run.until_s": 11.0}), LEVELS, finished.folder)
    assert digest(finished.folder) == before


def test_a_folder_of_something_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("Dear")
    with pytest.raises(ensemble.EnsembleError, match="holds letter.txt"):
        ensemble.run("flood/test", LEVELS, tmp_path)
    with pytest.raises(ensemble.EnsembleError, match="no ensemble's folder"):
        ensemble.open(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


def test_damaged_and_missing_files_are_told(tmp_path: Path) -> None:
    result = ensemble.run("flood/test", LEVELS[:2], tmp_path)
    path = tmp_path / "members/000001/maps.npz"
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(ensemble.EnsembleError, match="000001/maps.npz cannot be read") as caught:
        result.mean("max_depth")
    assert "Remove" in caught.value.remedy


def test_maps_on_other_grids_are_told(tmp_path: Path) -> None:
    result = ensemble.run("flood/test", ensemble.grid({"grid.rows": [12, 13]}), tmp_path)
    with pytest.raises(ensemble.EnsembleError, match="members 0 and 1 .* different grids"):
        result.mean("max_depth")


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    files.write_text(path, "old")
    with pytest.raises(RuntimeError), files.replacing(path) as part:
        part.write_text("half")
        raise RuntimeError
    assert path.read_text() == "old" and [entry.name for entry in tmp_path.iterdir()] == ["a.txt"]


def test_remains_of_a_killed_process_are_removed(tmp_path: Path) -> None:
    script = (
        "import os, signal, sys\nfrom pathlib import Path\nfrom corpuscle import _files as files\n"
        "with files.replacing(Path(sys.argv[1])) as part:\n"
        "    part.write_text('half')\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", script, str(tmp_path / "a.txt")], check=False)
    assert len(list(tmp_path.glob(".part-*"))) == 1
    with files.replacing(tmp_path / "b.txt") as part:
        part.write_text("being written")
        files.remove_remains(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["b.txt"]


# Streaming


@pytest.fixture
def without_fsync(monkeypatch: pytest.MonkeyPatch) -> None:
    """Writes many small members in seconds."""
    monkeypatch.setattr(os, "fsync", lambda _: None)


def source_of(values: np.ndarray) -> streaming.Source:
    return lambda: iter(values)


@pytest.mark.parametrize("absent", [0.0, math.inf, math.nan])
@pytest.mark.parametrize("signed", [False, True])
def test_percentiles_of_a_thousand_within_their_error(absent: float, signed: bool) -> None:
    random = np.random.default_rng(3)
    values = random.lognormal(0, 1, (1000, 60)).astype(np.float32)
    values[:, 20:40] = random.exponential(np.linspace(0.1, 40, 20), (1000, 20))
    values[:, 40] = 2.5  # constant
    if signed:
        values -= 1
    values[random.random(values.shape) < np.linspace(0, 1, 60)] = np.nan
    values[:, 59] = np.nan
    percents = [0, 1, 5, 37.3, 50, 95, 99.9, 100]
    filled = np.where(np.isnan(values), absent, values.astype(float))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ordered = np.sort(filled, axis=0)
        if math.isinf(absent):  # NumPy's interpolation has NaN beside infinity
            position = np.array(percents) / 100 * 999
            below, weight = np.floor(position).astype(int), position % 1
            upper = ordered[np.minimum(below + 1, 999)]
            exact = np.where(weight[:, None] > 0, ordered[below] + weight[:, None] * (upper - ordered[below]), ordered[below])
            exact = np.where(np.isinf(ordered[below]), np.inf, exact)
        else:
            exact = np.nanpercentile(filled, percents, axis=0)
    memory = 1000 * 4 * 7  # blocks of seven cells
    sorted_ = streaming.percentiles(source_of(values), percents, absent, method="exact", bins=256, memory_bytes=memory)
    binned = streaming.percentiles(source_of(values), percents, absent, method="auto", bins=256, memory_bytes=memory)
    assert (sorted_.method, binned.method) == ("exact", "histogram") and not sorted_.error.any()
    np.testing.assert_allclose(sorted_.values, exact, rtol=1e-12)
    finite = np.isfinite(exact)
    np.testing.assert_array_equal(finite, np.isfinite(binned.values))
    np.testing.assert_array_equal(np.isnan(exact), np.isnan(binned.values))
    difference = np.abs(np.where(finite, binned.values, 0) - np.where(finite, exact, 0))
    # Half a bin for the estimate itself; nothing for an exact 0 or infinity.
    allowed = np.broadcast_to(binned.error, exact.shape)
    assert (difference[finite] <= allowed[finite]).all()
    assert difference[finite].max() > 0.2 * allowed[finite].max(), "the error told is far too large"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        span = np.nan_to_num(np.nanmax(values, axis=0) - np.nanmin(values, axis=0))
    assert (binned.error <= (span + (1 if signed else 0)) / 512 + 1e-6).all()
    if absent == 0.0 and not signed:
        assert not binned.values[exact == 0].any(), "a dry percentile is not exactly 0"


def test_percentiles_of_a_thousand_members_from_files(tmp_path: Path, without_fsync: None) -> None:
    plan = ensemble.latin_hypercube({"flood.level": (0.2, 1.5), "flood.manning": (0.02, 0.1)}, 1000, 1)
    result = ensemble.run("flood/test", plan, tmp_path)
    wet = np.nan_to_num(exact_maps(result, "max_depth").astype(float))
    exact = np.percentile(wet, [5, 50, 95], axis=0)
    by_default = result.percentiles("max_depth", [5, 50, 95])
    np.testing.assert_allclose(by_default, exact, rtol=1e-12, atol=1e-15)
    assert by_default.attrs["error"] == 0 and by_default.attrs["method"] == "exact"
    binned = result.percentiles("max_depth", [5, 50, 95], memory_bytes=100_000)
    assert binned.attrs["method"] == "histogram" and 0 < binned.attrs["error"] < 0.01
    assert (np.abs(binned.to_numpy() - exact) <= binned.coords["error"].to_numpy()).all()


def test_moments_are_those_of_a_difficult_sum() -> None:
    values = 1e6 + np.random.default_rng(1).normal(0, 1e-3, (500, 3))
    result = streaming.moments(source_of(values), math.nan)
    np.testing.assert_allclose(result.standard_error, values.std(axis=0, ddof=1) / np.sqrt(500), rtol=1e-6)


def peak_of(compute) -> int:
    """Largest memory in bytes that a function has beyond what was there before."""
    tracemalloc.start()
    compute()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def test_memory_of_statistics_does_not_grow_with_members(tmp_path: Path, without_fsync: None) -> None:
    scene = corpuscle.Scene("flood/test", **{"grid.rows": 30, "grid.columns": 40})
    peaks = []
    for members in (100, 400):
        plan = ensemble.latin_hypercube({"flood.level": (0.5, 1.5)}, members, 1)
        result = ensemble.run(scene, plan, tmp_path / str(members))
        result.gauges("P1.depth_m")  # imports
        statistics = {
            "probability": lambda: result.probability("max_depth", above=0.3),  # noqa: B023
            "mean": lambda: result.mean("max_depth"),  # noqa: B023
            "histogram": lambda: result.percentiles("max_depth", [5, 50, 95], method="histogram"),  # noqa: B023
            "exact": lambda: result.percentiles("max_depth", [5, 50, 95], method="exact", memory_bytes=500_000),  # noqa: B023
            "gauge": lambda: result.gauges("P1.depth_m", memory_bytes=2000),  # noqa: B023
        }
        peaks.append({name: peak_of(compute) for name, compute in statistics.items()})
    for name, few in peaks[0].items():
        # The list of finished members grows by 300 numbers; a map more for each would be 1.4 MB.
        assert peaks[1][name] - few < 50_000, (name, peaks)


def test_memory_of_a_run_does_not_grow_with_maps(tmp_path: Path, without_fsync: None) -> None:
    scene = corpuscle.Scene("flood/test", **{"grid.rows": 60, "grid.columns": 80})

    def peak(members: int) -> int:
        plan = ensemble.latin_hypercube({"flood.level": (0.5, 1.5)}, members, 1)
        with ThreadPoolExecutor(2) as executor:
            return peak_of(lambda: ensemble.run(scene, plan, tmp_path / str(members), executor))

    peak(2)  # imports
    # So many that it does not matter which members run beside each other at a peak, some 300 kB.
    few, many = peak(10), peak(210)
    # A member's record and its row of the plan are some kilobytes; its maps would be 58 kB.
    assert many - few < 200 * 5000, (few, many)


# Files of results


def test_netcdf_has_units_and_grid_mapping(finished: ensemble.Ensemble, tmp_path: Path) -> None:
    chosen = ensemble.Statistics(above={"max_depth": [0.1, 0.5]}, percentiles=(10, 90))
    finished.to_netcdf(tmp_path / "e.nc", chosen)
    with xarray.open_dataset(tmp_path / "e.nc", decode_coords="all") as content:
        assert content.attrs["Conventions"] == "CF-1.8" and content.attrs["members_finished"] == 8
        assert "crs" in content.coords and content["crs"].attrs["grid_mapping_name"] == "transverse_mercator"
        assert content["x"].attrs["standard_name"] == "projection_x_coordinate" and content["x"].attrs["units"] == "m"
        assert content["max_depth_percentile"].dims == ("percentile", "y", "x")
        for name, values in content.data_vars.items():
            assert values.attrs.get("long_name"), name
            assert "units" in values.attrs or name.startswith("gauge"), name
        np.testing.assert_allclose(
            content["max_depth_probability"].sel(max_depth_threshold=0.5), finished.probability("max_depth", above=0.5)
        )
        band = content["gauge_percentile"].sel(gauge="P1.depth_m", percentile=90)
        np.testing.assert_allclose(band, finished.gauges("P1.depth_m", [90])["p90"])
    assert [path.name for path in tmp_path.iterdir()] == ["e.nc"]


def test_geotiff(finished: ensemble.Ensemble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rasterio = pytest.importorskip("rasterio")
    finished.to_geotiff(tmp_path / "p.tif", "max_depth", above=0.3)
    with rasterio.open(tmp_path / "p.tif") as file:
        assert file.crs.to_epsg() == 32632 and file.nodata == -9999 and (file.transform.c, file.transform.f) == (995.0, 2005.0)
        np.testing.assert_allclose(file.read(1), finished.probability("max_depth", above=0.3), rtol=1e-6)
    finished.to_geotiff(tmp_path / "a.tif", "arrival_time", percentile=50)
    with rasterio.open(tmp_path / "a.tif") as file:
        median = finished.percentiles("arrival_time", [50])[0].to_numpy()
        np.testing.assert_array_equal(file.read(1) == -9999, np.isinf(median))
    # Rows from south to north are turned.
    turned = finished.mean("max_depth")[::-1]
    export.to_geotiff(tmp_path / "t.tif", turned, None)
    with rasterio.open(tmp_path / "t.tif") as file:
        np.testing.assert_allclose(file.read(1), finished.mean("max_depth"), rtol=1e-6)
        assert (file.transform.c, file.transform.f) == (995.0, 2005.0)
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with pytest.raises(ensemble.MissingPackage, match=r"rasterio.*\n.*pip install corpuscle\[ensemble\]"):
        finished.to_geotiff(tmp_path / "q.tif", "max_depth")


def test_report_is_one_page_with_errors_as_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = ensemble.grid({"flood.level": [0.5, 1.0, 1.5], "test.fail": [False, True], "test.name": ["<i>a</i>"]})
    result = ensemble.run("flood/test", plan, tmp_path / "e", statistics=ensemble.Statistics(percentiles=(50,)))
    result.report(tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text()
    assert page.count('src="data:image/png;base64,') == 1 + 3 * 2 + 2
    assert "3 of 6 members finished, 3 failed" in page and "Lower it." in page and "flood.level, line 7" in page
    assert "&lt;b&gt;rises&lt;/b&gt; &amp; breaks" in page and "<b>" not in page and "<i>" not in page
    assert "http" not in page and "<script" not in page
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    result.report(tmp_path / "plain.html")
    page = (tmp_path / "plain.html").read_text()
    assert "matplotlib is not installed" in page and "base64" not in page and "P1.depth_m" in page


def test_a_model_without_maps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(corpuscle.Simulation, "maps", lambda self: xarray.Dataset())
    result = ensemble.run("gas/test", LEVELS, tmp_path / "e")
    assert result.maps == [] and len(result.gauge_means()) == 2
    assert not (tmp_path / "e/members/000000/maps.npz").exists()
    result.report(tmp_path / "r.html")
    result.to_netcdf(tmp_path / "r.nc")
    with pytest.raises(ensemble.EnsembleError, match="no map") as caught:
        result.mean("max_depth")
    assert "Its model has no maps" in caught.value.remedy


def test_disk_errors_stop_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_args, **_more):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(member.np, "savez_compressed", full)
    with pytest.raises(OSError, match="No space left"):
        ensemble.run("flood/test", LEVELS, tmp_path)
    assert ensemble.open(tmp_path).finished == [] and not list(tmp_path.rglob(".part-*"))
