"""Ensembles of the command line: the package reads and continues them, and finds the same statistics."""

import subprocess
import sys

import corpuscle as cp
import numpy as np
import pandas
import pytest
import rasterio
from corpuscle import ensemble

PLAN = """
scene = "scene.toml"
sample = "sobol"
members = 8
seed = 3
[change]
flood.manning = { from = 0.02, to = 0.08 }
[statistics]
above = { max_depth = [0.5] }
percentiles = [10, 50, 90]
"""


def command(folder, *arguments):
    return subprocess.run([sys.executable, "-m", "corpuscle", "ensemble", *arguments], capture_output=True, text=True, cwd=folder)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ensemble")
    scene = cp.Scene("flood/valley", **{"run.until_s": 120.0, "flood.spacing_m": 16.0})
    (folder / "scene.toml").write_text(scene.toml)
    (folder / "plan.toml").write_text(PLAN)
    done = command(folder, "plan.toml", "-o", "runs")
    assert done.returncode == 0, done.stderr
    return folder


def written(path):
    with rasterio.open(path) as file:
        return file.read(1, masked=True).filled(np.nan)


def test_statistics_are_the_same(folder):
    result = ensemble.open(folder / "runs")
    assert result.finished == list(range(8)) and not result.failed
    maps = {
        "max_depth_probability_above_0.5": result.probability("max_depth", above=0.5),
        "max_depth_mean": result.mean("max_depth"),
        "max_depth_standard_error": result.standard_error("max_depth"),
        "max_depth_p90": result.percentiles("max_depth", [90])[0],
        "arrival_s_p50": result.percentiles("arrival_s", [50])[0],
        "max_level_p10": result.percentiles("max_level", [10])[0],
    }
    for name, values in maps.items():
        expected = values.to_numpy().astype(np.float32)
        expected[~np.isfinite(expected)] = np.nan
        found = written(folder / "runs/results" / f"{name}.tif")
        assert np.count_nonzero(np.isfinite(found)) > 100, name
        np.testing.assert_array_equal(found, expected, err_msg=name)
    table = pandas.read_csv(folder / "runs/results/gauges.csv").set_index("gauge")
    bands = result.gauges("upper.depth_m", [10, 50, 90])
    ours = table.loc["upper.depth_m"]
    np.testing.assert_array_equal(ours["time_s"], bands.index)
    for column in ["mean", "standard_error", "members", "p10", "p50", "p90"]:
        np.testing.assert_array_equal(ours[column], bands[column])
    last = pandas.read_csv(folder / "runs/results/last_gauges.csv").set_index("gauge")
    means = result.gauge_means()
    pandas.testing.assert_frame_equal(last.loc[means.index], means, check_dtype=False, check_exact=True)


def test_members_are_those_of_python(folder, tmp_path):
    commanded = ensemble.open(folder / "runs")
    plan = commanded.plan
    scene = cp.Scene(folder / "scene.toml")
    computed = ensemble.run(scene, plan, tmp_path / "python", members=[2, 5])
    for number in computed.finished:
        member = f"members/{number:06d}"
        with np.load(folder / "runs" / member / "maps.npz") as ours, np.load(tmp_path / "python" / member / "maps.npz") as theirs:
            assert set(ours) == set(theirs)
            for name in ours:
                np.testing.assert_array_equal(ours[name], theirs[name], err_msg=name)
    ours, theirs = (pandas.read_csv(place / "members/000002/gauges.csv") for place in (folder / "runs", tmp_path / "python"))
    pandas.testing.assert_frame_equal(ours, theirs, check_dtype=False, check_exact=True)


def test_either_goes_on_where_the_other_stopped(folder, tmp_path):
    scene = cp.Scene(folder / "scene.toml")
    plan = ensemble.open(folder / "runs").plan
    (tmp_path / "scene.toml").write_text((folder / "scene.toml").read_text())
    (tmp_path / "plan.toml").write_text(PLAN)
    ensemble.run(scene, plan, tmp_path / "both", members=[0, 1, 2])
    done = command(tmp_path, "plan.toml", "-o", "both", "--member", "3", "--member", "4")
    assert done.returncode == 0, done.stderr
    result = ensemble.run(scene, plan, tmp_path / "both")
    assert result.finished == list(range(8))
    assert (result.summary()["attempts"] == 1).all(), "what one had finished the other did not run again"
    expected = ensemble.open(folder / "runs").mean("max_depth")
    np.testing.assert_array_equal(result.mean("max_depth"), expected)
    done = command(tmp_path, "plan.toml", "-o", "both")
    assert done.returncode == 0, done.stderr
    np.testing.assert_array_equal(written(tmp_path / "both/results/max_depth_mean.tif"), written(folder / "runs/results/max_depth_mean.tif"))
