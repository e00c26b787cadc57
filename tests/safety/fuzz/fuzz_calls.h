/* What the fuzzers of both call sequences share: instances, states, arguments of all sorts, and what must hold after
   every call. */
#ifndef FUZZ_CALLS_H
#define FUZZ_CALLS_H
#include "fuzz.h"
#include "fuzz_models.h"
#include "gp_session.h"

enum { SLOTS = 2, LARGEST_SNAPSHOT = 1 << 16 };

static Bytes in;                    /* what the calls and their arguments are read from */
static GpSession *slot[SLOTS];
static void *state[2 * SLOTS];      /* handles, each of the instance state_owner */
static size_t state_size[2 * SLOTS]; /* of the states behind them: all models have their own */
static int sentences;               /* logged errors since the call began */
static uint8_t before[LARGEST_SNAPSHOT], after[LARGEST_SNAPSHOT];
static const GpSession *watched; /* of the call under way; NULL where it may change something though it fails */
static int depth;                /* calls under way: callbacks make calls as well */
static int watching;             /* whether failed calls are looked at in this way at all: it takes time */

/* An array of `count` items in memory of its own, or NULL where the bytes say so. */
static inline void *array(size_t count, size_t item) {
    void *place;
    if (fuzz_byte(&in) == 0xFF) return NULL;
    place = malloc(count * item ? count * item : 1);
    FUZZ_CHECK(place, "no memory");
    memset(place, 0x5A, count * item);
    return place;
}

static inline double *doubles(size_t count) {
    double *place = array(count, sizeof *place);
    for (size_t i = 0; place && i < count; i++) place[i] = fuzz_double(&in);
    return place;
}

static inline int *integers(size_t count) { /* orders: mostly 1 */
    int *place = array(count, sizeof *place);
    for (size_t i = 0; place && i < count; i++) place[i] = (int)(fuzz_byte(&in) % 17 == 16 ? 2 : 1);
    return place;
}

static inline unsigned *references(const GpSession *c, size_t count) {
    unsigned *place = array(count, sizeof *place);
    for (size_t i = 0; place && i < count; i++) {
        place[i] = fuzz_byte(&in);
        if (c && place[i] < 0xF8) place[i] %= (unsigned)c->core->model.variables;
        if (place[i] == 0xFE) place[i] = 0xFFFFFFFFu;
    }
    return place;
}

/* Values that these variables have in all; seldom another number. */
static inline size_t values_of(GpSession *c, const unsigned *reference, size_t count) {
    size_t values = count;
    const unsigned wrong = fuzz_byte(&in);
    if (wrong > 0xF0) return wrong - 0xF0;
    for (size_t i = 0; c && reference && i < count; i++)
        if (reference[i] < c->core->model.variables)
            values += gp_variable_size(&c->core->model, c->core->model.variable + reference[i]) - 1;
    return values;
}

static inline double time_of(const GpSession *c) { /* mostly where the simulation is */
    return c && fuzz_byte(&in) < 0xE0 ? c->clock.time : fuzz_double(&in);
}

static inline double step_size(void) {
    static const double known[] = {1e-5, 1e-5, 1e-5, 2e-5, 1e-4, 1e-3};
    const unsigned choice = fuzz_byte(&in);
    return choice < 0xE0 ? known[choice % (sizeof known / sizeof *known)] : fuzz_double(&in);
}

static inline const char *word(void) {
    static const char *const known[] = {"it", "logAll", "logEvents", "logStatusError", "", NULL, "%s%n#r1#", "nothing"};
    return known[fuzz_byte(&in) % (sizeof known / sizeof *known)];
}

static inline void snapshot(const GpSession *c, uint8_t *to) {
    const double extra[GP_STATE_EXTRA] = {c->phase, c->exchange, c->clock.time, c->clock.stop, c->clock.has_stop, c->log};
    FUZZ_CHECK(gp_state_size(c->core) <= LARGEST_SNAPSHOT, "the model is too large to be fuzzed");
    gp_state_write(c->core, extra, to);
}

/* Before a call; `strict` where a failure must not change anything. */
static inline void begin(const GpSession *c, int strict) {
    if (depth++) return; /* the call around this one is watched */
    sentences = 0;
    watched = strict && watching ? c : NULL;
    if (watched) snapshot(watched, before);
}

/* After a call that returned `status`, 0 or `error`; it must have said why it failed. */
static inline void end(const GpSession *c, int status, int error) {
    depth--;
    FUZZ_CHECK(status == 0 || status == error, "a status that is neither OK nor error");
    if (depth || status == 0) return;
    FUZZ_CHECK(!c || !c->logger || sentences, "a call failed without a sentence");
    if (!watched) return;
    snapshot(watched, after);
    FUZZ_CHECK(!memcmp(before, after, gp_state_size(watched->core)), "a failed call changed something");
}

static inline void all_finite(const double *values, size_t count) {
    for (size_t i = 0; i < count; i++) FUZZ_CHECK(isfinite(values[i]), "a number that is not finite was returned");
}

/* A handle that belongs to a model with states of another size would be refused by its header; one that was freed cannot
   be told from a live one by anybody, so it is not used. */
static inline size_t handle(void) { return fuzz_byte(&in) % (2 * SLOTS); }

static inline void seen(const char *sentence) {
    FUZZ_CHECK(sentence && *sentence && strlen(sentence) < GP_TEXT_SIZE, "an empty or endless sentence");
    sentences++;
}
#endif
