"""Faults in attributes, units, types, names and values."""

from conformance_faults import FORCE, INPUT, OUT_REAL, OUTPUT, REAL, ROOT, STATE, of, put
from conformance_trees import MD, add, attributes, both, remove, replaced, share, twice, written

# identity
put("patch version", "2 3", "fmi-version", {b: attributes(ROOT, fmiVersion=f"{b}.0.1") for b in "23"})
put("version 1", "2", "fmi-edition", attributes(ROOT, fmiVersion="1.0"))
put("date without Z", "2 3", "date", attributes(ROOT, generationDateAndTime="2025-01-31T12:00:00"))
put("date of no calendar", "3", "date", attributes(ROOT, generationDateAndTime="2025-02-30T12:00:00Z"))
put("date with offset", "2", "date", attributes(ROOT, generationDateAndTime="2025-01-31T12:00:00+01:00"))
put("no token", "2 3", "token-empty", {"2": attributes(ROOT, guid=""), "3": attributes(ROOT, instantiationToken=" ")})
put("no model name", "2", "model-name", attributes(ROOT, modelName=""))
put("identifier with a space", "2", "model-identifier", attributes("//CoSimulation", modelIdentifier="gear box"))
put("identifier from a digit", "3", "model-identifier", attributes("//ModelExchange", modelIdentifier="3gear"))
put("identifier a keyword", "3", "model-identifier", attributes("//CoSimulation", modelIdentifier="double"))
put("no interface", "2", "interface-missing", both(remove("//ModelExchange"), remove("//CoSimulation")))
put(
    "tool without name",
    "2",
    "execution-tool",
    both(attributes("//CoSimulation", needsExecutionTool="true"), attributes(ROOT, generationTool=None)),
)
put("Python without tool", "3", "execution-tool", written("resources/model.py"))
put("stop before start", "2 3", "experiment-stop", attributes("//DefaultExperiment", startTime="1", stopTime="0.5"))
put("stop at start", "3", "experiment-stop", attributes("//DefaultExperiment", startTime="1", stopTime="1"))
put("negative step", "2 3", "experiment-step", attributes("//DefaultExperiment", stepSize="-1e-5"))
put("zero step", "2", "experiment-step", attributes("//DefaultExperiment", stepSize="0"))
put("zero tolerance", "3", "experiment-tolerance", attributes("//DefaultExperiment", tolerance="0"))
put("no experiment", "2", "experiment-missing", remove("//DefaultExperiment"))
put("category twice", "2 3", "log-category", twice("//Category"))

# capabilities
put(
    "serialize alone",
    "2 3",
    "capability-serialize",
    {
        "2": attributes("//CoSimulation", canGetAndSetFMUstate="false"),
        "3": attributes("//ModelExchange", canGetAndSetFMUState=None),
    },
)
put("flag of FMI 2 in FMI 3", "3", "capability-spelling", attributes("//CoSimulation", canGetAndSetFMUstate="true"))
put(
    "derivative flag of FMI 2 in FMI 3",
    "3",
    "capability-spelling",
    attributes("//ModelExchange", providesDirectionalDerivative="true"),
)
put("flag of FMI 3 in FMI 2", "2", "xml-schema", attributes("//CoSimulation", canGetAndSetFMUState="true"))
put(
    "early return without updates",
    "rich",
    "capability-early-return",
    attributes("//CoSimulation", providesIntermediateUpdate="false"),
)
put("internal step", "rich", "internal-step", attributes("//CoSimulation", fixedInternalStepSize="-1"))
put("event indicators", "2", "event-indicators", attributes(ROOT, numberOfEventIndicators="-1"))
put("parameter in updates", "rich", "intermediate-update", attributes("//*[@name='A']", intermediateUpdate="true"))
put(
    "update of none",
    "rich",
    "intermediate-update-unused",
    attributes("//CoSimulation", providesIntermediateUpdate=None, canReturnEarlyAfterIntermediateUpdate=None),
)
put("multiple set of an output", "2 3", "multiple-set", of(OUTPUT, canHandleMultipleSetPerTimeInstant="true"))

# units and types
put("unit twice", "2 3", "unit-duplicate", twice("//Unit[@name='N']"))
put("unit without name", "3", "unit-name", attributes("//Unit[@name='Hz']", name=""))
put("display unit twice", "2 3", "display-unit-duplicate", twice("//DisplayUnit"))
put("factor 0", "2", "unit-factor", attributes("//DisplayUnit", factor="0"))
put("exponent", "2 3", "unit-meaning", attributes("//Unit[@name='N']/BaseUnit", s="-1"))
put("display factor", "3", "unit-meaning", attributes("//DisplayUnit[@name='um']", factor="1000"))
put("no base unit", "2", "unit-base", remove("//Unit[@name='W']/BaseUnit"))
put("inverse with offset", "rich", "unit-inverse", attributes("//DisplayUnit[@inverse]", offset="1"))
put(
    "unit undefined",
    "2 3",
    "unit-undefined",
    of(OUT_REAL, unit="furlong", displayUnit=None)
    | {"2": attributes(OUT_REAL["2"], unit="furlong"), "3": attributes(OUT_REAL["3"], unit="furlong")},
)
put("unit of a type undefined", "rich", "unit-undefined", attributes("//Float64Type", unit="furlong"))
put("display unit undefined", "2 3", "display-unit-undefined", of(OUT_REAL, displayUnit="lbf"))
put("display unit of an alias", "rich", "display-unit-undefined", attributes("//Alias", displayUnit="inch"))
put("type twice", "3", "type-duplicate", twice("//TypeDefinitions/*"))
put("type named as a variable", "rich", "type-variable-name", attributes("//Float64Type", name="y"))
put("type undefined", "2 3", "type-undefined", of(OUT_REAL, declaredType="Nothing"))
put("type of another kind", "rich", "type-kind", attributes("//*[@name='gear']", declaredType="Length"))
put("item twice", "rich", "type-item", attributes("//Item[2]", value="1"))
put("start is no item", "rich", "enumeration-start", attributes("//*[@name='gear']", start="3"))

