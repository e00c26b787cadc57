#ifndef GP_COMPLEX_H
#define GP_COMPLEX_H
/* Complex numbers as pairs of doubles: C99 `complex` needs runtime functions that the Windows build lacks. */
#include <stddef.h>

#include "gp_exact.h"

typedef struct {
    double re; /* real part */
    double im; /* imaginary part */
} GpComplex;

GpComplex gp_complex(double re, double im);
GpComplex gp_cadd(GpComplex a, GpComplex b);
GpComplex gp_csub(GpComplex a, GpComplex b);
GpComplex gp_cscale(double a, GpComplex z);
double gp_csize(GpComplex z); /* |re| + |im| */
GpComplex gp_cmul(GpComplex a, GpComplex b);
GpComplex gp_cdiv(GpComplex a, GpComplex b); /* Smith 1962: no overflow in between */

/* sum a_i z_i with real a */
GpComplex gp_cdot(const double *a, const GpComplex *z, size_t n);

/* Solves A x = b in place (A: n x n row-major, b: n) by LU with partial pivoting. -1 where A is singular. */
int gp_csolve(GpComplex *A, GpComplex *b, size_t n);

#endif
