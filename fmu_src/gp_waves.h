#ifndef GP_WAVES_H
#define GP_WAVES_H
/* Exponentials, sines and Legendre integrals. Written out, because the libraries of different platforms round
   differently and this runtime gives the same doubles on all of them. */
#include "gp_complex.h"

enum { GP_LEGENDRE = 12 }; /* Legendre polynomials that a signal within a step is made of */

/* e^z - 1, accurate also where it is small. */
GpComplex gp_expm1(GpComplex z);

/* cos(2 pi x) and sin(2 pi x) */
GpComplex gp_turn(double x);

/* W_k = integral of e^(z (1 - s)) P_k(2 s - 1) over s = 0 ... 1, for k = 0 ... GP_LEGENDRE - 1:
   what a signal that is the Legendre polynomial P_k over a step adds to x' = (z / h) x + signal, per h.
   W_k = (-1)^k e^(z/2) i_k(z/2) with the modified spherical Bessel functions i_k (Abramowitz & Stegun 10.2). */
void gp_legendre_integrals(GpComplex z, GpComplex *W);

/* Coefficients c_k of the signal given at the Gauss points: signal(s) = sum c_k P_k(2 s - 1). */
void gp_legendre_coefficients(const double *signal, double *c);

/* The Gauss points in 0 ... 1, as many as Legendre polynomials. */
extern const double gp_gauss_points[GP_LEGENDRE];

#endif
