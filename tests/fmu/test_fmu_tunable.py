"""Joints and damping that change in the running FMU, against python-control, system by system.

Every piece is simulated by python-control from `gp.state_space` of the replaced model, the state carried over so that
no displacement and no velocity jumps; frequency outputs are those of `gp.power_flow` and `gp.frequency_response`.
"""

from dataclasses import replace
from itertools import pairwise

import fmu_oracle as oracle
import numpy as np
import pytest
import scipy.linalg
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu
from fmu_exchange import Exchange
from fmu_helpers import ROOT, export, stale
from fmu_networks import gearbox
from fmu_piecewise import Piece, Stepper, differences, in_entries, is_modal, simulate
from systems import random_gearbox

import gearpath as gp
from gearpath.api import modal_network
from gearpath.network.assemble import assemble

FULL = {"joints.bearing_1.stiffness": [[6e7, -9e5], [-9e5, 8e4]], "joints.bearing_1.damping": [[300, 4], [4, 0.9]]}
DAMPED = {
    "components.gear_train.modal_damping": 0.06,
    "joints.mount_2.stiffness": 4e6,
    "joints.mount_2.damping": 90.0,
}
ROLLER = {"joints.bearing_3.stiffness": [[1.1e8, 0], [0, 0]], "joints.bearing_3.damping": [[0, 0], [0, 0]]}


def spatial(seed):
    """A full 6 by 6 matrix of a bearing, positive definite, N/m and N m/rad."""
    F = np.random.default_rng(seed).normal(size=(6, 6)) * np.array([1, 1, 1, 0.02, 0.02, 0.02])[:, None]
    return (2e7 * F @ F.T + np.diag([1e8, 1e8, 1e8, 4e4, 4e4, 4e4])).tolist()


HELICAL = {
    "joints.bearing_1.stiffness": spatial(1),
    "joints.bearing_1.damping": (1e-6 * np.array(spatial(2))).tolist(),
}
MODELS = {
    "gearbox": [{}, FULL, FULL | DAMPED, FULL | DAMPED | ROLLER, {}, ROLLER],
    "helical_gearbox": [{}, HELICAL, HELICAL | {"components.gear_train.modal_damping": 0.03}, {}],
}
LENGTH = 30  # steps between two changes


class Machine:
    """A model that is replaced several times, its FMUs, and what python-control makes of it."""

    def __init__(self, name, folder) -> None:
        model = gp.load(ROOT / "models" / f"{name}.toml")
        self.models = [model.replace(changes) if changes else model for changes in MODELS[name]]
        self.networks = [modal_network(model) for model in self.models]
        self.pieces = [Piece(network) for network in self.networks]
        self.inputs = [load.name for load in self.networks[0].loads]
        scale = [1e-6 if load.is_transmission_error else 1.0 for load in self.networks[0].loads]
        self.u = np.random.default_rng(4).normal(size=(LENGTH * len(self.models) + 1, len(scale))) * scale
        self.unpacked = {}
        for fmi in ("2.0", "3.0"):
            path = gp.export_fmu(model, folder / f"{name}{fmi[0]}.fmu", fmi=fmi)
            self.unpacked[int(fmi[0])] = Fmu.unpack(path, folder / f"{name}{fmi[0]}")

    def quiet(self, version) -> dict:
        """Switches the gear mesh source off, where there is one: here all excitation comes through the inputs."""
        return {n: 0.0 for n in variables(self.unpacked[version]) if n.endswith(".amplitude")}

    def stepper(self, version) -> Stepper:
        it = Stepper(self.unpacked[version])
        it.set(self.quiet(version))
        return it

    @property
    def changes(self):
        return {LENGTH * (k + 1): differences(*pair) for k, pair in enumerate(pairwise(self.networks))}


def variables(unpacked):
    return [v.name for v in unpacked.description.modelVariables]


@pytest.fixture(scope="module", params=list(MODELS))
def machine(request, tmp_path_factory):
    if stale():
        pytest.fail(stale(), pytrace=False)
    return Machine(request.param, tmp_path_factory.mktemp("tunable"))


def deviation(found, wanted):
    """Of each output, relative to its largest value; forces on the ground and their like are zero."""
    size = np.abs(wanted).max(axis=0)
    assert (found[:, size == 0] == 0).all()
    return np.max(np.abs(found - wanted)[:, size > 0] / size[size > 0])


@pytest.mark.parametrize("linear", [False, True], ids=["held", "linear"])
@pytest.mark.parametrize("h", [2e-6, 1e-4])
def test_co_simulation(machine, h, linear):
    """Every output over time, powers too, through all changes and back to the start values and away again."""
    lengths = [LENGTH] * len(machine.pieces)
    wanted, names = simulate(machine.pieces, lengths, machine.u, h, linear=linear), machine.pieces[0].names
    for version in machine.unpacked:
        it = machine.stepper(version)
        found = it.run(machine.inputs, machine.u, h, names, machine.changes, linear=linear)
        assert deviation(found, wanted) < 1e-9, version
        it.fmu.free()


