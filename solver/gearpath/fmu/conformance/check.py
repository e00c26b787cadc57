"""Runs every check on one file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from . import (
    archive,
    binaries,
    capabilities,
    declared,
    dependencies,
    derivatives,
    documents,
    files,
    identity,
    initials,
    names,
    running,
    sources,
    structure,
    terminals,
    units,
    values,
)
from .contents import FILE, Fmu
from .finding import Finding, Severity, error
from .reading import read, version_of

EDITION = error("fmi-edition", "The FMU is of FMI 2.0 or 3.0.", "2.2.1", "2.4.1")
INCOMPLETE = error("check-incomplete", "The checks themselves run to their end.")

STATIC: tuple[Callable[[Fmu], Iterator[Finding]], ...] = (
    identity.check,
    capabilities.check,
    units.check,
    declared.check,
    names.check,
    initials.check,
    values.check,
    derivatives.check,
    structure.check,
    dependencies.check,
    terminals.check,
    files.check,
    sources.check,
    binaries.check,
)
_MOST = 10  # findings of one rule that are told one by one


def check_conformance(path: str | Path, *, run: bool = True) -> tuple[Finding, ...]:
    """Everything in an FMU that breaks FMI 2.0 or 3.0, or that importers stumble over; empty for a good one.

    Works on the FMU of any tool, and on files that are none: whatever is wrong with the file is a finding, never an
    exception. With `run`, the binary of this machine is also loaded, in a process of its own: token, start values,
    directional derivatives against finite differences, declared dependencies against what moves. Raises
    MissingExtraError without lxml or fmpy.
    """
    try:
        with archive.Archive.open(Path(path)) as opened:
            return tuple(_shortened(_all(opened, run)))
    except archive.UnreadableError as problem:
        return (archive.UNREADABLE.found(None, f'"{path}" is no complete ZIP archive ({problem}); export it again'),)


def _all(opened: archive.Archive, run: bool) -> list[Finding]:
    found = list(archive.check(opened))
    unsafe = {archive.PATH.id, archive.LINK.id, archive.BOMB.id}.intersection(f.rule for f in found)
    root, broken = documents.parse(opened, documents.DESCRIPTION)
    found += broken
    if root is None:
        if documents.DESCRIPTION not in opened.names:
            message = f"{FILE} is not at the top of the archive; put it there"
            found.append(documents.MISSING.found(None, message))
        return found
    version = version_of(root)
    if version is None or root.tag != "fmiModelDescription":
        stated = f'<{root.tag} fmiVersion="{root.get("fmiVersion", "")}">'
        found.append(EDITION.found(None, f"{FILE} begins with {stated}; only FMI 2.0 and 3.0 are checked"))
        return found
    found += documents.schema_findings(documents.DESCRIPTION, root, version)
    others: dict[str, Any] = {}
    for name, other, broken in documents.others(opened, version):
        found += broken
        if other is not None:
            others[name] = other
            found += documents.schema_findings(name, other, version)
    fmu = read(opened, version, root, others)
    for check in STATIC:
        found += _guarded(check, fmu)
    if run and not unsafe:
        found += _guarded(running.check, fmu)
    return found


def _guarded(check: Callable[[Fmu], Iterable[Finding]], fmu: Fmu) -> list[Finding]:
    """A file that no check foresaw must not hide what the other checks find."""
    found: list[Finding] = []
    try:
        for finding in check(fmu):
            found.append(finding)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, OSError) as problem:
        where = check.__module__.rpartition(".")[2]
        message = f"the check of {where} stopped ({type(problem).__name__}: {problem}); report this with the file"
        found.append(INCOMPLETE.found(fmu.version, message))
    return found


def _shortened(found: list[Finding]) -> Iterator[Finding]:
    """At most ten findings of one rule, and one that counts the rest; errors first."""
    counts, told = Counter(f.rule for f in found), Counter[str]()
    order = list(Severity)
    for finding in sorted(found, key=lambda f: order.index(f.severity)):
        told[finding.rule] += 1
        if told[finding.rule] <= _MOST:
            yield finding
        elif told[finding.rule] == counts[finding.rule]:
            rest = counts[finding.rule] - _MOST
            yield Finding(finding.rule, finding.severity, f"and {rest} more of this kind", finding.clause)
