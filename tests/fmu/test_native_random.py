"""The C runtime's frequency-domain outputs and steps against the solver, on random gearboxes of any dofs."""

import numpy as np
import pytest
from fmu_driver import OK, Fmu
from fmu_helpers import export
from systems import random_gearbox

from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.time_twin import time_twin
from gearpath.numerics.propagator import discretise


@pytest.mark.parametrize("seed", [7, 52, 80, 3, 11, 23, 104])
def test_native_kind_equals_the_solver(seed, tmp_path):
    """7, 52 and 80 have stiffness about the shaft axis, which resists the spin of a transmission error itself."""
    network = assemble(random_gearbox(seed, seed % 8 + 1)).modal()
    fmu = Fmu(Fmu.unpack(export(network, tmp_path / "it.fmu"), tmp_path / "unpacked"))
    fmu.start()
    frequencies = np.array([35.0, 470.0, 3100.0])
    flow = power_flow(network, 2 * np.pi * frequencies)
    gross = abs(flow.path_power).sum(axis=0) / flow.input_power
    for k, f in enumerate(frequencies):
        assert fmu.set({"frequency": f}) == OK
        assert abs(fmu.get(["alpha"])[0] - flow.share()[k]) < 1e-7 * gross[k]
    outputs = [o for o in network.outputs if o.quantity != "power"]
    twin = time_twin(network, outputs)
    step = discretise(twin.A, twin.B, 1e-5)
    x, u = np.zeros(len(twin.A)), np.array([1e-6 if load.is_transmission_error else 1.0 for load in twin.loads])
    found = fmu.run([load.name for load in twin.loads], np.tile(u, (200, 1)), 1e-5, [o.name for o in outputs])
    expected = np.array(
        [twin.C @ x + twin.D @ u] + [twin.C @ (x := step.step(x, u, 0 * u)) + twin.D @ u for _ in range(200)]
    )
    assert np.max(abs(found - expected) / abs(expected).max(axis=0)) < 1e-9
    fmu.free()
