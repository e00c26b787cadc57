"""Rules of joints: their ends, their place, their stiffness and damping."""

from math import dist

from ...errors import ModelError
from ...joints import Port
from ..references import find_port, place_of
from ..tables import FileTable, JointTable
from ..wording import show
from .matrices import check_matrix

_MEETING = 1e-6  # two stations that a joint connects are one place, m


def check_joints(file: FileTable) -> None:
    """Check every joint."""
    for name, joint in file.joints.items():
        key = f"joints.{name}"
        ends = tuple(find_port(file, text, f"{key}.between") for text in joint.between)
        _check_ends(joint, ends, f"{key}.between")
        _check_place(file, joint, ends, key)
        _check_impedance(file, joint, key)


def _check_ends(joint: JointTable, ends: tuple[Port, ...], key: str) -> None:
    if ends[0].is_ground:
        raise ModelError(
            key, f"{show(list(joint.between))} begins with ground", "put ground second, as the receiver"
        )
    if ends[0].component == ends[1].component:
        raise ModelError(
            key,
            f"{show(list(joint.between))} are both on {ends[0].component}",
            "connect two components, or one to ground",
        )


def _check_place(file: FileTable, joint: JointTable, ends: tuple[Port, ...], key: str) -> None:
    places = [place for place in (place_of(file, port) for port in ends) if place is not None]
    if places and joint.at is not None:
        raise ModelError(
            f"{key}.at",
            f"{show(list(joint.at))} is given beside a shaft station, which is the place of the joint",
            "leave at out",
        )
    if not places and joint.at is None:
        raise ModelError(f"{key}.at", "is missing", "give the place of the joint as [x, y, z] in m")
    if len(places) == 2 and dist(*places) > _MEETING:
        raise ModelError(
            f"{key}.between",
            f"the stations {show(list(joint.between))} are {dist(*places):.3g} m apart",
            "a joint has no length: move an origin so that they meet",
        )


def _check_impedance(file: FileTable, joint: JointTable, key: str) -> None:
    if joint.damping is not None and joint.damping_time is not None:
        raise ModelError(
            f"{key}.damping_time",
            f"{joint.damping_time:g} s is given beside damping",
            "give either damping or damping_time",
        )
    if joint.damping is not None and isinstance(joint.damping, tuple) != isinstance(joint.stiffness, tuple):
        raise ModelError(
            f"{key}.damping",
            f"{_form(joint.damping)} is given for a stiffness that is {_form(joint.stiffness)}",
            "give both in the same form, or damping_time",
        )
    for part, value in (("stiffness", joint.stiffness), ("damping", joint.damping)):
        if isinstance(value, tuple):
            check_matrix(value, file.dofs, f"{key}.{part}")
    if not isinstance(joint.stiffness, tuple) and "uy" not in file.dofs:
        raise ModelError(
            f"{key}.stiffness",
            f"{joint.stiffness:g} N/m is one number, which acts along uy, but uy is not among dofs",
            f"give a matrix on {', '.join(file.dofs)}",
        )


def _form(value: object) -> str:
    return "a matrix" if isinstance(value, tuple) else "one number"
