"""Plans: tables with one row for each member and one column for each scene key that is changed."""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import EnsembleError, require

if TYPE_CHECKING:
    import pandas

__all__ = ["Plan", "grid", "latin_hypercube", "sobol"]

# Probabilities are kept this far from 0 and 1, where the quantiles of unbounded distributions are infinite.
_EDGE = 2.0**-53


def grid(values: Mapping[str, Iterable[Any]]) -> pandas.DataFrame:
    """Plan of all combinations of the given values.

    Parameters
    ----------
    values : mapping
        For each dotted scene key the values to take, such as ``{"flood.manning": [0.02, 0.03]}``. Repeats of a gas
        or dew with other random numbers are ``{"seed": range(1, 21)}``.

    Returns
    -------
    pandas.DataFrame
        One row for each combination. The last key varies fastest.

    Raises
    ------
    EnsembleError
        Without keys, or where a key has no values.
    """
    lists = {_key(key): _values(key, items) for key, items in values.items()}
    if not lists:
        raise EnsembleError("The grid has no keys.", remedy='Give at least one, such as {"flood.manning": [0.02, 0.03]}.')
    rows = list(itertools.product(*lists.values()))
    pandas = require("pandas", "A plan")
    return pandas.DataFrame({key: [row[column] for row in rows] for column, key in enumerate(lists)})


def latin_hypercube(ranges: Mapping[str, Any], members: int, seed: int) -> pandas.DataFrame:
    """Plan of a Latin hypercube sample: each key's range in `members` strata of equal probability, each drawn from once.

    Parameters
    ----------
    ranges : mapping
        For each dotted scene key a pair ``(low, high)``, between which values are uniform, or a frozen distribution of
        `scipy.stats`, such as ``scipy.stats.lognorm(0.3, scale=0.03)``. For whole numbers use a discrete
        distribution, such as ``scipy.stats.randint(1, 7)`` for 1 to 6.
    members : int
        Number of rows, at least 1.
    seed : int
        Seed of the random numbers. The same seed and version of SciPy give the same plan.

    Returns
    -------
    pandas.DataFrame
        One row for each member.

    Raises
    ------
    EnsembleError
        Where a range or the number of members is wrong; `key` names the range.
    """
    return _sampled("LatinHypercube", ranges, members, seed)


def sobol(ranges: Mapping[str, Any], members: int, seed: int) -> pandas.DataFrame:
    """Plan of a scrambled Sobol sequence, which fills the ranges more evenly than independent random numbers.

    Parameters and errors are those of `latin_hypercube`. With a power of two as `members` the sequence is balanced;
    with another number SciPy warns that it is not.
    """
    return _sampled("Sobol", ranges, members, seed)


def _sampled(engine: str, ranges: Mapping[str, Any], members: int, seed: int) -> pandas.DataFrame:
    if isinstance(members, bool) or not isinstance(members, int | np.integer) or members < 1:
        raise EnsembleError(f"The number of members is {members!r}; it must be a whole number of at least 1.")
    if not ranges:
        raise EnsembleError("There are no ranges.", remedy='Give at least one, such as {"flood.manning": (0.02, 0.05)}.')
    stats = require("scipy.stats", "A sampled plan")
    pandas = require("pandas", "A plan")
    quantiles = {_key(key): _quantile(key, range_, stats) for key, range_ in ranges.items()}
    sampler = getattr(stats.qmc, engine)(d=len(quantiles), rng=np.random.default_rng(seed))
    sample = np.clip(sampler.random(int(members)), _EDGE, 1.0 - _EDGE)
    return pandas.DataFrame({key: quantile(sample[:, column]) for column, (key, quantile) in enumerate(quantiles.items())})


def _quantile(key: str, range_: Any, stats: Any) -> Any:
    """The function from probabilities to values."""
    if hasattr(range_, "ppf"):
        discrete = isinstance(getattr(range_, "dist", None), stats.rv_discrete)
        return (lambda p: range_.ppf(p).astype(np.int64)) if discrete else range_.ppf
    try:
        low, high = (float(end) for end in range_)
    except (TypeError, ValueError):
        raise EnsembleError(
            f"The range of {key} is {range_!r}.", key=key, remedy="Give (low, high) or a frozen distribution of scipy.stats."
        ) from None
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise EnsembleError(f"The range of {key} is {range_!r}; its low end must be below its high end, both finite.", key=key)
    return lambda p: low + (high - low) * p


