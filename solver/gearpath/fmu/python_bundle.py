"""The Python files inside a python FMU: solver, model as source and pythonfmu, in a package of its own.

No two different FMUs share a module name, so that any number of them run in one process, each its own code.
"""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from .. import components, joints
from ..errors import GearpathError, InputError
from ..joints import bearings
from ..network import system as system_module
from ..network.system import System
from .python_settings import Entry

_SOLVER = Path(__file__).resolve().parents[1]
_FLOORS = ("numerics", "components", "joints", "reduction", "fitting", "network")
_RUNNING = ("python_parts.py", "python_bearings.py", "python_design.py", "python_settings.py", "python_machine.py")
_TEMPLATES = ("entry.py", "slave.py")
# where hatch_build.py puts them, and where they are in a checkout, which counts more
_FOLDERS = (_SOLVER.parents[1] / "fmu_src" / "pythonfmu", _SOLVER / "fmu" / "runtime" / "pythonfmu")
_PACKAGE = "gearpath_bundle"  # stands for the package in the templates, as GearpathFmu does for the class

REQUIREMENTS = b"numpy>=1.26\nscipy>=1.11\n"


def model_source(system: System, entries: Sequence[Entry], frequency: float) -> str:
    """The model as Python source, exact to the last bit.

    Raises InputError where the source does not give the same system again.
    """
    text = repr(system)
    names = {
        name: value
        for module in (components, joints, bearings, system_module)
        for name, value in vars(module).items()
        if isinstance(value, type)
    }
    used = sorted(name for name in names if f"{name}(" in text)
    try:
        same = eval(text, {name: names[name] for name in used}) == system
    except (NameError, SyntaxError) as error:
        raise InputError(f"the model {system.name} cannot be written as Python source: {error}") from error
    if not same:
        raise InputError(f"the model {system.name} cannot be written as Python source; it holds more than plain values")
    modules: dict[str, list[str]] = {}
    for name in used:
        modules.setdefault(names[name].__module__.removeprefix(_SOLVER.name), []).append(name)
    imports = "".join(f"from {module} import {', '.join(found)}\n" for module, found in sorted(modules.items()))
    table = "".join(f"    {entry!r},\n" for entry in entries)
    return (
        f'"""The model of this FMU; see `network/system.py`."""\n\n{imports}'
        "from .fmu.python_settings import Entry\n\n"
        f"SYSTEM = {text}\nFREQUENCY = {float(frequency)!r}  # Hz, at the start\n"
        f"VARIABLES = (  # a variable's value reference is its place here\n{table})\n"
        f'MODEL = "{_PACKAGE}"\n'
    )


def bundle(model: str, pythonfmu: Mapping[str, bytes], salt: bytes) -> tuple[str, dict[str, bytes]]:
    """All files of `resources/`, and the name of the package, which is a hash of their content and of `salt`.

    `pythonfmu` holds pythonfmu's own Python files by name; they go into the package, so that FMUs of other
    versions of pythonfmu in the same process do not matter.
    """
    templates = _templates()
    files = {f"{_PACKAGE}/{name}": text for name, text in _solver_files().items()}
    files |= {f"{_PACKAGE}/pythonfmu/{name}": text for name, text in pythonfmu.items()}
    files[f"{_PACKAGE}/fmu/slave.py"] = templates["slave.py"]
    files[f"{_PACKAGE}/model.py"] = model.encode()
    files[f"{_PACKAGE}_fmu.py"] = templates["entry.py"]
    digest = hashlib.sha256(salt)
    for name, content in sorted(files.items()):
        digest.update(hashlib.sha256(name.encode()).digest() + hashlib.sha256(content).digest())
    package = f"gearpath_{digest.hexdigest()[:16]}"
    own = (f"{_PACKAGE}/model.py", f"{_PACKAGE}_fmu.py")
    named = {name: _renamed(content, package) if name in own else content for name, content in files.items()}
    named = {name.replace(_PACKAGE, package, 1): content for name, content in named.items()}
    named["slavemodule.txt"] = f"{package}_fmu".encode()
    named["requirements.txt"] = REQUIREMENTS
    return package, named


def _renamed(content: bytes, package: str) -> bytes:
    """The package and class of this FMU in place of those of the template."""
    suffix = package.removeprefix("gearpath_")
    return content.replace(_PACKAGE.encode(), package.encode()).replace(b"GearpathFmu", f"Gearpath{suffix}".encode())


def _solver_files() -> dict[str, bytes]:
    files = {"__init__.py": b'"""Gearpath, as far as an FMU needs it."""\n', "fmu/__init__.py": b""}
    for path in [_SOLVER / "errors.py", *(_SOLVER / "fmu" / name for name in _RUNNING)]:
        files[path.relative_to(_SOLVER).as_posix()] = _read(path)
    for floor in _FLOORS:
        found = sorted((_SOLVER / floor).glob("**/*.py"))
        if not found:
            raise _missing(_SOLVER / floor)
        files |= {path.relative_to(_SOLVER).as_posix(): _read(path) for path in found}
    return files


def _templates() -> dict[str, bytes]:
    folder = next((f for f in _FOLDERS if all((f / name).is_file() for name in _TEMPLATES)), None)
    if folder is None:
        raise _missing(_FOLDERS[-1])
    return {name: _read(folder / name) for name in _TEMPLATES}


def _read(path: Path) -> bytes:
    """A text file with the same bytes on every platform."""
    try:
        return path.read_bytes().replace(b"\r\n", b"\n")
    except OSError as error:
        raise _missing(path) from error


def _missing(path: Path) -> GearpathError:
    return GearpathError(f"Gearpath is not installed completely ({path} is missing); install it again")
