"""What must agree: the casing with closed forms and with scipy on the same matrices, Gearpath's reduction with both."""

from collections.abc import Iterator

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from casing_machine import DAMPING, FOOT, SEAT, held
from casing_matrices import DENSITY, Casing, Sparse
from casing_mesh import FEET
from casing_prisms import MassProperties, closed_form, of_moments

import gearpath as gp

SYMMETRIC = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
DYNAMIC = 2000.0  # Hz


def mass_properties(casing: Casing) -> MassProperties:
    """Kinetic energies of the six rigid motions, with M as it is written to the file."""
    R = casing.rigid()
    generalised = R.T @ (casing.mass @ R)
    first, turning = generalised[:3, 3:], generalised[3:, 3:]
    moments = np.zeros((4, 4))
    moments[0, 0] = generalised[0, 0]
    moments[0, 1:] = moments[1:, 0] = first[1, 2], first[2, 0], first[0, 1]
    moments[1:, 1:] = 0.5 * np.trace(turning) * np.eye(3) - turning
    return of_moments(moments)


def elastic_modes(stiffness: Sparse, mass: Sparse, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest frequencies (Hz) beyond rigid motion and their shapes, by scipy's shift-and-invert Lanczos."""
    shift = -((2.0 * np.pi * 100.0) ** 2)
    factor = scipy.sparse.linalg.splu(scipy.sparse.csc_matrix(stiffness - shift * mass), **SYMMETRIC)
    inverse = scipy.sparse.linalg.LinearOperator(stiffness.shape, matvec=factor.solve, dtype=float)
    start = np.cos(np.arange(stiffness.shape[0]) ** 2)
    found, shapes = scipy.sparse.linalg.eigsh(stiffness, count + 6, mass, sigma=shift, OPinv=inverse, v0=start)
    elastic = np.flatnonzero(found > (2.0 * np.pi) ** 2)[:count]  # 1 Hz: rounding leaves rigid motions below
    return np.sqrt(found[elastic]) / (2.0 * np.pi), shapes[:, elastic]


def largest_differences(casing: Casing, flexible: gp.Model, flow: object) -> Iterator[tuple[str, float]]:
    """What is compared, and the largest relative difference."""
    own, exact = mass_properties(casing), closed_form(DENSITY, casing.size)
    yield "mass, rigid motions against prisms", abs(own.mass / exact.mass - 1.0)
    yield "centre of gravity", abs(own.centre - exact.centre).max() / abs(exact.centre).max()
    yield "inertia", abs(own.inertia - exact.inertia).max() / abs(exact.inertia).max()
    machine = held(flexible)
    grounded = np.zeros(len(casing.numbers))
    grounded[np.hstack([casing.rows(foot)[:3] for foot in FEET])] = FOOT
    K, M = casing.stiffness, casing.mass
    frequencies = elastic_modes(K + scipy.sparse.diags_array(grounded), M, 12)[0]
    found = gp.natural_frequencies(machine)[: len(frequencies)]
    yield "12 natural frequencies on stiff feet, against eigsh", abs(found / frequencies - 1.0).max()
    seat = casing.rows(SEAT)[1]
    lines = np.array([1.0, DYNAMIC])
    response = gp.frequency_response(machine, lines, "sensors.seat", "excitation.force").values.ravel()
    solved = np.array([direct(K, grounded, M, seat, f) for f in lines])
    yield "stiffness of seat 1 at 1 Hz, against a direct solution", abs(response[0] / solved[0] - 1.0)
    yield f"receptance of seat 1 at {DYNAMIC:g} Hz, likewise", abs(response[1] / solved[1] - 1.0)
    balance = flow.dissipated_power.sum("element") / flow.input_power - 1.0
    yield "power that is dissipated, against the input power", float(abs(balance).max())


def direct(K: Sparse, grounded: np.ndarray, M: Sparse, place: int, frequency: float) -> complex:
    """Displacement by force at one coordinate (m/N) at a frequency in Hz, by a sparse factorisation of its own."""
    dynamic = (1.0 + 2j * DAMPING) * K - (2.0 * np.pi * frequency) ** 2 * M + scipy.sparse.diags_array(grounded)
    unit = np.zeros(K.shape[0], complex)
    unit[place] = 1.0
    return complex(scipy.sparse.linalg.splu(scipy.sparse.csc_matrix(dynamic), **SYMMETRIC).solve(unit)[place])
