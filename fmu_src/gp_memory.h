#ifndef GP_MEMORY_H
#define GP_MEMORY_H
#include "gp_instance.h"

/* Allocates all arrays of an instance whose model is set, at once. 0, or -1 where there is not enough memory. */
int gp_memory_allocate(GpInstance *p);

#endif
