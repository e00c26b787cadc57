"""modelDescription.xml of FMI 2.0, and what both versions of FMI share."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .units import DISPLAY, FACTORS, TYPES, unit_exponents
from .variables import Kind, Variable

LOG_CATEGORIES = {
    "logStatusError": "What went wrong, a sentence for each failure; always logged",
    "logEvents": "New discretisations, for a new step size or new parameters",
    "logAll": "All of these",
}
_TRANSFERS = (Kind.FRF_REAL, Kind.FRF_IMAG)
_CALCULATED = ("output", "local", "calculatedParameter")  # where there is no start value


@dataclass(frozen=True)
class Experiment:
    """The default experiment, s."""

    start_time: float
    stop_time: float
    step_size: float


@dataclass(frozen=True)
class Identity:
    """What a model description says beside its variables."""

    name: str
    model_identifier: str
    description: str
    guid: str
    version: str  # of Gearpath
    experiment: Experiment
    sources: Sequence[str]  # C files in sources/


def model_description(variables: Sequence[Variable], identity: Identity) -> bytes:
    """The XML file of FMI 2.0: all capabilities and dependencies written out, no date in it.

    Model exchange is offered by what is compiled, which has sources.
    """
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=identity.name,
        guid=identity.guid,
        description=identity.description,
        generationTool=f"Gearpath {identity.version}",
        variableNamingConvention="structured",
        numberOfEventIndicators="0",
    )
    _interfaces(root, identity, exchange=bool(identity.sources))
    add_units(root, variables, "SimpleType")
    add_categories(root)
    add_experiment(root, identity.experiment)
    _variables(root, variables)
    _structure(root, variables)
    return as_file(root)


def _interfaces(root: ET.Element, identity: Identity, *, exchange: bool) -> None:
    common = {
        "modelIdentifier": identity.model_identifier,
        "needsExecutionTool": "false",
        "canBeInstantiatedOnlyOncePerProcess": "false",
        "canNotUseMemoryManagementFunctions": "true",
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
        "providesDirectionalDerivative": "true",
    }
    stepping = {
        "canHandleVariableCommunicationStepSize": "true",
        "canInterpolateInputs": "true",
        "maxOutputDerivativeOrder": "0",
        "canRunAsynchronuously": "false",
    }
    kinds = [ET.SubElement(root, "CoSimulation", {**common, **stepping})]
    if exchange:
        element = ET.Element("ModelExchange", {**common, "completedIntegratorStepNotNeeded": "true"})
        root.insert(0, element)
        kinds.insert(0, element)
    for kind in kinds:
        files = ET.SubElement(kind, "SourceFiles")
        for file in identity.sources:
            ET.SubElement(files, "File", name=file)


def add_units(root: ET.Element, variables: Sequence[Variable], element: str) -> None:
    """UnitDefinitions, and TypeDefinitions with elements of the name that the version of FMI has for them."""
    units = sorted({variable.unit for variable in variables if variable.unit is not None})
    definitions = ET.SubElement(root, "UnitDefinitions")
    for unit in units:
        parent = ET.SubElement(definitions, "Unit", name=unit)
        exponents = {name: str(exponent) for name, exponent in unit_exponents(unit).items()}
        if unit in FACTORS:
            exponents["factor"] = repr(FACTORS[unit])
        ET.SubElement(parent, "BaseUnit", exponents)
        if unit in DISPLAY:
            display, factor = DISPLAY[unit]
            ET.SubElement(parent, "DisplayUnit", name=display, factor=repr(factor))
    used = {variable.unit for variable in variables if declared_type(variable)}
    types = ET.SubElement(root, "TypeDefinitions")
    for unit, (name, quantity) in TYPES.items():
        if unit not in used:
            continue
        attributes = {"quantity": quantity, "unit": unit}
        if unit in DISPLAY:
            attributes["displayUnit"] = DISPLAY[unit][0]
        if element == "SimpleType":
            ET.SubElement(ET.SubElement(types, element, name=name), "Real", attributes)
        else:
            ET.SubElement(types, element, {"name": name, **attributes})
    for section in (definitions, types):
        if not len(section):
            root.remove(section)


def declared_type(variable: Variable) -> str | None:
    """Name of the type of a variable: none for transfers and power ratios."""
    if variable.unit is None or variable.kind in _TRANSFERS:
        return None
    return TYPES[variable.unit][0] if variable.unit in TYPES else None


def add_categories(root: ET.Element) -> None:
    """What can be logged."""
    categories = ET.SubElement(root, "LogCategories")
    for category, meaning in LOG_CATEGORIES.items():
        ET.SubElement(categories, "Category", name=category, description=meaning)


def add_experiment(root: ET.Element, experiment: Experiment) -> None:
    """The default experiment."""
    times = (experiment.start_time, experiment.stop_time, experiment.step_size)
    ET.SubElement(root, "DefaultExperiment", dict(zip(("startTime", "stopTime", "stepSize"), map(repr, times))))


def as_file(root: ET.Element) -> bytes:
    """The bytes of an XML file, indented."""
    ET.indent(root, " ")
    content: bytes = ET.tostring(root, encoding="UTF-8", xml_declaration=True)
    return content + b"\n"


def roles(variable: Variable) -> dict[str, str]:
    """Causality, variability and initial: the combinations that both versions of FMI allow."""
    attributes: dict[str, str] = {"causality": variable.causality}
    tunable = variable.causality in ("parameter", "calculatedParameter")
    attributes["variability"] = "tunable" if tunable else "continuous"
    if variable.causality == "parameter" or (variable.causality == "local" and variable.start is not None):
        attributes["initial"] = "exact"
    elif variable.causality in _CALCULATED:
        attributes["initial"] = "calculated"
    return attributes


def numbers(variable: Variable) -> dict[str, str]:
    """Declared type, unit, displayed unit, range, nominal and start value."""
    attributes = {}
    kind = declared_type(variable)
    if kind is not None:
        attributes["declaredType"] = kind
    if variable.unit is not None:
        attributes["unit"] = variable.unit
        if variable.unit in DISPLAY and variable.kind not in _TRANSFERS:
            attributes["displayUnit"] = DISPLAY[variable.unit][0]
    for attribute, value in (("min", variable.minimum), ("max", variable.maximum), ("nominal", variable.nominal)):
        if value is not None:
            attributes[attribute] = repr(float(value))
    start = variable.start
    if start is not None:
        values = start if isinstance(start, tuple) else (start,)
        attributes["start"] = " ".join(repr(float(value)) for value in values)
    return attributes


def is_initial_unknown(variable: Variable) -> bool:
    """Whether it is listed as such: outputs, calculated parameters and derivatives."""
    return variable.causality in ("output", "calculatedParameter") or variable.derivative_of is not None


def _variables(root: ET.Element, variables: Sequence[Variable]) -> None:
    parent = ET.SubElement(root, "ModelVariables")
    place = {variable.name: i for i, variable in enumerate(variables, start=1)}
    for reference, variable in enumerate(variables):
        attributes = {"name": variable.name, "valueReference": str(reference), "description": variable.description}
        element = ET.SubElement(parent, "ScalarVariable", {**attributes, **roles(variable)})
        real = numbers(variable)
        if variable.derivative_of is not None:
            real["derivative"] = str(place[variable.derivative_of])
        ET.SubElement(element, "Real", real)


def _structure(root: ET.Element, variables: Sequence[Variable]) -> None:
    """Outputs, derivatives and initial unknowns; FMI 2 counts the variables from 1."""
    place = {variable.name: i for i, variable in enumerate(variables, start=1)}
    structure = ET.SubElement(root, "ModelStructure")
    sections: Mapping[str, Sequence[Variable]] = {
        "Outputs": [v for v in variables if v.causality == "output"],
        "Derivatives": [v for v in variables if v.derivative_of is not None],
        "InitialUnknowns": [v for v in variables if is_initial_unknown(v)],
    }
    for section, unknowns in sections.items():
        if not unknowns:
            continue
        parent = ET.SubElement(structure, section)
        for variable in unknowns:
            names = variable.initial_dependencies if section == "InitialUnknowns" else variable.dependencies
            places = sorted(place[name] for name in names)
            ET.SubElement(parent, "Unknown", index=str(place[variable.name]), dependencies=" ".join(map(str, places)))
