/* FMI 2.0: creation, initialisation, values and steps. */
#include "fmi2_session.h"

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

/* '%' and '#' are special in an FMI 2 message, and doubled stand for themselves (FMI 2.0.4, 2.1.5). */
static void add_escaped(GpText *t, const char *s) {
    char one[3] = {0, 0, 0};
    for (; *s; s++) {
        one[0] = *s;
        one[1] = *s == '%' || *s == '#' ? *s : '\0';
        if (t->length + 3 < GP_TEXT_SIZE) gp_text_add(t, one);
    }
}

static void log_to(void (*logger)(void), void *environment, const char *name, int is_error, const char *category,
                   const char *sentence) {
    GpText text;
    if (!logger) return;
    gp_text_clear(&text);
    add_escaped(&text, sentence);
    ((fmi2CallbackLogger)logger)(environment, name, is_error ? fmi2Error : fmi2OK, category, text.text);
}

static void say(const GpSession *s, int is_error, const char *category, const char *sentence) {
    log_to(s->logger, s->environment, s->name, is_error, category, sentence);
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn) {
    const char *name = instanceName ? instanceName : "";
    GpSession *s = NULL;
    GpText message;
    (void)visible;
    if (!functions) return NULL;
    gp_text_clear(&message);
    if (!*name)
        gp_text_add(&message, "The instance name is missing.");
    else if (fmuType != fmi2CoSimulation && fmuType != fmi2ModelExchange)
        gp_text_add(&message, "The type of the FMU must be co-simulation or model exchange.");
    else if (!fmuGUID)
        gp_text_add(&message, "The GUID is missing.");
    else if (!fmuResourceLocation)
        gp_text_add(&message, "The resource location is missing; the model is read from there.");
    else
        s = gp_session_create(name, fmuGUID, fmuResourceLocation, fmuType == fmi2ModelExchange, &message);
    if (!s) {
        GpText text;
        gp_text_clear(&text);
        gp_text_add(&text, "fmi2Instantiate: ");
        gp_text_add(&text, message.text);
        log_to((void (*)(void))functions->logger, functions->componentEnvironment, name, 1, "logStatusError", text.text);
        return NULL;
    }
    s->say = say;
    s->logger = (void (*)(void))functions->logger;
    s->environment = functions->componentEnvironment;
    s->log = loggingOn ? GP_LOG_ALL : 0;
    return s;
}

void fmi2FreeInstance(fmi2Component c) { gp_session_free(c, "fmi2FreeInstance"); }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[]) {
    return fmi2_status(gp_session_set_logging(c, "fmi2SetDebugLogging", loggingOn, nCategories, categories));
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
    (void)toleranceDefined; /* the steps are exact */
    (void)tolerance;
    if (gp_session_allowed(c, GP_INSTANTIATED, "fmi2SetupExperiment")) return fmi2Error;
    return fmi2_status(gp_session_start(c, "fmi2SetupExperiment", startTime, stopTimeDefined != fmi2False, stopTime));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    if (gp_session_allowed(c, GP_INSTANTIATED, "fmi2EnterInitializationMode")) return fmi2Error;
    ((GpSession *)c)->phase = GP_INITIALISING;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    return fmi2_status(gp_session_exit_initialisation(c, "fmi2ExitInitializationMode"));
}

fmi2Status fmi2Terminate(fmi2Component c) {
    if (gp_session_allowed(c, GP_STEPPING | GP_EVENT | GP_CONTINUOUS, "fmi2Terminate")) return fmi2Error;
    ((GpSession *)c)->phase = GP_TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) { return fmi2_status(gp_session_reset(c, "fmi2Reset")); }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
    return fmi2_status(gp_session_get(c, "fmi2GetReal", vr, nvr, value, nvr));
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
    return fmi2_status(gp_session_set(c, "fmi2SetReal", vr, nvr, value, nvr));
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    return fmi2_status(gp_session_slopes(c, "fmi2SetRealInputDerivatives", vr, nvr, order, value));
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    GpSession *s = c;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (!s) return fmi2Error;
    s->step_failed = gp_session_step(s, "fmi2DoStep", currentCommunicationPoint, communicationStepSize) != 0;
    return fmi2_status(s->step_failed);
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[], size_t nUnknown,
                                        const fmi2ValueReference vKnown_ref[], size_t nKnown,
                                        const fmi2Real dvKnown[], fmi2Real dvUnknown[]) {
    return fmi2_status(gp_session_derivative(c, "fmi2GetDirectionalDerivative", 0, vUnknown_ref, nUnknown, vKnown_ref,
                                             nKnown, dvKnown, nKnown, dvUnknown, nUnknown));
}
