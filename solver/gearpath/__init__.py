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
        fit_mobility,
        frequency_response,
        identify_joint,
        linearize,
        load,
        measure_joint,
        natural_frequencies,
        operating_point,
        power_flow,
        power_matrices,
        reduce,
        state_space,
        to_frd,
        torque_sweep,
        validate_fmu,
    )
    from .joints.bearings import (
        BallBearing,
        BearingStack,
        RollerBearing,
        back_to_back,
        catalogue_bearing,
        designations,
        face_to_face,
        tandem,
    )

__all__ = [
    "AccuracyError",
    "BallBearing",
    "BearingStack",
    "GearpathError",
    "InputError",
    "MissingExtraError",
    "Model",
    "ModelError",
    "RollerBearing",
    "__version__",
    "back_to_back",
    "catalogue_bearing",
    "designations",
    "expected_power",
    "export_fmu",
    "face_to_face",
    "fit_mobility",
    "frequency_response",
    "identify_joint",
    "linearize",
    "load",
    "measure_joint",
    "natural_frequencies",
    "operating_point",
    "power_flow",
    "power_matrices",
    "reduce",
    "state_space",
    "tandem",
    "to_frd",
    "torque_sweep",
    "validate_fmu",
]
_BEARINGS = {
    *("BallBearing", "BearingStack", "RollerBearing", "back_to_back", "catalogue_bearing", "designations"),
    *("face_to_face", "tandem"),
}


def __getattr__(name: str) -> Any:
    if name in __all__:
        module = ".joints.bearings" if name in _BEARINGS else ".api"
        return getattr(import_module(module, __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
