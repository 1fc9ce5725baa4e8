"""NetCDF and GeoTIFF files of an ensemble's statistics."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .errors import EnsembleError, MissingPackage, require
from .._files import replacing

if TYPE_CHECKING:
    import xarray

    from .results import Ensemble, Statistics

__all__ = ["chosen_gauges", "chosen_maps", "chosen_thresholds", "dataset", "to_geotiff", "to_netcdf"]

_NO_DATA = -9999.0
_GAUGES = 12
_DEFAULT_ABOVE = {"max_depth": (0.3,)}
# Steps between cell centres differ by rounding of their coordinates.
_STEP_TOLERANCE = 1e-6


def chosen_maps(ensemble: Ensemble, statistics: Statistics) -> list[str]:
    """The maps to evaluate."""
    return list(ensemble.maps if statistics.maps is None else statistics.maps)


def chosen_thresholds(ensemble: Ensemble, statistics: Statistics) -> dict[str, list[float]]:
    """The thresholds of probabilities by map."""
    if statistics.above is not None:
        return {name: [float(threshold) for threshold in thresholds] for name, thresholds in statistics.above.items()}
    maps = chosen_maps(ensemble, statistics)
    return {name: list(thresholds) for name, thresholds in _DEFAULT_ABOVE.items() if name in maps}


def chosen_gauges(ensemble: Ensemble, statistics: Statistics) -> list[str]:
    """The gauge columns to evaluate."""
    return list(ensemble.gauge_names[:_GAUGES] if statistics.gauges is None else statistics.gauges)


def dataset(ensemble: Ensemble, statistics: Statistics) -> xarray.Dataset:
    """Dataset of the chosen statistics, with the attributes of CF-1.8."""
    xarray = require("xarray", "A dataset")
    variables: dict[str, Any] = {}
    for name in chosen_maps(ensemble, statistics):
        variables |= _map_variables(ensemble, name, statistics)
    for name, thresholds in chosen_thresholds(ensemble, statistics).items():
        variables[f"{name}_probability"] = _probability(ensemble, name, thresholds)
    has_maps = bool(variables)
    if gauges := chosen_gauges(ensemble, statistics):
        variables |= _gauge_variables(ensemble, gauges, statistics)
    if not variables:
        raise EnsembleError(f"The ensemble in {ensemble.folder} has neither maps nor gauges in a finished member.")
    result = xarray.Dataset(variables, attrs=_global_attributes(ensemble))
    if has_maps:
        _describe_axes(result, ensemble.crs)
    return result


def to_netcdf(ensemble: Ensemble, path: Path, statistics: Statistics) -> None:
    """Writes the chosen statistics as NetCDF."""
    require("xarray", "A NetCDF file")
    if not any(importlib.util.find_spec(name) for name in ("netCDF4", "h5netcdf")):
        raise MissingPackage(
            "A NetCDF file needs the Python package netCDF4 or h5netcdf; neither is installed.",
            remedy="Install one with: pip install netCDF4",
        )
    content = dataset(ensemble, statistics)
    compressed = {name: {"zlib": True} for name, values in content.data_vars.items() if values.ndim > 1 and values.dtype.kind == "f"}
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path.absolute()) as part:
        content.to_netcdf(
            part, engine="netcdf4" if importlib.util.find_spec("netCDF4") else "h5netcdf", format="NETCDF4", encoding=compressed
        )


def to_geotiff(path: Path, values: xarray.DataArray, crs: str | None) -> None:
    """Writes a map as GeoTIFF."""
    rasterio = require("rasterio", "A GeoTIFF")
    y, x = values["y"].to_numpy(), values["x"].to_numpy()
    step_x, step_y = _step(x, "x"), _step(y, "y")
    cells = values.to_numpy()
    if step_y > 0:  # rows go from north to south
        cells, y, step_y = cells[::-1], y[::-1], -step_y
    band = np.where(np.isfinite(cells), cells, _NO_DATA).astype(np.float32)
    transform = rasterio.Affine(step_x, 0.0, x[0] - step_x / 2, 0.0, step_y, y[0] - step_y / 2)
    path.parent.mkdir(parents=True, exist_ok=True)
    with (
        replacing(path.absolute()) as part,
        rasterio.open(
            part, "w", driver="GTiff", width=band.shape[1], height=band.shape[0], count=1, dtype="float32",
            crs=crs, transform=transform, nodata=_NO_DATA, compress="deflate", predictor=3,
        ) as file,
    ):  # fmt: skip
        file.write(band, 1)
        file.set_band_description(1, str(values.attrs.get("long_name", values.name)))
        file.set_band_unit(1, str(values.attrs.get("units", "")))


def _map_variables(ensemble: Ensemble, name: str, statistics: Statistics) -> dict[str, xarray.DataArray]:
    percentiles = ensemble.percentiles(name, statistics.percentiles)
    error = percentiles.coords["error"].drop_vars("error")
    percentiles = percentiles.drop_vars("error")
    percentiles.attrs["ancillary_variables"] = f"{name}_percentile_error"
    mean, standard_error = ensemble.mean(name), ensemble.standard_error(name)
    mean.attrs["ancillary_variables"] = f"{name}_standard_error"
    arrays = {
        "mean": mean,
        "standard_error": standard_error,
        "percentile": percentiles,
        "percentile_error": error,
    }
    return {f"{name}_{statistic}": _single(array) for statistic, array in arrays.items()}


def _probability(ensemble: Ensemble, name: str, thresholds: list[float]) -> xarray.DataArray:
    """Probabilities along a dimension of the map's thresholds."""
    xarray = require("xarray", "A dataset")
    dimension = f"{name}_threshold"
    layers = [ensemble.probability(name, above=threshold) for threshold in thresholds]
    index = xarray.Variable(dimension, np.array(thresholds), {"units": ensemble.map_units(name), "long_name": f"threshold of {name}"})
    result = xarray.concat(layers, dim=dimension, combine_attrs="drop").assign_coords({dimension: index})
    title = f"{ensemble.map_title(name)}: probability that it is above the threshold"
    result.attrs = {"units": "1", "long_name": title, "members": len(ensemble.finished)}
    return _single(result)


