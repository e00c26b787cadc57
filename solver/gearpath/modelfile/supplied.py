"""Which degrees of freedom the ends of a joint supply: what a port from elsewhere lacks, the joint leaves free."""

from ..joints import Port
from .foreign_tables import MatricesTable, ModalTable
from .measured_tables import MeasuredTable
from .tables import FileTable


def supplied_dofs(file: FileTable, port: Port) -> tuple[str, ...]:
    """Active degrees of freedom that a port has, in the model's order."""
    table = None if port.is_ground else file.components[port.component]
    if isinstance(table, MeasuredTable) and port.place is not None:
        return tuple(dof for dof in file.dofs if dof in table.ports[port.place].channels)
    if isinstance(table, (MatricesTable, ModalTable)) and port.place is not None:
        given = table.ports[port.place].supplied(file.dofs)
        return tuple(dof for dof in file.dofs if dof in given)
    return file.dofs


def shared_dofs(file: FileTable, ends: tuple[Port, Port]) -> tuple[str, ...]:
    """Active degrees of freedom that both ends have: those that a joint between them connects."""
    first, second = (supplied_dofs(file, port) for port in ends)
    return tuple(dof for dof in first if dof in second)
