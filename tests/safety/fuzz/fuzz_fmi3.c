/* Fuzzer of the FMI 3 functions: as fuzz_fmi2.c, and with calls out of the intermediate update. */
#include "fmi3Functions.h"
#include "fuzz_calls.h"

#define OK_OR_ERROR(c, strict, call)             \
    do {                                         \
        begin(c, strict);                        \
        end(c, (int)(call), (int)fmi3Error);     \
    } while (0)

static void one_call(void);

static void logger(fmi3InstanceEnvironment e, fmi3Status status, fmi3String category, fmi3String message) {
    (void)e;
    FUZZ_CHECK(category && message, "an incomplete message");
    if (status != fmi3OK) seen(message);
}

static void intermediate(fmi3InstanceEnvironment e, fmi3Float64 time, fmi3Boolean settable, fmi3Boolean gettable,
                         fmi3Boolean finished, fmi3Boolean can_return, fmi3Boolean *early, fmi3Float64 *early_time) {
    (void)e;
    FUZZ_CHECK(isfinite(time) && settable != gettable && gettable == finished && !can_return, "a wrong callback");
    *early = fuzz_byte(&in) % 2 != 0; /* must not matter */
    *early_time = fuzz_double(&in);
    for (unsigned calls = fuzz_byte(&in) % 4; calls && depth < 3; calls--) one_call();
}

static void instantiate(size_t i) {
    const FuzzModel *m = fuzz_model + fuzz_byte(&in) % fuzz_models;
    const unsigned wrong = fuzz_byte(&in), kind = fuzz_byte(&in);
    const fmi3LogMessageCallback log = wrong == 0xFA ? NULL : logger;
    const char *name = wrong == 0xFB ? word() : "it", *token = wrong == 0xFC ? word() : m->guid;
    const char *path = wrong == 0xFD ? word() : m->location;
    const size_t count = fuzz_byte(&in) % 4;
    unsigned *vr = references(slot[i], count);
    if (depth && slot[i] && slot[i]->phase == GP_INTERMEDIATE) { /* its freeing is refused: it would be lost */
        free(vr);
        return;
    }
    fmi3FreeInstance(slot[i]);
    begin(NULL, 0);
    slot[i] = kind % 2 ? fmi3InstantiateModelExchange(name, token, path, 0, kind % 4 > 1, NULL, log)
                       : fmi3InstantiateCoSimulation(name, token, path, 0, kind % 4 > 1, kind > 0xF8, kind % 8 > 3, vr, count,
                                                     NULL, log, kind % 16 > 7 ? intermediate : NULL);
    depth--;
    FUZZ_CHECK(slot[i] || !log || sentences, "no instance and no sentence");
    free(vr);
}

static void values(GpSession *c, unsigned what) {
    const size_t count = fuzz_byte(&in) % 4, others = fuzz_byte(&in) % 4;
    unsigned *vr = references(c, count), *other = NULL;
    const size_t size = values_of(c, vr, count);
    double *value = what == 0 ? array(size, sizeof(double)) : doubles(size), *seed = NULL;
    size_t seeds;
    int status;
    switch (what) {
    case 0:
        begin(c, 0);
        status = (int)fmi3GetFloat64(c, vr, count, value, size);
        end(c, status, (int)fmi3Error);
        if (status == 0) all_finite(value, size);
        break;
    case 1: OK_OR_ERROR(c, 1, fmi3SetFloat64(c, vr, count, value, size)); break;
    default:
        other = references(c, others);
        seeds = values_of(c, other, others);
        seed = doubles(seeds);
        begin(c, 0);
        status = (int)(what == 2 ? fmi3GetDirectionalDerivative(c, vr, count, other, others, seed, seeds, value, size)
                                 : fmi3GetAdjointDerivative(c, other, others, vr, count, seed, seeds, value, size));
        end(c, status, (int)fmi3Error);
        if (status == 0) all_finite(value, size);
    }
    free(vr), free(value), free(other), free(seed);
}

