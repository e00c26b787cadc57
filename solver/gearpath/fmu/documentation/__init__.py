"""documentation/index.html of a native FMU: the model's own plots, tables and equations on one page."""

from .page import documentation

__all__ = ["documentation"]
