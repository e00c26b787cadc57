"""model.bin: the modal network as fmu_src/gp_model.c reads it (little-endian, padded to 8 bytes)."""

import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..components.dofs import is_rotation
from ..errors import InputError
from ..network.coupled_modes import CoupledModes, coupled_modes
from ..network.modal import ModalNetwork
from ..network.records import JointRows
from ..network.time_twin import state_scale
from ..numerics.arrays import Real
from .native_table import state_nominals
from .variables import Variable

MAGIC, VERSION, BYTE_ORDER = b"GEARPATH", 4, 0x01020304
NONE = 0x7FFFFFFF  # "no such index", GP_NONE
QUANTITIES = ("displacement", "velocity", "acceleration", "force", "power")  # GP_DISPLACEMENT ...
LARGEST_COUNT = 1 << 13  # of modes, joints, loads ...: what the runtime accepts


def payload(network: ModalNetwork, variables: Sequence[Variable], frequency: float) -> bytes:
    """Everything of model.bin behind its header: counts, then the sections in the order of `GpModel`.

    Raises:
        InputError: a number is not finite, or the network is too large for the runtime.
    """
    reals = _reals(network, frequency)
    check_finite(reals)
    modes = coupled_modes(network)
    names, text = named_text([joint.name for joint in _joints(network)] + [variable.name for variable in variables])
    counts = _counts(network, len(variables), len(text), modes is not None)
    parts = [struct.pack("<16I", *counts)]
    form = [*_modal_form(modes), *_tones(network), *_schedule(network)]
    check_finite(form)
    for array in (*reals, *form):
        parts.append(np.ascontiguousarray(array, dtype="<f8").tobytes())
    kinds = [int(kind) for kind in modes.kinds] if modes else []
    for index in (kinds, *_indices(network, variables, names)):
        parts.append(np.asarray(index, dtype="<u4").tobytes())
    return b"".join(padded(part) for part in [*parts, text])


def _joints(network: ModalNetwork) -> tuple[JointRows, ...]:
    """The joints, and behind them the dashpots inside components: joints to nowhere of one degree of freedom each."""
    one = np.ones((1, 1))
    inside = [
        JointRows(f"{name}.dashpot_{k + 1}", "dashpot", ("ux",), row[None], 0.0 * row[None], 0.0 * one, one)
        for name, D in network.dashpots.items()
        for k, row in enumerate(D)
    ]
    return (*network.joints, *inside)


def check_finite(arrays: Sequence[Real]) -> None:
    """Refuse numbers that are not finite."""
    if not all(np.isfinite(array).all() for array in arrays):
        raise InputError("a matrix of the network holds a number that is not finite, so no FMU can be made of it")


def _counts(network: ModalNetwork, variables: int, text: int, has_modes: bool) -> tuple[int, ...]:
    N, loads = len(network.eigenvalues), [load.name for load in network.loads]
    sizes = [len(joint.dofs) for joint in _joints(network)]
    small = (N, len(network.modal_damping), len(sizes), sum(sizes))
    if max(*small, len(loads), len(network.outputs)) > LARGEST_COUNT:
        raise InputError(f"the network is too large for an FMU (at most {LARGEST_COUNT} modes, joints or outputs)")
    source = network.source
    return (
        *small,
        sum(size**2 for size in sizes),
        len(loads),
        len(network.outputs),
        variables,
        loads.index(network.excitation),
        text,
        len(source.tones) if source else 0,
        loads.index(source.load) if source else NONE,
        N if has_modes else 0,
        len(network.schedule.torques) if network.schedule else 0,
        0,
        0,
    )


def _reals(network: ModalNetwork, frequency: float) -> list[Real]:
    N, source, schedule = len(network.eigenvalues), network.source, network.schedule
    zero = np.zeros(N)
    return [
        np.array(
            [
                frequency,
                source.speed if source else 0.0,
                source.teeth if source else 1.0,
                schedule.first if schedule else 0.0,
            ]
        ),
        network.eigenvalues,
        state_scale(network),
        state_nominals(network),
        np.array(list(network.modal_damping.values())),
        np.array([network.damping_share(name) for name in network.modal_damping]).reshape(-1, N),
        np.vstack([joint.source for joint in _joints(network)]),
        np.vstack([joint.receiver for joint in _joints(network)]),
        np.concatenate([_symmetric(joint.stiffness).ravel() for joint in _joints(network)]),
        np.concatenate([_symmetric(joint.damping).ravel() for joint in _joints(network)]),
        np.vstack([load.column for load in network.loads]),
        np.vstack([zero if load.mesh_displacement is None else load.mesh_displacement for load in network.loads]),
        np.vstack([zero if output.row is None else output.row for output in network.outputs] or [np.zeros((0, N))]),
    ]


