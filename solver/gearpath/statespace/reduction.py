"""Reduced models as python-control objects."""

from __future__ import annotations

from typing import Any

import control
import numpy as np

from ..errors import InputError
from ..network.modal import ModalNetwork
from ..numerics.arrays import Complex, Real
from .reduced import Certificate, Reduced
from .reduced.balanced import balanced
from .reduced.certificate import Comparison, certificate_of
from .reduced.choice import certified, check_request, reduced_network
from .reduced.passivity import is_positive_real
from .signals import with_units
from .twin import state_space


class ReducedStateSpace(control.StateSpace):  # type: ignore[misc]  # python-control has no types
    """x' = A x + B u, y = C x + D u of few states: signals as of `gearpath.state_space`, and a `certificate`.

    `network` is the reduced network, whose joints are still explicit; None after balanced truncation.
    """

    certificate: Certificate
    network: ModalNetwork | None
    _comparison: Comparison

    def with_joint(self, name: str, stiffness: Any = None, damping: Any = None) -> ReducedStateSpace:
        """The reduced model with other K (N/m ...) or C (N s/m ...) of one joint, certified anew for them.

        The components' bases know nothing of the joints, so that nothing is reduced again. Raises InputError for an
        unknown joint, a matrix of another size or not symmetric, and after balanced truncation, which has no joints.
        """
        if self.network is None:
            raise InputError("balanced truncation leaves no joint to exchange; reduce by rational_krylov, or again")
        joints = {joint.name: joint for joint in self.network.joints}
        if name not in joints:
            raise InputError(f"joints: there is no joint {name!r}; known: {', '.join(joints)}")
        joint = joints[name]
        K = _matrix(f"{name}.stiffness", stiffness, joint.stiffness)
        C = _matrix(f"{name}.damping", damping, joint.damping)
        complete = self._comparison.network.with_joint(name, K, C)
        comparison = Comparison(complete, self.certificate.band)
        found = certified(self.network.with_joint(name, K, C), comparison, self.certificate.method)
        return _of_network(found)


def reduce(
    network: ModalNetwork, order: int | None, tolerance: float | None, band: tuple[float, float], method: str
) -> ReducedStateSpace:
    """The reduced model of a network; see `gearpath.reduce`."""
    check_request(network, order, tolerance, band, method)
    if method == "balanced":
        return _balanced(network.viscous(), order, tolerance, band)
    found = reduced_network(network, order=order, tolerance=tolerance, band=band, method=method)
    return _of_network(found)


def _of_network(found: Reduced) -> ReducedStateSpace:
    whole = state_space(found.network)
    matrices = (whole.A, whole.B, whole.C, whole.D)
    return _made(whole, matrices, whole.state_labels, found.network, found.certificate, found.comparison)


def _made(
    whole: control.StateSpace,
    matrices: tuple[Real, Real, Real, Real],
    states: list[str] | None,
    network: ModalNetwork | None,
    certificate: Certificate,
    comparison: Comparison,
) -> ReducedStateSpace:
    made = ReducedStateSpace(
        *matrices,
        inputs=whole.input_labels,
        outputs=whole.output_labels,
        states=states,
        name=f"{whole.name}_reduced",
        remove_useless_states=False,
    )
    made.certificate, made.network, made._comparison = certificate, network, comparison
    about = f"Reduced state space of {whole.name}: loads to all outputs that are linear in them."
    units = [list(found.values()) for found in (whole.input_units, whole.output_units, whole.state_units)]
    with_units(made, about, *(units[:2] if states is None else units))
    return made


def _balanced(
    network: ModalNetwork, order: int | None, tolerance: float | None, band: tuple[float, float]
) -> ReducedStateSpace:
    """Balanced truncation to 2 `order` states, or to as many as the tolerance needs."""
    whole, comparison = state_space(network), Comparison(network, band)
    w = 2.0 * np.pi * np.linspace(*band, 400)
    gains = abs(comparison.exact(w)).max(axis=0)
    most = len(network.eigenvalues)
    orders = range(1, most + 1) if order is None else [min(order, most)]
    for states in orders:
        A, B, C, D = balanced(whole, 2 * states, gains)

        def respond(omega: Real, A: Real = A, B: Real = B, C: Real = C, D: Real = D) -> Complex:
            values, T = np.linalg.eig(A)
            left, right = np.linalg.solve(T, B), C @ T
            return np.asarray((right / (1j * omega[:, None, None] - values)) @ left + D)

        if tolerance is None or comparison.rough(respond).error <= tolerance:
            found = comparison.deviation(respond, np.asarray(np.linalg.eigvals(A), complex))
            if tolerance is None or found.error <= tolerance:
                break
    ports = _ports(network)
    stable = bool((np.linalg.eigvals(A).real <= 0.0).all())
    rows, columns = [row for row, _ in ports], [column for _, column in ports]
    passive = stable and is_positive_real(A, B[:, columns], C[rows], D[np.ix_(rows, columns)])
    certificate = certificate_of(found, comparison, "balanced", states, stable=stable, passive=passive)
    return _made(whole, (A, B, C, D), None, None, certificate, comparison)


def _ports(network: ModalNetwork) -> list[tuple[int, int]]:
    """(output, input) of every force input whose own place has a velocity output."""
    linear = [output for output in network.outputs if output.quantity != "power"]
    found = []
    for k, load in enumerate(network.loads):
        for i, output in enumerate(linear):
            moved = output.row if output.quantity == "velocity" and not load.is_transmission_error else None
            if moved is not None and np.allclose(moved, load.column, rtol=1e-9, atol=0.0):
                found.append((i, k))
                break
    return found


def _matrix(key: str, value: Any, current: Real) -> Real:
    """A symmetric matrix of the joint's size; `current` where none is given. Raises InputError."""
    if value is None:
        return current
    try:
        given = np.asarray(value)
        matrix = np.atleast_2d(given.astype(float)) if given.dtype.kind in "iuf" else None
    except (TypeError, ValueError):
        matrix = None
    if matrix is None:
        raise InputError(f"{key}: is no matrix of real numbers; give {current.shape[0]} rows of as many numbers")
    if matrix.shape != current.shape:
        raise InputError(f"{key}: shape {matrix.shape} does not fit; give {current.shape}")
    if not np.isfinite(matrix).all() or abs(matrix - matrix.T).max() > 1e-12 * abs(matrix).max():
        raise InputError(f"{key}: is not symmetric or not finite; give a symmetric matrix of real numbers")
    return matrix