static void states(GpSession *c, unsigned what) {
    const unsigned wrong = fuzz_byte(&in);
    const size_t count = wrong > 0xF0 ? wrong - 0xF0 : c ? c->core->model.states : 0;
    size_t found, *place = wrong % 16 == 15 ? NULL : &found;
    double *x = doubles(count);
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi3SetContinuousStates(c, x, count)); break;
    case 1: OK_OR_ERROR(c, 1, fmi3GetContinuousStates(c, x, count)); break;
    case 2: OK_OR_ERROR(c, 0, fmi3GetContinuousStateDerivatives(c, x, count)); break;
    case 3: OK_OR_ERROR(c, 1, fmi3GetNominalsOfContinuousStates(c, x, count)); break;
    case 4: OK_OR_ERROR(c, 1, fmi3GetNumberOfContinuousStates(c, place)); break;
    case 5: OK_OR_ERROR(c, 1, fmi3GetNumberOfEventIndicators(c, place)); break;
    default: OK_OR_ERROR(c, 1, fmi3GetEventIndicators(c, x, wrong % 2)); break;
    }
    free(x);
}

static void serialise(GpSession *c, size_t i, fmi3FMUState *other) {
    size_t size = 0;
    const unsigned wrong = fuzz_byte(&in), at = fuzz_byte(&in);
    fmi3Byte *bytes;
    OK_OR_ERROR(c, 1, fmi3SerializedFMUStateSize(c, state[i], wrong == 0xFF ? NULL : &size));
    if (wrong > 0xF0) size = size > wrong ? size - (wrong - 0xF0) : size + (wrong - 0xF0);
    bytes = array(size, 1);
    OK_OR_ERROR(c, 1, fmi3SerializeFMUState(c, state[i], bytes, size));
    if (bytes && size > 72 && wrong % 8 == 7) bytes[at * 31 % size] ^= (fmi3Byte)(1 + at);
    if (bytes && wrong % 16 == 15) fuzz_seal(bytes, size);
    OK_OR_ERROR(c, 1, fmi3DeserializeFMUState(c, bytes, size, wrong == 0xFE ? NULL : other));
    free(bytes);
}

static void keep_or_restore(GpSession *c, unsigned what) {
    const size_t i = handle(), k = handle();
    const int missing = fuzz_byte(&in) > 0xF8;
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi3GetFMUState(c, missing ? NULL : &state[i])); break;
    case 1: OK_OR_ERROR(c, 1, fmi3SetFMUState(c, state[i])); break;
    case 2: OK_OR_ERROR(c, 1, fmi3FreeFMUState(c, missing ? NULL : &state[i])); break;
    default: serialise(c, i, &state[k]); break;
    }
}

static void phase(GpSession *c, unsigned what) {
    fmi3Boolean f[5] = {fmi3False, fmi3False, fmi3False, fmi3False, fmi3False};
    double next;
    const unsigned missing = fuzz_byte(&in);
    const double start = what == 0 ? fuzz_double(&in) : 0, stop = what == 0 ? fuzz_double(&in) : 0;
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi3EnterInitializationMode(c, missing > 9, stop, start, missing % 4 == 3, stop)); break;
    case 1: OK_OR_ERROR(c, 0, fmi3ExitInitializationMode(c)); break;
    case 2: OK_OR_ERROR(c, 1, fmi3Terminate(c)); break;
    case 3: OK_OR_ERROR(c, 1, fmi3Reset(c)); break;
    case 4: OK_OR_ERROR(c, 1, fmi3EnterEventMode(c)); break;
    case 5:
        OK_OR_ERROR(c, 0, fmi3UpdateDiscreteStates(c, missing > 0xF8 ? NULL : f, f + 1, f + 2, f + 3, f + 4,
                                                   missing == 0xF8 ? NULL : &next));
        break;
    case 6: OK_OR_ERROR(c, 1, fmi3EnterContinuousTimeMode(c)); break;
    case 7: OK_OR_ERROR(c, 1, fmi3EvaluateDiscreteStates(c)); break;
    default: OK_OR_ERROR(c, 1, fmi3CompletedIntegratorStep(c, 1, missing > 0xF8 ? NULL : f, f + 1)); break;
    }
}

