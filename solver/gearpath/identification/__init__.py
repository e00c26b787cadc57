"""Joints identified in situ: K and C from mobilities of the assembled machine on both their sides."""

from .identify import identify, port_names
from .record import CrossTalk, IdentifiedJoint, JointIdentification
from .simulate import chosen_joints, joint_mobility, with_noise

__all__ = [
    "CrossTalk",
    "IdentifiedJoint",
    "JointIdentification",
    "chosen_joints",
    "identify",
    "joint_mobility",
    "port_names",
    "with_noise",
]
