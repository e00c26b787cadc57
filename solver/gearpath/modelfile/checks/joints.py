"""Rules of joints: their ends, their place, their stiffness and damping."""

from math import dist, hypot
from pathlib import Path

from ...errors import ModelError
from ...joints import Port
from ...joints.matrix_checks import check_matrix
from ..build_bearings import catalogue_of
from ..build_structures import build_plate
from ..hints import hint
from ..joint_tables import BeamJointTable, BearingTable, JointTable, MatrixJointTable, RigidJointTable
from ..references import PORTED, beam_offset, find, find_port, place_of
from ..structure_tables import PlateTable
from ..supplied import shared_dofs
from ..tables import FileTable
from ..wording import show
from .bearings import check_bearing
from .structures import as_model_error

# for each axis of an offset: which rotation moves which translation of its far end
_CARRIED = ((("rz", "uy"), ("ry", "uz")), (("rz", "ux"), ("rx", "uz")), (("ry", "ux"), ("rx", "uy")))
_MEETING = 1e-6  # two stations that a joint connects are one place, m


def check_joints(file: FileTable, folder: Path) -> None:
    """Check every joint; `folder` is where the model file is."""
    catalogue_file = catalogue_of(file, folder)
    for name, joint in file.joints.items():
        key = f"joints.{name}"
        ends = tuple(find_port(file, text, f"{key}.between") for text in joint.between)
        _check_ends(joint, ends, f"{key}.between")
        _check_place(file, joint, ends, key)
        _check_supplied(file, joint, (ends[0], ends[1]), key)
        if isinstance(joint, BeamJointTable):
            _check_beam(file, joint, ends, key)
        else:
            _check_meeting(file, joint, ends, key)
            if isinstance(joint, RigidJointTable):
                _check_rigid(file, joint, ends, key)
                continue
            if isinstance(joint, BearingTable):
                check_bearing(file, joint, key, catalogue_file)
            _check_impedance(file, joint, key)


def _check_ends(joint: JointTable, ends: tuple[Port, ...], key: str) -> None:
    if ends[0].is_ground:
        raise ModelError(key, f"{show(list(joint.between))} begins with ground", "put ground second, as the receiver")
    if ends[0].component == ends[1].component:
        raise ModelError(
            key,
            f"{show(list(joint.between))} are both on {ends[0].component}",
            "connect two components, or one to ground",
        )


def _is_named(file: FileTable, port: Port) -> bool:
    """Whether a port moves as it does wherever it is: the ground, and named ports of components from elsewhere."""
    return port.is_ground or isinstance(file.components[port.component], PORTED)


def _check_place(file: FileTable, joint: JointTable, ends: tuple[Port, ...], key: str) -> None:
    placed = [port for port in ends if place_of(file, port) is not None]
    if placed and joint.at is not None and not (isinstance(joint, BeamJointTable) and ends[1] not in placed):
        what = "a shaft station" if any(port.shaft for port in placed) else "a footprint or node"
        raise ModelError(
            f"{key}.at",
            f"{show(list(joint.at))} is given beside {what}, which is the place of the joint",
            "leave at out",
        )
    if not placed and joint.at is None and not all(_is_named(file, port) for port in ends):
        raise ModelError(f"{key}.at", "is missing", "give the place of the joint as [x, y, z] in m")
    for port in ends:
        table = None if port.is_ground else file.components[port.component]
        if isinstance(table, PlateTable) and port.place is None and joint.at is not None:
            plate, at = build_plate(file.materials, table), joint.at
            as_model_error(lambda plate=plate, at=at: plate.mesh([at]), f"{key}.at")  # type: ignore[misc]


def _check_supplied(file: FileTable, joint: JointTable, ends: tuple[Port, Port], key: str) -> None:
    """Refuse a joint whose ends share no degree of freedom, or not those that it needs."""
    shared = shared_dofs(file, ends)
    scalar = isinstance(joint, MatrixJointTable) and isinstance(joint.stiffness, float)
    needed = ("uy",) if scalar and "uy" in file.dofs else file.dofs if isinstance(joint, BeamJointTable) else shared[:1]
    lacking = [dof for dof in needed if dof not in shared]
    if lacking or not shared:
        what = lacking[0] if lacking else "any of the active dofs"
        raise ModelError(
            f"{key}.between",
            f"the ends {show(list(joint.between))} do not both have {what}, which the joint needs",
            "connect other ports, or add the channel to the ports of the component",
        )


