#ifndef FMI2_SESSION_H
#define FMI2_SESSION_H
#include "fmi2Functions.h"

#include "gp_session.h"

static inline fmi2Status fmi2_status(int failed) { return failed ? fmi2Error : fmi2OK; }

#endif