# names and references
put(
    "name twice",
    "2 3",
    "variable-name-duplicate",
    {
        "2": attributes("(//ScalarVariable)[2]", name="mesh.transmission_error"),
        "3": attributes("//Float64[2]", name="mesh.transmission_error"),
    },
)
put("alias twice", "rich", "variable-name-duplicate", attributes("//Alias", name="y"))
put("no name", "2", "variable-name-empty", attributes(INPUT["2"], name=""))
put("name with a space", "2 3", "variable-name-structured", of(INPUT, name="mesh error"))
put("name with an open bracket", "2", "variable-name-structured", of(INPUT, name="mesh[1")["2"])
put("name der without bracket", "3", "variable-name-structured", of(INPUT, name="der(mesh")["3"])
put("name with a tab", "rich", "variable-name-flat", replaced(MD, b'name="speed"', b'name="spe&#9;ed"'))
put("reference twice", "3", "value-reference", share("frequency", "mesh.force"))
put(
    "two starts on one reference",
    "2",
    "alias-start",
    share("mesh.force", "mesh.transmission_error"),
)
put("two units on one reference", "2", "alias-unit", share(FORCE, "mesh.transmission_error"))
put(
    "constant beside a variable",
    "2",
    "alias-constant",
    both(
        attributes(OUTPUT["2"], variability="constant", initial=None),
        attributes(OUT_REAL["2"], start="0"),
        share("bearing_1.force_rx", FORCE),
    ),
)

# causality, variability, initial
put("fixed input", "2 3", "variable-combination", of(INPUT, variability="fixed"))
put(
    "parameter without variability",
    "3",
    "variable-combination",
    attributes("//*[@causality='parameter']", variability=None, initial=None),
)
put(
    "approximate parameter",
    "2 3",
    "variable-initial",
    {
        "2": attributes("//ScalarVariable[@causality='parameter']", initial="approx"),
        "3": attributes("//Float64[@causality='parameter']", initial="approx"),
    },
)
put("initial of an input", "2", "variable-initial", attributes(INPUT["2"], initial="exact"))
put(
    "continuous integer",
    "rich",
    "variable-continuous",
    attributes("//*[@name='z']/../Boolean", variability="continuous"),
)
put("no time", "3", "variable-independent", remove("//*[@causality='independent']"))
put(
    "two times",
    "2",
    "variable-independent",
    both(
        *(
            both(
                attributes(f"//ScalarVariable[@name='{n}']", causality="independent"),
                attributes(f"//ScalarVariable[@name='{n}']/Real", start=None),
            )
            for n in ("mesh.force", "actuators.shaker")
        )
    ),
)
put("time an array", "3", "variable-independent-type", add("//*[@causality='independent']", '<Dimension start="2"/>'))

# values
put("input without start", "2 3", "start-missing", of(REAL, start=None))
put("start of an output", "2 3", "start-forbidden", of(OUT_REAL, start="0"))
put("start of time", "3", "start-forbidden", attributes("//*[@causality='independent']", start="0"))
put("start count", "3", "start-count", attributes("//Float64[@name='bearing_1.stiffness']", start="1 2 3"))
put("start count by a parameter", "rich", "start-count", attributes("//UInt64[@name='n']", start="3"))
put(
    "start below min",
    "2 3",
    "start-range",
    {
        "2": attributes("//ScalarVariable[@name='mount_1.stiffness']/Real", start="-1"),
        "3": attributes("//Float64[@name='mount_1.stiffness']", start="-1"),
    },
)
put("start above the max of its type", "rich", "start-range", attributes("//*[@name='u']", start="11"))
put("min above max", "2 3", "min-max", of(REAL, min="2", max="1"))
put("nominal 0", "2 3", "nominal", of(OUT_REAL, nominal="0"))
put("nominal negative", "2", "nominal", attributes(STATE["2"], nominal="-1"))
put("start infinite", "2 3", "not-finite", of(REAL, start="INF"))
put("size 0", "3", "dimension-size", attributes("//Dimension", start="0"))
put("size twice", "rich", "dimension-size", attributes("//*[@name='A']/Dimension[2]", start="2"))
put("size of a parameter that starts at 0", "rich", "dimension-size", attributes("//UInt64[@name='n']", start="0"))
put("size from an input", "rich", "dimension-reference", attributes("//*[@name='A']/Dimension", valueReference="13"))
put("size from nowhere", "3", "dimension-reference", attributes("//Dimension", start=None, valueReference="99999"))
put("structural array", "rich", "structural-parameter", add("//UInt64[@name='n']", '<Dimension start="1"/>'))
