"""Faults in derivatives, model structure and dependencies."""

from conformance_faults import INITIALS, KEY, OUTPUTS, RATE, RATES, REAL, listed, of, put
from conformance_trees import aim, attributes, exchange, remove, twice

# derivatives
put(
    "derivative of itself",
    "2 3",
    "derivative-target",
    {
        "2": aim(RATE["2"], "derivative", "der(gear_train.mode_1.x)"),
        "3": aim(RATE["3"], "derivative", "der(state)"),
    },
)
put("derivative of nothing", "2 3", "derivative-target", of(RATE, derivative="99999"))
put("derivative of another state", "2", "derivative-name", aim(RATE["2"], "derivative", "gear_train.mode_2.x"))
put("derivative not said", "2 3", "derivative-name", of(RATE, derivative=None))
put("listed derivative of nothing", "2 3", "derivative-extra", of(RATE, derivative=None))
put("derivative of another size", "rich", "derivative-size", remove("//*[@name='der(x)']/Dimension"))
put("unit of a derivative", "rich", "derivative-unit", attributes("//*[@name='der(x)']", unit="m"))
put("state an input", "rich", "state-causality", attributes("//*[@name='x']", causality="input", initial=None))
put("one state for two derivatives", "2", "state-shared", aim(RATE["2"], "derivative", "gear_train.mode_2.x"))
put("reinit of an input", "2 3", "reinit", of(REAL, reinit="true"))

# structure
put("output not listed", "2 3", "output-missing", listed(OUTPUTS, remove))
put("output listed twice", "2 3", "structure-duplicate", listed(OUTPUTS, twice))
put("output out of order", "2 3", "output-order", {b: exchange(f"{p}[1]", f"{p}[2]") for b, p in OUTPUTS.items()})
put(
    "input listed as output",
    "2 3",
    "output-extra",
    {b: aim(f"({p})[1]", KEY[b], "mesh.force") for b, p in OUTPUTS.items()},
)
put(
    "output that does not exist",
    "2 3",
    "structure-reference",
    {b: attributes(f"({p})[1]", **{KEY[b]: "99999"}) for b, p in OUTPUTS.items()},
)
put("derivative not listed", "2 3", "derivative-missing", listed(RATES, remove))
put("derivative listed twice", "2", "structure-duplicate", twice(f"({RATES['2']})[1]"))
put("initial unknown not listed", "2 3", "initial-unknown-missing", listed(INITIALS, remove))
put("initial unknown listed twice", "2 3", "structure-duplicate", listed(INITIALS, twice))
put(
    "initial unknown out of order",
    "2 3",
    {"2": "initial-unknown-order", "3": "initial-unknown-unordered"},
    {b: exchange(f"{p}[1]", f"{p}[2]") for b, p in INITIALS.items()},
)
put(
    "exact state as initial unknown",
    "2 3",
    "initial-unknown-extra",
    {
        "2": aim(f"({INITIALS['2']})[1]", "index", "gear_train.mode_1.x"),
        "3": aim(f"({INITIALS['3']})[1]", "valueReference", "state"),
    },
)
put("no calculated parameters", "3", "initial-unknown-missing", remove("//InitialUnknown[last()]"))
put("event indicator a boolean", "rich", "event-indicator", attributes("//EventIndicator", valueReference="13"))

# dependencies
put(
    "dependencies not given",
    "2 3",
    "dependencies-missing",
    {b: attributes(f"({p})[1]", dependencies=None) for b, p in OUTPUTS.items()},
)
put(
    "dependency out of range",
    "2 3",
    "dependency-reference",
    {b: attributes(f"({p})[1]", dependencies="99999") for b, p in OUTPUTS.items()},
)
put(
    "dependency on an output",
    "2 3",
    "dependency-known",
    {b: aim(f"({p})[1]", "dependencies", "alpha") for b, p in OUTPUTS.items()},
)
put(
    "initial dependency on an output",
    "2 3",
    "dependency-known",
    {b: aim(f"({p})[1]", "dependencies", "alpha") for b, p in INITIALS.items()},
)
put(
    "dependency on a parameter",
    "2",
    "dependency-parameter",
    aim(f"({OUTPUTS['2']})[1]", "dependencies", "mount_1.stiffness"),
)
put(
    "dependency twice",
    "2 3",
    "dependency-duplicate",
    {b: attributes(f"({p})[1]", dependencies="1 1") for b, p in OUTPUTS.items()},
)
put("dependencies out of order", "2", "dependency-order", attributes(f"({OUTPUTS['2']})[1]", dependencies="2 1"))
put(
    "kinds of another number",
    "2 3",
    "dependency-kind-count",
    {b: attributes(f"({p})[1]", dependencies="1 2", dependenciesKind="dependent") for b, p in OUTPUTS.items()},
)
put(
    "kinds of no dependencies",
    "2",
    "dependency-kind-count",
    attributes(f"({OUTPUTS['2']})[1]", dependencies=None, dependenciesKind="dependent"),
)
put(
    "late kind at the start",
    "2",
    "dependency-kind",
    attributes(f"({INITIALS['2']})[1]", dependencies="1", dependenciesKind="fixed"),
)
put(
    "kind of an integer",
    "rich",
    "dependency-kind",
    attributes("//Output[@valueReference='17']", dependenciesKind="constant constant"),
)
