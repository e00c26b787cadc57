"""Massless vector connections: bearings, mounts, bolted and rigid joints."""

from .beam_joint import beam_joint
from .joint import RIGID, Joint, Port
from .mounting import Mounting, preloaded

__all__ = ["RIGID", "Joint", "Mounting", "Port", "beam_joint", "preloaded"]
