"""The model as tables: components, joints with their matrices and units, excitation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass

from ..components import GearTrain, Section
from ..components.dofs import is_rotation
from ..joints import RIGID, Joint, Port
from ..joints.joint import Matrix
from ..network.foreign import described
from ..network.ports import joint_place
from ..network.system import MeshExcitation, System
from .table import Cell, MatrixCell, Table, table
from .wording import given, listed, number, quantity


def model_tables(system: System) -> list[Table]:
    """All tables of the model's data; those without rows are left out."""
    every = [
        component_table(system),
        shaft_table(system),
        disk_table(system),
        mesh_table(system),
        matrix_table(system),
        place_table(system),
        signal_table(system),
        source_table(system),
    ]
    return [item for item in every if any(group.rows for group in item.groups)]


def component_table(system: System) -> Table:
    """Every component with its scalar data."""
    of_files = described(system)
    rows = [
        [name, _kind(item), of_files.get(name) or "; ".join(_scalars(item))] for name, item in system.components.items()
    ]
    return table("Components (SI units)", ["component", "kind", "data"], rows, text=3)


def shaft_table(system: System) -> Table:
    """Shafts of all gear trains."""
    rows = []
    for train, part in _trains(system):
        for name, shaft in part.shafts.items():
            bores = [_diameters(section) for section in shaft.sections]
            rows.append(
                [
                    f"{train}.{name}",
                    shaft.beam,
                    given(shaft.length),
                    ", ".join(dict.fromkeys(bores)),
                    "(" + ", ".join(given(x) for x in shaft.origin) + ")",
                    " + ".join(str(count) for count in shaft.elements),
                    given(shaft.material.youngs_modulus),
                    given(shaft.material.poisson_ratio),
                    given(shaft.material.density),
                    ", ".join(dict.fromkeys(given(shaft.shear_coefficient_of(s)) for s in shaft.sections)),
                ]
            )
    head = ["shaft", "beam", "length, m", "diameter (bore), m", "first end (x, y, z), m", "elements"]
    return table("Shafts", [*head, "E, Pa", "ν", "ρ, kg/m³", "κ"], rows, text=2)


def _diameters(section: Section) -> str:
    """Outer / inner diameter, of a taper at both ends."""
    ends = [section.diameters(xi) for xi in ((0.0, 1.0) if section.tapered else (0.0,))]
    return " to ".join(given(outer) + (f" / {given(inner)}" if inner else "") for outer, inner in ends)


def disk_table(system: System) -> Table:
    """Gear bodies."""
    rows = [
        [f"{train}.{name}.{disk.name}"]
        + [given(x) for x in (disk.z, disk.mass, disk.diametral_inertia, disk.polar_inertia)]
        for train, part in _trains(system)
        for name, shaft in part.shafts.items()
        for disk in shaft.disks
    ]
    head = ["disk", "z on the shaft, m", "mass, kg", "diametral inertia, kg m²", "polar inertia, kg m²"]
    return table("Gear bodies", head, rows)


def mesh_table(system: System) -> Table:
    """Gear meshes."""
    rows = [
        [
            f"{train}.{name}",
            " – ".join(".".join(gear) for gear in mesh.between),
            given(mesh.stiffness),
            " / ".join(given(r) for r in mesh.base_radii),
            "line of action y" if mesh.pressure_angle is None else given(mesh.pressure_angle),
            given(mesh.helix_angle),
        ]
        for train, part in _trains(system)
        for name, mesh in part.meshes.items()
    ]
    head = ["mesh", "between", "stiffness, N/m", "base radii, m", "pressure angle, rad", "base helix angle, rad"]
    return table("Gear meshes", head, rows, text=2)


def matrix_table(system: System) -> Table:
    """Joints with their stiffness and damping; joints with equal matrices share a row."""
    alike: dict[tuple[object, ...], list[str]] = {}
    for name, joint in system.joints.items():
        alike.setdefault((joint.kind, joint.dofs, joint.stiffness, joint.damping), []).append(name)
    rows: list[list[Cell]] = []
    for names in alike.values():
        joint = system.joints[names[0]]
        if joint.kind == RIGID:
            rows.append([listed(names), joint.kind, f"holds {', '.join(joint.dofs or system.dofs)}", "–"])
            continue
        rows.append(
            [listed(names), joint.kind, _matrix(joint, joint.stiffness, False), _matrix(joint, joint.damping, True)]
        )
    return table("Joints: stiffness and damping", ["joints", "kind", "stiffness K", "damping C"], rows, text=4)


