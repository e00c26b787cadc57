"""model.bin of a linear system given by its matrices, as fmu_src/gp_model.c reads it: a network without modes."""

import struct
from collections.abc import Sequence

import numpy as np

from .binary import NONE, QUANTITIES, check_finite, named_text, padded
from .linear_system import LinearSystem
from .linear_table import state_nominals
from .variables import Variable

_ROW = len(QUANTITIES)  # GP_ROW: an output that is a row of C and D


def linear_payload(system: LinearSystem, variables: Sequence[Variable]) -> bytes:
    """Everything of model.bin behind its header.

    Raises:
        InputError: a number is not finite.
    """
    n, m, p = len(system.states), len(system.inputs), len(system.outputs)
    starts = np.array([0.0, 0.0, 1.0, 0.0])  # frequency, speed, teeth, torque: there are none
    doubles = [starts, state_nominals(system), system.A, system.B, system.C, system.D, system.balance]
    check_finite(doubles)
    offsets, text = named_text([variable.name for variable in variables])
    counts = (0, 0, 0, 0, 0, m, p, len(variables), 0, len(text), 0, NONE, 0, 0, n, 0)
    indices = [
        [0] * m,  # no input is a transmission error
        [(_ROW, NONE, 0, 0)] * p,
        [(int(v.kind), *v.index, offset, 0) for v, offset in zip(variables, offsets)],
    ]
    parts = [struct.pack("<16I", *counts)]
    parts += [np.ascontiguousarray(array, dtype="<f8").tobytes() for array in doubles]
    parts += [np.asarray(index, dtype="<u4").tobytes() for index in indices]
    return b"".join(padded(part) for part in [*parts, text])
