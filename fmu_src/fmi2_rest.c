/* FMI 2.0 functions that this FMU has no use for: each says so and returns an error, none does harm. */
#include "fmi2_session.h"

static fmi2Status unsupported(fmi2Component c, const char *function, const char *sentence) {
    return fmi2_status(gp_session_fail(c, function, sentence));
}

static fmi2Status no_such_type(fmi2Component c, size_t count, const char *function) {
    if (c && count == 0) return fmi2OK;
    return unsupported(c, function, "All variables of this FMU are Real, so this reference does not exist.");
}

static const char NO_DERIVATIVE[] = "This FMU gives no derivatives of outputs in time (see its capability flags).";
static const char NOT_PENDING[] = "This FMU steps synchronously, so this has no value.";

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Integer value[]) {
    (void)vr, (void)value;
    return no_such_type(c, nvr, "fmi2GetInteger");
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[]) {
    (void)vr, (void)value;
    return no_such_type(c, nvr, "fmi2GetBoolean");
}
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[]) {
    (void)vr, (void)value;
    return no_such_type(c, nvr, "fmi2GetString");
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer value[]) {
    (void)vr, (void)value;
    return no_such_type(c, nvr, "fmi2SetInteger");
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Boolean value[]) {
    (void)vr, (void)value;
    return no_such_type(c, nvr, "fmi2SetBoolean");
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2String value[]) {
    (void)vr, (void)value;
    return no_such_type(c, nvr, "fmi2SetString");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[]) {
    (void)vr, (void)nvr, (void)order, (void)value;
    return unsupported(c, "fmi2GetRealOutputDerivatives", NO_DERIVATIVE);
}

fmi2Status fmi2CancelStep(fmi2Component c) { return unsupported(c, "fmi2CancelStep", NOT_PENDING); }

/* 0 where the status of the last step may be asked for. */
static int asked_early(fmi2Component c, const char *function, const void *place) {
    if (gp_session_of_kind(c, 0, function) || gp_session_allowed(c, GP_STEPPING | GP_TERMINATED, function)) return -1;
    return place ? 0 : gp_session_fail(c, function, "The place for the value is missing.");
}

/* What a kind of status gives that this FMU does not have (FMI 2.0.4, 4.2.3). */
static fmi2Status discarded(fmi2Component c, const char *function) {
    unsupported(c, function, NOT_PENDING);
    return fmi2Discard;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value) {
    (void)s;
    return asked_early(c, "fmi2GetIntegerStatus", value) ? fmi2Error : discarded(c, "fmi2GetIntegerStatus");
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value) {
    (void)s;
    return asked_early(c, "fmi2GetStringStatus", (const void *)value) ? fmi2Error : discarded(c, "fmi2GetStringStatus");
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value) {
    if (asked_early(c, "fmi2GetStatus", value)) return fmi2Error;
    if (s != fmi2DoStepStatus) return discarded(c, "fmi2GetStatus");
    *value = fmi2_status(((GpSession *)c)->step_failed);
    return fmi2OK;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value) {
    if (asked_early(c, "fmi2GetRealStatus", value)) return fmi2Error;
    if (s != fmi2LastSuccessfulTime) return discarded(c, "fmi2GetRealStatus");
    *value = ((GpSession *)c)->clock.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value) {
    if (asked_early(c, "fmi2GetBooleanStatus", value)) return fmi2Error;
    if (s != fmi2Terminated) return discarded(c, "fmi2GetBooleanStatus");
    *value = fmi2False; /* this FMU never ends a simulation itself */
    return fmi2OK;
}
