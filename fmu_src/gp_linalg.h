#ifndef GP_LINALG_H
#define GP_LINALG_H
/* Real dense linear algebra on row-major arrays. Fixed order of operations: the same doubles on every platform. */
#include <stddef.h>
#include <stdint.h>

#include "gp_exact.h"

/* sum a_i b_i */
double gp_dot(const double *a, const double *b, size_t n);

/* y += alpha x */
void gp_axpy(double *y, double alpha, const double *x, size_t n);

/* C = A B (+ C if `add`): A is rows x inner with leading dimension lda, and so on. C overlaps neither A nor B. */
void gp_multiply(double *C, size_t ldc, const double *A, size_t lda, const double *B, size_t ldb, size_t rows,
                 size_t inner, size_t columns, int add);

/* Solves A X = B in place by LU with partial pivoting; A (n x n, lda) and B (n x columns, ldb) are overwritten.
   Returns 0, or -1 where A is singular. */
int gp_solve(double *A, size_t lda, double *B, size_t ldb, size_t n, size_t columns);

/* Whether the symmetric n x n matrix A is positive semidefinite up to rounding relative to its diagonal.
   `work` holds n * n doubles and `used` n bytes. */
int gp_semidefinite(const double *A, size_t n, double *work, unsigned char *used);

int gp_all_finite(const double *values, size_t n);

/* The difference is NaN where the value is not finite. NOLINTNEXTLINE(misc-redundant-expression) */
static inline int gp_finite(double value) { return value - value == 0.0; }
static inline double gp_magnitude(double value) { return value < 0 ? -value : value; }

#endif
