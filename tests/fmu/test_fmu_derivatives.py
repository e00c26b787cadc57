"""Directional and adjoint derivatives: against differences of the FMU's own values, and the state equations.

Time outputs, state derivatives and A, B, C, D are polynomials of every input, state and parameter, of degree 3 at
most, for which the five-point difference has no error but rounding.
"""

import fmu_oracle as oracle
import numpy as np
import pytest
from fmu_driver import OK, Fmu
from fmu_helpers import ROOT, export, stale
from fmu_networks import CHANGES, changed, gearbox
from fmu_piecewise import in_entries
from fmu_tangent import LEVELS, Tangent

import gearpath as gp

MATRICES = ("system.A", "system.B", "system.C", "system.D")


def moving():
    """Where the mesh moves the bearings directly, so that all couplings are there."""
    return gearbox(4, mesh_moves_bearings=True)


@pytest.fixture(scope="module")
def networks(tmp_path_factory):
    if stale():
        pytest.fail(stale(), pytrace=False)
    folder = tmp_path_factory.mktemp("derivatives")
    cases = {"error": moving(), "force": gearbox(5, excitation="mesh.force")}
    return {
        (name, version): Fmu.unpack(
            export(network, folder / f"{name}{version}.fmu", fmi=f"{version}.0"), folder / f"{name}{version}"
        )
        for name, network in cases.items()
        for version in (2, 3)
    }


EITHER = pytest.mark.parametrize(
    ("version", "exchange"), [(2, False), (2, True), (3, False), (3, True)], ids=["cs2", "me2", "cs3", "me3"]
)


def rows_agree(found, wanted, tolerance=1e-12):
    """To the largest entry of each row."""
    assert (np.abs(found - wanted) <= tolerance * np.abs(wanted).max(axis=1, keepdims=True)).all()


@EITHER
def test_state_equations_are_assembled_from_derivatives(networks, version, exchange):
    """While initialising, between steps or in continuous time, and after joints and damping were changed."""
    it = Tangent(networks["error", version], exchange=exchange)
    linear = [n for n in it.over_time if not n.endswith((".power", ".force", ".velocity"))]

    def agree(network):
        A, B, C, D, names = oracle.scaled_time_system(network)
        assert sorted(linear) == sorted(names)
        rows_agree(it.jacobian(it.derivatives, it.states[:54]), A)
        rows_agree(it.jacobian(it.derivatives, list(LEVELS)), B)
        rows_agree(it.jacobian(names, it.states[:54]), C)
        rows_agree(it.jacobian(names, list(LEVELS)), D)

    it.moved()
    it.fmu.enter("initialization")
    agree(moving())
    it.fmu.free()
    it = Tangent(networks["error", version], exchange=exchange)
    it.moved()
    it.fmu.enter("event" if exchange else "stepping")
    if not exchange:
        assert it.fmu.step(0.0, 1e-5) == OK
    agree(moving())
    assert it.fmu.set(in_entries(CHANGES, version)) == OK
    agree(changed(moving()))
    if exchange:
        assert it.fmu.call(f"fmi{version}EnterContinuousTimeMode") == OK
    else:
        assert it.fmu.step(1e-5, 1e-5) == OK
    agree(changed(moving()))
    it.fmu.free()


@pytest.mark.parametrize("name", ["gearbox", "helical_gearbox"])
@pytest.mark.parametrize("version", [2, 3])
def test_state_equations_of_models(name, version, tmp_path):
    """As `gp.state_space` has them; the gear mesh source, where there is one, adds a state and an input."""
    model = gp.load(ROOT / "models" / f"{name}.toml")
    path = gp.export_fmu(model, tmp_path / "it.fmu", fmi=f"{version}.0")
    it, space = Tangent(Fmu.unpack(path, tmp_path / "it"), exchange=True), gp.state_space(model)
    it.moved()
    it.fmu.enter("event")
    inputs, outputs = ([x.replace("/", ".") for x in labels] for labels in (space.input_labels, space.output_labels))
    n = space.nstates
    matrix, feed = it.jacobian(it.derivatives, it.states), it.jacobian(it.derivatives, inputs)
    rows_agree(matrix[:n, :n], space.A)
    rows_agree(feed[:n], space.B)
    assert (matrix[n:] == 0).all()
    assert (feed[n:] == 0).all()
    rows_agree(it.jacobian(outputs, it.states)[:, :n], space.C)
    rows_agree(it.jacobian(outputs, inputs), space.D)
    it.fmu.free()


