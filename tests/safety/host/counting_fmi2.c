/* Every call of FMI 2 that a simulation makes. Usage: counting_fmi2 RESOURCES GUID STATES VARIABLES */
#include "counting.h"
#include "fmi2Functions.h"

static void logger(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...) {
    (void)e, (void)n, (void)s, (void)c, (void)m;
}

static const char *location, *guid;
static size_t states;

static fmi2Component start(fmi2Type kind) {
    static const fmi2CallbackFunctions functions = {logger, NULL, NULL, NULL, NULL};
    fmi2Component c = fmi2Instantiate("it", kind, guid, location, &functions, 0, 1);
    if (!c) exit(4);
    STRICTLY(fmi2SetupExperiment(c, 0, 0, 0, 0, 0));
    STRICTLY(fmi2EnterInitializationMode(c));
    STRICTLY(fmi2ExitInitializationMode(c));
    return c;
}

/* Parameters doubled: the damping ratios and matrices stay valid. */
static void change(fmi2Component c) {
    const unsigned *vr = parameters.reference;
    STRICTLY(fmi2GetReal(c, vr, parameters.count, value));
    for (size_t i = 0; i < parameters.count; i++) value[i] *= 2;
    STRICTLY(fmi2SetReal(c, vr, parameters.count, value));
}

static void derivatives(fmi2Component c) {
    seed[0] = 1;
    for (size_t i = 0; i < outputs.count; i++)
        STRICTLY(fmi2GetDirectionalDerivative(c, outputs.reference + i, 1, inputs.reference, 1, seed, result));
}

static void keep(fmi2Component c) {
    fmi2FMUstate kept = NULL, copy = NULL;
    fmi2Byte *bytes;
    size_t size;
    FREELY(fmi2GetFMUstate(c, &kept)); /* a new handle is a new block of memory: FMI wants it so */
    STRICTLY(fmi2GetFMUstate(c, &kept));
    STRICTLY(fmi2SetFMUstate(c, kept));
    STRICTLY(fmi2SerializedFMUstateSize(c, kept, &size));
    bytes = malloc(size);
    STRICTLY(fmi2SerializeFMUstate(c, kept, bytes, size));
    FREELY(fmi2DeSerializeFMUstate(c, bytes, size, &copy));
    STRICTLY(fmi2DeSerializeFMUstate(c, bytes, size, &copy));
    STRICTLY(fmi2SetFMUstate(c, copy));
    FREELY(fmi2FreeFMUstate(c, &kept));
    FREELY(fmi2FreeFMUstate(c, &copy));
    free(bytes);
}

static void co_simulation(void) {
    static const double sizes[] = {1e-5, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 1e-5};
    const int order = 1;
    fmi2Component c = start(fmi2CoSimulation);
    double t = 0;
    for (int i = 0; i < 7; i++) {
        for (size_t k = 0; k < inputs.count; k++) value[k] = 1e-6;
        STRICTLY(fmi2SetReal(c, inputs.reference, 1, value));
        STRICTLY(fmi2SetRealInputDerivatives(c, inputs.reference, 1, &order, value));
        STRICTLY(fmi2DoStep(c, t, sizes[i], fmi2True));
        t += sizes[i];
        STRICTLY(fmi2GetReal(c, all.reference, all.count, value));
        if (i == 2) change(c);
        if (i == 3) keep(c);
        derivatives(c);
    }
    FAILING(fmi2DoStep(c, -1, 1e-5, fmi2True));
    STRICTLY(fmi2Terminate(c));
    STRICTLY(fmi2Reset(c));
    fmi2FreeInstance(c);
}

static void exchange(void) {
    fmi2Component c = start(fmi2ModelExchange);
    fmi2EventInfo info;
    fmi2Boolean event, end;
    for (int i = 0; i < 3; i++) {
        STRICTLY(fmi2NewDiscreteStates(c, &info));
        STRICTLY(fmi2EnterContinuousTimeMode(c));
        STRICTLY(fmi2SetTime(c, i * 1e-5));
        STRICTLY(fmi2GetContinuousStates(c, result, states));
        STRICTLY(fmi2SetContinuousStates(c, result, states));
        STRICTLY(fmi2GetDerivatives(c, result, states));
        STRICTLY(fmi2GetNominalsOfContinuousStates(c, result, states));
        STRICTLY(fmi2GetReal(c, all.reference, all.count, value));
        STRICTLY(fmi2CompletedIntegratorStep(c, fmi2True, &event, &end));
        derivatives(c);
        STRICTLY(fmi2EnterEventMode(c));
        change(c);
        keep(c);
    }
    fmi2FreeInstance(c);
}

int main(int argc, char **v) {
    if (argc != 5) return 3;
    location = v[1], guid = v[2], states = (size_t)atoi(v[3]);
    read_variables(v[4]);
    for (int i = 0; i < 3; i++) co_simulation();
    exchange();
    for (int i = 0; i < 100; i++) fmi2FreeInstance(start(fmi2CoSimulation));
    return summary();
}
