/* Fuzzer of serialised states: what is accepted must run on, and alike in a fresh and in a used instance. */
#include "fuzz.h"
#include "fuzz_models.h"
#include "gp_session.h"

enum { ROOM = 1024, HEADER = 72 };

static GpSession *fresh[2 * FUZZ_MODELS], *used[2 * FUZZ_MODELS]; /* co-simulation, then model exchange */
static int said;

static void say(const GpSession *s, int is_error, const char *category, const char *sentence) {
    (void)s, (void)category;
    said += is_error && *sentence;
}

static GpSession *session(const FuzzModel *m, int exchange) {
    GpText message;
    GpSession *s = gp_session_create("fuzz", m->guid, m->location, exchange, &message);
    FUZZ_CHECK(s, "the model cannot be used");
    s->say = say;
    return s;
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc, (void)argv;
    fuzz_find_models();
    for (unsigned i = 0; i < 2 * fuzz_models; i++) {
        fresh[i] = session(fuzz_model + i / 2, i % 2 != 0);
        used[i] = session(fuzz_model + i / 2, i % 2 != 0);
    }
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    /* two bytes of choices stand before the blob */
    if (size < 3) return LLVMFuzzerMutate(data, size, max_size);
    if (seed % 8 == 7) data[seed / 8 % 2] = (uint8_t)(seed / 16);
    return 2 + fuzz_mutate_numbers(data + 2, size - 2, max_size - 2, seed);
}

/* Leaves the modal form, and discretisations and responses of other parameters behind. */
static void wear(GpSession *s) {
    GpInstance *p = s->core;
    double values[ROOM];
    for (unsigned reference = 0; reference < p->model.variables; reference++) {
        const size_t size = gp_variable_size(&p->model, p->model.variable + reference);
        double value[ROOM];
        const GpVariable *v = p->model.variable + reference;
        if (size > ROOM || (gp_role(&p->model, v) != GP_IS_PARAMETER && v->kind != GP_TORQUE)) continue;
        if (gp_get(p, &reference, 1, value, size)) continue;
        for (size_t i = 0; i < size; i++) value[i] *= 1.5;
        gp_set(p, &reference, 1, value, size);
    }
    gp_step(p, 0, 1e-5);
    fuzz_get_all(p, values, ROOM);
}

static int step(GpSession *s, double h) {
    if (s->exchange) {
        double states[64];
        return gp_session_derivatives(s, "derivatives", states, s->core->model.states);
    }
    return gp_session_step(s, "step", s->clock.time, h);
}

/* Both make the same steps from the same state: the same results. */
static void run_alike(GpSession *a, GpSession *b, int steps) {
    const double h = 1e-5;
    double left[ROOM], right[ROOM];
    for (int i = 0; i < steps; i++) {
        const size_t count = fuzz_get_all(a->core, left, ROOM);
        FUZZ_CHECK(count == fuzz_get_all(b->core, right, ROOM), "one instance has other variables");
        FUZZ_CHECK(!memcmp(left, right, count * sizeof *left), "a restored state has other results in a used instance");
        if (!fuzz_is_quick(a->core, h)) return;
        FUZZ_CHECK(!step(a, h) == !step(b, h), "a step fails in one instance only");
    }
}

/* The state of `a`, restored in `b`, is kept as the same bytes. */
static void keep_alike(GpSession *a, GpSession *b) {
    void *state = NULL, *again = NULL;
    size_t size = 0;
    FUZZ_CHECK(!gp_session_keep(a, "keep", &state) && !gp_session_serialised_size(a, "size", state, &size), "not kept");
    if (!gp_session_restore(b, "restore", state)) {
        FUZZ_CHECK(!gp_session_keep(b, "keep", &again), "not kept");
        FUZZ_CHECK(!memcmp(state, again, size), "a state changed by being restored");
    }
    free(state);
    free(again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Bytes in = {data, data + size};
    const unsigned which = fuzz_byte(&in) % (2 * fuzz_models), how = fuzz_byte(&in);
    GpSession *a = fresh[which], *b = used[which];
    const size_t whole = gp_state_size(a->core), given = fuzz_left(&in);
    const size_t length = how & 1 ? given : whole; /* most often the right size: the checks behind it are reached */
    uint8_t *blob = calloc(length ? length : 1, 1);
    void *state = NULL, *other = NULL;
    FUZZ_CHECK(blob, "no memory");
    memcpy(blob, in.at, given < length ? given : length);
    if (length >= HEADER && !(how & 2)) memcpy(blob + 32, a->core->model.guid, 40);
    if (!(how & 4)) fuzz_seal(blob, length);
    gp_session_reset(a, "reset");
    said = 0;
    if (gp_session_deserialise(a, "deserialise", blob, length, &state)) {
        FUZZ_CHECK(said, "a state was refused without a sentence");
        FUZZ_CHECK(!state, "a refused state has a handle");
    } else {
        gp_session_reset(b, "reset");
        wear(b);
        FUZZ_CHECK(!gp_session_deserialise(b, "deserialise", blob, length, &other), "refused by a used instance only");
        FUZZ_CHECK(!gp_session_restore(a, "restore", state) && !gp_session_restore(b, "restore", other), "not restored");
        run_alike(a, b, 2);
        keep_alike(a, b);
        run_alike(a, b, 1);
    }
    free(blob);
    free(state);
    free(other);
    return 0;
}
