#ifndef GP_TANGENT_H
#define GP_TANGENT_H
/* Directional derivatives: a direction in states, inputs and parameters, and how the motion changes along it. */
#include "gp_frequency.h"
#include "gp_model.h"
#include "gp_system.h"

typedef struct {
    /* the direction */
    double *states;           /* (order, one more with a source) */
    double *input;            /* (M) */
    double *K, *C;            /* (blocks) */
    double *zeta;             /* (groups) */
    double *amplitude, *phase; /* (tones) */
    double frequency, speed, teeth;
    int of_parameters;        /* whether K, C or zeta is not zero */
    /* what changes along it */
    double *total;            /* (M) inputs with the source */
    GpSystem system;          /* X, K P, C P, X d and push; P itself does not change */
    GpMotion motion;
    GpResponseTangent response;
} GpTangent;

/* Sets the whole direction to zero. */
void gp_tangent_clear(GpTangent *t, const GpModel *m);

/* Fills in `system`. */
void gp_tangent_system(GpTangent *t, const GpModel *m, const GpSystem *s);

/* Fills in `motion`, from `total`, the states x, the total inputs u and their motion. */
void gp_tangent_motion(GpTangent *t, const GpModel *m, const GpSystem *s, const double *x, const double *u,
                       const GpMotion *motion);

/* The change of one output. */
double gp_tangent_output(const GpTangent *t, const GpModel *m, const GpMotion *motion, size_t output);

/* Entry of A, B, C or D (GP_ENTRY_A ...), and its change along the direction. */
double gp_system_entry(const GpModel *m, const GpSystem *s, uint32_t kind, size_t row, size_t column);
double gp_tangent_entry(const GpTangent *t, const GpModel *m, const GpSystem *s, uint32_t kind, size_t row,
                        size_t column);

#endif
