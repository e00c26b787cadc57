"""Faults put into good FMUs, each with the rule that must see it.

Bases: "2" and "3" are exported gearboxes, "rich" is conformance_rich. (name, bases, rule or a rule for each base, edit)
"""

from dataclasses import dataclass

from conformance_trees import (
    BUILD,
    MD,
    TERMINALS,
    add,
    aim,
    attributes,
    both,
    exchange,
    remove,
    renamed,
    replaced,
    share,
    twice,
    without,
    written,
)


@dataclass(frozen=True)
class Mutant:
    name: str
    base: str
    rule: str
    edit: object


ALL: list[Mutant] = []


def _put(name, bases, rule, edit):
    for base in bases.split():
        chosen = rule[base] if isinstance(rule, dict) else rule
        made = edit[base] if isinstance(edit, dict) else edit
        ALL.append(Mutant(f"{name}-{base}", base, chosen, made))


ROOT = "/fmiModelDescription"
INPUT = {"2": "//ScalarVariable[@causality='input']", "3": "//Float64[@causality='input']"}
REAL = {"2": INPUT["2"] + "/Real", "3": INPUT["3"]}
STATE = {"2": "//ScalarVariable[@name='gear_train.mode_1.x']/Real", "3": "//Float64[@name='state']"}
RATE = {"2": "//ScalarVariable[@name='der(gear_train.mode_1.x)']/Real", "3": "//Float64[@name='der(state)']"}
FORCE = "bearing_1.force_uy"
OUTPUT = {"2": f"//ScalarVariable[@name='{FORCE}']", "3": f"//Float64[@name='{FORCE}']"}
OUT_REAL = {"2": OUTPUT["2"] + "/Real", "3": OUTPUT["3"]}
OUTPUTS = {"2": "//Outputs/Unknown", "3": "//ModelStructure/Output"}
RATES = {"2": "//Derivatives/Unknown", "3": "//ContinuousStateDerivative"}
INITIALS = {"2": "//InitialUnknowns/Unknown", "3": "//InitialUnknown"}
KEY = {"2": "index", "3": "valueReference"}


def _of(paths, **values):
    """The same attributes at a place that each base has elsewhere."""
    return {base: attributes(path, **values) for base, path in paths.items()}


def _listed(paths, function, *more):
    return {base: function(f"({path})[1]", *more) for base, path in paths.items()}


# identity
_put("patch version", "2 3", "fmi-version", {b: attributes(ROOT, fmiVersion=f"{b}.0.1") for b in "23"})
_put("version 1", "2", "fmi-edition", attributes(ROOT, fmiVersion="1.0"))
_put("date without Z", "2 3", "date", attributes(ROOT, generationDateAndTime="2025-01-31T12:00:00"))
_put("date of no calendar", "3", "date", attributes(ROOT, generationDateAndTime="2025-02-30T12:00:00Z"))
_put("date with offset", "2", "date", attributes(ROOT, generationDateAndTime="2025-01-31T12:00:00+01:00"))
_put("no token", "2 3", "token-empty", {"2": attributes(ROOT, guid=""), "3": attributes(ROOT, instantiationToken=" ")})
_put("no model name", "2", "model-name", attributes(ROOT, modelName=""))
_put("identifier with a space", "2", "model-identifier", attributes("//CoSimulation", modelIdentifier="gear box"))
_put("identifier from a digit", "3", "model-identifier", attributes("//ModelExchange", modelIdentifier="3gear"))
_put("identifier a keyword", "3", "model-identifier", attributes("//CoSimulation", modelIdentifier="double"))
_put("no interface", "2", "interface-missing", both(remove("//ModelExchange"), remove("//CoSimulation")))
_put(
    "tool without name",
    "2",
    "execution-tool",
    both(attributes("//CoSimulation", needsExecutionTool="true"), attributes(ROOT, generationTool=None)),
)
_put("Python without tool", "3", "execution-tool", written("resources/model.py"))
_put("stop before start", "2 3", "experiment-stop", attributes("//DefaultExperiment", startTime="1", stopTime="0.5"))
_put("stop at start", "3", "experiment-stop", attributes("//DefaultExperiment", startTime="1", stopTime="1"))
_put("negative step", "2 3", "experiment-step", attributes("//DefaultExperiment", stepSize="-1e-5"))
_put("zero step", "2", "experiment-step", attributes("//DefaultExperiment", stepSize="0"))
_put("zero tolerance", "3", "experiment-tolerance", attributes("//DefaultExperiment", tolerance="0"))
_put("no experiment", "2", "experiment-missing", remove("//DefaultExperiment"))
_put("category twice", "2 3", "log-category", twice("//Category"))

