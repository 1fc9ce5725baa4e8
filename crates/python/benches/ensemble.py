"""Times an ensemble of 64 small floods on executors, and compares the maps: python ensemble.py [FOLDER]."""

import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import corpuscle as cp
import distributed
from corpuscle import ensemble

RANGES = {"flood.manning": (0.02, 0.08), "flood.inflow.0.discharge_m3_per_s.1.1": (500.0, 1500.0)}


def maps_of(result):
    return result.percentiles("max_depth", [5, 50, 95]).to_numpy().tobytes() + result.probability("max_depth", above=0.3).to_numpy().tobytes()


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
    scene = cp.Scene("flood/valley", **{"run.until_s": 120.0, "flood.spacing_m": 12.0})
    plan = ensemble.sobol(RANGES, members=64, seed=5)
    # What the first use of a package costs is not measured.
    ensemble.run(scene, plan, folder / "first", members=[0])

    def timed(name, executor):
        start = time.perf_counter()
        result = ensemble.run(scene, plan, folder / name, executor)
        print(f"{name}: {time.perf_counter() - start:.1f} s", flush=True)
        return maps_of(result)

    maps = []
    for turn in (1, 2):
        maps.append(timed(f"one after another {turn}", None))
        with ProcessPoolExecutor(2) as processes:
            maps.append(timed(f"two processes {turn}", processes))
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with distributed.Client(cluster) as client:
                maps.append(timed(f"two dask workers {turn}", client))
    print("the same maps:", len(set(maps)) == 1)


if __name__ == "__main__":
    main()
