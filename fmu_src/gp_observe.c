#include "gp_observe.h"

#include "gp_linalg.h"

/* Adds what the loads do to a row of `modes.observe`, and keeps its value. */
static void keep(GpInstance *p, size_t row, double of_states) {
    const GpModel *m = &p->model;
    const double *total = gp_total(p), *through = p->modes.through + row * m->loads;
    for (size_t k = 0; k < m->loads; k++) of_states += through[k] * total[k];
    p->seen[row] = of_states;
    p->seen_in[row] = p->epoch;
}

/* Row of `modes.observe` in the modal form: an output, a joint force or a receiver velocity. */
static double observed(GpInstance *p, size_t row) {
    const size_t n = 2 * p->model.modes;
    row = p->place[row];
    if (p->seen_in[row] != p->epoch) keep(p, row, p->kernels->dot(p->modes.observe + row * n, p->now, n));
    return p->seen[row];
}

void gp_observe(GpInstance *p, const unsigned int *reference, size_t count) {
    const size_t n = 2 * p->model.modes;
    const double *a[4];
    double value[4];
    size_t row[4], found = 0;
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v = p->model.variable + reference[i];
        if (v->kind != GP_OUTPUT || p->model.output[v->a].quantity == GP_POWER) continue;
        if (p->seen_in[p->place[v->a]] == p->epoch) continue;
        row[found] = p->place[v->a];
        a[found] = p->modes.observe + row[found] * n;
        if (++found < 4) continue;
        found = 0;
        p->kernels->dot4(a, p->now, n, value);
        for (int k = 0; k < 4; k++) keep(p, row[k], value[k]);
    }
}

double gp_observed_output(GpInstance *p, size_t output) {
    const GpModel *m = &p->model;
    const GpOutput *o = m->output + output;
    double power = 0;
    if (!p->modal) return gp_system_output(m, gp_motion(p), output);
    if (o->quantity != GP_POWER) return observed(p, output);
    for (size_t i = 0; i < m->joint[o->joint].size; i++) {
        const size_t force = m->outputs + m->joint[o->joint].first + i;
        power += observed(p, force) * observed(p, force + m->rows);
    }
    return power;
}

double gp_observed_port(GpInstance *p, const GpVariable *v) {
    const GpModel *m = &p->model;
    const size_t row = m->joint[v->a].first + v->b;
    if (p->modal) return observed(p, m->outputs + row + (v->kind == GP_PORT_FORCE ? 0 : m->rows));
    if (v->kind == GP_PORT_FORCE) return gp_motion(p)->g[row];
    return gp_dot(m->receiver + row * m->modes, gp_motion(p)->v, m->modes);
}
