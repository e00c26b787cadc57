"""Saved states: what was saved comes back, also by way of bytes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .contents import FLOATS, Fmu, Variable, true
from .finding import Finding, error
from .instance import Instance, Values
from .probe_point import Point

RESTORE = error("state-restore", "Restoring a saved state brings back all outputs.", "2.1.8", "2.2")
BYTES = error("state-serialize", "A state survives as bytes.", "2.1.8", "2.2")

_STEP = 1e-4


def check(fmu: Fmu, folder: Path, library: Path, interface: str) -> Iterator[Finding]:
    """Save, go on, restore: the outputs, and what follows, are as they were (co-simulation)."""
    flags, state = fmu.interfaces[interface], "State" if fmu.version == 3 else "state"
    if interface != "CoSimulation" or not true(flags.get(f"canGetAndSetFMU{state}")):
        return
    instance = Instance(fmu, folder, library, interface)
    instance.create()
    instance.enter_initialization()
    instance.leave_initialization()
    point = Point(instance, 2)
    point.move_inputs()
    instance.step(_STEP)
    outputs = [v for v in fmu.variables if v.causality == "output" and v.type in FLOATS and v.reference is not None]
    saved, before, time = instance.save(), instance.get(outputs), instance.time
    after = _onward(instance, outputs)
    kinds = [(RESTORE, saved)]
    if true(flags.get(f"canSerializeFMU{state}")):
        kinds.append((BYTES, instance.deserialized(instance.serialized(saved))))
    for rule, kept in kinds:
        point.move_inputs()
        instance.step(_STEP)
        instance.restore(kept)
        instance.time = time
        at_once = _same(instance.get(outputs), before)
        if not at_once or not _same(_onward(instance, outputs), after):
            when = "a step later" if at_once else "at once"
            message = f"{library.name} ({interface}): outputs differ {when} after the state was set back"
            yield rule.found(fmu.version, f"{message}; save everything that the outputs depend on")
            break  # where the instance is now, nobody knows
    instance.terminate()
    instance.free()


def _onward(instance: Instance, outputs: list[Variable]) -> Values:
    instance.step(_STEP)
    return instance.get(outputs)


def _same(found: Values, wanted: Values) -> bool:
    return bool(np.allclose(found, wanted, rtol=1e-9, atol=1e-300, equal_nan=True))
