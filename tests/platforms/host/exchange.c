/* Model exchange needs an integrator. */
#include <stdlib.h>

#include "host.h"

/* dx = f(time, x) */
static int evaluate(const Interface *fmi, void *c, double time, const double *x, double *dx, size_t n) {
    int status = fmi->set_time(c, time);
    if (!status) status = fmi->set_states(c, x, n);
    return status ? status : fmi->derivatives(c, dx, n);
}

/* One step from x; `work` holds the four slopes and the point at which the next is taken, each of n. */
static int runge_kutta(const Interface *fmi, void *c, double time, double h, double *x, double *work, size_t n) {
    static const double at[4] = {0, 0.5, 0.5, 1};
    double *slope[4], *point = work + 4 * n;
    for (int k = 0; k < 4; k++) {
        int status;
        slope[k] = work + (size_t)k * n;
        for (size_t i = 0; i < n; i++) point[i] = k ? x[i] + at[k] * h * slope[k - 1][i] : x[i];
        status = evaluate(fmi, c, time + at[k] * h, point, slope[k], n);
        if (status) return status;
    }
    for (size_t i = 0; i < n; i++) x[i] += h / 6 * (slope[0][i] + 2 * slope[1][i] + 2 * slope[2][i] + slope[3][i]);
    return OK;
}

int integrate(const Interface *fmi, void *c, double time, double size, size_t steps, size_t states) {
    double *x = script_memory(6 * states, sizeof *x);
    int status = fmi->states(c, x, states);
    for (size_t k = 1; k <= steps && !status; k++) {
        status = runge_kutta(fmi, c, time + (double)(k - 1) * size, size, x, x + states, states);
        if (!status) status = fmi->set_time(c, time + (double)k * size);
        if (!status) status = fmi->set_states(c, x, states);
        if (!status) status = fmi->step_completed(c);
    }
    free(x);
    return status;
}
