#include "gp_propagator.h"

#include <string.h>

#include "gp_given.h"
#include "gp_linalg.h"
#include "gp_waves.h"

static const double LARGEST = 1e16; /* of |A h|: beyond it the results keep no more than three digits, then none */

size_t gp_propagator_order(const GpModel *m) {
    return m->order + 2 * m->loads + (m->source_load == GP_NONE ? 0 : GP_LEGENDRE);
}

/* h b P(-1)^T and E of P'(s) = P(s) E, where P_k(2 s - 1)' = 2 sum over j = k - 1, k - 3 ... of (2 j + 1) P_j */
static void add_legendre(double *M, size_t order, const GpModel *m) {
    const size_t n = m->order, first = n + 2 * m->loads;
    for (size_t k = 0; k < GP_LEGENDRE; k++) {
        for (size_t i = 0; i < n; i++)
            M[i * order + first + k] = k % 2 ? -M[i * order + n + m->source_load] : M[i * order + n + m->source_load];
        for (size_t j = k % 2 ? 0 : 1; j < k; j += 2) M[(first + j) * order + first + k] = 2 * (2 * (double)j + 1);
    }
}

/* The largest sum of a column of A h: the exponential loses its logarithm in digits (to base 10). */
static double size_of(const double *M, size_t n, size_t order, double h) {
    double largest = 0;
    for (size_t j = 0; j < n; j++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++) sum += gp_magnitude(M[i * order + j]);
        if (!(sum <= largest)) largest = sum; /* keeps a NaN */
    }
    return largest * h;
}

int gp_discretise_physical(GpDiscrete *d, GpExpm *w, GpRigid *rigid, const GpModel *m, const GpSystem *s) {
    const size_t n = m->order, order = w->n;
    double *F;
    memset(w->M, 0, order * order * sizeof *w->M);
    gp_system_matrices(s, m, w->M, order);
    if (gp_is_given(m)) gp_given_balance(m, w->M, order);
    if (!(size_of(w->M, n, order, d->h) <= LARGEST)) return -1;
    gp_rigid_find(rigid, m, s, w->M, order);
    gp_rigid_remove(rigid, m, w->M, order);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n + m->loads; j++) w->M[i * order + j] *= d->h;
    for (size_t k = 0; k < m->loads; k++) w->M[(n + k) * order + n + m->loads + k] = 1;
    if (m->source_load != GP_NONE) add_legendre(w->M, order, m);
    F = gp_expm1_matrix(w);
    if (!F) return -1;
    gp_rigid_remove(rigid, m, F, order);
    if (gp_is_given(m)) gp_given_unbalance(m, F, order);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) d->transition[j * n + i] = F[i * order + j];
        for (size_t j = n; j < order; j++) d->columns[(j - n) * n + i] = F[i * order + j];
    }
    gp_rigid_add(rigid, m, d->h, d->transition, d->columns);
    d->ready = 1;
    return 0;
}

int gp_discretise_modal(GpDiscrete *d, const GpModel *m, const GpModes *modes) {
    const size_t used = (gp_propagator_order(m) - 2 * m->modes) * 2 * m->modes;
    gp_modes_discretise(modes, m, d->h, d->transition, d->columns);
    d->ready = gp_all_finite(d->columns, used) && gp_all_finite(d->transition, 4 * m->modes);
    return d->ready ? 0 : -1;
}

void gp_transition(const GpDiscrete *d, const GpKernels *kernels, int modal, const double *now, double *next,
                   size_t states) {
    if (modal) {
        kernels->pairs(d->transition, now, next, states / 2);
        return;
    }
    memset(next, 0, states * sizeof *next); /* what changes, then what was: small changes keep their digits */
    kernels->add_columns(next, d->transition, now, states, states);
    for (size_t i = 0; i < states; i++) next[i] += now[i];
}
