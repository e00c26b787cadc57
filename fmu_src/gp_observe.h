#ifndef GP_OBSERVE_H
#define GP_OBSERVE_H
/* Outputs over time: rows of `modes.observe` in the modal form, each computed once in an epoch, or from the motion. */
#include "gp_instance.h"

/* Computes the outputs among some variables ahead, four rows at a time. */
void gp_observe(GpInstance *p, const unsigned int *reference, size_t count);

/* The value of an output; of one degree of freedom of a joint's port. */
double gp_observed_output(GpInstance *p, size_t output);
double gp_observed_port(GpInstance *p, const GpVariable *v);

#endif
