"""The functions that a shared library must offer (FMI 2.0.4, 2.3 with 3.2.3 and 4.2.4; FMI 3.0.1, 2.5)."""

from __future__ import annotations

from collections.abc import Iterable

_VALUES_3 = "Float32 Float64 Int8 UInt8 Int16 UInt16 Int32 UInt32 Int64 UInt64 Boolean String Binary Clock"
_ACCESS_3 = " ".join(f"Get{kind} Set{kind}" for kind in _VALUES_3.split())
_COMMON = {
    2: """
        GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment EnterInitializationMode
        ExitInitializationMode Terminate Reset GetReal GetInteger GetBoolean GetString SetReal SetInteger SetBoolean
        SetString GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate
        GetDirectionalDerivative
    """,
    3: """
        GetVersion SetDebugLogging FreeInstance EnterInitializationMode ExitInitializationMode Terminate Reset
        GetNumberOfVariableDependencies GetVariableDependencies GetFMUState SetFMUState FreeFMUState
        SerializedFMUStateSize SerializeFMUState DeserializeFMUState GetDirectionalDerivative GetAdjointDerivative
        EnterConfigurationMode ExitConfigurationMode GetIntervalDecimal GetIntervalFraction GetShiftDecimal
        GetShiftFraction SetIntervalDecimal SetIntervalFraction SetShiftDecimal SetShiftFraction
    """
    + _ACCESS_3,
}
_OWN = {
    (2, "ModelExchange"): """
        EnterEventMode NewDiscreteStates EnterContinuousTimeMode CompletedIntegratorStep SetTime SetContinuousStates
        GetDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
    """,
    (2, "CoSimulation"): """
        SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep GetStatus GetRealStatus GetIntegerStatus
        GetBooleanStatus GetStringStatus
    """,
    (3, "ModelExchange"): """
        InstantiateModelExchange EnterEventMode EvaluateDiscreteStates UpdateDiscreteStates EnterContinuousTimeMode
        CompletedIntegratorStep SetTime SetContinuousStates GetContinuousStateDerivatives GetEventIndicators
        GetContinuousStates GetNominalsOfContinuousStates GetNumberOfEventIndicators GetNumberOfContinuousStates
    """,
    (3, "CoSimulation"): """
        InstantiateCoSimulation EnterEventMode EvaluateDiscreteStates UpdateDiscreteStates EnterStepMode
        GetOutputDerivatives DoStep
    """,
    (3, "ScheduledExecution"): "InstantiateScheduledExecution ActivateModelPartition",
}


def required(version: int, interfaces: Iterable[str]) -> frozenset[str]:
    """Names of all functions of an edition for some interface types."""
    texts = [_COMMON[version], *(_OWN.get((version, interface), "") for interface in interfaces)]
    return frozenset(f"fmi{version}{name}" for text in texts for name in text.split())