@EITHER
def test_powers_by_states_and_inputs(networks, version, exchange):
    """The only outputs over time that are not linear; squares, for which wide differences are exact."""
    it = Tangent(networks["error", version], exchange=exchange)
    it.moved()
    it.fmu.enter("initialization")
    powers = [n for n in it.over_time if n.endswith(".power")]
    size = np.abs(it.fmu.get(powers)).max()
    assert size > 0
    for known in [*it.states, *it.inputs]:
        width = np.abs(it.fmu.get([known])).max()
        for direction in it.directions(known):
            found = it.along(powers, [known], direction) * width
            wanted = it.difference(powers, known, direction, width) * width
            assert np.abs(found - wanted).max() <= 1e-12 * max(size, np.abs(wanted).max()), known
    it.fmu.free()


def check_parameters(it, unknowns, step, tolerance):
    """All parameters, in all directions, to a part of the largest derivative of a kind; counts what is not zero."""
    kinds, values, moved = it.kinds(unknowns), np.abs(it.fmu.get(unknowns)), 0
    for name in it.parameters:
        for direction in it.directions(name):
            width = it.size_of(name, direction)
            found = it.along(unknowns, [name], direction) * width
            wanted = it.difference(unknowns, name, direction, step * width) * width
            for kind in np.unique(kinds):
                of = kinds == kind
                size = tolerance * np.abs(wanted[of]).max() + 1e-14 * values[of].max() / step
                assert np.abs(found[of] - wanted[of]).max() <= size, (name, kind)
            moved += np.count_nonzero(found)
    return moved


@EITHER
def test_outputs_over_time_by_parameters(networks, version, exchange):
    """In initialisation mode, with the states held: every output, derivative and (FMI 3) entry of A, B, C, D."""
    it = Tangent(networks["error", version], exchange=exchange)
    it.moved()
    it.fmu.enter("initialization")
    unknowns = [*it.over_time, *it.derivatives, *(MATRICES if version == 3 else ())]
    assert check_parameters(it, unknowns, 0.05, 1e-9) > len(it.parameters)
    it.fmu.free()


@pytest.mark.parametrize("case", ["error", "force"])
@EITHER
def test_outputs_over_frequency_by_parameters(networks, case, version, exchange):
    it = Tangent(networks[case, version], exchange=exchange)
    it.fmu.enter("initialization")
    assert check_parameters(it, it.over_frequency, 1e-3, 1e-7) > len(it.parameters)
    it.fmu.free()


@pytest.mark.parametrize("case", ["error", "force"])
@EITHER
def test_outputs_over_frequency_by_frequency(networks, case, version, exchange):
    """Also after a change of joints; nothing else depends on it."""
    it = Tangent(networks[case, version], exchange=exchange)
    it.fmu.enter("event" if exchange else "stepping")
    kinds = it.kinds(it.over_frequency)
    for values in ({}, CHANGES):
        assert it.fmu.set(in_entries(values, version)) == OK
        for hertz in (45.0, 400.0, 3000.0):
            it.set("frequency", np.array(hertz))
            found = it.along(it.over_frequency, ["frequency"], 1.0)
            wide, narrow = (it.difference(it.over_frequency, "frequency", 1.0, k * hertz) for k in (6e-4, 3e-4))
            wanted = (16 * narrow - wide) / 15  # of order 6, for resonances are narrow
            values = np.abs(it.fmu.get(it.over_frequency))
            for kind in np.unique(kinds):
                of = kinds == kind
                size = 1e-6 * np.abs(wanted[of]).max() + 1e-9 * values[of].max() / hertz
                assert np.abs(found[of] - wanted[of]).max() <= size, (hertz, kind)
        assert (it.along([*it.over_time, *it.derivatives], ["frequency"], 1.0) == 0).all()
        assert (it.along(it.over_frequency, it.inputs, np.ones(len(it.inputs))) == 0).all()
    it.fmu.free()


