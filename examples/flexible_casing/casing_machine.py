"""The helical gearbox of models/ with another casing: from the finite element code, or rigid with the same mass."""

import re
import tomllib
from pathlib import Path

import numpy as np
from casing_matrices import NODES
from casing_mesh import FEET
from casing_prisms import MassProperties

import gearpath as gp

HELICAL = Path(__file__).resolve().parents[2] / "models" / "helical_gearbox.toml"
SEAT = "seat_1"  # where the casing alone is excited
FOOT = 1e9  # N/m, of each foot along x, y, z
DAMPING = 0.01  # chosen, of every elastic mode of the casing
VECTORS = 120  # interior vectors of the reduced casing; with 240 the power changes by less than 0.002 dB
PORTS = "\n".join(  # the mounts have no rotational stiffness
    f"{name} = {{ node = {node}, rotations = {str(name.startswith('seat')).lower()} }}" for name, node in NODES.items()
)
TABLE = f"""kind = "matrices"
file = "casing.npz"
modal_damping = {DAMPING}
vectors = {VECTORS}

[components.casing.ports]
{PORTS}
"""


def write_machine(path: Path) -> gp.Model:
    """Two changes of the helical gearbox: the table of the casing, and which of its nodes each joint takes hold of."""
    text = HELICAL.read_text(encoding="utf-8")
    text = re.sub(r"(?ms)^(\[components\.casing\])[^\n]*\n.*?(?=^# Bearings)", rf"\1\n{TABLE}\n", text)
    text = re.sub(
        r'(\[joints\.bearing_(\d)\].*?between = \[[^\]]*)"casing"', r'\1"casing.seat_\2"', text, flags=re.DOTALL
    )
    text = re.sub(r'(\[joints\.mount_(\d)\].*?between = \[)"casing"', r'\1"casing.foot_\2"', text, flags=re.DOTALL)
    path.write_text(text, encoding="utf-8")
    return gp.load(path)


def rigid_twin(own: MassProperties) -> gp.Model:
    """The helical gearbox with a rigid casing of this mass and inertia."""
    data = tomllib.loads(HELICAL.read_text(encoding="utf-8"))
    inertia = {a + b: own.inertia[i, j].item() for i, a in enumerate("xyz") for j, b in enumerate("xyz") if i <= j}
    data["components"]["casing"] = {
        "kind": "rigid_body",
        "mass": own.mass,
        "inertia": inertia,
        "centre_of_gravity": own.centre.tolist(),
    }
    return gp.Model.from_dict(data, str(HELICAL))


def held(flexible: gp.Model) -> gp.Model:
    """The flexible casing alone on stiff feet; a force along y at the first seat, and what it moves.

    A loss factor takes the place of the modal damping: (1 + i eta) K is a matrix that others can solve, too.
    """
    casing = {key: value for key, value in flexible.to_dict()["components"]["casing"].items() if key != "modal_damping"}
    spring = {"kind": "mount", "stiffness": np.diag([FOOT] * 3 + [0.0] * 3).tolist()}
    return gp.Model.from_dict(
        {
            "name": "held_casing",
            "frequency": flexible.to_dict()["frequency"],
            "components": {"casing": casing | {"loss_factor": 2.0 * DAMPING}},
            "joints": {f"on_{foot}": {**spring, "between": [f"casing.{foot}", "ground"]} for foot in FEET},
            "sensors": {"seat": {"component": "casing", "point": SEAT, "dof": "uy", "quantity": "displacement"}},
            "excitation": {"point": f"casing.{SEAT}", "dof": "uy"},
        },
        flexible.file,
    )
