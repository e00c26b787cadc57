#include "gp_linalg.h"

#include <string.h>

double gp_dot(const double *a, const double *b, size_t n) {
    double sum[8] = {0, 0, 0, 0, 0, 0, 0, 0}; /* enough for the latency of an addition to hide */
    size_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (size_t k = 0; k < 8; k++) sum[k] += a[i + k] * b[i + k];
    for (; i < n; i++) sum[0] += a[i] * b[i];
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

int gp_all_finite(const double *values, size_t n) {
    double sum[8] = {0, 0, 0, 0, 0, 0, 0, 0}; /* 0 * x is 0, or NaN where x is not finite */
    size_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (size_t k = 0; k < 8; k++) sum[k] += 0 * values[i + k];
    for (; i < n; i++) sum[0] += 0 * values[i];
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7])) == 0;
}

void gp_axpy(double *y, double alpha, const double *x, size_t n) {
    for (size_t i = 0; i < n; i++) y[i] += alpha * x[i];
}

void gp_multiply(double *C, size_t ldc, const double *A, size_t lda, const double *B, size_t ldb, size_t rows,
                 size_t inner, size_t columns, int add) {
    for (size_t i = 0; i < rows; i++) {
        double *restrict c = C + i * ldc;
        const double *a = A + i * lda;
        size_t k = 0;
        if (!add) memset(c, 0, columns * sizeof *c);
        /* Four rows of B at a time: a quarter of the traffic on c, and the inner loop vectorises. */
        for (; k + 4 <= inner; k += 4) {
            const double a0 = a[k], a1 = a[k + 1], a2 = a[k + 2], a3 = a[k + 3];
            const double *restrict b0 = B + k * ldb, *restrict b1 = b0 + ldb, *restrict b2 = b1 + ldb,
                         *restrict b3 = b2 + ldb;
            if (a0 == 0 && a1 == 0 && a2 == 0 && a3 == 0) continue;
            for (size_t j = 0; j < columns; j++) c[j] += (a0 * b0[j] + a1 * b1[j]) + (a2 * b2[j] + a3 * b3[j]);
        }
        for (; k < inner; k++) gp_axpy(c, a[k], B + k * ldb, columns);
    }
}

static void swap_rows(double *a, double *b, size_t n) {
    for (size_t i = 0; i < n; i++) {
        const double t = a[i];
        a[i] = b[i];
        b[i] = t;
    }
}

int gp_solve(double *A, size_t lda, double *B, size_t ldb, size_t n, size_t columns) {
    for (size_t k = 0; k < n; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < n; i++)
            if (gp_magnitude(A[i * lda + k]) > gp_magnitude(A[p * lda + k])) p = i;
        if (A[p * lda + k] == 0 || !gp_finite(A[p * lda + k])) return -1;
        if (p != k) {
            swap_rows(A + k * lda, A + p * lda, n);
            swap_rows(B + k * ldb, B + p * ldb, columns);
        }
        for (size_t i = k + 1; i < n; i++) {
            const double factor = -(A[i * lda + k] / A[k * lda + k]);
            if (factor == 0) continue;
            gp_axpy(A + i * lda + k + 1, factor, A + k * lda + k + 1, n - k - 1);
            gp_axpy(B + i * ldb, factor, B + k * ldb, columns);
        }
    }
    for (size_t k = n; k-- > 0;) {
        const double pivot = A[k * lda + k];
        for (size_t i = k + 1; i < n; i++) gp_axpy(B + k * ldb, -A[k * lda + i], B + i * ldb, columns);
        for (size_t j = 0; j < columns; j++) B[k * ldb + j] /= pivot;
    }
    return 0;
}

int gp_semidefinite(const double *A, size_t n, double *work, unsigned char *used) {
    /* L D L^T with the pivot that is largest relative to its own diagonal entry. What remains when no pivot is
       left above the tolerance must vanish. Squares are compared, so that no square root is needed. */
    const double tolerance = 1e-12;
    memcpy(work, A, n * n * sizeof *A);
    memset(used, 0, n);
    for (size_t i = 0; i < n; i++) {
        if (A[i * n + i] < 0) return 0;
        for (size_t k = 0; k < n && A[i * n + i] == 0; k++)
            if (A[i * n + k] != 0) return 0;
        if (A[i * n + i] == 0) used[i] = 1;
    }
    for (;;) {
        size_t p = n;
        for (size_t i = 0; i < n; i++)
            if (!used[i] && (p == n || work[i * n + i] * A[p * n + p] > work[p * n + p] * A[i * n + i])) p = i;
        if (p == n) return 1;
        if (work[p * n + p] <= tolerance * A[p * n + p]) break;
        used[p] = 1;
        for (size_t i = 0; i < n; i++) {
            const double factor = work[i * n + p] / work[p * n + p];
            for (size_t k = 0; k < n; k++)
                if (!used[i] && !used[k]) work[i * n + k] -= factor * work[p * n + k];
        }
    }
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++) {
            const double rest = used[i] || used[k] ? 0 : work[i * n + k];
            if (i == k && rest < -tolerance * A[i * n + i]) return 0;
            /* ratios first: the product of two small diagonals could underflow */
            if (rest != 0 && gp_magnitude(rest / A[i * n + i]) * gp_magnitude(rest / A[k * n + k]) >
                                 100 * tolerance * tolerance)
                return 0;
        }
    return 1;
}
