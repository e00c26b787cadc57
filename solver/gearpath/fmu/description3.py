"""modelDescription.xml and buildDescription.xml of FMI 3.0."""

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from .description import (
    Identity,
    add_categories,
    add_experiment,
    add_units,
    as_file,
    is_initial_unknown,
    numbers,
    roles,
)
from .variables import Variable

_OVER_TIME = ("input", "output")  # what may be read or written within a step


def model_description3(variables: Sequence[Variable], identity: Identity) -> bytes:
    """The XML file of FMI 3.0: model exchange and co-simulation, arrays, all capabilities written out, no date."""
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=identity.name,
        instantiationToken=identity.guid,
        description=identity.description,
        generationTool=f"Gearpath {identity.version}",
        variableNamingConvention="structured",
    )
    common = {
        "modelIdentifier": identity.model_identifier,
        "needsExecutionTool": "false",
        "canBeInstantiatedOnlyOncePerProcess": "false",
        "canGetAndSetFMUState": "true",
        "canSerializeFMUState": "true",
        "providesDirectionalDerivatives": "true",
        "providesAdjointDerivatives": "true",
        "providesPerElementDependencies": "false",
        "providesEvaluateDiscreteStates": "false",
    }
    stepping = {
        "canHandleVariableCommunicationStepSize": "true",
        "maxOutputDerivativeOrder": "0",
        "providesIntermediateUpdate": "true",
        "mightReturnEarlyFromDoStep": "false",
        "canReturnEarlyAfterIntermediateUpdate": "false",
        "hasEventMode": "false",
    }
    ET.SubElement(root, "ModelExchange", {**common, "needsCompletedIntegratorStep": "false"})
    ET.SubElement(root, "CoSimulation", {**common, **stepping})
    add_units(root, variables, "Float64Type")
    add_categories(root)
    add_experiment(root, identity.experiment)
    _variables(root, variables)
    _structure(root, variables)
    return as_file(root)


def build_description(identity: Identity) -> bytes:
    """sources/buildDescription.xml: how the sources are compiled to the same numbers."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    build = ET.SubElement(root, "BuildConfiguration", modelIdentifier=identity.model_identifier)
    files = ET.SubElement(build, "SourceFileSet", language="C99", compilerOptions="-O2 -ffp-contract=off")
    for name in identity.sources:
        ET.SubElement(files, "SourceFile", name=name)
    return as_file(root)


def _variables(root: ET.Element, variables: Sequence[Variable]) -> None:
    parent = ET.SubElement(root, "ModelVariables")
    reference = {variable.name: i for i, variable in enumerate(variables)}
    for variable in variables:
        attributes = {
            "name": variable.name,
            "valueReference": str(reference[variable.name]),
            "description": variable.description,
            **roles(variable),
        }
        if variable.causality in _OVER_TIME:
            attributes["intermediateUpdate"] = "true"
        if variable.derivative_of is not None:
            attributes["derivative"] = str(reference[variable.derivative_of])
        element = ET.SubElement(parent, "Float64", {**attributes, **numbers(variable)})
        for length in variable.shape:
            ET.SubElement(element, "Dimension", start=str(length))


def _structure(root: ET.Element, variables: Sequence[Variable]) -> None:
    """Outputs, derivatives and initial unknowns, by value reference."""
    reference = {variable.name: i for i, variable in enumerate(variables)}
    structure = ET.SubElement(root, "ModelStructure")

    def add(element: str, variable: Variable, names: Sequence[str]) -> None:
        references = " ".join(str(i) for i in sorted(reference[name] for name in names))
        ET.SubElement(structure, element, valueReference=str(reference[variable.name]), dependencies=references)

    for variable in variables:
        if variable.causality == "output":
            add("Output", variable, variable.dependencies)
    for variable in variables:
        if variable.derivative_of is not None:
            add("ContinuousStateDerivative", variable, variable.dependencies)
    for variable in variables:
        if is_initial_unknown(variable):
            add("InitialUnknown", variable, variable.initial_dependencies)
