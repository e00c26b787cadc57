"""Casings from files: matrices in every format and modes against the native component; units, damping, refusals."""

import numpy as np
import pytest
import scipy.linalg
from foreign_cases import frame_model, matrices_of, with_casing, written

import gearpath as gp
from gearpath.network.assemble import assemble
from gearpath.network.foreign import described
from gearpath.network.reference import reference_solution

FORMS = ("npz", "sparse npz", "mtx", "op4", "sti")


@pytest.fixture(scope="module")
def model():
    return frame_model()


@pytest.fixture(scope="module")
def frame(model):
    return matrices_of(model)


@pytest.fixture(scope="module")
def exact(model):
    """Power ratio of the machine solved at once in physical coordinates, with the frame's own sparse matrices."""
    return reference_solution(assemble(model.system), 2 * np.pi * model.frequencies()).alpha


@pytest.mark.parametrize("form", FORMS)
def test_every_format_gives_the_same_power_flow(model, frame, exact, tmp_path, form):
    K, M, ports = frame
    found = gp.power_flow(with_casing(model, written(form, K, M, ports, tmp_path), tmp_path))
    assert found.alpha.values == pytest.approx(exact, rel=1e-8, abs=1e-10)


def beam_pair():
    """K and M of two masses of 2 and 3 kg on a spring of 5e6 N/m, free; its one elastic mode in closed form."""
    K = 5e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return K, np.diag([2.0, 3.0]), np.sqrt(5e6 * (1 / 2 + 1 / 3))


def small_machine(table, folder, **joints):
    """A component on two springs to the ground at its ports a and b, driven at a."""
    spring = {"kind": "mount", "between": ["body.b", "ground"], "stiffness": 1e6, "damping": 50.0}
    data = {
        "name": "small",
        "dofs": ["uy"],
        "frequency": {"start": 5.0, "stop": 1500.0, "points": 60},
        "components": {"body": table},
        "joints": {"spring": spring} | joints,
        "excitation": {"point": "body.a", "dof": "uy"},
        "sensors": {"a": {"component": "body", "point": "a", "dof": "uy"}},
    }
    return gp.Model.from_dict(data, str(folder / "model.toml"))


def mobility(K, M, C, f, row=0):
    """Velocity of a coordinate by a unit force on it, straight from the matrices."""
    w = 2 * np.pi * f
    return np.array([1j * x * np.linalg.inv(K - x**2 * M + 1j * x * C)[row, row] for x in w])


def found_mobility(model):
    return gp.frequency_response(model).sel(output="sensors.a", input="excitation.force").values


PORTS = {"a": {"uy": 0}, "b": {"uy": 1}}
HELD, DAMPER = np.diag([0.0, 1e6]), np.diag([0.0, 50.0])


def test_two_masses_in_closed_form(tmp_path):
    K, M, w = beam_pair()
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M)
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": [1]}, "modal_damping": 0.01}
    model = small_machine(table, tmp_path)
    shape = np.array([np.sqrt(3 / 2), -np.sqrt(2 / 3)]) / np.sqrt(5.0)  # mass-normalised
    C = 2 * 0.01 * w * np.outer(M @ shape, M @ shape)
    assert found_mobility(model) == pytest.approx(mobility(K + HELD, M, C + DAMPER, model.frequencies()), rel=1e-10)


def test_a_damping_matrix_that_the_modes_diagonalise(tmp_path):
    """Rayleigh's stiffness part: a ratio of its own for every mode; in frequency, in time and at the mean ratio."""
    n = 6
    K = 4e6 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    K[0, 0] = K[-1, -1] = 4e6
    M, time = np.diag(np.linspace(1.0, 2.0, n)), 2e-5
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M, damping=time * K)
    model = small_machine({"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": [5]}}, tmp_path)
    held, damper = np.zeros((n, n)), np.zeros((n, n))
    held[5, 5], damper[5, 5] = 1e6, 50.0
    exact = mobility(K + held, M, time * K + damper, model.frequencies())
    assert found_mobility(model) == pytest.approx(exact, rel=1e-9)
    system = gp.state_space(model)
    H = system["sensors/a", "excitation/force"](2j * np.pi * model.frequencies())
    assert list(H) == pytest.approx(list(exact), rel=1e-8)


