"""Rasters and tables from arrays: the same bits as from files, and what is refused."""

import os
import pickle
import subprocess
import sys

import corpuscle as cp
import numpy as np
import pytest
import xarray

TEXT = """title = "A pool on rough ground"
[run]
until_s = 20.0
[terrain.file]
path = "dem.tif"
[flood]
spacing_m = 10.0
[[flood.inflow]]
name = "source"
at = [100.0, 80.0]
discharge_m3_per_s = 5.0
"""


def ground(rows=40, columns=50):
    """Rough heights on cells of 5 m, with all bits in use."""
    return np.random.default_rng(3).normal(10.0, 0.5, (rows, columns))


def test_an_array_gives_the_bits_of_a_file(tmp_path):
    cp.Raster(ground(), cell=5.0).write(tmp_path / "dem.tif")
    filed = cp.Simulation(cp.Scene(TEXT, folder=tmp_path))
    given = cp.Simulation(cp.Scene(TEXT, **{"terrain.file.path": cp.Raster(ground(), cell=5.0)}))
    filed.run()
    given.run()
    water, same = filed.frame()["water"], given.frame()["water"]
    assert water.count > 20
    for column in water:
        np.testing.assert_array_equal(water[column], same[column])
    other = ground()
    other[20, 25] += 1e-9
    changed = cp.Simulation(cp.Scene(TEXT, **{"terrain.file.path": cp.Raster(other, cell=5.0)}))
    changed.run()
    assert any(not np.array_equal(water[column], changed.frame()["water"][column]) for column in water)


def test_an_array_of_xarray_keeps_its_place_and_system():
    x, y = 512000.0 + 5.0 * np.arange(50), 204000.0 + 5.0 * np.arange(40)
    heights = xarray.DataArray(ground(), {"y": y, "x": x}, ("y", "x"), attrs={"crs": "EPSG:27700"})
    np.testing.assert_array_equal(cp.Raster.of(heights).values, ground()[::-1])
    np.testing.assert_array_equal(cp.Raster.of(heights[::-1]).values, ground()[::-1])
    scene = cp.Scene(TEXT, **{"terrain.file.path": heights, "flood.inflow.0.at": [512100.0, 204080.0]})
    simulation = cp.Simulation(scene)
    simulation.run()
    maps = simulation.maps()
    np.testing.assert_allclose(maps.x, x)
    np.testing.assert_allclose(maps.y, y[::-1])
    assert maps.rio.crs.to_epsg() == 27700 if hasattr(maps, "rio") else maps.attrs["crs"] == "EPSG:27700"
    wet = maps["depth"].fillna(0.0)
    deepest = wet.where(wet == wet.max(), drop=True)
    assert abs(float(deepest.x[0]) - 512100.0) < 60.0 and abs(float(deepest.y[0]) - 204080.0) < 60.0


def test_a_recorded_run_keeps_its_rasters(tmp_path):
    scene = cp.Scene(TEXT, **{"terrain.file.path": cp.Raster(ground(), cell=5.0), "flood.manning": {"raster": cp.Raster(np.full((4, 5), 0.05), cell=50.0)}})
    cp.Simulation(scene).run(tmp_path / "run")
    written = sorted(path.name for path in (tmp_path / "run-inputs").iterdir())
    assert [name.rsplit("_", 1)[0] for name in written] == ["flood_manning_raster", "terrain_file_path"]
    again = cp.Simulation(cp.Scene(tmp_path / "run/scene.toml"))
    again.run(tmp_path / "again")
    assert (tmp_path / "run/gauges.csv").read_bytes() == (tmp_path / "again/gauges.csv").read_bytes()


def test_a_change_before_a_recorded_run_is_not_lost(tmp_path):
    simulation = cp.Simulation(cp.Scene(TEXT, **{"terrain.file.path": cp.Raster(ground(), cell=5.0)}))
    simulation.change(**{"flood.manning": 0.1})
    with pytest.raises(cp.RunError, match="give the changes to the scene"):
        simulation.run(tmp_path / "run")


def test_arrays_that_are_changed_later_do_not_change_the_scene():
    heights, rows = ground(), np.array([[0.0, 5.0], [20.0, 6.0]])
    grid = xarray.DataArray(heights, {"y": 5.0 * np.arange(40)[::-1], "x": 5.0 * np.arange(50)}, ("y", "x"))
    scene = cp.Scene(TEXT, **{"terrain.file.path": grid, "flood.inflow.0.discharge_m3_per_s": rows})
    before = scene.toml
    heights[:] = 0.0
    rows[:] = 0.0
    assert pickle.loads(pickle.dumps(scene)).toml == scene.changed().toml == before


