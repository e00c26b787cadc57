"""Ports by node whose places the file knows: what the model says of them must agree. Motions without mass."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from test_foreign import DAMPER, beam_pair, found_mobility, mobility, small_machine

import gearpath as gp

BEAM = np.array([[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]])


def noded(folder, length=1.0):
    """Two masses with a node each, at x = 0 and 0.3 m, in a file of this unit of length."""
    K, M, _ = beam_pair()
    places = np.array([[0.0, 0.1, 0.0], [0.3, 0.1, 0.0]]) / length
    np.savez(
        folder / "body.npz",
        stiffness=np.kron(K, np.eye(3)),
        mass=np.kron(M, np.eye(3)),
        dof_nodes=[1, 1, 1, 2, 2, 2],
        dof_directions=[1, 2, 3] * 2,
        nodes=[1, 2],
        positions=places,
    )
    return {"kind": "matrices", "file": "body.npz", "ports": {"a": {"node": 1}, "b": {"node": 2}}}


def held(table, folder, **joint):
    """The component on a mount under a rigid body."""
    model = small_machine(noded(folder) if table is None else table, folder).to_dict()
    inertia = {"xx": 1.0, "yy": 1.0, "zz": 1.0}
    block = {"kind": "rigid_body", "centre_of_gravity": [0.0, 0.0, 0.0], "mass": 1.0, "inertia": inertia}
    model["components"]["block"] = block
    model["joints"]["under"] = {"kind": "mount", "between": ["block", "body.a"], "stiffness": 1e6} | joint
    return gp.Model.from_dict(model, str(folder / "model.toml"))


@pytest.mark.parametrize(("units", "length"), [("SI", 1.0), ("mm-t-s", 1e-3)])
def test_the_place_of_a_port_beside_that_of_its_node(tmp_path, units, length):
    table = noded(tmp_path, length) | {"units": units}
    table["ports"]["b"]["at"] = [0.30001, 0.1, 0.0]  # rounded
    places = small_machine(table, tmp_path).system.components["body"].places
    assert places["a"] == pytest.approx((0.0, 0.1, 0.0))
    table["ports"]["b"]["at"] = [0.301, 0.1, 0.0]
    words = r"ports\.b\.at: \[0\.301, 0\.1, 0\.0\] is given beside node 2, which the file places at \[0\.3, 0\.1, 0\] m"
    with pytest.raises(gp.ModelError, match=words):
        small_machine(table, tmp_path)


def test_the_place_of_a_joint_beside_that_of_a_node(tmp_path):
    model = held(None, tmp_path, at=[0.0, 0.1, 0.0])
    assert model.system.joints["under"].at == (0.0, 0.1, 0.0)
    with pytest.raises(
        gp.ModelError, match=r'joints\.under\.at: .* beside "body\.a", which the file places at \[0, 0\.1'
    ):
        held(None, tmp_path, at=[0.0, 0.0, 0.0])


def turning_beam(count):
    """K and lumped M of a beam held softly: no rotary inertia, so that count + 1 motions have no mass."""
    n = 2 * count + 2
    K = np.zeros((n, n))
    for k in range(count):
        K[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += np.pi * 1e6 * BEAM
    K[0, 0] += 1e5
    K[-2, -2] += 1e5
    return K, np.diag(np.tile([0.3, 0.0], count + 1))


def test_motions_without_mass_are_no_modes(tmp_path):
    """Natural frequencies and states are those of the masses and of the port that turns; responses stay exact."""
    K, M = turning_beam(10)
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M)
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": {"uy": 0, "rx": 1}, "b": {"uy": 20}}}
    model = small_machine(table, tmp_path)
    K[20, 20] += 1e6
    inverse = scipy.linalg.eigvalsh(M, K)
    exact = np.sort(1.0 / np.sqrt(inverse[inverse > 1e-9 * inverse.max()])) / (2 * np.pi)
    assert gp.natural_frequencies(model) == pytest.approx(exact, rel=1e-8)
    assert len(exact) == 11
    assert gp.state_space(model).nstates == 2 * (11 + 1)
    component = model.system.components["body"]
    assert replace(component) == component
    assert replace(component, motion=2.0 * component.motion) != component
    C = np.zeros((22, 22))
    C[20, 20] = 50.0
    f = model.frequencies()
    assert found_mobility(model) == pytest.approx(mobility(K, M, C, f), rel=1e-6)
    data = model.to_dict() | {"dofs": ["uy", "rx"]}
    turning = gp.Model.from_dict(data, model.file).replace({"excitation.dof": "rx", "sensors.a.dof": "rx"})
    wanted = mobility(K, M, C, f, 1)
    assert abs(found_mobility(turning) - wanted).max() < 1e-6 * abs(wanted).max()


def test_a_dashpot_behind_a_spring_without_mass_between(tmp_path):
    """Maxwell's element to the ground: the massless point between moves against its dashpot, not with its springs."""
    K, M = np.array([[3e6, -2e6], [-2e6, 2e6]]), np.diag([2.0, 0.0])
    C = np.diag([0.0, 800.0])
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M, damping=C)
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": [0]}}
    model = small_machine(table, tmp_path)
    exact = mobility(K + np.diag([1e6, 0.0]), M, C + np.diag([DAMPER[1, 1], 0.0]), model.frequencies())
    assert found_mobility(model) == pytest.approx(exact, rel=1e-5)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"stiffness": np.zeros((0, 0))}, r"stiffness: has shape \(0, 0\); give an n x n matrix"),
        ({"stiffness": np.array(3.0)}, r"stiffness: has shape \(\); give"),
        ({"mass": np.array([2.0, 3.0])}, r"mass: has shape \(2,\) beside a stiffness of \(2, 2\)"),
        ({"mass": np.full((2, 2), 5e-324)}, "stiffness: is so large beside the mass that no coordinate is below 1 GHz"),
        ({"damping": np.eye(3)}, r"damping: has shape \(3, 3\) beside"),
        ({"mass": np.diag([1.0, 1.0j])}, "body.npz: mass is not an array of numbers"),
        ({"mass": np.array([[None]])}, "body.npz: cannot be read"),
        (
            {"damping_row": np.array([10**9]), "damping_column": np.array([0]), "damping_value": np.array([1.0])},
            "body.npz: numbers 1000000001 coordinates, but has 11 entries; number them from 0 on without gaps",
        ),
        (
            {name: np.array([0, 1], np.uint8) for name in ("damping_row", "damping_column")}
            | {"damping_value": np.array([-1.0, 1.0])},
            "damping: feeds energy in",
        ),
    ],
)
def test_arrays_that_are_no_matrices(tmp_path, arrays, words):
    K, M, _ = beam_pair()
    np.savez(tmp_path / "body.npz", **({"stiffness": K, "mass": M} | arrays))
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": [1]}}
    with pytest.raises(gp.ModelError, match=rf"components\.body\.file: {words}"):
        small_machine(table, tmp_path)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"frequencies": np.array([0.0, np.nan])}, "frequencies has nan; give frequencies in Hz"),
        ({"frequencies": np.array([[0.0, 300.0]])}, r"shapes \(1, 2\) are not 1 rows of 2 numbers"),
        ({"shapes": np.array([[np.inf, 1.0]])}, "shapes has inf; give finite numbers"),
        ({"damping": np.array([0.0, -0.01])}, "damping has -0.01; give damping ratios from 0 to below 1"),
        ({"damping": np.array(["a", "b"])}, "damping is not an array of numbers"),
        ({"modal_masses": np.array([1.0, 0.0])}, "modal_masses has 0; give masses above 0"),
        ({"modal_masses": np.ones(3)}, "modal_masses has 3 entries for 2 modes"),
    ],
)
def test_arrays_that_are_no_modes(tmp_path, arrays, words):
    modes = {"frequencies": np.array([0.0, 300.0]), "shapes": np.array([[0.5, 0.4]]), "dofs": ["1:uy"]}
    np.savez(tmp_path / "modes.npz", **(modes | arrays))
    table = {"kind": "modal", "file": "modes.npz", "ports": {"a": {"node": 1}, "b": {"node": 1}}}
    with pytest.raises(gp.ModelError, match=rf"components\.body\.file: modes.npz: {words}"):
        small_machine(table, tmp_path)
