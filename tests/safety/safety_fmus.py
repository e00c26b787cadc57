"""The small networks and linear systems as unpacked FMUs, and what a C host is told about one."""

import zipfile
from dataclasses import dataclass
from pathlib import Path

from safety_networks import networks, systems

from gearpath.fmu.linear_export import export_linear
from gearpath.fmu.linear_table import linear_table
from gearpath.fmu.native import export_native
from gearpath.fmu.native_table import native_table
from gearpath.fmu.variables import Kind, Variable

FREQUENCY = 500.0  # Hz


@dataclass(frozen=True)
class SmallFmu:
    """One of them."""

    name: str
    fmi: str  # "2.0" or "3.0"
    folder: Path  # unpacked
    variables: tuple[Variable, ...]
    states: int

    @property
    def model(self) -> bytes:
        """model.bin."""
        return (self.folder / "resources" / "model.bin").read_bytes()

    @property
    def guid(self) -> str:
        """What the binary checks."""
        return self.model[32:72].rstrip(b"\0").decode()

    def host_arguments(self) -> list[str]:
        """RESOURCES GUID STATES VARIABLES for the hosts in host/."""
        resources = self.folder / "resources"
        listing = self.folder / "variables.txt"
        listing.write_text("".join(f"{_role(v)} {i} {_size(v)}\n" for i, v in enumerate(self.variables)))
        return [resources.as_uri(), self.guid, str(self.states), str(listing)]


def export_all(folder: Path) -> list[SmallFmu]:
    """Every small network and linear system in both versions of FMI, in folders of their own below `folder`."""
    found = []
    for name, network in networks().items():
        for fmi in ("2.0", "3.0"):
            place = folder / f"{name}_{fmi[0]}"
            place.mkdir(parents=True)
            path = export_native(
                network,
                place / "it.fmu",
                model_identifier="it",
                description="",
                frequency=FREQUENCY,
                version="0",
                fmi=fmi,
            )
            states = 2 * len(network.eigenvalues) + (network.source is not None)
            found.append(_unpacked(name, fmi, path, native_table(network, FREQUENCY, fmi), states))
    for name, system in systems().items():
        for fmi in ("2.0", "3.0"):
            place = folder / f"{name}_{fmi[0]}"
            place.mkdir(parents=True)
            path = export_linear(system, place / "it.fmu", fmi=fmi, version="0", documentation=False)
            found.append(_unpacked(name, fmi, path, linear_table(system, fmi), len(system.states)))
    return found


def _unpacked(name: str, fmi: str, path: Path, variables: tuple[Variable, ...], states: int) -> SmallFmu:
    with zipfile.ZipFile(path) as archive:
        archive.extractall(path.parent)
    return SmallFmu(name, fmi, path.parent, variables, states)


def _role(variable: Variable) -> str:
    if variable.causality in ("input", "parameter"):
        return variable.causality[0]
    return "o" if variable.causality == "output" or variable.kind in (Kind.DERIVATIVE, Kind.DERIVATIVES) else "x"


def _size(variable: Variable) -> int:
    size = 1
    for length in variable.shape:
        size *= length
    return size
