"""The native FMU: a generic C runtime, and the model as data."""

import hashlib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..network.modal import ModalNetwork
from . import runtime_files
from .binary import model_file, payload
from .description import Experiment, Identity, model_description
from .description3 import build_description, model_description3
from .documentation import BAND
from .native_table import native_table
from .package import write_fmu
from .scheduled import check_matrix, check_schedule
from .supplements import supplements
from .variables import Variable

_PLACEHOLDER = "{00000000-0000-0000-0000-000000000000}"


def export_native(
    network: ModalNetwork,
    path: Path,
    *,
    model_identifier: str,
    description: str,
    frequency: float,
    start_time: float = 0.0,
    stop_time: float = 0.1,
    step_size: float = 1e-5,
    version: str,
    fmi: str = "2.0",
    documentation: bool | None = None,
    band: tuple[float, float] = BAND,
    extra_files: Mapping[str, bytes] | None = None,
) -> Path:
    """Write the FMU of `network` to `path`, model exchange and co-simulation, for all platforms; return the path.

    The joints of a schedule begin with its matrices.
    `frequency` (Hz) is the start value of the input of that name; times in s; `fmi` is "2.0" or "3.0".
    `documentation`: with plots and reference results (True), a page, terminals and icons only (False), or nothing of
    the kind (None); the plots begin and end where `band` does (Hz). `extra_files` go into the FMU
    under their names. The same arguments give the same bytes; the GUID is a hash of model and description.

    Raises:
        InputError: the network, a name or a time cannot be used.
        GearpathError: the compiled runtime is missing.
    """
    check_arguments(model_identifier, start_time, stop_time, step_size)
    check_network(network)
    if network.schedule is not None:
        network = network.at_torque(network.schedule.first)
    variables = native_table(network, frequency, fmi)
    experiment = Experiment(float(start_time), float(stop_time), float(step_size))
    files = core_files(
        variables,
        payload(network, variables, frequency),
        fmi,
        name=network.name,
        model_identifier=model_identifier,
        description=description,
        version=version,
        experiment=experiment,
    )
    if documentation is not None:
        files |= supplements(
            network,
            variables,
            fmi,
            description=description,
            version=version,
            experiment=experiment,
            documentation=documentation,
            reference=documentation,
            band=band,
        )
    for name, extra in (extra_files or {}).items():
        if name in files or name.startswith("/") or "\\" in name or ".." in name.split("/"):
            raise InputError(f"{name!r} cannot be added to the FMU; it exists already or is no relative path")
        files[name] = extra
    return write_fmu(path, files)


def core_files(
    variables: Sequence[Variable],
    content: bytes,
    fmi: str,
    *,
    name: str,
    model_identifier: str,
    description: str,
    version: str,
    experiment: Experiment,
) -> dict[str, bytes]:
    """What makes an FMU run: description, data (`content` is model.bin behind its header), binaries and sources.

    The GUID is a hash of model and description.
    """
    sources = runtime_files.sources(fmi)
    identity = Identity(
        name=name,
        model_identifier=model_identifier,
        description=description,
        guid=_PLACEHOLDER,
        version=version,
        experiment=experiment,
        sources=[file for file in sorted(sources) if file.endswith(".c")],
    )
    xml = model_description3(variables, identity) if fmi == "3.0" else model_description(variables, identity)
    guid = content_guid(content, xml)
    files = {
        "modelDescription.xml": xml.replace(_PLACEHOLDER.encode(), guid.encode(), 1),
        "resources/model.bin": model_file(guid, content),
        "documentation/licenses/license.txt": runtime_files.licence(),
        **{f"sources/{file}": text for file, text in sources.items()},
        **{
            f"binaries/{folder}/{model_identifier}{extension}": library
            for (folder, extension), library in runtime_files.binaries(fmi).items()
        },
    }
    if fmi == "3.0":
        files["sources/buildDescription.xml"] = build_description(identity)
    return files


def check_arguments(identifier: str, start: float, stop: float, step: float) -> None:
    """Refuse a model identifier or an experiment that no FMU can have."""
    if not re.fullmatch(r"[A-Za-z_]\w*", identifier, re.ASCII):
        raise InputError(f"the model identifier {identifier!r} is not a C name; use letters, digits and underscores")
    if not (np.isfinite([start, stop, step]).all() and start < stop and step > 0):
        raise InputError(
            f"start {start} s, stop {stop} s and step {step} s are no experiment; "
            "start must lie before stop, and the step be positive"
        )


def content_guid(*parts: bytes) -> str:
    """A GUID that is a hash of the content, {8-4-4-4-12} hexadecimal digits."""
    digest = hashlib.sha256(b"".join(hashlib.sha256(part).digest() for part in parts)).hexdigest()
    return "{" + "-".join((digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32])) + "}"


def check_network(network: ModalNetwork) -> None:
    """Refuse what the runtime could not compute."""
    if not network.joints or not network.loads:
        raise InputError(f"{network.name}: an FMU needs at least one joint and one load")
    if (network.eigenvalues < 0).any():
        raise InputError(f"{network.name}: an eigenvalue is negative, so that the model is unstable")
    for name, ratio in network.modal_damping.items():
        if not 0 <= ratio < 1:
            raise InputError(f"{name}.modal_damping: {ratio} is no damping ratio; give at least 0 and less than 1")
    for joint in network.joints:
        for what, matrix in (("stiffness", joint.stiffness), ("damping", joint.damping)):
            check_matrix(f"{joint.name}.{what}", matrix)
    check_schedule(network)
    # The acceleration of a row that a mesh moves directly (row . X d) would need the derivative of the input.
    frequencies = np.sqrt(network.eigenvalues)
    for output in network.outputs:
        if output.quantity != "acceleration" or output.row is None:
            continue
        for load in network.loads:
            if load.mesh_displacement is None:
                continue
            for component in network.modal_damping:
                terms = output.row * frequencies * load.mesh_displacement * network.damping_share(component)
                if abs(terms.sum()) > 1e-9 * np.abs(terms).sum():
                    raise InputError(
                        f"{output.name}: this acceleration depends on the derivative of {load.name}, which "
                        "an FMU does not get; observe its velocity, or the acceleration of another component"
                    )