def test_coordinates_without_mass_follow_statically(tmp_path):
    """Two masses, a massless point in the middle of their spring; a force on it too meets its own compliance."""
    K, M, _ = beam_pair()
    three = 1e7 * np.array([[1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, 2.0]])
    np.savez(tmp_path / "body.npz", stiffness=three, mass=np.diag([2.0, 3.0, 0.0]))
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": [1], "middle": [2]}}
    model = small_machine(table, tmp_path)
    exact = mobility(K + HELD, M, DAMPER, model.frequencies())
    assert found_mobility(model) == pytest.approx(exact, rel=1e-6)
    full = mobility(
        three + np.diag([0.0, 1e6, 0.0]), np.diag([2.0, 3.0, 0.0]), np.diag([0.0, 50.0, 0.0]), model.frequencies(), 2
    )
    middle = model.replace({"excitation.point": "body.middle", "sensors.a.point": "middle"})
    assert found_mobility(middle) == pytest.approx(full, rel=1e-6)


def test_a_mass_that_is_zero_but_for_printed_digits(tmp_path):
    """-1e-7 of the largest, as seven digits leave it: no mass, and no broken factorisation."""
    K = np.array([[2e7, -1e7], [-1e7, 1e7]])
    np.savez(tmp_path / "body.npz", stiffness=K, mass=np.diag([-1e-7, 1.0]))
    model = small_machine({"kind": "matrices", "file": "body.npz", "ports": PORTS}, tmp_path)
    exact = mobility(K + HELD, np.diag([0.0, 1.0]), DAMPER, model.frequencies())
    assert found_mobility(model) == pytest.approx(exact, rel=1e-5)


@pytest.mark.parametrize("sparse", [False, True])
def test_millimetres_and_tonnes(tmp_path, sparse):
    """A cantilever of one element, Euler, in both systems of units: translations and rotations."""
    length, EI, mass = 0.4, 2.0e3, 1.5
    K = EI / length**3 * np.array([[12.0, -6 * length], [-6 * length, 4 * length**2]])
    M = mass / 420 * np.array([[156.0, -22 * length], [-22 * length, 4 * length**2]])
    mm = np.diag([1e-3, 1.0])  # m per mm, rad
    names = ("stiffness", "mass")
    inside = {name: 1e3 * mm @ matrix @ mm for name, matrix in zip(names, (K, M))}  # N mm of energy
    if sparse:
        i, k = np.indices((2, 2))
        inside = {
            f"{name}_{part}": values.ravel()
            for name in names
            for part, values in (("row", i), ("column", k), ("value", inside[name]))
        }
    np.savez(tmp_path / "mm.npz", **inside)
    ports = {"a": {"uy": 0, "rx": 1}, "b": {"uy": 0}}
    table = {"kind": "matrices", "file": "mm.npz", "units": "mm-t-s", "ports": ports}
    model = small_machine(table, tmp_path)
    f = model.frequencies()
    held, damper = np.diag([1e6, 0.0]), np.diag([50.0, 0.0])
    assert found_mobility(model) == pytest.approx(mobility(K + held, M, damper, f), rel=1e-9)
    turning = gp.Model.from_dict(model.to_dict() | {"dofs": ["uy", "rx"]}, model.file)
    turning = turning.replace({"excitation.dof": "rx", "sensors.a.dof": "rx"})
    assert found_mobility(turning) == pytest.approx(mobility(K + held, M, damper, f, 1), rel=1e-9)


def modes_of(K, M):
    values, shapes = scipy.linalg.eigh(K, M)
    return np.sqrt(np.maximum(values, 0.0)) / (2 * np.pi), shapes


