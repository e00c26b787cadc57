"""Damping matrices that couple modes: Rayleigh damping with dashpots, against the matrices themselves."""

import numpy as np
import pytest
import scipy.linalg
from foreign_cases import frame_model, matrices_of, with_casing

import gearpath as gp
from gearpath.network.assemble import assemble
from gearpath.network.reference import reference_solution
from gearpath.study.sweeping import reference_checks

N = 7
HELD, DAMPER = 1e6, 50.0


def chain(rng, *, free=False):
    """K and M of N masses on a chain of springs, held at its first mass unless it is free."""
    springs = rng.integers(20, 80, N) * 1e5 * ([0.0] + [1.0] * (N - 1) if free else 1.0)
    K = np.diag(springs) + np.diag([*springs[1:], 0.0]) - np.diag(springs[1:], 1) - np.diag(springs[1:], -1)
    return K, np.diag(rng.uniform(0.5, 2.0, N))


def dashpot(i, k, c):
    row = np.eye(N)[i] - (np.eye(N)[k] if k is not None else 0.0)
    return c * np.outer(row, row)


def cases():
    rng = np.random.default_rng(7)
    K, M = chain(rng)
    yield "one", K, M, dashpot(2, 3, 300.0), 1
    yield "Rayleigh and two", K, M, 4.0 * M + 2e-6 * K + dashpot(1, 5, 90.0) + dashpot(6, None, 40.0), 2
    K, M = chain(rng, free=True)
    yield "drag on rigid motion", K, M, 3.0 * M + 1e-6 * K, 1
    F = rng.normal(size=(N, N))
    yield "full", K, M, 20.0 * F @ F.T, N


CASES = {name: rest for name, *rest in cases()}


def machine(folder, K, M, C):
    """The structure on a mount at its last mass, driven and seen at another."""
    np.savez(folder / "body.npz", stiffness=K, mass=M, damping=C)
    data = {
        "name": "small",
        "dofs": ["uy"],
        "frequency": {"start": 20.0, "stop": 1000.0, "points": 80},
        "components": {"body": {"kind": "matrices", "file": "body.npz", "ports": {"a": [1], "b": [N - 1]}}},
        "joints": {
            "foot": {"kind": "mount", "between": ["body.b", "ground"], "stiffness": HELD, "damping": DAMPER},
        },
        "excitation": {"point": "body.a", "dof": "uy"},
        "sensors": {"b": {"component": "body", "point": "b", "dof": "uy"}},
    }
    return gp.Model.from_dict(data, str(folder / "model.toml"))


def velocities(K, M, C, frequencies):
    """(F, N) velocities of all masses under a unit force on the second, from the assembled matrices."""
    K, C = K + np.diag([0.0] * (N - 1) + [HELD]), C + np.diag([0.0] * (N - 1) + [DAMPER])
    w = 2 * np.pi * frequencies
    return np.array([1j * x * np.linalg.solve(K - x**2 * M + 1j * x * C, np.eye(N)[1]) for x in w])


@pytest.mark.parametrize("name", CASES)
def test_response_and_power_are_those_of_the_matrices(tmp_path, name):
    K, M, C, rows = CASES[name]
    model = machine(tmp_path, K, M, C)
    component = model.system.components["body"]
    assert len(component.dashpots) == rows
    v = velocities(K, M, C, model.frequencies())
    found = gp.frequency_response(model).sel(output="sensors.b", input="excitation.force").values
    assert found == pytest.approx(v[:, -1], rel=1e-8)
    power = gp.power_flow(model)
    inside = 0.5 * np.einsum("fi,ij,fj->f", v.conj(), C, v).real
    assert power.dissipated_power.sel(element="body").values == pytest.approx(inside, rel=1e-7)
    total = power.dissipated_power.sum("element").values
    assert total == pytest.approx(power.input_power.values, rel=1e-9)
    matrices = gp.power_matrices(model)
    assert matrices.dissipated_power.sel(element="body").values.real.ravel() == pytest.approx(inside, rel=1e-7)


@pytest.mark.parametrize("name", CASES)
def test_in_time_and_reduced(tmp_path, name):
    K, M, C, _ = CASES[name]
    model = machine(tmp_path, K, M, C)
    f = model.frequencies()
    v = velocities(K, M, C, f)[:, -1]
    for system, error in ((gp.state_space(model), 1e-9), (gp.reduce(model, tolerance=1e-3, band=(20.0, 1000.0)), 1e-3)):
        H = system["sensors/b", "excitation/force"](2j * np.pi * f)
        assert abs(np.ravel(H) - v).max() <= error * abs(v).max()
    assert gp.reduce(model, order=3, band=(20.0, 300.0)).certificate.passive


