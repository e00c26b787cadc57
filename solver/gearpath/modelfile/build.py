"""From a checked file to the `System` that the physics works on."""

from ..components import Disk, GearTrain, Material, Mesh, RigidBody, Section, Shaft
from ..joints import Joint, Port
from ..joints.joint import Matrix
from ..network.system import Actuator, Component, MeshExcitation, PointExcitation, Sensor, System, Vector
from .references import find_gear, find_mesh, find_port
from .tables import ActuatorTable, ExcitationTable, FileTable, JointTable, RigidBodyTable
from .train_tables import GearTrainTable, ShaftTable


def build_system(file: FileTable) -> System:
    """The system of a file that has passed `check_file`."""
    return System(
        name=file.name,
        dofs=file.dofs,
        components={name: _component(file, table) for name, table in file.components.items()},
        joints={name: _joint(file, table) for name, table in file.joints.items()},
        excitation=_excitation(file, file.excitation),
        actuators={name: Actuator(_port(file, table), table.dof, _at(table)) for name, table in file.actuators.items()},
        sensors={
            name: Sensor(_port(file, table), table.dof, table.quantity, _at(table))
            for name, table in file.sensors.items()
        },
    )


def _component(file: FileTable, table: GearTrainTable | RigidBodyTable) -> Component:
    if isinstance(table, RigidBodyTable):
        inertia = {key: value for key, value in table.inertia.model_dump().items() if value != 0.0}
        return RigidBody(table.mass, inertia, table.centre_of_gravity)
    meshes = {}
    for name, mesh in table.meshes.items():
        first, second = (find_gear(table, text, name) for text in mesh.between)
        meshes[name] = Mesh((first, second), mesh.stiffness, mesh.base_radii)
    shafts = {name: build_shaft(file, shaft) for name, shaft in table.shafts.items()}
    return GearTrain(shafts, meshes, table.modal_damping)


def build_shaft(file: FileTable, table: ShaftTable) -> Shaft:
    """A shaft whose material is known and whose form is complete."""
    material = Material(**file.materials[table.material].model_dump())
    if table.length is not None and table.diameter is not None:
        sections: tuple[Section, ...] = (Section(table.length, table.diameter),)
    else:
        sections = tuple(Section(part.length, part.outer, part.inner) for part in table.sections)
    return Shaft(
        material=material,
        origin=table.origin,
        sections=sections,
        shear_coefficient=table.shear_coefficient,
        elements=table.elements if isinstance(table.elements, tuple) else (table.elements,),
        disks=tuple(Disk(**disk.model_dump()) for disk in table.disks),
        beam=table.beam,
    )


def _joint(file: FileTable, table: JointTable) -> Joint:
    first, second = (find_port(file, text, "between") for text in table.between)
    stiffness = _matrix(table.stiffness)
    if table.damping is not None:
        damping = _matrix(table.damping)
    else:
        time = table.damping_time or 0.0
        damping = tuple(tuple(time * value for value in row) for row in stiffness)
    scalar = not isinstance(table.stiffness, tuple)
    dofs = ("uy",) if scalar else file.dofs
    return Joint(table.kind, (first, second), dofs, stiffness, damping, table.at, scalar)


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


def _port(file: FileTable, table: ActuatorTable) -> Port:
    if isinstance(table.point, str):
        return find_port(file, f"{table.component}.{table.point}", "point")
    return Port(table.component)


def _at(table: ActuatorTable) -> Vector | None:
    return table.point if isinstance(table.point, tuple) else None
