#include "gp_rigid.h"

#include <string.h>

#include "gp_linalg.h"

/* Below this, relative to what a joint resists most, it resists nothing. */
static const double NOTHING = 1e-12;

size_t gp_rigid_modes(const GpModel *m) {
    size_t count = 0;
    for (size_t r = 0; r < m->modes; r++) count += m->eigenvalues[r] == 0;
    return count;
}

/* The places of the modes without stiffness; 0 where their states are not in one unit. */
static size_t find_modes(const GpModel *m, size_t *index) {
    size_t count = 0;
    for (size_t r = 0; r < m->modes; r++)
        if (m->eigenvalues[r] == 0) index[count++] = r;
    for (size_t i = 1; i < count; i++)
        if (m->scale[index[i]] != m->scale[index[0]]) return 0;
    return count;
}

/* S += A / max diag A for A = P^T (K P) of one joint, over the rigid modes: all joints count alike. */
static void add_joint(double *S, size_t n, const size_t *index, const GpModel *m, const double *P, const double *KP,
                      const GpJoint *joint) {
    const size_t N = m->modes;
    double most = 0;
    for (int adding = 0; adding < 2; adding++)
        for (size_t a = 0; a < n; a++)
            for (size_t b = 0; b < n; b++) {
                double sum = 0;
                if (!adding && a != b) continue;
                for (size_t i = joint->first; i < joint->first + joint->size; i++)
                    sum += P[i * N + index[a]] * KP[i * N + index[b]];
                if (!adding && sum > most) most = sum;
                if (adding && most > 0) S[a * n + b] += sum / most;
            }
}

static void swap_doubles(double *a, double *b) {
    const double kept = *a;
    *a = *b;
    *b = kept;
}

/* S = L D L^T with pivots from the diagonal, the multipliers below it; returns the rank. */
static size_t factor(double *S, size_t n, size_t *index) {
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k, kept;
        for (size_t i = k; i < n; i++)
            if (S[i * n + i] > S[pivot * n + pivot]) pivot = i;
        if (!(S[pivot * n + pivot] > NOTHING)) return k;
        kept = index[k], index[k] = index[pivot], index[pivot] = kept;
        for (size_t i = 0; i < n; i++) swap_doubles(S + k * n + i, S + pivot * n + i);
        for (size_t i = 0; i < n; i++) swap_doubles(S + i * n + k, S + i * n + pivot);
        for (size_t i = k + 1; i < n; i++) {
            const double multiplier = S[i * n + k] / S[k * n + k];
            for (size_t j = k + 1; j < n; j++) S[i * n + j] -= multiplier * S[k * n + j];
            S[i * n + k] = multiplier;
        }
    }
    return n;
}

/* Makes the rows orthogonal; twice, against rounding. */
static void make_orthogonal(GpRigid *rigid, size_t N) {
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < rigid->count; i++) {
            double *row = rigid->motion + i * N;
            for (size_t k = 0; k < i; k++) {
                const double *other = rigid->motion + k * N;
                gp_axpy(row, -gp_dot(other, row, N) / rigid->square[k], other, N);
            }
            rigid->square[i] = gp_dot(row, row, N);
        }
}

void gp_rigid_find(GpRigid *rigid, const GpModel *m, const GpSystem *s, const double *M, size_t width) {
    const size_t N = m->modes;
    size_t *index = (size_t *)(void *)rigid->work;
    const size_t n = find_modes(m, index);
    double *S = rigid->work + n;
    size_t rank;
    rigid->count = 0;
    if (!n) return;
    memset(S, 0, n * n * sizeof *S);
    memset(rigid->motion, 0, n * N * sizeof *rigid->motion);
    for (size_t j = 0; j < m->joints; j++) {
        add_joint(S, n, index, m, s->P, s->KP, m->joint + j);
        add_joint(S, n, index, m, s->P, s->CP, m->joint + j);
    }
    rank = factor(S, n, index);
    for (size_t j = rank; j < n; j++) { /* L^T c = 0 with one free mode at a time */
        double *row = rigid->motion + rigid->count++ * N;
        row[index[j]] = 1;
        for (size_t i = rank; i-- > 0;) {
            double sum = S[j * n + i];
            for (size_t k = i + 1; k < rank; k++) sum += S[k * n + i] * row[index[k]];
            row[index[i]] = -sum;
        }
    }
    make_orthogonal(rigid, N);
    for (size_t i = 0; i < rigid->count; i++)
        for (size_t k = 0; k < m->loads; k++) {
            double sum = 0;
            for (size_t r = 0; r < N; r++) sum += rigid->motion[i * N + r] * M[(N + r) * width + 2 * N + k];
            rigid->gain[i * m->loads + k] = sum / rigid->square[i];
        }
}

/* Takes the motions out of N numbers, `stride` apart. */
static void remove_from(const GpRigid *rigid, size_t N, double *v, size_t stride) {
    for (size_t i = 0; i < rigid->count; i++) {
        const double *c = rigid->motion + i * N;
        double sum = 0;
        for (size_t r = 0; r < N; r++) sum += c[r] * v[r * stride];
        sum /= rigid->square[i];
        for (size_t r = 0; r < N; r++) v[r * stride] -= sum * c[r];
    }
}

void gp_rigid_remove(const GpRigid *rigid, const GpModel *m, double *M, size_t width) {
    const size_t N = m->modes;
    if (!rigid->count) return;
    for (size_t half = 0; half < 2; half++) {
        for (size_t j = 0; j < width; j++) remove_from(rigid, N, M + half * N * width + j, width);
        for (size_t i = 0; i < 2 * N; i++) remove_from(rigid, N, M + i * width + half * N, 1);
    }
}

/* What a load of this course in time adds to the coordinate and its rate, to a column. */
static void add_load(const double *c, size_t N, double displacement, double velocity, double *column) {
    gp_axpy(column, displacement, c, N);
    gp_axpy(column + N, velocity, c, N);
}

/* The gear mesh source adds nothing: a transmission error is an inner motion and has no gain. */
void gp_rigid_add(const GpRigid *rigid, const GpModel *m, double h, double *transition, double *columns) {
    const size_t N = m->modes, n = 2 * N, loads = m->loads;
    for (size_t i = 0; i < rigid->count; i++) {
        const double *c = rigid->motion + i * N;
        size_t mode = 0;
        double w;
        while (m->eigenvalues[mode] != 0) mode++;
        w = m->scale[mode];
        for (size_t r = 0; r < N; r++) gp_axpy(transition + (N + r) * n, w * h * c[r] / rigid->square[i], c, N);
        for (size_t k = 0; k < loads; k++) {
            const double b = h * rigid->gain[i * loads + k], a = w * h * b;
            add_load(c, N, a / 2, b, columns + k * n);
            add_load(c, N, a / 6, b / 2, columns + (loads + k) * n);
        }
    }
}
