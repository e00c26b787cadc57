"""Faults in terminals, XML, files, sources and binaries."""

from conformance_faults import INPUT, of, put
from conformance_trees import (
    BUILD,
    MD,
    TERMINALS,
    add,
    attributes,
    both,
    remove,
    renamed,
    replaced,
    twice,
    without,
    written,
)

# terminals
put(
    "terminal of nothing",
    "rich",
    "terminal-variable",
    attributes("//TerminalMemberVariable", file=TERMINALS, variableName="nothing"),
)
put(
    "stream of nothing",
    "rich",
    "terminal-variable",
    attributes("//TerminalStreamMemberVariable", file=TERMINALS, inStreamVariableName="nothing"),
)
put(
    "terminal of a state",
    "rich",
    "terminal-causality",
    attributes("//TerminalMemberVariable", file=TERMINALS, variableName="x"),
)
put("terminal twice", "rich", "terminal-name", attributes("//Terminals/Terminal[2]", file=TERMINALS, name="port"))
put(
    "member without name",
    "rich",
    "terminal-member",
    attributes("//TerminalMemberVariable", file=TERMINALS, memberName=None),
)
put(
    "members of one name",
    "rich",
    "terminal-member",
    attributes("//TerminalMemberVariable", file=TERMINALS, memberName="y"),
)
put("matching rule", "rich", "terminal-matching", attributes("//Terminal", file=TERMINALS, matchingRule="socket"))
put(
    "stream without flow",
    "rich",
    "terminal-stream",
    attributes("//TerminalMemberVariable[2]", file=TERMINALS, variableKind="signal"),
)
put("picture of a terminal", "rich", "terminal-icon", without("terminalsAndIcons/port.png"))
put(
    "terminals of another version",
    "rich",
    "terminals-version",
    attributes("/fmiTerminalsAndIcons", file=TERMINALS, fmiVersion="3.1"),
)
put("no icon", "rich", "icon-missing", without("terminalsAndIcons/icon.png"))
put("icon as SVG only", "rich", "icon-png", without("terminalsAndIcons/icon.png"))
put("coordinates upside down", "rich", "icon-extent", attributes("//CoordinateSystem", file=TERMINALS, y1="200"))

# XML
put("broken description", "2 3", "xml-broken", replaced(MD, b"</fmiModelDescription>", b""))
put("broken terminals", "rich", "xml-broken", replaced(TERMINALS, b"</Terminals>", b""))
put("broken documentation", "rich", "xml-broken", written("documentation/a.xml", b"<?xml encoding='UTF-8'?><a>"))
put("Latin-1", "2", "xml-encoding", replaced(MD, b"UTF-8", b"ISO-8859-1"))
put("no encoding", "rich", "xml-encoding", replaced(BUILD, b' encoding="UTF-8"', b""))
put(
    "entities",
    "3",
    "xml-entities",
    replaced(MD, b"<fmiModelDescription", b'<!DOCTYPE a [<!ENTITY b "c">]><fmiModelDescription'),
)
put("unknown attribute", "2 3", "xml-schema", of(INPUT, colour="red"))
put("unknown element", "rich", "xml-schema", add("//Terminals", "<Port/>", file=TERMINALS))
put("build without configuration", "3", "xml-schema", remove("//BuildConfiguration", file=BUILD))
put(
    "manifest without version",
    "rich",
    "manifest",
    replaced("extra/org.example.x/fmi-ls-manifest.xml", b"fmi-ls:fmi-ls-version", b"fmi-ls:fmi-ls-edition"),
)
put(
    "manifest of another",
    "rich",
    "manifest",
    replaced("extra/org.example.x/fmi-ls-manifest.xml", b'"org.example.x"', b'"org.example.y"'),
)