def test_modes_in_the_file_and_in_the_model_are_the_matrices(tmp_path):
    K, M, _ = beam_pair()
    f, shapes = modes_of(K, M)
    f[0] = 0.0
    masses = np.array([4.0, 0.25])
    scaled = shapes * np.sqrt(masses)
    np.savez(
        tmp_path / "modes.npz",
        frequencies=f,
        shapes=scaled,
        dofs=["1:uy", "2:uy"],
        damping=[0.0, 0.01],
        modal_masses=masses,
    )
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M)
    matrices = {"kind": "matrices", "file": "body.npz", "modal_damping": 0.01, "ports": PORTS}
    exact = found_mobility(small_machine(matrices, tmp_path))
    typed = {
        "kind": "modal",
        "frequencies": f.tolist(),
        "damping": 0.01,
        "modal_masses": masses.tolist(),
        "ports": {"a": {"uy": scaled[0].tolist()}, "b": {"uy": scaled[1].tolist()}},
    }
    assert found_mobility(small_machine(typed, tmp_path)) == pytest.approx(exact, rel=1e-9)
    rows = [{"frequencies": f, "shapes": np.vstack([scaled, 0 * scaled, 0 * scaled])}]
    names = ["1:uy", "2:uy", "1:ux", "2:ux", "1:uz", "2:uz"]
    np.savez(tmp_path / "nodes.npz", dofs=names, damping=[0.0, 0.01], modal_masses=masses, **rows[0])
    by_node = {"kind": "modal", "file": "nodes.npz", "ports": {"a": {"node": 1}, "b": {"node": 2}}}
    assert found_mobility(small_machine(by_node, tmp_path)) == pytest.approx(exact, rel=1e-9)


def test_modes_of_a_universal_file(tmp_path):
    """Dataset 55 written by pyuff, one mode a set; complex shapes are turned real."""
    pyuff = pytest.importorskip("pyuff")
    K, M, _ = beam_pair()
    K = K + np.diag([2e5, 0.0])
    f, shapes = modes_of(K, M)
    for name, turn in (("real.uff", 1.0), ("turned.uff", np.exp(0.7j))):
        for k in range(2):
            zero = np.zeros(2) * turn
            pyuff.UFF(str(tmp_path / name)).write_sets(
                pyuff.prepare_55(
                    model_type=1,
                    analysis_type=2 if turn == 1.0 else 3,
                    data_ch=2,
                    spec_data_type=8,
                    data_type=2 if turn == 1.0 else 5,
                    n_data_per_node=3,
                    r1=zero,
                    r2=shapes[:, k] * turn,
                    r3=zero,
                    node_nums=[1, 2],
                    mode_n=k + 1,
                    freq=f[k],
                    modal_m=1.0,
                    modal_damp_vis=0.01,
                    modal_damp_his=0.0,
                    load_case=1,
                    modal_a=0.0,
                    modal_b=0.0,
                    eig=2 * np.pi * f[k] * (-0.01 + 1j * np.sqrt(1 - 1e-4)),
                ),
                "overwrite" if k == 0 else "add",
            )
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M)
    matrices = {"kind": "matrices", "file": "body.npz", "modal_damping": 0.01, "ports": PORTS}
    exact = found_mobility(small_machine(matrices, tmp_path))
    for name in ("real.uff", "turned.uff"):
        modal = {"kind": "modal", "file": name, "ports": {"a": {"node": 1}, "b": {"node": 2}}}
        assert found_mobility(small_machine(modal, tmp_path)) == pytest.approx(exact, rel=1e-3)  # seven printed digits


