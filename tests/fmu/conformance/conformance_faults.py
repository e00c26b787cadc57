"""Faults put into good FMUs, each with the rule that must see it.

Bases: "2" and "3" are exported gearboxes, "rich" is conformance_rich. (name, bases, rule or a rule for each base, edit)
"""

from dataclasses import dataclass

from conformance_trees import attributes


@dataclass(frozen=True)
class Mutant:
    name: str
    base: str
    rule: str
    edit: object


ALL: list[Mutant] = []


def put(name, bases, rule, edit):
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


def of(paths, **values):
    """The same attributes at a place that each base has elsewhere."""
    return {base: attributes(path, **values) for base, path in paths.items()}


def listed(paths, function, *more):
    return {base: function(f"({path})[1]", *more) for base, path in paths.items()}
