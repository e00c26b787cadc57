"""The functions of FMI 2 and FMI 3 as the standard's own headers declare them: for ctypes, and for tests."""

import ctypes as ct
import re
from dataclasses import dataclass
from functools import cache

from fmu_helpers import HEADERS

_SCALARS = {
    "size_t": ct.c_size_t,
    "fmi2Boolean": ct.c_int,
    "fmi2Integer": ct.c_int,
    "fmi2Real": ct.c_double,
    "fmi2ValueReference": ct.c_uint,
    "fmi2StatusKind": ct.c_int,
    "fmi2Type": ct.c_int,
    "fmi3Boolean": ct.c_bool,
    "fmi3Float64": ct.c_double,
    "fmi3ValueReference": ct.c_uint,
}  # everything else is a pointer


@dataclass(frozen=True)
class Parameter:
    name: str
    pointer: bool
    ctype: type


@cache
def signatures(version: int) -> dict[str, tuple[Parameter, ...]]:
    """Name without the prefix "fmi2" or "fmi3" -> its parameters."""
    text = (HEADERS / f"fmi{version}FunctionTypes.h").read_text()
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
    found = re.findall(rf"typedef\s+[\w\s*]*?\bfmi{version}(\w+)TYPE\s*\(([^)]*)\)\s*;", text)
    return {name: tuple(_parameter(one) for one in rest.split(",") if one.strip() != "void") for name, rest in found}


def _parameter(text: str) -> Parameter:
    words = text.replace("*", " * ").replace("[]", " [] ").split()
    kept = [word for word in words if word not in ("const", "*", "[]")]
    pointer = "*" in words or "[]" in words or kept[0] not in _SCALARS
    return Parameter(kept[1] if len(kept) > 1 else "", pointer, ct.c_void_p if pointer else _SCALARS[kept[0]])


def declare(library: ct.CDLL, version: int) -> None:
    """Tells ctypes the argument and result types, so that sizes and doubles are passed as what they are."""
    for name, parameters in signatures(version).items():
        function = getattr(library, f"fmi{version}{name}")
        function.argtypes = [parameter.ctype for parameter in parameters]
        function.restype = ct.c_void_p if name.startswith("Instantiate") else ct.c_int
        if name in ("GetVersion", "GetTypesPlatform"):
            function.restype = ct.c_char_p
        if name == "FreeInstance":
            function.restype = None