static void step(GpSession *c) {
    const double t = time_of(c), h = step_size(), reached = c ? c->clock.time : 0;
    const unsigned missing = fuzz_byte(&in);
    fmi3Boolean f[3];
    double last;
    int status;
    if (c && !fuzz_is_quick(c->core, h)) return;
    begin(c, 0);
    status = (int)fmi3DoStep(c, t, h, fmi3True, missing == 0xFF ? NULL : f, f + 1, f + 2, missing == 0xFE ? NULL : &last);
    end(c, status, (int)fmi3Error);
    FUZZ_CHECK(!c || status == 0 || c->clock.time == reached, "a failed step moved the clock");
}

static void rest(GpSession *c, unsigned what) {
    const unsigned kind = fuzz_byte(&in), vr = 0;
    const char *categories[2] = {word(), word()};
    fmi3Int32 whole = 0;
    fmi3String text = NULL;
    size_t size = 0;
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi3SetDebugLogging(c, kind % 2 != 0, kind % 3, kind > 0xF0 ? NULL : categories)); break;
    case 1: OK_OR_ERROR(c, 1, fmi3SetTime(c, fuzz_double(&in))); break;
    case 2: OK_OR_ERROR(c, 1, fmi3GetInt32(c, &vr, kind % 2, &whole, kind % 2)); break;
    case 3: OK_OR_ERROR(c, 1, fmi3SetString(c, &vr, kind % 2, &text, kind % 2)); break;
    case 4: OK_OR_ERROR(c, 1, fmi3EnterStepMode(c)); break;
    case 5: OK_OR_ERROR(c, 1, fmi3EnterConfigurationMode(c)); break;
    case 6: OK_OR_ERROR(c, 1, fmi3GetNumberOfVariableDependencies(c, kind, &size)); break;
    default: OK_OR_ERROR(c, 1, fmi3GetOutputDerivatives(c, &vr, 1, &whole, NULL, 1)); break;
    }
}

/* Brings the first instance where most calls are allowed. */
static void prepare(unsigned where) {
    const FuzzModel *m = fuzz_model + where / 8 % fuzz_models;
    watching = where < 0x60;
    if (where % 8 == 0) return;
    slot[0] = where % 8 > 4 ? fmi3InstantiateModelExchange("it", m->guid, m->location, 0, 1, NULL, logger)
                            : fmi3InstantiateCoSimulation("it", m->guid, m->location, 0, 1, 0, 0, NULL, 0, NULL, logger,
                                                          where % 8 > 2 ? intermediate : NULL);
    FUZZ_CHECK(slot[0], "no instance");
    if (where % 8 == 1) return;
    fmi3EnterInitializationMode(slot[0], 0, 0, 0, 0, 0);
    if (where % 8 == 2 || where % 8 == 5) return;
    fmi3ExitInitializationMode(slot[0]);
    if (where % 8 == 7) fmi3EnterContinuousTimeMode(slot[0]);
}

static void one_call(void) {
    const unsigned call = fuzz_byte(&in), which = fuzz_byte(&in);
    GpSession *c = which == 0xFF ? NULL : slot[which % 16 == 15];
    switch (call % 16) {
    case 0: phase(c, call / 16 % 9); break;
    case 1: phase(c, which / 16 % 9); break;
    case 2: rest(c, which / 16 % 8); break;
    case 3: states(c, call / 16 % 7); break;
    case 4: keep_or_restore(c, call / 16 % 4); break;
    case 5: if (call / 16 % 4 == 0) instantiate(which % 16 == 15); else step(c); break;
    case 6:
    case 7: step(c); break;
    case 8: values(c, 3); break;
    case 9: values(c, 2); break;
    case 10:
    case 11:
    case 12: values(c, 1); break;
    default: values(c, 0); break;
    }
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc, (void)argv;
    fuzz_find_models();
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    in.at = data;
    in.end = data + size;
    prepare(fuzz_byte(&in));
    for (int calls = 0; fuzz_left(&in) && calls < 40; calls++) one_call();
    for (size_t i = 0; i < SLOTS; i++) {
        fmi3FreeInstance(slot[i]);
        slot[i] = NULL;
    }
    for (size_t i = 0; i < 2 * SLOTS; i++) {
        free(state[i]); /* one block each, whoever made it */
        state[i] = NULL;
    }
    return 0;
}
