"""Measured components: a structure's own mobilities, sampled by another method, must take its place exactly."""

from dataclasses import replace

import numpy as np
import pytest
from systems import BEARING, default_gearbox, scaled

from gearpath.components import DOFS, Footprint, Measured, Plate
from gearpath.components.dofs import rigid_motion
from gearpath.components.mobility import mobility_direct
from gearpath.errors import InputError
from gearpath.joints import Joint, Mounting, Port
from gearpath.joints.bearings import catalogue_bearing
from gearpath.network.assemble import assemble
from gearpath.network.excitations import power_matrices
from gearpath.network.measured import fit_of, fitted_system
from gearpath.network.natural import natural_frequencies
from gearpath.network.operation import operating_point
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.response import frequency_response
from gearpath.network.system import Actuator, MeshExcitation, Operation, PointExcitation, Sensor, System
from gearpath.network.time_twin import time_twin
from gearpath.results.labelled import checked_frequencies

LINES = 2 * np.pi * np.linspace(20.0, 3000.0, 400)


def casing_mobility(body, places, omega):
    """Y of a free rigid body at (place, dof) rows, T M^-1 T^T / (i w), in closed form."""
    centre = body.centre_of_gravity
    rows = np.array([rigid_motion(np.subtract(place, centre))[DOFS.index(dof)] for place, dof in places])
    tensor = np.zeros((3, 3))
    for key, value in body.inertia.items():
        tensor["xyz".index(key[0]), "xyz".index(key[1])] = tensor["xyz".index(key[1]), "xyz".index(key[0])] = value
    inverse = np.zeros((6, 6))
    inverse[:3, :3], inverse[3:, 3:] = np.eye(3) / body.mass, np.linalg.inv(tensor)
    return rows @ inverse @ rows.T / (1j * omega)[:, None, None]


def with_measured_casing(system, omega):
    """The gearbox whose rigid casing is known by its mobilities at bearings and mounts alone."""
    channels, ports, joints = [], {}, {}
    for name, joint in system.joints.items():
        first, second = joint.between
        place = joint.at
        if place is None:
            place = system.components["gear_train"].shafts[first.shaft].position(first.z)
        ports[name] = {dof: len(channels) + k for k, dof in enumerate(joint.dofs)}
        channels += [(place, dof) for dof in joint.dofs]
        port = Port("casing", place=name)
        ends = (first, port) if second.component == "casing" else (port, second)
        joints[name] = replace(joint, between=ends)
    casing = Measured(omega, casing_mobility(system.components["casing"], channels, omega), ports)
    return replace(system, components={**system.components, "casing": casing}, joints=joints)


def network_of(system):
    return assemble(system).modal()


def assert_same_flow(found, wanted, tolerance):
    for part in ("force", "velocity_source", "velocity_receiver", "path_power", "dissipated_power", "input_power"):
        a, b = getattr(found, part), getattr(wanted, part)
        assert np.max(abs(a - b).max(axis=-1)) <= tolerance * np.max(abs(b)), part
    np.testing.assert_allclose(found.share(), wanted.share(), atol=tolerance)


def test_the_sampled_casing_has_the_power_flow_of_the_casing():
    system = default_gearbox()
    measured = network_of(with_measured_casing(system, LINES))
    assert_same_flow(power_flow(measured, LINES), power_flow(network_of(system), LINES), 1e-9)


def test_chunks_and_lines_in_any_order():
    """Lines are looked up, not counted: a sweep of some of the measured lines, backwards."""
    system = default_gearbox()
    some = LINES[300:20:-7]
    found = power_flow(network_of(with_measured_casing(system, LINES)), some)
    assert_same_flow(found, power_flow(network_of(system), some), 1e-9)


def test_an_undamped_resonance_of_the_gear_train_on_a_line():
    """The line is solved without eliminating the components; there the rows are multiplied by Y."""
    system = default_gearbox()
    train = replace(system.components["gear_train"], modal_damping=0.0)
    system = replace(system, components={**system.components, "gear_train": train})
    modal = network_of(system)
    own = np.sqrt(modal.eigenvalues[modal.components["gear_train"]])
    lines = np.sort(np.concatenate([LINES, own[(own > LINES[0]) & (own < LINES[-1])]]))
    assert len(lines) > len(LINES)
    found = power_flow(network_of(with_measured_casing(system, lines)), lines)
    assert_same_flow(found, power_flow(modal, lines), 1e-7)


