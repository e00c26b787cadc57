"""A valid call of every function of FMI 2 and FMI 3, and what the standards allow when: for tests of all of them."""

import ctypes as ct

import fmi_signatures
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu, reals

INPUT, STATES = "actuators.shaker", 54
KNOWN = {"input": INPUT, "output": "casing.velocity_uy"}
PARAMETER = {2: "bearing_1.stiffness[1,1]", 3: "mount_1.stiffness"}
STATE = {2: "gear_train.mode_1.x", 3: "state"}

# Letters of the phases: I instantiated, N initialization, S stepping, E event, C continuous, T terminated; within a
# step of FMI 3, A: inputs are asked for, R: results are readable.
PHASES = {
    "I": "instantiated",
    "N": "initialization",
    "S": "stepping",
    "E": "event",
    "C": "continuous",
    "T": "terminated",
}
CO_SIMULATION, EXCHANGE, ALWAYS = "INST", "INECT", ("INST", "INECT")
NEVER = ("", "")

# Function -> phases of (co-simulation, model exchange) in which it succeeds: FMI 2.0.4, tables of 3.2.3 and 4.2.4.
# SetTime in event mode is more than the tables ask for. What this FMU has no use for is never allowed.
FMI2 = {
    "SetDebugLogging": ALWAYS,
    "SetupExperiment": ("I", "I"),
    "EnterInitializationMode": ("I", "I"),
    "ExitInitializationMode": ("N", "N"),
    "Terminate": ("S", "EC"),
    "Reset": ALWAYS,
    "GetReal": ("NST", "NECT"),
    "SetReal": ("INS", "INEC"),
    "SetReal parameter": ("INS", "INE"),
    "SetReal state": ("IN", "INC"),
    "SetReal output": NEVER,
    **{f"{verb}{kind}": NEVER for verb in ("Get", "Set") for kind in ("Integer", "Boolean", "String")},
    "GetFMUstate": ALWAYS,
    "SetFMUstate": ALWAYS,
    "FreeFMUstate": ALWAYS,
    "SerializedFMUstateSize": ALWAYS,
    "SerializeFMUstate": ALWAYS,
    "DeSerializeFMUstate": ALWAYS,
    "GetDirectionalDerivative": ("NST", "NECT"),
    "EnterEventMode": ("", "EC"),
    "NewDiscreteStates": ("", "E"),
    "EnterContinuousTimeMode": ("", "E"),
    "CompletedIntegratorStep": ("", "C"),
    "SetTime": ("", "EC"),
    "SetContinuousStates": ("", "C"),
    "GetDerivatives": ("", "NECT"),
    "GetEventIndicators": ("", "NECT"),
    "GetContinuousStates": ("", "NECT"),
    "GetNominalsOfContinuousStates": ("", "INECT"),
    "SetRealInputDerivatives": ("INS", ""),
    "GetRealOutputDerivatives": NEVER,
    "DoStep": ("S", ""),
    "CancelStep": NEVER,
    "GetStatus": ("ST", ""),
    "GetRealStatus": ("ST", ""),
    "GetBooleanStatus": ("ST", ""),
    "GetIntegerStatus": NEVER,
    "GetStringStatus": NEVER,
}
TYPES = [
    "Float32",
    *(f"{sign}Int{bits}" for sign in ("", "U") for bits in (8, 16, 32, 64)),
    *("Boolean", "String", "Binary", "Clock"),
]
# FMI 3.0, sections 2.3, 3.2 and 4.2. The nominals when instantiated are more than it asks for.
FMI3 = {
    "SetDebugLogging": ("INSTAR", "INECT"),
    "EnterInitializationMode": ("I", "I"),
    "ExitInitializationMode": ("N", "N"),
    "Terminate": ("S", "EC"),
    "Reset": ALWAYS,
    "GetFloat64": ("NSTR", "NECT"),
    "SetFloat64": ("INSA", "INEC"),
    "SetFloat64 parameter": ("INS", "INE"),
    "SetFloat64 state": ("IN", "INC"),
    "SetFloat64 output": NEVER,
    **{f"{verb}{kind}": NEVER for verb in ("Get", "Set") for kind in TYPES},
    "GetNumberOfVariableDependencies": NEVER,
    "GetVariableDependencies": NEVER,
    "GetFMUState": ALWAYS,
    "SetFMUState": ALWAYS,
    "FreeFMUState": ("INSTAR", "INECT"),  # it has nothing to do with the instance
    "SerializedFMUStateSize": ALWAYS,
    "SerializeFMUState": ALWAYS,
    "DeserializeFMUState": ALWAYS,
    "GetDirectionalDerivative": ("NSTR", "NECT"),
    "GetAdjointDerivative": ("NSTR", "NECT"),
    "EnterConfigurationMode": NEVER,
    "ExitConfigurationMode": NEVER,
    **{f"{verb}{what}": NEVER for verb in ("Get", "Set") for what in ("IntervalDecimal", "IntervalFraction")},
    **{f"{verb}{what}": NEVER for verb in ("Get", "Set") for what in ("ShiftDecimal", "ShiftFraction")},
    "EvaluateDiscreteStates": ("N", "NE"),
    "UpdateDiscreteStates": ("", "E"),
    "EnterEventMode": ("", "C"),
    "EnterContinuousTimeMode": ("", "E"),
    "CompletedIntegratorStep": ("", "C"),
    "SetTime": ("", "EC"),
    "SetContinuousStates": ("", "C"),
    "GetContinuousStateDerivatives": ("", "NECT"),
    "GetEventIndicators": ("", "NECT"),
    "GetContinuousStates": ("", "NECT"),
    "GetNominalsOfContinuousStates": ("", "INECT"),
    "GetNumberOfEventIndicators": ("", "INECT"),
    "GetNumberOfContinuousStates": ("", "INECT"),
    "EnterStepMode": NEVER,
    "GetOutputDerivatives": NEVER,
    "DoStep": ("S", ""),
    "ActivateModelPartition": NEVER,
}
ALLOWED = {2: FMI2, 3: FMI3}
# where a function goes from any phase that allows it: (co-simulation, model exchange)
GOES_TO = {
    "EnterInitializationMode": "NN",
    "ExitInitializationMode": "SE",
    "Terminate": "TT",
    "Reset": "II",
    "EnterEventMode": "-E",
    "EnterContinuousTimeMode": "-C",
}