@pytest.mark.parametrize("name", ["Rayleigh and two", "full"])
def test_the_fmu_has_the_same_damping(tmp_path, name):
    """The compiled runtime: response at one frequency, A entry by entry, and the checks of its own validation."""
    K, M, C, _ = CASES[name]
    model = machine(tmp_path, K, M, C)
    path = tmp_path / "small.fmu"
    gp.export_fmu(model, path, documentation=False)
    system, exact = gp.linearize(path), gp.state_space(model)
    assert np.sort_complex(system.poles()) == pytest.approx(np.sort_complex(exact.poles()), rel=1e-7)
    report = gp.validate_fmu(path, model)
    assert report.passed, [check for check in report.checks if not check.passed]


def test_a_matrix_that_feeds_energy_in_is_refused(tmp_path):
    K, M = chain(np.random.default_rng(1))
    with pytest.raises(gp.ModelError, match=r"components\.body\.file: damping: feeds energy in"):
        machine(tmp_path, K, M, dashpot(2, 3, 300.0) - dashpot(4, None, 10.0))


def test_digits_of_a_printed_rayleigh_matrix_are_no_dashpots(tmp_path):
    K, M = chain(np.random.default_rng(3))
    C = np.vectorize(lambda x: float(f"{x:.6e}"))(1e-6 * K)
    assert machine(tmp_path, K, M, C).system.components["body"].dashpots == ()


@pytest.mark.parametrize(("eta", "zeta"), [((0.0, 0.0), None), ((0.03, 0.1), None), ((0.1, 0.0), 0.0)])
def test_rigid_joints_keep_the_matrices(tmp_path, eta, zeta):
    """Two structures welded at a mass of each, and one of them to the ground: against their assembled matrices."""
    K, M, C, _ = CASES["Rayleigh and two"]
    data = machine(tmp_path, K, M, C).to_dict()
    other, extra, drag, _ = CASES["one"]
    if zeta is not None:
        drag = zeta * drag
    np.savez(tmp_path / "other.npz", stiffness=other, mass=extra, **({"damping": drag} if drag.any() else {}))
    data["components"]["body"]["ports"] |= {"held": [4], "end": [3]}
    data["components"]["other"] = {
        "kind": "matrices",
        "file": "other.npz",
        "ports": {"end": [0]},
        "loss_factor": eta[1],
    }
    data["components"]["body"]["loss_factor"] = eta[0]
    data["joints"]["weld"] = {"kind": "rigid", "between": ["body.end", "other.end"]}
    data["joints"]["clamp"] = {"kind": "rigid", "between": ["body.held", "ground"]}
    welded = gp.Model.from_dict(data, str(tmp_path / "model.toml"))
    T = np.zeros((2 * N, 2 * N - 2))  # all masses by those of the first less the clamped one, and the others'
    kept = [i for i in range(N) if i != 4]
    T[kept, range(N - 1)] = 1.0
    T[N, 3] = 1.0
    T[range(N + 1, 2 * N), range(N - 1, 2 * N - 2)] = 1.0
    H = T.T @ scipy.linalg.block_diag(eta[0] * K, eta[1] * other) @ T
    K, M, C = (T.T @ scipy.linalg.block_diag(a, b) @ T for a, b in ((K, other), (M, extra), (C, drag)))
    K[N - 2, N - 2] += HELD
    C[N - 2, N - 2] += DAMPER
    w = 2 * np.pi * welded.frequencies()
    dynamic = [K + 1j * H - x**2 * M + 1j * x * C for x in w]
    exact = np.array([1j * x * np.linalg.solve(D, np.eye(2 * N - 2)[1])[N - 2] for x, D in zip(w, dynamic)])
    found = gp.frequency_response(welded).sel(output="sensors.b", input="excitation.force").values
    assert abs(found - exact).max() < 1e-9 * abs(exact).max()
    power = gp.power_flow(welded)
    assert power.dissipated_power.sum("element").values == pytest.approx(power.input_power.values, rel=1e-9)
    matrices = gp.power_matrices(welded).dissipated_power.sum("element").values.real.ravel()
    assert matrices == pytest.approx(power.input_power.values, rel=1e-9)
    assert reference_solution(assemble(welded.system), w).input_power == pytest.approx(power.input_power, rel=1e-8)


def test_the_direct_solution_agrees(tmp_path):
    model = machine(tmp_path, *CASES["Rayleigh and two"][:3])
    exact = reference_solution(assemble(model.system), 2 * np.pi * model.frequencies())
    assert gp.power_flow(model).input_power.values == pytest.approx(exact.input_power, rel=1e-9)


def test_all_checks_of_a_machine_on_a_casing_with_rayleigh_damping(tmp_path):
    """Mass-proportional damping resists rigid motion, too: in the direct solution as in the synthesis."""
    model = frame_model(0.0)
    K, M, ports = matrices_of(model)
    seat = np.eye(len(K))[ports["bearing_1"][0]]
    np.savez(tmp_path / "casing.npz", stiffness=K, mass=M, damping=1e-6 * K + 3.0 * M + 100.0 * np.outer(seat, seat))
    damped = with_casing(model, {"kind": "matrices", "file": "casing.npz", "ports": ports}, tmp_path)
    failed = [check for check in reference_checks(damped, quiet=True) if not check.passed]
    assert failed == []
