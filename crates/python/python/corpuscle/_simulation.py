"""Simulations: scenes that run."""

from __future__ import annotations

import base64
import html
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._errors import RunError, SceneError
from ._progress import reporter
from ._scene import Scene
from ._toml import written

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True)
class Particles(Mapping):
    """A set of like particles: columns by name, one entry for each particle.

    ``particles["position"]`` has shape (n, 3), in metres unless the scene is in reduced units; ``velocity`` likewise; ``id``, ``radius`` and ``mass``
    have shape (n,). What else there is depends on the model: ``depth`` of a flood, ``temperature`` of dew.

    Attributes
    ----------
    name : str
        What the particles are: ``"water"``.
    columns : dict of str to numpy.ndarray
        The columns. They are handed over by the simulation, not copied, and are the caller's own.
    units : dict of str to str
        Units of the columns; empty text for a plain number.
    """

    name: str
    columns: dict[str, np.ndarray]
    units: dict[str, str]

    def __getitem__(self, column: str) -> np.ndarray:
        return self.columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def count(self) -> int:
        """Number of particles."""
        return len(self.columns["id"])

    def to_pandas(self) -> pandas.DataFrame:
        """The particles as a table with the columns of ``corpuscle run --frames csv``: ``set``, ``id``, ``x``, ``y``, ``z``, ``vx``, ...

        A gas can start from it: ``Scene(..., **{"gas.start_file": table})``.
        """
        pandas = _needs("pandas", "tables")
        axes = {"position": ("x", "y", "z"), "velocity": ("vx", "vy", "vz")}
        flat: dict[str, Any] = {"set": self.name}
        for name, values in self.columns.items():
            words = axes.get(name, tuple(f"{name}_{axis}" for axis in "xyz"))
            flat.update({name: values} if values.ndim == 1 else dict(zip(words, values.T)))
        return pandas.DataFrame(flat)


@dataclass(frozen=True)
class Frame(Mapping):
    """All particles at one time, by the name of their set.

    Attributes
    ----------
    time : float
        Simulated time, s.
    sets : dict of str to Particles
        The sets: ``"water"`` of a flood, one for each species of a gas.
    """

    time: float
    sets: dict[str, Particles]

    def __getitem__(self, name: str) -> Particles:
        return self.sets[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.sets)

    def __len__(self) -> int:
        return len(self.sets)


@dataclass(frozen=True)
class Series:
    """A series of a chart.

    Attributes
    ----------
    name : str
        Name for the legend.
    x, y : numpy.ndarray
        The points, shape (n,). A y that is not a number is a gap.
    errors : numpy.ndarray or None
        Standard error of each y, where there is one.
    """

    name: str
    x: np.ndarray
    y: np.ndarray
    errors: np.ndarray | None


@dataclass(frozen=True)
class Chart:
    """A chart of what a model measured, such as the histogram of speeds beside Maxwell's curve.

    Attributes
    ----------
    name, title : str
        Name as in files, and heading.
    x_label, y_label : str
        What the axes show, with the unit in brackets.
    series : dict of str to Series
        The series by name.
    note : str
        A line that goes with it, such as ``"p = 0.43"``.
    """

    name: str
    title: str
    x_label: str
    y_label: str
    series: dict[str, Series]
    note: str


@dataclass(frozen=True)
class Balance:
    """The balance of a conserved quantity.

    Attributes
    ----------
    initial, inflow, outflow, now : float
        Amount at the start, what came in and went out since, and amount now.
    relative_error : float
        (now - initial - inflow + outflow) over the amount that there is.
    """

    initial: float
    inflow: float
    outflow: float
    now: float
    relative_error: float


