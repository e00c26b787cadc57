"""Builds the FMUs of pendulum.c, and gives their A, B, C, D in closed form."""

import re
import shutil
import subprocess
import sys
import zipfile
from dataclasses import dataclass
from math import cos, sin, sqrt
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Model
from fmpy.fmi3 import FMU3Model

HERE = Path(__file__).parent
HEADERS = Path(fmpy.__file__).parent / "c-code"
STOP = 0.5  # rad

_MD2 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Test.Pendulum" guid="{{1}}" numberOfEventIndicators="1">
 <ModelExchange modelIdentifier="pendulum" {derivatives}/>
 <UnitDefinitions>
  <Unit name="rad"/><Unit name="rad/s"/><Unit name="N.m"/><Unit name="N"/><Unit name="m"/>
 </UnitDefinitions>
 <ModelVariables>{variables}</ModelVariables>
 <ModelStructure>
  <Outputs>{outputs}</Outputs>
  <Derivatives>{rates}</Derivatives>
 </ModelStructure>
</fmiModelDescription>
"""
_MD3 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="Test.Pendulum" instantiationToken="{{1}}">
 <ModelExchange modelIdentifier="pendulum" needsCompletedIntegratorStep="true" {derivatives}/>
 <DefaultExperiment startTime="0"/>
 <ModelVariables>
  <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
  <Float64 name="state" valueReference="1" initial="exact" start="0 0 1"><Dimension start="3"/></Float64>
  <Float64 name="der(state)" valueReference="2" derivative="1"><Dimension start="3"/></Float64>
  <Float64 name="load" valueReference="3" causality="input" start="0 0"><Dimension start="2"/></Float64>
  <Float64 name="q" valueReference="4" causality="input" start="0" min="0"/>
  <Float64 name="out" valueReference="5" causality="output"><Dimension start="3"/></Float64>
  <Float64 name="flow" valueReference="6" causality="output"/>
  {parameters}
  <Boolean name="engaged" valueReference="20" variability="discrete"/>
  <Boolean name="gravity_on" valueReference="21" causality="parameter" variability="fixed" start="true"/>
  <Int32 name="planets" valueReference="22" causality="parameter" variability="fixed" start="1"/>
  <Float64 name="beyond" valueReference="24"/>
  <String name="label" valueReference="23" causality="parameter" variability="fixed"><Start value=""/></String>
 </ModelVariables>
 <ModelStructure>
  <Output valueReference="5" dependencies="1 3"/>
  <Output valueReference="6" dependencies="1 4"/>
  <ContinuousStateDerivative valueReference="2"/>
  <EventIndicator valueReference="24"/>
 </ModelStructure>
</fmiModelDescription>
"""
_PARAMETERS = {"m": 2.0, "l": 0.5, "c": 0.3, "k": 40.0, "a": 0.2}


@dataclass(frozen=True)
class Case:
    """An operating point, and the pendulum's parameters."""

    th: float = 0.0
    w: float = 0.0
    h: float = 1.0
    u: float = 0.0
    F: float = 0.0
    q: float = 0.0
    m: float = 2.0
    l: float = 0.5  # noqa: E741 - the field's own name
    c: float = 0.3
    k: float = 40.0
    a: float = 0.2
    g: float = 9.81

    def slope(self, th, w, h, u, F, q):
        """x' for solvers of the equilibrium."""
        J = self.m * self.l**2
        stop = self.k * (th - STOP) if th > STOP else 0.0
        turn = -self.g / self.l * sin(th) - self.c * w + (u + F * self.l * cos(th)) / J - stop
        return np.array([w, turn, q - self.a * sqrt(h)])

    def matrices(self):
        """A, B, C, D on th, w, h; u, F, q; x, T, P, flow."""
        J, s, c = self.m * self.l**2, sin(self.th), cos(self.th)
        stop = self.k if self.th > STOP else 0.0
        turn = -self.g / self.l * c - self.F * self.l * s / J - stop
        A = [[0, 1, 0], [turn, -self.c, 0], [0, 0, -self.a / (2 * sqrt(self.h))]]
        B = [[0, 0, 0], [1 / J, self.l * c / J, 0], [0, 0, 1]]
        C = [
            [self.l * c, 0, 0],
            [-self.m * self.g * s + self.F * c, 2 * self.m * self.l * self.w, 0],
            [0, self.u, 0],
            [0, 0, 1],
        ]
        D = [[0, 0, 0], [0, s, 0], [self.w, 0, 0], [0, 0, 1 + 2 * self.q]]
        return tuple(np.array(matrix, float) for matrix in (A, B, C, D))


