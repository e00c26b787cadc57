/* Every call of FMI 3 that a simulation makes. Usage: counting_fmi3 RESOURCES TOKEN STATES VARIABLES */
#include "counting.h"
#include "fmi3Functions.h"

static void logger(fmi3InstanceEnvironment e, fmi3Status s, fmi3String c, fmi3String m) { (void)e, (void)s, (void)c, (void)m; }

static const char *location, *token;
static size_t states;
static fmi3Instance current; /* of the callback */

static void intermediate(fmi3InstanceEnvironment e, fmi3Float64 time, fmi3Boolean settable, fmi3Boolean gettable,
                         fmi3Boolean finished, fmi3Boolean can_return, fmi3Boolean *early, fmi3Float64 *early_time) {
    const double input = 2e-6;
    (void)e, (void)time, (void)finished, (void)can_return, (void)early, (void)early_time;
    if (settable && fmi3SetFloat64(current, inputs.reference, 1, &input, 1)) faults++;
    if (gettable && fmi3GetFloat64(current, all.reference, all.count, value, all.values)) faults++;
}

static void initialise(fmi3Instance c) {
    if (!c) exit(4);
    STRICTLY(fmi3EnterInitializationMode(c, 0, 0, 0, 0, 0));
    STRICTLY(fmi3ExitInitializationMode(c));
}

static fmi3Instance start_steps(void) {
    current = fmi3InstantiateCoSimulation("it", token, location, 0, 1, 0, 0, inputs.reference, 1, NULL, logger, intermediate);
    initialise(current);
    return current;
}

/* Parameters doubled: the damping ratios and matrices stay valid. */
static void change(fmi3Instance c) {
    const unsigned *vr = parameters.reference;
    STRICTLY(fmi3GetFloat64(c, vr, parameters.count, value, parameters.values));
    for (size_t i = 0; i < parameters.values; i++) value[i] *= 2;
    STRICTLY(fmi3SetFloat64(c, vr, parameters.count, value, parameters.values));
}

static void derivatives(fmi3Instance c) {
    for (size_t i = 0; i < outputs.count; i++) {
        const unsigned *unknown = outputs.reference + i;
        const size_t size = outputs.size[i];
        for (size_t k = 0; k <= size; k++) seed[k] = 1;
        STRICTLY(fmi3GetDirectionalDerivative(c, unknown, 1, inputs.reference, 1, seed, 1, result, size));
        STRICTLY(fmi3GetAdjointDerivative(c, unknown, 1, inputs.reference, 1, seed, size, result, 1));
    }
}

static void keep(fmi3Instance c) {
    fmi3FMUState kept = NULL, copy = NULL;
    fmi3Byte *bytes;
    size_t size;
    FREELY(fmi3GetFMUState(c, &kept)); /* a new handle is a new block of memory: FMI wants it so */
    STRICTLY(fmi3GetFMUState(c, &kept));
    STRICTLY(fmi3SetFMUState(c, kept));
    STRICTLY(fmi3SerializedFMUStateSize(c, kept, &size));
    bytes = malloc(size);
    STRICTLY(fmi3SerializeFMUState(c, kept, bytes, size));
    FREELY(fmi3DeserializeFMUState(c, bytes, size, &copy));
    STRICTLY(fmi3DeserializeFMUState(c, bytes, size, &copy));
    STRICTLY(fmi3SetFMUState(c, copy));
    FREELY(fmi3FreeFMUState(c, &kept));
    FREELY(fmi3FreeFMUState(c, &copy));
    free(bytes);
}

static void co_simulation(void) {
    static const double sizes[] = {1e-5, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 1e-5};
    fmi3Instance c = start_steps();
    fmi3Boolean event, end, early;
    double t = 0, last;
    for (int i = 0; i < 7; i++) {
        value[0] = 1e-6;
        STRICTLY(fmi3SetFloat64(c, inputs.reference, 1, value, 1));
        STRICTLY(fmi3DoStep(c, t, sizes[i], fmi3True, &event, &end, &early, &last));
        t = last;
        STRICTLY(fmi3GetFloat64(c, all.reference, all.count, value, all.values));
        if (i == 2) change(c);
        if (i == 3) keep(c);
        derivatives(c);
    }
    FAILING(fmi3DoStep(c, -1, 1e-5, fmi3True, &event, &end, &early, &last));
    STRICTLY(fmi3Terminate(c));
    STRICTLY(fmi3Reset(c));
    fmi3FreeInstance(c);
}

static void exchange(void) {
    fmi3Instance c = fmi3InstantiateModelExchange("it", token, location, 0, 1, NULL, logger);
    fmi3Boolean f[5], event, end;
    double next;
    initialise(c);
    for (int i = 0; i < 3; i++) {
        STRICTLY(fmi3UpdateDiscreteStates(c, f, f + 1, f + 2, f + 3, f + 4, &next));
        STRICTLY(fmi3EnterContinuousTimeMode(c));
        STRICTLY(fmi3SetTime(c, i * 1e-5));
        STRICTLY(fmi3GetContinuousStates(c, result, states));
        STRICTLY(fmi3SetContinuousStates(c, result, states));
        STRICTLY(fmi3GetContinuousStateDerivatives(c, result, states));
        STRICTLY(fmi3GetNominalsOfContinuousStates(c, result, states));
        STRICTLY(fmi3GetFloat64(c, all.reference, all.count, value, all.values));
        STRICTLY(fmi3CompletedIntegratorStep(c, fmi3True, &event, &end));
        derivatives(c);
        STRICTLY(fmi3EnterEventMode(c));
        change(c);
        keep(c);
    }
    fmi3FreeInstance(c);
}

int main(int argc, char **v) {
    if (argc != 5) return 3;
    location = v[1], token = v[2], states = (size_t)atoi(v[3]);
    read_variables(v[4]);
    for (int i = 0; i < 3; i++) co_simulation();
    exchange();
    for (int i = 0; i < 100; i++) fmi3FreeInstance(start_steps());
    return summary();
}
