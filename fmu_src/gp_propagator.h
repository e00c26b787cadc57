#ifndef GP_PROPAGATOR_H
#define GP_PROPAGATOR_H
/* Exact discretisation of the coupled system for a step size, in one of two forms:
       modal      pairs of modes (gp_modes.h): the start parameters, and a basis of modes that is well conditioned
       physical   a dense propagator from the matrix exponential: anything else, given systems (gp_given.h) too

   The inputs within a step are u0 + (u1 - u0) t / h, and for the gear mesh source sum c_k P_k(2 t / h - 1):
       z(h) = z + (Phi - I) z + held u0 + ramp (u1 - u0) + sum_k legendre_k c_k

   physical: [Phi - I, held, ramp, legendre] = top rows of expm(M) - I,
           [ A h   B h   0   h b P(-1)^T ]
       M = [  0     0    I       0       ]     (Van Loan 1978); P' = P E for the row P^T of Legendre polynomials
           [  0     0    0       0       ]
           [  0     0    0       E       ] */
#include "gp_expm.h"
#include "gp_modes.h"
#include "gp_rigid.h"

typedef struct {
    double h;                 /* step size, s; 0 where unused */
    unsigned long long used;  /* when it was used last, in steps */
    int ready;                /* whether the columns belong to h, the parameters and the form */
    double *transition;       /* physical: (order, order) Phi - I, column by column; modal: (4, N) */
    double *columns;          /* (2M + GP_LEGENDRE, order) held, ramp, legendre (the last only with a source) */
} GpDiscrete;

/* Order of the matrix M. */
size_t gp_propagator_order(const GpModel *m);

/* Fills in d for its step size. 0, or -1 where the matrix A h is so large that no digits would be left. */
int gp_discretise_physical(GpDiscrete *d, GpExpm *w, GpRigid *rigid, const GpModel *m, const GpSystem *s);
int gp_discretise_modal(GpDiscrete *d, const GpModel *m, const GpModes *modes);

/* next = state after a step without inputs; then axpy of the columns adds what the inputs do. */
void gp_transition(const GpDiscrete *d, const GpKernels *kernels, int modal, const double *now, double *next,
                   size_t states);

#endif
