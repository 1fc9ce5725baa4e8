"""The report of an ensemble: one self-contained HTML page."""

from __future__ import annotations

import base64
import importlib.util
import io
import math
from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .errors import require
from .export import chosen_gauges, chosen_maps, chosen_thresholds
from .._files import replacing

if TYPE_CHECKING:
    import xarray

    from .results import Ensemble, Statistics

__all__ = ["write"]

_NO_PICTURES = "The pictures are left out: matplotlib is not installed. Install it with: pip install matplotlib"
_PICTURE_WIDTH_IN = 4.6
_DOTS_PER_IN = 144
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #1d2733; background: #fff; margin: 0 auto; padding: 24px 20px 60px; max-width: 1160px; }
h1 { font-size: 26px; margin: 0 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 19px; margin: 36px 0 8px; padding-bottom: 4px; border-bottom: 1px solid #d5dbe2; }
h3 { font-size: 15px; margin: 20px 0 6px; } p { margin: 6px 0; } .quiet { color: #5a6675; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); gap: 14px; }
figure { margin: 0; } figure img { width: 100%; height: auto; display: block; }
figcaption { color: #5a6675; font-size: 13px; }
.table { overflow: auto; max-height: 520px; border: 1px solid #d5dbe2; border-radius: 4px; }
table { border-collapse: collapse; font-size: 13px; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 10px; text-align: left; border-bottom: 1px solid #eceff3; vertical-align: top; }
th { position: sticky; top: 0; background: #f3f5f8; font-weight: 600; white-space: nowrap; }
td.number, th.number { text-align: right; } td.failed { color: #a4231b; font-weight: 600; } td.text { overflow-wrap: anywhere; }
pre { background: #f3f5f8; padding: 12px; overflow: auto; font-size: 12.5px; border-radius: 4px; max-height: 520px; }
@media print { .table, pre { max-height: none; overflow: visible; } }
"""


def write(ensemble: Ensemble, path: Path, statistics: Statistics) -> None:
    """Writes the report."""
    require("pandas", "A report")
    sections = [_head(ensemble), _failures(ensemble)]
    if ensemble.finished:
        draw = importlib.util.find_spec("matplotlib") is not None
        sections += [_maps(ensemble, statistics, draw), _gauges(ensemble, statistics, draw)]
    sections += [_plan(ensemble), _scene(ensemble)]
    title = escape(f"Ensemble of {ensemble.name}")
    page = (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
        f"<title>{title}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n{''.join(sections)}</body>\n</html>\n"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path.absolute()) as part:
        part.write_text(page, encoding="utf-8")


def _head(ensemble: Ensemble) -> str:
    planned, finished, failed = len(ensemble.plan), len(ensemble.finished), len(ensemble.failed)
    parts = [f"{finished} of {planned} members finished", f"{failed} failed"]
    if waiting := planned - finished - failed:
        parts.append(f"{waiting} not run")
    keys = ", ".join(ensemble.plan.columns)
    dry = "A dry cell counts as depth, speed, duration and hazard 0, and as an arrival time of infinity, which is never."
    note = "Statistics are over the finished members." + (f" {dry}" if ensemble.maps else "")
    return (
        f'<h1>Ensemble of {escape(ensemble.name)}</h1>\n<p>{", ".join(parts)}. Changed: {escape(keys)}.</p>\n<p class="quiet">{note}</p>\n'
    )


def _failures(ensemble: Ensemble) -> str:
    failed = ensemble.failed
    if not failed:
        return ""
    rows = [
        [_number(member), _text(_changes(ensemble, member)), _text(error.what), _text(error.where), _text(error.remedy or "")]
        for member, error in failed.items()
    ]
    return "<h2>Members that failed</h2>\n" + _table(["member", "changes", "error", "where", "what to do"], rows)


def _maps(ensemble: Ensemble, statistics: Statistics, draw: bool) -> str:
    names, thresholds = chosen_maps(ensemble, statistics), chosen_thresholds(ensemble, statistics)
    if not names and not thresholds:
        return ""
    if not draw:
        return f'<h2>Maps</h2>\n<p class="quiet">{_NO_PICTURES}</p>\n'
    text = ""
    if thresholds:
        pictures = []
        for name, values in thresholds.items():
            for threshold in values:
                share = ensemble.probability(name, above=threshold)
                pictures.append(_figure(_map_picture(share, "Blues", (0.0, 1.0)), _sentence(share.attrs["long_name"])))
        text += f'<h2>Probabilities</h2>\n<div class="pictures">\n{"".join(pictures)}</div>\n'
    for name in names:
        text += _percentile_maps(ensemble, name, statistics)
    return text


def _percentile_maps(ensemble: Ensemble, name: str, statistics: Statistics) -> str:
    values = ensemble.percentiles(name, statistics.percentiles)
    limits = _limits(values)
    pictures = [
        _figure(_map_picture(layer, "viridis", limits), f"Percentile {percent:g}")
        for percent, layer in zip(statistics.percentiles, values, strict=True)
    ]
    mean = ensemble.mean(name)
    caption = "Mean of the members that the water reaches" if mean.attrs["dry"] == "left out" else "Mean"
    pictures.append(_figure(_map_picture(mean, "viridis", limits), caption))
    error, units = values.attrs["error"], values.attrs["units"]
    accuracy = "exact" if values.attrs["method"] == "exact" else f"from histograms, with an error of at most {error:.2g} {units}"
    title = _sentence(ensemble.map_title(name))
    note = f"Percentiles are {accuracy}. Where a member is dry, it {_counts_as(values.attrs['dry'])}."
    return f'<h2>{escape(title)}</h2>\n<p class="quiet">{escape(note)}</p>\n<div class="pictures">\n{"".join(pictures)}</div>\n'


def _limits(values: xarray.DataArray) -> tuple[float, float]:
    """Ends of the colours: without the outermost hundredths of the values that are shown."""
    shown = _shown_cells(values).compressed()
    if shown.size == 0:
        return 0.0, 1.0
    low, high = np.percentile(shown, [1, 99])
    return float(low), float(high)


def _shown_cells(values: xarray.DataArray) -> Any:
    """The cells with those masked that are dry, never reached, or without a value."""
    cells = values.to_numpy()
    zero_is_dry = values.attrs.get("dry", "counts as 0") == "counts as 0"
    return np.ma.masked_where(~np.isfinite(cells) | ((cells == 0) & zero_is_dry), cells)


def _counts_as(dry: str) -> str:
    return "is left out" if dry == "left out" else dry


def _gauges(ensemble: Ensemble, statistics: Statistics, draw: bool) -> str:
    names = chosen_gauges(ensemble, statistics)
    if not names:
        return ""
    means = ensemble.gauge_means()
    rows = [
        [_text(str(name)), _number(row["mean"]), _number(row["standard_error"]), _number(row["members"])] for name, row in means.iterrows()
    ]
    table = "<h3>Last values</h3>\n" + _table(["gauge", "mean", "standard error", "members"], rows, numbers=(1, 2, 3))
    if not draw:
        return f'<h2>Gauges</h2>\n<p class="quiet">{_NO_PICTURES}</p>\n{table}'
    pictures = [_figure(_band_picture(ensemble, name, statistics.percentiles), name) for name in names]
    left = len(means) - len(names)
    note = f'<p class="quiet">{left} more columns are in the table.</p>\n' if left > 0 else ""
    return f'<h2>Gauges</h2>\n<div class="pictures">\n{"".join(pictures)}</div>\n{note}{table}'


def _plan(ensemble: Ensemble) -> str:
    table = ensemble.summary()
    columns = list(ensemble.plan.columns)
    headings = ["member", *columns, "status", "wall time, s"]
    rows = []
    for member, row in zip(table.index, table[[*columns, "status", "wall_time_s"]].itertuples(index=False), strict=True):
        *changes, status, wall = row
        state = f'<td class="failed">{status}</td>' if status == "failed" else f"<td>{escape(status)}</td>"
        rows.append([_number(member), *map(_cell, changes), state, _number(wall, 3)])
    numbers = (0, *(1 + index for index, key in enumerate(columns) if _is_numeric(table[key])), len(headings) - 1)
    return "<h2>Plan</h2>\n" + _table(headings, rows, numbers=numbers)


def _scene(ensemble: Ensemble) -> str:
    return f'<h2>Scene</h2>\n<p class="quiet">Without the plan\'s changes.</p>\n<pre>{escape(ensemble.scene)}</pre>\n'


def _map_picture(values: xarray.DataArray, colours: str, limits: tuple[float, float]) -> bytes:
    """PNG of a map; cells that are dry, never reached, or without a value are grey, and so is a probability of 0."""
    values = values.sortby(["y", "x"])
    y, x = values["y"].to_numpy(), values["x"].to_numpy()
    shown = _shown_cells(values)
    half_x, half_y = _half_step(x), _half_step(y)
    extent = (x[0] - half_x, x[-1] + half_x, y[0] - half_y, y[-1] + half_y)
    shape = (extent[3] - extent[2]) / (extent[1] - extent[0])
    height = min(max(0.6 + 3.2 * shape, 1.5), 6.0)
    label = str(values.attrs.get("units", ""))

    def draw(axes: Any, figure: Any) -> None:
        axes.set_facecolor("#e6e9ed")
        image = axes.imshow(shown, origin="lower", extent=extent, cmap=colours, vmin=limits[0], vmax=limits[1], interpolation="nearest")
        axes.set_xlabel(_axis_label(values, "x"), fontsize=8)
        axes.set_ylabel(_axis_label(values, "y"), fontsize=8)
        axes.locator_params(nbins=5)
        beyond = "both" if colours == "viridis" else "neither"
        bar = figure.colorbar(image, ax=axes, extend=beyond, aspect=18)
        bar.ax.tick_params(labelsize=8)
        bar.set_label("" if label == "1" else label, fontsize=8)

    return _picture(draw, height)


def _band_picture(ensemble: Ensemble, name: str, percents: Sequence[float]) -> bytes:
    """PNG of a gauge: mean, middle percentile, and the band between the outer ones."""
    table = ensemble.gauges(name, percents)
    ordered = sorted(percents)
    low, high, times = f"p{ordered[0]:g}", f"p{ordered[-1]:g}", table.index.to_numpy()

    def draw(axes: Any, figure: Any) -> None:
        if low != high:
            axes.fill_between(times, table[low], table[high], color="#a9cbe8", linewidth=0, label=f"percentiles {low[1:]} to {high[1:]}")
        for percent in ordered[1:-1] if len(ordered) > 2 else ordered[:1] if low == high else ():
            axes.plot(times, table[f"p{percent:g}"], color="#1f5f99", linewidth=1.4, label=f"percentile {percent:g}")
        axes.plot(times, table["mean"], color="#c0501f", linewidth=1.2, linestyle="--", label="mean")
        axes.set_xlabel("time, s", fontsize=8)
        axes.margins(x=0)
        axes.grid(color="#e6e9ed", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.legend(fontsize=7, frameon=False)

    return _picture(draw, 2.8)


def _picture(draw: Callable[[Any, Any], None], height: float) -> bytes:
    """PNG that a function draws on axes and a figure. No window and no global state of matplotlib is used."""
    require("matplotlib", "A picture", "matplotlib")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_PICTURE_WIDTH_IN, height), dpi=_DOTS_PER_IN, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.tick_params(labelsize=8)
    draw(axes, figure)
    png = io.BytesIO()
    figure.savefig(png, format="png", metadata={"Software": None})
    return png.getvalue()


def _figure(png: bytes, caption: str) -> str:
    text = escape(caption)
    source = base64.b64encode(png).decode("ascii")
    return f'<figure><img alt="{text}" src="data:image/png;base64,{source}"><figcaption>{text}</figcaption></figure>\n'


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]], numbers: Sequence[int] = (0,)) -> str:
    """A table of cells that are HTML already."""
    head = "".join(
        f'<th class="number">{escape(text)}</th>' if index in numbers else f"<th>{escape(text)}</th>" for index, text in enumerate(headings)
    )
    body = "\n".join(f"<tr>{''.join(row)}</tr>" for row in rows)
    return f'<div class="table"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table></div>\n'


def _text(text: str) -> str:
    return f'<td class="text">{escape(text)}</td>'


def _number(value: Any, digits: int = 6) -> str:
    missing = isinstance(value, float) and math.isnan(value)
    return f'<td class="number">{"" if missing else f"{value:.{digits}g}"}</td>'


def _cell(value: Any) -> str:
    numeric = isinstance(value, int | float | np.number) and not isinstance(value, bool | np.bool_)
    return _number(value) if numeric else _text(str(value))


def _is_numeric(column: Any) -> bool:
    return column.dtype.kind in "iuf"


def _changes(ensemble: Ensemble, member: int) -> str:
    row = ensemble.plan.loc[member]
    return ", ".join(f"{key} = {_shown(row[key])}" for key in row.index)


def _shown(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)


def _half_step(axis: NDArray[np.float64]) -> float:
    return float(axis[-1] - axis[0]) / (axis.size - 1) / 2 if axis.size > 1 else 0.5


def _axis_label(values: xarray.DataArray, axis: str) -> str:
    units = values[axis].attrs.get("units")
    return f"{axis}, {units}" if units else axis


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