def _values(key: str, items: Iterable[Any]) -> list[Any]:
    if isinstance(items, str | bytes) or not isinstance(items, Iterable):
        raise EnsembleError(f"The values of {key} are {items!r}.", key=key, remedy=f"Give a list, such as [{items!r}].")
    values = list(items)
    if not values:
        raise EnsembleError(f"The list of values of {key} is empty.", key=key)
    return values


def _key(key: Any) -> str:
    if not isinstance(key, str) or not key.strip():
        raise EnsembleError(f"A column of the plan is named {key!r}.", remedy='Columns are dotted scene keys, such as "flood.manning".')
    return key


@dataclass(frozen=True)
class Plan:
    """A checked plan: its columns, and its rows with values in Python's own types."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]

    @classmethod
    def of(cls, table: pandas.DataFrame) -> Plan:
        """The plan of a user's table, checked.

        Raises
        ------
        EnsembleError
            Where the table is empty, a column is named twice, or a value is missing, not finite, or none that a
            scene can have.
        """
        if not hasattr(table, "columns") or not hasattr(table, "iloc"):
            raise EnsembleError(
                f"The plan is a {type(table).__name__}; it must be a pandas.DataFrame.",
                remedy="Make it with grid, latin_hypercube or sobol, or with pandas.DataFrame.",
            )
        columns = tuple(_key(key) for key in table.columns)
        for key in columns:
            if columns.count(key) > 1:
                raise EnsembleError(f"The plan has two columns {key}.", key=key)
        if not columns or len(table) == 0:
            raise EnsembleError(f"The plan is empty: it has {len(table)} rows and {len(columns)} columns.")
        cells = [[_value(value, row, key) for row, value in enumerate(table[key].tolist())] for key in columns]
        return cls(columns, tuple(zip(*cells, strict=True)))

    @classmethod
    def from_csv(cls, text: str) -> Plan:
        """The plan of a table that `csv` wrote."""
        lines = list(csv.reader(io.StringIO(text, newline="")))
        return cls(tuple(lines[0][1:]), tuple(tuple(map(_decoded, line[1:])) for line in lines[1:]))

    def csv(self) -> str:
        """The plan as a CSV table, with the member's number as first column.

        A value is written as in JSON; text stands without quotation marks unless it would read as another value.
        """
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["member", *self.columns])
        for member, row in enumerate(self.rows):
            writer.writerow([member, *map(_encoded, row)])
        return text.getvalue()

    def changes(self, member: int) -> dict[str, Any]:
        """The changes of a member: values by scene key."""
        return dict(zip(self.columns, self.rows[member], strict=True))

    def table(self) -> pandas.DataFrame:
        """The plan as a table whose index is the member's number."""
        pandas = require("pandas", "A plan")
        cells = {key: [row[column] for row in self.rows] for column, key in enumerate(self.columns)}
        return pandas.DataFrame(cells, index=pandas.RangeIndex(len(self.rows), name="member"))

    def difference(self, other: Plan) -> str | None:
        """A sentence on how `other`, which is given, differs from this plan, which is stored; None where it does not."""
        if self.columns != other.columns:
            return f"the stored plan has the columns {', '.join(self.columns)}, the given one {', '.join(other.columns)}"
        if len(self.rows) != len(other.rows):
            return f"the stored plan has {len(self.rows)} members, the given one {len(other.rows)}"
        for member, (mine, theirs) in enumerate(zip(self.rows, other.rows, strict=True)):
            for key, left, right in zip(self.columns, mine, theirs, strict=True):
                if _encoded(left) != _encoded(right):
                    return f"{key} of member {member} is {_encoded(left)} in the stored plan, {_encoded(right)} in the given one"
        return None


def _value(value: Any, row: int, key: str) -> Any:
    """The cell's value in Python's types."""
    where = f"{key} of the plan's row {row}"
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_value(item, row, key) for item in value]
    if isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        if math.isfinite(value):
            return value
        raise EnsembleError(f"{where} is {value}; it must be a finite number.", key=key, remedy="Fill in the value, or leave the row out.")
    if value is None or type(value).__name__ in ("NAType", "NaTType"):
        raise EnsembleError(f"{where} is missing.", key=key, remedy="Fill in the value, or leave the row out.")
    raise EnsembleError(
        f"{where} is a {type(value).__name__} ({value!r}), which a scene cannot have.",
        key=key,
        remedy="Values are numbers, true or false, text, or lists of these.",
    )


def _encoded(value: Any) -> str:
    if isinstance(value, str):
        try:
            json.loads(value)
        except ValueError:
            return value
    return json.dumps(value, ensure_ascii=False)


def _decoded(cell: str) -> Any:
    try:
        return json.loads(cell)
    except ValueError:
        return cell
