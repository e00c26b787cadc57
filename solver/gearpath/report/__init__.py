"""The HTML report of a model and its FMUs, and the overview picture of the README."""

from .overview import picture
from .page import write_report

__all__ = ["picture", "write_report"]
