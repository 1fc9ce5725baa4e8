"""An ensemble's results, computed from the files of its finished members."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import streaming
from .errors import EnsembleError, require
from .folder import Folder
from .member import Failure, Member, X, Y, read_gauge, read_maps

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = ["Ensemble", "Statistics", "open"]

_MEMORY_BYTES = 2**28
_BINS = 256
# Maps whose dry cells have the value 0.
_ZERO_WHERE_DRY = ("depth", "speed", "velocity", "fastest", "duration", "hazard", "infiltration", "discharge")


@dataclass(frozen=True)
class Statistics:
    """Choice of the statistics that reports and NetCDF files have.

    Attributes
    ----------
    maps : sequence of str, optional
        Maps to evaluate; None is all.
    above : mapping, optional
        Thresholds of probabilities by map, in the map's unit; None is 0.3 m of ``max_depth``, where there is that map.
    percentiles : sequence of float
        Percentiles of maps and gauges, 0 to 100.
    gauges : sequence of str, optional
        Gauge columns to evaluate; None is the first twelve.
    """

    maps: Sequence[str] | None = None
    above: Mapping[str, Sequence[float]] | None = None
    percentiles: Sequence[float] = (5.0, 50.0, 95.0)
    gauges: Sequence[str] | None = None

    def __post_init__(self) -> None:
        _check_percents(self.percentiles)
        for name, thresholds in (self.above or {}).items():
            if isinstance(thresholds, int | float) or not all(math.isfinite(threshold) for threshold in thresholds):
                raise EnsembleError(f"The thresholds of {name} are {thresholds!r}; they must be a list of finite numbers.")

    def stored(self) -> dict[str, Any]:
        """The choice in the types of JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Brief:
    """What is kept in memory of a member's record."""

    status: str
    error: Failure | None
    attempts: int
    wall_time_s: float | None


