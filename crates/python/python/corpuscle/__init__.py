"""Particle physics from Python: gases of colliding balls, dew on cold solids, floods on terrain.

>>> import corpuscle as cp
>>> simulation = cp.Simulation(cp.Scene("gas/maxwell", **{"run.until_s": 5.0}))
>>> summary = simulation.run()
>>> simulation.gauges()["gas.temperature"].mean()   # doctest: +SKIP

`scenes()` lists the built-in scenes. The guide tells what a scene file can say; each key can be given here, too.
"""

from importlib.metadata import PackageNotFoundError, version

from ._errors import Error, RunError, SceneError
from ._raster import Raster
from ._scene import Scene, scenes
from ._simulation import Balance, Chart, Frame, Particles, Series, Simulation, resume

try:
    __version__ = version("corpuscle")
except PackageNotFoundError:  # imported from its source folder
    __version__ = "0+unknown"

__all__ = [
    "Balance",
    "Chart",
    "Error",
    "Frame",
    "Particles",
    "Raster",
    "RunError",
    "Scene",
    "SceneError",
    "Series",
    "Simulation",
    "resume",
    "scenes",
]
