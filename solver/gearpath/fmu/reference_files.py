"""Reference input and output inside the FMU, as the layered standard FMI-LS-REF asks for (any version of FMI)."""

import hashlib
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence

import numpy as np

from ..network.modal import ModalNetwork
from ..numerics.arrays import Real
from .description import Experiment, as_file
from .reference_experiment import Answer, answers, sweeps
from .variables import Variable

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
STEPS = 200
_COARSER = 5  # times the default experiment's step: the FMU is exact at any
_LAYERED = "http://fmi-standard.org/fmi-ls-manifest"
_PURPOSE = "Layered Standard providing information on related files included in an FMU."  # wording of the standard
_TEXT = """Reference files of {name}

sweep_in.csv           inputs: swept sines ({step} s between rows); those that are no signals keep their start values
sweep_held_out.csv     outputs where the inputs are held from row to row, as importers do by default in co-simulation
sweep_linear_out.csv   outputs where they vary linearly from row to row: model exchange, or co-simulation with
                       fmi2SetRealInputDerivatives or fmi3IntermediateUpdate
sweep.exp              the experiments: the two answers, start {start} s, stop {stop} s, step {step} s

A row of outputs is what holds at its time before the inputs of that row are set, in the held case with those of the
row before. The outputs were computed with the matrix exponential of the whole model, apart from the FMU's own
integration, and are written with all digits of a double. Co-simulation agrees to about 1e-9 of each output's largest
value, model exchange to the tolerance of its solver.
"""


def reference_files(network: ModalNetwork, variables: Sequence[Variable], experiment: Experiment) -> dict[str, bytes]:
    """All files of the layered standard, by their path in the FMU."""
    times, step = rows(experiment)
    loads, columns = sweeps(network, times), {"time": times}
    for variable in variables:
        if variable.causality == "input":
            value = variable.start if isinstance(variable.start, float) else 0.0
            columns[variable.name] = loads.get(variable.name, np.full(len(times), value))
    return answered(network.name, columns, answers(network, variables, loads, step), step)


def rows(experiment: Experiment) -> tuple[Real, float]:
    """The times of the rows, and the step between them, s."""
    start, stop = experiment.start_time, experiment.stop_time
    step = min(_COARSER * experiment.step_size, (stop - start) / STEPS)
    return start + step * np.arange(STEPS + 1, dtype=float), step


def answered(system: str, inputs: Mapping[str, Real], found: Sequence[Answer], step: float) -> dict[str, bytes]:
    """The files of what was simulated; `inputs` begin with the column "time", whose rows are `step` (s) apart."""
    times, start = inputs["time"], float(inputs["time"][0])
    files = {"sweep_in.csv": _csv(inputs)}
    for answer in found:
        files[f"sweep_{answer.name}_out.csv"] = _csv({"time": times, **answer.columns})
    files["sweep.exp"] = _experiments(system, found, times, step)
    files["fmi-ls-manifest.xml"] = _manifest(files)
    text = _TEXT.format(name=system, start=f"{start!r}", stop=f"{float(times[-1])!r}", step=f"{step!r}")
    return {
        **{f"{FOLDER}/{name}": content for name, content in files.items()},
        "documentation/fmi-ls-ref.txt": text.encode(),
    }


def _csv(columns: Mapping[str, Real]) -> bytes:
    """A file as the FMI cross-check writes them: quoted names, decimal numbers that read back as the same doubles."""
    head = ",".join('"' + name.replace('"', '""') + '"' for name in columns)
    rows = np.column_stack(list(columns.values())).tolist()
    return "\n".join([head, *(",".join(map(repr, row)) for row in rows), ""]).encode()


def _experiments(name: str, answers: Sequence[Answer], times: Real, step: float) -> bytes:
    """sweep.exp, as the harmonised experiments format of the Modelica Association has it."""
    root = ET.Element("Experiments", name=f"Sweeps of {name}", description="Swept sines in all signals at once")
    for answer in answers:
        one = ET.SubElement(root, "Experiment", name=f"sweep_{answer.name}", description=f"Sweep, {answer.words}")
        span = {"startTime": repr(float(times[0])), "stopTime": repr(float(times[-1])), "stepSize": repr(step)}
        ET.SubElement(one, "TransientSimulation", span)
        ET.SubElement(one, "Stimuli", source="sweep_in.csv")
        ET.SubElement(one, "References", source=f"sweep_{answer.name}_out.csv")
    return as_file(root)


def _manifest(files: Mapping[str, bytes]) -> bytes:
    """fmi-ls-manifest.xml: what every file is for, with its checksum."""
    ET.register_namespace("fmi-ls", _LAYERED)
    identity = {"name": "org.fmi-standard.fmi-ls-ref", "version": "1.0.0-alpha.1", "description": _PURPOSE}
    root = ET.Element("fmiReferences", {f"{{{_LAYERED}}}fmi-ls-{key}": text for key, text in identity.items()})
    roles = {
        "sweep.exp": ("application/x-ma-hs-experiments", "experiment/validation", "The two experiments"),
        "sweep_in.csv": ("text/csv", "testcase", "Inputs over time"),
        "sweep_held_out.csv": ("text/csv", "result", "Outputs over time where inputs are held between rows"),
        "sweep_linear_out.csv": ("text/csv", "result", "Outputs over time where inputs are linear between rows"),
    }
    for name, (kind, role, text) in roles.items():
        checksum = hashlib.sha3_256(files[name]).hexdigest()
        attributes = {"type": kind, "source": name, "role": role, "description": text}
        ET.SubElement(root, "Related", {**attributes, "checksum": checksum, "checksumType": "SHA3-256"})
    return as_file(root)
