"""All rules of the checks, and the page that lists them.

python -m gearpath.fmu.conformance.rules > docs/conformance.md
"""

from __future__ import annotations

from importlib import import_module

from .finding import Rule

TOPICS = {
    "archive": "Archive",
    "documents": "XML files",
    "check": "Edition",
    "identity": "Identity, default experiment, log categories",
    "capabilities": "Capabilities",
    "units": "Units",
    "declared": "Types",
    "names": "Names and references",
    "initials": "Causality, variability, initial",
    "values": "Values and sizes",
    "derivatives": "Derivatives and states",
    "structure": "Model structure",
    "dependencies": "Dependencies",
    "terminals": "Terminals and icons",
    "files": "Files",
    "sources": "Source code",
    "binaries": "Binaries, without running them",
    "running": "Running the binary",
    "probe_calls": "Calls",
    "probe_state": "State",
    "probe_slopes": "Derivatives and dependencies in numbers",
}

_HEAD = """# What the conformance check looks at

`gearpath validate X.fmu` checks any FMU of FMI 2.0 or 3.0, of any tool, against these rules; with a model file it
checks the physics too. In Python: `gearpath.fmu.conformance.check_conformance(path)`. An error is forbidden by the
standard or makes importers fail, a warning is allowed but trips people up, a note says what was not checked. Clauses
are sections of FMI 2.0.4 and FMI 3.0.1; a dash means that the rule is not for that edition, or is good practice and
not of the standard. The numeric checks load the binary for this machine only, in a process of its own.

This page is generated: `python -m gearpath.fmu.conformance.rules > docs/conformance.md`.
"""


def rules_of(module: str) -> list[Rule]:
    """Rules that a module of this package defines, in order."""
    found = vars(import_module(f".{module}", __package__)).values()
    return [value for value in found if isinstance(value, Rule)]


def all_rules() -> dict[str, Rule]:
    """Every rule by its id."""
    return {rule.id: rule for module in TOPICS for rule in rules_of(module)}


def page() -> str:
    """The rules as Markdown."""
    lines = [_HEAD]
    for module, title in TOPICS.items():
        lines += [
            f"## {title}",
            "",
            "| rule | severity | what is asked | FMI 2.0.4 | FMI 3.0.1 |",
            "|---|---|---|---|---|",
        ]
        for rule in rules_of(module):
            clauses = f"{rule.clause_2 or '-'} | {rule.clause_3 or '-'}"
            lines.append(f"| `{rule.id}` | {rule.severity} | {rule.demand} | {clauses} |")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    print(page(), end="")