# capabilities
_put(
    "serialize alone",
    "2 3",
    "capability-serialize",
    {
        "2": attributes("//CoSimulation", canGetAndSetFMUstate="false"),
        "3": attributes("//ModelExchange", canGetAndSetFMUState=None),
    },
)
_put("flag of FMI 2 in FMI 3", "3", "capability-spelling", attributes("//CoSimulation", canGetAndSetFMUstate="true"))
_put(
    "derivative flag of FMI 2 in FMI 3",
    "3",
    "capability-spelling",
    attributes("//ModelExchange", providesDirectionalDerivative="true"),
)
_put("flag of FMI 3 in FMI 2", "2", "xml-schema", attributes("//CoSimulation", canGetAndSetFMUState="true"))
_put(
    "early return without updates",
    "rich",
    "capability-early-return",
    attributes("//CoSimulation", providesIntermediateUpdate="false"),
)
_put("internal step", "rich", "internal-step", attributes("//CoSimulation", fixedInternalStepSize="-1"))
_put("event indicators", "2", "event-indicators", attributes(ROOT, numberOfEventIndicators="-1"))
_put("parameter in updates", "rich", "intermediate-update", attributes("//*[@name='A']", intermediateUpdate="true"))
_put(
    "update of none",
    "rich",
    "intermediate-update-unused",
    attributes("//CoSimulation", providesIntermediateUpdate=None, canReturnEarlyAfterIntermediateUpdate=None),
)
_put("multiple set of an output", "2 3", "multiple-set", _of(OUTPUT, canHandleMultipleSetPerTimeInstant="true"))

# units and types
_put("unit twice", "2 3", "unit-duplicate", twice("//Unit[@name='N']"))
_put("unit without name", "3", "unit-name", attributes("//Unit[@name='Hz']", name=""))
_put("display unit twice", "2 3", "display-unit-duplicate", twice("//DisplayUnit"))
_put("factor 0", "2", "unit-factor", attributes("//DisplayUnit", factor="0"))
_put("exponent", "2 3", "unit-meaning", attributes("//Unit[@name='N']/BaseUnit", s="-1"))
_put("display factor", "3", "unit-meaning", attributes("//DisplayUnit[@name='um']", factor="1000"))
_put("no base unit", "2", "unit-base", remove("//Unit[@name='W']/BaseUnit"))
_put("inverse with offset", "rich", "unit-inverse", attributes("//DisplayUnit[@inverse]", offset="1"))
_put(
    "unit undefined",
    "2 3",
    "unit-undefined",
    _of(OUT_REAL, unit="furlong", displayUnit=None)
    | {"2": attributes(OUT_REAL["2"], unit="furlong"), "3": attributes(OUT_REAL["3"], unit="furlong")},
)
_put("unit of a type undefined", "rich", "unit-undefined", attributes("//Float64Type", unit="furlong"))
_put("display unit undefined", "2 3", "display-unit-undefined", _of(OUT_REAL, displayUnit="lbf"))
_put("display unit of an alias", "rich", "display-unit-undefined", attributes("//Alias", displayUnit="inch"))
_put("type twice", "3", "type-duplicate", twice("//TypeDefinitions/*"))
_put("type named as a variable", "rich", "type-variable-name", attributes("//Float64Type", name="y"))
_put("type undefined", "2 3", "type-undefined", _of(OUT_REAL, declaredType="Nothing"))
_put("type of another kind", "rich", "type-kind", attributes("//*[@name='gear']", declaredType="Length"))
_put("item twice", "rich", "type-item", attributes("//Item[2]", value="1"))
_put("start is no item", "rich", "enumeration-start", attributes("//*[@name='gear']", start="3"))

