#include "gp_system.h"

#include "gp_given.h"
#include "gp_linalg.h"

void gp_system_joints(const GpModel *m, const double *packed, const double *P, double *result) {
    for (size_t j = 0; j < m->joints; j++) {
        const GpJoint *joint = m->joint + j;
        const size_t at = joint->first * m->modes;
        gp_multiply(result + at, m->modes, packed + joint->block, joint->size, P + at, m->modes, joint->size,
                    joint->size, m->modes, 0);
    }
}

double gp_modal_damping(const GpModel *m, const double *zeta, size_t r) { /* `scale` is sqrt(L) wherever L is not 0 */
    double ratio = 0;
    for (size_t g = 0; g < m->groups; g++) ratio += zeta[g] * m->share[g * m->modes + r];
    return m->eigenvalues[r] == 0 ? 0 : 2 * ratio * m->scale[r];
}

void gp_system_form(GpSystem *s, const GpModel *m, const double *zeta, const double *K, const double *C) {
    const size_t N = m->modes;
    for (size_t r = 0; r < N; r++) s->X[r] = gp_modal_damping(m, zeta, r);
    for (size_t i = 0; i < m->rows * N; i++) s->P[i] = m->source[i] - m->receiver[i];
    gp_system_joints(m, K, s->P, s->KP);
    gp_system_joints(m, C, s->P, s->CP);
    for (size_t k = 0; k < m->loads; k++)
        for (size_t r = 0; r < N; r++) {
            const double X = s->X[r], column = m->column[k * N + r];
            s->Xd[k * N + r] = X * m->mesh[k * N + r];
            s->push[k * N + r] = m->is_error[k] ? (m->eigenvalues[r] - X * X) * column : column;
        }
}

void gp_system_matrices(const GpSystem *s, const GpModel *m, double *M, size_t width) {
    const size_t N = m->modes, n = 2 * N;
    if (gp_is_given(m)) {
        gp_given_matrices(m, M, width);
        return;
    }
    for (size_t r = 0; r < N; r++) {
        double *upper = M + r * width, *lower = M + (N + r) * width;
        upper[N + r] = m->scale[r];
        for (size_t k = 0; k < m->loads; k++) {
            upper[n + k] = m->scale[r] * s->Xd[k * N + r];
            lower[n + k] = s->push[k * N + r];
        }
        for (size_t i = 0; i < m->rows; i++) { /* -P^T K P and -P^T C P, and C P acting on X d e */
            const double p = s->P[i * N + r];
            if (p == 0) continue;
            gp_axpy(lower, -p, s->KP + i * N, N);
            gp_axpy(lower + N, -p, s->CP + i * N, N);
            for (size_t k = 0; k < m->loads; k++)
                if (m->is_error[k]) lower[n + k] -= p * gp_dot(s->CP + i * N, s->Xd + k * N, N);
        }
        lower[r] -= m->eigenvalues[r];
        lower[N + r] -= s->X[r];
        for (size_t c = 0; c < N; c++) lower[c] /= m->scale[c];
    }
}

void gp_system_motion(const GpSystem *s, const GpModel *m, const double *x, const double *u, GpMotion *motion) {
    const size_t N = m->modes;
    const double *rate = x + N;
    motion->x = x;
    motion->u = u;
    for (size_t r = 0; r < N; r++) {
        motion->q[r] = x[r] / m->scale[r];
        motion->v[r] = rate[r];
        motion->a[r] = -m->eigenvalues[r] * motion->q[r] - s->X[r] * rate[r];
    }
    for (size_t k = 0; k < m->loads; k++) {
        if (u[k] == 0) continue;
        if (m->is_error[k]) gp_axpy(motion->v, u[k], s->Xd + k * N, N);
        gp_axpy(motion->a, u[k], s->push + k * N, N);
    }
    for (size_t i = 0; i < m->rows; i++) {
        motion->g[i] = gp_dot(s->KP + i * N, motion->q, N) + gp_dot(s->CP + i * N, motion->v, N);
        gp_axpy(motion->a, -motion->g[i], s->P + i * N, N);
    }
}

void gp_system_derivative(const GpModel *m, const GpMotion *motion, double *derivative) {
    for (size_t i = 0; i < m->order; i++) derivative[i] = gp_system_rate(m, motion, i);
}

double gp_system_rate(const GpModel *m, const GpMotion *motion, size_t i) {
    const size_t N = m->modes;
    if (gp_is_given(m)) return gp_given_rate(m, motion, i);
    return i < N ? m->scale[i] * motion->v[i] : motion->a[i - N];
}

double gp_system_output(const GpModel *m, const GpMotion *motion, size_t output) {
    const GpOutput *o = m->output + output;
    const double *row = m->output_rows + output * m->modes;
    double power = 0;
    switch (o->quantity) {
    case GP_DISPLACEMENT: return gp_dot(row, motion->q, m->modes);
    case GP_VELOCITY: return gp_dot(row, motion->v, m->modes);
    case GP_ACCELERATION: return gp_dot(row, motion->a, m->modes);
    case GP_FORCE: return motion->g[m->joint[o->joint].first + o->dof];
    case GP_ROW: return gp_given_output(m, motion, output);
    default:
        for (size_t i = 0; i < m->joint[o->joint].size; i++) {
            const size_t at = m->joint[o->joint].first + i;
            power += motion->g[at] * gp_dot(m->receiver + at * m->modes, motion->v, m->modes);
        }
        return power;
    }
}
