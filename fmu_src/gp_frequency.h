#ifndef GP_FREQUENCY_H
#define GP_FREQUENCY_H
/* The frequency response to a unit amplitude of one load, by mobility synthesis (Rook & Singh 1996, Eq. 3).

       h_r = i w / (L_r - w^2 + i w X_r),   W = P diag(h) P^T,   Z = K / (i w) + C,   I + Z W,
       g = (I + Z W)^-1 Z v0,   q' = h (f - P^T g),   v = q' + i w d e */
#include "gp_complex.h"
#include "gp_model.h"
#include "gp_system.h"

typedef struct {
    GpComplex *h;      /* (N) modal mobilities */
    GpComplex *v;      /* (N) physical modal velocities */
    GpComplex *g;      /* (rows) joint forces on the receivers */
    GpComplex *work;   /* (rows + 2 rows^2) workspace: W, I + Z W, v0 */
    double *alpha;     /* (joints) power into each receiver / input power */
    double alpha_part[3]; /* over the paths: total, forces, moments */
    double input;      /* input power, W */
    double omega;      /* w, rad/s */
    size_t load;       /* which one acts */
    int resting;       /* whether the frequency is 0 */
} GpResponse;

/* 0, or -1 where the response is singular (an undamped resonance exactly at this frequency). At 0 Hz, and where w^2
   underflows, there is none: velocities and powers are 0. */
int gp_respond(GpResponse *p, const GpSystem *s, const GpModel *m, const double *K, const double *C,
               double frequency, size_t load);

/* Transfer from the load to one output (not a power). */
GpComplex gp_transfer(const GpResponse *p, const GpModel *m, size_t output);

/* How the response changes along a direction of frequency, joint matrices and modal damping. */
typedef struct {
    GpComplex *v;         /* (N) change of v */
    GpComplex *g;         /* (rows) change of g */
    double *alpha;        /* (joints) */
    double alpha_part[3];
    double input;
    double omega;         /* rad/s */
} GpResponseTangent;

/* From the present response; `X` (N), dK and dC (blocks) are the directions. Overwrites p->work only. */
int gp_respond_tangent(GpResponseTangent *t, GpResponse *p, const GpSystem *s, const GpModel *m, const double *K,
                       const double *C, const double *X, const double *dK, const double *dC, double frequency);

GpComplex gp_transfer_tangent(const GpResponseTangent *t, const GpResponse *p, const GpModel *m, size_t output);

#endif
