#include "gp_given.h"

#include <string.h>

#include "gp_linalg.h"

int gp_is_given(const GpModel *m) { return m->modes == 0; }

const char *gp_given_check(const GpModel *m) {
    if (!gp_is_given(m)) return NULL;
    for (size_t i = 0; i < m->order; i++)
        if (!(m->nominal[i] > 0)) return "the nominal value of a state is not positive.";
    for (size_t i = 0; i < m->order + m->loads; i++)
        if (!(m->unit[i] > 0)) return "the unit of a state or input is not positive.";
    return NULL;
}

void gp_given_matrices(const GpModel *m, double *M, size_t width) {
    const size_t n = m->order, loads = m->loads;
    for (size_t i = 0; i < n; i++) {
        memcpy(M + i * width, m->A + i * n, n * sizeof *M);
        if (loads) memcpy(M + i * width + n, m->B + i * loads, loads * sizeof *M);
    }
}

void gp_given_balance(const GpModel *m, double *M, size_t width) {
    for (size_t i = 0; i < m->order; i++)
        for (size_t j = 0; j < m->order + m->loads; j++) M[i * width + j] *= m->unit[j] / m->unit[i];
}

/* Behind the states come the inputs twice: what they do when held, and when they grow. */
void gp_given_unbalance(const GpModel *m, double *F, size_t width) {
    const size_t n = m->order;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n + 2 * m->loads; j++)
            F[i * width + j] *= m->unit[i] / m->unit[j < n + m->loads ? j : j - m->loads];
}

/* A row of [A B] or [C D] times the states and inputs. */
static double product(const double *of_states, const double *of_inputs, const GpModel *m, const GpMotion *motion) {
    return gp_dot(of_states, motion->x, m->order) + gp_dot(of_inputs, motion->u, m->loads);
}

double gp_given_rate(const GpModel *m, const GpMotion *motion, size_t i) {
    return product(m->A + i * m->order, m->B + i * m->loads, m, motion);
}

double gp_given_output(const GpModel *m, const GpMotion *motion, size_t i) {
    return product(m->C + i * m->order, m->D + i * m->loads, m, motion);
}

double gp_given_entry(const GpModel *m, uint32_t kind, size_t row, size_t column) {
    switch (kind) {
    case GP_ENTRY_A: return m->A[row * m->order + column];
    case GP_ENTRY_B: return m->B[row * m->loads + column];
    case GP_ENTRY_C: return m->C[row * m->order + column];
    default: return m->D[row * m->loads + column];
    }
}
