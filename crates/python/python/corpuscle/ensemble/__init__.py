"""Ensembles: many runs of one scene with changed values, and statistics over them.

    import corpuscle
    from corpuscle import ensemble

    plan = ensemble.latin_hypercube({"flood.manning": (0.02, 0.06)}, members=100, seed=1)
    result = ensemble.run("flood/valley", plan, "runs/valley-manning")
    result.probability("max_depth", above=0.3)
    result.report("runs/valley-manning/report.html")

`run` takes an executor, on which members run at the same time. With a ProcessPoolExecutor the call must stand under
``if __name__ == "__main__":``, as for all uses of multiprocessing.
"""

from .errors import EnsembleError, MissingPackage, WorkerLost
from .member import Failure
from .plans import grid, latin_hypercube, sobol
from .results import Ensemble, Statistics, open
from .runner import Progress, run

__all__ = [
    "Ensemble",
    "EnsembleError",
    "Failure",
    "MissingPackage",
    "Progress",
    "Statistics",
    "WorkerLost",
    "grid",
    "latin_hypercube",
    "open",
    "run",
    "sobol",
]
