#ifndef FMI3_SESSION_H
#define FMI3_SESSION_H
#include "fmi3Functions.h"

#include "gp_session.h"

static inline fmi3Status fmi3_status(int failed) { return failed ? fmi3Error : fmi3OK; }

#endif