def build(path, fmi=2, derivatives=0):
    """Compile and zip; `derivatives` 0 none, 1 right, 2 wrong, 3 refused."""
    folder = path.parent / path.stem
    folder.mkdir()
    library = folder / "pendulum.so"
    compiler = [shutil.which("cc")] if shutil.which("cc") else [sys.executable, "-m", "ziglang", "cc"]
    defines = [f"-DDERIVATIVES={derivatives}", *(["-DFMI3"] if fmi == 3 else [])]
    options = ["-std=c99", "-O1", "-shared", "-fPIC", f"-I{HEADERS}", f"-I{HERE}"]
    rest = folder / "rest.c"
    rest.write_text(absent(fmi))
    sources = [HERE / "pendulum.c", rest, "-lm"]
    subprocess.run([*compiler, *options, *defines, "-o", library, *sources], check=True)
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("modelDescription.xml", description(fmi, derivatives))
        file.write(library, f"binaries/{fmpy.platform if fmi == 2 else fmpy.platform_tuple}/pendulum.so")
    return path


def absent(fmi):
    """Functions of the standard that fmpy wants to find and pendulum.c does not have."""
    there = re.findall(rf"\b(fmi{fmi}\w+)\(", (HERE / f"pendulum{fmi}.h").read_text())
    wanted = {name for name in dir({2: FMU2Model, 3: FMU3Model}[fmi]) if name.startswith(f"fmi{fmi}")}
    return "\n".join(f"int {name}(void) {{ return 3; }}" for name in sorted(wanted - set(there)))


def description(fmi, derivatives):
    """modelDescription.xml."""
    flag = "providesDirectionalDerivative" + ("s" if fmi == 3 else "")
    text = f'{flag}="true"' if derivatives else ""
    if fmi == 3:
        parameters = "".join(
            f'<Float64 name="{n}" valueReference="{13 + i}" causality="parameter" variability="tunable" start="{v}"/>'
            for i, (n, v) in enumerate(_PARAMETERS.items())
        )
        return _MD3.format(derivatives=text, parameters=parameters)
    variables, rows = [], []

    def add(name, reference, attributes="", real=""):
        variables.append(
            f'<ScalarVariable name="{name}" valueReference="{reference}" {attributes}><Real {real}/></ScalarVariable>'
        )

    for i, (name, unit, start) in enumerate((("bob.th", "rad", 0), ("bob.w", "rad/s", 0), ("h", "m", 1))):
        add(name, i, 'initial="exact"', f'start="{start}" unit="{unit}"')
    for i, name in enumerate(("bob.th", "bob.w", "h")):
        add(f"der({name})", 3 + i, "", f'derivative="{i + 1}"')
    for i, (name, unit) in enumerate((("u", 'unit="N.m"'), ("F", 'unit="N"'), ("q", 'min="0"'))):
        add(name, 6 + i, 'causality="input"', f'start="0" {unit}')
    for i, name in enumerate(("x", "T", "P", "flow")):
        add(name, 9 + i, 'causality="output"')
    add("angle", 0, 'causality="output"', 'unit="rad"')  # an alias of the state
    for i, (name, value) in enumerate(_PARAMETERS.items()):
        add(name, 13 + i, 'causality="parameter" variability="tunable"', f'start="{value}"')
    fixed = 'valueReference="0" causality="parameter" variability="fixed"'
    variables += [
        f'<ScalarVariable name="gravity_on" {fixed}><Boolean start="true"/></ScalarVariable>',
        f'<ScalarVariable name="planets" {fixed}><Integer start="1"/></ScalarVariable>',
        f'<ScalarVariable name="label" {fixed}><String start=""/></ScalarVariable>',
    ]
    depends = {10: "1", 11: "1 2 8", 12: "2 7", 13: "3 9", 14: "1"}  # by index
    rows = [f'<Unknown index="{i}" dependencies="{known}"/>' for i, known in depends.items()]
    rates = [f'<Unknown index="{i}"/>' for i in (4, 5, 6)]
    return _MD2.format(derivatives=text, variables="".join(variables), outputs="".join(rows), rates="".join(rates))
