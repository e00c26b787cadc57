#include "gp_session.h"

#include <stdlib.h>
#include <string.h>

#include "gp_linalg.h"
#include "gp_path.h"
#include "gp_schedule.h"

static const int RUNNING = GP_INITIALISING | GP_EVENT | GP_CONTINUOUS | GP_STEPPING | GP_INTERMEDIATE | GP_TERMINATED;

GpSession *gp_session_create(const char *name, const char *guid, const char *location, int exchange,
                             GpText *message) {
    GpModel model;
    GpSession *s;
    FILE *stream = gp_open_resource(location, "model.bin", message);
    int failed;
    if (!stream) return NULL;
    failed = gp_model_read(&model, stream, message);
    (void)fclose(stream); /* it was only read */
    if (failed) return NULL;
    if (strcmp(model.guid, guid) != 0) {
        gp_text_add(message, "The GUID (FMI 3: the instantiation token) does not belong to resources/model.bin; the FMU's files are mixed up.");
        gp_model_free(&model);
        return NULL;
    }
    s = calloc(1, sizeof *s);
    if (s) s->name = malloc(strlen(name) + 1);
    if (s && s->name) s->core = gp_instance_create(&model, message);
    if (!s || !s->core) {
        if (!message->length) gp_text_add(message, "There is not enough memory for another instance.");
        if (s) free(s->name);
        free(s);
        gp_model_free(&model);
        return NULL;
    }
    memcpy(s->name, name, strlen(name) + 1);
    s->exchange = exchange;
    s->phase = GP_INSTANTIATED;
    gp_clock_start(&s->clock, 0, 0, 0, message);
    return s;
}

void gp_session_free(GpSession *s, const char *function) {
    if (!s || gp_session_allowed(s, ~GP_INTERMEDIATE, function)) return;
    gp_instance_free(s->core);
    free(s->name);
    free(s);
}

static void say(const GpSession *s, int is_error, const char *category, const char *function, const char *sentence) {
    GpText text;
    if (!s->say) return;
    gp_text_clear(&text);
    gp_text_add(&text, function);
    gp_text_add(&text, ": ");
    gp_text_add(&text, sentence);
    s->say(s, is_error, category, text.text);
}

int gp_session_fail(GpSession *s, const char *function, const char *sentence) {
    if (s) say(s, 1, "logStatusError", function, sentence);
    return -1;
}

/* 0, or -1 with the core's message logged. */
static int passed(GpSession *s, const char *function, int failed) {
    return failed ? gp_session_fail(s, function, s->core->message.text) : 0;
}

int gp_session_allowed(GpSession *s, int phases, const char *function) {
    if (!s) return -1; /* nobody to tell */
    if ((int)s->phase & phases) return 0;
    switch (s->phase) {
    case GP_INSTANTIATED: return gp_session_fail(s, function, "This call is not allowed before initialisation.");
    case GP_INITIALISING: return gp_session_fail(s, function, "This call is not allowed in initialisation mode.");
    case GP_EVENT: return gp_session_fail(s, function, "This call is not allowed in event mode.");
    case GP_CONTINUOUS: return gp_session_fail(s, function, "This call is not allowed in continuous-time mode.");
    case GP_STEPPING: return gp_session_fail(s, function, "This call is not allowed once the simulation runs; there is no event mode in co-simulation.");
    case GP_INTERMEDIATE: return gp_session_fail(s, function, "This call is not allowed during a step.");
    default: return gp_session_fail(s, function, "This call is not allowed after terminating; reset the instance first.");
    }
}

int gp_session_of_kind(GpSession *s, int exchange, const char *function) {
    if (!s) return -1;
    if (s->exchange == exchange) return 0;
    return gp_session_fail(s, function,
                           exchange ? "This instance was made for co-simulation, not for model exchange."
                                    : "This instance was made for model exchange, not for co-simulation.");
}

