"""Numbers in words: significant digits, units, signs, as an engineer prints them."""

import math

import numpy as np

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_NBSP, _THIN, _MINUS = "\u00a0", "\u202f", "\u2212"


def number(value: float, digits: int = 3) -> str:
    """A result to so many significant digits: 0.0312, 1 509, 3.81 × 10⁻⁷."""
    value = float(value)
    if not math.isfinite(value):
        return "not a number" if math.isnan(value) else ("∞" if value > 0 else f"{_MINUS}∞")
    if value == 0.0:
        return "0"
    exponent = int(f"{value:.{digits - 1}e}".split("e")[1])
    if -4 < exponent < 6:
        grouped = "," if exponent >= 4 else ""
        return _signed(f"{value:{grouped}.{max(digits - 1 - exponent, 0)}f}".replace(",", _THIN))
    mantissa = f"{value / 10.0**exponent:.{digits - 1}f}"
    power = f"10{str(exponent).translate(_SUPERSCRIPT)}"
    return power if mantissa == "1" else _signed(f"{mantissa}{_THIN}×{_THIN}{power}")


def given(value: float) -> str:
    """A number as the model gives it, with its digits (at most 12): 0.04975, 1.2 × 10⁸."""
    value = float(value)
    if value == 0.0 or not math.isfinite(value):
        return number(value)
    digits = next(n for n in range(1, 13) if n == 12 or math.isclose(float(f"{value:.{n - 1}e}"), value, rel_tol=1e-12))
    return number(value, digits)


def percent(share: float, digits: int = 3) -> str:
    """A share as a percentage: three significant digits below 1 %, one decimal above, none above 1000 %."""
    if not math.isfinite(share):
        return "–"
    value = 100.0 * float(share)
    decimals = 1 if abs(value) < 999.95 else 0
    text = _signed(f"{value:.{decimals}f}") if abs(value) >= 1.0 else number(value, digits)
    return f"{text}{_NBSP}%"


def decibel(level: float, unit: bool = True) -> str:
    """A level with one decimal."""
    text = _signed(f"{round(level, 1) + 0.0:.1f}") if math.isfinite(level) else "–"
    return f"{text}{_NBSP}dB" if unit else text


def level(ratio: float) -> float:
    """10 lg |ratio|; minus infinity for zero."""
    with np.errstate(divide="ignore"):
        return float(10.0 * np.log10(abs(ratio)))


def quantity(value: float, unit: str, digits: int | None = None) -> str:
    """A number with its unit; all digits of the model's number unless `digits` says how many."""
    return f"{given(value) if digits is None else number(value, digits)}{_NBSP}{spaced(unit)}"


def spaced(unit: str) -> str:
    """A unit for print: `N.m` is `N m`, `m/s2` is `m/s²`."""
    return unit.replace("rad/s2", "rad/s²").replace("m/s2", "m/s²").replace(".", _NBSP)


def plural(count: int, noun: str) -> str:
    """`1 bearing`, `4 bearings`."""
    ending = "" if count == 1 else ("es" if noun.endswith(("s", "sh", "ch")) else "s")
    return f"{number(count, 6) if count > 9999 else count}{_NBSP}{noun}{ending}"


def listed(words: list[str]) -> str:
    """`a`, `a and b`, `a, b and c`."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _signed(text: str) -> str:
    return text.replace("-", _MINUS)
