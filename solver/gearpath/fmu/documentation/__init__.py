"""documentation/index.html of a native FMU: the model's own plots, tables and equations on one page."""

from .page import documentation
from .plots import BAND

__all__ = ["BAND", "documentation"]
