"""Random linear systems of known poles, their FMUs in either version, and the same steps by scipy's exponential."""

import ctypes as ct

import control
import numpy as np
import scipy.linalg
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu
from fmu_exchange import Exchange

import gearpath as gp


def random_system(n, inputs=2, outputs=3, seed=0, growth=0.0, name="controller"):
    """A StateSpace with poles of 1e2 to 1e4 rad/s (odd n: one more real pole), the first growing at `growth` 1/s."""
    rng = np.random.default_rng([seed, n])
    blocks = [[[-rng.uniform(100.0, 3000.0)]]] if n % 2 else []
    for _ in range(n // 2):
        w = 10.0 ** rng.uniform(2.0, 4.0)
        decay = rng.uniform(0.01, 0.5) * w
        blocks.append([[-decay, w], [-w, -decay]])
    if blocks and growth:
        first = np.array(blocks[0])
        blocks[0] = first + (growth - first[0, 0]) * np.eye(len(first))
    T = scipy.linalg.orth(rng.normal(size=(n, n))) @ np.diag(rng.uniform(0.5, 2.0, n)) if n else np.zeros((0, 0))
    A = T @ scipy.linalg.block_diag(*blocks) @ np.linalg.inv(T) if n else np.zeros((0, 0))
    B, C = rng.normal(size=(n, inputs)), rng.normal(size=(outputs, n))
    return control.StateSpace(
        A, 1e3 * B, C, rng.normal(size=(outputs, inputs)), name=name, remove_useless_states=False,
        inputs=[f"mount_{k + 1}/force_uy" for k in range(inputs)],
        outputs=[f"act_{k + 1}" for k in range(outputs)],
        states=[f"filter/z_{k + 1}" for k in range(n)],
    )  # fmt: skip


def unpacked_of(system, folder, fmi="2.0", **settings):
    path = gp.export_fmu(system, folder / "it.fmu", fmi=fmi, documentation=False, **settings)
    return Fmu.unpack(path, folder / "it")


def started(unpacked, *, exchange=False, intermediate=None, initial=None):
    """An instance at 0 s: ready for steps, or in continuous-time mode."""
    if unpacked.description.fmiVersion == "2.0":
        fmu = Fmu(unpacked, kind=0 if exchange else 1)
    else:
        fmu = Fmu3(unpacked, exchange=exchange, intermediate=intermediate)
    if initial:
        assert fmu.set(initial) == OK, fmu.messages
    fmu.start()
    if exchange and isinstance(fmu, Fmu):
        it = Exchange(fmu, 2)
        assert not it.update()
        it.ok("EnterContinuousTimeMode")
    return fmu


def exchanging(fmu, n) -> Exchange:
    it = Exchange(fmu, 2 if isinstance(fmu, Fmu) else 3)
    it.n = n
    return it


def dotted(labels) -> list[str]:
    return [label.replace("/", ".") for label in labels]


def stepped(system, x, steps, u, slopes):
    """Outputs (steps + 1, p) where inputs begin at u[k] in step k and grow with slopes[k], at the end of each step."""
    n, m = system.nstates, system.ninputs
    found = [system.C @ x + system.D @ u[0]]
    for h, held, slope in zip(steps, u, slopes):
        M = np.zeros((n + 2 * m, n + 2 * m))
        M[:n, :n], M[:n, n : n + m], M[n : n + m, n + m :] = system.A, system.B, np.eye(m)
        E = scipy.linalg.expm(M * h)
        x = E[:n] @ np.concatenate([x, held, slope])
        found.append(system.C @ x + system.D @ (held + h * slope))
    return np.array(found)


def run(unpacked, system, steps, u, slopes, x):
    """Outputs after every step, inputs held where the slopes are None."""
    names, outputs = dotted(system.input_labels), dotted(system.output_labels)
    end = {}

    def intermediate(fmu, _time, asked, _readable):
        if asked and end:
            assert fmu.set(end) == OK, fmu.messages

    fmu = started(unpacked, intermediate=intermediate, initial=dict(zip(dotted(system.state_labels), x)))
    t, found = 0.0, []
    for k, h in enumerate(steps):
        assert fmu.set(dict(zip(names, u[k]))) == OK, fmu.messages
        if not found:
            found.append(fmu.get(outputs))
        if slopes is not None and hasattr(fmu, "set_slopes"):
            assert fmu.set_slopes(dict(zip(names, slopes[k]))) == OK
        elif slopes is not None:
            end = dict(zip(names, u[k] + h * slopes[k]))
        assert fmu.step(t, h) == OK, fmu.messages
        t += h
        found.append(fmu.get(outputs))
    fmu.free()
    return np.array(found)


def derivative(fmu, unknowns, knowns, seed, adjoint=False) -> np.ndarray:
    """Directional (FMI 3: or adjoint) derivatives."""
    fmi2 = isinstance(fmu, Fmu)
    values = (ct.c_double * len(seed))(*seed)
    result = (ct.c_double * len(knowns if adjoint else unknowns))()
    lists = (fmu.references(unknowns), ct.c_size_t(len(unknowns)), fmu.references(knowns), ct.c_size_t(len(knowns)))
    if fmi2:
        status = fmu.call("fmi2GetDirectionalDerivative", *lists, values, result)
    else:
        function = "fmi3GetAdjointDerivative" if adjoint else "fmi3GetDirectionalDerivative"
        status = fmu.call(function, *lists, values, ct.c_size_t(len(values)), result, ct.c_size_t(len(result)))
    assert status == OK, fmu.messages
    return np.array(result)
