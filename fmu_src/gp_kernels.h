#ifndef GP_KERNELS_H
#define GP_KERNELS_H
/* The inner loops of a step, in the widest vectors that the processor has. All variants add in the same order, so that
   they give the same doubles. */
#include <stddef.h>

#include "gp_exact.h"

typedef struct {
    /* sum a_i b_i */
    double (*dot)(const double *a, const double *b, size_t n);
    /* four of them with the same b at once: half the traffic */
    void (*dot4)(const double *const a[4], const double *b, size_t n, double result[4]);
    /* y += alpha x */
    void (*axpy)(double *y, double alpha, const double *x, size_t n);
    /* y += A x, A (n x columns) column by column */
    void (*add_columns)(double *y, const double *A, const double *x, size_t n, size_t columns);
    /* the modal transition of N pairs, see gp_propagator.h */
    void (*pairs)(const double *coefficients, const double *now, double *next, size_t N);
    /* C = A B for square row-major matrices of order n */
    void (*multiply)(double *C, const double *A, const double *B, size_t n);
} GpKernels;

/* The kernels for this processor. */
const GpKernels *gp_kernels(void);

#endif