@pytest.mark.parametrize("version", [2, 3])
def test_the_modal_form_comes_back(machine, version):
    """The start values bring the cheap form back, which the comparison above goes through too."""
    it = machine.stepper(version)
    for k, network in enumerate(machine.networks):
        it.set(machine.changes.get(LENGTH * k, {}))
        assert it.fmu.step(k * 1e-5, 1e-5) == OK
        assert is_modal(it.fmu.serialised()) == (not differences(machine.networks[0], network))
    it.fmu.free()


def frequency_outputs(model, hertz):
    """Power ratios by `gp.power_flow`, and transfers by `gp.frequency_response`, both by name."""
    flow = gp.power_flow(model, [hertz]).isel(frequency=0)
    ratios = {name: float(flow[name]) for name in ("alpha", "alpha_force", "alpha_moment")}
    for path in flow.path.values:
        name = f"{path.rsplit('.', 1)[0]}.alpha"
        ratios[name] = ratios.get(name, 0.0) + float(flow.path_alpha.sel(path=path))
    response = gp.frequency_response(model, [hertz], inputs=modal_network(model).excitation)
    return ratios, dict(zip(response.output.values, response.values.ravel()))


@pytest.mark.parametrize("version", [2, 3])
def test_frequency_outputs_follow_at_once(machine, version):
    """No step between the change and the question: ratios to 1e-9, transfers to 1e-11 of the largest of their kind.

    The transfers of the nearly symmetric default gearbox cancel: a casing rotation is 1e-6 of the motion of its parts.
    """
    it = machine.stepper(version)
    declared = variables(it.fmu.unpacked)
    shares = {n for n in declared if n.startswith("alpha") or (n.startswith("bearing_") and n.endswith(".alpha"))}
    for k, model in enumerate(machine.models):
        it.set(machine.changes.get(LENGTH * k, {}))
        for hertz in (33.0, 710.0, 4100.0):
            it.set({"frequency": hertz})
            ratios, transfers = frequency_outputs(model, hertz)
            assert set(ratios) == shares
            assert {f"frf.{n}.{part}" for n in transfers for part in ("re", "im")} == {
                n for n in declared if n.startswith("frf.")
            }
            gross = max(map(abs, ratios.values()))
            assert np.abs(it.fmu.get(list(ratios)) - list(ratios.values())).max() <= 1e-9 * gross
            kinds = {n: n.rsplit(".", 1)[-1].split("_")[0] for n in transfers}
            for name, value in transfers.items():
                size = max(abs(other) for n, other in transfers.items() if kinds[n] == kinds[name])
                found = complex(*it.fmu.get([f"frf.{name}.re", f"frf.{name}.im"]))
                assert abs(found - value) <= 1e-11 * size, (hertz, name)
    it.fmu.free()


def own_matrices(it, inputs):
    """A and B from the FMU's derivatives at unit states and inputs."""
    nominals, zero = it.vector("GetNominalsOfContinuousStates"), dict.fromkeys(inputs, 0.0)
    it.set(zero)
    A = np.empty((it.n, it.n))
    for j, x in enumerate(np.diag(nominals)):
        it.states = x
        A[:, j] = it.derivatives / nominals[j]
    it.states = np.zeros(it.n)
    B = []
    for name in inputs:
        it.set(zero | {name: 1.0})
        B.append(it.derivatives)
    it.set(zero)
    return A, np.array(B).T


def held(A, B, h):
    n, m = B.shape
    E = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((m, n + m))]]))
    return E[:n, :n], E[:n, n:]


@pytest.mark.parametrize("version", [2, 3])
def test_model_exchange(machine, version):
    """Exact exponentials of the FMU's own derivatives between events; its own states are what an event leaves."""
    h, pieces = 1e-5, machine.pieces
    wanted = simulate(pieces, [LENGTH] * len(pieces), machine.u, h, linear=False)
    unpacked = machine.unpacked[version]
    fmu = Fmu(unpacked, kind=0) if version == 2 else Fmu3(unpacked, exchange=True)
    assert fmu.set(machine.quiet(version)) == OK
    fmu.enter("continuous")
    it = Exchange(fmu, version)
    it.n = pieces[0].space.nstates + bool(machine.quiet(version))  # the angle of the source
    found, x = [], np.zeros(it.n)
    for i, u in enumerate(machine.u):
        it.ok("SetTime", i * h)
        it.states = x
        it.set(dict(zip(machine.inputs, u)))
        if i in machine.changes:
            it.ok("EnterEventMode")
            it.set(in_entries(machine.changes[i], version))
            damped = any("modal" in name for name in machine.changes[i])
            assert it.update() == damped
            it.ok("EnterContinuousTimeMode")
            assert damped != np.array_equal(it.states, x)
            x = it.states
        found.append(fmu.get(pieces[0].names))
        if i % LENGTH == 0 and i + 1 < len(machine.u):
            E, F = held(*own_matrices(it, machine.inputs), h)
        x = E @ x + F @ u
    assert deviation(np.array(found), wanted) < 1e-9
    fmu.free()


