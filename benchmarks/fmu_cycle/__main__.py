"""One FMU cycle (set, doStep, get) in a C host against dense products, a dense propagator and pythonfmu, CPU time.

    python benchmarks/fmu_cycle [MODEL]

Needs a C compiler (cc). Ratios are of medians in one run of one process; the pythonfmu kind runs in a second process
of the same driver, with libpython preloaded (it needs that in hosts that are not Python).
"""

import ctypes.util
import os
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from importlib.util import find_spec
from pathlib import Path

import fmpy
import numpy as np

import gearpath as gp
from gearpath.api import modal_network
from gearpath.fmu.native import export_native
from gearpath.network.modal import ModalNetwork
from gearpath.network.records import JointRows, Load, Output

HERE = Path(__file__).resolve().parent
DEFAULT = HERE.parents[1] / "models" / "gearbox.toml"
STEP = "1e-5"


def compiled(folder: Path) -> Path:
    """The driver, compiled for this very machine."""
    headers = Path(next(iter(find_spec("fmpy").submodule_search_locations))) / "c-code"
    program = folder / "driver"
    source = str(HERE / "driver.c")
    command = ["cc", "-std=gnu99", "-O3", "-march=native", "-I", str(headers), source, "-o", str(program), "-ldl"]
    subprocess.run(command, check=True)
    return program


def measured(
    program: Path,
    fmu: Path,
    inputs: list[str],
    outputs: list[str],
    *,
    states: int,
    cycles: int,
    change: str | None = None,
    environment: dict[str, str] | None = None,
) -> dict[str, float]:
    """What the driver prints about an FMU, ns."""
    folder = fmu.with_suffix("")
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    description = fmpy.read_model_description(str(folder))
    reference = {v.name: v.valueReference for v in description.modelVariables}
    library = folder / "binaries" / "linux64" / f"{description.coSimulation.modelIdentifier}.so"
    arguments = [str(library), (folder / "resources").as_uri(), description.guid, str(states), STEP, str(cycles)]
    arguments += [",".join(str(reference[name]) for name in names) for names in (inputs, outputs)]
    arguments += [str(reference[change])] if change else []
    done = subprocess.run(
        [str(program), *arguments],
        env={**os.environ, **(environment or {})},
        capture_output=True,
        text=True,
        check=False,
    )
    if not done.stdout.startswith("cycle"):
        raise SystemExit(f"the driver failed: {done.stderr.strip()}")
    return {name: float(value) for name, value in (line.split() for line in done.stdout.split("\n") if line.strip())}


def small_network() -> ModalNetwork:
    """50 states, two inputs, eight outputs: the system that exporters were compared with."""
    rng, modes = np.random.default_rng(1), 25
    rows = rng.normal(size=(3, modes))
    one = np.ones((1, 1))
    joint = JointRows(
        "mount", "mount", ("uy",), rows[:1], 0 * rows[:1], 1e5 * one, 10 * one, scalar=True, grounded=True
    )
    loads = tuple(Load(f"actuators.a{i}", "N", rows[1 + i]) for i in range(2))
    outputs = [Output(f"sensors.s{i}", "m/s", "velocity", row=rng.normal(size=modes)) for i in range(8)]
    return ModalNetwork(
        "small",
        {"plate": slice(0, modes)},
        {"plate": 0.01},
        (2 * np.pi * np.geomspace(40, 4000, modes)) ** 2,
        (joint,),
        loads,
        tuple(outputs),
        "actuators.a0",
        (),
    )


def python_library() -> str:
    """The shared library of this Python."""
    name = sysconfig.get_config_var("INSTSONAME") or ctypes.util.find_library(
        f"python{sys.version_info[0]}.{sys.version_info[1]}"
    )
    place = Path(sysconfig.get_config_var("LIBDIR") or "/usr/lib") / str(name)
    return str(place if place.exists() else name)


def main() -> None:
    """Print the measured ratios."""
    model = gp.load(sys.argv[1] if len(sys.argv) > 1 else DEFAULT)
    network = modal_network(model)
    inputs = [load.name for load in network.loads]
    outputs = [output.name for output in network.outputs]
    states, joint = 2 * len(network.eigenvalues), network.joints[0]
    entry = f"{joint.name}.stiffness" + ("" if joint.scalar else "[1,1]")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = compiled(folder)
        fmu = gp.export_fmu(model, folder / "native.fmu")
        print(f"{network.name}: {states} states, {len(inputs)} inputs")
        few = [o.name for o in network.outputs if o.quantity == "force"][:8]
        for chosen, what in ((few, f"{len(few)} outputs"), (outputs, f"all {len(outputs)} outputs over time")):
            found = measured(program, fmu, inputs, chosen, states=states, cycles=100_000, change=entry)
            print(
                f"  {what}: cycle {found['cycle']:.0f} ns, of one dense matrix-vector product "
                + ", ".join(
                    f"{found['cycle'] / found[f'product_{form}']:.2f} ({form}, {found[f'product_{form}']:.0f} ns)"
                    for form in ("by_columns", "by_rows")
                )
            )
        print(
            f"  after a bearing change: first step {found['again'] / 1e6:.1f} ms, "
            f"then {found['cycle_after_change']:.0f} ns a cycle"
        )
        native = measured(program, fmu, inputs, few, states=0, cycles=100_000)["cycle"]
        python = gp.export_fmu(model, folder / "python.fmu", kind="python")
        preload = {"LD_PRELOAD": python_library(), "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        slow = measured(program, python, inputs, few, states=0, cycles=300, environment=preload)["cycle"]
        print(
            f"  pythonfmu with the same model: {slow / 1000:.0f} us a cycle, {slow / native:.0f} times the native one"
        )
        small = export_native(
            small_network(),
            folder / "small.fmu",
            model_identifier="small",
            description="",
            frequency=100.0,
            version="0",
        )
        found = measured(
            program,
            small,
            [f"actuators.a{i}" for i in range(2)],
            [f"sensors.s{i}" for i in range(8)],
            states=50,
            cycles=1_000_000,
        )
        print(
            f"50 states, 2 inputs, 8 outputs: cycle {found['cycle']:.0f} ns, of a dense propagator's "
            f"{found['cycle'] / found['dense_cycle_by_rows']:.2f} ({found['dense_cycle_by_rows']:.0f} ns), "
            f"{found['cycle'] / found['dense_cycle']:.2f} with its columns vectorised ({found['dense_cycle']:.0f} ns)"
        )


if __name__ == "__main__":
    main()
