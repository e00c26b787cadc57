#include "gp_frequency.h"

#include <string.h>

#include "gp_linalg.h"

static const double TWO_PI = 6.283185307179586476925286766559;

static int finite_complex(GpComplex z) { return gp_finite(z.re) && gp_finite(z.im); }

/* Entry i, k of Z = K / (i w) + C inside a joint. */
static GpComplex impedance(const double *K, const double *C, size_t at, double omega) {
    GpComplex z;
    z.re = C[at];
    z.im = -K[at] / omega;
    return z;
}

/* W = P diag(h) P^T, symmetric. */
static void interface_mobility(const GpModel *m, const double *P, const GpComplex *h, GpComplex *W) {
    const size_t N = m->modes, n = m->rows;
    for (size_t i = 0; i < n; i++)
        for (size_t k = i; k < n; k++) {
            const double *a = P + i * N, *b = P + k * N;
            GpComplex sum = {0, 0};
            for (size_t r = 0; r < N; r++) {
                const double ab = a[r] * b[r];
                sum.re += ab * h[r].re;
                sum.im += ab * h[r].im;
            }
            W[i * n + k] = W[k * n + i] = sum;
        }
}

/* T = I + Z W and g = Z v0 */
static void interface_equation(const GpModel *m, const double *K, const double *C, double omega,
                               const GpComplex *W, const GpComplex *v0, GpComplex *T, GpComplex *g) {
    const size_t n = m->rows;
    memset(T, 0, n * n * sizeof *T);
    memset(g, 0, n * sizeof *g);
    for (size_t j = 0; j < m->joints; j++) {
        const GpJoint *joint = m->joint + j;
        for (size_t i = 0; i < joint->size; i++) {
            const size_t row = joint->first + i;
            for (size_t k = 0; k < joint->size; k++) {
                const GpComplex z = impedance(K, C, joint->block + i * joint->size + k, omega);
                const GpComplex p = gp_cmul(z, v0[joint->first + k]);
                g[row].re += p.re;
                g[row].im += p.im;
                for (size_t c = 0; c < n; c++) {
                    const GpComplex w = gp_cmul(z, W[(joint->first + k) * n + c]);
                    T[row * n + c].re += w.re;
                    T[row * n + c].im += w.im;
                }
            }
            T[row * n + row].re += 1;
        }
    }
}

/* 1/2 Re(conj(v) g) */
static double mean_power(GpComplex v, GpComplex g) { return 0.5 * (v.re * g.re + v.im * g.im); }

static void power_ratios(GpResponse *p, const GpModel *m, double input) {
    memset(p->alpha_part, 0, sizeof p->alpha_part);
    for (size_t j = 0; j < m->joints; j++) {
        p->alpha[j] = 0;
        for (size_t i = 0; i < m->joint[j].size; i++) {
            const size_t at = m->joint[j].first + i;
            const GpComplex v = gp_cdot(m->receiver + at * m->modes, p->v, m->modes);
            const double ratio = input > 0 ? mean_power(v, p->g[at]) / input : 0;
            p->alpha[j] += ratio;
            if (m->joint[j].path) p->alpha_part[m->rotation[at] ? 2 : 1] += ratio;
        }
        if (m->joint[j].path) p->alpha_part[0] += p->alpha[j];
    }
}

int gp_respond(GpResponse *p, const GpSystem *s, const GpModel *m, const double *K, const double *C,
               double frequency) {
    const size_t N = m->modes, n = m->rows;
    const double w = TWO_PI * frequency;
    const double *column = m->column + m->excitation * N, *mesh = m->mesh + m->excitation * N;
    const double push = m->is_error[m->excitation] ? w * w : 1; /* f = push * column */
    GpComplex *W = p->work, *T = W + n * n, *v0 = T + n * n;
    GpComplex power = {0, 0};
    double check = 0, held = 0;
    p->omega = w;
    for (size_t r = 0; r < N; r++) {
        GpComplex numerator, denominator;
        numerator.re = 0;
        numerator.im = w;
        denominator.re = m->eigenvalues[r] - w * w;
        denominator.im = w * s->X[r];
        if (denominator.re == 0 && denominator.im == 0) return -1;
        p->h[r] = gp_cdiv(numerator, denominator);
        p->v[r].re = p->h[r].re * (push * column[r]); /* uncoupled, still without the rigid part of d */
        p->v[r].im = p->h[r].im * (push * column[r]);
    }
    for (size_t i = 0; i < n; i++) {
        v0[i] = gp_cdot(s->P + i * N, p->v, N);
        v0[i].im += w * gp_dot(s->P + i * N, mesh, N); /* `mesh` is zero for a force */
    }
    interface_mobility(m, s->P, p->h, W);
    interface_equation(m, K, C, w, W, v0, T, p->g);
    if (gp_csolve(T, p->g, n)) return -1;
    for (size_t r = 0; r < N; r++) {
        GpComplex f = {0, 0};
        f.re = push * column[r];
        for (size_t i = 0; i < n; i++) {
            f.re -= s->P[i * N + r] * p->g[i].re;
            f.im -= s->P[i * N + r] * p->g[i].im;
        }
        p->v[r] = gp_cmul(p->h[r], f);
        power.re += column[r] * p->v[r].re;
        p->v[r].im += w * mesh[r];
        if (!finite_complex(p->v[r])) return -1;
    }
    for (size_t i = 0; i < n; i++) {
        if (!finite_complex(p->g[i])) return -1;
        /* what a transmission error does against joints that resist its rigid spin: 1/2 Re(conj(i w P d) g) */
        held += gp_dot(s->P + i * N, mesh, N) * p->g[i].im;
    }
    power_ratios(p, m, 0.5 * (push * power.re + w * held));
    for (size_t j = 0; j < m->joints; j++) check += p->alpha[j];
    return gp_finite(check) ? 0 : -1;
}

GpComplex gp_transfer(const GpResponse *p, const GpModel *m, size_t output) {
    const GpOutput *o = m->output + output;
    GpComplex v, i_omega = {0, 0};
    if (o->quantity == GP_FORCE) return p->g[m->joint[o->joint].first + o->dof];
    v = gp_cdot(m->output_rows + output * m->modes, p->v, m->modes);
    i_omega.im = p->omega;
    if (o->quantity == GP_DISPLACEMENT) return gp_cdiv(v, i_omega);
    if (o->quantity == GP_ACCELERATION) return gp_cmul(i_omega, v);
    return v;
}
