"""The FMU's frequency-domain outputs against the solver, before and after its parameters are exchanged."""

import numpy as np

from ...network.modal import ModalNetwork
from ...network.power import PowerFlow, is_moment_path, power_flow, ratio
from ...network.response import frequency_response
from ...network.synthesis import Synthesis
from ...numerics.arrays import Complex, Real
from ..checks import Check
from ..simulation import RunningFmu
from .exchange import parameters
from .measure import Drive, largest_deviation, relative, spring_force

_LINES, _EXCHANGED_LINES = 25, 5


def checks(
    fmu: RunningFmu, network: ModalNetwork, changed: ModalNetwork, band: tuple[float, float], limit: float
) -> list[Check]:
    """Power ratios and transfers over the band; again with all parameters exchanged, and when they are set back."""
    few = np.geomspace(*band, _EXCHANGED_LINES)
    before = deviation(fmu, network, np.geomspace(*band, _LINES))
    fmu.set(parameters(changed))
    exchanged = deviation(fmu, changed, few)
    fmu.set(parameters(network))
    return [
        Check(
            "frequency-domain outputs against the power flow",
            before,
            limit,
            f"power ratios and transfers of all outputs at {_LINES} frequencies",
        ),
        Check(
            "the same with all joints and dampings exchanged",
            float(np.max([exchanged, deviation(fmu, network, few)])),
            limit,
            f"at {_EXCHANGED_LINES} frequencies, and after they were set back",
        ),
    ]


def deviation(fmu: RunningFmu, network: ModalNetwork, f: Real) -> float:
    """Largest deviation of the power ratios (relative to what flows) and of the transfers (of their yardstick)."""
    ratios, transfers = _read(fmu, network, f)
    omega = 2 * np.pi * f
    flow = power_flow(network, omega)
    expected, size = expected_ratios(network, flow, omega)
    linear = [o for o in network.outputs if o.quantity != "power"]
    load = next(item for item in network.loads if item.name == network.excitation)
    exact = frequency_response(network, omega, linear, [load])[:, :, 0]
    force = load.equivalent_mass * omega[-1] ** 2 or 1.0
    drive = Drive(force, float(omega[-1]), 1e-4 * spring_force(network, load))
    names = [o.name for o in linear]
    moved = largest_deviation(linear, dict(zip(names, transfers.T)), dict(zip(names, exact.T)), drive)
    return float(np.max([relative(abs(ratios - expected), size[:, None]), moved]))


def _read(fmu: RunningFmu, network: ModalNetwork, f: Real) -> tuple[Real, Complex]:
    """Power ratios (F, 3 + paths) and transfers (F, linear outputs) as the FMU gives them."""
    ratios = ["alpha", "alpha_force", "alpha_moment", *(f"{name}.alpha" for name in network.paths)]
    linear = [o.name for o in network.outputs if o.quantity != "power"]
    parts = [f"frf.{name}.{part}" for name in linear for part in ("re", "im")]
    values = []
    for frequency in f:
        fmu.set({"frequency": float(frequency)})
        values.append(fmu.get(ratios + parts))
    table = np.array(values)
    transfers = table[:, len(ratios) :: 2] + 1j * table[:, len(ratios) + 1 :: 2]
    return table[:, : len(ratios)], transfers


def expected_ratios(network: ModalNetwork, flow: PowerFlow, omega: Real) -> tuple[Real, Real]:
    """Power ratios as the FMU's outputs hold them, (F, 3 + paths), and the size that they are judged by, (F,).

    That is what flows in all paths together; and active power that is a small rest of a large apparent power keeps
    as many digits less as it is smaller.
    """
    rows = [flow.share(), flow.share(lambda path: not is_moment_path(path)), flow.share(is_moment_path)]
    for name in network.paths:
        own = [k for k, path in enumerate(flow.paths) if path.rsplit(".", 1)[0] == name]
        rows.append(ratio(flow.path_power[own].sum(axis=0), flow.input_power))
    load = next(item for item in network.loads if item.name == network.excitation)
    solved = Synthesis(network, [load]).solve(omega)
    drive = omega**2 if load.is_transmission_error else np.ones_like(omega)
    conjugate = np.asarray(abs(load.column @ solved.elastic[:, 0]), float)
    apparent = ratio(np.asarray(0.5 * conjugate * drive), flow.input_power)
    gross = ratio(abs(flow.path_power).sum(axis=0), flow.input_power)
    return np.array(rows).T, np.maximum(gross, 1e-6) * np.maximum(1.0, 1e-4 * apparent)
