"""The FMU's frequency-domain outputs against the solver, before and after a bearing is exchanged."""

import numpy as np

from ...network.modal import ModalNetwork
from ...network.power import is_moment_path, power_flow
from ...network.response import frequency_response
from ...numerics.arrays import Complex, Real
from ..checks import Check
from ..simulation import RunningFmu

_LINES = 25


def spectrum_check(fmu: RunningFmu, network: ModalNetwork, band: tuple[float, float], limit: float) -> Check:
    """alpha and its parts relative to alpha, transfers relative to the largest of the output."""
    f = np.geomspace(*band, _LINES)
    return Check(
        "frequency-domain outputs against the power flow",
        _deviation(fmu, network, f),
        limit,
        f"alpha of all paths and transfers of all outputs at {_LINES} frequencies",
    )


def exchange_check(fmu: RunningFmu, network: ModalNetwork, band: tuple[float, float], limit: float) -> Check:
    """The same after the first path's stiffness was halved and its damping doubled in the running FMU."""
    f = np.geomspace(*band, 5)
    name = network.paths[0] if network.paths else network.joints[0].name
    joint = next(j for j in network.joints if j.name == name)
    changed = network.with_joint(name, 0.5 * joint.stiffness, 2.0 * joint.damping)
    original = joint_parameters(network, name)
    fmu.set(joint_parameters(changed, name))
    deviation = _deviation(fmu, changed, f)
    fmu.set(original)
    return Check(
        f"the same with {name} exchanged while running",
        max(deviation, _deviation(fmu, network, f)),
        limit,
        "stiffness halved, damping doubled, then set back",
    )


def joint_parameters(network: ModalNetwork, name: str) -> dict[str, float]:
    """Values of a joint's tunable parameters by FMU variable."""
    joint = next(j for j in network.joints if j.name == name)
    values = {}
    for what, matrix in (("stiffness", joint.stiffness), ("damping", joint.damping)):
        for i in range(len(joint.dofs)):
            for k in range(i, len(joint.dofs)):
                entry = "" if joint.scalar else f"[{i + 1},{k + 1}]"
                values[f"{name}.{what}{entry}"] = float(matrix[i, k])
    return values


def read_spectrum(fmu: RunningFmu, network: ModalNetwork, f: Real) -> tuple[Real, Complex]:
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


def _deviation(fmu: RunningFmu, network: ModalNetwork, f: Real) -> float:
    ratios, transfers = read_spectrum(fmu, network, f)
    omega = 2 * np.pi * f
    flow = power_flow(network, omega)
    joints = [flow.share(lambda path, name=name: path.startswith(f"{name}.")) for name in network.paths]  # type: ignore[misc]
    expected = np.array(
        [flow.share(), flow.share(lambda path: not is_moment_path(path)), flow.share(is_moment_path), *joints]
    ).T
    gross = abs(flow.path_power).sum(axis=0) / np.where(flow.input_power > 0, flow.input_power, 1.0)
    linear = [o for o in network.outputs if o.quantity != "power"]
    load = next(item for item in network.loads if item.name == network.excitation)
    exact = frequency_response(network, omega, linear, [load])[:, :, 0]
    size = abs(exact).max(axis=0)
    errors = [abs(ratios - expected).max(axis=1) / np.where(gross > 0, gross, 1.0)]
    errors.append((abs(transfers - exact) / np.where(size > 0, size, 1.0)).max(axis=1))
    return float(np.max(errors))
