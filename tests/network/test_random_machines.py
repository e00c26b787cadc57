"""Invariants over random gearboxes: synthesis against the direct solution, power balance, passivity, reciprocity."""

from dataclasses import replace

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st
from systems import random_gearbox

from gearpath.components.mobility import modal_response
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.synthesis import Synthesis

machines = st.builds(random_gearbox, st.integers(0, 2**32 - 1), st.integers(1, 8))
helical_machines = st.builds(random_gearbox, st.integers(0, 2**32 - 1), st.integers(1, 8), st.just(True))
LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 7)


def kinds(network):
    """Rows of forces and of moments: they have different units and are compared apart."""
    rotation = np.array([dof[0] == "r" for joint in network.joints for dof in joint.dofs])
    return [rows for rows in (~rotation, rotation) if rows.any()]


def rounding(network, load, force):
    """By how much the rounding of modes and joints can move the interface forces: near an antiresonance much.

    eps |(I + Z W)^-1| |Z| (|P| |h| (|f| + |P^T| |g|) + |w P d|), (n_p, F): the componentwise error bound.
    """
    P, (K, C) = network.relative, network.interface_matrices()
    size, response = abs(P), modal_response(network.eigenvalues, network.damping, LINES)
    bound = np.empty(force.shape)
    for i, w in enumerate(LINES):
        Z, h = K / (1j * w) + C, response[:, i]
        inverse = np.linalg.inv(np.eye(len(P)) + Z @ (P * h) @ P.T)
        drive = abs(load.column) * (w**2 if load.is_transmission_error else 1.0)
        motion = abs(h) * (drive + size.T @ abs(force[:, i]))
        if load.is_transmission_error:
            motion += w * abs(load.mesh_displacement)
        bound[:, i] = abs(inverse) @ (abs(Z) @ (size @ motion))
    return np.finfo(float).eps * bound


def check_synthesis_against_reference(system):
    network = assemble(system)
    modal = network.modal()
    load = next(item for item in modal.loads if item.name == modal.excitation)
    solved = Synthesis(modal, [load]).solve(LINES)
    force = solved.force[:, 0]
    reference = reference_solution(network, LINES)
    bound, relative = rounding(modal, load, force), np.zeros(len(LINES))
    for rows in kinds(modal):
        largest = abs(reference.force[rows]).max(axis=0)
        deviation = abs(force - reference.force)[rows].max(axis=0)
        relative = np.maximum(relative, bound[rows].max(axis=0) / np.maximum(largest, 1e-300))
        assert np.all(deviation <= 1e-9 * largest + 1e3 * bound[rows].max(axis=0) + 1e-300)
    flow = power_flow(modal, LINES)
    gross = abs(flow.path_power).sum(axis=0) / flow.input_power  # where the paths nearly cancel, the net is small
    assert np.all(abs(flow.share() - reference.alpha) <= (1e-8 + 1e3 * relative) * gross)


def check_balance_and_passivity(system):
    modal = assemble(system).modal()
    flow, load = power_flow(modal, LINES), next(item for item in modal.loads if item.name == modal.excitation)
    drive = LINES**2 if load.is_transmission_error else 1.0
    apparent = 0.5 * abs(load.column @ Synthesis(modal, [load]).solve(LINES).elastic[:, 0]) * drive
    # the input power is a small rest of the apparent power where hardly anything is lost
    assert np.all(
        abs(flow.dissipated_power.sum(axis=0) - flow.input_power) < 1e-8 * flow.input_power + 1e-11 * apparent
    )
    assert np.all(flow.dissipated_power >= 0.0)
    assert np.all(flow.transmitted_power >= -1e-10 * flow.input_power)
    assert np.all(flow.share() < 1.0 + 1e-10)


def check_reciprocity(system):
    """Velocity at j per unit force at i = velocity at i per unit force at j, across the joints."""
    modal = assemble(system).modal()
    rng = np.random.default_rng(0)
    columns = rng.normal(size=(2, modal.eigenvalues.size))
    loads = [replace(modal.loads[-1], column=c, mesh_displacement=None) for c in columns]
    velocity = Synthesis(modal, loads).solve(LINES).velocity
    there, back = columns[1] @ velocity[:, 0], columns[0] @ velocity[:, 1]
    summed = np.maximum(abs(columns[1]) @ abs(velocity[:, 0]), abs(columns[0]) @ abs(velocity[:, 1]))
    assert np.all(abs(there - back) <= 1e-10 * summed)


@settings(max_examples=200, deadline=None)
@given(machines)
@example(random_gearbox(2482, 1))  # moves 100,000 times as far as it deforms: damping must not resist rigid motion
@example(random_gearbox(28180, 1, True))
def test_synthesis_equals_the_unsynthesised_solution(system):
    check_synthesis_against_reference(system)


@settings(max_examples=200, deadline=None)
@given(machines)
def test_power_balance_and_passivity(system):
    check_balance_and_passivity(system)


@settings(max_examples=100, deadline=None)
@given(machines)
def test_reciprocity_of_the_coupled_machine(system):
    check_reciprocity(system)


@settings(max_examples=40, deadline=None)
@given(helical_machines)
def test_all_of_it_holds_for_helical_machines_in_space(system):
    for check in (check_synthesis_against_reference, check_balance_and_passivity, check_reciprocity):
        check(system)
