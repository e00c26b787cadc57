"""Reduced models as python-control objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..joints.matrix_checks import check_matrix
from ..network.modal import ModalNetwork
from ..network.records import JointRows
from ..numerics.arrays import Complex, Real
from .named import StateSpace
from .reduced import Certificate, Reduced
from .reduced.balanced import balanced
from .reduced.certificate import Comparison, certificate_of
from .reduced.choice import certified, check_request, check_tolerance, reduced_network
from .reduced.passivity import is_positive_real
from .signals import with_units
from .twin import state_space

if TYPE_CHECKING:
    import control


@dataclass(frozen=True)
class Following:
    """How the damping of joints follows their stiffness: C = T K where a joint has a damping time T, and eta K / w."""

    damping_times: Mapping[str, float] = field(default_factory=dict)  # T, s
    loss_times: Mapping[str, float] = field(default_factory=dict)  # eta / w, s, of loss factors made viscous

    def exchanged(self, joint: JointRows, stiffness: Any, damping: Any) -> tuple[Real, Real]:
        """K and C of a joint that gets other matrices, None where the present ones stay. Raises ModelError."""
        lost = self.loss_times.get(joint.name, 0.0)
        K, C = joint.stiffness, joint.damping - lost * joint.stiffness
        if stiffness is not None:
            K = _matrix(f"{joint.name}.stiffness", stiffness, joint.dofs)
            C = self.damping_times[joint.name] * K if joint.name in self.damping_times else C
        if damping is not None:
            C = _matrix(f"{joint.name}.damping", damping, joint.dofs)
        return K, C + lost * K

    def without(self, name: str) -> Following:
        """The same, but for one joint whose own damping is given."""
        return Following({key: time for key, time in self.damping_times.items() if key != name}, self.loss_times)


class ReducedStateSpace(StateSpace):
    """x' = A x + B u, y = C x + D u of few states: signals as of `gearpath.state_space`, and a `certificate`.

    `network` is the reduced network, whose joints are still explicit; None after balanced truncation.
    """

    certificate: Certificate
    network: ModalNetwork | None
    _comparison: Comparison
    _following: Following

    def with_joint(self, name: str, stiffness: Any = None, damping: Any = None) -> ReducedStateSpace:
        """The reduced model with other K (N/m ...) or C (N s/m ...) of one joint, certified anew for them.

        As `Model.replace` takes them: a matrix on the joint's degrees of freedom, or a number along uy alone. Without
        `damping`, C follows K by the joint's damping_time, if the model has one; a loss factor stays. The components'
        bases know nothing of the joints, so that nothing is reduced again. Raises InputError for an unknown joint, a
        matrix of another size, not symmetric or indefinite, and after balanced truncation, which leaves no joints.
        """
        if self.network is None:
            raise InputError("balanced truncation leaves no joint to exchange; reduce by rational_krylov, or again")
        joints = {joint.name: joint for joint in self.network.joints}
        if name not in joints:
            raise InputError(f"joints: there is no joint {name!r}; known: {', '.join(joints)}")
        K, C = self._following.exchanged(joints[name], stiffness, damping)
        complete = self._comparison.network.with_joint(name, K, C)
        comparison = Comparison(complete, self.certificate.band)
        found = certified(self.network.with_joint(name, K, C), comparison, self.certificate.method)
        return _of_network(found, self._following if damping is None else self._following.without(name))


def reduce(
    network: ModalNetwork,
    order: int | None,
    tolerance: float | None,
    band: tuple[float, float],
    method: str,
    damping_times: Mapping[str, float] | None = None,
) -> ReducedStateSpace:
    """The reduced model of a network; see `gearpath.reduce`. `damping_times` (s) are those of joints whose C = T K."""
    check_request(network, order, tolerance, band, method)
    if method == "balanced":
        return _balanced(network.viscous(), order, tolerance, band)
    found = reduced_network(network, order=order, tolerance=tolerance, band=band, method=method)
    w = 2.0 * np.pi * network.loss_frequency
    lossy = {joint.name: joint.loss_factor / w for joint in network.joints if joint.loss_factor}
    return _of_network(found, Following(damping_times or {}, lossy))


def _of_network(found: Reduced, following: Following) -> ReducedStateSpace:
    whole = state_space(found.network)
    matrices = (whole.A, whole.B, whole.C, whole.D)
    made = _made(whole, matrices, whole.state_labels, found.network, found.certificate, found.comparison)
    made._following = following
    return made


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
    if tolerance is not None:
        check_tolerance(comparison, tolerance)
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


def _matrix(key: str, value: Any, dofs: tuple[str, ...]) -> Real:
    """A symmetric matrix on the joint's degrees of freedom, of a number along uy alone. Raises InputError."""
    try:
        given = np.asarray(value)
        matrix = given.astype(float) if given.dtype.kind in "iuf" else None
    except (TypeError, ValueError):
        matrix = None
    if matrix is not None and matrix.ndim == 0 and "uy" in dofs:
        matrix = np.diag([float(matrix) if dof == "uy" else 0.0 for dof in dofs])
    square = matrix is not None and matrix.ndim == 2 and matrix.shape[0] == matrix.shape[1]
    if matrix is None or not square or not np.isfinite(matrix).all():
        raise InputError(f"{key}: is no matrix of finite real numbers; give one on {', '.join(dofs)}")
    check_matrix(tuple(tuple(row) for row in matrix.tolist()), dofs, key)
    return np.asarray(0.5 * (matrix + matrix.T))
