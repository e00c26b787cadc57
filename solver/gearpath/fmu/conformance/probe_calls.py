"""Does the binary start: library, version, token, start values, states in their order, one step."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose
from pathlib import Path

import numpy as np

from .contents import FLOATS, Fmu, Variable, real
from .finding import Finding, error, warning
from .instance import CallError, Instance

LOAD = error("binary-load", "The library can be loaded.", "2.3", "2.5")
VERSION = error("binary-version", "The binary says that it is of the edition of its description.", "2.1.4", "2.2")
TOKEN = error("binary-token", "The binary accepts the token of its description.", "2.1.5", "2.3")
TOKEN_ANY = warning("binary-token-any", "The binary refuses another token.", "2.1.5", "2.3")
CALL = error("binary-call", "Calls that are allowed succeed.", "2.1.3", "2.2")
START = error("binary-start", "The binary starts from the start values of its description.", "2.2.7", "2.4.7.5")
STATES = error("binary-states", "States and derivatives have the order of the list of derivatives.", "2.2.8", "2.4.8")
NOMINALS = error("binary-nominals", "Nominal values of states are positive.", "3.2.2", "3.2")


def check(fmu: Fmu, folder: Path, library: Path, interface: str) -> Iterator[Finding]:
    """From loading to the first step."""
    place = f"{library.name} ({interface})"
    try:
        instance = Instance(fmu, folder, library, interface)
    except Exception as problem:  # fmpy raises plain Exception
        yield LOAD.found(fmu.version, f"{place} cannot be loaded ({problem}); link what it needs into it")
        raise CallError("it cannot be loaded") from problem
    version = instance.getVersion()
    if version != f"{fmu.version}.0" and not (fmu.version == 3 and version.startswith("3.")):
        yield VERSION.found(fmu.version, f'{place} says it is of FMI "{version}"; compile it for {fmu.version}.0')
    yield from _other_token(fmu, folder, library, interface)
    try:
        instance.create()
    except CallError as problem:
        message = f'{place} refuses the token "{fmu.token}" of modelDescription.xml or cannot start ({problem})'
        yield TOKEN.found(fmu.version, f"{message}; give both the same token")
        raise
    instance.enter_initialization()
    yield from _starts(instance, place)
    instance.leave_initialization()
    if interface == "ModelExchange":
        yield from _states(instance, place)
    else:
        step = real(fmu.root.find("DefaultExperiment").get("stepSize")) if _has_step(fmu) else None
        instance.step(step or 1e-3)
    instance.terminate()
    instance.free()


def _has_step(fmu: Fmu) -> bool:
    element = fmu.root.find("DefaultExperiment")
    return element is not None and element.get("stepSize") is not None


def _other_token(fmu: Fmu, folder: Path, library: Path, interface: str) -> Iterator[Finding]:
    stranger = Instance(fmu, folder, library, interface, "{00000000-0000-0000-0000-000000000000}")
    try:
        stranger.create()
    except CallError:
        return
    stranger.free()
    message = f"{library.name} ({interface}) starts with any token; refuse all but that of modelDescription.xml"
    yield TOKEN_ANY.found(fmu.version, message)


def _starts(instance: Instance, place: str) -> Iterator[Finding]:
    fmu = instance.fmu
    for v in fmu.variables:
        if v.start is None or v.initial == "approx" or v.type in ("Binary", "Clock") or v.reference is None:
            continue
        found = instance.read(v.type, [v])
        wanted = list(v.start) * (len(found) if len(v.start) == 1 else 1)
        wrong = [(f, w) for f, w in zip(found, wanted) if not _same(v, f, w)]
        if wrong:
            message = f'{place}: "{v.name}" starts at {wrong[0][0]}, modelDescription.xml says {wrong[0][1]}'
            yield START.found(fmu.version, f"{message}; write what the binary has")


def _same(v: Variable, found: object, wanted: str) -> bool:
    if v.type == "String":
        return (found.decode("utf-8", "replace") if isinstance(found, bytes) else str(found)) == wanted
    number = {"true": 1.0, "false": 0.0}.get(wanted.strip(), real(wanted))
    precision = 1e-6 if v.type == "Float32" else 1e-12
    return number is None or isclose(float(found), number, rel_tol=precision)  # type: ignore[arg-type]


def _states(instance: Instance, place: str) -> Iterator[Finding]:
    """Set random states: the variables of the states show them, and those of the derivatives the derivatives."""
    fmu = instance.fmu
    derivatives = [v for e in fmu.listed("Derivative") if (v := fmu.by_key.get(e.key or 0)) is not None]
    states = [s for s in fmu.states if s is not None and s.type in FLOATS]
    count = sum(fmu.size(s) or 1 for s in states)
    if not count or len(states) != len(fmu.listed("Derivative")):
        return
    nominals = instance.nominals(count)
    if not np.all(nominals > 0.0):
        yield NOMINALS.found(
            fmu.version, f"{place}: a nominal value of a state is {nominals.min():g}; give positive ones"
        )
        nominals = np.ones(count)
    drawn = instance.states(count) + nominals * np.random.default_rng(1).uniform(0.5, 1.5, count)
    instance.set_states(drawn)
    for what, variables, expected in (
        ("states", states, drawn),
        ("derivatives", derivatives, instance.derivatives(count)),
    ):
        shown = instance.get(variables)
        if not np.allclose(shown, expected, rtol=1e-9, atol=0.0):
            owners = [v.name for v in variables for _ in range(fmu.size(v) or 1)]
            first = owners[int(np.argmax(~np.isclose(shown, expected, rtol=1e-9, atol=0.0)))]
            message = f'{place}: element "{first}" of the {what} is not what the {what} vector has there'
            yield STATES.found(fmu.version, f"{message}; list the derivatives in the order of the vector")
