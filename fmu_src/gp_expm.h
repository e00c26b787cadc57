#ifndef GP_EXPM_H
#define GP_EXPM_H
#include "gp_kernels.h"

typedef struct {
    const GpKernels *kernels;
    size_t n;      /* order of the matrices, all row-major n x n */
    double *M;     /* the caller writes the matrix here; overwritten */
    double *M2;    /* workspace */
    double *M4;    /* workspace */
    double *M6;    /* workspace */
    double *T1;    /* workspace */
    double *T2;    /* workspace */
} GpExpm;

/* e^M - I by Pade-13 scaling and squaring (Higham 2005): one of the workspaces, valid until the next call, or NULL
   where the result is not finite. Subtracting the identity before squaring, not after, keeps the slow modes of
   a stiff system accurate (they are small numbers beside it). */
double *gp_expm1_matrix(GpExpm *w);

#endif
