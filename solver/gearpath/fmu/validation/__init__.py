"""Validation of an exported FMU: every check with its figure and its limit."""

from .suite import validate

__all__ = ["validate"]
