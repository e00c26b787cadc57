"""The time twin as python-control objects."""

from .twin import signal_name, state_space

__all__ = ["signal_name", "state_space"]
