"""Rules of measured components: their files, their ports, and the frequencies of the model within their band."""

from pathlib import Path

from ...errors import ModelError
from ..build_measured import build_measured
from ..measured_tables import MeasuredTable
from ..tables import FileTable

_EDGE = 1e-9


def check_measured(file: FileTable, folder: Path) -> None:
    """Check every measured component; `folder` is where the model file is."""
    for name, table in file.components.items():
        if not isinstance(table, MeasuredTable):
            continue
        key = f"components.{name}"
        if not table.ports:
            raise ModelError(f"{key}.ports", "there is no port", "give at least one, ports = { foot = { uy = 0 } }")
        for port, one in table.ports.items():
            if not one.channels:
                raise ModelError(f"{key}.ports.{port}", "has no channel", "give one at least, such as uy = 0")
        low, high = build_measured(table, folder, key).band
        wanted = file.frequency
        for part, value in (("start", wanted.start), ("stop", wanted.stop)):
            if not low * (1.0 - _EDGE) <= value <= high * (1.0 + _EDGE):
                raise ModelError(
                    f"frequency.{part}",
                    f"{value:g} Hz is outside {low:g} to {high:g} Hz, where {name} was measured",
                    "give a range within",
                )
