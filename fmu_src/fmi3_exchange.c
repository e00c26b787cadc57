/* FMI 3.0: model exchange and states. */
#include <stdlib.h>

#include "fmi3_session.h"

fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
    if (gp_session_allowed(instance, GP_CONTINUOUS, "fmi3EnterEventMode")) return fmi3Error;
    ((GpSession *)instance)->phase = GP_EVENT;
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined,
                                    fmi3Float64 *nextEventTime) {
    static const char function[] = "fmi3UpdateDiscreteStates";
    int changed;
    if (!instance) return fmi3Error;
    if (!discreteStatesNeedUpdate || !terminateSimulation || !nominalsOfContinuousStatesChanged ||
        !valuesOfContinuousStatesChanged || !nextEventTimeDefined || !nextEventTime)
        return fmi3_status(gp_session_fail(instance, function, "A place for a result is missing."));
    if (gp_session_update(instance, function, &changed)) return fmi3Error;
    *discreteStatesNeedUpdate = *terminateSimulation = *nominalsOfContinuousStatesChanged = fmi3False;
    *valuesOfContinuousStatesChanged = changed != 0;
    *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0;
    return fmi3OK;
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
    return fmi3_status(gp_session_allowed(instance, GP_INITIALISING | GP_EVENT, "fmi3EvaluateDiscreteStates"));
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
    return fmi3_status(gp_session_continue(instance, "fmi3EnterContinuousTimeMode"));
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation) {
    (void)noSetFMUStatePriorToCurrentPoint;
    if (gp_session_allowed(instance, GP_CONTINUOUS, "fmi3CompletedIntegratorStep")) return fmi3Error;
    if (!enterEventMode || !terminateSimulation)
        return fmi3_status(gp_session_fail(instance, "fmi3CompletedIntegratorStep", "A place for a result is missing."));
    *enterEventMode = *terminateSimulation = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
    return fmi3_status(gp_session_set_time(instance, "fmi3SetTime", time));
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 continuousStates[],
                                   size_t nContinuousStates) {
    return fmi3_status(
        gp_session_set_states(instance, "fmi3SetContinuousStates", continuousStates, nContinuousStates));
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 continuousStates[], size_t nContinuousStates) {
    return fmi3_status(gp_session_states(instance, "fmi3GetContinuousStates", continuousStates, nContinuousStates));
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[],
                                             size_t nContinuousStates) {
    return fmi3_status(
        gp_session_derivatives(instance, "fmi3GetContinuousStateDerivatives", derivatives, nContinuousStates));
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t nContinuousStates) {
    return fmi3_status(
        gp_session_nominals(instance, "fmi3GetNominalsOfContinuousStates", nominals, nContinuousStates));
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 eventIndicators[], size_t nEventIndicators) {
    (void)eventIndicators;
    return fmi3_status(gp_session_indicators(instance, "fmi3GetEventIndicators", nEventIndicators));
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *nEventIndicators) {
    if (gp_session_of_kind(instance, 1, "fmi3GetNumberOfEventIndicators")) return fmi3Error;
    if (!nEventIndicators)
        return fmi3_status(gp_session_fail(instance, "fmi3GetNumberOfEventIndicators", "The place for it is missing."));
    *nEventIndicators = 0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *nContinuousStates) {
    if (gp_session_of_kind(instance, 1, "fmi3GetNumberOfContinuousStates")) return fmi3Error;
    if (!nContinuousStates)
        return fmi3_status(gp_session_fail(instance, "fmi3GetNumberOfContinuousStates", "The place for it is missing."));
    *nContinuousStates = ((GpSession *)instance)->core->model.states;
    return fmi3OK;
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState) {
    return fmi3_status(gp_session_keep(instance, "fmi3GetFMUState", FMUState));
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState) {
    return fmi3_status(gp_session_restore(instance, "fmi3SetFMUState", FMUState));
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState) {
    if (!instance) return fmi3Error;
    if (!FMUState) return fmi3OK; /* "the call is ignored" */
    free(*FMUState);
    *FMUState = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size) {
    return fmi3_status(gp_session_serialised_size(instance, "fmi3SerializedFMUStateSize", FMUState, size));
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState, fmi3Byte serializedState[],
                                 size_t size) {
    return fmi3_status(gp_session_serialise(instance, "fmi3SerializeFMUState", FMUState, serializedState, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[], size_t size,
                                   fmi3FMUState *FMUState) {
    return fmi3_status(gp_session_deserialise(instance, "fmi3DeserializeFMUState", serializedState, size, FMUState));
}
