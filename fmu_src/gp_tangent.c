#include "gp_tangent.h"

#include <string.h>

#include "gp_given.h"
#include "gp_linalg.h"

static void clear(double *values, size_t count) {
    if (count) memset(values, 0, count * sizeof *values);
}

void gp_tangent_clear(GpTangent *t, const GpModel *m) {
    clear(t->states, m->states);
    clear(t->input, m->loads);
    clear(t->K, m->blocks);
    clear(t->C, m->blocks);
    clear(t->zeta, m->groups);
    clear(t->amplitude, m->tones);
    clear(t->phase, m->tones);
    t->frequency = t->speed = t->teeth = 0;
    t->of_parameters = 0;
}

void gp_tangent_system(GpTangent *t, const GpModel *m, const GpSystem *s) {
    const size_t N = m->modes;
    gp_system_joints(m, t->K, s->P, t->system.KP);
    gp_system_joints(m, t->C, s->P, t->system.CP);
    for (size_t r = 0; r < N; r++) {
        const double X = s->X[r], dX = gp_modal_damping(m, t->zeta, r);
        t->system.X[r] = dX;
        for (size_t k = 0; k < m->loads; k++) {
            t->system.Xd[k * N + r] = dX * m->mesh[k * N + r];
            t->system.push[k * N + r] = m->is_error[k] ? -2 * X * dX * m->column[k * N + r] : 0;
        }
    }
}

void gp_tangent_motion(GpTangent *t, const GpModel *m, const GpSystem *s, const double *x, const double *u,
                       const GpMotion *motion) {
    const size_t N = m->modes;
    gp_system_motion(s, m, t->states, t->total, &t->motion);
    if (!t->of_parameters) return;
    for (size_t r = 0; r < N; r++) t->motion.a[r] -= t->system.X[r] * x[N + r];
    for (size_t k = 0; k < m->loads; k++) {
        if (u[k] == 0) continue;
        gp_axpy(t->motion.a, u[k], t->system.push + k * N, N);
        if (m->is_error[k]) gp_axpy(t->motion.v, u[k], t->system.Xd + k * N, N);
    }
    for (size_t i = 0; i < m->rows; i++) { /* g' = K' P q + C' P v + C P (X' d e); the rest is in already */
        double change = gp_dot(t->system.KP + i * N, motion->q, N) + gp_dot(t->system.CP + i * N, motion->v, N);
        for (size_t k = 0; k < m->loads; k++)
            if (m->is_error[k] && u[k] != 0) change += u[k] * gp_dot(s->CP + i * N, t->system.Xd + k * N, N);
        t->motion.g[i] += change;
        gp_axpy(t->motion.a, -change, s->P + i * N, N);
    }
}

double gp_tangent_output(const GpTangent *t, const GpModel *m, const GpMotion *motion, size_t output) {
    const GpOutput *o = m->output + output;
    double power = 0;
    if (o->quantity != GP_POWER) return gp_system_output(m, &t->motion, output);
    for (size_t i = 0; i < m->joint[o->joint].size; i++) {
        const size_t at = m->joint[o->joint].first + i;
        const double *row = m->receiver + at * m->modes;
        power += t->motion.g[at] * gp_dot(row, motion->v, m->modes) + motion->g[at] * gp_dot(row, t->motion.v, m->modes);
    }
    return power;
}

/* What all entries are made of: `joints` gives K P and C P, `X` the damping. */
static double entry_of_A(const GpModel *m, const GpSystem *s, const double *KP, const double *CP, const double *X,
                         size_t r, size_t c) { /* r counts the lower half, without -L */
    const size_t N = m->modes, mode = c < N ? c : c - N;
    const double *force = c < N ? KP : CP;
    double sum = 0;
    for (size_t i = 0; i < m->rows; i++) sum -= s->P[i * N + r] * force[i * N + mode];
    if (c < N) return sum / m->scale[mode];
    return r == mode ? sum - X[r] : sum;
}

/* C P X d of interface row i, or its change. */
static double dragged(const GpModel *m, const GpSystem *s, const GpTangent *t, size_t i, size_t k) {
    const size_t N = m->modes;
    const double *CP = s->CP + i * N, *Xd = s->Xd + k * N;
    if (!m->is_error[k]) return 0;
    if (!t) return gp_dot(CP, Xd, N);
    return gp_dot(t->system.CP + i * N, Xd, N) + gp_dot(CP, t->system.Xd + k * N, N);
}

static double entry_of_B(const GpModel *m, const GpSystem *s, const GpTangent *t, size_t r, size_t k) {
    const GpSystem *of = t ? &t->system : s;
    double sum = of->push[k * m->modes + r];
    for (size_t i = 0; i < m->rows; i++) {
        const double p = s->P[i * m->modes + r];
        if (p != 0) sum -= p * dragged(m, s, t, i, k);
    }
    return sum;
}

/* The output that is row `row` of C and D. */
static size_t linear_output(const GpModel *m, size_t row) {
    size_t i = 0;
    for (;; i++) {
        if (m->output[i].quantity == GP_POWER) continue;
        if (row-- == 0) return i;
    }
}

static double entry(const GpModel *m, const GpSystem *s, const GpTangent *t, uint32_t kind, size_t row,
                    size_t column) {
    const size_t N = m->modes, mode = column < N ? column : column - N;
    const GpSystem *of = t ? &t->system : s;
    const int of_states = kind == GP_ENTRY_A || kind == GP_ENTRY_C;
    const GpOutput *o;
    const double *weights;
    size_t output, g;
    double sum = 0;
    if (gp_is_given(m)) return t ? 0 : gp_given_entry(m, kind, row, column); /* nothing changes given matrices */
    if (kind == GP_ENTRY_A || kind == GP_ENTRY_B) {
        if (row < N && of_states) return !t && column == N + row ? m->scale[row] : 0;
        if (row < N) return m->scale[row] * of->Xd[column * N + row];
        if (!of_states) return entry_of_B(m, s, t, row - N, column);
        sum = entry_of_A(m, s, of->KP, of->CP, of->X, row - N, column);
        return !t && column == row - N ? sum - m->eigenvalues[mode] / m->scale[mode] : sum;
    }
    output = linear_output(m, row);
    o = m->output + output;
    weights = m->output_rows + output * N;
    switch (o->quantity) {
    case GP_FORCE:
        g = m->joint[o->joint].first + o->dof;
        if (!of_states) return dragged(m, s, t, g, column);
        return column < N ? of->KP[g * N + mode] / m->scale[mode] : of->CP[g * N + mode];
    case GP_DISPLACEMENT: return !t && of_states && column < N ? weights[mode] / m->scale[mode] : 0;
    case GP_VELOCITY:
        if (of_states) return !t && column >= N ? weights[mode] : 0;
        return gp_dot(weights, of->Xd + column * N, N);
    default:
        for (size_t r = 0; r < N; r++)
            if (weights[r] != 0)
                sum += weights[r] * entry(m, s, t, of_states ? GP_ENTRY_A : GP_ENTRY_B, N + r, column);
        return sum;
    }
}

double gp_system_entry(const GpModel *m, const GpSystem *s, uint32_t kind, size_t row, size_t column) {
    return entry(m, s, NULL, kind, row, column);
}

double gp_tangent_entry(const GpTangent *t, const GpModel *m, const GpSystem *s, uint32_t kind, size_t row,
                        size_t column) {
    return entry(m, s, t, kind, row, column);
}
