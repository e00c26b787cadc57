"""Structures for the tests of the reductions: the default source, random ones, and a plain partition as the oracle."""

from dataclasses import replace

import numpy as np
import scipy.linalg
import scipy.sparse
from systems import random_gearbox

from gearpath.components import GearTrain, Material, Section, Shaft, ShaftPoint, Structure
from gearpath.network.assemble import assemble
from gearpath.reduction import craig_bampton, free_interface, hold, interface_rows

NODE_COORDINATES = 34  # of one shaft of the default gearbox: uy, rx at 17 nodes
# Guyan by a factor of four, 69 to 17: uy at every fourth node of both shafts, rx at bearings and gears, and p
KEPT = sorted(
    [NODE_COORDINATES * shaft + 2 * node for shaft in (0, 1) for node in (0, 4, 8, 12, 16)]
    + [NODE_COORDINATES * shaft + 2 * node + 1 for shaft in (0, 1) for node in (0, 8, 16)]
    + [68]
)


def random_source(seed):
    """The gear train of a random gearbox."""
    return assemble(random_gearbox(seed, seed % 5 + 1)).structures["train"]


def chain(n=12, port=None):
    """Unit masses and springs in a row, free at both ends; natural frequencies 2 sin(k pi / 2n) rad/s."""
    K = np.diag(np.r_[1.0, 2.0 * np.ones(n - 2), 1.0]) - np.eye(n, k=1) - np.eye(n, k=-1)
    rows = np.zeros((6, n))
    rows[1] = np.eye(n)[0] if port is None else port
    return Structure(np.eye(n), K, np.ones((n, 1)), 0.01, {"end": rows})


def beam_shaft(elements):
    """A free steel shaft in the plane, 1 m long and 10 mm thick, with a port at each end."""
    steel = Material(2.07e11, 0.3, 7850.0)
    train = GearTrain({"it": Shaft(steel, (0.0, 0.0, 0.0), (Section(1.0, 0.01),), 0.886, (elements,))}, {})
    return train.structure(("uy", "rx"), {"end": ShaftPoint("it", 0.0), "other": ShaftPoint("it", 1.0)})


def sparse(structure):
    """The same structure with sparse matrices."""
    M, K = (scipy.sparse.csc_array(matrix) for matrix in (structure.mass, structure.stiffness))
    return replace(structure, mass=M, stiffness=K)


def bampton(structure, count):
    """Craig-Bampton with at most as many modes as the interior has."""
    held = hold(structure, interface_rows(structure))
    return craig_bampton(structure, min(count, len(held.inner)), held=held)


def free(structure, count, residual):
    """Free-interface modes, at most as many as there are."""
    return free_interface(structure, min(count, structure.size - structure.rigid_modes.shape[1]), residual)


def bordered_static(K, rows, motion):
    """Coordinates of least strain energy whose rows read `motion`: Lagrange multipliers, dense; and their condition."""
    m, n = rows.shape
    unit = 1.0 / np.sqrt(np.diag(K))
    B = rows * unit
    size = np.linalg.norm(B, axis=1)
    border = np.block([[K * np.outer(unit, unit), (B / size[:, None]).T], [B / size[:, None], np.zeros((m, m))]])
    right = np.vstack([np.zeros((n, motion.shape[1])), motion / size[:, None]])
    return unit[:, None] * scipy.linalg.solve(border, right)[:n], np.linalg.cond(border)


def elastic_flexibility(structure):
    """Sum over all elastic modes of phi phi^T / w^2, from the dense eigenproblem."""
    values, shapes = scipy.linalg.eigh(structure.stiffness, structure.mass)
    elastic = shapes[:, structure.rigid_modes.shape[1] :]
    return (elastic / values[structure.rigid_modes.shape[1] :]) @ elastic.T