int gp_session_start(GpSession *s, const char *function, double start, int has_stop, double stop) {
    gp_text_clear(&s->message);
    if (gp_clock_start(&s->clock, start, has_stop, stop, &s->message))
        return gp_session_fail(s, function, s->message.text);
    s->core->time = start;
    return 0;
}

int gp_session_exit_initialisation(GpSession *s, const char *function) {
    if (gp_session_allowed(s, GP_INITIALISING, function)) return -1;
    if (gp_use_parameters(s->core)) return gp_session_fail(s, function, s->core->message.text);
    s->phase = s->exchange ? GP_EVENT : GP_STEPPING;
    return 0;
}

int gp_session_reset(GpSession *s, const char *function) {
    if (gp_session_allowed(s, ~GP_INTERMEDIATE, function)) return -1;
    gp_text_clear(&s->message);
    gp_instance_reset(s->core);
    gp_clock_start(&s->clock, 0, 0, 0, &s->message);
    s->phase = GP_INSTANTIATED;
    return 0;
}

int gp_session_set_logging(GpSession *s, const char *function, int on, size_t count, const char *const *categories) {
    int log = 0;
    if (!s) return -1;
    if (count && !categories) return gp_session_fail(s, function, "The categories are missing.");
    for (size_t i = 0; i < count; i++) {
        const char *category = categories[i] ? categories[i] : "";
        if (!strcmp(category, "logEvents"))
            log |= GP_LOG_EVENTS;
        else if (!strcmp(category, "logAll"))
            log |= GP_LOG_ALL;
        else if (strcmp(category, "logStatusError") != 0)
            return gp_session_fail(s, function, "Only the categories logStatusError, logEvents and logAll exist.");
    }
    s->log = !on ? 0 : count ? log : GP_LOG_ALL;
    return 0;
}

/* What may be set in the present phase. */
static int settable(const GpSession *s) {
    switch (s->phase) {
    case GP_INSTANTIATED:
    case GP_INITIALISING: return GP_IS_INPUT | GP_IS_PARAMETER | GP_IS_STATE;
    case GP_EVENT:
    case GP_STEPPING: return GP_IS_INPUT | GP_IS_PARAMETER;
    case GP_CONTINUOUS: return GP_IS_INPUT | GP_IS_STATE; /* states too: FMI 2.0.1, 3.2.3, condition 5 */
    default: return GP_IS_INPUT;
    }
}

static int check_roles(GpSession *s, const char *function, const unsigned int *reference, size_t count) {
    const GpModel *m = &s->core->model;
    for (size_t i = 0; i < count; i++) {
        GpRole role;
        if (reference[i] >= m->variables) return passed(s, function, gp_refuse(s->core, reference[i], " does not exist."));
        if (gp_schedule_decides(m, m->variable + reference[i]))
            return passed(s, function, gp_refuse(s->core, reference[i], GP_DECIDED));
        role = gp_role(m, m->variable + reference[i]);
        if (role == GP_IS_RESULT)
            return passed(s, function, gp_refuse(s->core, reference[i], " is a result and cannot be set."));
        if ((int)role & settable(s)) continue;
        return passed(s, function,
                      gp_refuse(s->core, reference[i],
                                role == GP_IS_STATE     ? " is a state; it can be set before the simulation and in continuous-time mode only."
                                : s->phase == GP_CONTINUOUS ? " is a parameter; it can be set in event mode only."
                                                        : " is a parameter; it can be set between steps only."));
    }
    return 0;
}

/* In the importer's callback the inputs are those of the end of the step: they become slopes. */
static int set_ends(GpSession *s, const char *function, const unsigned int *reference, size_t count,
                    const double *value, size_t values) {
    const int first = 1;
    double now, slope;
    if (!s->asking) return gp_session_fail(s, function, "The step is done; inputs can be set before the next one.");
    if (values != count) return gp_session_fail(s, function, "There must be one value for each of these inputs.");
    for (int look_only = 1; look_only >= 0; look_only--)
        for (size_t i = 0; i < count; i++) {
            if (gp_get(s->core, reference + i, 1, &now, 1)) return passed(s, function, -1);
            slope = (value[i] - now) / s->step;
            if (!gp_finite(slope))
                return passed(s, function, gp_refuse(s->core, reference[i], " must be set to a finite number."));
            if (!look_only && passed(s, function, gp_set_slope(s->core, reference + i, 1, &first, &slope))) return -1;
        }
    return 0;
}

