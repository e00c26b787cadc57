/* Model exchange and states of a session (declared in gp_session.h). */
#include <stdlib.h>
#include <string.h>

#include "gp_linalg.h"
#include "gp_session.h"
#include "gp_state.h"

static const int EXCHANGE = GP_EVENT | GP_CONTINUOUS;
static const int WITH_STATES = GP_INITIALISING | GP_EVENT | GP_CONTINUOUS | GP_TERMINATED;

static int check(GpSession *s, const char *function, int phases, const double *array, size_t count) {
    if (gp_session_of_kind(s, 1, function) || gp_session_allowed(s, phases, function)) return -1;
    if (count != s->core->model.states) return gp_session_fail(s, function, "This is not the number of continuous states.");
    return array ? 0 : gp_session_fail(s, function, "The array is missing.");
}

int gp_session_set_time(GpSession *s, const char *function, double time) {
    if (gp_session_of_kind(s, 1, function) || gp_session_allowed(s, EXCHANGE, function)) return -1;
    if (!gp_finite(time)) return gp_session_fail(s, function, "The time must be finite.");
    s->core->time = s->clock.time = time;
    return 0;
}

int gp_session_states(GpSession *s, const char *function, double *states, size_t count) {
    return check(s, function, WITH_STATES, states, count) || gp_get_states(s->core, states) ? -1 : 0;
}

int gp_session_set_states(GpSession *s, const char *function, const double *states, size_t count) {
    if (check(s, function, GP_CONTINUOUS, states, count)) return -1;
    return gp_set_states(s->core, states) ? gp_session_fail(s, function, s->core->message.text) : 0;
}

int gp_session_derivatives(GpSession *s, const char *function, double *derivatives, size_t count) {
    if (check(s, function, WITH_STATES, derivatives, count)) return -1;
    return gp_get_derivatives(s->core, derivatives) ? gp_session_fail(s, function, s->core->message.text) : 0;
}

int gp_session_nominals(GpSession *s, const char *function, double *nominals, size_t count) {
    if (check(s, function, WITH_STATES | GP_INSTANTIATED, nominals, count)) return -1;
    gp_get_nominals(s->core, nominals);
    return 0;
}

int gp_session_indicators(GpSession *s, const char *function, size_t count) {
    if (gp_session_of_kind(s, 1, function) || gp_session_allowed(s, WITH_STATES, function)) return -1;
    return count ? gp_session_fail(s, function, "This FMU has no event indicators.") : 0;
}

int gp_session_update(GpSession *s, const char *function, int *states_changed) {
    *states_changed = 0;
    if (gp_session_allowed(s, GP_EVENT, function)) return -1;
    if (gp_use_parameters(s->core)) return gp_session_fail(s, function, s->core->message.text);
    *states_changed = s->core->jumped;
    s->core->jumped = 0;
    return 0;
}

int gp_session_continue(GpSession *s, const char *function) {
    if (gp_session_of_kind(s, 1, function) || gp_session_allowed(s, GP_EVENT, function)) return -1;
    s->phase = GP_CONTINUOUS;
    s->core->begun = 1;
    return 0;
}

static size_t stated_size(const void *state) { /* of a state in memory, from its header */
    uint64_t size;
    memcpy(&size, (const unsigned char *)state + 16, 8);
    return (size_t)size;
}

static const int NOT_IN_A_STEP = ~GP_INTERMEDIATE;

int gp_session_keep(GpSession *s, const char *function, void **state) {
    const GpClock *c;
    void *place;
    if (gp_session_allowed(s, NOT_IN_A_STEP, function)) return -1;
    if (!state) return gp_session_fail(s, function, "The place for the state is missing.");
    place = *state;
    if (place && stated_size(place) != gp_state_size(s->core)) {
        gp_session_fail(s, function, "The state given to be overwritten belongs to another model.");
        return -1;
    }
    if (!place) place = malloc(gp_state_size(s->core));
    if (!place) return gp_session_fail(s, function, "There is not enough memory for the state.");
    c = &s->clock;
    {
        const double extra[GP_STATE_EXTRA] = {(double)s->phase, s->exchange, c->time,
                                              c->stop, c->has_stop, s->core->jumped};
        gp_state_write(s->core, extra, place);
    }
    *state = place;
    return 0;
}

static int restore(GpSession *s, const char *function, const unsigned char *bytes, size_t size, int look_only) {
    double extra[GP_STATE_EXTRA];
    if (gp_state_check(s->core, bytes, size)) return gp_session_fail(s, function, s->core->message.text);
    memcpy(extra, bytes + 72, sizeof extra);
    for (int phase = GP_INSTANTIATED; phase <= GP_TERMINATED; phase *= 2) {
        const int co_simulation_only = phase == GP_STEPPING, exchange_only = phase == GP_EVENT || phase == GP_CONTINUOUS;
        if (extra[0] != phase || phase == GP_INTERMEDIATE) continue;
        if (extra[1] != s->exchange || (s->exchange ? co_simulation_only : exchange_only))
            return gp_session_fail(s, function, "The state belongs to the other kind of interface.");
        if (extra[4] != 0 && extra[4] != 1) break;
        if (extra[5] != 0 && extra[5] != 1) break;
        if (look_only) return 0;
        if (gp_state_read(s->core, bytes, size, extra)) return gp_session_fail(s, function, s->core->message.text);
        s->phase = (GpPhase)phase;
        s->clock.time = extra[2];
        s->clock.stop = extra[3];
        s->clock.has_stop = extra[4] != 0;
        s->core->jumped = extra[5] != 0;
        return 0;
    }
    return gp_session_fail(s, function, "The state cannot be used: a number in it is out of range.");
}

int gp_session_restore(GpSession *s, const char *function, const void *state) {
    if (gp_session_allowed(s, NOT_IN_A_STEP, function)) return -1;
    if (!state) return gp_session_fail(s, function, "The state is missing.");
    return restore(s, function, state, stated_size(state), 0);
}

int gp_session_serialised_size(GpSession *s, const char *function, const void *state, size_t *size) {
    if (gp_session_allowed(s, NOT_IN_A_STEP, function)) return -1;
    if (!state || !size) return gp_session_fail(s, function, "The state or the place for its size is missing.");
    *size = stated_size(state);
    return 0;
}

int gp_session_serialise(GpSession *s, const char *function, const void *state, unsigned char *bytes, size_t size) {
    if (gp_session_allowed(s, NOT_IN_A_STEP, function)) return -1;
    if (!state || !bytes) return gp_session_fail(s, function, "The state or the place for its bytes is missing.");
    if (size < stated_size(state)) return gp_session_fail(s, function, "The place for the bytes is too small.");
    memcpy(bytes, state, stated_size(state));
    return 0;
}

int gp_session_deserialise(GpSession *s, const char *function, const unsigned char *bytes, size_t size,
                           void **state) {
    void *place;
    if (gp_session_allowed(s, NOT_IN_A_STEP, function)) return -1;
    if (!bytes || !state) return gp_session_fail(s, function, "The bytes or the place for the state are missing.");
    if (size >= 72 && stated_size(bytes) < size && stated_size(bytes) == gp_state_size(s->core))
        size = stated_size(bytes); /* room that was too large */
    if (restore(s, function, bytes, size, 1)) return -1;
    place = *state;
    if (place && stated_size(place) != size) return gp_session_fail(s, function, "The state given to be overwritten belongs to another model.");
    if (!place) place = malloc(size);
    if (!place) return gp_session_fail(s, function, "There is not enough memory for the state.");
    memcpy(place, bytes, size);
    *state = place;
    return 0;
}
