#ifndef GP_EXPM_H
#define GP_EXPM_H
/* Exact discretisation of x' = A x + B u for a step h with u(t) = u0 + du t / h:

       x(h) = x(0) + Phi1 x(0) + Gamma0 u0 + Gamma1 du,      [Phi1 Gamma0 Gamma1] = top rows of expm(M) - I,

           [ A h   B h   0 ]
       M = [  0     0    I ]     (Van Loan 1978), by Pade-13 scaling and squaring (Higham 2005).
           [  0     0    0 ]

   A "wide" matrix holds the top n rows of such a block matrix, row-major, n x (n + 2 m). */
#include <stddef.h>

typedef struct {
    size_t n;      /* states */
    size_t m;      /* inputs */
    size_t width;  /* n + 2 m */
    double *M;     /* wide: the caller writes [A | B | anything] here before gp_discretise */
    double *M2;    /* wide workspace */
    double *M4;    /* wide workspace */
    double *M6;    /* wide workspace */
    double *T1;    /* wide workspace */
    double *T2;    /* wide workspace */
} GpExpm;

/* Reads [A | B] from w->M and writes [Phi1 Gamma0 Gamma1] to `result`, column by column ((n + 2 m) x n).
   Returns 0, or -1 where the result is not finite. */
int gp_discretise(GpExpm *w, double h, double *result);

#endif
