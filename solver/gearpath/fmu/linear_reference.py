"""Reference input and output of a linear system, as the layered standard FMI-LS-REF asks for."""

import numpy as np

from ..numerics.arrays import Real
from ..numerics.propagator import discretise
from .description import Experiment
from .linear_system import LinearSystem
from .linear_table import input_nominals
from .reference_experiment import Answer, swept
from .reference_files import answered, rows


def linear_reference(system: LinearSystem, experiment: Experiment) -> dict[str, bytes]:
    """All files of the layered standard by their path in the FMU; none where an unstable system overflows in them."""
    times, step = rows(experiment)
    m = len(system.inputs)
    signals = [nominal * swept(times, k / m) for k, nominal in enumerate(input_nominals(system))]
    u = np.column_stack([*signals, np.zeros((len(times), 0))])
    before = np.vstack([u[:1], u[:-1]])
    found = []
    for name, words, x, now in (
        ("held", "inputs held from row to row", _states(system, u, step, linear=False), before),
        ("linear", "inputs linear between the rows", _states(system, u, step, linear=True), u),
    ):
        with np.errstate(over="ignore", invalid="ignore"):
            y = x @ system.C.T + now @ system.D.T
        if not np.isfinite(y).all():
            return {}
        found.append(Answer(name, words, dict(zip(system.outputs, y.T))))
    return answered(system.name, {"time": times, **dict(zip(system.inputs, u.T))}, found, step)


def _states(system: LinearSystem, u: Real, step: float, *, linear: bool) -> Real:
    """The states (rows, n) at every row of inputs, which are held or linear between them; from rest."""
    T = system.balance[: len(system.A)]
    over = discretise(system.A * T / T[:, None], system.B / T[:, None], step)
    z = np.zeros((len(u), len(T)))
    growth = np.diff(u, axis=0) if linear else np.zeros_like(u[1:])
    with np.errstate(over="ignore", invalid="ignore"):
        for k, change in enumerate(growth):
            z[k + 1] = over.step(z[k], u[k], change)
        return np.asarray(z * T)
