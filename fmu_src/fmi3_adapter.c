/* FMI 3.0: creation, initialisation, values and steps. */
#include "fmi3_session.h"

const char *fmi3GetVersion(void) { return fmi3Version; }

static void log_to(void (*logger)(void), void *environment, int is_error, const char *category, const char *sentence) {
    if (logger) ((fmi3LogMessageCallback)logger)(environment, is_error ? fmi3Error : fmi3OK, category, sentence);
}

static void say(const GpSession *s, int is_error, const char *category, const char *sentence) {
    log_to(s->logger, s->environment, is_error, category, sentence);
}

static GpSession *create(const char *function, const char *name, const char *token, const char *path, int exchange,
                         fmi3Boolean logging, void *environment, fmi3LogMessageCallback logger) {
    GpSession *s = NULL;
    GpText message, text;
    gp_text_clear(&message);
    if (!name || !*name)
        gp_text_add(&message, "The instance name is missing.");
    else if (!token)
        gp_text_add(&message, "The instantiation token is missing.");
    else if (!path)
        gp_text_add(&message, "The resource path is missing; the model is read from there.");
    else
        s = gp_session_create(name, token, path, exchange, &message);
    if (!s) {
        gp_text_clear(&text);
        gp_text_add(&text, function);
        gp_text_add(&text, ": ");
        gp_text_add(&text, message.text);
        log_to((void (*)(void))logger, environment, 1, "logStatusError", text.text);
        return NULL;
    }
    s->say = say;
    s->logger = (void (*)(void))logger;
    s->environment = environment;
    s->log = logging ? GP_LOG_ALL : 0;
    return s;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage) {
    (void)visible;
    return create("fmi3InstantiateModelExchange", instanceName, instantiationToken, resourcePath, 1, loggingOn,
                  instanceEnvironment, logMessage);
}

/* The variables that may be set within a step are the inputs, whatever was asked for. */
fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken,
                                         fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                         fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables,
                                         fmi3InstanceEnvironment instanceEnvironment,
                                         fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate) {
    static const char function[] = "fmi3InstantiateCoSimulation";
    GpSession *s;
    (void)visible;
    (void)earlyReturnAllowed;
    if (eventModeUsed || (nRequiredIntermediateVariables && !requiredIntermediateVariables)) {
        log_to((void (*)(void))logMessage, instanceEnvironment, 1, "logStatusError",
               eventModeUsed ? "fmi3InstantiateCoSimulation: This FMU has no event mode in co-simulation."
                             : "fmi3InstantiateCoSimulation: The required intermediate variables are missing.");
        return NULL;
    }
    s = create(function, instanceName, instantiationToken, resourcePath, 0, loggingOn, instanceEnvironment, logMessage);
    if (!s) return NULL;
    for (size_t i = 0; i < nRequiredIntermediateVariables; i++) {
        const unsigned int reference = requiredIntermediateVariables[i];
        const GpModel *m = &s->core->model;
        if (reference < m->variables && gp_role(m, m->variable + reference) != GP_IS_PARAMETER) continue;
        gp_refuse(s->core, reference,
                  reference < m->variables ? " is no input, output or state, so it cannot be an intermediate variable."
                                           : " does not exist.");
        gp_session_fail(s, function, s->core->message.text);
        gp_session_free(s, function);
        return NULL;
    }
    s->intermediate = (void (*)(void))intermediateUpdate;
    return s;
}

void fmi3FreeInstance(fmi3Instance instance) { gp_session_free(instance, "fmi3FreeInstance"); }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[]) {
    return fmi3_status(gp_session_set_logging(instance, "fmi3SetDebugLogging", loggingOn, nCategories, categories));
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime) {
    GpSession *s = instance;
    (void)toleranceDefined; /* the steps are exact */
    (void)tolerance;
    if (gp_session_allowed(s, GP_INSTANTIATED, "fmi3EnterInitializationMode") ||
        gp_session_start(s, "fmi3EnterInitializationMode", startTime, stopTimeDefined, stopTime))
        return fmi3Error;
    s->phase = GP_INITIALISING;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    return fmi3_status(gp_session_exit_initialisation(instance, "fmi3ExitInitializationMode"));
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
    if (gp_session_allowed(instance, GP_STEPPING | GP_EVENT | GP_CONTINUOUS, "fmi3Terminate")) return fmi3Error;
    ((GpSession *)instance)->phase = GP_TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance) { return fmi3_status(gp_session_reset(instance, "fmi3Reset")); }

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          fmi3Float64 values[], size_t nValues) {
    return fmi3_status(gp_session_get(instance, "fmi3GetFloat64", valueReferences, nValueReferences, values, nValues));
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          const fmi3Float64 values[], size_t nValues) {
    return fmi3_status(gp_session_set(instance, "fmi3SetFloat64", valueReferences, nValueReferences, values, nValues));
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                        const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                        size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity) {
    return fmi3_status(gp_session_derivative(instance, "fmi3GetDirectionalDerivative", 0, unknowns, nUnknowns, knowns,
                                             nKnowns, seed, nSeed, sensitivity, nSensitivity));
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                    size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity) {
    return fmi3_status(gp_session_derivative(instance, "fmi3GetAdjointDerivative", 1, unknowns, nUnknowns, knowns,
                                             nKnowns, seed, nSeed, sensitivity, nSensitivity));
}

/* Asks the importer for the inputs at the end of the step: between the communication points they then follow the
   straight line. Without a callback, or where it sets nothing, they are held. */
static void ask_for_inputs(GpSession *s, double t, double h) {
    fmi3Boolean early = fmi3False;
    fmi3Float64 early_time = t + h;
    s->step = h;
    s->asking = 1;
    s->phase = GP_INTERMEDIATE;
    ((fmi3IntermediateUpdateCallback)s->intermediate)(s->environment, t + h, fmi3True, fmi3False, fmi3False, fmi3False,
                                                      &early, &early_time);
    s->phase = GP_STEPPING;
}

/* Tells the importer that the step is done and its results can be read. */
static void tell_of_results(GpSession *s, double time) {
    fmi3Boolean early = fmi3False;
    fmi3Float64 early_time = time;
    s->asking = 0;
    s->phase = GP_INTERMEDIATE;
    ((fmi3IntermediateUpdateCallback)s->intermediate)(s->environment, time, fmi3False, fmi3True, fmi3True, fmi3False,
                                                      &early, &early_time);
    s->phase = GP_STEPPING;
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime) {
    static const char function[] = "fmi3DoStep";
    GpSession *s = instance;
    const double t = currentCommunicationPoint, h = communicationStepSize;
    int failed;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (gp_session_check_step(s, function, t, h)) return fmi3Error;
    if (!eventHandlingNeeded || !terminateSimulation || !earlyReturn || !lastSuccessfulTime)
        return fmi3_status(gp_session_fail(s, function, "A place for a result is missing."));
    if (s->intermediate) ask_for_inputs(s, t, h);
    failed = gp_session_step(s, function, t, h);
    if (failed) gp_hold(s->core); /* inputs given in the callback belong to this step */
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
    *lastSuccessfulTime = s->clock.time;
    if (!failed && s->intermediate) tell_of_results(s, t + h);
    return fmi3_status(failed);
}
