/* FMI 2.0 functions that this FMU has no use for: each says so and returns an error, none does harm. */
#include "fmi2_slave.h"

static fmi2Status unsupported(fmi2Component c, const char *function, const char *sentence) {
    return c ? fmi2_fail(c, function, sentence) : fmi2Error;
}

static fmi2Status no_such_type(fmi2Component c, size_t count, const char *function) {
    if (c && count == 0) return fmi2OK;
    return unsupported(c, function, "All variables of this FMU are Real, so this reference does not exist.");
}

static const char NO_STATE[] = "This FMU cannot get, set or serialise its state (see its capability flags).";
static const char NO_DERIVATIVE[] = "This FMU gives no derivatives of outputs (see its capability flags).";
static const char NO_EXCHANGE[] = "This FMU supports co-simulation only, not model exchange.";
static const char NOT_PENDING[] = "This FMU steps synchronously, so this has no value.";

#define UNSUPPORTED(name, arguments, unused, sentence) \
    fmi2Status name arguments {                        \
        unused;                                        \
        return unsupported(c, #name, sentence);        \
    }

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

UNSUPPORTED(fmi2GetFMUstate, (fmi2Component c, fmi2FMUstate *s), (void)s, NO_STATE)
UNSUPPORTED(fmi2SetFMUstate, (fmi2Component c, fmi2FMUstate s), (void)s, NO_STATE)
UNSUPPORTED(fmi2FreeFMUstate, (fmi2Component c, fmi2FMUstate *s), (void)s, NO_STATE)
UNSUPPORTED(fmi2SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate s, size_t *n), (void)s; (void)n, NO_STATE)
UNSUPPORTED(fmi2SerializeFMUstate, (fmi2Component c, fmi2FMUstate s, fmi2Byte b[], size_t n),
            (void)s; (void)b; (void)n, NO_STATE)
UNSUPPORTED(fmi2DeSerializeFMUstate, (fmi2Component c, const fmi2Byte b[], size_t n, fmi2FMUstate *s),
            (void)s; (void)b; (void)n, NO_STATE)

UNSUPPORTED(fmi2GetDirectionalDerivative,
            (fmi2Component c, const fmi2ValueReference u[], size_t nu, const fmi2ValueReference k[], size_t nk,
             const fmi2Real dk[], fmi2Real du[]),
            (void)u; (void)nu; (void)k; (void)nk; (void)dk; (void)du, NO_DERIVATIVE)
UNSUPPORTED(fmi2GetRealOutputDerivatives,
            (fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
             fmi2Real value[]),
            (void)vr; (void)nvr; (void)order; (void)value, NO_DERIVATIVE)

UNSUPPORTED(fmi2EnterEventMode, (fmi2Component c), (void)c, NO_EXCHANGE)
UNSUPPORTED(fmi2NewDiscreteStates, (fmi2Component c, fmi2EventInfo *i), (void)i, NO_EXCHANGE)
UNSUPPORTED(fmi2EnterContinuousTimeMode, (fmi2Component c), (void)c, NO_EXCHANGE)
UNSUPPORTED(fmi2CompletedIntegratorStep,
            (fmi2Component c, fmi2Boolean b, fmi2Boolean *e, fmi2Boolean *t), (void)b; (void)e; (void)t, NO_EXCHANGE)
UNSUPPORTED(fmi2SetTime, (fmi2Component c, fmi2Real t), (void)t, NO_EXCHANGE)
UNSUPPORTED(fmi2SetContinuousStates, (fmi2Component c, const fmi2Real x[], size_t n), (void)x; (void)n, NO_EXCHANGE)
UNSUPPORTED(fmi2GetDerivatives, (fmi2Component c, fmi2Real x[], size_t n), (void)x; (void)n, NO_EXCHANGE)
UNSUPPORTED(fmi2GetEventIndicators, (fmi2Component c, fmi2Real x[], size_t n), (void)x; (void)n, NO_EXCHANGE)
UNSUPPORTED(fmi2GetContinuousStates, (fmi2Component c, fmi2Real x[], size_t n), (void)x; (void)n, NO_EXCHANGE)
UNSUPPORTED(fmi2GetNominalsOfContinuousStates, (fmi2Component c, fmi2Real x[], size_t n), (void)x; (void)n,
            NO_EXCHANGE)

UNSUPPORTED(fmi2CancelStep, (fmi2Component c), (void)c, NOT_PENDING)
UNSUPPORTED(fmi2GetIntegerStatus, (fmi2Component c, const fmi2StatusKind s, fmi2Integer *v), (void)s; (void)v,
            NOT_PENDING)
UNSUPPORTED(fmi2GetStringStatus, (fmi2Component c, const fmi2StatusKind s, fmi2String *v), (void)s; (void)v,
            NOT_PENDING)

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value) {
    if (!c || !value || s != fmi2DoStepStatus) return unsupported(c, "fmi2GetStatus", NOT_PENDING);
    *value = ((Fmi2Slave *)c)->last_step;
    return fmi2OK;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value) {
    if (!c || !value || s != fmi2LastSuccessfulTime) return unsupported(c, "fmi2GetRealStatus", NOT_PENDING);
    *value = ((Fmi2Slave *)c)->clock.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value) {
    if (!c || !value || s != fmi2Terminated) return unsupported(c, "fmi2GetBooleanStatus", NOT_PENDING);
    *value = fmi2False; /* this FMU never ends a simulation itself */
    return fmi2OK;
}
