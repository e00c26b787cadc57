#ifndef GP_SCHEDULE_H
#define GP_SCHEDULE_H
/* Matrices of joints that follow the torque through the machine, linear between the points of a table:
       K(T) = (1 - s) K_i + s K_(i+1),   s = (T - T_i) / (T_(i+1) - T_i),   T_i <= T < T_(i+1),
   and those of the first or last point outside it. What a joint may follow with: */
#include "gp_model.h"

enum { GP_FOLLOWS_STIFFNESS = 1, GP_FOLLOWS_DAMPING = 2 };

/* The torque within the table. */
double gp_schedule_clamped(const GpModel *m, double torque);

/* Writes the matrices of the joints that follow to the packed K and C (blocks); the others stay. */
void gp_schedule_matrices(const GpModel *m, double torque, double *K, double *C);

/* Whether they hold exactly these. */
int gp_schedule_agrees(const GpModel *m, double torque, const double *K, const double *C);

/* Adds what a change of the torque does to them to dK and dC: at a point of the table the derivative of what follows. */
void gp_schedule_tangent(const GpModel *m, double torque, double change, double *dK, double *dC);

/* Whether this variable is an entry or a matrix that the torque decides. */
int gp_schedule_decides(const GpModel *m, const GpVariable *v);

#define GP_DECIDED " follows the input operation.torque, which decides it; set that input instead."

/* NULL, or what is wrong with the table of a model that is being read. */
const char *gp_schedule_check(const GpModel *m);

#endif
