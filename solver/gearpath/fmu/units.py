"""Units of FMU variables: SI base units, what tools show instead, and declared types."""

import re
from collections.abc import Mapping

from ..errors import InputError

# SI base units (and rad) of the named units: exponents of kg, m, s, rad.
_EXPONENTS: Mapping[str, Mapping[str, int]] = {
    "1": {},
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Hz": {"s": -1},
    "rev": {"rad": 1},
    "min": {"s": 1},
}
# Units that are a multiple of their base units.
FACTORS: Mapping[str, float] = {"rev/min": 0.10471975511965977}  # 2 pi / 60
# Shown instead of the SI unit by tools that can: display value = factor * value.
DISPLAY: Mapping[str, tuple[str, float]] = {
    "m": ("um", 1e6),
    "m/s": ("mm/s", 1e3),
    "W": ("mW", 1e3),
    "N/m": ("kN/mm", 1e-6),
    "rad": ("deg", 57.29577951308232),
}
# Declared types: name and quantity of the variables with a unit of their own.
TYPES: Mapping[str, tuple[str, str]] = {
    "m": ("Displacement", "Length"),
    "rad": ("Angle", "Angle"),
    "m/s": ("Velocity", "Velocity"),
    "rad/s": ("AngularVelocity", "AngularVelocity"),
    "m/s2": ("Acceleration", "Acceleration"),
    "rad/s2": ("AngularAcceleration", "AngularAcceleration"),
    "N": ("Force", "Force"),
    "N.m": ("Moment", "Torque"),
    "W": ("Power", "Power"),
    "Hz": ("Frequency", "Frequency"),
    "rev/min": ("ShaftSpeed", "AngularVelocity"),
    "N/m": ("Stiffness", "TranslationalSpringConstant"),
    "N.m/rad": ("RotationalStiffness", "RotationalSpringConstant"),
    "N.s/m": ("Damping", "TranslationalDampingConstant"),
    "N.m.s/rad": ("RotationalDamping", "RotationalDampingConstant"),
}
_TOKEN = re.compile(r"\(|\)|\.|/|[A-Za-z1]+|-?\d+")


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
