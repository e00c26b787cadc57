"""Massless vector connections: bearings, mounts and bolted joints."""

from .beam_joint import beam_joint
from .joint import Joint, Port
from .mounting import Mounting, preloaded

__all__ = ["Joint", "Mounting", "Port", "beam_joint", "preloaded"]
