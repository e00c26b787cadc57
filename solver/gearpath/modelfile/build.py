"""From a checked file to the `System` that the physics works on."""

from pathlib import Path

from ..components import Disk, GearTrain, Mesh, RigidBody, Section, Shaft
from ..joints import RIGID, Joint, Port, beam_joint
from ..joints.joint import Matrix
from ..network.records import MeshSource, Tone
from ..network.system import (
    Actuator,
    Component,
    MeshExcitation,
    Operation,
    PointExcitation,
    Sensor,
    System,
    Vector,
)
from .bearing_tables import OperationTable
from .build_bearings import build_mounting, catalogue_of
from .build_matrices import build_matrices
from .build_measured import build_measured
from .build_modal import build_modal
from .build_structures import build_frame, build_material, build_plate, shear_coefficient_of
from .foreign_tables import MatricesTable, ModalTable
from .joint_tables import BeamJointTable, BearingTable, JointTable, RigidJointTable
from .measured_tables import MeasuredTable
from .references import beam_offset, find_driving_shaft, find_gear, find_mesh, find_port, mesh_names
from .source_tables import SourceTable
from .structure_tables import FrameTable, PlateTable
from .supplied import shared_dofs
from .tables import ActuatorTable, ComponentTable, ExcitationTable, FileTable, RigidBodyTable
from .train_tables import GearTrainTable, MeshTable, SectionTable, ShaftTable


def build_system(file: FileTable, folder: Path) -> System:
    """The system of a file in `folder` that has passed `check_file`; rolling bearings are yet without stiffness."""
    return System(
        name=file.name,
        dofs=file.dofs,
        components={name: _component(file, table, name, folder) for name, table in file.components.items()},
        joints={name: _joint(file, table, name, folder) for name, table in file.joints.items()},
        excitation=_excitation(file, file.excitation),
        actuators={name: Actuator(_port(file, table), table.dof, _at(table)) for name, table in file.actuators.items()},
        sensors={
            name: Sensor(_port(file, table), table.dof, table.quantity, _at(table))
            for name, table in file.sensors.items()
        },
        loss_frequency=(file.frequency.start * file.frequency.stop) ** 0.5,
        band=file.frequency.stop,
        vectors={
            name: table.vectors
            for name, table in file.components.items()
            if isinstance(table, (PlateTable, FrameTable, MatricesTable)) and table.vectors is not None
        },
        source=None if file.source is None else _source(file, file.source),
        operation=None if file.operation is None else _operation(file, file.operation),
    )


def _component(file: FileTable, table: ComponentTable, name: str, folder: Path) -> Component:
    if isinstance(table, MatricesTable):
        return build_matrices(table, folder, file.dofs, f"components.{name}")
    if isinstance(table, ModalTable):
        return build_modal(table, folder, f"components.{name}")
    if isinstance(table, MeasuredTable):
        return build_measured(table, folder, f"components.{name}")
    if isinstance(table, PlateTable):
        return build_plate(file.materials, table)
    if isinstance(table, FrameTable):
        return build_frame(file.materials, table)
    if isinstance(table, RigidBodyTable):
        inertia = {key: value for key, value in table.inertia.model_dump().items() if value != 0.0}
        return RigidBody(table.mass, inertia, table.centre_of_gravity)
    meshes = {name: build_mesh(table, mesh) for name, mesh in table.meshes.items()}
    shafts = {name: build_shaft(file, shaft) for name, shaft in table.shafts.items()}
    return GearTrain(shafts, meshes, table.modal_damping)


def build_mesh(train: GearTrainTable, table: MeshTable) -> Mesh:
    """A mesh whose gears are known."""
    first, second = (find_gear(train, text, "between") for text in table.between)
    return Mesh((first, second), **table.model_dump(exclude={"between"}))


def build_shaft(file: FileTable, table: ShaftTable) -> Shaft:
    """A shaft whose material is known and whose form is complete."""
    material = build_material(file.materials, table.material)
    if table.length is not None and table.diameter is not None:
        sections: tuple[Section, ...] = (Section(table.length, table.diameter),)
    else:
        sections = tuple(_section(part) for part in table.sections)
    return Shaft(
        material=material,
        origin=table.origin,
        sections=sections,
        shear_coefficient=table.shear_coefficient,
        elements=table.elements if isinstance(table.elements, tuple) else (table.elements,),
        disks=tuple(Disk(**disk.model_dump()) for disk in table.disks),
        beam=table.beam,
    )


