#include "gp_frequency.h"

#include <string.h>

#include "gp_linalg.h"

static const double TWO_PI = 6.283185307179586476925286766559;

static const double LOWEST = 1e-100; /* rad/s: its square, times any stiffness, does not underflow */

static int finite_complex(GpComplex z) { return gp_finite(z.re) && gp_finite(z.im); }

/* Entry i, k of Z = K / (i w) + C inside a joint. */
static GpComplex impedance(const double *K, const double *C, size_t at, double omega) {
    return gp_complex(C[at], -K[at] / omega);
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

static void rest(GpResponse *p, const GpModel *m) {
    memset(p->v, 0, m->modes * sizeof *p->v);
    memset(p->g, 0, m->rows * sizeof *p->g);
    memset(p->alpha, 0, m->joints * sizeof *p->alpha);
    memset(p->alpha_part, 0, sizeof p->alpha_part);
    p->input = 0;
}

int gp_respond(GpResponse *p, const GpSystem *s, const GpModel *m, const double *K, const double *C,
               double frequency, size_t load) {
    const size_t N = m->modes, n = m->rows;
    const double w = TWO_PI * frequency;
    const double *column = m->column + load * N, *mesh = m->mesh + load * N;
    const double push = m->is_error[load] ? w * w : 1; /* f = push * column */
    GpComplex *W = p->work, *T = W + n * n, *v0 = T + n * n;
    GpComplex power = {0, 0};
    double check = 0, held = 0;
    p->omega = w;
    p->load = load;
    p->resting = w < LOWEST;
    if (p->resting) {
        p->omega = 1; /* transfers divide by it */
        rest(p, m);
        return 0;
    }
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
    p->input = 0.5 * (push * power.re + w * held);
    power_ratios(p, m, p->input);
    for (size_t j = 0; j < m->joints; j++) check += p->alpha[j];
    return gp_finite(check) ? 0 : -1;
}

/* The derivative of mean_power. */
static double mean_power_tangent(GpComplex v, GpComplex g, GpComplex dv, GpComplex dg) {
    return mean_power(dv, g) + mean_power(v, dg);
}

static void power_ratios_tangent(GpResponseTangent *t, const GpResponse *p, const GpModel *m) {
    memset(t->alpha_part, 0, sizeof t->alpha_part);
    for (size_t j = 0; j < m->joints; j++) {
        t->alpha[j] = 0;
        for (size_t i = 0; i < m->joint[j].size; i++) {
            const size_t at = m->joint[j].first + i;
            const double *row = m->receiver + at * m->modes;
            const GpComplex v = gp_cdot(row, p->v, m->modes), dv = gp_cdot(row, t->v, m->modes);
            const double power = mean_power(v, p->g[at]), change = mean_power_tangent(v, p->g[at], dv, t->g[at]);
            const double ratio = p->input > 0 ? (change - power / p->input * t->input) / p->input : 0;
            t->alpha[j] += ratio;
            if (m->joint[j].path) t->alpha_part[m->rotation[at] ? 2 : 1] += ratio;
        }
        if (m->joint[j].path) t->alpha_part[0] += t->alpha[j];
    }
}

/* g = Z P v and v = h (f - P^T g) + i w d, so
       (I + Z W) g' = Z' P v + Z P (h' (f - P^T g) + h f' + i w' d),   h' (f - P^T g) = (h' / h) (v - i w d). */
int gp_respond_tangent(GpResponseTangent *t, GpResponse *p, const GpSystem *s, const GpModel *m, const double *K,
                       const double *C, const double *X, const double *dK, const double *dC, double frequency) {
    const size_t N = m->modes, n = m->rows;
    const double w = p->omega, dw = TWO_PI * frequency;
    const double *column = m->column + p->load * N, *mesh = m->mesh + p->load * N;
    const int is_error = m->is_error[p->load] != 0;
    const double push = is_error ? w * w : 1, dpush = is_error ? 2 * w * dw : 0;
    GpComplex *W = p->work, *T = W + n * n, *v0 = T + n * n;
    double power = 0, held = 0, dheld = 0, dpower = 0;
    t->omega = dw;
    if (p->resting) {
        memset(t->v, 0, N * sizeof *t->v);
        memset(t->g, 0, n * sizeof *t->g);
        memset(t->alpha, 0, m->joints * sizeof *t->alpha);
        memset(t->alpha_part, 0, sizeof t->alpha_part);
        t->input = 0;
        return 0;
    }
    for (size_t r = 0; r < N; r++) { /* for now t->v = h' (f - P^T g) + h f' + i w' d */
        const GpComplex inverse = gp_cdiv(gp_complex(0, w), p->h[r]); /* L - w^2 + i w X */
        const GpComplex change = gp_complex(-2 * w * dw, dw * s->X[r] + w * X[r]);
        const GpComplex relative = gp_csub(gp_complex(dw / w, 0), gp_cdiv(change, inverse));
        const GpComplex moved = gp_complex(p->v[r].re, p->v[r].im - w * mesh[r]);
        t->v[r] = gp_cadd(gp_cmul(relative, moved), gp_cscale(dpush * column[r], p->h[r]));
        t->v[r].im += dw * mesh[r];
    }
    for (size_t i = 0; i < n; i++) v0[i] = gp_cdot(s->P + i * N, t->v, N);
    interface_mobility(m, s->P, p->h, W);
    interface_equation(m, K, C, w, W, v0, T, t->g);
    for (size_t j = 0; j < m->joints; j++) /* Z' P v, Z' = K' / (i w) - K w' / (i w^2) + C' */
        for (size_t i = 0; i < m->joint[j].size; i++)
            for (size_t k = 0; k < m->joint[j].size; k++) {
                const size_t at = m->joint[j].block + i * m->joint[j].size + k, row = m->joint[j].first + i;
                const GpComplex z = gp_complex(dC[at], -dK[at] / w + K[at] / w * (dw / w));
                const GpComplex v = gp_cdot(s->P + (m->joint[j].first + k) * N, p->v, N);
                if (z.re != 0 || z.im != 0) t->g[row] = gp_cadd(t->g[row], gp_cmul(z, v));
            }
    if (gp_csolve(T, t->g, n)) return -1;
    for (size_t r = 0; r < N; r++) {
        GpComplex back = {0, 0};
        for (size_t i = 0; i < n; i++) back = gp_cadd(back, gp_cscale(s->P[i * N + r], t->g[i]));
        t->v[r] = gp_csub(t->v[r], gp_cmul(p->h[r], back));
        power += column[r] * p->v[r].re;
        dpower += column[r] * t->v[r].re;
        if (!finite_complex(t->v[r])) return -1;
    }
    for (size_t i = 0; i < n; i++) {
        const double spin = gp_dot(s->P + i * N, mesh, N);
        held += spin * p->g[i].im;
        dheld += spin * t->g[i].im;
    }
    t->input = 0.5 * (dpush * power + push * dpower + dw * held + w * dheld);
    power_ratios_tangent(t, p, m);
    return 0;
}

GpComplex gp_transfer_tangent(const GpResponseTangent *t, const GpResponse *p, const GpModel *m, size_t output) {
    const GpOutput *o = m->output + output;
    const GpComplex i_omega = gp_complex(0, p->omega), i_change = gp_complex(0, t->omega);
    GpComplex v, dv;
    if (o->quantity == GP_FORCE) return t->g[m->joint[o->joint].first + o->dof];
    v = gp_cdot(m->output_rows + output * m->modes, p->v, m->modes);
    dv = gp_cdot(m->output_rows + output * m->modes, t->v, m->modes);
    if (o->quantity == GP_DISPLACEMENT)
        return gp_cdiv(gp_csub(dv, gp_cscale(t->omega / p->omega, v)), i_omega);
    if (o->quantity == GP_ACCELERATION) return gp_cadd(gp_cmul(i_omega, dv), gp_cmul(i_change, v));
    return dv;
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
