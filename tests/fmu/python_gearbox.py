"""A gearbox as a `System`, and a way to drive its python FMU call by call."""

from pathlib import Path

import fmpy
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

from gearpath.components import Disk, GearTrain, Material, Mesh, RigidBody, Section, Shaft
from gearpath.fmu.python_kind import export_python
from gearpath.joints import Joint, Port
from gearpath.network.system import MeshExcitation, System

STEEL = Material(2.07e11, 0.3, 7850.0)
STIFFNESS = ((1.2e8, 1.8e6), (1.8e6, 6.0e4))
DAMPING = ((120.0, 1.8), (1.8, 0.06))
MOUNTS = ((-0.09, 0.0, -0.12), (0.09, 0.0, -0.12), (-0.09, 0.0, 0.12), (0.09, 0.0, 0.12))


def gearbox(
    *,
    name="gearbox",
    mass=12.0,
    ixx=0.15,
    centre=(0.0, 0.0, 0.0),
    lengths=(0.25, 0.25),
    diameter=0.03,
    gears=None,
    mounts=MOUNTS,
    modal_damping=0.015,
) -> System:
    """The planar gearbox; `gears` are the places of both on their shafts, the middle unless given."""
    first, second = gears or (lengths[0] / 2, lengths[1] / 2)
    train = GearTrain(
        {
            "input": _shaft(-0.04975, lengths[0], diameter, Disk("pinion", first, 1.526, 1.0237e-3, 1.8884e-3)),
            "output": _shaft(0.05025, lengths[1], 0.03, Disk("wheel", second, 1.5568, 1.0638e-3, 1.9655e-3)),
        },
        {"mesh": Mesh((("input", "pinion"), ("output", "wheel")), 1.5e8, (0.04975, 0.05025))},
        modal_damping,
    )
    stations = [("input", 0.0), ("input", lengths[0]), ("output", 0.0), ("output", lengths[1])]
    joints = {
        f"bearing_{k}": Joint("bearing", (Port("gear_train", s, z), Port("casing")), ("uy", "rx"), STIFFNESS, DAMPING)
        for k, (s, z) in enumerate(stations, 1)
    }
    for k, at in enumerate(mounts, 1):
        ends = (Port("casing"), Port("ground"))
        joints[f"mount_{k}"] = Joint("mount", ends, ("uy",), ((1e7,),), ((440.0,),), at, True)
    casing = RigidBody(mass, {"xx": ixx, "yy": 0.2, "zz": 0.17}, centre)
    components = {"gear_train": train, "casing": casing}
    return System(name, ("uy", "rx"), components, joints, MeshExcitation("gear_train", "mesh"))


def _shaft(x, length, diameter, disk):
    return Shaft(STEEL, (x, 0.0, -0.125), (Section(length, diameter),), 0.886, (8, 8), (disk,))


def export(system, path, **changes):
    """The python FMU with plain settings."""
    settings = {
        "model_identifier": "gearbox",
        "description": "A test model",
        "frequency": 500.0,
        "version": "0.0.test",
    }
    return export_python(system, Path(path), **(settings | changes))


class Host:
    """One instance, with variables by name and what it logged."""

    def __init__(self, path, folder=None):
        description = fmpy.read_model_description(str(path))
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.folder = folder or fmpy.extract(str(path))
        self.log = []
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="host",
        )
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(lambda *a: self.log.append((a[2], a[4].decode())))
        callbacks.allocateMemory = defaultCallbacks.allocateMemory
        callbacks.freeMemory = defaultCallbacks.freeMemory
        self.slave.instantiate(callbacks=callbacks, loggingOn=True)

    def start(self, **values):
        """Initialise at 0 s with parameters set beforehand."""
        self.slave.setupExperiment(startTime=0.0)
        self.set(values)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        return self

    def set(self, values):
        self.slave.setReal([self.references[name] for name in values], list(values.values()))

    def get(self, *names):
        return self.slave.getReal([self.references[name] for name in names])

    def free(self):
        self.slave.terminate()
        self.slave.freeInstance()
