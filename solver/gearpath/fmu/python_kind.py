"""The python FMU: the full solver inside pythonfmu, so that design parameters can be set too."""

import sys
import tempfile
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from importlib import metadata
from pathlib import Path

from ..errors import GearpathError, InputError, MissingExtraError
from ..network.assemble import assemble
from ..network.contained import self_contained
from ..network.measured import fitted_system
from ..network.system import System
from .description import Experiment, Identity, model_description
from .native import check_arguments, check_network, content_guid
from .package import write_fmu
from .python_bundle import bundle, model_source
from .python_documentation import documentation
from .python_table import entries, python_table
from .variables import Kind, Variable

_PLACEHOLDER = "{00000000-0000-0000-0000-000000000000}"
_STUB = """from pythonfmu import Fmi2Slave


class {name}(Fmi2Slave):
    def do_step(self, current_time, step_size):
        return True
"""
_OLDEST = (0, 7)  # of pythonfmu: earlier native parts look for the slave's class in another way
# What pythonfmu's native part can do (measured with 0.7.0), where it differs from the native kind.
_CAPABILITIES = {
    "needsExecutionTool": "true",
    "canInterpolateInputs": "false",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
    "providesDirectionalDerivative": "false",
}
_LOG_CATEGORIES = {
    "logStatusWarning": "Messages with the status warning",
    "logStatusDiscard": "Messages with the status discard",
    "logStatusError": "Why a step was refused, a sentence each",
    "logStatusFatal": "Why a value was refused, a sentence each",
    "logAll": "All messages",
}


def export_python(
    system: System,
    path: Path,
    *,
    model_identifier: str,
    description: str,
    frequency: float,
    start_time: float = 0.0,
    stop_time: float = 0.1,
    step_size: float = 1e-5,
    version: str,
    extra_files: Mapping[str, bytes] | None = None,
) -> Path:
    """Write the FMI 2.0 co-simulation FMU of `system` to `path`, for Linux and Windows; return the path.

    `frequency` (Hz) is the start value of the input of that name; times in s; `extra_files` go into the FMU
    under their names. The same arguments give the same bytes; the GUID is a hash of the content. What the FMU
    needs of its host is written in its documentation. A gear mesh source is left out: it is of the native kind.
    Measured components are in it as the modes of their fits, matrices as their modes.

    Raises:
        InputError: the system, a name or a time cannot be used.
        GearpathError: pythonfmu is too old, or not installed (MissingExtraError).
    """
    check_arguments(model_identifier, start_time, stop_time, step_size)
    base = _base_fmu(model_identifier)
    system = replace(self_contained(fitted_system(system)), source=None)
    network = assemble(system).modal().viscous()
    check_network(network)
    variables = python_table(system, network, frequency)
    experiment = Experiment(float(start_time), float(stop_time), float(step_size))

    def xml(guid: str) -> bytes:
        identity = Identity(network.name, model_identifier, description, guid, version, experiment, [])
        return _amended(model_description(variables, identity), variables)

    _, resources = bundle(
        model_source(system, entries(variables, network), frequency),
        {name.removeprefix("resources/pythonfmu/"): base[name] for name in base if "/pythonfmu/" in name},
        xml(_PLACEHOLDER),
    )
    files = {f"resources/{name}": content for name, content in resources.items()}
    files |= {name: content for name, content in base.items() if name.startswith("binaries/")}
    files["modelDescription.xml"] = xml(
        content_guid(*(part for name in sorted(files) for part in (name.encode(), files[name])))
    )
    files["documentation/licenses/pythonfmu.txt"] = _licence()
    _add(files, extra_files or {}, documentation(system.name, description, variables, _platforms(base)))
    return write_fmu(path, files)


def _base_fmu(identifier: str) -> dict[str, bytes]:
    """What pythonfmu's own builder makes of an empty slave: its binaries and its Python files."""
    try:
        from pythonfmu import FmuBuilder
    except ImportError as error:
        raise MissingExtraError("pythonfmu", "fmu") from error
    installed = metadata.version("pythonfmu")
    if tuple(int(part) for part in installed.split(".")[:2]) < _OLDEST:
        raise GearpathError(f'pythonfmu {installed} is too old; run: python -m pip install "pythonfmu>=0.7"')
    with tempfile.TemporaryDirectory(prefix="gearpath_") as name:
        folder = Path(name)
        stub = f"{folder.name}_stub"
        script = folder / f"{stub}.py"
        script.write_text(_STUB.format(name=f"Stub_{identifier}"), encoding="utf-8")
        path = list(sys.path)
        try:
            made = FmuBuilder.build_FMU(script, folder)
        finally:  # the builder imports the script and leaves its folder on the path
            sys.path[:] = path
            sys.modules.pop(stub, None)
            sys.path_importer_cache.pop(name, None)
        with zipfile.ZipFile(made) as archive:
            files = {entry: archive.read(entry) for entry in archive.namelist() if not entry.endswith("/")}
    return {
        name.replace(f"Stub_{identifier}", identifier): content.replace(b"\r\n", b"\n")
        if name.endswith(".py")
        else content
        for name, content in files.items()
    }


def _platforms(base: Mapping[str, bytes]) -> list[str]:
    return sorted(name.split("/")[1] for name in base if name.startswith("binaries/"))


def _licence() -> bytes:
    """pythonfmu's licence, as its wheel brings it along."""
    distribution = metadata.distribution("pythonfmu")
    for file in distribution.files or ():
        if file.name.upper().startswith("LICEN"):
            return file.read_binary().replace(b"\r\n", b"\n")
    return f"PythonFMU {distribution.version}, MIT licence, https://github.com/NTNU-IHB/PythonFMU\n".encode()


def _amended(content: bytes, variables: tuple[Variable, ...]) -> bytes:
    """The native kind's model description with the capabilities of pythonfmu and fixed design parameters."""
    root = ET.fromstring(content)
    tool = root.attrib["generationTool"]
    root.set("generationTool", f"{tool}, PythonFMU {metadata.version('pythonfmu')}")
    slave = root.find("CoSimulation")
    categories = root.find("LogCategories")
    table = root.find("ModelVariables")
    assert slave is not None
    assert categories is not None
    assert table is not None
    for attribute, value in _CAPABILITIES.items():
        slave.set(attribute, value)
    for sources in slave.findall("SourceFiles"):
        slave.remove(sources)
    categories.clear()
    for name, meaning in _LOG_CATEGORIES.items():
        ET.SubElement(categories, "Category", name=name, description=meaning)
    for element, variable in zip(table, variables):
        if variable.kind == Kind.DESIGN:
            element.set("variability", "fixed")
            element[0].attrib.pop("displayUnit", None)
    ET.indent(root, " ")
    text: bytes = ET.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text + b"\n"


def _add(files: dict[str, bytes], extra: Mapping[str, bytes], page: bytes) -> None:
    """Add the caller's files and the page on the python kind, beside an index.html of the caller's."""
    for name, content in extra.items():
        if name in files or name.startswith("/") or "\\" in name or ".." in name.split("/"):
            raise InputError(f"{name!r} cannot be added to the FMU; it exists already or is no relative path")
        files[name] = content
    own = "documentation/index.html"
    files[own if own not in files else "documentation/python.html"] = page