def place_table(system: System) -> Table:
    """Where every joint sits; its force acts on the second port."""
    rows = []
    for name, joint in system.joints.items():
        place = joint_place(system, joint)
        where = "–" if place is None else "(" + ", ".join(given(x) for x in place) + ")"
        rows.append([name, *(port_name(port) for port in joint.between), where])
    head = ["joint", "from (source)", "to (receiver)", "position (x, y, z), m"]
    return table("Joints: where they sit", head, rows, text=3)


def signal_table(system: System) -> Table:
    """Additional actuators and sensors."""
    rows = [["actuators." + name, "force", f"{port_name(a.port)}.{a.dof}"] for name, a in system.actuators.items()]
    rows += [["sensors." + name, s.quantity, f"{port_name(s.port)}.{s.dof}"] for name, s in system.sensors.items()]
    return table("Actuators and sensors", ["signal", "quantity", "where"], rows, text=3)


def source_table(system: System) -> Table:
    """The tones of the gear mesh source of native FMUs."""
    source, rows = system.source, []
    if source is None:
        return table("Gear mesh source", ["tone"], [])
    for tone in source.tones:
        order = tone.harmonic * source.teeth + tone.shift
        rows.append([tone.name, given(order), given(tone.amplitude), given(tone.phase)])
    heading = f"Gear mesh source of native FMUs: {source.load}, {given(source.speed)} rev/min, {source.teeth} teeth"
    return table(heading, ["tone", "shaft order", "amplitude, m", "phase, rad"], rows)


def excitation_words(system: System) -> str:
    """The excitation in words, with its amplitude."""
    item = system.excitation
    if isinstance(item, MeshExcitation):
        size = quantity(item.displacement, "m")
        return f"a transmission error of {size} (peak) in the mesh {item.component}.{item.mesh}"
    unit = "N m" if is_rotation(item.dof) else "N"
    noun = "moment" if is_rotation(item.dof) else "force"
    return f"a {noun} of {quantity(item.force, unit)} (peak) on {port_name(item.port)} along {item.dof}"


def port_name(port: Port) -> str:
    """A port as the model file writes it, such as `gear_train.input@0.25`."""
    if port.shaft is None:
        return port.component
    place = f".{port.disk}" if port.disk is not None else f"@{port.z}"
    return f"{port.component}.{port.shaft}{place}"


def matrix_unit(row: str, column: str, damping: bool) -> str:
    """Unit of the entry of a joint matrix, symmetric: N/m, N/rad, N m/rad; with seconds for damping."""
    turns = is_rotation(row) + is_rotation(column)
    force, motion = ("N", "N", "N m")[turns], ("m", "rad", "rad")[turns]
    return f"{force} s/{motion}" if damping else f"{force}/{motion}"


def _matrix(joint: Joint, matrix: Matrix, damping: bool) -> MatrixCell:
    digits = given if joint.mounting is None else lambda value: number(value, 5)  # a computed matrix
    rows = [
        [(digits(value), matrix_unit(row, column, damping)) for column, value in zip(joint.dofs, values)]
        for row, values in zip(joint.dofs, matrix)
    ]
    return MatrixCell(joint.dofs, rows)


def _trains(system: System) -> Iterator[tuple[str, GearTrain]]:
    for name, component in system.components.items():
        if isinstance(component, GearTrain):
            yield name, component


def _kind(component: object) -> str:
    name = type(component).__name__
    return "".join(f" {c.lower()}" if c.isupper() else c for c in name).strip()


def _scalars(component: object) -> Iterator[str]:
    """The component's plain numbers, by name."""
    assert is_dataclass(component)
    for field in fields(component):
        value = getattr(component, field.name)
        name = field.name.replace("_", " ")
        if not field.init:
            continue
        if isinstance(value, bool | int | float | str):
            yield f"{name} {given(value) if isinstance(value, float) else value}"
        elif isinstance(value, dict) and value and all(isinstance(v, int | float) for v in value.values()):
            yield f"{name} " + ", ".join(f"{k} {given(v)}" for k, v in value.items())
        elif isinstance(value, tuple) and value and all(isinstance(v, int | float) for v in value):
            yield f"{name} ({', '.join(given(v) for v in value)})"
