"""Power flow over the torque through the machine: alpha(f, T)."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..errors import InputError
from ..network.assemble import assemble
from ..network.operation import at_operating_point
from ..network.system import System
from ..numerics.arrays import Real
from .labelled import labelled_power_flow

_KEPT = ("input_power", "transmitted_power", "alpha", "alpha_force", "alpha_moment", "path_alpha")


def labelled_torque_sweep(
    system: System,
    torques: ArrayLike,
    frequencies_hz: ArrayLike,
    amplitude: float,
    progress: Callable[[int], None] = lambda _: None,
) -> xr.Dataset:
    """Power flow over `torque` (N m) and `frequency` (Hz); see `gearpath.torque_sweep`."""
    checked = _torques(torques)
    flows = []
    for point in systems_over_torque(system, checked):
        flow = labelled_power_flow(assemble(point).modal(), frequencies_hz, amplitude, progress)
        stiffness = {name: np.array(point.joints[name].stiffness) for name in _following(point)}
        flows.append(flow[list(_KEPT)].assign({f"stiffness.{n}": (("dof", "dof_2"), K) for n, K in stiffness.items()}))
    torque = xr.DataArray(checked, dims="torque", attrs={"units": "N m", "long_name": "torque on the driving shaft"})
    dofs = list(system.dofs)
    return xr.concat(flows, dim=torque, combine_attrs="override").assign_coords(dof=dofs, dof_2=dofs)


def systems_over_torque(system: System, torques: Real) -> Iterator[System]:
    """The system at the operating point of each torque, N m; raises InputError where it has no operation."""
    if system.operation is None or not _following(system):
        raise InputError(
            "torques: the model has no table operation, or no bearing by geometry or catalogue follows it; add them"
        )
    for torque in torques.tolist():
        yield at_operating_point(replace(system, operation=replace(system.operation, torque=torque)))


def _following(system: System) -> list[str]:
    return [name for name, joint in system.joints.items() if joint.mounting and joint.mounting.follows_operation]


def _torques(torques: ArrayLike) -> Real:
    try:
        checked = np.atleast_1d(np.asarray(torques, float))
    except (TypeError, ValueError):
        raise InputError(f"torques: {torques!r} are not numbers; give them in N m") from None
    if checked.ndim != 1 or not checked.size or not (np.isfinite(checked) & (checked >= 0.0)).all():
        raise InputError(f"torques: {torques!r} are not finite torques of at least 0 N m, in one dimension; give such")
    return checked
