"""Simulations: the same bits as the command line, arrays, changes, threads, Ctrl-C."""

import filecmp
import json
import os
import signal
import subprocess
import sys
import threading
import time

import corpuscle as cp
import numpy as np
import pandas
import pytest


def command(*arguments, **named):
    return subprocess.run([sys.executable, "-m", "corpuscle", *map(str, arguments)], capture_output=True, text=True, **named)


@pytest.mark.parametrize("fixture", ["gas", "flood"])
def test_a_run_has_the_bits_of_the_command_line(fixture, request, tmp_path):
    scene = request.getfixturevalue(fixture)
    file = tmp_path / "scene.toml"
    file.write_text(scene.toml)
    done = command("run", file, "--output", tmp_path / "command", "--backend", "cpu", "--threads", 1)
    assert done.returncode == 0, done.stderr
    summary = cp.Simulation(scene).run(tmp_path / "python")
    assert summary["status"] == "done"
    names = sorted(path.name for path in (tmp_path / "command" / "frames").iterdir())
    assert len(names) > 2
    same, different, missing = filecmp.cmpfiles(tmp_path / "command/frames", tmp_path / "python/frames", names, shallow=False)
    assert (different, missing) == ([], [])
    assert (tmp_path / "command/gauges.csv").read_bytes() == (tmp_path / "python/gauges.csv").read_bytes()


def test_frames_and_gauges_are_those_of_the_files(gas, tmp_path):
    simulation = cp.Simulation(gas)
    simulation.run(tmp_path / "run", frames="csv")
    files = sorted((tmp_path / "run/frames").glob("*.csv"))
    written = pandas.read_csv(files[-1], float_precision="round_trip")
    frame = simulation.frame()
    given = next(iter(frame.values()))
    assert frame.time == simulation.time == simulation.until
    x = next(name for name in written.columns if name.startswith("x"))
    np.testing.assert_array_equal(np.sort(written[x]), np.sort(given["position"][:, 0]))
    gauges = pandas.read_csv(tmp_path / "run/gauges.csv", index_col=0, float_precision="round_trip")
    np.testing.assert_array_equal(gauges.to_numpy(), simulation.gauges().to_numpy())
    np.testing.assert_array_equal(gauges.index, simulation.gauges().index)
    assert list(gauges.columns) == list(simulation.gauges().columns)


def test_where_it_is_halted_does_not_matter(gas):
    whole, halted = cp.Simulation(gas), cp.Simulation(gas)
    whole.run()
    for moment in [0.1234, 0.5, 0.5, 1.9999]:
        halted.advance(moment)
        assert halted.time == moment
    halted.run()
    assert whole.save() == halted.save()
    pandas.testing.assert_frame_equal(whole.gauges(), halted.gauges())


def test_arrays_are_the_callers_own(gas):
    simulation = cp.Simulation(gas)
    balls = next(iter(simulation.frame().values()))
    assert balls["position"].shape == (200, 3) and balls.count == 200 and balls["position"].flags.c_contiguous
    before = balls["position"].copy()
    simulation.advance(by=0.5)
    np.testing.assert_array_equal(balls["position"], before)
    balls["position"][:] = 0.0
    after = next(iter(simulation.frame().values()))["position"]
    assert not np.array_equal(after, before) and np.abs(after).max() > 1.0
    assert balls.units["position"] == ""


def test_energy_from_the_arrays_is_that_of_the_ledger(gas):
    simulation = cp.Simulation(gas)
    simulation.advance(1.0)
    balls = next(iter(simulation.frame().values()))
    energy = 0.5 * (balls["mass"] * (balls["velocity"] ** 2).sum(axis=1)).sum()
    assert simulation.ledger()["energy"].now == pytest.approx(energy, rel=1e-12)


