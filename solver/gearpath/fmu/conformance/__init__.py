"""Conformance of FMU files to FMI 2.0 and 3.0, beyond what the public validators see.

Reads the file only: it shares no code with the exporter.
"""

from .check import check_conformance
from .finding import Finding, Rule, Severity

__all__ = ["Finding", "Rule", "Severity", "check_conformance"]