@pytest.mark.parametrize("kind", ["native", "python"])
def test_fmus_of_a_machine_with_matrices(model, frame, tmp_path, kind):
    K, M, ports = frame
    foreign = with_casing(model, written("npz", K, M, ports, tmp_path), tmp_path)
    path = gp.export_fmu(foreign, tmp_path / "it.fmu", kind=kind, documentation=False)
    import fmpy

    found = fmpy.simulate_fmu(
        str(path), stop_time=1e-4, step_size=1e-5, start_values={"frequency": 640.0}, output=["alpha"]
    )
    wanted = gp.power_flow(
        foreign.replace({"components.casing.loss_factor": 0.0, "components.casing.modal_damping": 0.01}), [640.0]
    )
    assert found["alpha"][-1] == pytest.approx(wanted.alpha.item(), rel=1e-8)


def test_twins_agree(model, frame, tmp_path):
    K, M, ports = frame
    table = written("npz", K, M, ports, tmp_path) | {"loss_factor": 0.0, "modal_damping": 0.01}
    foreign = with_casing(model, table, tmp_path)
    f = foreign.frequencies()
    H = gp.frequency_response(foreign)
    found = np.moveaxis(gp.state_space(foreign)(2j * np.pi * f), -1, 0)
    assert (abs(found - H.values).max(axis=0) <= 1e-8 * abs(H.values).max(axis=0)).all()


@pytest.mark.parametrize(
    ("changes", "arrays", "words"),
    [
        ({"file": "none.npz"}, {}, r"components\.body\.file: none\.npz: there is no such file; give its path"),
        ({"file": "body.xyz"}, {}, r'file: "body\.xyz" is no file of matrices'),
        ({"mass_file": "m.mtx"}, {}, "holds all matrices; leave mass_file"),
        ({}, {"mass": None}, r"has no array 'mass' \(it has: stiffness\); add it"),
        ({}, {"mass": np.eye(3)}, r"mass: has shape \(3, 3\) beside a stiffness of \(2, 2\)"),
        ({}, {"stiffness": np.array([[1.0, 2.0], [0.0, 1.0]])}, "stiffness: is not symmetric"),
        ({}, {"stiffness": np.array([[1.0, np.nan], [np.nan, 1.0]])}, "stiffness: has entries that are not finite"),
        ({}, {"stiffness": np.array([[1e6, 0.0], [0.0, -1e6]])}, "stiffness: is negative in some motion"),
        ({}, {"mass": np.diag([1.0, -1.0])}, "mass: its lowest eigenvalue"),
        (
            {},
            {"mass": np.diag([1.0, 0.0]), "stiffness": np.diag([1e6, 0.0])},
            "none in some motion that no stiff",
        ),
        ({}, {"mass": np.array([["a"]])}, "mass is not an array of numbers"),
        ({"ports": {"a": [0], "b": [7]}}, {}, r"ports\.b\.uy: 7 is beyond the 2 coordinates"),
        ({"ports": {"a": [0, 1], "b": [1]}}, {}, r"ports\.a: has 2 coordinates; give 1 or 3 or 6"),
        ({"ports": {"a": {"node": 1}, "b": [1]}}, {}, r"ports\.a\.node: the file does not say"),
        ({"ports": {"a": {"node": 1, "uy": 0}, "b": [1]}}, {}, r"ports\.a: is given in no way or in several"),
        ({"ports": {"a": [0.5], "b": [1]}}, {}, r"0\.5 is no coordinate"),
        ({"ports": {"a": [0]}}, {}, r'there is no port "body\.b"'),
        ({"units": "inch"}, {}, "units"),
        ({"modal_damping": 0.01, "loss_factor": 0.02}, {}, r"loss_factor: 0\.02 is given beside modal_damping, 0\.01"),
    ],
)
def test_matrices_that_do_not_fit(tmp_path, changes, arrays, words):
    K, M, _ = beam_pair()
    content = {name: value for name, value in ({"stiffness": K, "mass": M} | arrays).items() if value is not None}
    np.savez(tmp_path / "body.npz", **content)
    (tmp_path / "body.xyz").write_text("")
    table = {"kind": "matrices", "file": "body.npz", "ports": {"a": [0], "b": [1]}} | changes
    with pytest.raises(gp.ModelError, match=words):
        small_machine(table, tmp_path)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frequencies": None}, r"components\.body\.frequencies: is missing"),
        ({"frequencies": [0.0, -3.0]}, r"-3\.0 is no frequency"),
        ({"damping": [0.1, 0.1, 0.1]}, "damping: has 3 numbers for 2 modes; give one, or one a mode"),
        ({"damping": 1.0}, "1.0 is no damping ratio"),
        ({"ports": {"a": {"uy": [1.0]}, "b": {"uy": [1.0, 2.0]}}}, r"ports\.a\.uy: has 1 numbers for 2 modes"),
        ({"ports": {"a": {}, "b": {"uy": [1.0, 2.0]}}}, r"ports\.a: has no shape"),
        ({"ports": {"a": {"node": 3}, "b": {"uy": [1.0, 2.0]}}}, r"ports\.a\.node: there is no file"),
        ({"file": "m.npz"}, r"frequencies: is given beside a file|no such file"),
    ],
)
def test_modes_that_do_not_fit(tmp_path, changes, words):
    table = {
        "kind": "modal",
        "frequencies": [0.0, 300.0],
        "ports": {"a": {"uy": [0.4, 0.3]}, "b": {"uy": [0.4, -0.3]}},
    } | changes
    with pytest.raises(gp.ModelError, match=words):
        small_machine({key: value for key, value in table.items() if value is not None}, tmp_path)


