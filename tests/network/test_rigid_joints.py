"""Rigid joints against one-piece bodies, closed forms, the limit of stiff joints, and their refusals."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from rigid_machines import beam, gearbox_on_beam, ground, machine, on, rigid, spatial_gearbox, spring
from systems import STEEL

from gearpath.components import Frame, Matrices, Measured, ModalModel, RigidBody
from gearpath.components.cross_section import BarSection
from gearpath.components.frame_beam import FrameBeam
from gearpath.errors import InputError
from gearpath.joints import Port
from gearpath.network.assemble import assemble
from gearpath.network.contained import self_contained
from gearpath.network.natural import natural_frequencies
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.response import frequency_response
from gearpath.network.synthesis import Synthesis
from gearpath.network.system import Sensor
from gearpath.network.time_twin import time_twin

LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 25)
FREE = spring(on("a", 0.0), ground(), 0.0)  # no stiffness: the machine floats


def bars(zeta=0.0, joint=()):
    """Bars of 0.3 and 0.2 m, welded."""
    weld = rigid(on("a", 0.3), on("b", 0.0), None, joint)
    parts = {"a": beam(0.3, zeta=zeta), "b": beam(0.2, z=0.3, zeta=zeta)}
    return machine(parts, {"free": FREE, "weld": weld}, on("a", 0.1))


def one_bar(zeta=0.0):
    return machine({"a": beam(0.3, 0.2, zeta=zeta)}, {"free": FREE}, on("a", 0.1))


def mobility(system):
    """Velocity of the driven point."""
    modal = assemble(system).modal()
    load = modal.loads[-1]
    return load.column @ Synthesis(modal, [load]).solve(LINES).velocity[:, 0]


def test_two_bars_welded_are_one_longer_bar():
    joined, whole = (assemble(system).modal() for system in (bars(), one_bar()))
    assert list(joined.components) == ["a+b"]
    assert (joined.eigenvalues[:6] == 0.0).all()
    np.testing.assert_allclose(joined.eigenvalues[6:], whole.eigenvalues[6:], rtol=1e-11)
    np.testing.assert_allclose(mobility(bars()), mobility(one_bar()), rtol=1e-9)


def test_bars_of_one_damping_ratio_are_one_bar_of_that_ratio():
    np.testing.assert_allclose(mobility(bars(0.02)), mobility(one_bar(0.02)), rtol=1e-9)


def test_a_mode_takes_of_each_ratio_the_part_of_the_strain_energy():
    """Two equal bars end to end: by symmetry half of each, so 0.01 and 0.03 make 0.02 in every mode."""
    parts = {"a": beam(0.3, zeta=0.01), "b": beam(0.3, z=0.3, zeta=0.03)}
    system = machine(parts, {"free": FREE, "weld": rigid(on("a", 0.3), on("b", 0.0))}, on("a", 0.1))
    modal = assemble(system).modal()
    elastic = modal.eigenvalues > 0.0
    np.testing.assert_allclose(modal.damping[elastic] / (2.0 * np.sqrt(modal.eigenvalues[elastic])), 0.02, rtol=1e-7)
    assert (modal.damping[~elastic] == 0.0).all()


def test_between_stiff_joints_parts_of_one_ratio_damp_less():
    """Their free modes damp no rigid motion of a part: sum_k sqrt(L_k) T_k^2 < sqrt(mu) (docs/model_file.md)."""
    stiff = spring(on("a", 0.3), on("b", 0.0), [1e12] * 3 + [1e10] * 3)
    found = []
    for system in (bars(0.01), replace(bars(0.01), joints={"free": FREE, "weld": stiff})):
        poles = np.linalg.eigvals(time_twin(assemble(system).modal(), outputs=()).A)
        poles = poles[poles.imag > 100.0]
        found.append((-poles.real / abs(poles))[np.argsort(abs(poles))][[0, 2, 4]])  # bending, in one plane
    np.testing.assert_allclose(found[0], 0.01, rtol=1e-6)
    np.testing.assert_allclose(found[1], [0.00203, 0.00644, 0.00815], atol=1e-5)


def chain(springs, zeta):
    """Unit masses between springs in y, which nothing holds."""
    steps = np.diff(np.eye(len(springs) + 1), axis=0)
    K, ports = steps.T @ np.diag(springs) @ steps, {"first": {"uy": 0}, "last": {"uy": len(springs)}}
    return Matrices(np.eye(len(K)), K, np.ones((len(K), 1)), ports, {}, zeta)


def test_one_ratio_is_composite_in_whatever_form_a_structure_comes():
    parts = {"a": chain([1e7, 3e7, 2e7], 0.01), "b": chain([5e7, 4e6], 0.03)}
    foot = spring(Port("b", place="last"), ground(), [1e6], ("uy",))
    weld = rigid(Port("a", place="last"), Port("b", place="first"))
    system = machine(parts, {"foot": foot, "weld": weld}, Port("a", place="first"), dofs=("uy",))
    contained = self_contained(system)
    assert all(isinstance(part, ModalModel) for part in contained.components.values())
    given, modes = (power_flow(assemble(item).modal(), LINES) for item in (system, contained))
    np.testing.assert_allclose(modes.input_power, given.input_power, rtol=1e-9)
    np.testing.assert_allclose(reference_solution(assemble(contained), LINES).input_power, given.input_power, rtol=1e-7)
    first = contained.components["a"]
    uneven = replace(first, damping_ratios=(*first.damping_ratios[:-1], 0.0101))  # each its own: a matrix
    off = power_flow(assemble(replace(contained, components={"a": uneven, "b": parts["b"]})).modal(), LINES)
    assert abs(off.input_power / given.input_power - 1.0).max() > 0.1


def test_two_bodies_welded_are_one_body():
    """Masses add, inertias add about the common centre of gravity (parallel axes)."""
    one = RigidBody(3.0, {"xx": 0.02, "yy": 0.03, "zz": 0.04, "xy": 0.005}, (0.1, -0.2, 0.05))
    two = RigidBody(5.0, {"xx": 0.05, "yy": 0.06, "zz": 0.03, "yz": -0.01}, (-0.3, 0.1, 0.2))
    parts = {"one": one, "two": two}
    centre = sum(body.mass * np.array(body.centre_of_gravity) for body in parts.values()) / 8.0
    J = np.zeros((3, 3))
    for body in parts.values():
        r = np.array(body.centre_of_gravity) - centre
        J += body.inertia_matrix()[3:, 3:] + body.mass * (r @ r * np.eye(3) - np.outer(r, r))
    inertia = {"xyz"[i] + "xyz"[k]: float(J[i, k]) for i in range(3) for k in range(i, 3)}
    whole = {"one": RigidBody(8.0, inertia, tuple(centre.tolist()))}
    place = (0.4, 0.3, -0.2)
    free = {"free": spring(Port("one"), ground(), 0.0, at=place)}
    weld = {"weld": rigid(Port("one"), Port("two"), (0.0, 0.0, 0.0))}
    found, expected = (
        assemble(machine(bodies, joints, Port("one"))).modal().joints[0].source
        for bodies, joints in ((parts, free | weld), (whole, free))
    )
    assert found.shape == (6, 6)
    np.testing.assert_allclose(found @ found.T, expected @ expected.T, rtol=1e-12, atol=1e-12)


def test_a_bar_welded_to_the_ground_is_clamped():
    """Euler-Bernoulli cantilever: cos(x) cosh(x) = -1."""
    held = {"wall": rigid(on("a", 0.0), ground()), "free": spring(on("a", 0.5), ground(), 0.0)}
    system = machine({"a": beam(0.5, beam="euler", elements=(32,))}, held, on("a", 0.5))
    d, E, rho = 0.03, STEEL.youngs_modulus, STEEL.density
    stiffness = np.sqrt(E * np.pi * d**4 / 64 / (rho * np.pi * d**2 / 4))
    bending = np.array([1.8751040687, 4.6940911330, 7.8547574382]) ** 2 / 0.5**2 * stiffness / (2 * np.pi)
    found = natural_frequencies(assemble(system).modal())
    for expected in bending:  # in either plane
        assert (abs(found / expected - 1.0) < 5e-6).sum() == 2


def test_a_pinned_body_swings_about_its_pin():
    body = RigidBody(4.0, {"xx": 0.03, "yy": 0.05, "zz": 0.06}, (0.0, 0.0, 0.2))
    pin = rigid(Port("body"), ground(), (0.0, 0.0, 0.0), ("ux", "uy", "uz", "ry", "rz"))
    held = {"pin": pin, "spring": spring(Port("body"), ground(), 5e5, ("uy",), (0.0, 0.0, 0.5))}
    found = natural_frequencies(assemble(machine({"body": body}, held, Port("body"))).modal())
    np.testing.assert_allclose(found, np.sqrt(5e5 * 0.5**2 / (0.03 + 4.0 * 0.2**2)) / (2 * np.pi), rtol=1e-13)
    assert len(found) == 1


def test_stiff_joints_tend_to_the_rigid_joint():
    """The deviation of the natural frequencies falls like 1/k."""
    limit, deviations = natural_frequencies(assemble(gearbox_on_beam()).modal()), []
    for k in (1e11, 1e12, 1e13):
        system = gearbox_on_beam()
        stiff = {
            name: spring(*joint.between, [k, 1e-2 * k], ("uy", "rx"))
            for name, joint in system.joints.items()
            if joint.kind == "rigid"
        }
        found = natural_frequencies(assemble(replace(system, joints={**system.joints, **stiff})).modal())
        deviations.append(abs(found[1:12] / limit[1:12] - 1.0).max())  # without the rolling gears, at 0 Hz
    assert deviations[0] < 1e-2
    np.testing.assert_allclose(np.divide(deviations[:-1], deviations[1:]), 10.0, rtol=0.05)


def test_joints_that_repeat_others_change_nothing():
    bodies = {"one": RigidBody(3.0, {"xx": 0.02, "yy": 0.03, "zz": 0.04}), "a": beam(0.3)}
    weld = {"weld": rigid(on("a", 0.1), Port("one")), "free": FREE}
    once = assemble(machine(bodies, weld, on("a", 0.1))).modal()
    again = {**weld, "back": rigid(Port("one"), on("a", 0.1)), "part": rigid(on("a", 0.1), Port("one"), None, ("rx",))}
    more = assemble(machine(bodies, again, on("a", 0.1))).modal()
    np.testing.assert_allclose(more.eigenvalues, once.eigenvalues, rtol=1e-9)


def frame_bars(factors, *, whole=False):
    section = BarSection.round(0.02)
    nodes = {"low": (0.0, 0.0, 0.0), "middle": (0.0, 0.0, 0.3), "high": (0.0, 0.1, 0.6)}

    def bar(*ends):
        return FrameBeam(ends, STEEL, section, 0.9, 3)

    def frame(names, factor):
        beams = {f"{a}_{b}": bar(a, b) for a, b in pairwise(names)}
        return Frame({name: nodes[name] for name in names}, beams, loss_factor=factor)

    low = spring(Port("one", place="low"), ground(), 1e6, time=1e-5)
    if whole:
        return machine({"one": frame(list(nodes), factors[0])}, {"foot": low}, Port("one", place="middle"))
    parts = {"one": frame(["low", "middle"], factors[0]), "two": frame(["middle", "high"], factors[1])}
    weld = rigid(Port("one", place="middle"), Port("two", place="middle"))
    return machine(parts, {"foot": low, "weld": weld}, Port("one", place="middle"))


def test_frames_of_one_loss_factor_are_one_frame():
    joined, whole = (assemble(frame_bars((0.05, 0.05), whole=one)) for one in (False, True))
    outputs = [frequency_response(n.modal(), LINES, n.modal().outputs[:6], n.modal().loads) for n in (joined, whole)]
    np.testing.assert_allclose(outputs[0], outputs[1], rtol=1e-6, atol=1e-6 * abs(outputs[1]).max())
    direct = [reference_solution(network, LINES).force for network in (joined, whole)]
    np.testing.assert_allclose(direct[0], direct[1], rtol=1e-9, atol=1e-9 * abs(direct[1]).max())


def test_what_cannot_be_joined_is_refused():
    with pytest.raises(InputError, match=r"^joints.wall: rigid joints leave body no way to move; connect its neigh"):
        assemble(
            machine(
                {"body": RigidBody(1.0, {"xx": 1.0, "yy": 1.0, "zz": 1.0})},
                {"wall": rigid(Port("body"), ground()), "foot": spring(Port("body"), ground(), 1.0)},
                Port("body"),
            )
        ).modal()
    one = RigidBody(1.0, {"xx": 1.0, "yy": 1.0, "zz": 1.0})
    known = Measured(np.array([1.0, 1e5]), np.ones((2, 1, 1), complex), {"p": {"uy": 0}})
    parts = {"one": one, "known": known}
    joints = {"weld": rigid(Port("one"), Port("known", place="p")), "foot": spring(Port("one"), ground(), 1.0)}
    with pytest.raises(InputError, match=r"^joints.weld: known was measured, .* cannot be held rigidly; give a stiff"):
        assemble(machine(parts, joints, Port("one"))).modal()
    joints["weld"] = replace(joints["weld"], dofs=("uy", "rx"))
    with pytest.raises(InputError, match=r"^joints.weld.dofs: rx is no motion of both ends; name some of: uy$"):
        assemble(machine(parts, joints, Port("one")))


def test_an_acceleration_beside_a_mesh_is_left_out_or_refused():
    system = spatial_gearbox(weld=rigid(Port("gear_train", "output", 0.0), Port("casing")))
    names = [output.name for output in assemble(system).modal().outputs]
    assert "casing.velocity_uy" in names
    assert "casing.acceleration_uy" not in names
    asked = replace(system, sensors={"top": Sensor(Port("casing"), "uy", "acceleration")})
    with pytest.raises(InputError, match=r"^sensors.top.quantity: .* derivative of the transmission error; use veloc"):
        assemble(asked).modal()


def test_losses_of_joined_parts_beside_a_measured_part():
    """Its fit stands for it in natural frequencies; a part that only moves rigidly may have a loss factor."""
    parts = {"a": replace(chain([1e7, 3e7], 0.0), loss_factor=0.02), "b": replace(chain([5e7], 0.0), loss_factor=0.1)}
    lump = Matrices(np.array([[0.7]]), np.zeros((1, 1)), np.ones((1, 1)), {"p": {"uy": 0}}, {}, 0.0, 0.3)
    pair = chain([1e7], 0.0)  # two masses of 1 kg, w_1^2 = 2e7: one channel, but two modes in its fit
    lines = 2 * np.pi * np.linspace(20.0, 2000.0, 300)
    Y = 0.5 / (1j * lines) + 0.5j * lines / (2e7 - lines**2)
    known = Measured(lines, Y[:, None, None], {"first": {"uy": 0}})
    joints = {
        "foot": spring(Port("b", place="last"), Port("m", place="first"), [1e6], ("uy",)),
        "weld": rigid(Port("a", place="last"), Port("b", place="first")),
        "lump": rigid(Port("lump", place="p"), Port("b", place="last")),
    }
    found = []
    for item in (pair, known):
        system = machine({**parts, "lump": lump, "m": item}, joints, Port("a", place="first"), dofs=("uy",))
        modal = assemble(system).modal()
        found.append((natural_frequencies(modal), power_flow(modal, lines[::7]).input_power))
        check = reference_solution(assemble(system), lines[::7])
        np.testing.assert_allclose(found[-1][1], check.input_power, rtol=1e-8)
    np.testing.assert_allclose(found[1][0], found[0][0], rtol=1e-5, atol=1e-3)
    np.testing.assert_allclose(found[1][1], found[0][1], rtol=1e-8)
