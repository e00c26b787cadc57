"""One instance of the gearbox in fmuloader, with the same names for both versions of FMI."""

import tempfile
from contextlib import contextmanager

import fmpy
import numpy as np
from client_reference import FREQUENCY
from fmuloader.fmi2 import Fmi2Slave, Fmi2Type
from fmuloader.fmi3 import Fmi3Slave


class Gearbox:
    """Variables by name; everything else is fmuloader's own method."""

    def __init__(self, fmu, fmi, folder):
        self.fmi = fmi
        self.description = fmpy.read_model_description(fmu)
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        kind = Fmi2Slave if fmi == "2.0" else Fmi3Slave
        # a folder for each instance: to unpack over a library that is in use ends the process
        self.own = kind(fmu, model_identifier="gearbox", unpack_dir=tempfile.mkdtemp(dir=folder))

    def instantiate(self, exchange):
        token = self.description.guid
        if self.fmi == "2.0":
            kind = Fmi2Type.MODEL_EXCHANGE if exchange else Fmi2Type.CO_SIMULATION
            self.own.instantiate("gearbox", kind, guid=token)
        elif exchange:
            self.own.instantiate_model_exchange("gearbox", instantiation_token=token)
        else:
            self.own.instantiate_co_simulation("gearbox", instantiation_token=token)

    def initialise(self, start):
        if self.fmi == "2.0":
            self.own.setup_experiment(start_time=0.0)
        self.own.enter_initialization_mode()
        self.set({"frequency": FREQUENCY} | start)
        self.own.exit_initialization_mode()

    def set(self, values):
        references = [self.references[name] for name in values]
        if self.fmi == "2.0":
            self.own.set_real(references, list(values.values()))
        else:
            self.own.set_float64(references, np.concatenate([np.ravel(value) for value in values.values()]).tolist())

    def get(self, names):
        read = self.own.get_real if self.fmi == "2.0" else self.own.get_float64
        return read([self.references[name] for name in names])

    def rates(self):
        read = self.own.get_derivatives if self.fmi == "2.0" else self.own.get_continuous_state_derivatives
        return read(144)

    def events(self):
        """What ends an event: no new discrete states, then continuous time."""
        if self.fmi == "2.0":
            assert not self.own.new_discrete_states().newDiscreteStatesNeeded
        else:
            assert not self.own.update_discrete_states().discrete_states_need_update
        self.own.enter_continuous_time_mode()


@contextmanager
def running(fmu, fmi, folder, *, exchange=False, start=None):
    """An initialised instance, in continuous time or ready for steps."""
    gearbox = Gearbox(fmu, fmi, folder)
    with gearbox.own:
        gearbox.instantiate(exchange)
        gearbox.initialise(start or {})
        if exchange:
            gearbox.events()
        yield gearbox
        gearbox.own.terminate()