def test_a_component_is_described_by_mass_and_frequency(tmp_path):
    K, M, w = beam_pair()
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M)
    model = small_machine({"kind": "matrices", "file": "body.npz", "ports": PORTS}, tmp_path)
    first = f"first elastic one {w / (2 * np.pi):.4g} Hz"
    assert described(model.system) == {"body": f"matrices, 2 modes, 1 rigid, {first}, mass 5 kg along uy"}
    data = model.to_dict()
    ports = {"a": {"uy": [0.6, 0.5]}, "b": {"uy": [0.6, -0.5]}}
    data["components"]["body"] = {"kind": "modal", "frequencies": [0.0, 300.0], "ports": ports}
    found = described(gp.Model.from_dict(data, str(tmp_path / "model.toml")).system)
    assert found == {"body": f"modal, 2 modes, 1 rigid, first elastic one 300 Hz, mass {1 / 0.36:.4g} kg along uy"}


def test_stiffness_and_mass_exchanged(tmp_path):
    K, M, _ = beam_pair()
    np.savez(tmp_path / "body.npz", stiffness=M, mass=K)
    with pytest.raises(gp.ModelError, match=r"components\.body\.file: stiffness: is so small .* exchange"):
        small_machine({"kind": "matrices", "file": "body.npz", "ports": PORTS}, tmp_path)


def test_one_coordinate_twice_in_a_port(tmp_path):
    K, M, _ = beam_pair()
    np.savez(tmp_path / "body.npz", stiffness=K, mass=M)
    ports = {"a": {"uy": 0, "ux": 0}, "b": [1]}
    with pytest.raises(gp.ModelError, match=r"ports\.a: has one coordinate for several of u., u."):
        small_machine({"kind": "matrices", "file": "body.npz", "ports": ports}, tmp_path)


def test_damping_and_vectors_leave_the_prepared_matrices(tmp_path):
    """Their preparation takes seconds for a large structure, and a study changes damping often."""
    K, M, _ = beam_pair()
    np.savez(tmp_path / "body.npz", stiffness=1.2345 * K, mass=M)  # of no other test
    model = small_machine({"kind": "matrices", "file": "body.npz", "ports": PORTS}, tmp_path)
    other = model.replace({"components.body.loss_factor": 0.1, "components.body.vectors": 20})
    first, second = (m.system.components["body"] for m in (model, other))
    assert second.stiffness is first.stiffness
    assert (second.loss_factor, first.loss_factor) == (0.1, 0.0)
    assert first != second