def test_maps_have_coordinates_and_values(flood):
    simulation = cp.Simulation(flood)
    assert simulation.maps()["max_depth"].dims == ("y", "x")
    simulation.run()
    maps = simulation.maps()
    assert maps.sizes == {"y": 200, "x": 400}
    assert maps.x[0] == 2.5 and maps.x[-1] == 1997.5 and maps.y[0] > maps.y[-1]
    depth = maps["depth"].fillna(0.0)
    volume = float(depth.sum()) * 25.0
    assert volume == pytest.approx(simulation.ledger()["water_m3"].now, rel=0.05)
    assert maps["max_depth"].attrs["units"] == "m"


def test_other_models_have_no_maps(gas):
    assert len(cp.Simulation(gas).maps()) == 0


def test_charts_carry_maxwells_curve(gas):
    simulation = cp.Simulation(gas.changed(**{"run.until_s": 20.0}))
    simulation.run()
    speeds = simulation.charts()["speed_histogram"].series
    curve = np.interp(speeds["balls"].x, speeds["Maxwell"].x, speeds["Maxwell"].y)
    width = np.diff(speeds["balls"].x).mean()
    assert np.abs(speeds["balls"].y - curve).sum() * width < 0.25


def test_functions_are_called_at_their_times(gas):
    seen = []
    cp.Simulation(gas).run(at={1.5: lambda running: seen.append(running.time), 0.25: lambda running: seen.append(running.time)})
    assert seen == [0.25, 1.5]
    assert list(cp.Simulation(gas).every(0.75)) == [0.75, 1.5, 2.0]


def test_a_live_change_changes_the_physics(gas):
    key = "gas.walls.x_min.thermal.temperature"
    walled = gas.changed(**{"gas.walls.x_min": {"thermal": {"temperature": 1e4}}, "run.until_s": 10.0})
    same, heated = cp.Simulation(walled), cp.Simulation(walled)
    for simulation in (same, heated):
        simulation.advance(1.0)
    heated.change(**{key: 1e5})
    for simulation in (same, heated):
        simulation.run()
    temperature = [simulation.gauges()["gas.temperature"].iloc[-1] for simulation in (same, heated)]
    assert temperature[1] > 1.5 * temperature[0]
    with pytest.raises(cp.SceneError, match=key):
        heated.change(**{"gas.species.0.radius": 2.0})
    with pytest.raises(cp.SceneError, match="hot"):
        heated.change(**{key: "hot"})
    with pytest.raises(cp.SceneError) as caught:
        heated.change(**{key: -1.0})
    assert caught.value.key == key
    with pytest.raises(cp.SceneError, match="no value of this scene can"):
        cp.Simulation(gas).change(**{"gas.species.0.radius": 2.0})


def test_a_saved_state_goes_on_to_the_same_bits(flood):
    first, second = cp.Simulation(flood), cp.Simulation(flood)
    first.advance(30.0)
    second.restore(first.save())
    first.run()
    second.run()
    assert first.save() == second.save()
    with pytest.raises(cp.Error):
        second.restore(b"nothing of the kind")


def test_threads_do_not_change_the_bits(flood):
    states = []
    for threads in (1, 2, 3):
        simulation = cp.Simulation(flood, threads=threads)
        simulation.run()
        states.append(simulation.save())
    assert states[0] == states[1] == states[2]


def test_two_threads_of_python_run_two_models_at_once(gas, flood):
    simulations = [cp.Simulation(gas, threads=1), cp.Simulation(flood, threads=1)]
    ticks = 0
    workers = [threading.Thread(target=simulation.run) for simulation in simulations]
    for worker in workers:
        worker.start()
    while any(worker.is_alive() for worker in workers):
        ticks += 1
        time.sleep(0.001)
    assert ticks > 5, "Python goes on while simulations compute"
    assert all(simulation.time == simulation.until for simulation in simulations)


def test_a_simulation_in_use_says_so(flood):
    simulation = cp.Simulation(flood)
    failures = []

    def ask(*_):
        try:
            simulation.frame()
        except cp.RunError as error:
            failures.append(str(error))

    simulation.run(progress=ask)
    assert failures and "advances at the moment" in failures[0]


