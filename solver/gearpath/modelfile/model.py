"""The model: one checked file, immutable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import InputError, ModelError
from ..network.operation import at_operating_point
from ..network.system import System
from ..numerics.arrays import Real
from .build import build_system
from .checks import check_file
from .edit import edited
from .problems import first_problem
from .reading import read_toml
from .tables import FileTable, FrequencyTable
from .wording import plain


@dataclass(frozen=True)
class Model:
    """A checked model; made by `load` or `Model.from_dict`, equal to any other of the same content."""

    table: FileTable = field(repr=False)
    file: str | None = field(default=None, compare=False)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], file: str | None = None) -> Model:
        """The model of a dict in the language of the file; raises ModelError on the first thing wrong."""
        try:
            copied = plain(data)
            table = FileTable.model_validate(copied)
            check_file(table, _folder(file))
        except ValidationError as error:
            raise first_problem(error, copied, file) from None
        except ModelError as error:
            raise ModelError(error.key, error.problem, error.remedy, file=file) from None
        except RecursionError:
            raise ModelError("the file", "is nested too deeply", "write flat tables", file=file) from None
        return cls(table, file)

    @property
    def name(self) -> str:
        """Name of the model."""
        return self.table.name

    @property
    def dofs(self) -> tuple[str, ...]:
        """Active degrees of freedom; matrices of joints follow their order."""
        return self.table.dofs

    @property
    def frequency(self) -> FrequencyTable:
        """The sweep of the file: start and stop in Hz, points, and `frequencies()`."""
        return self.table.frequency

    def frequencies(self) -> Real:
        """All frequencies of the sweep, Hz."""
        return self.frequency.frequencies()

    @cached_property
    def system(self) -> System:
        """Components, joints and excitation as plain dataclasses; `eval` of its `repr` gives it again.

        Rolling bearings have the stiffness of their operating point. Raises ModelError where there is none.
        """
        try:
            return at_operating_point(build_system(self.table, _folder(self.file)))
        except InputError as error:
            key, _, text = str(error).partition(": ")
            problem, _, remedy = text.partition("; ")
            raise ModelError(key, problem, remedy, file=self.file) from None

    def to_dict(self) -> dict[str, Any]:
        """What the file says, as a plain dict that `from_dict` accepts."""
        data = plain(self.table.model_dump(exclude_unset=True))
        assert isinstance(data, dict)
        return data

    def replace(self, changes: Mapping[str, Any]) -> Model:
        """A new model with other values at dotted paths, checked like the file.

        Lists are entered by index or by the name of the entry (`...shafts.input.disks.pinion.z`).
        Of keys that exclude each other, such as damping and damping_time, the one set replaces the other.
        """
        full = plain(self.table.model_dump())
        assert isinstance(full, dict)
        try:
            data = edited(self.to_dict(), full, changes)
        except ModelError as error:
            raise ModelError(error.key, error.problem, error.remedy, file=self.file) from None
        return type(self).from_dict(data, self.file)

    def __hash__(self) -> int:
        return hash((self.name, self.dofs, *self.table.joints))


def _folder(file: str | None) -> Path:
    return Path(file).parent if file else Path()


def load(path: str | PathLike[str]) -> Model:
    """Read and check a model file (TOML); raises InputError or ModelError, one sentence each."""
    return Model.from_dict(read_toml(path), str(path))