def plate_machine(omega=None):
    """A driven rigid block on a damped plate on mounts; with `omega` the plate is known by its sampled mobilities."""
    steel = default_gearbox().components["gear_train"].shafts["input"].material
    spots = {"seat": (0.05, 0.02, 0.0), "left": (-0.2, -0.1, 0.0), "right": (0.22, -0.12, 0.0), "far": (0.0, 0.15, 0.0)}
    plate = Plate(
        steel, (0.0, 0.0, 0.0), (0.5, 0.4), 0.008, (8, 6),
        footprints={name: Footprint(at) for name, at in spots.items()}, loss_factor=0.02,
    )  # fmt: skip
    dofs = ("uz",)
    K, stiff = np.array([[3e6]]), np.array([[2e5]])
    joints = {
        "bearing": Joint("bearing", (Port("block"), Port("plate", place="seat")), dofs, scaled(K, 1.0), scaled(K, 1e-5))
    }
    for name in ("left", "right", "far"):
        ends = (Port("plate", place=name), Port("ground"))
        joints[name] = Joint("mount", ends, dofs, scaled(stiff, 1.0), scaled(stiff, 1e-4))
    block = replace(default_gearbox().components["casing"], mass=2.0)
    system = System(
        "plate_machine", dofs, {"block": block, "plate": plate}, joints, PointExcitation(Port("block"), "uz"),
        actuators={"shaker": Actuator(Port("plate", place="far"), "uz")},
        sensors={"probe": Sensor(Port("plate", place="right"), "uz", "acceleration")}, band=800.0,
    )  # fmt: skip
    if omega is None:
        return system
    structure = plate.structure(dofs, {name: name for name in spots})
    rows = np.vstack([structure.ports[name][[2]] for name in spots])
    ports = {name: {"uz": k} for k, name in enumerate(spots)}
    measured = Measured(omega, mobility_direct(structure, rows, omega), ports, spots)
    return replace(system, components={"block": block, "plate": measured})


PLATE_LINES = 2 * np.pi * np.linspace(20.0, 800.0, 261)


@pytest.fixture(scope="module")
def plate_networks():
    return network_of(plate_machine(PLATE_LINES)), network_of(plate_machine())


def test_the_sampled_plate_has_the_power_flow_of_the_plate(plate_networks):
    """Sampled by direct solves of the whole mesh; the plate itself is reduced to 1e-6 of its interface mobility."""
    found, wanted = (power_flow(network, PLATE_LINES) for network in plate_networks)
    assert_same_flow(found, wanted, 1e-5)


def test_power_balance_of_a_measured_component(plate_networks):
    """What enters is lost: 1/2 Re(f^H v) into the channels counts all that the plate takes, between lines too."""
    measured, _ = plate_networks
    between = 2 * np.pi * np.random.default_rng(0).uniform(20.0, 800.0, 200)
    flow = power_flow(measured, between)
    np.testing.assert_allclose(flow.dissipated_power.sum(axis=0), flow.input_power, rtol=1e-9)
    assert np.all(flow.dissipated_power >= -1e-12 * flow.input_power)
    assert flow.dissipated_power[list(flow.elements).index("plate")].max() > 0.1 * flow.input_power.max()


def test_forces_on_and_motion_of_a_measured_component(plate_networks):
    measured, exact = plate_networks
    found, wanted = (
        frequency_response(n, PLATE_LINES, [o for o in n.outputs if o.name == "sensors.probe"], n.loads)
        for n in plate_networks
    )
    assert [load.name for load in measured.loads] == [load.name for load in exact.loads]
    assert np.all(abs(found - wanted).max(axis=0) < 1e-4 * abs(wanted).max(axis=0))


def test_power_matrices_balance(plate_networks):
    measured, exact = plate_networks
    found, wanted = (power_matrices(network, PLATE_LINES, network.loads) for network in (measured, exact))
    size = abs(wanted.input).max()
    assert abs(found.dissipated.sum(axis=0) - found.input).max() < 1e-9 * size
    plate = list(wanted.elements).index("plate")
    assert abs(found.dissipated[plate] - wanted.dissipated[plate]).max() < 1e-4 * size


def test_the_time_twin_is_that_of_the_fit(plate_networks):
    """Power flow through the fit deviates no more than the fit; its time twin agrees with its frequency twin."""
    measured, exact = plate_networks
    fit = fit_of(measured.measured["plate"])
    assert fit.passive
    assert fit.worst.value <= 1e-2
    viscous = measured.viscous()
    assert len(viscous.eigenvalues) == len(measured.eigenvalues) - 4 + fit.order
    twin = time_twin(measured)
    lines = PLATE_LINES[::20]
    time = np.array([twin.C @ np.linalg.solve(1j * w * np.eye(len(twin.A)) - twin.A, twin.B) + twin.D for w in lines])
    through_fit = frequency_response(viscous, PLATE_LINES, twin.outputs, twin.loads)
    scale = abs(through_fit).max(axis=0)
    assert np.all(abs(time - through_fit[::20]).max(axis=0) < 1e-8 * scale)
    outputs = [next(o for o in measured.outputs if o.name == each.name) for each in twin.outputs]
    wanted = frequency_response(measured, PLATE_LINES, outputs, measured.loads)
    # a resonance of the whole machine multiplies the fit's deviation, here by 1 / eta = 50
    assert np.all(abs(through_fit - wanted).max(axis=0) < 50 * fit.worst.value * abs(wanted).max(axis=0))
    poles = np.linalg.eigvals(twin.A)  # the block turns freely about its one joint
    assert poles.real.max() < 1e-9 * abs(poles).max()
    found = power_flow(viscous, PLATE_LINES)
    np.testing.assert_allclose(found.dissipated_power.sum(axis=0), found.input_power, rtol=1e-7)
    assert_same_flow(found, power_flow(exact, PLATE_LINES), 50 * fit.worst.value)


