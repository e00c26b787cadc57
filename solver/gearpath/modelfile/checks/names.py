"""Names of components, joints and meshes begin the names of inputs and outputs, so they must differ."""

from ...errors import ModelError
from ..tables import FileTable
from ..train_tables import GearTrainTable
from ..wording import show

RESERVED = (
    "ground",
    "frf",
    "alpha",
    "alpha_force",
    "alpha_moment",
    "frequency",
    "actuators",
    "sensors",
    "time",
    "excitation",
    "operation",
)


def check_names(file: FileTable) -> None:
    """Refuse reserved names and a name used twice."""
    taken: dict[str, str] = {}
    for name, key in _names(file):
        if name in RESERVED:
            raise ModelError(key, f"{show(name)} is a reserved name", "choose another name")
        if name in taken:
            raise ModelError(key, f"{show(name)} is already the name of {taken[name]}", "choose another name")
        taken[name] = key


def _names(file: FileTable) -> list[tuple[str, str]]:
    """(name, key) of everything whose names share the variables of an FMU."""
    names = [(name, f"components.{name}") for name in file.components]
    for name, component in file.components.items():
        if isinstance(component, GearTrainTable):
            names += [(mesh, f"components.{name}.meshes.{mesh}") for mesh in component.meshes]
    return names + [(name, f"joints.{name}") for name in file.joints]
