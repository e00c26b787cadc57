"""terminalsAndIcons.xml: the ports of the model as terminals, and where their pictures go (FMI 3.0, clause 2.4.9).

    joint       plug, kind _Gearpath_Joint: for every degree of freedom `force_<dof>`, an outflow (positive on the
                receiver: momentum leaves the source), and `velocity_<dof>`, a signal (of the receiver). Their product
                is the power into the receiver.
    excitation  bus, kind _Gearpath_Excitation: `transmission_error` and `speed` are signals, a `force` or `moment` is
                an inflow (positive on the FMU's component), `velocity` the signal that goes with it.

The force on the ground has no velocity beside it. FMI 2.0 has no terminals of its own and borrows this file as it is.
"""

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence

from ..network.modal import ModalNetwork
from ..network.records import JointRows, Load
from .description import as_file
from .variables import Variable

Member = tuple[str, str, str]  # variable, member, kind
_JOINT, _EXCITATION = "_Gearpath_Joint", "_Gearpath_Excitation"
_COLOUR = {"joint": "213 94 0", "excitation": "0 114 178"}
_SIZE = 18.0  # of a terminal's picture, where there is room; the icon spans -100 ... 100


def terminals_and_icons(network: ModalNetwork, variables: Sequence[Variable]) -> bytes:
    """The file for both versions of FMI; members are among `variables`, whatever these leave out."""
    root = ET.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    drawn = ET.SubElement(root, "GraphicalRepresentation")
    whole = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    ET.SubElement(drawn, "CoordinateSystem", {**whole, "suggestedScalingFactorTo_mm": "0.1"})
    ET.SubElement(drawn, "Icon", whole)
    names = {variable.name for variable in variables}
    found = ET.Element("Terminals")
    joints = [(joint, members) for joint in network.joints if (members := _joint_members(joint, names))]
    taken = {joint.name for joint, _ in joints}
    loads = {
        f"{name}_excitation" if name in taken else name: members
        for name, members in _load_members(network, names).items()
    }
    for k, (joint, members) in enumerate(joints):
        text = f"{joint.kind.capitalize()} to the {'ground' if joint.grounded else 'receiver'}: force on it"
        text += "" if joint.grounded else " and its velocity; their product is the power into it"
        _terminal(found, joint.name, "plug", _JOINT, text, members, _place("joint", k, len(joints)))
    for k, (name, members) in enumerate(loads.items()):
        text = "Excitation; a force or moment is positive on the component that it acts on"
        _terminal(found, name, "bus", _EXCITATION, text, members, _place("excitation", k, len(loads)))
    if len(found):
        root.append(found)
    return as_file(root)


def _joint_members(joint: JointRows, names: set[str]) -> list[Member]:
    members = []
    for dof in joint.dofs:
        for part, kind in (("force", "outflow"), ("velocity", "signal")):
            if f"{joint.name}.{part}_{dof}" in names:
                members.append((f"{joint.name}.{part}_{dof}", f"{part}_{dof}", kind))
    return members


def _load_members(network: ModalNetwork, names: set[str]) -> dict[str, list[Member]]:
    """Name of a terminal -> its members: loads of one mesh together, every actuator on its own."""
    found: dict[str, list[Member]] = {}
    for load in network.loads:
        terminal, member, kind = _load(load)
        if load.name in names:
            found.setdefault(terminal, []).append((load.name, member, kind))
    for terminal, members in found.items():
        for part in ("speed", "velocity"):
            if f"{terminal}.{part}" in names:
                members.append((f"{terminal}.{part}", part, "signal"))
    return found


def _load(load: Load) -> tuple[str, str, str]:
    """Terminal, member and kind of an input."""
    group, _, last = load.name.rpartition(".")
    if load.is_transmission_error:
        return group, last, "signal"
    if last == "force" and group:
        return group, "force" if load.unit == "N" else "moment", "inflow"
    return load.name, "force" if load.unit == "N" else "moment", "inflow"


def _place(picture: str, place: int, count: int) -> Mapping[str, str]:
    """Joints one below the other at the right, excitations at the left."""
    step = 200.0 / count
    half, y = min(_SIZE, 0.8 * step) / 2, 100.0 - (place + 0.5) * step
    x = 100.0 if picture == "joint" else -100.0
    corners = {"x1": x - half, "y1": y - half, "x2": x + half, "y2": y + half}
    return {
        "defaultConnectionColor": _COLOUR[picture],
        **{name: f"{value:g}" for name, value in corners.items()},
        "iconBaseName": picture,
    }


def _terminal(
    parent: ET.Element,
    name: str,
    rule: str,
    kind: str,
    description: str,
    members: Sequence[Member],
    place: Mapping[str, str],
) -> None:
    attributes = {"name": name, "matchingRule": rule, "terminalKind": kind, "description": description}
    terminal = ET.SubElement(parent, "Terminal", attributes)
    for variable, member, how in members:
        each = {"variableName": variable, "memberName": member, "variableKind": how}
        ET.SubElement(terminal, "TerminalMemberVariable", each)
    ET.SubElement(terminal, "TerminalGraphicalRepresentation", dict(place))
