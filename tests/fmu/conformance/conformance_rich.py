"""A source code FMU of FMI 3 with what an exported gearbox does not have: structural parameters, arrays that they size,
aliases, enumerations, strings, binaries, clocks, event indicators, nested terminals, several build configurations.
"""

from conformance_trees import BUILD, MD, TERMINALS, Tree

_DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="Rich" instantiationToken="{1}" generationTool="by hand"
 generationDateAndTime="2025-01-31T12:00:00Z" variableNamingConvention="structured">
 <ModelExchange modelIdentifier="rich" canGetAndSetFMUState="true" canSerializeFMUState="true"/>
 <CoSimulation modelIdentifier="rich" canHandleVariableCommunicationStepSize="true" fixedInternalStepSize="1e-3"
  providesIntermediateUpdate="true" canReturnEarlyAfterIntermediateUpdate="true" hasEventMode="true"/>
 <UnitDefinitions>
  <Unit name="m"><BaseUnit m="1"/><DisplayUnit name="mm" factor="1000"/></Unit>
  <Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
  <Unit name="rad/s"><BaseUnit rad="1" s="-1"/><DisplayUnit name="rpm" factor="9.549296585513721"/></Unit>
  <Unit name="S"><BaseUnit kg="-1" m="-2" s="3" A="2"/><DisplayUnit name="Ohm" factor="1" inverse="true"/></Unit>
 </UnitDefinitions>
 <TypeDefinitions>
  <Float64Type name="Length" unit="m" displayUnit="mm" min="-10" max="10" nominal="0.5"/>
  <EnumerationType name="Gear"><Item name="first" value="1"/><Item name="second" value="2"/></EnumerationType>
 </TypeDefinitions>
 <LogCategories><Category name="logEvents"/><Category name="logStatusError"/></LogCategories>
 <DefaultExperiment startTime="0" stopTime="1" stepSize="0.01" tolerance="1e-6"/>
 <ModelVariables>
  <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
  <UInt64 name="n" valueReference="1" causality="structuralParameter" variability="fixed" start="2" min="0" max="5"/>
  <UInt64 name="k" valueReference="2" variability="constant" start="3"/>
  <Float64 name="A" valueReference="3" causality="parameter" variability="tunable" start="0 1 -1 0">
   <Dimension valueReference="1"/><Dimension valueReference="1"/>
  </Float64>
  <Float64 name="u" valueReference="4" causality="input" start="0.5" declaredType="Length" intermediateUpdate="true"
   canHandleMultipleSetPerTimeInstant="true">
   <Dimension start="2"/><Alias name="u.too" displayUnit="mm"/>
  </Float64>
  <Float64 name="x" valueReference="5" initial="exact" start="0 0" unit="m" reinit="true">
   <Dimension valueReference="1"/>
  </Float64>
  <Float64 name="der(x)" valueReference="6" unit="m/s" derivative="5"><Dimension valueReference="1"/></Float64>
  <Float64 name="y" valueReference="7" causality="output" unit="m" displayUnit="mm">
   <Dimension valueReference="1"/>
  </Float64>
  <Float32 name="speed" valueReference="8" causality="output" unit="rad/s" displayUnit="rpm"/>
  <Enumeration name="gear" valueReference="9" causality="parameter" variability="fixed" start="2" declaredType="Gear"/>
  <Int8 name="small" valueReference="10" causality="parameter" variability="fixed" start="-100" min="-120" max="127"/>
  <String name="texts" valueReference="11" causality="parameter" variability="fixed">
   <Dimension start="2"/><Start value="a b"/><Start value="c"/>
  </String>
  <Binary name="blob" valueReference="12" causality="input"><Start value="ff00"/></Binary>
  <Boolean name="on" valueReference="13" causality="input" start="true"/>
  <Float64 name="total" valueReference="14" causality="calculatedParameter" variability="tunable" unit="S"
   displayUnit="Ohm"/>
  <Float64 name="z" valueReference="15"/>
  <Clock name="tick" valueReference="16" causality="input" intervalVariability="constant" intervalDecimal="0.1"/>
  <Int32 name="count" valueReference="17" causality="output" clocks="16" previous="18"/>
  <Int32 name="before" valueReference="18" clocks="16"/>
  <Float64 name="'a name #1'.b[1,2]" valueReference="19" causality="output" variability="constant" start="1"/>
 </ModelVariables>
 <ModelStructure>
  <Output valueReference="7" dependencies="4 5" dependenciesKind="tunable dependent"/>
  <Output valueReference="8" dependencies="0"/>
  <Output valueReference="17" dependencies="16 18"/>
  <Output valueReference="19" dependencies=""/>
  <ContinuousStateDerivative valueReference="6" dependencies="3 4 5"/>
  <ClockedState valueReference="17" dependencies="18"/>
  <InitialUnknown valueReference="6" dependencies="3 4 5"/>
  <InitialUnknown valueReference="7" dependencies="4 5" dependenciesKind="constant dependent"/>
  <InitialUnknown valueReference="8" dependencies=""/>
  <InitialUnknown valueReference="14" dependencies="3"/>
  <EventIndicator valueReference="15"/>
 </ModelStructure>
