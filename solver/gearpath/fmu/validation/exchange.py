"""Exchanging every tunable parameter of a running FMU at once, and what the network is then."""

from dataclasses import replace
from typing import Any

import numpy as np

from ...network.modal import ModalNetwork
from ..checks import Check
from ..dependencies import TORQUE
from .measure import relative


def exchanged(network: ModalNetwork) -> ModalNetwork:
    """Every joint at half its stiffness and twice its damping, every modal damping half as large again.

    Matrices that follow the torque or a design are no parameters and stay.
    """
    K, C = decided(network)
    joints = tuple(
        replace(
            j,
            stiffness=j.stiffness if j.name in K else 0.5 * j.stiffness,
            damping=j.damping if j.name in C else 2.0 * j.damping,
        )
        for j in network.joints
    )
    damping = {name: 1.5 * ratio if ratio else 0.01 for name, ratio in network.modal_damping.items()}
    return replace(network, joints=joints, modal_damping=damping)


def decided(network: ModalNetwork) -> tuple[set[str], set[str]]:
    """The joints whose stiffness, and whose damping, a schedule or a design decides."""
    schedule = network.schedule
    stiffness, damping = (set(schedule.stiffness), set(schedule.damping)) if schedule else (set(), set())
    for name in network.decided:
        joint, _, what = name.rpartition(".")
        (stiffness if what == "stiffness" else damping).add(joint)
    return stiffness, damping


def parameters(network: ModalNetwork) -> dict[str, float]:
    """Values of all tunable parameters by FMU variable."""
    values = {f"{name}.modal_damping": float(ratio) for name, ratio in network.modal_damping.items()}
    K, C = decided(network)
    for joint in network.joints:
        for what, matrix, follows in (("stiffness", joint.stiffness, K), ("damping", joint.damping, C)):
            if joint.name in follows:
                continue
            for i in range(len(joint.dofs)):
                for k in range(i, len(joint.dofs)):
                    entry = "" if joint.scalar else f"[{i + 1},{k + 1}]"
                    values[f"{joint.name}.{what}{entry}"] = float(matrix[i, k])
    return values


def start_check(description: Any, network: ModalNetwork) -> Check:
    """Start values in the modelDescription against the model: an importer may set them all."""
    wanted = parameters(network)
    if network.schedule is not None:
        wanted[TORQUE] = network.schedule.first
    starts = _starts(description)
    found = np.array([starts.get(name, np.nan) for name in wanted])
    expected = np.array(list(wanted.values()))
    deviation = relative(abs(found - expected), np.maximum(abs(expected), 1e-300))
    what = f"{len(wanted)} parameters, relative to the model's"
    return Check("start values of the parameters", deviation, 1e-12, what)


def _starts(description: Any) -> dict[str, float]:
    """Start values by name, those of a matrix by entry."""
    starts = {}
    for variable in description.modelVariables:
        if variable.start is None:
            continue
        shape = [int(d.start) for d in getattr(variable, "dimensions", None) or ()]
        values = variable.start.split() if isinstance(variable.start, str) else np.atleast_1d(variable.start)
        if len(shape) == 2:
            for at, value in enumerate(values):
                starts[f"{variable.name}[{at // shape[1] + 1},{at % shape[1] + 1}]"] = float(value)
        elif not shape:
            starts[variable.name] = float(variable.start)
    return starts
