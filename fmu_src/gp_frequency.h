#ifndef GP_FREQUENCY_H
#define GP_FREQUENCY_H
/* The frequency response to a unit amplitude of the excitation, by mobility synthesis (Rook & Singh 1996, Eq. 3).

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
    double omega;      /* w, rad/s */
} GpResponse;

/* 0, or -1 where the response is singular (an undamped resonance exactly at this frequency). */
int gp_respond(GpResponse *p, const GpSystem *s, const GpModel *m, const double *K, const double *C,
               double frequency);

/* Transfer from the excitation to one output (not a power). */
GpComplex gp_transfer(const GpResponse *p, const GpModel *m, size_t output);

#endif
