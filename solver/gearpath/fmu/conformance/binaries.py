"""Shared libraries: in the right folder, with the right name, for the right machine, with all functions."""

from __future__ import annotations

from collections.abc import Iterator

from .contents import Fmu
from .finding import Finding, error, warning
from .functions import required
from .platforms import Platform, of_other_edition, promised
from .symbols import read_library

FOLDER = error("platform-folder", "Folders of binaries/ have the names of their edition.", None, "2.5.1.4")
FOLDER_2 = warning("platform-unknown", "Folders of binaries/ have names that tools know.", "2.3", None)
MISSING = error("binary-missing", "Every platform has the library of every modelIdentifier.", "2.3", "2.5.1.4")
FORMAT = error("binary-format", "A library is for the platform of its folder.", "2.3", "2.5.1.4")
FUNCTIONS = error("binary-functions", "A library offers all functions of its interface types.", "2.3", "2.5")
LOOSE = warning("binary-loose", "Libraries lie in the folder of a platform.", "2.3", "2.5.1.4")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Every folder of binaries/, without loading anything."""
    names = fmu.archive.under("binaries")
    for name in names:
        if name.count("/") == 1:
            yield LOOSE.found(fmu.version, f"{name} is in no platform's folder; move it into one")
    for folder in sorted({name.split("/")[1] for name in names if name.count("/") > 1}):
        target = promised(fmu.version, folder)
        if target is None:
            other = of_other_edition(fmu.version, folder)
            remedy = f"rename it to {other}" if other else "use a name such as x86_64-linux"
            rule = FOLDER_2 if fmu.version == 2 else FOLDER
            yield rule.found(fmu.version, f"binaries/{folder} is no platform of FMI {fmu.version}; {remedy}")
        else:
            yield from _platform(fmu, folder, target)


def _platform(fmu: Fmu, folder: str, target: Platform) -> Iterator[Finding]:
    for identifier in fmu.identifiers:
        stem = f"binaries/{folder}/{identifier}"
        static = [f"{stem}.lib", f"{stem}.a", f"binaries/{folder}/lib{identifier}.a"]
        if stem + target.suffix in fmu.archive.names:
            yield from _library(fmu, stem + target.suffix, target, identifier)
        elif not fmu.archive.names.intersection(static):
            found = ", ".join(n.rpartition("/")[2] for n in fmu.archive.under(f"binaries/{folder}"))
            message = f"{stem}{target.suffix} is missing (there is {found}); name the library as modelIdentifier says"
            yield MISSING.found(fmu.version, message)


def _library(fmu: Fmu, name: str, target: Platform, identifier: str) -> Iterator[Finding]:
    library = read_library(fmu.archive.read(name) or b"")
    fits = library is not None and library.format == target.format
    if library is None or not fits or (target.machine is not None and target.machine not in library.machines):
        what = f"a {library.format} library of another machine" if library else "no shared library"
        message = f"{name} is {what} and not for {target.architecture} {target.system}; compile it for that"
        yield FORMAT.found(fmu.version, message)
        return
    offered = [kind for kind, e in fmu.interfaces.items() if e.get("modelIdentifier") == identifier]
    absent = sorted(required(fmu.version, offered) - library.functions)
    if absent:
        listed = ", ".join(absent[:5]) + (f" and {len(absent) - 5} more" if len(absent) > 5 else "")
        yield FUNCTIONS.found(
            fmu.version, f"{name} does not offer {listed}; export all functions of {' and '.join(offered)}"
        )
