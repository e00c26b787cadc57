#include "gp_modes.h"

#include <string.h>

#include "gp_linalg.h"
#include "gp_waves.h"

static const double *first_shape(const GpModel *m, size_t k) { return m->shape + 2 * k * m->modes; }
static const double *second_shape(const GpModel *m, size_t k) { return m->shape + (2 * k + 1) * m->modes; }

void gp_modes_to_states(const GpModel *m, const double *z, double *x) {
    const size_t N = m->modes;
    memset(x, 0, 2 * N * sizeof *x);
    for (size_t k = 0; k < m->pairs; k++) {
        const GpPole *p = m->pole + k;
        const double *f = first_shape(m, k), *g = second_shape(m, k), a = z[k], b = z[N + k];
        switch (m->pair_kind[k]) {
        case GP_OSCILLATING: /* Re((a + ib)(f + ig)) and Re((a + ib)(re + i im)(f + ig)) */
            gp_axpy(x, a, f, N);
            gp_axpy(x, -b, g, N);
            gp_axpy(x + N, a * p->re - b * p->im, f, N);
            gp_axpy(x + N, -(a * p->im + b * p->re), g, N);
            break;
        case GP_DECAYING:
            gp_axpy(x, a, f, N);
            gp_axpy(x, b, g, N);
            gp_axpy(x + N, a * p->re, f, N);
            gp_axpy(x + N, b * p->im, g, N);
            break;
        default:
            gp_axpy(x, a, f, N);
            gp_axpy(x + N, b, f, N);
        }
    }
    for (size_t r = 0; r < N; r++) x[r] *= m->scale[r];
}

void gp_modes_from_states(const GpModel *m, const GpSystem *s, const double *x, double *z, double *work) {
    const size_t N = m->modes;
    double *q = work, *rest = q + N, *force = rest + N; /* rest = s + (X + P^T C P) q */
    for (size_t r = 0; r < N; r++) {
        q[r] = x[r] / m->scale[r];
        rest[r] = x[N + r] + s->X[r] * q[r];
    }
    for (size_t i = 0; i < m->rows; i++) force[i] = gp_dot(s->CP + i * N, q, N);
    for (size_t i = 0; i < m->rows; i++)
        if (force[i] != 0) gp_axpy(rest, force[i], s->P + i * N, N);
    for (size_t k = 0; k < m->pairs; k++) {
        const GpPole *p = m->pole + k;
        const double *f = first_shape(m, k), *g = second_shape(m, k);
        const double fq = gp_dot(f, q, N), fr = gp_dot(f, rest, N), gq = gp_dot(g, q, N), gr = gp_dot(g, rest, N);
        GpComplex c;
        switch (m->pair_kind[k]) {
        case GP_OSCILLATING:
            c = gp_cmul(gp_complex(p->re, p->im), gp_complex(fq, gq));
            c = gp_cdiv(gp_complex(2 * (c.re + fr), 2 * (c.im + gr)), gp_complex(p->norm_re, p->norm_im));
            z[k] = c.re;
            z[N + k] = c.im;
            break;
        case GP_DECAYING:
            z[k] = (p->re * fq + fr) / p->norm_re;
            z[N + k] = (p->im * gq + gr) / p->norm_im;
            break;
        default:
            z[k] = fq / p->norm_re;
            z[N + k] = gp_dot(f, x + N, N) / p->norm_im;
        }
    }
}

/* Writes the outputs, joint forces and receiver velocities of a motion to a column of `table`. */
static void observe(const GpModel *m, const GpMotion *motion, double *table, size_t width, size_t column) {
    double *at = table + column;
    for (size_t i = 0; i < m->outputs; i++, at += width)
        *at = m->output[i].quantity == GP_POWER ? 0 : gp_system_output(m, motion, i);
    for (size_t i = 0; i < m->rows; i++, at += width) *at = motion->g[i];
    for (size_t i = 0; i < m->rows; i++, at += width) *at = gp_dot(m->receiver + i * m->modes, motion->v, m->modes);
}

