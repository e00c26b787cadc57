/* FMI 3.0, model exchange and co-simulation. */
#include <stdlib.h>
#include <string.h>

#include "fmi3Functions.h"
#include "host.h"

#define USED(X)                                                                                                       \
    X(InstantiateModelExchange) X(InstantiateCoSimulation) X(FreeInstance) X(EnterInitializationMode)                 \
    X(ExitInitializationMode) X(Terminate) X(Reset) X(GetFloat64) X(SetFloat64) X(GetFMUState) X(SetFMUState)         \
    X(FreeFMUState) X(SerializedFMUStateSize) X(SerializeFMUState) X(DeserializeFMUState)                             \
    X(GetDirectionalDerivative) X(GetAdjointDerivative) X(EnterEventMode) X(UpdateDiscreteStates)                     \
    X(EnterContinuousTimeMode) X(CompletedIntegratorStep) X(SetTime) X(SetContinuousStates) X(GetContinuousStates)    \
    X(GetContinuousStateDerivatives) X(GetNominalsOfContinuousStates) X(GetNumberOfContinuousStates) X(DoStep)

static struct {
#define X(name) fmi3##name##TYPE *name;
    USED(X)
#undef X
} f;

/* Inputs at the end of the next step, for the callback; that of one instance is enough here. */
static struct {
    void *c;
    unsigned int *reference;
    double *value;
    size_t count;
    int status;
} ends;

static int load(void) {
    Function found;
#define X(name)                                                                                                       \
    if (!(found = library_function("fmi3" #name))) return -1;                                                         \
    memcpy(&f.name, &found, sizeof found);
    USED(X)
#undef X
    return 0;
}

static void logger(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
    (void)environment;
    write_text("log");
    write_count((size_t)status);
    write_text(" ");
    write_text(category);
    write_text(" ");
    write_text(message);
    write_text("\n");
}

static void intermediate(fmi3InstanceEnvironment environment, fmi3Float64 time, fmi3Boolean set_requested,
                         fmi3Boolean get_allowed, fmi3Boolean finished, fmi3Boolean can_return, fmi3Boolean *wants_return,
                         fmi3Float64 *return_time) {
    (void)environment, (void)time, (void)get_allowed, (void)finished, (void)can_return, (void)return_time;
    *wants_return = fmi3False;
    if (set_requested && ends.count)
        ends.status = (int)f.SetFloat64(ends.c, ends.reference, ends.count, ends.value, ends.count);
}

static void *instantiate(int exchange, const char *token, const char *path) {
    if (exchange) return f.InstantiateModelExchange("host", token, path, fmi3False, fmi3False, NULL, logger);
    return f.InstantiateCoSimulation("host", token, path, fmi3False, fmi3False, fmi3False, fmi3False, NULL, 0, NULL,
                                     logger, intermediate);
}

static void release(void *c) { f.FreeInstance(c); }
static int start(void *c, double time) {
    return (int)f.EnterInitializationMode(c, fmi3False, 0, time, fmi3False, 0);
}
static int initialised(void *c) { return (int)f.ExitInitializationMode(c); }
static int terminate(void *c) { return (int)f.Terminate(c); }
static int reset(void *c) { return (int)f.Reset(c); }

static int set(void *c, const unsigned int *vr, size_t count, const double *value, size_t values) {
    return (int)f.SetFloat64(c, vr, count, value, values);
}
static int get(void *c, const unsigned int *vr, size_t count, double *value, size_t values) {
    return (int)f.GetFloat64(c, vr, count, value, values);
}

static void clear_ends(void) {
    free(ends.reference);
    free(ends.value);
    memset(&ends, 0, sizeof ends);
}

static int ramp(void *c, const unsigned int *vr, size_t count, const double *value) {
    clear_ends();
    ends.c = c;
    ends.count = count;
    ends.reference = script_memory(count, sizeof *vr);
    ends.value = script_memory(count, sizeof *value);
    memcpy(ends.reference, vr, count * sizeof *vr);
    memcpy(ends.value, value, count * sizeof *value);
    return OK;
}

static int step(void *c, double time, double size) {
    fmi3Boolean event_wanted, end_wanted, early;
    fmi3Float64 reached;
    int status = (int)f.DoStep(c, time, size, fmi3True, &event_wanted, &end_wanted, &early, &reached);
    if (!status) status = early ? ERROR : ends.status;
    clear_ends();
    return status;
}

static int event(void *c) { return (int)f.EnterEventMode(c); }
static int continuous(void *c) { return (int)f.EnterContinuousTimeMode(c); }
static int set_time(void *c, double time) { return (int)f.SetTime(c, time); }
static int set_states(void *c, const double *x, size_t n) { return (int)f.SetContinuousStates(c, x, n); }
static int states(void *c, double *x, size_t n) { return (int)f.GetContinuousStates(c, x, n); }
static int derivatives(void *c, double *dx, size_t n) { return (int)f.GetContinuousStateDerivatives(c, dx, n); }
static int nominals(void *c, double *x, size_t n) { return (int)f.GetNominalsOfContinuousStates(c, x, n); }

static int update(void *c, int *values_changed) {
    fmi3Boolean again, end_wanted, nominals_changed, states_changed, has_next;
    fmi3Float64 next;
    *values_changed = 0;
    do {
        const fmi3Status status =
            f.UpdateDiscreteStates(c, &again, &end_wanted, &nominals_changed, &states_changed, &has_next, &next);
        if (status) return (int)status;
        *values_changed |= states_changed;
    } while (again);
    return OK;
}

static int step_completed(void *c) {
    fmi3Boolean event_wanted, end_wanted;
    return (int)f.CompletedIntegratorStep(c, fmi3True, &event_wanted, &end_wanted);
}

static int keep(void *c, void **state) { return (int)f.GetFMUState(c, state); }
static int restore(void *c, void *state) { return (int)f.SetFMUState(c, state); }
static int forget(void *c, void **state) { return (int)f.FreeFMUState(c, state); }
static int serialised_size(void *c, void *state, size_t *size) { return (int)f.SerializedFMUStateSize(c, state, size); }
static int serialise(void *c, void *state, unsigned char *byte, size_t size) {
    return (int)f.SerializeFMUState(c, state, byte, size);
}
static int deserialise(void *c, const unsigned char *byte, size_t size, void **state) {
    return (int)f.DeserializeFMUState(c, byte, size, state);
}

static int directional(void *c, const unsigned int *unknown, size_t unknowns, const unsigned int *known, size_t knowns,
                       const double *seed, size_t seeds, double *result, size_t results) {
    return (int)f.GetDirectionalDerivative(c, unknown, unknowns, known, knowns, seed, seeds, result, results);
}

static int adjoint(void *c, const unsigned int *unknown, size_t unknowns, const unsigned int *known, size_t knowns,
                   const double *seed, size_t seeds, double *result, size_t results) {
    return (int)f.GetAdjointDerivative(c, unknown, unknowns, known, knowns, seed, seeds, result, results);
}

const Interface fmi3_interface = {
    .name = "fmi3", .load = load, .instantiate = instantiate, .release = release, .start = start,
    .initialised = initialised, .set = set, .get = get, .ramp = ramp, .step = step, .event = event, .update = update,
    .continuous = continuous, .step_completed = step_completed, .set_time = set_time, .set_states = set_states,
    .states = states, .derivatives = derivatives, .nominals = nominals, .keep = keep, .restore = restore,
    .forget = forget, .serialised_size = serialised_size, .serialise = serialise, .deserialise = deserialise,
    .directional = directional, .adjoint = adjoint, .terminate = terminate, .reset = reset,
};
