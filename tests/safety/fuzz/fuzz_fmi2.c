/* Fuzzer of the FMI 2 functions: bytes are calls in any order with any arguments, on two instances and four states. */
#include <stdarg.h>

#include "fmi2Functions.h"
#include "fuzz_calls.h"

#define OK_OR_ERROR(c, strict, call)             \
    do {                                         \
        begin(c, strict);                        \
        end(c, (int)(call), (int)fmi2Error);     \
    } while (0)

/* The message is a format, as importers treat it. */
static void logger(fmi2ComponentEnvironment e, fmi2String name, fmi2Status status, fmi2String category, fmi2String message,
                   ...) {
    char text[2 * GP_TEXT_SIZE];
    va_list rest;
    (void)e;
    FUZZ_CHECK(name && category && message, "an incomplete message");
    va_start(rest, message);
    vsnprintf(text, sizeof text, message, rest);
    va_end(rest);
    FUZZ_CHECK(*text, "an empty sentence");
    if (status != fmi2OK) seen(message);
}

static void instantiate(size_t i) {
    static const fmi2CallbackFunctions talking = {logger, NULL, NULL, NULL, NULL}, silent = {NULL, NULL, NULL, NULL, NULL};
    const FuzzModel *m = fuzz_model + fuzz_byte(&in) % fuzz_models;
    const unsigned wrong = fuzz_byte(&in), kind = fuzz_byte(&in);
    const fmi2CallbackFunctions *functions = wrong == 0xFA ? NULL : wrong == 0xFB ? &silent : &talking;
    fmi2FreeInstance(slot[i]);
    begin(NULL, 0);
    slot[i] = fmi2Instantiate(wrong == 0xFC ? word() : "it", kind < 0xF8 ? (fmi2Type)(kind % 2) : (fmi2Type)2,
                              wrong == 0xFD ? word() : m->guid, wrong == 0xFE ? word() : m->location, functions, 0,
                              kind % 4 > 1);
    depth--;
    FUZZ_CHECK(slot[i] || functions != &talking || sentences, "no instance and no sentence");
}

static void values(GpSession *c, unsigned what) {
    const size_t count = fuzz_byte(&in) % 5, known = fuzz_byte(&in) % 4;
    unsigned *vr = references(c, count), *other = NULL;
    double *value = what == 0 ? array(count, sizeof(double)) : doubles(count), *seed = NULL;
    int *order = NULL, status;
    switch (what) {
    case 0:
        begin(c, 0);
        status = (int)fmi2GetReal(c, vr, count, value);
        end(c, status, (int)fmi2Error);
        if (status == 0) all_finite(value, count);
        break;
    case 1: OK_OR_ERROR(c, 1, fmi2SetReal(c, vr, count, value)); break;
    case 2:
        order = integers(count);
        OK_OR_ERROR(c, 1, fmi2SetRealInputDerivatives(c, vr, count, order, value));
        break;
    default:
        other = references(c, known);
        seed = doubles(known);
        begin(c, 0);
        status = (int)fmi2GetDirectionalDerivative(c, vr, count, other, known, seed, value);
        end(c, status, (int)fmi2Error);
        if (status == 0) all_finite(value, count);
    }
    free(vr), free(value), free(order), free(other), free(seed);
}

static void states(GpSession *c, unsigned what) {
    const unsigned wrong = fuzz_byte(&in);
    const size_t count = wrong > 0xF0 ? wrong - 0xF0 : c ? c->core->model.states : 0;
    double *x = doubles(count);
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi2SetContinuousStates(c, x, count)); break;
    case 1: OK_OR_ERROR(c, 1, fmi2GetContinuousStates(c, x, count)); break;
    case 2: OK_OR_ERROR(c, 0, fmi2GetDerivatives(c, x, count)); break;
    case 3: OK_OR_ERROR(c, 1, fmi2GetNominalsOfContinuousStates(c, x, count)); break;
    default: OK_OR_ERROR(c, 1, fmi2GetEventIndicators(c, x, wrong % 2)); break;
    }
    free(x);
}

static void serialise(GpSession *c, size_t i, fmi2FMUstate *other) {
    size_t size = 0;
    const unsigned wrong = fuzz_byte(&in), at = fuzz_byte(&in);
    char *bytes;
    OK_OR_ERROR(c, 1, fmi2SerializedFMUstateSize(c, state[i], wrong == 0xFF ? NULL : &size));
    if (wrong > 0xF0) size = size > wrong ? size - (wrong - 0xF0) : size + (wrong - 0xF0);
    bytes = array(size, 1);
    OK_OR_ERROR(c, 1, fmi2SerializeFMUstate(c, state[i], bytes, size));
    if (bytes && size > 72 && wrong % 8 == 7) bytes[at * 31 % size] ^= (char)(1 + at);
    if (bytes && wrong % 16 == 15) fuzz_seal((uint8_t *)bytes, size);
    OK_OR_ERROR(c, 1, fmi2DeSerializeFMUstate(c, bytes, size, wrong == 0xFE ? NULL : other));
    free(bytes);
}

static void keep_or_restore(GpSession *c, unsigned what) {
    const size_t i = handle(), k = handle();
    const int missing = fuzz_byte(&in) > 0xF8;
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi2GetFMUstate(c, missing ? NULL : &state[i])); break;
    case 1: OK_OR_ERROR(c, 1, fmi2SetFMUstate(c, state[i])); break;
    case 2: OK_OR_ERROR(c, 1, fmi2FreeFMUstate(c, missing ? NULL : &state[i])); break;
    default: serialise(c, i, &state[k]); break;
    }
}