void gp_modes_form(GpModes *modes, const GpModel *m, const GpSystem *s, GpMotion *motion, double *x, double *z,
                   double *u, double *work) {
    const size_t n = 2 * m->modes;
    memset(u, 0, m->loads * sizeof *u);
    memset(z, 0, n * sizeof *z);
    for (size_t j = 0; j < n; j++) {
        z[j] = 1;
        gp_modes_to_states(m, z, x);
        gp_system_motion(s, m, x, u, motion);
        observe(m, motion, modes->observe, n, j);
        z[j] = 0;
    }
    memset(x, 0, n * sizeof *x);
    for (size_t k = 0; k < m->loads; k++) {
        u[k] = 1;
        gp_system_motion(s, m, x, u, motion);
        observe(m, motion, modes->through, m->loads, k);
        gp_system_derivative(m, motion, z);
        gp_modes_from_states(m, s, z, modes->force + k * n, work);
        u[k] = 0;
    }
    memset(z, 0, n * sizeof *z);
}

/* What is the same for all loads of one pair: the poles times h, and their Legendre integrals. */
typedef struct {
    uint32_t kind;
    double h;
    GpComplex first[GP_LEGENDRE], second[GP_LEGENDRE]; /* of the pole, or of two real poles */
} Pair;

/* The transition of pair k less the identity, to `pairs`, and its integrals. */
static Pair discretise_pair(const GpModel *m, size_t k, double h, double *pairs) {
    const size_t N = m->modes;
    const GpPole *p = m->pole + k;
    Pair pair;
    GpComplex F;
    pair.kind = m->pair_kind[k];
    pair.h = h;
    pairs[k] = pairs[N + k] = pairs[2 * N + k] = pairs[3 * N + k] = 0;
    switch (pair.kind) {
    case GP_OSCILLATING:
        F = gp_expm1(gp_complex(h * p->re, h * p->im));
        gp_legendre_integrals(gp_complex(h * p->re, h * p->im), pair.first);
        pairs[k] = pairs[3 * N + k] = F.re;
        pairs[N + k] = -F.im;
        pairs[2 * N + k] = F.im;
        break;
    case GP_DECAYING:
        gp_legendre_integrals(gp_complex(h * p->re, 0), pair.first);
        gp_legendre_integrals(gp_complex(h * p->im, 0), pair.second);
        pairs[k] = gp_expm1(gp_complex(h * p->re, 0)).re;
        pairs[3 * N + k] = gp_expm1(gp_complex(h * p->im, 0)).re;
        break;
    default: pairs[N + k] = h;
    }
    return pair;
}

/* What the load that adds (a, b) does when it follows the Legendre polynomial P_i over the step. */
static GpComplex integral(const Pair *pair, double a, double b, size_t i) {
    const double h = pair->h;
    const double once = i == 0, twice = i == 0 ? 0.5 : i == 1 ? -1.0 / 6 : 0; /* of P_i, and of (1 - s) P_i */
    switch (pair->kind) {
    case GP_OSCILLATING: return gp_cscale(h, gp_cmul(pair->first[i], gp_complex(a, b)));
    case GP_DECAYING: return gp_complex(h * a * pair->first[i].re, h * b * pair->second[i].re);
    default: return gp_complex(h * (a * once + h * b * twice), h * b * once);
    }
}

static void set_column(double *column, size_t N, size_t k, GpComplex value) {
    column[k] = value.re;
    column[N + k] = value.im;
}

void gp_modes_discretise(const GpModes *modes, const GpModel *m, double h, double *pairs, double *columns) {
    const size_t N = m->modes, n = 2 * N, M = m->loads;
    for (size_t k = 0; k < N; k++) {
        const Pair pair = discretise_pair(m, k, h, pairs);
        for (size_t load = 0; load < M; load++) {
            const double a = modes->force[load * n + k], b = modes->force[load * n + N + k];
            const GpComplex held = integral(&pair, a, b, 0); /* P_0 */
            const GpComplex ramp = gp_cscale(0.5, gp_cadd(held, integral(&pair, a, b, 1))); /* (P_0 + P_1) / 2 */
            set_column(columns + load * n, N, k, held);
            set_column(columns + (M + load) * n, N, k, ramp);
            if (load != m->source_load) continue;
            for (size_t i = 0; i < GP_LEGENDRE; i++)
                set_column(columns + (2 * M + i) * n, N, k, integral(&pair, a, b, i));
        }
    }
}