class Simulation:
    """An opened scene, which advances.

    Parameters
    ----------
    scene : Scene, str or path
        The scene, or what `Scene` takes as its source.
    threads : int, optional
        Number of threads, by default one for each core. Results are the same bits for any.
    backend : {"cpu", "gpu"}
        Where to compute. The CPU computes in double precision, a GPU in single precision.

    Raises
    ------
    SceneError
        Where the scene, its terrain or a file that it names cannot be used, or there is no GPU.

    Notes
    -----
    The interpreter is free while a simulation computes: other threads of Python go on, and may advance other simulations. Ctrl-C stops it in a sound
    state at the time that it has reached, and raises `KeyboardInterrupt`.
    """

    def __init__(self, scene: Scene | str | os.PathLike[str], *, threads: int | None = None, backend: str = "cpu") -> None:
        if backend not in ("cpu", "gpu"):
            raise SceneError(f'backend = {backend!r} is not known; give "cpu" or "gpu"')
        self.scene = scene if isinstance(scene, Scene) else Scene(scene)
        self._number_of_threads = _threads(threads)
        self._native = _native.Simulation(self.scene._native, self._number_of_threads, backend == "gpu")
        self._is_touched = False

    @classmethod
    def _resumed(cls, folder: str | os.PathLike[str], threads: int | None) -> Simulation:
        made = object.__new__(cls)
        made._number_of_threads = _threads(threads)
        made._is_touched = False
        made._native = _native.Simulation.resume(Path(folder), made._number_of_threads)
        made.scene = Scene(Path(folder) / "scene.toml")
        return made

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._native.time

    @property
    def until(self) -> float:
        """The end of the scene, s."""
        return self._native.until

    @property
    def steps(self) -> int:
        """Steps taken; of a gas, collisions."""
        return self._native.steps

    @property
    def particles(self) -> int:
        """Number of particles now."""
        return self._native.particles

    @property
    def backend(self) -> str:
        """Where it computes: ``"cpu"`` or ``"gpu"``."""
        return self._native.backend

    @property
    def warnings(self) -> list[str]:
        """Choices that were made where the scene leaves a value open, and warnings, in sentences."""
        return self._native.warnings

    def run(
        self,
        output: str | os.PathLike[str] | None = None,
        *,
        frames: str = "vtp",
        at: Mapping[float, Callable[[Simulation], Any]] | None = None,
        progress: bool | Callable[..., Any] = False,
    ) -> dict[str, Any]:
        """Runs to the end of the scene.

        Parameters
        ----------
        output : path, optional
            A new or empty folder for the run's files, as `corpuscle run --output` writes them. By default nothing is written. Arrays that
            stand for files of the scene are written beside it, into `<output>-inputs`.
        frames : {"vtp", "csv", "xyz", "none"}
            Format of the particle files.
        at : dict of float to callable, optional
            Functions by the times at which they are called with this simulation. Not together with `output`.
        progress : bool or callable
            True shows a bar, if `tqdm` is installed, else lines on standard error. A callable gets (time, end, particles, rate in particle-steps or
            collisions per second, seconds left or None).

        Returns
        -------
        dict
            The summary: status, particles, steps, simulated and wall-clock time, warnings and the ledger, as in `summary.json`.

        Raises
        ------
        RunError
            Where the computation breaks down or a file cannot be written; what was written stays readable. Also where `output` is given for a
            simulation that has advanced.
        KeyboardInterrupt
            After Ctrl-C. A run with `output` can be resumed by `resume`.
        """
        if output is not None and at:
            raise RunError("`output` and `at` are given together; read the files of the run afterwards, or leave `output` out")
        if output is not None and self.time > 0.0:
            raise RunError(
                f"the simulation has advanced to t = {self.time:g} already, so its files would lack the start; "
                "open the scene anew and run it with `output`"
            )
        if output is not None and self.scene._has_files:
            if self._is_touched:
                raise RunError("the simulation was changed before its run with `output`; give the changes to the scene, or leave `output` out")
            self._open_beside(Path(output))
        for moment in sorted(at or {}):
            self.advance(moment, progress=progress)
            at[moment](self)
        with reporter(progress) as report:
            return json.loads(self._native.run(None if output is None else Path(output), frames, report))

    def _open_beside(self, output: Path) -> None:
        """Opens the scene with its arrays in files beside that of the run, so that the run can be resumed and repeated from its files."""
        inputs = output.absolute().with_name(output.name + "-inputs")
        self._native = _native.Simulation(self.scene._parsed(inputs), self._number_of_threads, self.backend == "gpu")

    def advance(self, time: float | None = None, *, by: float | None = None, progress: bool | Callable[..., Any] = False) -> None:
        """Advances to a time, s, or by so much time.

        Rows of gauges that fall due on the way are kept, see `gauges`. The physics does not depend on where it is halted.

        Raises
        ------
        RunError
            Where the time is past or beyond the end of the scene, or the computation breaks down.
        KeyboardInterrupt
            After Ctrl-C: the state is sound, at the time reached.
        """
        if (time is None) == (by is None):
            raise RunError("advance needs a time, or `by`; give one of them, as in advance(10.0) or advance(by=0.5)")
        now, until = self.time, self.until
        target = float(now + by if time is None else time)
        if not now <= target <= until * (1 + 1e-12):
            raise RunError(
                f"cannot advance from t = {now:g} to {target:g}: times run from the present one to the end of the scene, {until:g}; "
                f'set "run.until_s" for a longer run'
            )
        with reporter(progress) as report:
            self._native.advance(min(target, until), report)

    def every(self, period: float) -> Iterator[float]:
        """Times at multiples of a period, to each of which the simulation has advanced: ``for t in simulation.every(0.5): ...``."""
        if not period > 0.0:
            raise RunError(f"a period of {period} does not end; give one above 0")
        count = int(self.time / period) + 1
        while count * period < self.until * (1 - 1e-9):
            self.advance(max(count * period, self.time))
            yield self.time
            count += 1
        if self.time < self.until:
            self.advance(self.until)
            yield self.time

    def change(self, **changes: Any) -> None:
        """Changes values while it runs, by their keys: ``simulation.change(**{"flood.manning": 0.06})``.

        Raises
        ------
        SceneError
            Where a key cannot be changed in a running scene; the message lists those that can.
        """
        for key, value in changes.items():
            self._native.change(key, written(key, value))
            self._is_touched = True

    def frame(self) -> Frame:
        """The particles now."""
        time, sets = self._native.frame()
        named = {}
        for name, columns in sets:
            arrays = {column: values for column, (values, _) in columns.items()}
            named[name] = Particles(name, arrays, {column: unit for column, (_, unit) in columns.items()})
        return Frame(time, named)

    def gauges(self) -> pandas.DataFrame:
        """Gauges over time: one row for each time at which they were due, one column for each quantity, such as ``P1.depth_m``.

        A value that is not a number says that there was nothing to measure. The rows are those of `gauges.csv` of a run.
        """
        pandas = _needs("pandas", "tables")
        headers, times, values = self._native.gauges()
        return pandas.DataFrame(values, columns=headers, index=pandas.Index(times, name="time_s"))

    def maps(self) -> xarray.Dataset:
        """Maps now, on the grid of the terrain; empty for a model without maps.

        Variables have dims ``("y", "x")`` with the coordinates of the cells' centres, rows from the north; cells that are dry, or outside, are not a
        number. Where the terrain has a reference system `spatial_ref` describes it, so that `rioxarray` reads it.
        """
        xarray = _needs("xarray", "maps")
        given = self._native.maps()
        grid = self._native.grid()
        if not given or grid is None:
            return xarray.Dataset()
        x, y, system, metres = grid
        coordinates = {"y": ("y", y, _axis("y", metres)), "x": ("x", x, _axis("x", metres))}
        variables = {}
        for name, title, unit, values in given:
            variables[name] = (("y", "x"), values, {"long_name": title, "units": unit or "1"})
        dataset = xarray.Dataset(variables, coordinates, {"Conventions": "CF-1.8", "time_s": self.time})
        return _with_system(dataset, system)

    def charts(self) -> dict[str, Chart]:
        """Charts of what was measured up to now, by name; of a gas the histogram of speeds and others."""
        return {chart["name"]: _chart(chart) for chart in self._native.charts()}

    def paths(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Trajectories of the particles that are followed: by name times, shape (n,), and points, shape (n, 3)."""
        return {name: (times, points) for name, times, points in self._native.paths()}

    def ledger(self) -> dict[str, Balance]:
        """Balances of what is conserved, such as ``water_m3`` or ``energy``."""
        return {quantity: Balance(*amounts) for quantity, amounts in self._native.ledger()}

    def picture(self, width: int = 960, height: int = 540) -> np.ndarray:
        """A picture as an array of bytes, shape (height, width, 4): red, green, blue, opacity.

        Raises
        ------
        RunError, SceneError
            Where there is no GPU and no software Vulkan to draw on.
        """
        return self._native.picture(width, height)

    def write_picture(self, path: str | os.PathLike[str], width: int = 1920, height: int = 1080) -> None:
        """Writes a picture as a PNG file.

        Raises
        ------
        RunError, SceneError
            As `picture`, and where the file cannot be written.
        """
        self._native.write_picture(Path(path), width, height)

    def save(self) -> bytes:
        """The whole state, to the bit."""
        return self._native.save()

    def restore(self, state: bytes) -> None:
        """Takes back a state that `save` gave for the same scene. Rows of gauges begin anew.

        Raises
        ------
        RunError, SceneError
            Where the bytes are damaged or belong to another scene.
        """
        self._native.restore(state)
        self._is_touched = True

    def __repr__(self) -> str:
        return f"<Simulation of {self.scene.name}: t = {self.time:g} of {self.until:g}, {self.particles} particles>"

    def _repr_html_(self) -> str:
        rows = [("time", f"{self.time:g} of {self.until:g}"), ("particles", self.particles), ("steps", self.steps)]
        rows += [(name, f"{balance.now:g} (error {balance.relative_error:.1e})") for name, balance in self.ledger().items()]
        cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(str(value))}</td></tr>" for name, value in rows)
        return f"<div><b>{html.escape(self.scene.title or self.scene.name)}</b>{self._drawn()}<table>{cells}</table></div>"

    def _drawn(self) -> str:
        """The picture as HTML; a line where there is nothing to draw on."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "picture.png"
            try:
                self.write_picture(path, 640, 360)
            except (RunError, SceneError) as error:
                return f"<p>no picture: {html.escape(str(error))}</p>"
            image = path.read_bytes()
        return f'<br><img alt="" width="640" src="data:image/png;base64,{base64.b64encode(image).decode()}">'


def resume(folder: str | os.PathLike[str], *, threads: int | None = None) -> Simulation:
    """Opens an interrupted run from its folder; `Simulation.run` goes on with it, into the same folder, to the same bits.

    Raises
    ------
    SceneError, RunError
        Where the folder holds no run, no checkpoint, or one that does not fit.
    """
    return Simulation._resumed(folder, threads)


def _threads(threads: int | None) -> int | None:
    if threads is not None and not 1 <= threads <= 1024:
        raise SceneError(f"threads = {threads} cannot be; give a whole number from 1 to 1024")
    return threads


def _needs(package: str, extra: str) -> Any:
    try:
        return __import__(package)
    except ImportError as error:
        raise ImportError(f"this needs {package}; install it with `pip install corpuscle[{extra}]`") from error


def _axis(name: str, metres: float | None) -> dict[str, str]:
    """Attributes of a coordinate whose unit is so many metres, in the convention CF; degrees for none."""
    if metres is None:
        word, unit = ("longitude", "degrees_east") if name == "x" else ("latitude", "degrees_north")
        return {"standard_name": word, "long_name": word.capitalize(), "units": unit, "axis": name.upper()}
    words = {"x": "Easting", "y": "Northing"}
    unit = "m" if metres == 1.0 else f"{metres!r} m"
    return {"standard_name": f"projection_{name}_coordinate", "long_name": words[name], "units": unit, "axis": name.upper()}


def _with_system(dataset: xarray.Dataset, system: str | None) -> xarray.Dataset:
    """The dataset with the description of its reference system, in the convention CF, if the name is known."""
    if system is None:
        return dataset
    dataset.attrs["crs"] = system
    try:
        import pyproj

        described = pyproj.CRS.from_user_input(system).to_cf()
    except Exception:  # no pyproj, or a name that it does not know: the attribute `crs` has the name
        return dataset
    described["spatial_ref"] = described["crs_wkt"]
    for name in dataset.data_vars:
        dataset[name].attrs["grid_mapping"] = "spatial_ref"
    return dataset.assign_coords(spatial_ref=((), 0, described))


def _chart(chart: dict[str, Any]) -> Chart:
    series = {}
    for name, points, errors in chart["series"]:
        series[name] = Series(name, points[:, 0], points[:, 1], errors if len(errors) else None)
    label, upwards = _label(chart["x"]), _label(chart["y"])
    return Chart(chart["name"], chart["title"], label, upwards, series, chart["note"])


def _label(axis: tuple[str, str]) -> str:
    return f"{axis[0]} [{axis[1]}]" if axis[1] else axis[0]
