"""Modes that take parts of several damping ratios, as those of measured or rigidly joined components do."""

from dataclasses import replace

import fmu_oracle as oracle
import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu
from fmu_helpers import export
from fmu_networks import gearbox

HERTZ = (180.0, 900.0, 2750.0)


def shared(network):
    """The same network whose elastic modes take random parts of the ratios of three components."""
    rng = np.random.default_rng(5)
    ratios = {"first": 0.01, "second": 0.03, "third": 0.0}
    shares = {name: rng.uniform(0, 2, len(network.eigenvalues)) for name in ratios}
    shares["second"][::3] = 0
    return replace(network, modal_damping=ratios, damping_shares=shares)


@pytest.fixture(scope="module")
def network():
    return shared(gearbox())


@pytest.fixture(scope="module", params=[2, 3])
def instance(request, network, tmp_path_factory):
    folder = tmp_path_factory.mktemp("shares")
    path = export(network, folder / "it.fmu", fmi=f"{request.param}.0")
    fmu = {2: Fmu, 3: Fmu3}[request.param](Fmu.unpack(path, folder / "it"))
    fmu.start()
    yield fmu
    fmu.free()


def test_frequency_outputs_follow_every_ratio(network, instance):
    for ratios in ({}, {"first": 0.02, "second": 0.005, "third": 0.04}, dict(network.modal_damping)):
        current = replace(network, modal_damping=dict(network.modal_damping) | ratios)
        assert instance.set({f"{name}.modal_damping": zeta for name, zeta in ratios.items()}) == OK
        for hertz in HERTZ:
            assert instance.set({"frequency": hertz}) == OK
            wanted = oracle.frequency_response(current, hertz)
            found = instance.get(list(wanted))
            assert found == pytest.approx(list(wanted.values()), rel=1e-9, abs=1e-12 * max(map(abs, wanted.values())))


def test_steps_follow_the_shares(network, tmp_path):
    path = export(network, tmp_path / "it.fmu")
    fmu = Fmu(Fmu.unpack(path, tmp_path / "it"))
    fmu.start()
    inputs = [load.name for load in network.loads]
    u = np.array([1e-6 if load.is_transmission_error else 1.0 for load in network.loads])
    U = np.tile(u, (60, 1))
    wanted, names = oracle.first_order_hold(network, U, 2e-5)
    found = fmu.run(inputs, U, 2e-5, names)[: len(U)]
    assert np.max(abs(found - wanted) / abs(wanted).max(axis=0)) < 1e-9
    fmu.free()
