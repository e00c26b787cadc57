"""Massless vector connections: bearings and mounts."""

from .joint import Joint, Port

__all__ = ["Joint", "Port"]