# names and references
_put(
    "name twice",
    "2 3",
    "variable-name-duplicate",
    {
        "2": attributes("(//ScalarVariable)[2]", name="mesh.transmission_error"),
        "3": attributes("//Float64[2]", name="mesh.transmission_error"),
    },
)
_put("alias twice", "rich", "variable-name-duplicate", attributes("//Alias", name="y"))
_put("no name", "2", "variable-name-empty", attributes(INPUT["2"], name=""))
_put("name with a space", "2 3", "variable-name-structured", _of(INPUT, name="mesh error"))
_put("name with an open bracket", "2", "variable-name-structured", _of(INPUT, name="mesh[1")["2"])
_put("name der without bracket", "3", "variable-name-structured", _of(INPUT, name="der(mesh")["3"])
_put("name with a tab", "rich", "variable-name-flat", replaced(MD, b'name="speed"', b'name="spe&#9;ed"'))
_put("reference twice", "3", "value-reference", share("frequency", "mesh.force"))
_put(
    "two starts on one reference",
    "2",
    "alias-start",
    share("mesh.force", "mesh.transmission_error"),
)
_put("two units on one reference", "2", "alias-unit", share(FORCE, "mesh.transmission_error"))
_put(
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
_put("fixed input", "2 3", "variable-combination", _of(INPUT, variability="fixed"))
_put(
    "parameter without variability",
    "3",
    "variable-combination",
    attributes("//*[@causality='parameter']", variability=None, initial=None),
)
_put(
    "approximate parameter",
    "2 3",
    "variable-initial",
    {
        "2": attributes("//ScalarVariable[@causality='parameter']", initial="approx"),
        "3": attributes("//Float64[@causality='parameter']", initial="approx"),
    },
)
_put("initial of an input", "2", "variable-initial", attributes(INPUT["2"], initial="exact"))
_put(
    "continuous integer",
    "rich",
    "variable-continuous",
    attributes("//*[@name='z']/../Boolean", variability="continuous"),
)
_put("no time", "3", "variable-independent", remove("//*[@causality='independent']"))
_put(
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
_put("time an array", "3", "variable-independent-type", add("//*[@causality='independent']", '<Dimension start="2"/>'))

# values
_put("input without start", "2 3", "start-missing", _of(REAL, start=None))
_put("start of an output", "2 3", "start-forbidden", _of(OUT_REAL, start="0"))
_put("start of time", "3", "start-forbidden", attributes("//*[@causality='independent']", start="0"))
_put("start count", "3", "start-count", attributes("//Float64[@name='bearing_1.stiffness']", start="1 2 3"))
_put("start count by a parameter", "rich", "start-count", attributes("//UInt64[@name='n']", start="3"))
_put(
    "start below min",
    "2 3",
    "start-range",
    {
        "2": attributes("//ScalarVariable[@name='mount_1.stiffness']/Real", start="-1"),
        "3": attributes("//Float64[@name='mount_1.stiffness']", start="-1"),
    },
)
_put("start above the max of its type", "rich", "start-range", attributes("//*[@name='u']", start="11"))
_put("min above max", "2 3", "min-max", _of(REAL, min="2", max="1"))
_put("nominal 0", "2 3", "nominal", _of(OUT_REAL, nominal="0"))
_put("nominal negative", "2", "nominal", attributes(STATE["2"], nominal="-1"))
_put("start infinite", "2 3", "not-finite", _of(REAL, start="INF"))
_put("size 0", "3", "dimension-size", attributes("//Dimension", start="0"))
_put("size twice", "rich", "dimension-size", attributes("//*[@name='A']/Dimension[2]", start="2"))
_put("size of a parameter that starts at 0", "rich", "dimension-size", attributes("//UInt64[@name='n']", start="0"))
_put("size from an input", "rich", "dimension-reference", attributes("//*[@name='A']/Dimension", valueReference="13"))
_put("size from nowhere", "3", "dimension-reference", attributes("//Dimension", start=None, valueReference="99999"))
_put("structural array", "rich", "structural-parameter", add("//UInt64[@name='n']", '<Dimension start="1"/>'))

# derivatives
_put(
    "derivative of itself",
    "2 3",
    "derivative-target",
    {
        "2": aim(RATE["2"], "derivative", "der(gear_train.mode_1.x)"),
        "3": aim(RATE["3"], "derivative", "der(state)"),
    },
)
_put("derivative of nothing", "2 3", "derivative-target", _of(RATE, derivative="99999"))
_put("derivative of another state", "2", "derivative-name", aim(RATE["2"], "derivative", "gear_train.mode_2.x"))
_put("derivative not said", "2 3", "derivative-name", _of(RATE, derivative=None))
_put("listed derivative of nothing", "2 3", "derivative-extra", _of(RATE, derivative=None))
_put("derivative of another size", "rich", "derivative-size", remove("//*[@name='der(x)']/Dimension"))
_put("unit of a derivative", "rich", "derivative-unit", attributes("//*[@name='der(x)']", unit="m"))
_put("state an input", "rich", "state-causality", attributes("//*[@name='x']", causality="input", initial=None))
_put("one state for two derivatives", "2", "state-shared", aim(RATE["2"], "derivative", "gear_train.mode_2.x"))
_put("reinit of an input", "2 3", "reinit", _of(REAL, reinit="true"))

# structure
_put("output not listed", "2 3", "output-missing", _listed(OUTPUTS, remove))
_put("output listed twice", "2 3", "structure-duplicate", _listed(OUTPUTS, twice))
_put("output out of order", "2 3", "output-order", {b: exchange(f"{p}[1]", f"{p}[2]") for b, p in OUTPUTS.items()})
_put(
    "input listed as output",
    "2 3",
    "output-extra",
    {b: aim(f"({p})[1]", KEY[b], "mesh.force") for b, p in OUTPUTS.items()},
)
_put(
    "output that does not exist",
    "2 3",
    "structure-reference",
    {b: attributes(f"({p})[1]", **{KEY[b]: "99999"}) for b, p in OUTPUTS.items()},
)
_put("derivative not listed", "2 3", "derivative-missing", _listed(RATES, remove))
_put("derivative listed twice", "2", "structure-duplicate", twice(f"({RATES['2']})[1]"))
_put("initial unknown not listed", "2 3", "initial-unknown-missing", _listed(INITIALS, remove))
_put("initial unknown listed twice", "2 3", "structure-duplicate", _listed(INITIALS, twice))
_put(
    "initial unknown out of order",
    "2 3",
    {"2": "initial-unknown-order", "3": "initial-unknown-unordered"},
    {b: exchange(f"{p}[1]", f"{p}[2]") for b, p in INITIALS.items()},
)
_put(
    "exact state as initial unknown",
    "2 3",
    "initial-unknown-extra",
    {
        "2": aim(f"({INITIALS['2']})[1]", "index", "gear_train.mode_1.x"),
        "3": aim(f"({INITIALS['3']})[1]", "valueReference", "state"),
    },
)
_put("no calculated parameters", "3", "initial-unknown-missing", remove("//InitialUnknown[last()]"))
_put("event indicator a boolean", "rich", "event-indicator", attributes("//EventIndicator", valueReference="13"))

# dependencies
_put(
    "dependencies not given",
    "2 3",
    "dependencies-missing",
    {b: attributes(f"({p})[1]", dependencies=None) for b, p in OUTPUTS.items()},
)
_put(
    "dependency out of range",
    "2 3",
    "dependency-reference",
    {b: attributes(f"({p})[1]", dependencies="99999") for b, p in OUTPUTS.items()},
)
_put(
    "dependency on an output",
    "2 3",
    "dependency-known",
    {b: aim(f"({p})[1]", "dependencies", "alpha") for b, p in OUTPUTS.items()},
)
_put(
    "initial dependency on an output",
    "2 3",
    "dependency-known",
    {b: aim(f"({p})[1]", "dependencies", "alpha") for b, p in INITIALS.items()},
)
_put(
    "dependency on a parameter",
    "2",
    "dependency-parameter",
    aim(f"({OUTPUTS['2']})[1]", "dependencies", "mount_1.stiffness"),
)
_put(
    "dependency twice",
    "2 3",
    "dependency-duplicate",
    {b: attributes(f"({p})[1]", dependencies="1 1") for b, p in OUTPUTS.items()},
)
_put("dependencies out of order", "2", "dependency-order", attributes(f"({OUTPUTS['2']})[1]", dependencies="2 1"))
_put(
    "kinds of another number",
    "2 3",
    "dependency-kind-count",
    {b: attributes(f"({p})[1]", dependencies="1 2", dependenciesKind="dependent") for b, p in OUTPUTS.items()},
)
_put(
    "kinds of no dependencies",
    "2",
    "dependency-kind-count",
    attributes(f"({OUTPUTS['2']})[1]", dependencies=None, dependenciesKind="dependent"),
)
_put(
    "late kind at the start",
    "2",
    "dependency-kind",
    attributes(f"({INITIALS['2']})[1]", dependencies="1", dependenciesKind="fixed"),
)
_put(
    "kind of an integer",
    "rich",
    "dependency-kind",
    attributes("//Output[@valueReference='17']", dependenciesKind="constant constant"),
)

# terminals
_put(
    "terminal of nothing",
    "rich",
    "terminal-variable",
    attributes("//TerminalMemberVariable", file=TERMINALS, variableName="nothing"),
)
_put(
    "stream of nothing",
    "rich",
    "terminal-variable",
    attributes("//TerminalStreamMemberVariable", file=TERMINALS, inStreamVariableName="nothing"),
)
_put(
    "terminal of a state",
    "rich",
    "terminal-causality",
    attributes("//TerminalMemberVariable", file=TERMINALS, variableName="x"),
)
_put("terminal twice", "rich", "terminal-name", attributes("//Terminals/Terminal[2]", file=TERMINALS, name="port"))
_put(
    "member without name",
    "rich",
    "terminal-member",
    attributes("//TerminalMemberVariable", file=TERMINALS, memberName=None),
)
_put(
    "members of one name",
    "rich",
    "terminal-member",
    attributes("//TerminalMemberVariable", file=TERMINALS, memberName="y"),
)
_put("matching rule", "rich", "terminal-matching", attributes("//Terminal", file=TERMINALS, matchingRule="socket"))
_put(
    "stream without flow",
    "rich",
    "terminal-stream",
    attributes("//TerminalMemberVariable[2]", file=TERMINALS, variableKind="signal"),
)
_put("picture of a terminal", "rich", "terminal-icon", without("terminalsAndIcons/port.png"))
_put(
    "terminals of another version",
    "rich",
    "terminals-version",
    attributes("/fmiTerminalsAndIcons", file=TERMINALS, fmiVersion="3.1"),
)
_put("no icon", "rich", "icon-missing", without("terminalsAndIcons/icon.png"))
_put("icon as SVG only", "rich", "icon-png", without("terminalsAndIcons/icon.png"))
_put("coordinates upside down", "rich", "icon-extent", attributes("//CoordinateSystem", file=TERMINALS, y1="200"))

# XML
_put("broken description", "2 3", "xml-broken", replaced(MD, b"</fmiModelDescription>", b""))
_put("broken terminals", "rich", "xml-broken", replaced(TERMINALS, b"</Terminals>", b""))
_put("broken documentation", "rich", "xml-broken", written("documentation/a.xml", b"<?xml encoding='UTF-8'?><a>"))
_put("Latin-1", "2", "xml-encoding", replaced(MD, b"UTF-8", b"ISO-8859-1"))
_put("no encoding", "rich", "xml-encoding", replaced(BUILD, b' encoding="UTF-8"', b""))
_put(
    "entities",
    "3",
    "xml-entities",
    replaced(MD, b"<fmiModelDescription", b'<!DOCTYPE a [<!ENTITY b "c">]><fmiModelDescription'),
)
_put("unknown attribute", "2 3", "xml-schema", _of(INPUT, colour="red"))
_put("unknown element", "rich", "xml-schema", add("//Terminals", "<Port/>", file=TERMINALS))
_put("build without configuration", "3", "xml-schema", remove("//BuildConfiguration", file=BUILD))
_put(
    "manifest without version",
    "rich",
    "manifest",
    replaced("extra/org.example.x/fmi-ls-manifest.xml", b"fmi-ls:fmi-ls-version", b"fmi-ls:fmi-ls-edition"),
)
_put(
    "manifest of another",
    "rich",
    "manifest",
    replaced("extra/org.example.x/fmi-ls-manifest.xml", b'"org.example.x"', b'"org.example.y"'),
)

# files
_put("no description", "2 3", "description-missing", without(MD))
_put("in a folder", "2", "description-missing", renamed(MD, f"gearbox/{MD}"))
_put("no documentation", "2 3", "documentation-missing", without("documentation/index.html"))
_put("no licence", "2 3", "licence-missing", without("documentation/licenses/license.txt"))
_put(
    "licence of another name",
    "3",
    "licence-entry",
    renamed("documentation/licenses/license.txt", "documentation/licenses/MIT"),
)
_put("stray file", "2 3", "layout", written("notes.txt"))
_put("icon of FMI 2 in FMI 3", "3", "layout", written("model.png"))
_put("extra without domain", "2", "extra-name", written("extra/data/a.csv"))
_put("headers of the standard", "2", "sources-headers", written("sources/fmi2Functions.h"))
_put("nothing to run", "2 3", "implementation-missing", without("binaries/", "sources/"))

# sources
_put("source missing", "2 3", "source-missing", without("sources/gp_linalg.c"))
_put("source twice", "2 3", "source-duplicate", {"2": twice("//File"), "3": twice("//SourceFile", file=BUILD)})
_put(
    "sources unlisted",
    "2",
    "source-unlisted",
    both(remove("//ModelExchange/SourceFiles"), remove("//CoSimulation/SourceFiles")),
)
_put("no build description", "3", "build-missing", without(BUILD))
_put(
    "build of another model",
    "3",
    "build-identifier",
    attributes("//BuildConfiguration", file=BUILD, modelIdentifier="other"),
)
_put(
    "interface without build",
    "3",
    "build-interface",
    attributes("//BuildConfiguration", file=BUILD, modelIdentifier="other"),
)
_put(
    "two builds for a platform", "rich", "build-platform", attributes("//BuildConfiguration", file=BUILD, platform=None)
)
_put("build of another version", "3", "build-version", attributes("/*", file=BUILD, fmiVersion="3.1"))
_put("include folder", "rich", "build-include", attributes("//IncludeDirectory", file=BUILD, name="less"))
_put("library", "rich", "build-library", attributes("//Library", file=BUILD, external="false"))
_put("option", "rich", "build-option", attributes("//PreprocessorDefinition", file=BUILD, value="3"))

# binaries, not run
LINUX = {"2": "binaries/linux64", "3": "binaries/x86_64-linux"}
_put(
    "library missing",
    "2 3",
    "binary-missing",
    {b: both(renamed(f"{f}/gearbox.so", f"{f}/readme.txt")) for b, f in LINUX.items()},
)
_put(
    "library misnamed",
    "2 3",
    "binary-missing",
    {b: renamed(f"{f}/gearbox.so", f"{f}/libgearbox.so") for b, f in LINUX.items()},
)
_put("identifier of another library", "3", "binary-missing", attributes("//ModelExchange", modelIdentifier="other"))
_put("folder of FMI 2", "3", "platform-folder", renamed(LINUX["3"], "binaries/linux64"))
_put("folder of nothing", "2", "platform-unknown", renamed(LINUX["2"], "binaries/amiga"))
_put("library beside the folders", "2", "binary-loose", written("binaries/gearbox.so"))
_put(
    "library of another machine",
    "2 3",
    "binary-format",
    {
        "2": renamed("binaries/aarch64-linux/gearbox.so", "binaries/linux64/gearbox.so"),
        "3": renamed("binaries/aarch64-linux/gearbox.so", "binaries/x86_64-linux/gearbox.so"),
    },
)
_put(
    "library of another system",
    "2",
    "binary-format",
    renamed("binaries/darwin64/gearbox.dylib", "binaries/win64/gearbox.dll"),
)
_put("library of text", "3", "binary-format", written("binaries/x86_64-windows/gearbox.dll", b"MZ nothing"))
for _system, _file in (("linux", "gearbox.so"), ("windows", "gearbox.dll"), ("darwin", "gearbox.dylib")):
    _put(
        f"function missing on {_system}",
        "3",
        "binary-functions",
        replaced(f"binaries/x86_64-{_system}/{_file}", b"fmi3GetFMUState\0", b"fmi3BetFMUState\0"),
    )
