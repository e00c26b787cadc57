"""Rules of components that come from elsewhere: their files and their ports."""

from pathlib import Path

from ...errors import ModelError
from ..build_matrices import build_matrices
from ..build_modal import build_modal
from ..foreign_tables import MatricesTable, ModalTable
from ..tables import FileTable


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
        build_matrices(table, folder, file.dofs, key)
