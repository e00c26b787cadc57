"""Gearpath: structure-borne noise power flow in gearboxes, and the same physics as FMUs."""

from ._version import __version__

__all__ = ["__version__"]
