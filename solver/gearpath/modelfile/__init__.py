"""Model files: TOML in, a checked immutable model and its system out."""

from .model import Model, load

__all__ = ["Model", "load"]
