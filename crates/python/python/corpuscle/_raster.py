"""What stands for a file of a scene: rasters from arrays, tables."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _native
from ._errors import SceneError
from ._files import write_text


@dataclass(frozen=True, eq=False)
class Raster:
    """Values on a grid, given wherever a scene has the path of a raster.

    ``Scene("flood.toml", **{"terrain.file.path": Raster(heights, cell=5.0)})``. A two-dimensional `xarray.DataArray` with coordinates can be given as it is.

    Parameters
    ----------
    values : array of shape (rows, columns)
        Rows from the north, columns from the west; not-a-number where there is no data. Real numbers of any type; computed with in double precision.
    cell : float or (float, float)
        Size of a cell, or its sizes eastwards and southwards, in units of the reference system.
    corner : (float, float)
        Outer corner at the north-west: easting and northing, or longitude and latitude. By default the south-west corner is (0, 0).
    crs : str, optional
        Reference system, as ``"EPSG:27700"``.

    Raises
    ------
    SceneError
        Where the array is not as it must be.
    """

    values: np.ndarray
    cell: float | tuple[float, float]
    corner: tuple[float, float] | None = None
    crs: str | None = None

    def __post_init__(self) -> None:
        values = np.asarray(self.values)
        if values.ndim != 2 or min(values.shape) < 2:
            raise SceneError(f"a raster has the shape (rows, columns), at least 2 each; this array has {values.shape}")
        if values.dtype.kind not in "fiu":
            raise SceneError(f"a raster has real numbers; this array has {values.dtype}: convert it, as by values.astype(float)")
        values = np.array(values, dtype=np.float64, order="C")
        if np.isinf(values).any():
            row, column = np.argwhere(np.isinf(values))[0]
            raise SceneError(f"a raster has finite numbers, or not-a-number for no data; that of row {row}, column {column} is infinite")
        if np.isnan(values).all():
            raise SceneError("this array has no number at all; give values")
        sizes = tuple(float(size) for size in np.broadcast_to(self.cell, 2))
        if not all(0.0 < size < float("inf") for size in sizes):
            raise SceneError(f"cell = {self.cell} cannot be the size of a cell; give one above 0")
        values.flags.writeable = False
        corner = (0.0, values.shape[0] * sizes[1]) if self.corner is None else tuple(float(place) for place in self.corner)
        for name, value in (("values", values), ("cell", sizes), ("corner", corner)):
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, array: Any) -> Raster:
        """The raster of a two-dimensional `xarray.DataArray` with evenly spaced coordinates of the cells' centres.

        Rows may run from the south. The reference system is that of `rioxarray` or the attribute `crs`, if there is one.
        """
        down, across = array.dims
        x, y = (np.asarray(array[name].values, dtype=float) for name in (across, down))
        steps = _step(x, across), -_step(y, down)
        values = np.asarray(array.values)
        if steps[1] < 0.0:
            values, y = values[::-1], y[::-1]
        if steps[0] < 0.0:
            raise SceneError(f"the coordinate {across} falls; sort the array by it, as by array.sortby({across!r})")
        cell = (steps[0], abs(steps[1]))
        return cls(values, cell, (x[0] - 0.5 * cell[0], y[0] + 0.5 * cell[1]), _system(array))

    @property
    def _ending(self) -> str:
        return ".tif"

    @property
    def digest(self) -> str:
        """A hash of all of it, the same for the same raster."""
        known = hashlib.sha256(repr((self.values.shape, self.cell, self.corner, self.crs)).encode())
        known.update(self.values.data)
        return known.hexdigest()[:32]

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes it as a GeoTIFF with all its bits, whole or not at all.

        Raises
        ------
        SceneError, RunError
            Where the reference system has no EPSG code, or the file cannot be written.
        """
        _native.write_raster(Path(path), self.values, self.corner, self.cell, self.crs)


@dataclass(frozen=True, eq=False)
class _Table:
    """A table that stands where a scene has the path of a CSV file."""

    text: str
    _ending: str = ".csv"

    @classmethod
    def of(cls, frame: Any) -> _Table:
        for name, column in frame.items():
            if column.dtype.kind == "f" and not np.isfinite(column.to_numpy()).all():
                row = int(np.argmin(np.isfinite(column.to_numpy())))
                raise SceneError(f"the table has no finite number in column {name}, row {row}; give one")
        return cls(frame.to_csv(index=False, lineterminator="\n"))

    @property
    def digest(self) -> str:
        return hashlib.sha256(self.text.encode()).hexdigest()[:32]

    def write(self, path: Path) -> None:
        write_text(path, self.text)


def as_file(value: Any) -> Raster | _Table | None:
    """What stands for a file: a raster, or a table as a `pandas.DataFrame`; none for other values."""
    if isinstance(value, (Raster, _Table)):
        return value
    if hasattr(value, "to_csv") and hasattr(value, "columns"):
        return _Table.of(value)
    is_grid = hasattr(value, "dims") and hasattr(value, "coords") and getattr(value, "ndim", 0) == 2
    return Raster.of(value) if is_grid else None


def _step(places: np.ndarray, name: str) -> float:
    steps = np.diff(places)
    step = float(steps.mean()) if len(steps) else 0.0
    if step == 0.0 or not np.allclose(steps, step, rtol=1e-4, atol=0.0):
        raise SceneError(f"the coordinate {name} is not evenly spaced; put the array on an even grid, as by array.interp")
    return (float(places[-1]) - float(places[0])) / (len(places) - 1)


def _system(array: Any) -> str | None:
    if array.attrs.get("crs"):
        return str(array.attrs["crs"])
    described = array.coords.get("spatial_ref")
    if described is None or "crs_wkt" not in described.attrs:
        return None
    import pyproj

    code = pyproj.CRS.from_wkt(described.attrs["crs_wkt"]).to_epsg()
    if code is None:
        raise SceneError("the reference system of the array has no EPSG code; project it to one that has, as by array.rio.reproject")
    return f"EPSG:{code}"
