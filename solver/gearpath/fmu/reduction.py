"""Reduced FMUs: which reduction was asked for, what came of it, and the same again when the FMU is checked."""

import json
import zipfile
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..network.modal import ModalNetwork
from ..statespace.reduced import Certificate, Comparison, Reduced, reduced_network

RECORD = "resources/reduction.json"
_LINES = 2000


@dataclass(frozen=True)
class ReductionRequest:
    """A reduction as `gearpath.reduce` takes it: one of order and tolerance, over a band in Hz."""

    order: int | None
    tolerance: float | None
    band: tuple[float, float]
    method: str = "rational_krylov"


def reduced_for(network: ModalNetwork, request: ReductionRequest) -> Reduced:
    """The reduced network, and the worst certificate of all torques that its joints follow.

    Raises InputError as `reduced_network`.
    """
    stages = [network]
    if network.schedule is not None:
        stages = [network.at_torque(float(torque)) for torque in network.schedule.torques]
    settings = {"tolerance": request.tolerance, "band": request.band, "method": request.method}
    found = [reduced_network(stage, order=request.order, **settings) for stage in stages]  # type: ignore[arg-type]
    order = max(item.certificate.order for item in found)
    if any(item.certificate.order != order for item in found):
        settings["tolerance"] = None
        found = [reduced_network(stage, order=order, **settings) for stage in stages]  # type: ignore[arg-type]
    worst = max((item.certificate for item in found), key=lambda certificate: certificate.error)
    first = found[0].network
    joints = tuple(
        replace(joint, stiffness=given.stiffness, damping=given.damping)
        for joint, given in zip(first.joints, network.joints)
    )
    return replace(found[0], network=replace(first, joints=joints), certificate=worst)


def request_of(certificate: Certificate) -> ReductionRequest:
    """The request that gives the same reduction again."""
    return ReductionRequest(certificate.order, None, certificate.band, certificate.method)


def worst_error(complete: ModalNetwork, network: ModalNetwork, certificate: Certificate) -> float:
    """Largest error of the reduced network over evenly spaced lines of the band and, where it has a schedule, over its
    torques: another grid than the certificate's.
    """
    torques = [float(torque) for torque in network.schedule.torques] if network.schedule else [0.0]
    omega = 2.0 * np.pi * np.linspace(*certificate.band, _LINES)
    found = []
    for torque in torques:
        exact, small = complete.viscous().at_torque(torque), network.at_torque(torque)
        found.append(Comparison(exact, certificate.band).over(omega, small))
    return max(found)


def record_of(certificate: Certificate) -> bytes:
    """What the FMU remembers of its reduction, JSON."""
    return json.dumps(asdict(certificate), indent=1, sort_keys=True).encode()


def certificate_of(path: Path) -> Certificate | None:
    """The certificate that a reduced FMU carries; None of any other file. Raises InputError for a damaged one."""
    try:
        with zipfile.ZipFile(path) as archive:
            if RECORD not in archive.namelist():
                return None
            values = json.loads(archive.read(RECORD))
        pair, band = tuple(map(str, values.pop("pair"))), tuple(map(float, values.pop("band")))
        return Certificate(pair=(pair[0], pair[1]), band=(band[0], band[1]), **values)
    except (OSError, zipfile.BadZipFile):
        return None
    except (ValueError, TypeError, KeyError, IndexError, AttributeError) as error:
        raise InputError(f"{path}: {RECORD} cannot be read; export the FMU again") from error
