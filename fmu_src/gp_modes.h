#ifndef GP_MODES_H
#define GP_MODES_H
/* The modal form of the coupled system as exported (with its start parameters): x' = A x + B u falls apart into N
   pairs of scalar equations, which are integrated exactly at the cost of a few products each.

   A pair has two coordinates (a, b):
       GP_OSCILLATING  x = Re((a + i b) X),  (a + i b)' = p (a + i b),      X = [w f; p f], f the complex mode
       GP_DECAYING     x = a X1 + b X2,      a' = p1 a,  b' = p2 b          likewise real
       GP_DRIFTING     x = a [w f; 0] + b [0; f],  a' = b,  b' = 0          a rigid motion that nothing resists
   The left vectors follow from the symmetry of mass, damping and stiffness: for the mode f with the pole p,
       y = [(p f + (X + P^T C P) f) / w ; f],   and y^T [w f; p f] = 2 p f^T f + f^T (X + P^T C P) f  (`norm`). */
#include "gp_model.h"
#include "gp_system.h"

typedef struct {
    double *force;   /* (M, 2N) what a unit of each load adds to a', b': first all a, then all b */
    double *observe; /* (outputs + 2 rows, 2N) outputs, joint forces and receiver velocities of z; 0 for powers */
    double *through; /* (outputs + 2 rows, M) the same, of the loads */
} GpModes;

/* x (2N) = T z and z = T^-1 x; z: first all a, then all b. `work` holds 3 N + rows doubles. */
void gp_modes_to_states(const GpModel *m, const double *z, double *x);
void gp_modes_from_states(const GpModel *m, const GpSystem *s, const double *x, double *z, double *work);

/* Fills in everything from the exported modes and the system formed with the start parameters; x, z, u and work
   are workspace of 2N, 2N, M and 3 N + rows doubles. */
void gp_modes_form(GpModes *modes, const GpModel *m, const GpSystem *s, GpMotion *motion, double *x, double *z,
                   double *u, double *work);

/* The discretisation for the step h: the four coefficients of every pair less the identity, to `pairs` (4 N:
   a of a, b of a, a of b, b of b), and what the inputs add to z, to `columns` (see GpDiscrete). */
void gp_modes_discretise(const GpModes *modes, const GpModel *m, double h, double *pairs, double *columns);

#endif