</fmiModelDescription>
"""

_BUILD = """<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
 <BuildConfiguration modelIdentifier="rich" platform="x86_64-linux">
  <SourceFileSet language="C99">
   <SourceFile name="rich.c"/><SourceFile name="more/part.c"/>
   <PreprocessorDefinition name="SIZE" value="2"><Option value="1"/><Option value="2"/></PreprocessorDefinition>
   <IncludeDirectory name="more"/>
  </SourceFileSet>
  <Library name="m" external="true"/>
 </BuildConfiguration>
 <BuildConfiguration modelIdentifier="rich">
  <SourceFileSet language="C99"><SourceFile name="rich.c"/></SourceFileSet>
 </BuildConfiguration>
</fmiBuildDescription>
"""

_TERMINALS = """<?xml version="1.0" encoding="UTF-8"?>
<fmiTerminalsAndIcons fmiVersion="3.0">
 <GraphicalRepresentation>
  <CoordinateSystem x1="-100" y1="-100" x2="100" y2="100" suggestedScalingFactorTo_mm="0.1"/>
  <Icon x1="-90" y1="-90" x2="90" y2="90"/>
 </GraphicalRepresentation>
 <Terminals>
  <Terminal name="port" matchingRule="plug" terminalKind="org.example.flange">
   <TerminalMemberVariable variableName="u.too" memberName="u" variableKind="signal"/>
   <TerminalMemberVariable variableName="y" memberName="y" variableKind="inflow"/>
   <TerminalStreamMemberVariable inStreamMemberName="i" outStreamMemberName="o" inStreamVariableName="u"
    outStreamVariableName="y"/>
   <Terminal name="inner" matchingRule="sequence">
    <TerminalMemberVariable variableName="speed" variableKind="signal"/>
   </Terminal>
   <TerminalGraphicalRepresentation x1="-10" y1="-10" x2="10" y2="10" iconBaseName="port"/>
  </Terminal>
  <Terminal name="other" matchingRule="org.example.rule">
   <TerminalMemberVariable variableName="total" variableKind="signal"/>
  </Terminal>
 </Terminals>
</fmiTerminalsAndIcons>
"""

_MANIFEST = """<?xml version="1.0" encoding="UTF-8"?>
<fmiLayeredStandardManifest xmlns:fmi-ls="http://fmi-standard.org/fmi-ls-manifest" fmi-ls:fmi-ls-name="org.example.x"
 fmi-ls:fmi-ls-version="1.0" fmi-ls:fmi-ls-description="An example"/>
"""


def rich() -> Tree:
    """The files of the FMU."""
    return {
        MD: _DESCRIPTION.encode(),
        BUILD: _BUILD.encode(),
        TERMINALS: _TERMINALS.encode(),
        "sources/rich.c": b"",
        "sources/more/part.c": b"",
        "terminalsAndIcons/icon.png": b"png",
        "terminalsAndIcons/icon.svg": b"svg",
        "terminalsAndIcons/port.png": b"png",
        "documentation/index.html": b"<html></html>",
        "documentation/licenses/license.txt": b"free",
        "extra/org.example.x/fmi-ls-manifest.xml": _MANIFEST.encode(),
        "extra/org.example.x/data.csv": b"",
        "resources/any.xml": b"not even XML",
    }
