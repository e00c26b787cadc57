"""What a measurement on both sides of joints would give: mobilities of a network there, with noise if wanted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import InputError
from ..network.modal import ModalNetwork
from ..network.records import JointRows, Load, Output
from ..network.response import frequency_response
from ..numerics.arrays import Complex, Real


def chosen_joints(network: ModalNetwork, names: Sequence[str]) -> tuple[JointRows, ...]:
    """Joints by name. Raises InputError for one that does not exist or has the ground on one side."""
    by_name = {joint.name: joint for joint in network.joints}
    for name in names:
        if name not in by_name:
            raise InputError(f"joints: there is no joint {name!r}; name some of: {', '.join(by_name)}")
        if by_name[name].grounded:
            raise InputError(f"joints: {name} stands on the ground, where nothing can be measured; leave it out")
    if len(set(names)) != len(names):
        raise InputError("joints: a joint is named twice; name each once")
    return tuple(by_name[name] for name in names)


def joint_mobility(network: ModalNetwork, omega: Real, names: Sequence[str], connected: bool = True) -> Complex:
    """Mobilities (F, 2 n, 2 n) at the source sides of the named joints, then at their receiver sides.

    Of the assembled network, or of what is left of it when these joints are taken out.
    """
    joints = chosen_joints(network, names)
    rows = np.vstack([*(joint.source for joint in joints), *(joint.receiver for joint in joints)])
    if not connected:
        for joint in joints:
            nothing = np.zeros_like(joint.stiffness)
            network = network.with_joint(joint.name, nothing, nothing)
    loads = [Load(str(k), "", row) for k, row in enumerate(rows)]
    outputs = [Output(str(k), "", "velocity", row) for k, row in enumerate(rows)]
    return frequency_response(network, omega, outputs, loads)


def with_noise(mobility: Complex, noise: float, seed: int | None = None) -> Complex:
    """Every entry with independent circular complex Gaussian noise, sqrt(E|e|^2) = noise |Y_ij|."""
    if not (np.isfinite(noise) and noise >= 0.0):
        raise InputError(f"noise: {noise} is not allowed; give 0.01 for 1 % of each FRF")
    rng = np.random.default_rng(seed)
    e = rng.standard_normal((2, *mobility.shape)) * np.sqrt(0.5)
    return np.asarray(mobility * (1.0 + noise * (e[0] + 1j * e[1])))
