/* A pendulum with an elastic stop, beside a tank: nonlinear, with an event, an input that must not be negative, and
   parameters of all types. FMI 2.0, or 3.0 with -DFMI3; -DDERIVATIVES=1 gives directional derivatives, 2 wrong ones,
   3 an error.

   th' = w
   w'  = -(g/l) sin th - c w + (u + F l cos th)/(m l^2) - [engaged] k (th - 0.5)
   h'  = q - a sqrt h
   x = l sin th,  T = m (l w^2 + g cos th) + F sin th,  P = u w,  flow = q + q^2 + h
*/
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TH, W, H };
enum { U, F, Q };
enum { M, L, C, K, A };

typedef struct {
    double x[3], u[3], p[5];
    int engaged, next, on, planets, broken;
    void *logger, *environment;
} Model;

static void tell(Model *s, const char *text);

static Model *created(void *logger, void *environment) {
    Model *s = calloc(1, sizeof *s);
    const double p[5] = {2.0, 0.5, 0.3, 40.0, 0.2};
    memcpy(s->p, p, sizeof p);
    s->x[H] = 1.0;
    s->on = s->planets = 1;
    s->logger = logger;
    s->environment = environment;
    return s;
}

static double gravity(const Model *s) { return s->on ? 9.81 * s->planets : 0.0; }

static void rates(const Model *s, double *d) {
    const double *p = s->p, th = s->x[TH], w = s->x[W];
    d[0] = w;
    d[1] = -gravity(s) / p[L] * sin(th) - p[C] * w + (s->u[U] + s->u[F] * p[L] * cos(th)) / (p[M] * p[L] * p[L]);
    d[1] -= s->engaged ? p[K] * (th - 0.5) : 0.0;
    d[2] = s->u[Q] - p[A] * sqrt(s->x[H]);
}

static void outputs(const Model *s, double *y) {
    const double *p = s->p, th = s->x[TH], w = s->x[W];
    y[0] = p[L] * sin(th) + 1e3 * s->u[Q] - 1e3 * s->u[Q]; /* no q in it but for rounding */
    y[1] = p[M] * (p[L] * w * w + gravity(s) * cos(th)) + s->u[F] * sin(th);
    y[2] = s->u[U] * w;
    y[3] = s->u[Q] + s->u[Q] * s->u[Q] + s->x[H];
}

/* The change of rates d and outputs y with the changes dx and du. */
static void tangent(const Model *s, const double *dx, const double *du, double *d, double *y) {
    const double *p = s->p, th = s->x[TH], w = s->x[W], J = p[M] * p[L] * p[L];
    d[0] = dx[W];
    d[1] = (-gravity(s) / p[L] * cos(th) - s->u[F] * p[L] * sin(th) / J - (s->engaged ? p[K] : 0.0)) * dx[TH];
    d[1] += -p[C] * dx[W] + (du[U] + du[F] * p[L] * cos(th)) / J;
    d[2] = du[Q] - 0.5 * p[A] / sqrt(s->x[H]) * dx[H];
    y[0] = p[L] * cos(th) * dx[TH];
    y[1] = (-p[M] * gravity(s) + 0.0) * sin(th) * dx[TH] + s->u[F] * cos(th) * dx[TH];
    y[1] += 2.0 * p[M] * p[L] * w * dx[W] + sin(th) * du[F];
    y[2] = s->u[U] * dx[W] + w * du[U];
    y[3] = (1.0 + 2.0 * s->u[Q]) * du[Q] + dx[H];
#if DERIVATIVES == 2
    y[0] = -y[0];
#endif
}

/* Rates of the integrator, which may go too far. */
static int rates_or_error(Model *s, double *d) {
    rates(s, d);
    if (!(fabs(s->x[W]) >= 500.0)) return 0;
    tell(s, "the bob turns too fast");
    return 3;
}

/* Event iteration: the first round finds the new discrete state, the second takes it. */
static int update(Model *s) {
    if (s->next != s->engaged) {
        s->engaged = s->next;
        return 0;
    }
    s->next = s->x[TH] > 0.5;
    return s->next != s->engaged;
}

/* An event that the root search has stopped just short of. */
static int lost(const Model *s) { return (s->x[TH] > 0.5) != s->engaged; }

static int set_input(Model *s, int i, double value) {
    if (i == Q && value < 0.0) {
        tell(s, "the inflow q must not be negative");
        return 3;
    }
    s->u[i] = value;
    return 0;
}

static int set_parameter(Model *s, int i, double value) {
    if (i == M && value <= 0.0) {
        tell(s, "the mass m must be positive");
        return 3;
    }
    s->p[i] = value;
    return 0;
}

static int set_label(Model *s, const char *text) {
    s->broken = strcmp(text, "broken") == 0;
    return 0;
}

static int ready(Model *s) {
    if (s->broken) tell(s, "the label says that it is broken");
    return s->broken ? 3 : 0;
}

#ifdef FMI3
#include "pendulum3.h"
#else
#include "pendulum2.h"
#endif
