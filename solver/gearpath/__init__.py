"""Gearpath: structure-borne noise power flow in gearboxes, and the same physics as FMUs.

    import gearpath as gp
    model = gp.load("models/gearbox.toml")
    flow = gp.power_flow(model)

The public names are loaded when they are first used, so that a floor of the package can be imported alone and fast.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ._version import __version__
from .errors import AccuracyError, GearpathError, InputError, MissingExtraError, ModelError

if TYPE_CHECKING:
    from .api import (
        Model,
        expected_power,
        export_fmu,
        frequency_response,
        load,
        natural_frequencies,
        power_flow,
        power_matrices,
        state_space,
        validate_fmu,
    )

__all__ = [
    "AccuracyError",
    "GearpathError",
    "InputError",
    "MissingExtraError",
    "Model",
    "ModelError",
    "__version__",
    "expected_power",
    "export_fmu",
    "frequency_response",
    "load",
    "natural_frequencies",
    "power_flow",
    "power_matrices",
    "state_space",
    "validate_fmu",
]


def __getattr__(name: str) -> Any:
    if name in __all__:
        return getattr(import_module(".api", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
