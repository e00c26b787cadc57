/* Fuzzer of model.bin: whatever the reader accepts is made an instance and used. The harness makes size and checksum
   right, so that the checks behind them are reached. */
#include "fuzz.h"

enum { ROOM = 4096 };

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return fuzz_mutate_numbers(data, size, max_size, seed);
}

/* Small enough to be quick: the reader itself has seen the large ones. */
static int is_small(const GpModel *m) {
    return m->order <= 12 && m->rows <= 12 && m->loads <= 4 && m->outputs <= 24 && m->variables <= 400 && m->tones <= 4;
}

static void set_all(GpInstance *p, double factor) {
    for (unsigned reference = 0; reference < p->model.variables; reference++) {
        const size_t size = gp_variable_size(&p->model, p->model.variable + reference);
        double value[ROOM];
        if (size > ROOM || gp_get(p, &reference, 1, value, size)) continue;
        for (size_t i = 0; i < size; i++) value[i] *= factor;
        if (gp_set(p, &reference, 1, value, size)) FUZZ_CHECK(p->message.length, "a set failed without a sentence");
    }
}

static void derivatives(GpInstance *p) {
    double result[ROOM], seed[ROOM];
    for (int i = 0; i < ROOM; i++) seed[i] = 1;
    for (unsigned known = 0; known < p->model.variables; known += 3) {
        const unsigned unknown = (unsigned)(known * 7 + 5) % (unsigned)p->model.variables;
        const size_t k = gp_variable_size(&p->model, p->model.variable + known);
        const size_t u = gp_variable_size(&p->model, p->model.variable + unknown);
        if (k > 64 || u > 64) continue;
        gp_directional(p, &unknown, 1, &known, 1, seed, k, result, u);
        gp_adjoint(p, &unknown, 1, &known, 1, seed, u, result, k);
    }
}

static void save_and_restore(GpInstance *p) {
    double extra[GP_STATE_EXTRA] = {1, 2, 3, 4, 5, 6}, found[GP_STATE_EXTRA];
    const size_t size = gp_state_size(p);
    uint8_t *bytes = malloc(size), *again = malloc(size);
    int failed;
    FUZZ_CHECK(bytes && again, "no memory");
    gp_state_write(p, extra, bytes);
    failed = gp_state_read(p, bytes, size, found);
    if (!failed) {
        gp_state_write(p, found, again);
        FUZZ_CHECK(!memcmp(bytes, again, size), "a state changed by being restored");
    }
    free(bytes);
    free(again);
}

static void use(GpInstance *p) {
    static const double sizes[] = {1e-5, 1e-3};
    double values[ROOM], states[64], time = 0;
    fuzz_get_all(p, values, ROOM);
    for (int i = 0; i < 3; i++) {
        const double h = sizes[i % 2];
        if (!fuzz_is_quick(p, h)) break;
        if (gp_step(p, time += h, h)) FUZZ_CHECK(p->message.length, "a step failed without a sentence");
        fuzz_get_all(p, values, ROOM);
        if (i == 0) set_all(p, 1.25); /* leaves the modal form */
        if (i == 1) save_and_restore(p);
    }
    gp_get_states(p, states);
    gp_set_states(p, states);
    gp_get_derivatives(p, states);
    gp_get_nominals(p, states);
    derivatives(p);
    gp_instance_reset(p);
    fuzz_get_all(p, values, ROOM);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint8_t *file = fuzz_copy(data, size);
    GpModel model;
    GpText message;
    FILE *stream;
    fuzz_seal(file, size);
    stream = fmemopen(file, size, "rb");
    FUZZ_CHECK(stream, "no stream");
    gp_text_clear(&message);
    if (gp_model_read(&model, stream, &message)) {
        FUZZ_CHECK(message.length, "a model was refused without a sentence");
        FUZZ_CHECK(!model.bytes, "a refused model owns memory");
    } else if (!is_small(&model)) {
        gp_model_free(&model);
    } else {
        GpInstance *p = gp_instance_create(&model, &message);
        FUZZ_CHECK(p, "no memory");
        use(p);
        gp_instance_free(p);
    }
    fclose(stream);
    free(file);
    return 0;
}