def new(unpacked, version: int, exchange: bool, **options):
    return Fmu3(unpacked, exchange=exchange, **options) if version == 3 else Fmu(unpacked, kind=int(not exchange))


class Calls:
    """Valid arguments of every function for one instance; `row` is a key of FMI2 or FMI3."""

    def __init__(self, fmu, version: int) -> None:
        self.fmu, self.version, self.state, self.spare, self.bytes = fmu, version, ct.c_void_p(), ct.c_void_p(), b""
        self.made: list[ct.c_void_p] = []

    def keep(self) -> None:
        """Takes the state that functions which need one are given, and another one to be freed."""
        for place in (self.state, self.spare):
            assert self._state("Get", place) == OK, self.fmu.messages
        self.bytes = self.fmu.serialised()

    def free(self) -> None:
        for place in (self.state, self.spare, *self.made):
            assert self._state("Free", place) == OK

    def _state(self, verb: str, place: ct.c_void_p) -> int:
        return self.fmu.call(f"fmi{self.version}{verb}FMU{'state' if self.version == 2 else 'State'}", ct.byref(place))

    def call(self, row: str, without: str | None = None) -> int:
        """The status, with all arguments valid but the pointer named `without`, which is NULL."""
        function = row.split()[0]
        values = self.arguments(row)
        if without is not None:
            assert without in values
            values[without] = None
        return self.fmu.call(f"fmi{self.version}{function}", *values.values())

    def arguments(self, row: str) -> dict[str, object]:
        function = row.split()[0]
        parameters = fmi_signatures.signatures(self.version)[function][1:]
        return {p.name: self._argument(row, function, p) for p in parameters}

    def _argument(self, row: str, function: str, p: fmi_signatures.Parameter):
        room = (ct.c_double * STATES)()
        if p.name.lower() == "fmustate":
            if function.startswith(("Get", "Des", "DeS")):
                self.made.append(ct.c_void_p())
                return ct.byref(self.made[-1])
            return ct.byref(self.spare) if function.startswith("Free") else self.state
        if p.name == "size" and p.pointer:
            return ct.byref(ct.c_size_t())
        if p.name == "size":
            return len(self.bytes)
        if p.name in ("serializedState", ""):
            return ct.create_string_buffer(self.bytes, max(len(self.bytes), 1))
        if p.name in ("vr", "valueReferences"):
            return self.fmu.references([self._variable(row)])
        if p.name in ("value", "values", "x", "continuousStates") and function.startswith("Set"):
            return reals([1e-6] * STATES)
        if p.name == "nValues" and row.endswith(" state"):
            return STATES
        if p.name in ("nx", "nContinuousStates") and not p.pointer:
            return STATES
        if p.name in ("vUnknown_ref", "unknowns"):
            return self.fmu.references([KNOWN["output"]])
        if p.name in ("vKnown_ref", "knowns"):
            return self.fmu.references([KNOWN["input"]])
        if p.name in ("order", "orders"):
            return (ct.c_int * 1)(1)
        if p.name == "categories":
            return (ct.c_char_p * 1)(b"logEvents")
        if p.name == "s":
            return {"GetRealStatus": 2, "GetBooleanStatus": 3}.get(function, 0)
        if p.pointer:
            return room
        if p.name in ("ni", "nEventIndicators", "stopTimeDefined", "toleranceDefined"):
            return 0
        return {"communicationStepSize": 1e-5, "time": 0.5}.get(p.name, 0.0 if p.ctype is ct.c_double else 1)

    def _variable(self, row: str) -> str:
        kind = row.partition(" ")[2]
        others = {"parameter": PARAMETER[self.version], "state": STATE[self.version], "output": KNOWN["output"]}
        return others.get(kind, INPUT)
