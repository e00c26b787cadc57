/* FMI 2.0, model exchange and co-simulation. */
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "host.h"

#define USED(X)                                                                                                       \
    X(Instantiate) X(FreeInstance) X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode)            \
    X(Terminate) X(Reset) X(GetReal) X(SetReal) X(GetFMUstate) X(SetFMUstate) X(FreeFMUstate)                         \
    X(SerializedFMUstateSize) X(SerializeFMUstate) X(DeSerializeFMUstate) X(GetDirectionalDerivative)                 \
    X(EnterEventMode) X(NewDiscreteStates) X(EnterContinuousTimeMode) X(CompletedIntegratorStep) X(SetTime)           \
    X(SetContinuousStates) X(GetContinuousStates) X(GetDerivatives) X(GetNominalsOfContinuousStates)                  \
    X(SetRealInputDerivatives) X(DoStep)

static struct {
#define X(name) fmi2##name##TYPE *name;
    USED(X)
#undef X
} f;

static int load(void) {
    Function found;
#define X(name)                                                                                                       \
    if (!(found = library_function("fmi2" #name))) return -1;                                                         \
    memcpy(&f.name, &found, sizeof found);
    USED(X)
#undef X
    return 0;
}

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
    static char text[4096];
    va_list arguments;
    (void)environment, (void)instance;
    va_start(arguments, message);
    format(text, sizeof text, message, arguments); /* messages are formats: a stray '%' would show here */
    va_end(arguments);
    write_text("log");
    write_count((size_t)status);
    write_text(" ");
    write_text(category);
    write_text(" ");
    write_text(text);
    write_text("\n");
}

static void *instantiate(int exchange, const char *guid, const char *location) {
    static const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, NULL};
    return f.Instantiate("host", exchange ? fmi2ModelExchange : fmi2CoSimulation, guid, location, &callbacks, fmi2False,
                         fmi2False);
}

static void release(void *c) { f.FreeInstance(c); }

static int start(void *c, double time) {
    const fmi2Status status = f.SetupExperiment(c, fmi2False, 0, time, fmi2False, 0);
    return (int)(status ? status : f.EnterInitializationMode(c));
}

static int initialised(void *c) { return (int)f.ExitInitializationMode(c); }
static int terminate(void *c) { return (int)f.Terminate(c); }
static int reset(void *c) { return (int)f.Reset(c); }

/* Scalars: as many values as references, else a mistake in the script. */
static int set(void *c, const unsigned int *vr, size_t count, const double *value, size_t values) {
    return count == values ? (int)f.SetReal(c, vr, count, value) : ERROR;
}
static int get(void *c, const unsigned int *vr, size_t count, double *value, size_t values) {
    return count == values ? (int)f.GetReal(c, vr, count, value) : ERROR;
}

static int ramp(void *c, const unsigned int *vr, size_t count, const double *slope) {
    int *order = script_memory(count, sizeof *order), status;
    for (size_t i = 0; i < count; i++) order[i] = 1;
    status = (int)f.SetRealInputDerivatives(c, vr, count, order, slope);
    free(order);
    return status;
}

static int step(void *c, double time, double size) { return (int)f.DoStep(c, time, size, fmi2True); }

static int event(void *c) { return (int)f.EnterEventMode(c); }
static int continuous(void *c) { return (int)f.EnterContinuousTimeMode(c); }
static int set_time(void *c, double time) { return (int)f.SetTime(c, time); }
static int set_states(void *c, const double *x, size_t n) { return (int)f.SetContinuousStates(c, x, n); }
static int states(void *c, double *x, size_t n) { return (int)f.GetContinuousStates(c, x, n); }
static int derivatives(void *c, double *dx, size_t n) { return (int)f.GetDerivatives(c, dx, n); }
static int nominals(void *c, double *x, size_t n) { return (int)f.GetNominalsOfContinuousStates(c, x, n); }

static int update(void *c, int *values_changed) {
    fmi2EventInfo info;
    *values_changed = 0;
    do {
        const fmi2Status status = f.NewDiscreteStates(c, &info);
        if (status) return (int)status;
        *values_changed |= info.valuesOfContinuousStatesChanged != fmi2False;
    } while (info.newDiscreteStatesNeeded);
    return OK;
}

static int step_completed(void *c) {
    fmi2Boolean event_wanted, end_wanted;
    return (int)f.CompletedIntegratorStep(c, fmi2True, &event_wanted, &end_wanted);
}

static int keep(void *c, void **state) { return (int)f.GetFMUstate(c, state); }
static int restore(void *c, void *state) { return (int)f.SetFMUstate(c, state); }
static int forget(void *c, void **state) { return (int)f.FreeFMUstate(c, state); }
static int serialised_size(void *c, void *state, size_t *size) { return (int)f.SerializedFMUstateSize(c, state, size); }
static int serialise(void *c, void *state, unsigned char *byte, size_t size) {
    return (int)f.SerializeFMUstate(c, state, (fmi2Byte *)byte, size);
}
static int deserialise(void *c, const unsigned char *byte, size_t size, void **state) {
    return (int)f.DeSerializeFMUstate(c, (const fmi2Byte *)byte, size, state);
}

static int directional(void *c, const unsigned int *unknown, size_t unknowns, const unsigned int *known, size_t knowns,
                       const double *seed, size_t seeds, double *result, size_t results) {
    if (seeds != knowns || results != unknowns) return ERROR;
    return (int)f.GetDirectionalDerivative(c, unknown, unknowns, known, knowns, seed, result);
}

const Interface fmi2_interface = {
    .name = "fmi2", .load = load, .instantiate = instantiate, .release = release, .start = start,
    .initialised = initialised, .set = set, .get = get, .ramp = ramp, .step = step, .event = event, .update = update,
    .continuous = continuous, .step_completed = step_completed, .set_time = set_time, .set_states = set_states,
    .states = states, .derivatives = derivatives, .nominals = nominals, .keep = keep, .restore = restore,
    .forget = forget, .serialised_size = serialised_size, .serialise = serialise, .deserialise = deserialise,
    .directional = directional, .terminate = terminate, .reset = reset,
};
