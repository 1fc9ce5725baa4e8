"""A stand-in for the native package: the same classes, with an analytic model, for tests of `corpuscle.ensemble`.

The scene's keys are numbers: `flood.manning`, `flood.level`, `run.until_s`, `grid.rows`, `grid.columns`, and for tests
`test.fail`, `test.sleep_s`, `test.die` (a file: the process ends by SIGKILL unless it exists).
"""

from __future__ import annotations

import os
import signal
import time
import tomllib
from pathlib import Path

import numpy as np
import pandas
import xarray

# The subpackage under test, in the source folder.
__path__.append(str(Path(__file__).parents[4] / "python" / "corpuscle"))
__version__ = "0"
_DEFAULTS = {
    "flood.manning": 0.03, "flood.level": 1.0, "run.until_s": 10.0, "grid.rows": 12, "grid.columns": 17,
    "test.fail": False, "test.sleep_s": 0.0, "test.die": "", "test.name": "plain",
}  # fmt: skip
CRS = "EPSG:32632"


class Error(Exception):
    def __init__(self, message, key=None, line=None, remedy=None):
        super().__init__(message)
        self.message, self.key, self.line, self.remedy = message, key, line, remedy

    def __reduce__(self):
        return Error, (self.message, self.key, self.line, self.remedy)


class Scene:
    def __init__(self, source, **changes):
        values = tomllib.loads(source) if "=" in source else {}
        self.name, self.model = ("test" if "=" in source else source), "flood"
        self.values = {**_DEFAULTS, **values, **changes}

    @property
    def toml(self):
        return "".join(f'"{key}" = {repr(value).lower()}\n' for key, value in self.values.items())

    def changed(self, **changes):
        for key in changes:
            if key not in _DEFAULTS:
                raise Error(f"There is no key {key}.", key=key, line=3, remedy="Did you mean flood.manning?")
        scene = Scene(self.name)
        scene.values = {**self.values, **changes}
        return scene


class Simulation:
    def __init__(self, scene, threads=None, backend="cpu"):
        self.scene, self.values, self.time, self.until = scene, scene.values, 0.0, scene.values["run.until_s"]
        if self.values["test.fail"]:
            raise Error("The level <b>rises</b> & breaks.", key="flood.level", line=7, remedy="Lower it.")

    def run(self, output=None, progress=False):
        time.sleep(self.values["test.sleep_s"])
        if (flag := self.values["test.die"]) and not os.path.exists(flag):
            Path(flag).touch()
            os.kill(os.getpid(), signal.SIGKILL)
        self.time = self.until
        return {"status": "done", "wall_time_s": 0.0, "ratio": float("nan")}

    def gauges(self):
        times = np.arange(0.0, self.until + 0.5, 1.0)
        depth = self.values["flood.level"] * (1 - np.exp(-times * 0.1 / self.values["flood.manning"] / 10))
        return pandas.DataFrame({"P1.depth_m": depth, "P1.level_m": depth + 100.0}, index=pandas.Index(times, name="time_s"))

    def maps(self):
        rows, columns = self.values["grid.rows"], self.values["grid.columns"]
        x, y = 1000.0 + 10.0 * np.arange(columns), 2000.0 - 10.0 * np.arange(rows)
        bed = np.hypot((x - x.mean())[None, :], (y - y.mean())[:, None]) / (5.0 * max(rows, columns))
        depth = self.values["flood.level"] * (1.2 - self.values["flood.manning"]) - bed
        depth = np.where(depth > 0.01, depth, np.nan).astype(np.float32)
        depth[0, 0] = np.nan  # outside
        arrival = (100.0 * self.values["flood.manning"] / depth).astype(np.float32)
        maps = {
            "max_depth": (depth, "m", "largest depth"),
            "max_level": (depth + bed.astype(np.float32), "m", "highest water level"),
            "arrival_time": (arrival, "s", "time of first wetting"),
        }
        return xarray.Dataset(
            {name: (("y", "x"), values, {"units": units, "long_name": title}) for name, (values, units, title) in maps.items()},
            coords={"x": ("x", x, {"units": "m"}), "y": ("y", y, {"units": "m"})},
            attrs={"crs": CRS},
        )
