"""Massless vector connections: bearings, mounts and bolted joints."""

from .beam_joint import beam_joint
from .joint import Joint, Port

__all__ = ["Joint", "Port", "beam_joint"]
