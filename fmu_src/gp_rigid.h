#ifndef GP_RIGID_H
#define GP_RIGID_H
/* Rigid motions that nothing resists: q = c with L c = 0, K P c = 0 and C P c = 0. They follow q'' = f exactly, whatever
   the other modes do. A matrix exponential does not know: rounding splits their double pole at 0, and what begins as
   rounding grows. So they are taken out before it and put back in closed form. */
#include "gp_model.h"
#include "gp_system.h"

typedef struct {
    size_t count;    /* motions found */
    double *motion;  /* (modes without stiffness, N) the motions c in the first rows, orthogonal */
    double *square;  /* (modes without stiffness) c c */
    double *gain;    /* (modes without stiffness, M) what a load adds to the rate of the motion's coordinate: c b / c c */
    double *work;    /* (its square and twice its number) */
} GpRigid;

/* Modes without stiffness: what the arrays above are sized by. */
size_t gp_rigid_modes(const GpModel *m);

/* Finds them, for the matrix [A B] with rows of `width`. */
void gp_rigid_find(GpRigid *rigid, const GpModel *m, const GpSystem *s, const double *M, size_t width);

/* Takes them out of the rows and columns of [A B] or of its exponential: 2N rows of `width`. */
void gp_rigid_remove(const GpRigid *rigid, const GpModel *m, double *M, size_t width);

/* Adds a step h of them to a discretisation: transition (2N, 2N) by columns, and columns of the loads (see GpDiscrete). */
void gp_rigid_add(const GpRigid *rigid, const GpModel *m, double h, double *transition, double *columns);

#endif
