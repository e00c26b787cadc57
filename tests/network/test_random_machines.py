"""Invariants over random gearboxes: synthesis against the direct solution, power balance, passivity, reciprocity."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import random_gearbox

from gearpath.components.mobility import modal_response
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.synthesis import Synthesis

machines = st.builds(random_gearbox, st.integers(0, 2**32 - 1), st.integers(1, 8))
LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 7)


def kinds(network):
    """Rows of forces and of moments: they have different units and are compared apart."""
    rotation = np.array([dof[0] == "r" for joint in network.joints for dof in joint.dofs])
    return [rows for rows in (~rotation, rotation) if rows.any()]


def interface_condition(network):
    """Condition of I + Z W at every line: by so much the rounding of the joints' positions moves the forces."""
    P, (K, C) = network.relative, network.interface_matrices()
    h = modal_response(network.eigenvalues, network.damping, LINES)
    return np.array(
        [np.linalg.cond(np.eye(len(P)) + (K / (1j * w) + C) @ (P * h[:, i]) @ P.T) for i, w in enumerate(LINES)]
    )


@settings(max_examples=200, deadline=None)
@given(machines)
def test_synthesis_equals_the_unsynthesised_solution(system):
    network = assemble(system)
    modal = network.modal()
    load = next(item for item in modal.loads if item.name == modal.excitation)
    solved = Synthesis(modal, [load]).solve(LINES)
    force = solved.force[:, 0]
    reference = reference_solution(network, LINES)
    limit = np.maximum(1e-9, 16 * np.finfo(float).eps * interface_condition(modal))
    for rows in kinds(modal):
        largest = abs(reference.force[rows]).max(axis=0)
        deviation = abs(force - reference.force)[rows].max(axis=0)
        assert np.all(deviation <= limit * largest + 1e-300)
    flow = power_flow(modal, LINES)
    gross = abs(flow.path_power).sum(axis=0) / flow.input_power  # where the paths nearly cancel, the net is small
    assert np.all(abs(flow.share() - reference.alpha) <= 10 * limit * gross)


@settings(max_examples=200, deadline=None)
@given(machines)
def test_power_balance_and_passivity(system):
    flow = power_flow(assemble(system).modal(), LINES)
    np.testing.assert_allclose(flow.dissipated_power.sum(axis=0), flow.input_power, rtol=1e-8)
    assert np.all(flow.dissipated_power >= 0.0)
    assert np.all(flow.transmitted_power >= -1e-10 * flow.input_power)
    assert np.all(flow.share() < 1.0 + 1e-10)


@settings(max_examples=100, deadline=None)
@given(machines)
def test_reciprocity_of_the_coupled_machine(system):
    """Velocity at j per unit force at i = velocity at i per unit force at j, across the joints."""
    modal = assemble(system).modal()
    rng = np.random.default_rng(0)
    columns = rng.normal(size=(2, modal.eigenvalues.size))
    loads = [replace(modal.loads[-1], column=c, mesh_displacement=None) for c in columns]
    velocity = Synthesis(modal, loads).solve(LINES).velocity
    there, back = columns[1] @ velocity[:, 0], columns[0] @ velocity[:, 1]
    summed = np.maximum(abs(columns[1]) @ abs(velocity[:, 0]), abs(columns[0]) @ abs(velocity[:, 1]))
    assert np.all(abs(there - back) <= 1e-10 * summed)