def _check_meeting(file: FileTable, joint: JointTable, ends: tuple[Port, ...], key: str) -> None:
    places = [place for port in ends if (place := place_of(file, port)) is not None]
    if len(places) == 2 and dist(*places) > _MEETING:
        shafts = all(port.shaft for port in ends)
        wanted = "rigid joint" if isinstance(joint, RigidJointTable) else "bearing or mount"
        raise ModelError(
            f"{key}.between",
            f"the {'stations' if shafts else 'ends'} {show(list(joint.between))} are {dist(*places):.3g} m apart",
            "a joint has no length: move an origin so that they meet"
            if shafts
            else f"a {wanted} has no length: move one so that they meet, or use a beam_joint",
        )


def _check_beam(file: FileTable, joint: BeamJointTable, ends: tuple[Port, ...], key: str) -> None:
    find("material", joint.material, file.materials, f"{key}.material")
    if joint.inner_diameter >= joint.diameter:
        raise ModelError(
            f"{key}.inner_diameter",
            f"{joint.inner_diameter:g} m is not below the diameter, {joint.diameter:g} m",
            "give an inner diameter below the outer one, 0 for a solid beam",
        )
    known = place_of(file, ends[0]) is not None and (place_of(file, ends[1]) is not None or joint.at is not None)
    if known and joint.offset is not None:
        raise ModelError(
            f"{key}.offset",
            f"{show(list(joint.offset))} is given beside the places of both ends",
            "leave offset out",
        )
    if not known and joint.offset is None:
        raise ModelError(
            f"{key}.offset", "is missing", "give the way from the source's end to the receiver's as [x, y, z] in m"
        )
    offset = beam_offset(file, joint)
    for axis, (turn, moved) in ((a, pair) for a, pairs in enumerate(_CARRIED) for pair in pairs):
        if abs(offset[axis]) > _MEETING and moved in file.dofs and turn not in file.dofs:
            raise ModelError(
                f"{key}.between",
                f"the joint reaches {offset[axis]:g} m along {'xyz'[axis]}, where a turn {turn} moves its end {moved}",
                f"add {turn} to dofs",
            )
    if hypot(*offset) <= _MEETING:
        raise ModelError(
            f"{key}.between",
            f"the ends {show(list(joint.between))} are at the same place",
            "a beam joint bridges the way between its ends: move one, or use a bearing or mount",
        )


def _check_rigid(file: FileTable, joint: RigidJointTable, ends: tuple[Port, ...], key: str) -> None:
    for port in ends:
        if not port.is_ground and file.components[port.component].kind == "measured":
            raise ModelError(
                f"{key}.between",
                f"{show(port.component)} was measured, and its mobilities cannot be held rigidly",
                "give a stiff mount or bearing instead",
            )
    for dof in joint.dofs or ():
        if dof not in file.dofs:
            raise ModelError(f"{key}.dofs", f"{show(dof)} is not among the active dofs", hint(dof, file.dofs))


def _check_impedance(file: FileTable, joint: MatrixJointTable, key: str) -> None:
    if joint.damping is not None and joint.damping_time is not None:
        raise ModelError(
            f"{key}.damping_time",
            f"{joint.damping_time:g} s is given beside damping",
            "give either damping or damping_time",
        )
    given = joint.damping is not None and joint.stiffness is not None
    if given and isinstance(joint.damping, tuple) != isinstance(joint.stiffness, tuple):
        raise ModelError(
            f"{key}.damping",
            f"{_form(joint.damping)} is given for a stiffness that is {_form(joint.stiffness)}",
            "give both in the same form, or damping_time",
        )
    for part, value in (("stiffness", joint.stiffness), ("damping", joint.damping)):
        if isinstance(value, tuple):
            check_matrix(value, file.dofs, f"{key}.{part}")
    if isinstance(joint.stiffness, float) and "uy" not in file.dofs:
        raise ModelError(
            f"{key}.stiffness",
            f"{joint.stiffness:g} N/m is one number, which acts along uy, but uy is not among dofs",
            f"give a matrix on {', '.join(file.dofs)}",
        )


def _form(value: object) -> str:
    return "a matrix" if isinstance(value, tuple) else "one number"