static void phase(GpSession *c, unsigned what) {
    fmi2EventInfo info;
    fmi2Boolean flags[2];
    const int missing = fuzz_byte(&in) > 0xF0;
    const double start = what == 0 ? fuzz_double(&in) : 0, stop = what == 0 ? fuzz_double(&in) : 0;
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi2SetupExperiment(c, missing, stop, start, fuzz_byte(&in) % 4 == 3, stop)); break;
    case 1: OK_OR_ERROR(c, 1, fmi2EnterInitializationMode(c)); break;
    case 2: OK_OR_ERROR(c, 0, fmi2ExitInitializationMode(c)); break;
    case 3: OK_OR_ERROR(c, 1, fmi2Terminate(c)); break;
    case 4: OK_OR_ERROR(c, 1, fmi2Reset(c)); break;
    case 5: OK_OR_ERROR(c, 1, fmi2EnterEventMode(c)); break;
    case 6: OK_OR_ERROR(c, 0, fmi2NewDiscreteStates(c, missing ? NULL : &info)); break;
    case 7: OK_OR_ERROR(c, 1, fmi2EnterContinuousTimeMode(c)); break;
    default: OK_OR_ERROR(c, 1, fmi2CompletedIntegratorStep(c, 1, missing ? NULL : flags, flags + 1)); break;
    }
}

static void step(GpSession *c) {
    const double t = time_of(c), h = step_size(), reached = c ? c->clock.time : 0;
    int status;
    if (c && !fuzz_is_quick(c->core, h)) return;
    begin(c, 0);
    status = (int)fmi2DoStep(c, t, h, 1);
    end(c, status, (int)fmi2Error);
    FUZZ_CHECK(!c || status == 0 || c->clock.time == reached, "a failed step moved the clock");
}

/* FMI 2 answers a question that has no answer with fmi2Discard. */
#define OK_OR_DISCARD(c, call)                             \
    do {                                                   \
        int status_;                                       \
        begin(c, 1);                                       \
        status_ = (int)(call);                             \
        end(c, status_ == (int)fmi2Discard ? (int)fmi2Error : status_, (int)fmi2Error); \
    } while (0)

static void rest(GpSession *c, unsigned what) {
    const unsigned kind = fuzz_byte(&in), vr = 0;
    fmi2Integer whole = 0;
    fmi2Real real = 0;
    fmi2String text = NULL;
    fmi2Status status = fmi2OK;
    const char *categories[2] = {word(), word()};
    switch (what) {
    case 0: OK_OR_ERROR(c, 1, fmi2SetDebugLogging(c, kind % 2 != 0, kind % 3, kind > 0xF0 ? NULL : categories)); break;
    case 1: OK_OR_ERROR(c, 1, fmi2SetTime(c, fuzz_double(&in))); break;
    case 2: OK_OR_ERROR(c, 1, fmi2GetInteger(c, &vr, kind % 2, &whole)); break;
    case 3: OK_OR_ERROR(c, 1, fmi2SetString(c, &vr, kind % 2, &text)); break;
    case 4: OK_OR_DISCARD(c, fmi2GetRealStatus(c, (fmi2StatusKind)(kind % 5), kind > 0xF0 ? NULL : &real)); break;
    case 5: OK_OR_DISCARD(c, fmi2GetStatus(c, (fmi2StatusKind)(kind % 5), kind > 0xF0 ? NULL : &status)); break;
    case 6: OK_OR_DISCARD(c, fmi2GetBooleanStatus(c, (fmi2StatusKind)(kind % 5), kind > 0xF0 ? NULL : &whole)); break;
    case 7: OK_OR_DISCARD(c, fmi2GetStringStatus(c, fmi2PendingStatus, &text)); break;
    case 8: OK_OR_ERROR(c, 1, fmi2GetRealOutputDerivatives(c, &vr, 1, &whole, &real)); break;
    default: OK_OR_ERROR(c, 1, fmi2CancelStep(c)); break;
    }
}

/* Brings the first instance where most calls are allowed. */
static void prepare(unsigned where) {
    const FuzzModel *m = fuzz_model + where / 8 % fuzz_models;
    static const fmi2CallbackFunctions talking = {logger, NULL, NULL, NULL, NULL};
    const fmi2Type kind = where % 8 > 4 ? fmi2ModelExchange : fmi2CoSimulation;
    watching = where < 0x60;
    if (where % 8 == 0) return;
    slot[0] = fmi2Instantiate("it", kind, m->guid, m->location, &talking, 0, 1);
    FUZZ_CHECK(slot[0], "no instance");
    if (where % 8 == 1) return;
    fmi2EnterInitializationMode(slot[0]);
    if (where % 8 == 2 || where % 8 == 5) return;
    fmi2ExitInitializationMode(slot[0]);
    if (where % 8 == 7) fmi2EnterContinuousTimeMode(slot[0]);
}

static void one_call(void) {
    const unsigned call = fuzz_byte(&in), which = fuzz_byte(&in);
    GpSession *c = which == 0xFF ? NULL : slot[which % 16 == 15];
    switch (call % 16) {
    case 0: phase(c, call / 16 % 9); break;
    case 1: phase(c, which / 16 % 9); break;
    case 2: rest(c, which / 16 % 10); break;
    case 3: states(c, call / 16 % 5); break;
    case 4: keep_or_restore(c, call / 16 % 4); break;
    case 5: if (call / 16 % 4 == 0) instantiate(which % 16 == 15); else step(c); break;
    case 6:
    case 7: step(c); break;
    case 8:
    case 9: values(c, 3); break;
    case 10: values(c, 2); break;
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
        fmi2FreeInstance(slot[i]);
        slot[i] = NULL;
    }
    for (size_t i = 0; i < 2 * SLOTS; i++) {
        free(state[i]); /* one block each, whoever made it */
        state[i] = NULL;
    }
    return 0;
}