def test_the_end_is_reported(gas):
    reports = []
    cp.Simulation(gas).run(progress=lambda time, until, *_: reports.append((time, until)))
    assert reports[-1] == (2.0, 2.0)


def test_an_exception_of_a_callback_stops_the_run(gas):
    def stop(*_):
        raise KeyError("enough")

    simulation = cp.Simulation(gas.changed(**{"run.until_s": 2000.0}))
    with pytest.raises(KeyError, match="enough"):
        simulation.run(progress=stop)
    assert 0.0 <= simulation.time < 2000.0
    simulation.advance(by=0.1)


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
def test_ctrl_c_stops_a_run_that_can_be_resumed(gas, tmp_path):
    # Seconds, so that it is not over before the signal comes on a busy machine.
    long = gas.changed(**{"run.until_s": 300.0})
    (tmp_path / "scene.toml").write_text(long.toml)
    text = """
import sys, corpuscle as cp
scene, folder = sys.argv[1:]
try:
    cp.Simulation(cp.Scene(scene)).run(folder, progress=lambda *_: print("on", flush=True))
except KeyboardInterrupt:
    print("stopped")
"""
    arguments = [sys.executable, "-c", text, str(tmp_path / "scene.toml"), str(tmp_path / "run")]
    running = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
    assert running.stdout.readline() == "on\n"
    running.send_signal(signal.SIGINT)
    rest, _ = running.communicate(timeout=60)
    assert rest.endswith("stopped\n")
    resumed = cp.resume(tmp_path / "run")
    assert 0.0 < resumed.time < 300.0
    with pytest.raises(cp.RunError, match="by `run` alone"):
        resumed.advance(by=0.1)
    assert resumed.run()["status"] == "done"
    whole = cp.Simulation(long)
    whole.run(tmp_path / "whole")
    assert (tmp_path / "whole/gauges.csv").read_bytes() == (tmp_path / "run/gauges.csv").read_bytes()


@pytest.mark.parametrize("wrong", [-1.0, 5.0, float("nan")])
def test_times_out_of_range_are_refused(gas, wrong):
    with pytest.raises(cp.RunError, match="run.until_s"):
        cp.Simulation(gas).advance(wrong)


def test_a_full_folder_is_refused(gas, tmp_path):
    (tmp_path / "something").write_text("here")
    with pytest.raises(cp.Error, match="empty|holds|exists"):
        cp.Simulation(gas).run(tmp_path)
    assert (tmp_path / "something").read_text() == "here"


def test_a_missing_terrain_is_named(tmp_path):
    text = 'title = "none"\n[run]\nuntil_s = 1.0\n[terrain.file]\npath = "missing.tif"\n[flood]\nspacing_m = 5.0\n'
    with pytest.raises(cp.SceneError, match="missing.tif"):
        cp.Simulation(cp.Scene(text, folder=tmp_path))


def test_the_command_answers_and_refuses():
    done = command("scenes", "--json")
    assert done.returncode == 0 and "flood/valley" in json.dumps(json.loads(done.stdout))
    assert command("run", "flood/valey").returncode == 2


def test_memory_stays_flat_over_many_runs(gas):
    small = gas.changed(**{"run.until_s": 0.02})

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    if not os.path.exists("/proc/self/statm"):
        pytest.skip("resident memory is read from /proc")

    def runs(count):
        for _ in range(count):
            simulation = cp.Simulation(small, threads=1)
            simulation.run()
            simulation.frame()
            simulation.gauges()

    runs(100)
    before = resident()
    runs(900)
    assert resident() - before < 8e6


def test_a_picture_is_drawn_where_there_is_a_device(gas):
    simulation = cp.Simulation(gas)
    try:
        picture = simulation.picture(320, 180)
    except cp.Error as error:
        if os.environ.get("CORPUSCLE_REQUIRE_GPU"):
            raise
        pytest.skip(f"nothing to draw on: {error}")
    assert picture.shape == (180, 320, 4) and picture.dtype == np.uint8
    assert picture[..., :3].std() > 5.0
    assert "data:image/png" in simulation._repr_html_()