class Ensemble:
    """The results of an ensemble, as its folder has them when this object is made.

    Statistics are over the finished members, in member order. They are computed from the members' files at each call,
    a member at a time, so memory does not grow with the number of members, and the same files give the same bits.

    A dry cell has no value (NaN) in the model's maps. In means and percentiles it counts as 0 for depths, speeds, velocities,
    durations, hazard and infiltration; as infinity, which is "never", for arrival times; for all other maps, such as
    levels, the member is left out in that cell. Cells outside the terrain, which have no value in any member, cannot
    be told from cells that are dry in all.
    """

    def __init__(self, place: Folder) -> None:
        self._place = place
        self._briefs: list[Brief | None] = []
        self._first: Member | None = None
        self._longest: int | None = None
        latest = -math.inf
        for record in place.records():
            self._briefs.append(None if record is None else Brief(record.status, record.error, record.attempts, record.wall_time_s))
            if record is None or not record.finished:
                continue
            self._first = self._first or record
            if record.last_time_s is not None and record.last_time_s > latest:
                self._longest, latest = record.number, record.last_time_s

    def __repr__(self) -> str:
        return f"Ensemble({str(self.folder)!r}: {len(self.finished)} of {len(self._briefs)} members finished, {len(self.failed)} failed)"

    @property
    def folder(self) -> Path:
        """The ensemble's folder."""
        return self._place.path

    @property
    def name(self) -> str:
        """The scene's name."""
        return str(self._place.about().get("name"))

    @property
    def scene(self) -> str:
        """The scene without changes, as TOML text."""
        return self._place.scene

    @property
    def plan(self) -> pandas.DataFrame:
        """The plan: one row for each member, one column for each scene key that is changed."""
        return self._place.plan.table()

    @property
    def finished(self) -> list[int]:
        """Numbers of the finished members."""
        return [number for number, brief in enumerate(self._briefs) if brief is not None and brief.status == "finished"]

    @property
    def failed(self) -> dict[int, Failure]:
        """Errors of the members that failed, by number."""
        return {number: brief.error for number, brief in enumerate(self._briefs) if brief is not None and brief.error is not None}

    @property
    def maps(self) -> list[str]:
        """Names of the maps; empty for a model without maps."""
        return [] if self._first is None else list(self._first.maps or {})

    def map_title(self, name: str) -> str:
        """What a map shows, in words; its name where the model does not tell."""
        return str(self._map_attributes(name).get("long_name") or name)

    def map_units(self, name: str) -> str:
        """Unit of a map; empty where the model does not tell."""
        return str(self._map_attributes(name).get("units") or "")

    @property
    def gauge_names(self) -> list[str]:
        """Names of the gauge columns."""
        return [] if self._first is None else list(self._first.final_gauges or {})

    @property
    def statistics(self) -> Statistics:
        """The stored choice of statistics."""
        return Statistics(**(self._place.about().get("statistics") or {}))

    def probability(self, name: str, *, above: float | None = None, below: float | None = None) -> xarray.DataArray:
        """Share of the finished members in which a map is above (or below) a threshold.

        A cell that is dry in a member is neither above nor below.

        Parameters
        ----------
        name : str
            The map, such as ``"max_depth"``.
        above, below : float
            The threshold, in the map's unit; one of the two.

        Returns
        -------
        xarray.DataArray
            Shares from 0 to 1, dimensions (y, x). `attrs` has the number of members.

        Raises
        ------
        EnsembleError
            Where no member has finished, there is no such map, or the members' grids differ.
        """
        thresholds = [float(given) for given in (above, below) if given is not None]
        if len(thresholds) != 1:
            raise EnsembleError("probability needs one threshold.", remedy="Give above=, such as above=0.3, or below=.")
        threshold = thresholds[0]
        if math.isnan(threshold):
            raise EnsembleError("The threshold of a probability is NaN; it must be a number.")
        share, _ = streaming.shares(self._map_source(name), [threshold], above=above is not None)
        sign = ">" if above is not None else "<"
        title = f"probability that {_inside(self.map_title(name))} {sign} {threshold:g} {self.map_units(name)}".rstrip()
        return self._map(f"{name}_probability", share[0], units="1", long_name=title, threshold=threshold)

    def percentiles(
        self,
        name: str,
        percents: Sequence[float],
        *,
        method: str = "auto",
        bins: int = _BINS,
        memory_bytes: int = _MEMORY_BYTES,
    ) -> xarray.DataArray:
        """Percentiles of a map over the finished members, with linear interpolation between order statistics.

        Method "exact" reads the values of all members for a block of cells after another and sorts them, with as many
        passes over the files as there are blocks of `memory_bytes`. Method "histogram" takes two passes for any
        number of members: one for each cell's smallest and largest value, one that counts its values in `bins` bins
        between them; an order statistic is taken as the middle of its bin. Dry counts as in the class's description,
        and is not part of the bins, so percentiles that are dry are exact. "auto" is exact as long as one block holds
        all values of the cells that are ever wet, and a histogram for more.

        Parameters
        ----------
        name : str
            The map.
        percents : sequence of float
            Percentiles to compute, 0 to 100.
        method : {"auto", "exact", "histogram"}
            See above.
        bins : int
            Bins of a histogram, at least 2.
        memory_bytes : int
            Limit of the working memory that depends on members or bins. Beyond it a few arrays of the size of a map are held.

        Returns
        -------
        xarray.DataArray
            Dimensions (percentile, y, x), in the map's unit. The coordinate `error` (y, x) bounds the difference from the
            exact percentile: 0 for the exact method, half the width of the cell's bins for histograms;
            ``attrs["error"]`` is its largest value and ``attrs["method"]`` the method. Where an arrival is never,
            infinity; where a cell is left out in all members, NaN.

        Raises
        ------
        EnsembleError
            Where no member has finished, there is no such map, or the members' grids differ.
        """
        percents = _check_percents(percents)
        _check_method(method, bins, memory_bytes)
        dry = self._dry(name)
        result = streaming.percentiles(self._map_source(name), percents, dry, method=method, bins=bins, memory_bytes=memory_bytes)
        xarray = require("xarray", "A map")
        rows, columns = self._shape
        array = xarray.DataArray(
            result.values.reshape(len(percents), rows, columns),
            dims=("percentile", "y", "x"),
            coords={"percentile": ("percentile", percents, {"units": "1", "long_name": "percentile"}), **self._axes},
            name=f"{name}_percentile",
            attrs=self._attributes(name, long_name=f"percentile of {_inside(self.map_title(name))}", dry=_dry_words(dry)),
        )
        bound = f"bound of the error of percentiles of {_inside(self.map_title(name))}"
        array.coords["error"] = (("y", "x"), result.error.reshape(rows, columns), {"units": self.map_units(name), "long_name": bound})
        array.attrs.update(method=result.method, error=float(result.error.max(initial=0.0)))
        return array

    def mean(self, name: str) -> xarray.DataArray:
        """Mean of a map over the finished members, dimensions (y, x), in the map's unit.

        Arrival times are averaged over the members in which the cell was reached; NaN where it was in none. What a dry
        cell counts as for other maps is in the class's description and in ``attrs["dry"]``.
        """
        return self._moment(name, "mean")

    def standard_error(self, name: str) -> xarray.DataArray:
        """Standard error of `mean`: sample standard deviation over the root of the number of values; NaN for fewer than two."""
        return self._moment(name, "standard_error")

    def gauges(
        self,
        name: str,
        percents: Sequence[float] = (5.0, 50.0, 95.0),
        *,
        method: str = "auto",
        bins: int = _BINS,
        memory_bytes: int = _MEMORY_BYTES,
    ) -> pandas.DataFrame:
        """Mean and percentiles over the finished members of a gauge at each time: the bands of a hydrograph.

        The times are those of the member that ran longest, of several the first. A member with other times is
        interpolated linearly; beyond its first and last time, and where a gauge has no value, it is left out.

        Parameters
        ----------
        name : str
            The gauge column, such as ``"P1.depth_m"``.
        percents, method, bins, memory_bytes
            As for `percentiles`.

        Returns
        -------
        pandas.DataFrame
            Index ``time_s``; columns ``mean``, ``standard_error``, ``members`` (their number at that time), one for
            each percentile, such as ``p5``, and ``error``, which bounds the error of the percentiles. Without values, NaN.

        Raises
        ------
        EnsembleError
            Where no member has finished or there is no such gauge.
        """
        percents = _check_percents(percents)
        _check_method(method, bins, memory_bytes)
        times = self._gauge_times(name)

        def source() -> Iterator[NDArray[np.float64]]:
            for number in self.finished:
                own, values = read_gauge(self._place.member(number), name)
                yield values if np.array_equal(own, times) else _interpolated(times, own, values)

        moments = streaming.moments(source, math.nan)
        bands = streaming.percentiles(source, percents, math.nan, method=method, bins=bins, memory_bytes=memory_bytes)
        columns = {"mean": moments.mean, "standard_error": moments.standard_error, "members": moments.count}
        columns |= {f"p{percent:g}": values for percent, values in zip(percents, bands.values, strict=True)}
        pandas = require("pandas", "A gauge")
        return pandas.DataFrame({**columns, "error": bands.error}, index=pandas.Index(times, name="time_s"))

    def gauge_means(self) -> pandas.DataFrame:
        """Mean over the finished members of each gauge column's last value, with standard error.

        Returns
        -------
        pandas.DataFrame
            Index ``gauge``; columns ``mean``, ``standard_error`` (NaN for fewer than two members) and ``members``.
        """
        self._need_finished()
        names = self.gauge_names

        def source() -> Iterator[NDArray[np.float64]]:
            for _, final in self._finals():
                yield np.array([_number(final.get(name)) for name in names])

        moments = streaming.moments(source, math.nan)
        pandas = require("pandas", "A table")
        columns = {"mean": moments.mean, "standard_error": moments.standard_error, "members": moments.count}
        return pandas.DataFrame(columns, index=pandas.Index(names, name="gauge"))

    def summary(self) -> pandas.DataFrame:
        """One row for each member.

        Returns
        -------
        pandas.DataFrame
            Index ``member``; the plan's columns; ``status`` ("finished", "failed", or "not run"), ``error`` (text, empty
            without one), ``attempts``, ``wall_time_s``; and the last value of each gauge column, NaN where there is none.
        """
        table = self.plan
        briefs = self._briefs
        table["status"] = ["not run" if brief is None else brief.status for brief in briefs]
        table["error"] = ["" if brief is None or brief.error is None else str(brief.error) for brief in briefs]
        table["attempts"] = [0 if brief is None else brief.attempts for brief in briefs]
        table["wall_time_s"] = [_number(None if brief is None else brief.wall_time_s) for brief in briefs]
        finals = dict(self._finals())
        values = {name: [_number(finals.get(number, {}).get(name)) for number in table.index] for name in self.gauge_names}
        pandas = require("pandas", "A table")
        return pandas.concat([table, pandas.DataFrame(values, index=table.index)], axis=1)

    def dataset(self, statistics: Statistics | None = None) -> xarray.Dataset:
        """Dataset of the chosen statistics, with the attributes of CF-1.8; see `to_netcdf`."""
        from .export import dataset

        return dataset(self, statistics or self.statistics)

    def to_netcdf(self, path: str | os.PathLike[str], statistics: Statistics | None = None) -> None:
        """Writes a NetCDF file of the chosen statistics, by the conventions CF-1.8.

        For each map ``NAME_mean``, ``NAME_standard_error``, ``NAME_percentile``, ``NAME_percentile_error`` and, where
        there are thresholds, ``NAME_probability``; for gauges ``gauge_mean``, ``gauge_standard_error``, ``gauge_members``,
        ``gauge_percentile`` and ``gauge_percentile_error``. Cells without a value are NaN; an arrival that is never, infinity.

        Parameters
        ----------
        path : path
            The file, which is replaced if it exists.
        statistics : Statistics, optional
            The choice; None is the stored one.

        Raises
        ------
        MissingPackage
            Where neither netCDF4 nor h5netcdf is installed.
        """
        from .export import to_netcdf

        to_netcdf(self, Path(path), statistics or self.statistics)

    def to_geotiff(
        self,
        path: str | os.PathLike[str],
        name: str,
        *,
        above: float | None = None,
        below: float | None = None,
        percentile: float | None = None,
    ) -> None:
        """Writes one statistic of a map as GeoTIFF of 32-bit floating point, with -9999 for no data.

        No data is where the statistic has no value, and where an arrival is never.

        Parameters
        ----------
        path : path
            The file, which is replaced if it exists.
        name : str
            The map.
        above, below, percentile : float
            One of these chooses the probability or the percentile; without any, the mean is written.

        Raises
        ------
        MissingPackage
            Where rasterio is not installed.
        """
        from .export import to_geotiff

        chosen = [given for given in (above, below, percentile) if given is not None]
        if len(chosen) > 1:
            raise EnsembleError("to_geotiff writes one statistic.", remedy="Give one of above, below and percentile.")
        require("rasterio", "A GeoTIFF")
        if percentile is not None:
            values = self.percentiles(name, [percentile])[0]
        else:
            values = self.probability(name, above=above, below=below) if chosen else self.mean(name)
        to_geotiff(Path(path), values, self.crs)

    def report(self, path: str | os.PathLike[str], statistics: Statistics | None = None) -> None:
        """Writes a report, one self-contained HTML page: members that failed, maps, gauges, and the plan.

        Maps and curves are pictures by matplotlib; where it is not installed a line says so in their place.

        Parameters
        ----------
        path : path
            The file, which is replaced if it exists.
        statistics : Statistics, optional
            The choice; None is the stored one.
        """
        from .report import write

        write(self, Path(path), statistics or self.statistics)

    @property
    def crs(self) -> str | None:
        """The maps' reference system, as well-known text or code; None where it is not known."""
        return None if self._first is None else self._first.crs

    @cached_property
    def _grid(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        x, y = read_maps(self._place.member(self._need_finished().number), X, Y)
        return x, y

    @property
    def _shape(self) -> tuple[int, int]:
        x, y = self._grid
        return y.size, x.size

    @property
    def _axes(self) -> dict[str, Any]:
        attributes = self._need_finished().coordinates or {}
        return {name: (name, values, attributes.get(name, {})) for name, values in zip("yx", reversed(self._grid), strict=True)}

    def _need_finished(self) -> Member:
        """The record of the first finished member."""
        if self._first is not None:
            return self._first
        failed = self.failed
        told = f" Member {min(failed)}: {failed[min(failed)]}" if failed else ""
        raise EnsembleError(f"No member of the ensemble in {self.folder} has finished.{told}", remedy="Call run first, or again.")

    def _need(self, name: str, names: list[str], what: str) -> None:
        self._need_finished()
        if name not in names:
            known = f"It has {', '.join(names)}." if names else f"Its model has no {what}s."
            raise EnsembleError(f"The ensemble in {self.folder} has no {what} {name!r}.", remedy=known)

    def _map_attributes(self, name: str) -> dict[str, Any]:
        self._need(name, self.maps, "map")
        return (self._need_finished().maps or {})[name]

    def _map_source(self, name: str) -> streaming.Source:
        """Passes over the flattened maps of the finished members."""
        self._need(name, self.maps, "map")
        x, y = self._grid

        def source() -> Iterator[NDArray[np.float32]]:
            for number in self.finished:
                own_x, own_y, values = read_maps(self._place.member(number), X, Y, name)
                if not (np.array_equal(own_x, x) and np.array_equal(own_y, y)):
                    raise EnsembleError(
                        f"The maps of members {self.finished[0]} and {number} of the ensemble in {self.folder} are on different grids.",
                        remedy="Statistics of maps need one grid: leave the keys out of the plan that change the terrain's cells.",
                    )
                yield values.reshape(-1)

        return source

    def _moment(self, name: str, which: str) -> xarray.DataArray:
        dry = self._dry(name)
        values = getattr(streaming.moments(self._map_source(name), dry), which)
        title = f"{which.replace('_', ' ')} of {_inside(self.map_title(name))}"
        words = "left out" if math.isinf(dry) else _dry_words(dry)
        return self._map(f"{name}_{which}", values, **self._attributes(name, long_name=title, dry=words))

    def _map(self, name: str, values: NDArray[np.float64], **attributes: Any) -> xarray.DataArray:
        xarray = require("xarray", "A map")
        attributes = {"members": len(self.finished), **attributes}
        return xarray.DataArray(values.reshape(self._shape), dims=("y", "x"), coords=self._axes, name=name, attrs=attributes)

    def _attributes(self, name: str, **more: Any) -> dict[str, Any]:
        return {"units": self.map_units(name), **more, "members": len(self.finished)}

    def _dry(self, name: str) -> float:
        """What a dry cell counts as in means and percentiles."""
        self._need(name, self.maps, "map")
        if name.startswith("arrival"):
            return math.inf
        return 0.0 if any(word in name for word in _ZERO_WHERE_DRY) else math.nan

    def _gauge_times(self, name: str) -> NDArray[np.float64]:
        self._need(name, self.gauge_names, "gauge")
        assert self._longest is not None, "a member with gauges has a last time"
        return read_gauge(self._place.member(self._longest), name)[0]

    def _finals(self) -> Iterator[tuple[int, dict[str, float | None]]]:
        """Last gauge values of the finished members."""
        for number in self.finished:
            record = self._place.record(number)
            if record is not None:
                yield number, record.final_gauges or {}


def open(folder: str | os.PathLike[str]) -> Ensemble:
    """The ensemble in a folder that `run` wrote, complete or not.

    Raises
    ------
    EnsembleError
        Where the folder is no ensemble's.
    """
    return Ensemble(Folder.open(Path(folder)))


def _interpolated(times: NDArray[np.float64], own: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """A gauge's values at other times; NaN beyond its own."""
    if own.size == 0:
        return np.full(times.size, np.nan)
    return np.interp(times, own, values, left=np.nan, right=np.nan)


def _inside(title: str) -> str:
    """A title as part of a sentence: without its capital, except where it begins with an abbreviation."""
    return title if title[1:2].isupper() else title[:1].lower() + title[1:]


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _dry_words(dry: float) -> str:
    return "left out" if math.isnan(dry) else "counts as infinity (never)" if math.isinf(dry) else f"counts as {dry:g}"


def _check_percents(percents: Sequence[float]) -> list[float]:
    try:
        checked = [float(percent) for percent in percents]
    except (TypeError, ValueError):
        checked = []
    if not checked or not all(0 <= percent <= 100 for percent in checked):
        raise EnsembleError(
            f"The percentiles are {percents!r}; they must be a list of numbers from 0 to 100.", remedy="Such as [5, 50, 95]."
        )
    return checked


def _check_method(method: str, bins: int, memory_bytes: int) -> None:
    if method not in ("auto", "exact", "histogram"):
        raise EnsembleError(f"The method is {method!r}; it must be auto, exact or histogram.")
    if bins < 2 or memory_bytes < 1:
        raise EnsembleError(f"bins is {bins} and memory_bytes {memory_bytes}; they must be at least 2 and 1.")
