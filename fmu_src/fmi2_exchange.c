/* FMI 2.0: model exchange and states. */
#include <stdlib.h>

#include "fmi2_session.h"

fmi2Status fmi2EnterEventMode(fmi2Component c) {
    if (gp_session_allowed(c, GP_CONTINUOUS | GP_EVENT, "fmi2EnterEventMode")) return fmi2Error;
    ((GpSession *)c)->phase = GP_EVENT;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *eventInfo) {
    int changed;
    if (!c) return fmi2Error;
    if (!eventInfo) return fmi2_status(gp_session_fail(c, "fmi2NewDiscreteStates", "The event info is missing."));
    if (gp_session_update(c, "fmi2NewDiscreteStates", &changed)) return fmi2Error;
    eventInfo->newDiscreteStatesNeeded = fmi2False;
    eventInfo->terminateSimulation = fmi2False;
    eventInfo->nominalsOfContinuousStatesChanged = fmi2False;
    eventInfo->valuesOfContinuousStatesChanged = changed ? fmi2True : fmi2False;
    eventInfo->nextEventTimeDefined = fmi2False;
    eventInfo->nextEventTime = 0;
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    return fmi2_status(gp_session_continue(c, "fmi2EnterContinuousTimeMode"));
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation) {
    (void)noSetFMUStatePriorToCurrentPoint;
    if (gp_session_allowed(c, GP_CONTINUOUS, "fmi2CompletedIntegratorStep")) return fmi2Error;
    if (!enterEventMode || !terminateSimulation)
        return fmi2_status(gp_session_fail(c, "fmi2CompletedIntegratorStep", "A place for the result is missing."));
    *enterEventMode = *terminateSimulation = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) { return fmi2_status(gp_session_set_time(c, "fmi2SetTime", time)); }

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx) {
    return fmi2_status(gp_session_set_states(c, "fmi2SetContinuousStates", x, nx));
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx) {
    return fmi2_status(gp_session_states(c, "fmi2GetContinuousStates", x, nx));
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx) {
    return fmi2_status(gp_session_derivatives(c, "fmi2GetDerivatives", derivatives, nx));
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx) {
    return fmi2_status(gp_session_nominals(c, "fmi2GetNominalsOfContinuousStates", x_nominal, nx));
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni) {
    (void)eventIndicators;
    return fmi2_status(gp_session_indicators(c, "fmi2GetEventIndicators", ni));
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate) {
    return fmi2_status(gp_session_keep(c, "fmi2GetFMUstate", FMUstate));
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate) {
    return fmi2_status(gp_session_restore(c, "fmi2SetFMUstate", FMUstate));
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate) {
    if (!c) return fmi2Error;
    if (!FMUstate) return fmi2OK; /* "the call is ignored" */
    free(*FMUstate);
    *FMUstate = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size) {
    return fmi2_status(gp_session_serialised_size(c, "fmi2SerializedFMUstateSize", FMUstate, size));
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size) {
    return fmi2_status(
        gp_session_serialise(c, "fmi2SerializeFMUstate", FMUstate, (unsigned char *)serializedState, size));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate) {
    return fmi2_status(gp_session_deserialise(c, "fmi2DeSerializeFMUstate", (const unsigned char *)serializedState, size,
                                              FMUstate));
}
