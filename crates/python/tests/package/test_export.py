"""`corpuscle export`: files that the programs of each field read, with the values of the run."""

import subprocess
import sys

import corpuscle as cp
import numpy as np
import pandas as pd
import pytest
import xarray as xr

FILES = ["maps.nc", "gauges.parquet", "particles.vtkhdf"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A simulation of a flood on terrain with a reference system, and the folder that has its run and what was exported."""
    folder = tmp_path_factory.mktemp("export")
    x, y = 400000.0 + 10.0 * np.arange(40), 300400.0 - 10.0 * np.arange(30)
    bed = xr.DataArray(10.0 + 0.02 * np.add.outer(np.abs(np.arange(30) - 15) ** 1.5, np.arange(40)), {"y": y, "x": x}, ("y", "x"))
    bed.attrs["crs"] = "EPSG:27700"
    text = """
    title = "A small lake"
    [run]
    until_s = 20.0
    frame_every_s = 10.0
    [terrain.file]
    path = "bed.tif"
    [flood]
    spacing_m = 20.0
    water = [{ level_m = 11.0 }]
    gauge = [{ name = "P1", at = [400100.0, 300250.0] }, { name = "dry", at = [400380.0, 300390.0] }]
    """
    write_bed(folder / "bed.tif", bed)
    (folder / "lake.toml").write_text(text)
    simulation = cp.Simulation(cp.Scene(folder / "lake.toml"))
    simulation.run(folder / "run")
    command(folder, "run", *FILES)
    return simulation, folder


def write_bed(path, bed):
    rasterio = pytest.importorskip("rasterio")
    x, y = bed.x.to_numpy(), bed.y.to_numpy()
    place = rasterio.transform.from_origin(x[0] - 5.0, y[0] + 5.0, 10.0, 10.0)
    size = {"height": len(y), "width": len(x), "count": 1, "dtype": "float64"}
    with rasterio.open(path, "w", driver="GTiff", crs=bed.attrs["crs"], transform=place, **size) as file:
        file.write(bed.to_numpy(), 1)


def command(folder, *arguments):
    done = subprocess.run([sys.executable, "-m", "corpuscle", "export", *arguments], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("engine", ["netcdf4", "h5netcdf"])
def test_maps_are_those_of_the_simulation(run, engine):
    simulation, folder = run
    pytest.importorskip({"netcdf4": "netCDF4"}.get(engine, engine))
    maps = simulation.maps()
    with xr.open_dataset(folder / "maps.nc", engine=engine) as exported:
        for name, expected in maps.drop_vars("depth").data_vars.items():
            np.testing.assert_array_equal(exported[name], expected, err_msg=name)
            for key in ["long_name", "units", "grid_mapping"]:
                assert exported[name].encoding.get(key, exported[name].attrs.get(key)) == expected.attrs[key], (name, key)
        assert exported["depth"].dims == ("time", "y", "x")
        np.testing.assert_array_equal(exported["depth"][-1], maps["depth"])
        np.testing.assert_array_equal(exported["time"], [0.0, 10.0, 20.0])
        for axis in ["x", "y"]:
            np.testing.assert_array_equal(exported[axis], maps[axis])
            assert exported[axis].attrs == maps[axis].attrs
        assert exported.attrs["title"] == "A small lake" and exported.attrs["crs"] == maps.attrs["crs"]
        assert exported.attrs["Conventions"] == maps.attrs["Conventions"]


def test_other_programs_read_the_reference_system(run):
    pytest.importorskip("rioxarray")
    _, folder = run
    with xr.open_dataset(folder / "maps.nc", decode_coords="all") as exported:
        assert exported.rio.crs.to_epsg() == 27700
        assert exported.rio.transform()[2] == 399995.0


def test_gauges_are_those_of_the_simulation(run):
    pytest.importorskip("pyarrow")
    simulation, folder = run
    exported = pd.read_parquet(folder / "gauges.parquet").set_index("time_s")
    pd.testing.assert_frame_equal(exported, simulation.gauges(), check_exact=True)
    assert len(exported) > 10


def test_particles_are_those_of_the_simulation(run):
    h5py = pytest.importorskip("h5py")
    simulation, folder = run
    water = simulation.frame()["water"]
    with h5py.File(folder / "particles.vtkhdf") as file:
        root = file["VTKHDF"]
        assert root.attrs["Type"] == b"PolyData" and list(root["Steps/Values"]) == [0.0, 10.0, 20.0]
        start, count = root["Steps/PointOffsets"][-1], root["NumberOfPoints"][-1]
        last = slice(start, start + count)
        np.testing.assert_array_equal(root["Points"][last], water["position"])
        for name in ["id", "velocity", "mass", "depth"]:
            np.testing.assert_array_equal(root["PointData"][name][last], water[name], err_msg=name)
