"""Validation of an exported FMU: every check with its figure and its limit."""

from .suite import torques_of, validate

__all__ = ["torques_of", "validate"]
