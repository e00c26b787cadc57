"""model.bin: the modal network as fmu_src/gp_model.c reads it (little-endian, padded to 8 bytes)."""

import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..components.dofs import is_rotation
from ..errors import InputError
from ..network.modal import ModalNetwork
from ..numerics.arrays import Real
from .variables import Variable

MAGIC, VERSION, BYTE_ORDER = b"GEARPATH", 1, 0x01020304
NONE = 0x7FFFFFFF  # "no such index", GP_NONE
RIGID_SCALE = 2.0 * np.pi * 1000.0  # rad/s; scales q where a mode has no eigenfrequency, so that A is balanced
QUANTITIES = ("displacement", "velocity", "acceleration", "force", "power")  # GP_DISPLACEMENT ...
LARGEST_COUNT = 1 << 13  # of modes, joints, loads ...: what the runtime accepts


def payload(network: ModalNetwork, variables: Sequence[Variable], frequency: float) -> bytes:
    """Everything of model.bin behind its header: counts, then the sections in the order of `GpModel`.

    Raises:
        InputError: a number is not finite, or the network is too large for the runtime.
    """
    N = len(network.eigenvalues)
    P_source = np.vstack([joint.source for joint in network.joints])
    P_receiver = np.vstack([joint.receiver for joint in network.joints])
    names, text = _names([joint.name for joint in network.joints])
    blocks = [len(joint.dofs) ** 2 for joint in network.joints]
    counts = (
        N,
        len(network.modal_damping),
        len(network.joints),
        len(P_source),
        sum(blocks),
        len(network.loads),
        len(network.outputs),
        len(variables),
        [load.name for load in network.loads].index(network.excitation),
        len(text),
        0,
        0,
    )
    if max(*counts[:4], *counts[5:7]) > LARGEST_COUNT:
        raise InputError(f"the network is too large for an FMU (at most {LARGEST_COUNT} modes, joints or outputs)")
    zero = np.zeros(N)
    reals = [
        np.array([frequency]),
        network.eigenvalues,
        np.where(network.eigenvalues > 0, np.sqrt(network.eigenvalues), RIGID_SCALE),
        np.array(list(network.modal_damping.values())),
        P_source,
        P_receiver,
        np.concatenate([_symmetric(joint.stiffness).ravel() for joint in network.joints]),
        np.concatenate([_symmetric(joint.damping).ravel() for joint in network.joints]),
        np.vstack([load.column for load in network.loads]),
        np.vstack([zero if load.mesh_displacement is None else load.mesh_displacement for load in network.loads]),
        np.vstack([zero if output.row is None else output.row for output in network.outputs] or [np.zeros((0, N))]),
    ]
    starts = np.cumsum([0, *(len(joint.dofs) for joint in network.joints)])
    block_starts = np.cumsum([0, *blocks])
    joints = [joint.name for joint in network.joints]
    indices: list[ArrayLike] = [
        _groups(network),
        [load.is_transmission_error for load in network.loads],
        [is_rotation(dof) for joint in network.joints for dof in joint.dofs],
        [
            (starts[j], len(joint.dofs), block_starts[j], joint.name in network.paths, names[j], 0)
            for j, joint in enumerate(network.joints)
        ],
        [
            (
                QUANTITIES.index(output.quantity),
                NONE if output.joint is None else joints.index(output.joint),
                output.dof if output.quantity == "force" else 0,
                0,
            )
            for output in network.outputs
        ],
        [(int(v.kind), *v.index) for v in variables],
    ]
    parts = [struct.pack("<12I", *counts)]
    for array in reals:
        if not np.isfinite(array).all():
            raise InputError("a matrix of the network holds a number that is not finite, so no FMU can be made of it")
        parts.append(np.ascontiguousarray(array, dtype="<f8").tobytes())
    parts += [np.asarray(index, dtype="<u4").tobytes() for index in indices]
    return b"".join(_padded(part) for part in [*parts, text])


def model_file(guid: str, content: bytes) -> bytes:
    """model.bin: the header for this GUID, then the payload."""
    checked = guid.encode("ascii").ljust(40, b"\0") + content
    head = struct.pack("<8sIIQII", MAGIC, VERSION, BYTE_ORDER, 32 + len(checked), zlib.crc32(checked), 0)
    return head + checked


def _symmetric(matrix: Real) -> Real:
    """The symmetric part: the runtime insists on exact symmetry, rounding may have spoilt it."""
    return 0.5 * (matrix + matrix.T)


def _groups(network: ModalNetwork) -> list[int]:
    group = [NONE] * len(network.eigenvalues)
    for g, name in enumerate(network.modal_damping):
        for r in range(*network.components[name].indices(len(group))):
            group[r] = g
    return group


def _names(names: Sequence[str]) -> tuple[list[int], bytes]:
    offsets, text = [], b""
    for name in names:
        offsets.append(len(text))
        text += name.encode("utf-8") + b"\0"
    return offsets, text


def _padded(part: bytes) -> bytes:
    return part + b"\0" * (-len(part) % 8)
