"""The time twin as python-control objects."""

from .signals import signal_name
from .twin import state_space

__all__ = ["signal_name", "state_space"]