def test_worker_processes_leave_no_files_behind(tmp_path):
    text = """
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
import corpuscle as cp, numpy as np
def toml(scene):
    return scene.changed(seed=3).toml
if __name__ == "__main__":
    scene = cp.Scene(open("scene.toml").read(), **{"terrain.file.path": cp.Raster(np.random.rand(9, 9), cell=5.0)})
    for kind in ("fork", "spawn"):
        with ProcessPoolExecutor(2, multiprocessing.get_context(kind)) as processes:
            assert len(list(processes.map(toml, [scene] * 4))) == 4
    print(scene.toml)
"""
    (tmp_path / "scene.toml").write_text(TEXT)
    (tmp_path / "script.py").write_text(text)
    (tmp_path / "tmp").mkdir()
    environment = {**os.environ, "TMPDIR": str(tmp_path / "tmp")}
    done = subprocess.run([sys.executable, "script.py"], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and "tmp/corpuscle-" in done.stdout, done.stderr
    assert list((tmp_path / "tmp").glob("corpuscle-*")) == []


def test_a_scene_with_a_raster_survives_pickling():
    scene = pickle.loads(pickle.dumps(cp.Scene(TEXT, **{"terrain.file.path": cp.Raster(ground(), cell=5.0)})))
    assert cp.Simulation(scene).time == 0.0


@pytest.mark.parametrize("values", [ground()[::2, ::-1], ground().T, np.asfortranarray(ground()), ground().astype(np.float32), np.arange(100).reshape(10, 10)])
def test_any_layout_and_kind_of_number_is_taken(values, tmp_path):
    raster = cp.Raster(values, cell=(5.0, 2.5), corner=(10.0, 20.0))
    raster.write(tmp_path / "a.tif")
    np.testing.assert_array_equal(raster.values, values.astype(float))


@pytest.mark.parametrize(
    ("values", "cell", "words"),
    [
        (np.zeros(5), 1.0, "shape"),
        (np.zeros((1, 5)), 1.0, "at least 2"),
        (np.full((3, 3), np.nan), 1.0, "no number"),
        (np.where(np.eye(3) > 0, np.inf, 0.0), 1.0, "row 0, column 0"),
        (np.zeros((3, 3), complex), 1.0, "real numbers"),
        (np.array([["a", "b"], ["c", "d"]]), 1.0, "real numbers"),
        (np.zeros((3, 3)), 0.0, "above 0"),
    ],
)
def test_arrays_that_are_no_raster_are_refused(values, cell, words):
    with pytest.raises(cp.SceneError, match=words):
        cp.Raster(values, cell=cell)


def test_an_uneven_grid_is_refused_by_key():
    uneven = xarray.DataArray(ground(3, 3), {"y": [0.0, 1.0, 3.0], "x": [0.0, 1.0, 2.0]}, ("y", "x"))
    with pytest.raises(cp.SceneError, match="evenly spaced") as caught:
        cp.Scene(TEXT, **{"terrain.file.path": uneven})
    assert caught.value.key == "terrain.file.path"


def test_a_system_without_a_code_is_refused():
    with pytest.raises(cp.SceneError, match="EPSG"):
        cp.Scene(TEXT, **{"terrain.file.path": cp.Raster(ground(), cell=5.0, crs="+proj=utm +zone=32")})


def test_a_gas_goes_on_from_a_table_of_its_balls(gas, tmp_path):
    first = cp.Simulation(gas)
    first.run(tmp_path / "run", frames="csv")
    table = first.frame()["balls"].to_pandas()
    empty = {"gas.species": [], "gas.follow": 0}
    given = cp.Scene(gas.toml, **empty, **{"gas.start_file": table})
    filed = cp.Scene(gas.toml, **empty, **{"gas.start_file": max((tmp_path / "run/frames").glob("*.csv"))})
    states = []
    for scene in (given, filed):
        simulation = cp.Simulation(pickle.loads(pickle.dumps(scene)))
        np.testing.assert_array_equal(simulation.frame()["balls"]["velocity"], first.frame()["balls"]["velocity"])
        simulation.run()
        states.append(simulation.frame()["balls"]["position"])
    np.testing.assert_array_equal(*states)
    table.loc[3, "x"] = np.nan
    with pytest.raises(cp.SceneError, match="column x, row 3") as caught:
        cp.Scene(gas.toml, **empty, **{"gas.start_file": table})
    assert caught.value.key == "gas.start_file"
