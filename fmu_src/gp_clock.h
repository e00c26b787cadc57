#ifndef GP_CLOCK_H
#define GP_CLOCK_H
/* The communication points. The system is time-invariant, so that nothing is integrated over the clock: the
   importer's own points are kept, and no rounding of ours can drift away from them. */
#include "gp_text.h"

typedef struct {
    double time;     /* end of the last step, s */
    double stop;     /* s, where has_stop */
    int has_stop;    /* whether the importer gave a stop time */
} GpClock;

/* 0, or -1 with a message where the times are not finite or in the wrong order. */
int gp_clock_start(GpClock *c, double start, int has_stop, double stop, GpText *message);

/* Whether a step of h from the communication point t is possible now: 0, or -1 with a message. */
int gp_clock_check(const GpClock *c, double t, double h, GpText *message);

void gp_clock_advance(GpClock *c, double t, double h);

/* How far a step size may differ from another one only because it was computed as t1 - t0 near the time t. */
double gp_clock_jitter(double t, double h);

#endif
