"""Rules of components that come from elsewhere: their files and their ports."""

from math import dist
from pathlib import Path

from ...components import Matrices, ModalModel
from ...errors import ModelError
from ..build_matrices import SAME_PLACE, build_matrices
from ..build_modal import build_modal
from ..foreign_tables import MatricesTable, ModalTable
from ..joint_tables import BeamJointTable
from ..references import find_port
from ..tables import FileTable
from ..wording import show
from .structures import check_damping


def check_foreign(file: FileTable, folder: Path) -> None:
    """Check every component of matrices or modes; `folder` is where the model file is."""
    for name, table in file.components.items():
        if not isinstance(table, (MatricesTable, ModalTable)):
            continue
        key = f"components.{name}"
        if not table.ports:
            raise ModelError(
                f"{key}.ports", "there is no port", "give at least one, such as ports = { foot = [0, 1, 2] }"
            )
        if isinstance(table, ModalTable):
            build_modal(table, folder, key)
            continue
        check_damping(table, key)
        _check_joints(file, name, build_matrices(table, folder, file.dofs, key))


def _check_joints(file: FileTable, name: str, component: Matrices | ModalModel) -> None:
    """Refuse a joint that lies elsewhere than the node of the file that it holds."""
    for joint_name, joint in file.joints.items():
        for text in joint.between[1:] if isinstance(joint, BeamJointTable) else joint.between:
            port = find_port(file, text, f"joints.{joint_name}.between")
            place = component.position(port.place) if port.component == name and port.place else None
            if place is not None and joint.at is not None and dist(place, joint.at) > SAME_PLACE:
                raise ModelError(
                    f"joints.{joint_name}.at",
                    f"{show(list(joint.at))} is given beside {show(text)}, which the file places at "
                    f"[{', '.join(f'{x:g}' for x in place)}] m",
                    "move one so that they meet, or leave positions out of the file",
                )