def _modal_form(modes: CoupledModes | None) -> list[Real]:
    if modes is None:
        return [np.zeros(0), np.zeros(0)]
    return [np.hstack([modes.poles, modes.norms]), modes.shapes]


def _tones(network: ModalNetwork) -> list[Real]:
    tones = network.source.tones if network.source else ()
    return [np.array([(t.harmonic, t.shift, t.amplitude, t.phase) for t in tones]).reshape(-1, 4)]


def _schedule(network: ModalNetwork) -> list[Real]:
    """Torques, then K and C of all joints at each, zero where they do not follow."""
    schedule = network.schedule
    if schedule is None:
        return []
    tables = [np.asarray(schedule.torques, float)]
    for matrices in (schedule.stiffness, schedule.damping):
        rows = [
            [
                _symmetric(matrices[joint.name][i]).ravel()
                if joint.name in matrices
                else np.zeros(len(joint.dofs) ** 2)
                for joint in _joints(network)
            ]
            for i in range(len(schedule.torques))
        ]
        tables.append(np.array([np.concatenate(row) for row in rows]))
    return tables


def _follows(network: ModalNetwork, name: str) -> int:
    """What of a joint follows the torque: GP_FOLLOWS_STIFFNESS and GP_FOLLOWS_DAMPING."""
    if network.schedule is None:
        return 0
    return (name in network.schedule.stiffness) + 2 * (name in network.schedule.damping)


def _indices(network: ModalNetwork, variables: Sequence[Variable], names: Sequence[int]) -> list[ArrayLike]:
    """The index sections behind the kinds of mode pairs."""
    sizes = [len(joint.dofs) for joint in _joints(network)]
    starts, block_starts = np.cumsum([0, *sizes]), np.cumsum([0, *(size**2 for size in sizes)])
    joints = [joint.name for joint in _joints(network)]
    return [
        [load.is_transmission_error for load in network.loads],
        [is_rotation(dof) for joint in _joints(network) for dof in joint.dofs],
        [
            (starts[j], sizes[j], block_starts[j], joint.name in network.paths, names[j], _follows(network, joint.name))
            for j, joint in enumerate(_joints(network))
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
        [(int(v.kind), *v.index, names[len(joints) + i], 0) for i, v in enumerate(variables)],
    ]


def model_file(guid: str, content: bytes) -> bytes:
    """model.bin: the header for this GUID, then the payload."""
    checked = guid.encode("ascii").ljust(40, b"\0") + content
    head = struct.pack("<8sIIQII", MAGIC, VERSION, BYTE_ORDER, 32 + len(checked), zlib.crc32(checked), 0)
    return head + checked


def _symmetric(matrix: Real) -> Real:
    """The symmetric part: the runtime insists on exact symmetry, rounding may have spoilt it."""
    return 0.5 * (matrix + matrix.T)


def named_text(names: Sequence[str]) -> tuple[list[int], bytes]:
    """The offset of each name in the text section, and that section: zero-terminated UTF-8."""
    offsets, text = [], b""
    for name in names:
        offsets.append(len(text))
        text += name.encode("utf-8") + b"\0"
    return offsets, text


def padded(part: bytes) -> bytes:
    """A section as the file holds it."""
    return part + b"\0" * (-len(part) % 8)


def scheduled_torques(content: bytes) -> Real:
    """The torques (T,), N m, that model.bin holds matrices for; none without a schedule.

    Raises:
        InputError: it is cut short or of another version.
    """
    wrong = InputError("resources/model.bin cannot be read; unpack or export the FMU again")
    if len(content) < 136 or content[:8] != MAGIC or struct.unpack_from("<I", content, 8)[0] != VERSION:
        raise wrong
    n = struct.unpack_from("<16I", content, 72)
    modes, groups, _, rows, blocks, loads, outputs = n[:7]
    tones, pairs, points = n[10], n[12], n[13]
    before = 4 + 3 * modes + groups * (1 + modes) + 2 * rows * modes + 2 * blocks + 2 * loads * modes + outputs * modes
    start = 136 + 8 * (before + 4 * pairs + 2 * pairs * modes + 4 * tones)
    if start + 8 * points > len(content):
        raise wrong
    return np.frombuffer(content, "<f8", points, start).astype(float)
