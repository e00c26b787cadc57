"""The time twin of the synthesis: the coupled network as first-order state equations, plain arrays.

    xi' = s + X d e
    s'  = -L xi - X s + (L d - X X d) e + Phi^T f - P^T g
    g   = K P xi + C P (s + X d e)                           xi: physical modal motion, d = Phi^T M d_mesh

This realisation of the transmission error e is proper: it needs neither e' nor e''. The states are [w xi, s] with w
each mode's own frequency (a fixed frequency for rigid-body modes), so that A is well balanced and the squared norm of
an elastic mode's state pair is twice its energy.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .modal import ModalNetwork
from .records import Load, Output

RIGID_SCALE = 2.0 * np.pi * 1000.0  # rad/s, scale of rigid-body displacements in the state


@dataclass(frozen=True)
class TimeTwin:
    """x' = A x + B u, y = C x + D u of the loads and the linear outputs."""

    A: Real
    B: Real
    C: Real
    D: Real
    loads: tuple[Load, ...]
    outputs: tuple[Output, ...]


def state_scale(network: ModalNetwork) -> Real:
    """w of each mode, rad/s: state = w * displacement."""
    return np.where(network.eigenvalues > 0.0, np.sqrt(network.eigenvalues), RIGID_SCALE)


def time_twin(
    network: ModalNetwork, outputs: Sequence[Output] | None = None, loads: Sequence[Load] | None = None
) -> TimeTwin:
    """State equations for the given outputs and loads (default: all linear outputs, all loads).

    Loss factors have no causal form in time: their viscous equivalents (`ModalNetwork.viscous`) take their place.
    """
    network = network.viscous()
    chosen = tuple(o for o in network.outputs if o.quantity != "power") if outputs is None else tuple(outputs)
    inputs = network.loads if loads is None else tuple(loads)
    L, X, w = network.eigenvalues, network.damping, state_scale(network)
    P, (K, C) = network.relative, network.interface_matrices()
    N = len(L)
    slip = np.column_stack([_slip(load, X) for load in inputs]) if inputs else np.zeros((N, 0))
    push = np.column_stack([_push(load, L, X) for load in inputs]) if inputs else np.zeros((N, 0))
    force_x, force_s, force_u = K @ P / w, C @ P, C @ P @ slip
    A = np.block([[np.zeros((N, N)), np.diag(w)], [-np.diag(L / w) - P.T @ force_x, -np.diag(X) - P.T @ force_s]])
    B = np.vstack([w[:, None] * slip, push - P.T @ force_u])
    joints = network.joint_slices()
    rows_x, rows_u = np.zeros((len(chosen), 2 * N)), np.zeros((len(chosen), len(inputs)))
    for k, output in enumerate(chosen):
        if output.quantity == "force":
            assert output.joint is not None
            i = joints[output.joint].start + output.dof
            rows_x[k, :N], rows_x[k, N:], rows_u[k] = force_x[i], force_s[i], force_u[i]
            continue
        if output.row is None:
            raise InputError(f"{output.name} is a power, not linear in the state; compute it from force and velocity")
        if output.quantity == "displacement":
            rows_x[k, :N] = output.row / w
        elif output.quantity == "velocity":
            rows_x[k, N:], rows_u[k] = output.row, output.row @ slip
        else:
            rows_x[k], rows_u[k] = output.row @ A[N:], output.row @ B[N:]
    return TimeTwin(A, B, rows_x, rows_u, inputs, chosen)


def _slip(load: Load, X: Real) -> Real:
    """Velocity that the transmission error adds at once, X d."""
    return np.zeros_like(X) if load.mesh_displacement is None else X * load.mesh_displacement


def _push(load: Load, L: Real, X: Real) -> Real:
    """Modal force per unit input: Phi^T f, or L d - X X d of a transmission error."""
    if load.mesh_displacement is None:
        return load.column
    return (L - X**2) * load.mesh_displacement
