"""Names of the folders below binaries/, and what lies in them."""

from __future__ import annotations

import platform
import re
from dataclasses import dataclass

_NAMES_2 = {
    "linux32": ("x86", "linux"),
    "linux64": ("x86_64", "linux"),
    "win32": ("x86", "windows"),
    "win64": ("x86_64", "windows"),
    "darwin32": ("x86", "darwin"),
    "darwin64": ("x86_64", "darwin"),
}
_ARCHITECTURES = ["aarch32", "aarch64", "riscv32", "riscv64", "x86", "x86_64", "ppc32", "ppc64", "i386", "i586", "i686"]
_TUPLE = re.compile(rf"({'|'.join(_ARCHITECTURES)})-(darwin|linux|windows)(-[a-z]+[0-9]*[a-z]*)?")
_FORMAT = {"linux": "elf", "windows": "pe", "darwin": "macho"}
_SUFFIX = {"linux": ".so", "windows": ".dll", "darwin": ".dylib"}
_MACHINE = {
    "elf": {"x86": 3, "x86_64": 62, "aarch32": 40, "aarch64": 183, "riscv32": 243, "riscv64": 243},
    "pe": {"x86": 0x14C, "x86_64": 0x8664, "aarch64": 0xAA64},
    "macho": {"x86": 7, "x86_64": 0x01000007, "aarch64": 0x0100000C},
}


@dataclass(frozen=True)
class Platform:
    """What a folder name promises."""

    architecture: str
    system: str

    @property
    def suffix(self) -> str:
        """Of shared libraries."""
        return _SUFFIX[self.system]

    @property
    def format(self) -> str:
        """Of shared libraries: elf, pe or macho."""
        return _FORMAT[self.system]

    @property
    def machine(self) -> int | None:
        """Number of the architecture in that format."""
        return _MACHINE[self.format].get(self.architecture)


def promised(version: int, folder: str) -> Platform | None:
    """What the name of a folder means; None where the edition does not have it.

    FMI 2 lets vendors add names, and those of FMI 3 are what they add.
    """
    if version == 2 and folder in _NAMES_2:
        return Platform(*_NAMES_2[folder])
    match = _TUPLE.fullmatch(folder)
    if match is None:
        return None
    return Platform(re.sub("i[356]86", "x86", match[1]), match[2])


def of_other_edition(version: int, folder: str) -> str:
    """The name that FMI 3 has for a folder of FMI 2, or nothing."""
    found = _NAMES_2.get(folder)
    return f"{found[0]}-{found[1]}" if version == 3 and found else ""


def of_host(version: int) -> list[str]:
    """Folders that this machine can run, best first."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    system = platform.system().lower()
    old = [name for name, found in _NAMES_2.items() if found == (machine, system)]
    return (old if version == 2 else []) + [f"{machine}-{system}"]
