#ifndef GP_GIVEN_H
#define GP_GIVEN_H
/* A linear system given by its matrices in place of a modal network, such as a controller:
       x' = A x + B u,   y = C x + D u,   any number of states, none included
   It has no modes, joints, parameters or source. The model holds a unit for every state and input, a power of two: in
   these units A and B are balanced, which the matrix exponential needs and which rounds nothing. */
#include "gp_system.h"

/* Whether the model is one. */
int gp_is_given(const GpModel *m);

/* NULL, or what is wrong with the numbers or counts of a model that is being read. */
const char *gp_given_check(const GpModel *m);

/* Writes [A | B] to the top left of a matrix of zeros with `width` columns. */
void gp_given_matrices(const GpModel *m, double *M, size_t width);

/* Takes the rows and columns of these states and inputs to the balanced units, or a result of it back. */
void gp_given_balance(const GpModel *m, double *M, size_t width);
void gp_given_unbalance(const GpModel *m, double *F, size_t width);

/* Entry i of x', and output i. */
double gp_given_rate(const GpModel *m, const GpMotion *motion, size_t i);
double gp_given_output(const GpModel *m, const GpMotion *motion, size_t i);

/* Entry of A, B, C or D (GP_ENTRY_A ...). */
double gp_given_entry(const GpModel *m, uint32_t kind, size_t row, size_t column);

#endif
