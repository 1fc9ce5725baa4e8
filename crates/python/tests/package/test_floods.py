"""Ensembles of floods: the same maps from any executor, and the same as from single runs."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import corpuscle as cp
import numpy as np
import pytest
from corpuscle import ensemble

KEYS = {"flood.manning": (0.02, 0.08), "flood.inflow.0.discharge_m3_per_s.1.1": (500.0, 1500.0)}


@pytest.fixture(scope="module")
def scene():
    return cp.Scene("flood/valley", **{"run.until_s": 60.0, "flood.spacing_m": 16.0})


@pytest.fixture(scope="module")
def plan():
    return ensemble.latin_hypercube(KEYS, members=6, seed=5)


@pytest.fixture(scope="module")
def here(scene, plan, tmp_path_factory):
    return ensemble.run(scene, plan, tmp_path_factory.mktemp("here") / "floods")


def maps_of(result):
    return result.percentiles("max_depth", [10, 50, 90]).to_numpy(), result.probability("max_depth", above=0.1).to_numpy()


def test_statistics_are_those_of_single_runs(scene, plan, here):
    depths = []
    for _, row in plan.iterrows():
        simulation = cp.Simulation(scene.changed(**row.to_dict()))
        simulation.run()
        depths.append(simulation.maps()["max_depth"].fillna(0.0).to_numpy())
    assert not here.failed
    percentiles, probability = maps_of(here)
    np.testing.assert_array_equal(probability, np.mean(np.array(depths) > 0.1, axis=0))
    np.testing.assert_allclose(percentiles, np.percentile(depths, [10, 50, 90], axis=0), atol=1e-6)
    assert probability.max() == 1.0 and np.any((probability > 0.0) & (probability < 1.0))


@pytest.mark.parametrize("kind", ["threads", "processes", "dask"])
def test_any_executor_gives_the_same_maps(kind, scene, plan, here, tmp_path):
    if kind == "dask":
        distributed = pytest.importorskip("distributed")
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with distributed.Client(cluster) as client:
                result = ensemble.run(scene, plan, tmp_path / "floods", executor=client.get_executor())
    else:
        with (ThreadPoolExecutor if kind == "threads" else ProcessPoolExecutor)(2) as executor:
            result = ensemble.run(scene, plan, tmp_path / "floods", executor=executor)
    assert not result.failed
    for given, expected in zip(maps_of(result), maps_of(here)):
        np.testing.assert_array_equal(given, expected)


def test_a_member_that_is_refused_is_told(scene, tmp_path):
    result = ensemble.run(scene, ensemble.grid({"flood.manning": [0.03, -1.0]}), tmp_path / "floods")
    assert result.finished == [0]
    assert result.failed[1].key == "flood.manning" and "-1" in result.failed[1].message


def test_a_gas_has_means_with_standard_errors(tmp_path):
    gas = cp.Scene("gas/maxwell", **{"run.until_s": 5.0})
    result = ensemble.run(gas, ensemble.grid({"seed": list(range(1, 9))}), tmp_path / "gases")
    means = result.gauge_means()
    assert not result.failed and "gas.pressure_virial" in str(means)
