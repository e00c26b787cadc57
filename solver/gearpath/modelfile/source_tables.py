"""Tables of the gear mesh source: the tones of a transmission error that turns with the driving shaft."""

from typing import Annotated

from pydantic import Field

from .numbers import Count, Quantity
from .table import Table
from .train_tables import Several
from .words import Text

_HARMONIC = Count("order of the tooth meshing", at_most=1000)
_AMPLITUDE = Quantity(
    "amplitude of the tone in the transmission error (0: off)",
    "m",
    at_least=0.0,
    plausible=(0.0, 0.01),
    slip="did you mean m, not um?",
)
_PHASE = Quantity(
    "phase of the tone where the shaft angle is 0",
    "rad",
    plausible=(-7.0, 7.0),
    slip="did you mean rad, not degrees? (180 degrees are 3.1416 rad)",
)


class HarmonicTable(Table):
    """A harmonic of the tooth meshing: amplitude * cos(order * teeth * angle + phase)."""

    order: Annotated[int, _HARMONIC]
    amplitude: Annotated[float, _AMPLITUDE]
    phase: Annotated[float, _PHASE] = 0.0


class SidebandTable(Table):
    """A tone beside a harmonic, from modulation: amplitude * cos((harmonic * teeth + order) * angle + phase)."""

    harmonic: Annotated[int, _HARMONIC]
    order: Annotated[
        float,
        Quantity("distance from the harmonic in orders of the shaft, not 0", at_least=-1000.0, at_most=1000.0),
    ]
    amplitude: Annotated[float, _AMPLITUDE]
    phase: Annotated[float, _PHASE] = 0.0


class SourceTable(Table):
    """A gear mesh source inside native FMUs: it adds to the transmission error of a mesh."""

    mesh: Annotated[str, Text("mesh", "gear_train.mesh")] = ""
    speed: Annotated[
        float,
        Quantity(
            "speed of the shaft that carries the first gear of the mesh",
            "rev/min",
            plausible=(-1e6, 1e6),
            slip="did you mean rev/min?",
        ),
    ]
    teeth: Annotated[int, Count("tooth count of the first gear of the mesh")]
    harmonics: Annotated[Several[HarmonicTable], Field(description="Harmonics of the tooth meshing")] = ()
    sidebands: Annotated[Several[SidebandTable], Field(description="Tones beside the harmonics")] = ()