def _gauge_variables(ensemble: Ensemble, names: list[str], statistics: Statistics) -> dict[str, Any]:
    tables = [ensemble.gauges(name, statistics.percentiles) for name in names]
    times = tables[0].index.to_numpy(np.float64)
    percents = [float(percent) for percent in statistics.percentiles]

    def stacked(column: str) -> NDArray[np.float64]:
        return np.stack([table[column].to_numpy(np.float64) for table in tables])

    bands = np.stack([stacked(f"p{percent:g}") for percent in percents])
    note = "the unit is the ending of the gauge's name"
    return {
        "gauge": ("gauge", np.array(names, dtype=object), {"long_name": "gauge column"}),
        "gauge_time": ("gauge_time", times, {"units": "s", "long_name": "time since the start of the simulation"}),
        "percentile": ("percentile", percents, {"units": "1", "long_name": "percentile"}),
        "gauge_mean": (("gauge", "gauge_time"), stacked("mean"), {"long_name": "mean of gauges", "comment": note}),
        "gauge_standard_error": (
            ("gauge", "gauge_time"),
            stacked("standard_error"),
            {"long_name": "standard error of the mean of gauges", "comment": note},
        ),
        "gauge_members": (
            ("gauge", "gauge_time"),
            stacked("members").astype(np.int32),
            {"units": "1", "long_name": "number of members with a value"},
        ),
        "gauge_percentile": (
            ("percentile", "gauge", "gauge_time"),
            bands,
            {"long_name": "percentile of gauges", "comment": note, "ancillary_variables": "gauge_percentile_error"},
        ),
        "gauge_percentile_error": (
            ("gauge", "gauge_time"),
            stacked("error"),
            {"long_name": "bound of the error of percentiles of gauges", "comment": note},
        ),
    }


def _global_attributes(ensemble: Ensemble) -> dict[str, Any]:
    return {
        "Conventions": "CF-1.8",
        "title": f"Ensemble of the scene {ensemble.name}",
        "source": "corpuscle",
        "members_planned": len(ensemble.plan),
        "members_finished": len(ensemble.finished),
        "comment": "Statistics are over the finished members. Where a variable has the attribute dry, "
        "it tells what a dry cell counts as; infinity is never.",
    }


def _describe_axes(content: xarray.Dataset, crs: str | None) -> None:
    """Adds the reference system, and the axes' standard names and units."""
    geographic, attributes = _grid_mapping(crs)
    standard = ("longitude", "latitude") if geographic else ("projection_x_coordinate", "projection_y_coordinate")
    units = ("degrees_east", "degrees_north") if geographic else ("m", "m")
    for axis, name, unit in zip("xy", standard, units, strict=True):
        content[axis].attrs.setdefault("units", unit)
        content[axis].attrs.setdefault("long_name", f"{axis} of cell centres")
        content[axis].attrs["axis"] = axis.upper()
        if crs is not None:
            content[axis].attrs["standard_name"] = name
    if crs is None:
        return
    content["crs"] = ((), np.int32(0), attributes)
    for values in content.data_vars.values():
        if {"x", "y"} <= set(values.dims):
            values.attrs["grid_mapping"] = "crs"


def _grid_mapping(crs: str | None) -> tuple[bool, dict[str, Any]]:
    """Whether a reference system is geographic, and the attributes of its grid mapping; the text alone without pyproj."""
    if crs is None:
        return False, {}
    if importlib.util.find_spec("pyproj") is None:
        return crs.lstrip().upper().startswith(("GEOG", "EPSG:4326")), {"crs_wkt": crs}
    pyproj = require("pyproj", "A grid mapping")
    system = pyproj.CRS.from_user_input(crs)
    return system.is_geographic, system.to_cf()


def _single(array: xarray.DataArray) -> xarray.DataArray:
    """The map in 32-bit floating point, as the members' maps are."""
    return array.astype(np.float32, keep_attrs=True)


def _step(axis: NDArray[np.float64], name: str) -> float:
    """The step between cell centres."""
    steps = np.diff(axis)
    if steps.size == 0 or np.any(np.abs(steps - steps[0]) > _STEP_TOLERANCE * abs(steps[0])) or steps[0] == 0:
        raise EnsembleError(
            f"A GeoTIFF needs equal steps between at least two cells; the {axis.size} values of {name} have none.",
            remedy="Write a NetCDF file with to_netcdf instead.",
        )
    return float((axis[-1] - axis[0]) / steps.size)
