"""Measured components in the network: their own mobilities in the frequency twin, their fit wherever time runs.

In a modal network the coordinates of a measured component are its m channels themselves, with the mobility Y(w) in
place of the diagonal modal response; `fitted` puts the N real modes of its fit there, q = phi q_r.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..components import Measured, ModalModel
from ..fitting import ModalFit, fit_modes
from ..numerics.arrays import Complex, Real
from ..numerics.lines import real_times_complex
from .records import Load
from .system import System

if TYPE_CHECKING:
    from .modal import ModalNetwork


@lru_cache(maxsize=32)
def fit_of(component: Measured) -> ModalFit:
    """The fit of a measured component, computed once for each content."""
    return fit_modes(component.omega, component.mobility, component.modes, component.tolerance)


def fitted_system(system: System) -> System:
    """The system whose measured components are the modes of their fits; the others stay as they are."""
    components = {
        name: _modes_of(item) if isinstance(item, Measured) else item for name, item in system.components.items()
    }
    return replace(system, components=components) if components != system.components else system


def _modes_of(component: Measured) -> ModalModel:
    fit = fit_of(component)
    return ModalModel(
        tuple(fit.eigenvalues.tolist()),
        tuple(fit.damping_ratios.tolist()),
        {
            port: {dof: tuple(fit.shapes[k].tolist()) for dof, k in channels.items()}
            for port, channels in component.ports.items()
        },
        dict(component.places),
    )


@dataclass(frozen=True)
class MeasuredRows:
    """What a measured component is to the interface: its coordinates, and the interface rows that move with it."""

    block: slice
    rows: NDArray[np.intp]  # (k,)
    motion: Real  # (k, m): P of these rows and coordinates
    component: Measured

    @classmethod
    def of(cls, P: Real, block: slice, component: Measured) -> MeasuredRows:
        """Those of the component whose coordinates are the given slice."""
        rows = np.flatnonzero(P[:, block].any(axis=1))
        return cls(block, rows, P[rows, block], component)

    def interface(self, Y: Complex) -> Complex:
        """B Y B^T, (k, k, F), of Y (m, m, F)."""
        half = real_times_complex(self.motion, Y).swapaxes(0, 1)
        return real_times_complex(self.motion, half).swapaxes(0, 1)


def velocities(Y: Complex, force: Complex) -> Complex:
    """Y f on every line: Y (m, m, F), f (m, k, F)."""
    return np.asarray(np.einsum("abf,bkf->akf", Y, force))


def port_forces(network: ModalNetwork, loads: Sequence[Load], joint_force: Complex, block: slice) -> Complex:
    """Forces into the channels of a measured component under unit loads, (m, k, F): loads less joint forces."""
    drive = np.array([load.column[block] for load in loads]).T
    return np.asarray(drive[:, :, None] - real_times_complex(network.relative[:, block].T, joint_force))


def fitted(network: ModalNetwork) -> ModalNetwork:
    """The network with the fit of every measured component in its place; the others stay as they are."""
    if not network.measured:
        return network
    fits = {name: fit_of(component) for name, component in network.measured.items()}
    parts = {
        name: fits[name].shapes if name in fits else np.eye(block.stop - block.start)
        for name, block in network.components.items()
    }
    ends = np.cumsum([part.shape[1] for part in parts.values()])
    blocks = {name: slice(int(end) - part.shape[1], int(end)) for (name, part), end in zip(parts.items(), ends)}
    T = scipy.linalg.block_diag(*parts.values())
    ratios, shares = _damping(network, fits, blocks, T)
    return replace(
        network,
        components=blocks,
        modal_damping=ratios,
        damping_shares=shares,
        loss_shares={name: share @ T for name, share in network.loss_shares.items()},
        joined_losses={name: replace(item, rows=item.rows @ T) for name, item in network.joined_losses.items()},
        dashpots={name: D @ T for name, D in network.dashpots.items()},
        eigenvalues=np.concatenate(
            [fits[n].eigenvalues if n in fits else network.eigenvalues[network.components[n]] for n in parts]
        ),
        joints=tuple(replace(j, source=j.source @ T, receiver=j.receiver @ T) for j in network.joints),
        loads=tuple(_projected(load, T) for load in network.loads),
        outputs=tuple(replace(o, row=None if o.row is None else o.row @ T) for o in network.outputs),
        measured={},
    )


def _projected(load: Load, T: Real) -> Load:
    d = load.mesh_displacement  # no gear mesh is on a measured component: its part is 0
    return replace(load, column=load.column @ T, mesh_displacement=None if d is None else d @ T)


def _damping(
    network: ModalNetwork, fits: Mapping[str, ModalFit], blocks: Mapping[str, slice], T: Real
) -> tuple[dict[str, float], dict[str, Real]]:
    """Damping ratios by component, and what each mode takes of them: a fit's modes have ratios of their own."""
    ratios, shares = {}, {}
    for name, share in network.damping_shares.items():  # 0 on measured components
        shares[name] = share @ T
    for name in network.components:
        if name in network.modal_damping:
            ratios[name] = network.modal_damping[name]
        fit = fits.get(name)
        if fit is None or not (fit.eigenvalues > 0.0).any():
            continue
        zeta = fit.damping_ratios[fit.eigenvalues > 0.0]
        ratios[name] = float(zeta.mean())
        share = np.zeros(T.shape[1])
        share[blocks[name]] = fit.damping_ratios / ratios[name]
        shares[name] = share
    return ratios, shares