def test_natural_frequencies_are_those_of_the_fit():
    system = default_gearbox()
    exact = natural_frequencies(network_of(system))
    found = natural_frequencies(network_of(with_measured_casing(system, LINES)))
    np.testing.assert_allclose(found[:6], exact[:6], rtol=1e-3)


def test_off_the_band_nothing_is_known(plate_networks):
    with pytest.raises(InputError, match=r"10 Hz is outside 20 to 800 Hz, where plate was measured"):
        checked_frequencies([100.0, 10.0], plate_networks[0])
    with pytest.raises(InputError, match=r"801 Hz is outside 20 to 800 Hz"):
        power_flow(plate_networks[0], 2 * np.pi * np.array([801.0]))
    assert len(checked_frequencies([20.0, 800.0], plate_networks[0])) == 2


def test_another_bearing_does_not_touch_the_components():
    """The same content is the same component: solved and fitted once."""
    first, second = (with_measured_casing(default_gearbox(scaled(BEARING, k)), LINES) for k in (1.0, 2.0))
    assert first.components["casing"] == second.components["casing"]
    assert fit_of(first.components["casing"]) is fit_of(second.components["casing"])
    assert isinstance(first.excitation, MeshExcitation)


def test_the_system_of_the_fit_is_the_network_of_the_fit():
    """Two ways into modal coordinates: of the network, and of the system with modes in place of the component."""
    system = with_measured_casing(default_gearbox(), LINES)
    one, other = network_of(system).viscous(), network_of(fitted_system(system)).viscous()
    np.testing.assert_allclose(other.eigenvalues, one.eigenvalues, rtol=1e-12)
    np.testing.assert_allclose(other.damping, one.damping, rtol=1e-12)
    np.testing.assert_allclose(other.relative, one.relative, atol=1e-12 * abs(one.relative).max())
    assert list(other.modal_damping) == list(one.modal_damping)
    reference = reference_solution(assemble(fitted_system(system)), LINES[::40])
    np.testing.assert_allclose(power_flow(one, LINES[::40]).share(), reference.alpha, rtol=1e-8)


def test_the_unsynthesised_solution_takes_the_mobilities():
    """All coordinates at once, no interface eliminated: a transmission error in gears, a force on a block."""
    system = with_measured_casing(default_gearbox(), LINES)
    shaken = replace(plate_machine(PLATE_LINES), excitation=PointExcitation(Port("plate", place="far"), "uz"))
    for machine, lines in ((system, LINES[::100]), (shaken, PLATE_LINES[::10])):
        found, wanted = power_flow(network_of(machine), lines), reference_solution(assemble(machine), lines)
        forces = wanted.force[: len(found.force)]  # of the paths
        np.testing.assert_allclose(found.force, forces, rtol=0, atol=1e-9 * abs(forces).max())
        np.testing.assert_allclose(found.input_power, wanted.input_power, rtol=1e-8)
        np.testing.assert_allclose(found.share(), wanted.alpha, rtol=1e-8)


def test_the_mean_load_goes_through_the_fit():
    """Statics of a machine on a measured casing: bearing loads balance the tooth force as with the casing itself."""
    bearing = catalogue_bearing("6206-like")
    exact = default_gearbox()
    loads = []
    for system in (exact, with_measured_casing(exact, LINES)):
        joints = {
            name: replace(joint, mounting=Mounting(bearing)) if joint.kind == "bearing" else joint
            for name, joint in system.joints.items()
        }
        system = replace(system, joints=joints, operation=Operation("gear_train", 50.0))
        loads.append(np.array([state.load for state in operating_point(system).values()]))
    np.testing.assert_allclose(loads[1], loads[0], atol=2e-3 * abs(loads[0]).max())


def test_the_state_space_has_the_states_of_the_fit():
    """Three rigid motions stand for twelve channels."""
    control = pytest.importorskip("control")
    from gearpath.statespace import state_space

    network = network_of(with_measured_casing(default_gearbox(), LINES))
    plant = state_space(network)
    assert isinstance(plant, control.StateSpace)
    assert plant.nstates == 2 * len(network.viscous().eigenvalues)
    assert plant.nstates < 2 * len(network.eigenvalues)
