"""Measurements on both sides of joints with names and units (xarray), and joints identified from them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..components.dofs import force_unit, motion_unit
from ..errors import InputError
from ..identification import JointIdentification, chosen_joints, identify, joint_mobility, port_names, with_noise
from ..network.modal import ModalNetwork
from .labelled import checked_frequencies

_SIDES = ("source", "receiver")


def labelled_measurement(
    network: ModalNetwork,
    frequencies_hz: ArrayLike,
    joints: str | Iterable[str] | None,
    noise: float,
    seed: int | None,
    connected: bool,
) -> xr.DataArray:
    """Mobilities over (frequency, motion, force); see `gearpath.measure_joint`."""
    names = [joints] if isinstance(joints, str) else list(network.paths if joints is None else joints)
    if not names:
        raise InputError("joints: name at least one joint")
    f = checked_frequencies(frequencies_hz, network)
    dofs = {joint.name: joint.dofs for joint in chosen_joints(network, names)}
    Y = with_noise(joint_mobility(network, 2.0 * np.pi * f, names, connected), noise, seed)
    ports = list(port_names(dofs))
    kinds = [port.rsplit(".", 1)[1] for port in ports]
    return xr.DataArray(
        Y,
        dims=("frequency", "motion", "force"),
        coords={
            "frequency": ("frequency", f, {"units": "Hz"}),
            "motion": ports,
            "force": ports,
            "motion_unit": ("motion", [motion_unit(dof, 1) for dof in kinds]),
            "force_unit": ("force", [force_unit(dof) for dof in kinds]),
        },
        name="mobility",
        attrs={"model": network.name, "units": "velocity unit per force unit, SI", "convention": "e^{+i w t}"},
    )


def identified(
    mobility: ArrayLike | xr.DataArray,
    frequencies_hz: ArrayLike | None,
    joints: Mapping[str, Sequence[str]] | None,
    noise: ArrayLike | None,
    without: ArrayLike | xr.DataArray | None,
) -> JointIdentification:
    """Joints from labelled or bare mobilities; see `gearpath.identify_joint`."""
    if isinstance(mobility, xr.DataArray):
        if {"frequency", "motion", "force"} - set(mobility.dims):
            raise InputError(f"mobility: dimensions {mobility.dims} are not frequency, motion and force; rename them")
        joints = _joints_of([str(name) for name in mobility["motion"].values]) if joints is None else joints
        frequencies_hz = mobility["frequency"].values if frequencies_hz is None else frequencies_hz
        mobility = _ordered("mobility", mobility, joints)
    if frequencies_hz is None or joints is None:
        raise InputError("mobility: bare numbers need frequencies_hz and joints, as {'bearing_1': ('uy', 'rx')}")
    if isinstance(without, xr.DataArray):
        without = _ordered("without", without, joints)
    return identify(frequencies_hz, mobility, joints, noise, without)


def _joints_of(ports: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Degrees of freedom by joint, from names such as bearing_1.source.uy."""
    joints: dict[str, tuple[str, ...]] = {}
    for port in ports:
        parts = port.rsplit(".", 2)
        if len(parts) != 3 or parts[1] not in _SIDES:
            raise InputError(f"mobility: {port!r} does not name a port; write JOINT.source.DOF or JOINT.receiver.DOF")
        if parts[1] == "source":
            joints[parts[0]] = (*joints.get(parts[0], ()), parts[2])
    return joints


def _ordered(what: str, mobility: xr.DataArray, joints: Mapping[str, Sequence[str]]) -> ArrayLike:
    """The array with sides and joints in order. Raises InputError for ports that are missing."""
    ports = port_names(joints)
    for dim in ("motion", "force"):
        if dim not in mobility.dims or "frequency" not in mobility.dims:
            raise InputError(f"{what}: dimensions {mobility.dims} are not frequency, motion and force; rename them")
        names = [str(name) for name in mobility[dim].values]
        missing = [port for port in ports if port not in names]
        if missing:
            raise InputError(f"{what}: {dim} has no {missing[0]}; both sides of a joint must be measured")
        if len(set(names)) != len(names) or len(names) != len(ports):
            raise InputError(f"{what}: {dim} names ports that no joint has, or twice; keep {', '.join(ports)}")
    return np.asarray(mobility.transpose("frequency", "motion", "force").sel(motion=list(ports), force=list(ports)))
