"""Terminals and icons (FMI 3, and FMI 2 that borrows them)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from .contents import Fmu, real
from .documents import TERMINALS
from .finding import Finding, error, warning

VERSION = error("terminals-version", "fmiVersion is that of the FMU, or 3.0 in an FMU of FMI 2.", "2.3", "2.4.9")
NAME = error("terminal-name", "No two terminals on one level have the same name.", "2.3", "2.4.9.2")
VARIABLE = error("terminal-variable", "Members are variables of the FMU.", "2.3", "2.4.9.2")
CAUSALITY = error("terminal-causality", "Members are inputs, outputs or parameters.", "2.3", "2.4.9.2")
MEMBER = error("terminal-member", "Members of a plug or a bus have names, each once.", "2.3", "2.4.9.2")
MATCHING = error("terminal-matching", "matchingRule is plug, bus, sequence or a reverse domain name.", "2.3", "2.4.9.2")
STREAM = error("terminal-stream", "A terminal with streams has one flow.", "2.3", "2.4.9.2")
PICTURE = error("terminal-icon", "The PNG of every terminal is there.", "2.3", "2.4.9.2")
ICON = warning("icon-missing", "The icon that is placed is there.", "2.3", "2.4.9.1")
EXTENT = error("icon-extent", "The coordinate system spans from lower left to upper right.", "2.3", "2.4.9.1")

_ALLOWED = ("input", "output", "parameter", "calculatedParameter")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Graphics, then every terminal with those inside it."""
    root = fmu.documents.get(TERMINALS)
    if root is None:
        return
    stated, wanted = root.get("fmiVersion", ""), fmu.root.get("fmiVersion") if fmu.version == 3 else "3.0"
    if stated != wanted and not (fmu.version == 2 and stated.startswith("3.")):
        yield VERSION.found(fmu.version, f'{TERMINALS}: fmiVersion is "{stated}"; write "{wanted}"')
    system = root.find("GraphicalRepresentation/CoordinateSystem")
    if system is not None:
        x1, y1, x2, y2 = (real(system.get(name)) for name in ("x1", "y1", "x2", "y2"))
        if None not in (x1, y1, x2, y2) and not (x1 < x2 and y1 < y2):  # type: ignore[operator]
            yield EXTENT.found(fmu.version, f"{TERMINALS}: the coordinate system has no area; make x1 < x2 and y1 < y2")
    placed = root.find("GraphicalRepresentation/Icon") is not None
    if placed and "terminalsAndIcons/icon.png" not in fmu.archive.names:
        yield ICON.found(fmu.version, f"{TERMINALS}: places an icon, but terminalsAndIcons/icon.png is missing; add it")
    top = root.find("Terminals")
    if top is not None:
        yield from _level(fmu, top, "")


def _level(fmu: Fmu, parent: Any, path: str) -> Iterator[Finding]:
    terminals = list(parent.iterchildren("Terminal"))
    for name, count in Counter(t.get("name", "") for t in terminals).items():
        if count > 1:
            yield NAME.found(fmu.version, f'{TERMINALS}: {count} terminals are named "{path}{name}"; rename one')
    for terminal in terminals:
        name = path + terminal.get("name", "")
        yield from _terminal(fmu, terminal, f'{TERMINALS}, terminal "{name}" (line {terminal.sourceline})')
        yield from _level(fmu, terminal, f"{name}.")


def _terminal(fmu: Fmu, terminal: Any, place: str) -> Iterator[Finding]:
    rule = terminal.get("matchingRule", "")
    if rule not in ("plug", "bus", "sequence") and "." not in rule:
        yield MATCHING.found(fmu.version, f'{place}: matchingRule "{rule}" does not exist; use plug, bus or sequence')
    members = list(terminal.iterchildren("TerminalMemberVariable"))
    streams = list(terminal.iterchildren("TerminalStreamMemberVariable"))
    if rule in ("plug", "bus"):
        for member, count in Counter(m.get("memberName", "") for m in members).items():
            if count > 1 or not member:
                yield MEMBER.found(fmu.version, f'{place}: {count} members are named "{member}"; name each of them')
    flows = [m for m in members if m.get("variableKind") in ("inflow", "outflow")]
    if streams and len(flows) != 1:
        yield STREAM.found(fmu.version, f"{place}: has streams and {len(flows)} flows; keep one flow")
    names = [m.get("variableName", "") for m in members]
    names += [s.get(f"{side}StreamVariableName", "") for s in streams for side in ("in", "out")]
    for name in names:
        variable = fmu.by_name.get(name)
        if variable is None:
            yield VARIABLE.found(fmu.version, f'{place}: its member "{name}" is no variable; correct the name')
        elif variable.causality not in _ALLOWED:
            message = f'{place}: its member "{name}" is a {variable.causality}; use inputs, outputs and parameters'
            yield CAUSALITY.found(fmu.version, message)
    for drawn in terminal.iterchildren("TerminalGraphicalRepresentation"):
        picture = f"terminalsAndIcons/{drawn.get('iconBaseName', '').removeprefix('./')}.png"
        if picture not in fmu.archive.names:
            yield PICTURE.found(fmu.version, f"{place}: {picture} is missing; add it")