def _section(table: SectionTable) -> Section:
    (outer, outer_end), (inner, inner_end) = table.diameters()
    if (outer, inner) == (outer_end, inner_end):
        return Section(table.length, outer, inner)
    return Section(table.length, outer, inner, outer_end, inner_end)


def _operation(file: FileTable, table: OperationTable) -> Operation:
    component, shaft = find_driving_shaft(file, table.shaft)
    return Operation(component, table.torque, shaft, table.speed)


def _joint(file: FileTable, table: JointTable, name: str, folder: Path) -> Joint:
    first, second = (find_port(file, text, "between") for text in table.between)
    if isinstance(table, BeamJointTable):
        return _beam_joint(file, table, (first, second))
    if isinstance(table, RigidJointTable):
        return Joint(RIGID, (first, second), table.dofs or (), (), (), table.at)
    mounting = None
    if isinstance(table, BearingTable):
        mounting = build_mounting(table, file.dofs, f"joints.{name}", catalogue_of(file, folder))
    stiffness = _matrix(table.stiffness) if table.stiffness is not None else _nothing(len(file.dofs))
    if table.damping is not None:
        damping = _matrix(table.damping)
    else:
        time = table.damping_time or 0.0
        damping = tuple(tuple(time * value for value in row) for row in stiffness)
    scalar = isinstance(table.stiffness, float)
    dofs = ("uy",) if scalar else shared_dofs(file, (first, second))
    if not scalar:
        stiffness, damping = (_part(matrix, file.dofs, dofs) for matrix in (stiffness, damping))
    return Joint(
        table.kind,
        (first, second),
        dofs,
        stiffness,
        damping,
        table.at,
        scalar,
        table.loss_factor,
        mounting=mounting,
    )


def _part(matrix: Matrix, dofs: tuple[str, ...], kept: tuple[str, ...]) -> Matrix:
    """Rows and columns of the degrees of freedom that a joint connects."""
    places = [dofs.index(dof) for dof in kept]
    return tuple(tuple(matrix[i][k] for k in places) for i in places)


def _nothing(size: int) -> Matrix:
    return ((0.0,) * size,) * size


def _beam_joint(file: FileTable, table: BeamJointTable, between: tuple[Port, Port]) -> Joint:
    material = build_material(file.materials, table.material)
    kappa = shear_coefficient_of(table.shear_coefficient, table.diameter, table.inner_diameter, material.poisson_ratio)
    return beam_joint(
        between,
        beam_offset(file, table),
        file.dofs,
        table.diameter,
        material.youngs_modulus,
        material.poisson_ratio,
        table.inner_diameter,
        kappa,
        table.loss_factor,
        table.at,
    )


def _matrix(value: float | Matrix) -> Matrix:
    """The exactly symmetric matrix of a value that is symmetric to rounding."""
    if not isinstance(value, tuple):
        return ((value,),)
    columns = tuple(zip(*value))
    return tuple(tuple(a / 2.0 + b / 2.0 for a, b in zip(row, column)) for row, column in zip(value, columns))


def _excitation(file: FileTable, table: ExcitationTable) -> MeshExcitation | PointExcitation:
    if table.mesh:
        component, mesh = find_mesh(file, table.mesh, "mesh")
        return MeshExcitation(component, mesh, table.displacement)
    return PointExcitation(find_port(file, table.point, "point"), table.dof, table.force, table.at)


def _source(file: FileTable, table: SourceTable) -> MeshSource:
    _, mesh = find_mesh(file, table.mesh or mesh_names(file)[0], "source.mesh")
    harmonics = [
        Tone(f"{mesh}.harmonic_{tone.order}", float(tone.order), 0.0, tone.amplitude, tone.phase)
        for tone in table.harmonics
    ]
    sidebands = [
        Tone(f"{mesh}.sideband_{i}", float(tone.harmonic), tone.order, tone.amplitude, tone.phase)
        for i, tone in enumerate(table.sidebands, start=1)
    ]
    return MeshSource(f"{mesh}.transmission_error", table.speed, table.teeth, (*harmonics, *sidebands))


def _port(file: FileTable, table: ActuatorTable) -> Port:
    if isinstance(table.point, str):
        return find_port(file, f"{table.component}.{table.point}", "point")
    return Port(table.component)


def _at(table: ActuatorTable) -> Vector | None:
    return table.point if isinstance(table.point, tuple) else None
