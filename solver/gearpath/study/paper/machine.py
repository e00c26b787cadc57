"""The paper's machines as they are shipped, and the changes that its studies make to them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...modelfile import Model, load

_PACKAGE = Path(__file__).resolve().parents[2]
_FOLDERS = (_PACKAGE / "models", _PACKAGE.parents[1] / "models")  # of an installed wheel, of a checkout


def shipped(name: str = "gearbox") -> Model:
    """A model file that comes with Gearpath; raises InputError where the installation lacks it."""
    for folder in _FOLDERS:
        if (folder / f"{name}.toml").is_file():
            return load(folder / f"{name}.toml")
    raise InputError(f"{name}.toml: this installation does not hold the model file; install Gearpath again")


def bearings(model: Model) -> list[str]:
    """Names of the bearings."""
    return [name for name, joint in model.system.joints.items() if joint.kind == "bearing"]


def mounts(model: Model) -> list[str]:
    """Names of the mounts."""
    return [name for name, joint in model.system.joints.items() if joint.kind == "mount"]


def scaled_joints(model: Model, names: list[str], stiffness: float = 1.0, damping: float = 1.0) -> dict[str, Any]:
    """Changes that scale K and C of the joints, each by its own factor."""
    changes: dict[str, Any] = {}
    for name in names:
        joint = model.system.joints[name]
        changes[f"joints.{name}.stiffness"] = _value(stiffness * np.array(joint.stiffness), joint.scalar)
        changes[f"joints.{name}.damping"] = _value(damping * np.array(joint.damping), joint.scalar)
    return changes


def masked_bearings(model: Model, keep: ArrayLike) -> dict[str, Any]:
    """Changes that keep only the entries of K and C where `keep` (d, d) is 1."""
    changes: dict[str, Any] = {}
    for name in bearings(model):
        joint = model.system.joints[name]
        changes[f"joints.{name}.stiffness"] = _value(np.array(joint.stiffness) * keep, joint.scalar)
        changes[f"joints.{name}.damping"] = _value(np.array(joint.damping) * keep, joint.scalar)
    return changes


def shifted_casing(model: Model, x: float = 0.0, z: float = 0.0) -> dict[str, Any]:
    """Changes that move the centre of gravity of the casing, m."""
    place = model.to_dict()["components"]["casing"]["centre_of_gravity"]
    return {"components.casing.centre_of_gravity": [place[0] + x, place[1], place[2] + z]}


def shifted_mounts(model: Model, x: float = 0.0, z: float = 0.0) -> dict[str, Any]:
    """Changes that move all mounts, m."""
    changes: dict[str, Any] = {}
    for name in mounts(model):
        place = model.system.joints[name].at
        assert place is not None  # mounts of a rigid casing stand somewhere
        changes[f"joints.{name}.at"] = [place[0] + x, place[1], place[2] + z]
    return changes


def changed_shafts(model: Model, **values: Any) -> dict[str, Any]:
    """Changes of the same keys on every shaft of the gear train, such as beam="euler"."""
    shafts = model.to_dict()["components"]["gear_train"]["shafts"]
    return {f"components.gear_train.shafts.{name}.{key}": value for name in shafts for key, value in values.items()}


def shifted_gears(model: Model, z: float) -> dict[str, Any]:
    """Changes that move the disks along their shafts, m; the numbers of elements stay."""
    shafts = model.to_dict()["components"]["gear_train"]["shafts"]
    return {
        f"components.gear_train.shafts.{name}.disks.{disk['name']}.z": disk["z"] + z
        for name, shaft in shafts.items()
        for disk in shaft["disks"]
    }


def _value(matrix: Any, scalar: bool) -> Any:
    return float(matrix[0, 0]) if scalar else np.asarray(matrix).tolist()
