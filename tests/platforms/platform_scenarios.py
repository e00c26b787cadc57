"""Runs of an FMU that use everything it offers, as scripts for the host: the same for every machine."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from platform_script import Script, bits

LOADS = ("mesh.transmission_error", "mesh.force")
AMPLITUDES = np.array([1e-6, 100.0])  # m, N
CHANGE_AT = 60  # step at which the bearing is exchanged
# not a multiple of the old matrix, and not diagonal
NEW_STIFFNESS = np.array([[2.3e8, -1.1e6], [-1.1e6, 4.7e4]])
NEW_DAMPING = np.array([[310.0, 2.5], [2.5, 0.21]])
STATES = 144  # of the default gearbox


def held_inputs(count: int) -> NDArray[np.float64]:
    """Random loads (steps, 2), the same in every run."""
    return np.random.default_rng(7).normal(size=(count, 2)) * AMPLITUDES


def new_bearing(fmi: str) -> dict[str, object]:
    """The values of the bearing's new matrices, as the version of FMI has them."""
    if fmi == "3.0":
        return {"bearing_2.stiffness": NEW_STIFFNESS, "bearing_2.damping": NEW_DAMPING}
    entries = {"1,1": (0, 0), "1,2": (0, 1), "2,2": (1, 1)}
    return {
        f"bearing_2.{name}[{label}]": matrix[at]
        for name, matrix in (("stiffness", NEW_STIFFNESS), ("damping", NEW_DAMPING))
        for label, at in entries.items()
    }


def co_simulation(script: Script, inputs: NDArray[np.float64], h: float, change_at: int | None = None) -> None:
    """Steps with held inputs; the outputs are read before each step, with the inputs of that step, and at the end."""
    outputs = script.fmu.names("output")
    script.start("cs")
    for k, loads in enumerate(inputs):
        if k == change_at:
            script.set(new_bearing(script.fmu.fmi))
        script.set(dict(zip(LOADS, loads)))
        script.get(outputs)
        script.step(k * h, h)
    script.get(outputs)


def interpolation(script: Script, corners: NDArray[np.float64], h: float) -> None:
    """Steps in which the inputs go straight from one corner to the next."""
    outputs = script.fmu.names("output")
    script.start("cs")
    for k in range(len(corners) - 1):
        script.set(dict(zip(LOADS, corners[k])))
        script.get(outputs)
        script.ramp(dict(zip(LOADS, corners[k])), dict(zip(LOADS, corners[k + 1])), h)
        script.step(k * h, h)
    script.set(dict(zip(LOADS, corners[-1])))
    script.get(outputs)


def changing_steps(script: Script) -> None:
    """Step sizes from 1 us to 10 ms, a frequency, a mount and the damping of the modes changed on the way."""
    outputs, time = script.fmu.names("output"), 0.25
    script.start("cs", time)
    for k, loads in enumerate(held_inputs(24)):
        h = (1e-6, 1e-5, 3.3e-5, 1e-4, 1e-3, 1e-2)[k % 6] if k < 13 else (2e-5, 1e-4)[k % 2]
        if k == 13:
            script.set({"gear_train.modal_damping": 0.02, "mount_3.stiffness": 2e6})
        script.set({"frequency": 20.0 + 130.0 * k, **dict(zip(LOADS, loads))})
        script.step(time, h)
        script.get(outputs)
        time += h
    script.call("terminate")
    script.call("reset")
    script.call("free")


def model_exchange(script: Script) -> None:
    """Runge-Kutta steps, derivatives and outputs, the bearing exchanged in event mode."""
    outputs, h = script.fmu.names("output"), 2.5e-7
    script.start("me")
    script.call("nominals", STATES)
    for k, loads in enumerate(held_inputs(6)):
        if k == 3:
            script.call("event")
            script.set(new_bearing(script.fmu.fmi))
            script.call("update")
            script.call("continuous")
        script.set(dict(zip(LOADS, loads)))
        script.integrate(20 * k * h, h, 20, STATES)
        script.call("states", STATES)
        script.call("derivatives", STATES)
        script.get(outputs)


def derivatives(script: Script) -> None:
    """Directional derivatives, and in FMI 3 adjoint ones, of outputs and state derivatives."""
    rng = np.random.default_rng(11)
    outputs = script.fmu.names("output")
    for kind in ("cs", "me"):
        script.start(kind)
        if kind == "me":
            script.set(dict(zip(LOADS, AMPLITUDES)))
            script.integrate(0.0, 2.5e-7, 3, STATES)
        for unknowns, knowns in _pairs(script, outputs, kind):
            size = script.fmu.size
            script.derivative("directional", unknowns, knowns, rng.normal(size=sum(size[n] for n in knowns)))
            if script.fmu.fmi == "3.0":
                script.derivative("adjoint", unknowns, knowns, rng.normal(size=sum(size[n] for n in unknowns)))
        script.call("free")


def _pairs(script: Script, outputs: list[str], kind: str) -> Iterator[tuple[list[str], list[str]]]:
    yield outputs, list(LOADS)
    if kind == "cs":
        return
    names = list(script.fmu.reference)
    if script.fmu.fmi == "3.0":
        states, slopes = ["state"], ["der(state)"]
    else:
        slopes = [name for name in names if name.startswith("der(")]
        states = [name[4:-1] for name in slopes]
    yield slopes, [*states, *LOADS]
    yield outputs, states


def state(script: Script) -> None:
    """A state kept, gone on from, gone back to, serialised, given to another instance; at last the first one reset."""
    outputs, inputs, h = script.fmu.names("output"), held_inputs(12), 1e-5
    script.start("cs")

    def steps(first: int, last: int) -> None:
        for k in range(first, last):
            script.set(dict(zip(LOADS, inputs[k])))
            script.step(k * h, h)
        script.get(outputs)

    steps(0, 4)
    script.set(new_bearing(script.fmu.fmi))
    steps(4, 6)
    script.call("keep")
    script.call("serialise")
    steps(6, 12)
    script.call("restore")
    steps(6, 12)
    script.call("instance", 1)
    script.start("cs")
    script.call("restore")
    steps(6, 12)
    script.call("forget")
    script.call("instance", 0)
    script.call("reset")
    script.call("start", bits(0.0))
    script.call("initialised")
    steps(0, 4)


def every_scenario() -> dict[str, object]:
    """By name: a function that writes the scenario into a script."""
    return {
        "held inputs": lambda script: co_simulation(script, held_inputs(120), 1e-5, CHANGE_AT),
        "interpolated inputs": lambda script: interpolation(script, held_inputs(60), 2e-5),
        "changing steps": changing_steps,
        "model exchange": model_exchange,
        "derivatives": derivatives,
        "state": state,
    }