# files
put("no description", "2 3", "description-missing", without(MD))
put("in a folder", "2", "description-missing", renamed(MD, f"gearbox/{MD}"))
put("no documentation", "2 3", "documentation-missing", without("documentation/index.html"))
put("no licence", "2 3", "licence-missing", without("documentation/licenses/license.txt"))
put(
    "licence of another name",
    "3",
    "licence-entry",
    renamed("documentation/licenses/license.txt", "documentation/licenses/MIT"),
)
put("stray file", "2 3", "layout", written("notes.txt"))
put("icon of FMI 2 in FMI 3", "3", "layout", written("model.png"))
put("extra without domain", "2", "extra-name", written("extra/data/a.csv"))
put("headers of the standard", "2", "sources-headers", written("sources/fmi2Functions.h"))
put("nothing to run", "2 3", "implementation-missing", without("binaries/", "sources/"))

# sources
put("source missing", "2 3", "source-missing", without("sources/gp_linalg.c"))
put("source twice", "2 3", "source-duplicate", {"2": twice("//File"), "3": twice("//SourceFile", file=BUILD)})
put(
    "sources unlisted",
    "2",
    "source-unlisted",
    both(remove("//ModelExchange/SourceFiles"), remove("//CoSimulation/SourceFiles")),
)
put("no build description", "3", "build-missing", without(BUILD))
put(
    "build of another model",
    "3",
    "build-identifier",
    attributes("//BuildConfiguration", file=BUILD, modelIdentifier="other"),
)
put(
    "interface without build",
    "3",
    "build-interface",
    attributes("//BuildConfiguration", file=BUILD, modelIdentifier="other"),
)
put(
    "two builds for a platform", "rich", "build-platform", attributes("//BuildConfiguration", file=BUILD, platform=None)
)
put("build of another version", "3", "build-version", attributes("/*", file=BUILD, fmiVersion="3.1"))
put("include folder", "rich", "build-include", attributes("//IncludeDirectory", file=BUILD, name="less"))
put("library", "rich", "build-library", attributes("//Library", file=BUILD, external="false"))
put("option", "rich", "build-option", attributes("//PreprocessorDefinition", file=BUILD, value="3"))

# binaries, not run
LINUX = {"2": "binaries/linux64", "3": "binaries/x86_64-linux"}
put(
    "library missing",
    "2 3",
    "binary-missing",
    {b: both(renamed(f"{f}/gearbox.so", f"{f}/readme.txt")) for b, f in LINUX.items()},
)
put(
    "library misnamed",
    "2 3",
    "binary-missing",
    {b: renamed(f"{f}/gearbox.so", f"{f}/libgearbox.so") for b, f in LINUX.items()},
)
put("identifier of another library", "3", "binary-missing", attributes("//ModelExchange", modelIdentifier="other"))
put("folder of FMI 2", "3", "platform-folder", renamed(LINUX["3"], "binaries/linux64"))
put("folder of nothing", "2", "platform-unknown", renamed(LINUX["2"], "binaries/amiga"))
put("library beside the folders", "2", "binary-loose", written("binaries/gearbox.so"))
put(
    "library of another machine",
    "2 3",
    "binary-format",
    {
        "2": renamed("binaries/aarch64-linux/gearbox.so", "binaries/linux64/gearbox.so"),
        "3": renamed("binaries/aarch64-linux/gearbox.so", "binaries/x86_64-linux/gearbox.so"),
    },
)
put(
    "library of another system",
    "2",
    "binary-format",
    renamed("binaries/darwin64/gearbox.dylib", "binaries/win64/gearbox.dll"),
)
put("library of text", "3", "binary-format", written("binaries/x86_64-windows/gearbox.dll", b"MZ nothing"))
for _system, _file in (("linux", "gearbox.so"), ("windows", "gearbox.dll"), ("darwin", "gearbox.dylib")):
    put(
        f"function missing on {_system}",
        "3",
        "binary-functions",
        replaced(f"binaries/x86_64-{_system}/{_file}", b"fmi3GetFMUState\0", b"fmi3BetFMUState\0"),
    )
