"""What a validation finds: checks with a figure and a limit, and the curves that were compared."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..numerics.arrays import Complex, Real
from .conformance import Finding


@dataclass(frozen=True)
class Check:
    """One check: passed if the measured figure does not exceed its limit (NaN never passes)."""

    name: str
    figure: float
    limit: float
    what: str  # what the figure is, in words, such as "largest deviation relative to the largest value"

    @property
    def passed(self) -> bool:
        """Whether the figure is within the limit."""
        return bool(self.figure <= self.limit)


@dataclass(frozen=True)
class Comparison:
    """A transfer as the FMU gives it and as the solver does: complex values over frequency (Hz)."""

    name: str  # output variable, such as "bearing_1.force_uy"
    unit: str
    frequency: Real  # where the FMU was simulated
    simulated: Complex  # steady state of the simulated FMU
    solver_frequency: Real
    solver: Complex  # the mobility synthesis


@dataclass(frozen=True)
class ValidationReport:
    """All checks of one FMU."""

    fmu: Path
    model: str
    kind: str  # "native" | "python"
    checks: tuple[Check, ...]
    comparisons: tuple[Comparison, ...] = ()
    notes: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()  # of the conformance check

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)
