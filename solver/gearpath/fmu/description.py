"""modelDescription.xml of FMI 2.0."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass

from ..errors import InputError
from .variables import Kind, Variable

# SI base units (and rad) of the named units: exponents of kg, m, s, rad.
_EXPONENTS = {
    "1": {},
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Hz": {"s": -1},
}
# Shown instead of the SI unit by tools that can: display value = factor * value.
_DISPLAY = {
    "m": ("um", 1e6),
    "m/s": ("mm/s", 1e3),
    "W": ("mW", 1e3),
    "N/m": ("kN/mm", 1e-6),
}
_TOKEN = re.compile(r"\(|\)|\.|/|[A-Za-z1]+|-?\d+")
_LOG_CATEGORIES = {
    "logStatusError": "What went wrong, a sentence for each failure; always logged",
    "logEvents": "New discretisations, for a new step size or new parameters",
    "logAll": "All of these",
}


@dataclass(frozen=True)
class Experiment:
    """The default experiment, s."""

    start_time: float
    stop_time: float
    step_size: float


def unit_exponents(unit: str) -> dict[str, int]:
    """Exponents of the SI base units and rad of a unit such as "N.m/rad", "m/s2" or "(m/s)/(N.m)".

    A slash divides by the single factor or parenthesis behind it.
    """
    tokens, position = _TOKEN.findall(unit), 0

    def factor() -> dict[str, int]:
        nonlocal position
        token = tokens[position]
        position += 1
        if token == "(":
            inner = product()
            position += 1
            return inner
        base = _EXPONENTS[token]
        if position < len(tokens) and re.fullmatch(r"-?\d+", tokens[position]) and token != "1":
            power = int(tokens[position])
            position += 1
            return {name: power * exponent for name, exponent in base.items()}
        return dict(base)

    def product() -> dict[str, int]:
        nonlocal position
        result = factor()
        while position < len(tokens) and tokens[position] in "./":
            sign = 1 if tokens[position] == "." else -1
            position += 1
            for name, exponent in factor().items():
                result[name] = result.get(name, 0) + sign * exponent
        return result

    try:
        result = product()
    except (IndexError, KeyError) as error:
        raise InputError(f"the unit {unit!r} is not understood; use kg, m, s, rad, N, W and Hz") from error
    if position != len(tokens) or "".join(tokens) != unit:
        raise InputError(f"the unit {unit!r} is not understood; use a form such as N.m/rad or m/s2")
    return {name: result[name] for name in ("kg", "m", "s", "rad") if result.get(name)}


def model_description(
    variables: Sequence[Variable],
    *,
    name: str,
    model_identifier: str,
    description: str,
    guid: str,
    version: str,
    experiment: Experiment,
    sources: Sequence[str],
) -> bytes:
    """The XML file: co-simulation, all capabilities and dependencies written out, no date in it."""
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=name,
        guid=guid,
        description=description,
        generationTool=f"Gearpath {version}",
        variableNamingConvention="structured",
        numberOfEventIndicators="0",
    )
    slave = ET.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=model_identifier,
        needsExecutionTool="false",
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="true",
        maxOutputDerivativeOrder="0",
        canRunAsynchronuously="false",
        canBeInstantiatedOnlyOncePerProcess="false",
        canNotUseMemoryManagementFunctions="true",
        canGetAndSetFMUstate="false",
        canSerializeFMUstate="false",
        providesDirectionalDerivative="false",
    )
    files = ET.SubElement(slave, "SourceFiles")
    for file in sources:
        ET.SubElement(files, "File", name=file)
    _units(root, variables)
    categories = ET.SubElement(root, "LogCategories")
    for category, meaning in _LOG_CATEGORIES.items():
        ET.SubElement(categories, "Category", name=category, description=meaning)
    ET.SubElement(
        root,
        "DefaultExperiment",
        startTime=repr(experiment.start_time),
        stopTime=repr(experiment.stop_time),
        stepSize=repr(experiment.step_size),
    )
    _variables(root, variables)
    _structure(root, variables)
    ET.indent(root, " ")
    content: bytes = ET.tostring(root, encoding="UTF-8", xml_declaration=True)
    return content + b"\n"


def _units(root: ET.Element, variables: Sequence[Variable]) -> None:
    definitions = ET.SubElement(root, "UnitDefinitions")
    for unit in sorted({variable.unit for variable in variables}):
        element = ET.SubElement(definitions, "Unit", name=unit)
        exponents = {name: str(exponent) for name, exponent in unit_exponents(unit).items()}
        ET.SubElement(element, "BaseUnit", exponents)
        if unit in _DISPLAY:
            display, factor = _DISPLAY[unit]
            ET.SubElement(element, "DisplayUnit", name=display, factor=repr(factor))


def _variables(root: ET.Element, variables: Sequence[Variable]) -> None:
    parent = ET.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables):
        attributes = {
            "name": variable.name,
            "valueReference": str(reference),
            "description": variable.description,
            "causality": variable.causality,
            "variability": "tunable" if variable.causality == "parameter" else "continuous",
        }
        if variable.causality == "parameter":
            attributes["initial"] = "exact"
        if variable.causality == "output":
            attributes["initial"] = "calculated"
        real = {"unit": variable.unit}
        if variable.unit in _DISPLAY and variable.kind is not Kind.FRF_REAL and variable.kind is not Kind.FRF_IMAG:
            real["displayUnit"] = _DISPLAY[variable.unit][0]
        for attribute, value in (
            ("min", variable.minimum),
            ("max", variable.maximum),
            ("nominal", variable.nominal),
            ("start", variable.start),
        ):
            if value is not None:
                real[attribute] = repr(float(value))
        ET.SubElement(ET.SubElement(parent, "ScalarVariable", attributes), "Real", real)


def _structure(root: ET.Element, variables: Sequence[Variable]) -> None:
    """Outputs and initial unknowns; FMI 2 counts the variables from 1."""
    place = {variable.name: i for i, variable in enumerate(variables, start=1)}
    structure = ET.SubElement(root, "ModelStructure")
    for section in ("Outputs", "InitialUnknowns"):
        parent = ET.SubElement(structure, section)
        for variable in variables:
            if variable.causality != "output":
                continue
            names = variable.dependencies if section == "Outputs" else variable.initial_dependencies
            places = sorted(place[name] for name in names)
            ET.SubElement(parent, "Unknown", index=str(place[variable.name]), dependencies=" ".join(map(str, places)))