/* Within a step results belong to its end, when that is reached. */
static int check_results(GpSession *s, const char *function) {
    if (gp_session_allowed(s, RUNNING, function)) return -1;
    if (s->phase != GP_INTERMEDIATE || !s->asking) return 0;
    return gp_session_fail(s, function, "The step is not done yet; results can be read in the callback after it.");
}

int gp_session_set(GpSession *s, const char *function, const unsigned int *reference, size_t count,
                   const double *value, size_t values) {
    if (gp_session_allowed(s, (GP_INSTANTIATED | RUNNING) & ~GP_TERMINATED, function)) return -1;
    if ((count && !reference) || (values && !value))
        return gp_session_fail(s, function, "The references or values are missing.");
    if (check_roles(s, function, reference, count)) return -1;
    if (s->phase == GP_INTERMEDIATE) return set_ends(s, function, reference, count, value, values);
    return passed(s, function, gp_set(s->core, reference, count, value, values));
}

int gp_session_get(GpSession *s, const char *function, const unsigned int *reference, size_t count, double *value,
                   size_t values) {
    if (check_results(s, function)) return -1;
    if ((count && !reference) || (values && !value))
        return gp_session_fail(s, function, "The references or values are missing.");
    return passed(s, function, gp_get(s->core, reference, count, value, values));
}

int gp_session_slopes(GpSession *s, const char *function, const unsigned int *reference, size_t count,
                      const int *order, const double *value) {
    if (gp_session_of_kind(s, 0, function)) return -1;
    if (gp_session_allowed(s, GP_INSTANTIATED | GP_INITIALISING | GP_STEPPING, function)) return -1;
    if (count && (!reference || !order || !value))
        return gp_session_fail(s, function, "The references, orders or values are missing.");
    return passed(s, function, gp_set_slope(s->core, reference, count, order, value));
}

int gp_session_count(GpSession *s, const char *function, const unsigned int *reference, size_t count,
                     size_t *values) {
    if (!s) return -1;
    if (count && !reference) return gp_session_fail(s, function, "The references are missing.");
    return passed(s, function, gp_count(s->core, reference, count, values));
}

int gp_session_check_step(GpSession *s, const char *function, double t, double h) {
    if (gp_session_allowed(s, GP_STEPPING, function)) return -1;
    gp_text_clear(&s->message);
    if (gp_clock_check(&s->clock, t, h, &s->message)) return gp_session_fail(s, function, s->message.text);
    return 0;
}

int gp_session_step(GpSession *s, const char *function, double t, double h) {
    const unsigned long long formed = s->core->formed;
    if (gp_session_check_step(s, function, t, h)) return -1;
    if (gp_step(s->core, t + h, h)) return gp_session_fail(s, function, s->core->message.text);
    gp_clock_advance(&s->clock, t, h);
    s->core->time = t + h;
    if (s->log && s->core->formed != formed)
        say(s, 0, "logEvents", function, "The system was discretised for a new step size or new parameters.");
    return 0;
}

int gp_session_derivative(GpSession *s, const char *function, int adjoint, const unsigned int *unknown,
                          size_t unknowns, const unsigned int *known, size_t knowns, const double *seed,
                          size_t seeds, double *result, size_t results) {
    if (check_results(s, function)) return -1;
    if ((unknowns && !unknown) || (knowns && !known) || (seeds && !seed) || (results && !result))
        return gp_session_fail(s, function, "The references, seeds or results are missing.");
    return passed(s, function,
                  adjoint ? gp_adjoint(s->core, unknown, unknowns, known, knowns, seed, seeds, result, results)
                          : gp_directional(s->core, unknown, unknowns, known, knowns, seed, seeds, result, results));
}
