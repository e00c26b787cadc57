#ifndef GP_SYSTEM_H
#define GP_SYSTEM_H
/* The coupled system for one set of joint matrices and damping ratios, in the time domain.

   State x = [w q ; s], with s = q' - sum X d_k e_k so that no derivative of a transmission error is needed:
       q' = s + sum X d_k e_k
       s' = -L q - X s + sum (L m_k - X X m_k) e_k + sum b_k F_k - P^T g,   g = K P q + C P q' */
#include "gp_expm.h"
#include "gp_model.h"

typedef struct {
    double *X;       /* (N) modal damping 2 zeta sqrt(L), rad/s */
    double *KP;      /* (rows, N) K P */
    double *CP;      /* (rows, N) C P */
    double *P;       /* (rows, N) source - receiver */
    double *Xd;      /* (M, N) X d of each transmission error, else 0 */
    double *push;    /* (M, N) what a load adds to s' directly */
} GpSystem;

typedef struct {
    double *q;        /* (N) modal displacements */
    double *v;        /* (N) q' */
    double *a;        /* (N) s' */
    double *g;        /* (rows) joint forces on the receivers */
    const double *x, *u; /* (order), (M) what it was formed from: all that a given system needs */
} GpMotion;

/* X of mode r for these damping ratios (groups), rad/s. */
double gp_modal_damping(const GpModel *m, const double *zeta, size_t r);

/* Forms everything that depends on zeta (groups) and on the packed K and C (blocks). */
void gp_system_form(GpSystem *s, const GpModel *m, const double *zeta, const double *K, const double *C);

/* result (rows, N) = blockdiag(packed) P */
void gp_system_joints(const GpModel *m, const double *packed, const double *P, double *result);

/* Writes [A | B] to the top left of a matrix of zeros with `width` columns. */
void gp_system_matrices(const GpSystem *s, const GpModel *m, double *M, size_t width);

/* The motion that belongs to the state x (order) and the inputs u (M), which it refers to. */
void gp_system_motion(const GpSystem *s, const GpModel *m, const double *x, const double *u, GpMotion *motion);

/* x' (order) from the motion, and one entry of it. */
void gp_system_derivative(const GpModel *m, const GpMotion *motion, double *derivative);
double gp_system_rate(const GpModel *m, const GpMotion *motion, size_t i);

/* The value of one output. */
double gp_system_output(const GpModel *m, const GpMotion *motion, size_t output);

#endif
