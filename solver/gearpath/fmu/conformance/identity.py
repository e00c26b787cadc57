"""Who the FMU is: version, token, date, names, interface types, default experiment, log categories."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from datetime import datetime
from math import isfinite

from .contents import FILE, Fmu, real
from .finding import Finding, error, warning

VERSION = error("fmi-version", 'fmiVersion is exactly "2.0" or "3.0".', "2.2.1", "2.4.1")
TOKEN = error("token-empty", "guid (FMI 2) or instantiationToken (FMI 3) is not empty.", "2.2.1", "2.4.1")
NAME = error("model-name", "modelName is not empty.", "2.2.1", "2.4.1")
DATE = error("date", "generationDateAndTime , if given, is of the form YYYY-MM-DDThh:mm:ssZ.", "2.2.1", "2.4.1")
INTERFACE = error("interface-missing", "The FMU offers an interface type.", "2.2.1", "2.4.1")
IDENTIFIER = error("model-identifier", "modelIdentifier is a name of C.", "3.3.1, 4.3.1", "2.4.2")
TOOL = warning(
    "execution-tool", "needsExecutionTool says whether a tool is needed, and generationTool which.", "4.3.1", "2.4.2"
)
STEP = error("experiment-step", "stepSize of the default experiment is positive.", "2.2.5", "2.4.6")
STOP = error("experiment-stop", "The default experiment stops after it starts.", "2.2.5", "2.4.6")
TOLERANCE = error("experiment-tolerance", "tolerance of the default experiment is positive.", "2.2.5", "2.4.6")
EXPERIMENT = warning("experiment-missing", "There is a default experiment with a stop time.", "2.2.5", "2.4.6")
CATEGORY = error("log-category", "Log categories have names, each once.", "2.2.4", "2.4.5")

_KEYWORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while
"""


def check(fmu: Fmu) -> Iterator[Finding]:
    """The attributes of the root element and the small lists below it."""
    stated = str(fmu.root.get("fmiVersion", ""))
    if stated != f"{fmu.version}.0":
        message = f'{FILE}: fmiVersion is "{stated}"; write "{fmu.version}.0", also for its patch releases'
        yield VERSION.found(fmu.version, message)
    if not fmu.token.strip():
        attribute = "guid" if fmu.version == 2 else "instantiationToken"
        yield TOKEN.found(fmu.version, f"{FILE}: {attribute} is empty; give the one that the binary has")
    if not str(fmu.root.get("modelName", "")).strip():
        yield NAME.found(fmu.version, f"{FILE}: modelName is empty; name the model")
    yield from _date(fmu)
    yield from _interfaces(fmu)
    yield from _experiment(fmu)
    yield from _categories(fmu)


def _date(fmu: Fmu) -> Iterator[Finding]:
    date = fmu.root.get("generationDateAndTime")
    if date is None:
        return  # optional, and a reproducible file has none
    try:
        datetime.strptime(date, "%Y-%m-%dT%H:%M:%SZ")
        exact = re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", date) is not None
    except ValueError:
        exact = False
    if not exact:
        message = f'{FILE}: generationDateAndTime "{date}" is not of the form 2025-12-31T23:59:59Z; write it in UTC'
        yield DATE.found(fmu.version, message)


def _interfaces(fmu: Fmu) -> Iterator[Finding]:
    if not fmu.interfaces:
        yield INTERFACE.found(fmu.version, f"{FILE}: offers no interface type; add ModelExchange or CoSimulation")
    for kind, element in fmu.interfaces.items():
        name = element.get("modelIdentifier", "")
        if not re.fullmatch("[A-Za-z_][A-Za-z0-9_]*", name) or name in _KEYWORDS.split():
            message = f'{FILE}, {kind}: modelIdentifier "{name}" is no name of C; use letters, digits and _'
            yield IDENTIFIER.found(fmu.version, message)
        needs = element.get("needsExecutionTool", "false") in ("true", "1")
        if needs and not fmu.root.get("generationTool", "").strip():
            message = f"{FILE}, {kind}: needs a tool to run, but generationTool does not name it; name it there"
            yield TOOL.found(fmu.version, message)
        if not needs and any(name.endswith(".py") for name in fmu.archive.under("resources")):
            message = f"{FILE}, {kind}: resources/ holds Python modules; set needsExecutionTool to true"
            yield TOOL.found(fmu.version, message)


def _experiment(fmu: Fmu) -> Iterator[Finding]:
    element = fmu.root.find("DefaultExperiment")
    if element is None or element.get("stopTime") is None:
        yield EXPERIMENT.found(fmu.version, f"{FILE}: there is no default stop time; add a DefaultExperiment")
    if element is None:
        return
    start, stop = real(element.get("startTime", "0")), real(element.get("stopTime"))
    if start is not None and stop is not None and not (isfinite(start) and isfinite(stop) and stop > start):
        message = f"{FILE}, DefaultExperiment: stops at {stop:g} s and starts at {start:g} s; stop later"
        yield STOP.found(fmu.version, message)
    for attribute, rule in (("stepSize", STEP), ("tolerance", TOLERANCE)):
        value = real(element.get(attribute))
        if value is not None and not (isfinite(value) and value > 0.0):
            message = f"{FILE}, DefaultExperiment: {attribute} is {value:g}; give a positive one"
            yield rule.found(fmu.version, message)


def _categories(fmu: Fmu) -> Iterator[Finding]:
    names = Counter(element.get("name", "") for element in fmu.root.iterfind("LogCategories/Category"))
    for name, count in names.items():
        if count > 1:
            yield CATEGORY.found(fmu.version, f'{FILE}: log category "{name}" is there {count} times; keep one')
        if not name.strip():
            yield CATEGORY.found(fmu.version, f"{FILE}: a log category has no name; name it")
