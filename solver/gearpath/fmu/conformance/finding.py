"""A rule of the standard, and a finding: one place in one file where a rule is broken."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

_EDITION = {2: "FMI 2.0.4", 3: "FMI 3.0.1"}


class Severity(StrEnum):
    """How much a finding matters."""

    ERROR = "error"  # the standard forbids it, or an importer will fail
    WARNING = "warning"  # allowed, but importers stumble or users miss something
    NOTE = "note"  # something was not checked


@dataclass(frozen=True)
class Rule:
    """What an FMU must fulfil, and where the standard says so."""

    id: str
    severity: Severity
    demand: str  # one sentence
    clause_2: str | None = None  # section of FMI 2.0.4; None where the rule does not concern FMI 2
    clause_3: str | None = None  # section of FMI 3.0.1

    def clause(self, version: int | None) -> str:
        """Edition and section, of both editions where the version of the file is not known."""
        sections = {2: self.clause_2, 3: self.clause_3}
        wanted = [version] if version is not None and sections.get(version) else [2, 3]
        named = [f"{_EDITION[v]}, {sections[v]}" for v in wanted if sections[v]]
        return "; ".join(named) if named else "good practice"

    def found(self, version: int | None, message: str) -> Finding:
        """A finding of this rule; `message` names the place and what to do."""
        return Finding(self.id, self.severity, message, self.clause(version))


@dataclass(frozen=True)
class Finding:
    """One place where a rule is broken."""

    rule: str
    severity: Severity
    message: str  # one sentence: file, variable, what is wrong, what to do
    clause: str  # of the standard, such as "FMI 2.0.4, 2.2.7"

    def __str__(self) -> str:
        return f"{self.severity} {self.rule}: {self.message} [{self.clause}]"


def error(id: str, demand: str, clause_2: str | None = None, clause_3: str | None = None) -> Rule:
    """A rule whose violation is an error."""
    return Rule(id, Severity.ERROR, demand, clause_2, clause_3)


def warning(id: str, demand: str, clause_2: str | None = None, clause_3: str | None = None) -> Rule:
    """A rule whose violation is a warning."""
    return Rule(id, Severity.WARNING, demand, clause_2, clause_3)


def note(id: str, demand: str, clause_2: str | None = None, clause_3: str | None = None) -> Rule:
    """A rule that tells what was left out."""
    return Rule(id, Severity.NOTE, demand, clause_2, clause_3)
