"""Reads unit names such as N.m.s/rad, (m/s2)/m or kN/mm: factor and exponents of the base units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import pi

Exponents = Mapping[str, int]

_SI: dict[str, tuple[float, dict[str, int]]] = {
    "kg": (1.0, {"kg": 1}),
    "m": (1.0, {"m": 1}),
    "s": (1.0, {"s": 1}),
    "A": (1.0, {"A": 1}),
    "K": (1.0, {"K": 1}),
    "mol": (1.0, {"mol": 1}),
    "cd": (1.0, {"cd": 1}),
    "rad": (1.0, {"rad": 1}),
    "g": (1e-3, {"kg": 1}),
    "N": (1.0, {"kg": 1, "m": 1, "s": -2}),
    "Pa": (1.0, {"kg": 1, "m": -1, "s": -2}),
    "J": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "W": (1.0, {"kg": 1, "m": 2, "s": -3}),
    "V": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "Ohm": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -2}),
}
_OTHERS: dict[str, tuple[float, dict[str, int]]] = {
    "1": (1.0, {}),
    "deg": (pi / 180.0, {"rad": 1}),
    "rev": (2.0 * pi, {"rad": 1}),
    "rpm": (pi / 30.0, {"rad": 1, "s": -1}),
    "min": (60.0, {"s": 1}),
    "h": (3600.0, {"s": 1}),
    "bar": (1e5, {"kg": 1, "m": -1, "s": -2}),
    "%": (0.01, {}),
}
_PREFIXES = {"n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
_TOKEN = re.compile(r"\s*(?:([A-Za-zµμ%]+|1)(?:\^?(-?\d+))?|([./*()]))")


def meaning(name: str) -> tuple[float, dict[str, int]] | None:
    """Factor to SI and exponents, angles counted as rad; None for a name that is not understood."""
    tokens, position = [], 0
    while position < len(name):
        match = _TOKEN.match(name, position)
        if match is None:
            return None
        tokens.append(match)
        position = match.end()
    value, rest = _product(tokens)
    return None if rest else value


def _product(tokens: list[re.Match[str]]) -> tuple[tuple[float, dict[str, int]] | None, list[re.Match[str]]]:
    """A product up to the end or a closing bracket; what follows one slash is divided by, brackets or not."""
    factor, exponents, sign = 1.0, dict[str, int](), 1
    while tokens and tokens[0][3] != ")":
        head, tokens = tokens[0], tokens[1:]
        if head[3] in (".", "*"):
            continue
        if head[3] == "/":
            sign = -1
            continue
        if head[3] == "(":
            part, tokens = _product(tokens)
            if part is None or not tokens:
                return None, tokens
            tokens, power = tokens[1:], 1
        else:
            part, power = _symbol(head[1]), int(head[2] or 1)
        if part is None:
            return None, tokens
        factor *= part[0] ** (sign * power)
        for unit, exponent in part[1].items():
            exponents[unit] = exponents.get(unit, 0) + sign * power * exponent
    return (factor, {unit: e for unit, e in exponents.items() if e}), tokens


def _symbol(text: str) -> tuple[float, dict[str, int]] | None:
    known = _SI | _OTHERS
    if text in known:
        return known[text]
    if text[:1] in _PREFIXES and text[1:] in _SI and text[1:] != "kg":
        factor, exponents = _SI[text[1:]]
        return _PREFIXES[text[0]] * factor, exponents
    return None