@pytest.mark.parametrize("version", [2, 3])
def test_no_velocity_jumps(machine, version):
    """Joints and damping change at once under a transmission error: displacements and velocities of all modes stay."""
    network, loads = machine.networks[0], machine.inputs
    it, names = machine.stepper(version), machine.pieces[0].names
    it.run(loads, machine.u[:LENGTH], 1e-5, names, {}, linear=False)
    N = len(network.eigenvalues)
    motion = ["der(state)"] if version == 3 else [n for n in it.fmu.reference if n.startswith("der(")]
    before, forces = it.fmu.get(motion), it.fmu.get([n for n in names if ".force_" in n])
    it.set(differences(network, machine.networks[2]) | {"gear_train.modal_damping": 0.3})
    after = it.fmu.get(motion)
    scale = np.abs(before[:N]).max()
    assert np.abs(after[:N] - before[:N]).max() <= 1e-13 * scale
    assert np.abs(after[N:] - before[N:]).max() > 1e-3 * np.abs(before[N:]).max()
    assert not np.allclose(it.fmu.get([n for n in names if ".force_" in n]), forces, rtol=1e-3, atol=0.0)
    it.fmu.free()


def test_entries_one_by_one_in_any_order(machine):
    """Entries of the upper half in calls of their own, indefinite on the way: as with all at once, bit for bit."""
    network = machine.networks[1]
    values, u = in_entries(differences(machine.networks[0], network), 2), machine.u[:30]
    results = []
    for order in (list(values), list(values)[::-1], sorted(values, key=hash)):
        it = machine.stepper(2)
        it.run(machine.inputs, u, 1e-5, machine.pieces[0].names, {}, linear=False)
        for name in order:
            assert it.fmu.set({name: values[name]}) == OK
        results.append(it.fmu.serialised())
        assert it.fmu.get(["alpha"])[0] > 0
        results[-1] += it.fmu.serialised()
        it.fmu.free()
    assert results[0] == results[1] == results[2]


def random_networks(seed):
    """A network as exported and twice changed: joints of any rank, and every damping ratio."""
    rng = np.random.default_rng(seed)
    if seed % 2:
        networks = [gearbox(seed, mesh_moves_bearings=seed % 3 == 0)]
    else:
        networks = [assemble(random_gearbox(seed, seed % 5 + 1)).modal()]
    for _ in range(2):
        network = networks[-1]
        for joint in rng.permutation(np.array(network.joints, dtype=object))[:3]:
            scale, rank = np.sqrt(np.diag(joint.stiffness)), int(rng.integers(1, len(joint.dofs) + 1))
            F, G = scale[:, None] * rng.normal(size=(2, len(scale), rank))
            network = network.with_joint(joint.name, F @ F.T, 1e-6 * G @ G.T)
        damping = {name: float(rng.uniform(0.001, 0.1)) for name in network.modal_damping}
        networks.append(replace(network, modal_damping=damping))
    return [*networks, networks[0]]


@pytest.mark.parametrize("seed", [1, 3, 5, 7, 6, 8, 14, 16, 26])
def test_random_networks(seed, tmp_path):
    """Over time by python-control; over frequency by one dense solve of the coupled equations."""
    networks = random_networks(seed)
    pieces = [Piece(network) for network in networks]
    scale = [1e-6 if load.is_transmission_error else 1.0 for load in networks[0].loads]
    u = np.random.default_rng(seed).normal(size=(25 * len(networks) + 1, len(scale))) * scale
    wanted = simulate(pieces, [25] * len(networks), u, 1e-5, linear=bool(seed % 4))
    changes = {25 * (k + 1): differences(a, b) for k, (a, b) in enumerate(pairwise(networks))}
    fmi = "2.0" if seed % 3 else "3.0"
    it = Stepper(Fmu.unpack(export(networks[0], tmp_path / "it.fmu", fmi=fmi), tmp_path / "it"))
    inputs = [load.name for load in networks[0].loads]
    found = it.run(inputs, u, 1e-5, pieces[0].names, changes, linear=bool(seed % 4))
    assert deviation(found, wanted) < 1e-9
    for before, network in pairwise(networks):
        it.set(differences(before, network))
        expected = oracle.frequency_response(network, 500.0)
        gross = max(abs(value) for name, value in expected.items() if "alpha" in name)
        for name, value in expected.items():
            if "alpha" in name:
                assert abs(it.fmu.get([name])[0] - value) < 1e-9 * gross, name
    it.fmu.free()
