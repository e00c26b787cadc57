"""Many instances: a thousand at once, in threads, over a fork, of two models, freed in any order; and reset ones."""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import fmu_crowd
import numpy as np
import pytest
from fmu_driver import ERROR, OK, Fmu
from fmu_exchange import Exchange
from fmu_helpers import ROOT, export, stale
from fmu_networks import CHANGES, gearbox
from fmu_states import Keeper, Run, new

import gearpath as gp

EITHER = pytest.mark.parametrize("version", [2, 3])
# What fits here; sanitizers (tests/safety) put room around every block and keep freed ones.
MEGABYTE = (1 << 20) * (32 if os.environ.get("GEARPATH_RUNTIME_LIBRARY") else 1)


@pytest.fixture(scope="module")
def fmus(unpacked, unpacked3):
    return {2: unpacked, 3: unpacked3}


@pytest.fixture(scope="module")
def other(tmp_path_factory):
    """Another model in another FMU of either version."""
    folder, network = tmp_path_factory.mktemp("other"), gearbox(2, mesh_moves_bearings=True)
    return {
        version: Fmu.unpack(export(network, folder / f"{version}.fmu", fmi=f"{version}.0"), folder / f"{version}")
        for version in (2, 3)
    }


@pytest.mark.slow
def test_a_thousand_instances(tmp_path):
    """The default gearbox with 144 states: less than 0.5 MB each, and each as if it were alone.

    One that left the modal form takes up to 2 MB more for its dense propagators and the matrix exponential.
    """
    assert not stale(), stale()
    path = gp.export_fmu(gp.load(ROOT / "models" / "gearbox.toml"), tmp_path / "it.fmu")
    command = [sys.executable, fmu_crowd.__file__, path, tmp_path / "it"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["same"]
    assert found["distinct"] == fmu_crowd.COUNT
    assert found["made"] < 0.5 * MEGABYTE
    assert found["stepped"] < 0.5 * MEGABYTE
    assert found["changed"] < 2 * MEGABYTE


def whole_run(unpacked, seed: int) -> tuple[np.ndarray, bytes]:
    """An instance from its birth to its end, with changes, states and a reset on the way."""
    rng, fmu = np.random.default_rng(seed), new(unpacked)
    fmu.start()
    run, found = Run(fmu, made=seed), []
    for i in range(60):
        if i % 20 == 5:
            run.set(CHANGES | {"gear_train.modal_damping": float(rng.uniform(0.01, 0.2))})
        if i % 20 == 15:
            run.set({"bearing_1.stiffness": np.diag(rng.uniform([5e7, 1e4], [2e8, 1e5])), "frequency": 50.0 + i})
        found.append(run.step(float(rng.choice([1e-5, 2e-5, 1e-4]))))
        if i == 30:
            content = fmu.serialised()
            assert fmu.call(f"fmi{unpacked.description.fmiVersion[0]}Reset") == OK
            assert Keeper(fmu).take(content) == OK
    end = fmu.serialised()
    fmu.free()
    return np.array(found), end


@EITHER
def test_threads(fmus, other, version):
    """Instances of two FMUs, made, stepped, changed and freed in eight threads at once: as one after another."""
    jobs = [((fmus, other)[seed % 2][version], seed) for seed in range(16)]
    wanted = [whole_run(*job) for job in jobs]
    with ThreadPoolExecutor(8) as pool:
        for _ in range(2):
            for found, expected in zip(pool.map(whole_run, *zip(*jobs)), wanted):
                assert np.array_equal(found[0], expected[0])
                assert found[1] == expected[1]


@EITHER
def test_fork(fmus, version, tmp_path):
    """A child goes on with its copies, modal and dense, and the parent with its own."""
    runs = []
    for changes in ({}, CHANGES):
        fmu = new(fmus[version])
        fmu.start()
        runs.append(Run(fmu))
        runs[-1].set(changes)
        for _ in range(5):
            runs[-1].step(1e-5)
    child = os.fork()
    if child == 0:  # whatever happens, it must not come back into pytest
        try:
            for i, run in enumerate(runs):
                found, end = run.go_on()
                np.save(tmp_path / f"{i}.npy", found)
                (tmp_path / f"{i}.end").write_bytes(end)
                run.fmu.free()
        finally:
            os._exit(0)
    os.waitpid(child, 0)
    for i, run in enumerate(runs):
        found, end = run.go_on()
        assert np.array_equal(found, np.load(tmp_path / f"{i}.npy"))
        assert end == (tmp_path / f"{i}.end").read_bytes()
        run.fmu.free()


def test_two_models_in_one_process(fmus, other):
    """Step by step in turns, two models in both versions of FMI: as each alone."""
    everything = [*fmus.values(), *other.values()]

    def begun(unpacked):
        fmu = new(unpacked)
        fmu.start()
        return Run(fmu)

    def step(run, i):
        if i == 10:
            run.set(CHANGES)
        return run.step(1e-5)

    runs, alone = [begun(unpacked) for unpacked in everything], []
    turns = [[step(run, i) for run in runs] for i in range(20)]
    for unpacked in everything:
        run = begun(unpacked)
        alone.append([step(run, i) for i in range(20)])
        run.fmu.free()
    for k, run in enumerate(runs):
        assert np.array_equal([turn[k] for turn in turns], alone[k])
        run.fmu.free()
    assert not np.array_equal(alone[0][-1], alone[2][-1])


@EITHER
@pytest.mark.parametrize("exchange", [False, True], ids=["cs", "me"])
def test_reset_from_anywhere(fmus, version, exchange):
    """An instance that was reset is one that was just made: same state, same run, bit by bit."""
    fresh = new(fmus[version], exchange=exchange)
    start = fresh.serialised()
    phases = ["event", "continuous"] if exchange else ["stepping"]
    for phase in ("instantiated", "initialization", *phases, "terminated"):
        fmu = new(fmus[version], exchange=exchange)
        fmu.enter(phase)
        if phase in ("event", "stepping"):
            Exchange(fmu, version).set(CHANGES | {"frequency": 77.0, "mesh.force": 3.0})
            fmu.get(["alpha", "bearing_1.force_uy"])
        if phase == "stepping":
            assert fmu.step(0.0, 3e-4) == OK
            assert fmu.set({"mesh.transmission_error": 1e308}) == OK
            assert fmu.step(3e-4, 3e-4) == ERROR
            assert version == 3 or fmu.set_slopes({"frequency": 10.0, "mesh.force": 2.0}) == OK
        assert fmu.call(f"fmi{version}Reset") == OK
        assert fmu.serialised() == start
        if not exchange:
            fmu.start()
            other = new(fmus[version])
            other.start()
            again, first = Run(fmu).go_on(), Run(other).go_on()
            assert np.array_equal(again[0], first[0])
            assert again[1] == first[1]
            other.free()
        fmu.free()
    fresh.free()


@EITHER
def test_freed_in_any_order(fmus, other, version):
    """Those that are left do not notice."""
    rng, runs = np.random.default_rng(6), []
    for k in range(24):
        fmu = new((fmus, other)[k % 2][version])
        fmu.start()
        runs.append(Run(fmu, made=k))
    alone = [run.go_on()[0] for run in runs[:2]]
    left = [runs[i] for i in 2 + rng.permutation(22)]
    for run in runs[:2]:
        run.fmu.free()
    while left:
        left.pop().fmu.free()
        for run in left:
            run.step(1e-5)
    for k in (0, 1):
        fmu = new((fmus, other)[k][version])
        fmu.start()
        assert np.array_equal(Run(fmu, made=k).go_on()[0], alone[k])
        fmu.free()


def test_resources_are_given_back(fmus):
    """Two thousand lives of an instance and its states do not make the process grow."""

    def live(count):
        for _ in range(count):
            fmu = new(fmus[2])
            fmu.start()
            keeper = Keeper(fmu)
            keeper.free(keeper.keep())
            fmu.free()
        return fmu_crowd.resident()

    first, open_before = live(500), len(list(Path("/proc/self/fd").iterdir()))
    assert live(2000) - first < MEGABYTE
    assert len(list(Path("/proc/self/fd").iterdir())) == open_before
