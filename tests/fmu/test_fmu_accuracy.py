"""The native FMU against python-control in modal coordinates, by the functions of benchmarks/fmu_accuracy.py."""

import importlib.util
from pathlib import Path

import pytest

import gearpath as gp

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def benchmark():
    spec = importlib.util.spec_from_file_location("fmu_accuracy", ROOT / "benchmarks" / "fmu_accuracy.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def model():
    return gp.load(ROOT / "models" / "gearbox.toml")


@pytest.mark.slow
@pytest.mark.parametrize("step", [1e-6, 1e-5, 1e-4])
@pytest.mark.parametrize(("linear", "limit"), [(False, 1e-12), (True, 1e-11)])
@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_ten_thousand_steps(benchmark, model, tmp_path, fmi, linear, limit, step):
    path = gp.export_fmu(model, tmp_path / "gearbox.fmu", fmi=fmi)
    found, _ = benchmark.deviation(model, path, step, linear=linear)
    assert 0 < found < limit  # exactly 0 would mean that it was compared with itself
