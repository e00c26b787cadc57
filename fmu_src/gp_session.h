#ifndef GP_SESSION_H
#define GP_SESSION_H
/* What both versions of FMI share: the call sequence, the clock and the log around one instance. Functions return 0, or
   -1 after a sentence was logged; a failed call changes nothing. */
#include "gp_clock.h"
#include "gp_instance.h"

typedef enum {
    GP_INSTANTIATED = 1,
    GP_INITIALISING = 2,
    GP_EVENT = 4,        /* model exchange: parameters may be set */
    GP_CONTINUOUS = 8,   /* model exchange: an integrator is at work */
    GP_STEPPING = 16,    /* co-simulation: between steps */
    GP_INTERMEDIATE = 32, /* co-simulation: within a step, in the importer's callback */
    GP_TERMINATED = 64
} GpPhase;

enum { GP_LOG_EVENTS = 1, GP_LOG_ALL = 2 }; /* categories that can be switched; errors are always logged */

typedef struct GpSession GpSession;
typedef void (*GpSay)(const GpSession *session, int is_error, const char *category, const char *sentence);

struct GpSession {
    GpInstance *core;
    GpClock clock;
    GpPhase phase;
    int exchange;         /* model exchange, else co-simulation */
    int log;              /* GP_LOG_EVENTS, GP_LOG_ALL */
    char *name;           /* of the instance, for the log */
    GpSay say;            /* the adapter's way to the importer's logger */
    void (*logger)(void); /* the importer's, of whatever type; NULL if there is none */
    void *environment;    /* the importer's */
    int step_failed;      /* whether the last step did */
    void (*intermediate)(void); /* FMI 3: called within a step; NULL if there is none */
    double step;          /* of the step under way, s; for inputs set in the intermediate phase */
    int asking;           /* in the intermediate phase: whether inputs are asked for, else results can be read */
    GpText message;       /* for sentences that are put together */
};

/* NULL with a message. `location`: the resources, as a URI or a path. */
GpSession *gp_session_create(const char *name, const char *guid, const char *location, int exchange, GpText *message);
void gp_session_free(GpSession *s, const char *function); /* not within a step */

int gp_session_fail(GpSession *s, const char *function, const char *sentence);

/* 0 where `s` is an instance in one of `phases`. */
int gp_session_allowed(GpSession *s, int phases, const char *function);

/* 0 where `s` is an instance for model exchange (1) or co-simulation (0). */
int gp_session_of_kind(GpSession *s, int exchange, const char *function);

int gp_session_start(GpSession *s, const char *function, double start, int has_stop, double stop);
int gp_session_exit_initialisation(GpSession *s, const char *function);
int gp_session_reset(GpSession *s, const char *function);
int gp_session_set_logging(GpSession *s, const char *function, int on, size_t count, const char *const *categories);

int gp_session_set(GpSession *s, const char *function, const unsigned int *reference, size_t count,
                   const double *value, size_t values);
int gp_session_get(GpSession *s, const char *function, const unsigned int *reference, size_t count, double *value,
                   size_t values);
int gp_session_slopes(GpSession *s, const char *function, const unsigned int *reference, size_t count,
                      const int *order, const double *value);

/* Elements in all of some variables, to `values`. */
int gp_session_count(GpSession *s, const char *function, const unsigned int *reference, size_t count, size_t *values);

/* A step from t to t + h; `check` only looks whether it is possible. */
int gp_session_check_step(GpSession *s, const char *function, double t, double h);
int gp_session_step(GpSession *s, const char *function, double t, double h);

int gp_session_derivative(GpSession *s, const char *function, int adjoint, const unsigned int *unknown,
                          size_t unknowns, const unsigned int *known, size_t knowns, const double *seed,
                          size_t seeds, double *result, size_t results);

/* Model exchange */
int gp_session_set_time(GpSession *s, const char *function, double time);
int gp_session_states(GpSession *s, const char *function, double *states, size_t count);
int gp_session_set_states(GpSession *s, const char *function, const double *states, size_t count);
int gp_session_derivatives(GpSession *s, const char *function, double *derivatives, size_t count);
int gp_session_nominals(GpSession *s, const char *function, double *nominals, size_t count);
int gp_session_indicators(GpSession *s, const char *function, size_t count); /* there are none */
int gp_session_update(GpSession *s, const char *function, int *states_changed); /* in event mode */
int gp_session_continue(GpSession *s, const char *function); /* to continuous-time mode */

/* State: a block of bytes that begins with its size. `keep` makes one or reuses *state. */
int gp_session_keep(GpSession *s, const char *function, void **state);
int gp_session_restore(GpSession *s, const char *function, const void *state);
int gp_session_serialised_size(GpSession *s, const char *function, const void *state, size_t *size);
int gp_session_serialise(GpSession *s, const char *function, const void *state, unsigned char *bytes, size_t size);
int gp_session_deserialise(GpSession *s, const char *function, const unsigned char *bytes, size_t size, void **state);

#endif