@EITHER
def test_frequencies_at_and_below_zero(networks, version, exchange):
    """Importers ground unconnected inputs, and probe around 0: no response at 0, by its magnitude below."""
    it = Tangent(networks["error", version], exchange=exchange)
    it.fmu.enter("event" if exchange else "stepping")
    names, damping = it.over_frequency, "gear_train.modal_damping"
    it.set("frequency", np.array(500.0))
    at_500, slope = it.fmu.get(names), it.along(names, ["frequency"], [1.0])
    assert np.all(at_500 != 0)
    it.set("frequency", np.array(0.0))
    assert not it.fmu.get(names).any()
    assert not it.along(names, ["frequency", damping], [1.0, 1.0]).any()
    it.set("frequency", np.array(1e-8))
    assert np.isfinite(it.fmu.get(names)).all()
    it.set("frequency", np.array(-500.0))
    assert it.fmu.get(names).tolist() == at_500.tolist()
    assert it.along(names, ["frequency"], [-1.0]).tolist() == slope.tolist()
    assert it.fmu.get(["frequency"]).tolist() == [-500.0]
    it.fmu.free()


def test_one_entry_of_a_matrix(networks):
    """Without its mirror, which no value can show: g_1 = K_12 u_2 moves, g_2 does not, and both add up."""
    it = Tangent(networks["error", 3], exchange=True)
    it.moved()
    it.fmu.enter("initialization")
    port, name = ["bearing_2.force"], ["bearing_2.stiffness"]
    upper, lower = (it.along(port, name, [[0, a], [1 - a, 0]]) for a in (1, 0))
    slip = it.along(port, name, [[1, 0], [0, 0]])[0], it.along(port, name, [[0, 0], [0, 1]])[1]
    assert upper == pytest.approx([slip[1], 0.0], rel=1e-13)
    assert lower == pytest.approx([0.0, slip[0]], rel=1e-13)
    assert min(map(abs, slip)) > 0
    everything = [*it.over_time, *it.derivatives, *MATRICES]
    both = sum(it.along(everything, name, [[0, a], [1 - a, 0]]) for a in (1, 0))
    found = it.along(everything, name, [[0, 1], [1, 0]])
    assert found == pytest.approx(both, rel=1e-10, abs=1e-12 * np.abs(found).max())
    it.fmu.free()


@pytest.mark.parametrize("exchange", [False, True], ids=["cs", "me"])
def test_adjoint_is_the_transpose(networks, exchange):
    """Of all outputs, derivatives and matrices by all inputs, states and parameters; before and after a change."""
    it = Tangent(networks["error", 3], exchange=exchange)
    it.moved()
    it.fmu.enter("initialization")
    rng = np.random.default_rng(2)

    def transpose(unknowns, knowns):
        J = it.jacobian(unknowns, knowns)
        for weights in (rng.normal(size=len(J)), np.eye(len(J))[rng.integers(len(J))]):
            found = it.adjoint(unknowns, knowns, weights)
            assert (np.abs(found - weights @ J) <= 1e-12 * (np.abs(weights) @ np.abs(J))).all()
            assert np.count_nonzero(found) == np.count_nonzero(weights @ J)

    knowns = [*it.inputs, "frequency", *it.states, *it.parameters]
    unknowns = [*it.outputs, *it.derivatives, *MATRICES]
    transpose(list(rng.permutation(unknowns)), list(rng.permutation(knowns)))
    assert it.fmu.call("fmi3ExitInitializationMode") == OK
    assert it.fmu.set(CHANGES) == OK
    transpose([*it.over_time, *it.derivatives], [*it.inputs, *it.states])
    it.fmu.free()


@pytest.mark.parametrize("version", [2, 3])
def test_derivatives_change_nothing(networks, version):
    """A run with and without derivatives in between ends in the same state, bit by bit."""
    ends = []
    for asked in (False, True):
        it = Tangent(networks["error", version], exchange=False)
        it.fmu.enter("stepping")
        for i in range(12):
            it.set("mesh.transmission_error", np.array(1e-6 * np.sin(i)))
            if i == 6:
                assert it.fmu.set(in_entries(CHANGES, version)) == OK
            if asked:
                it.jacobian(it.outputs, it.inputs)
                it.along([*it.outputs, *it.derivatives], it.parameters, np.ones(it.size(it.parameters)))
            assert it.fmu.step(i * 1e-5, 1e-5) == OK
        ends.append(it.fmu.serialised())
        it.fmu.free()
    assert ends[0] == ends[1]
