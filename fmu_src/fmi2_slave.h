#ifndef FMI2_SLAVE_H
#define FMI2_SLAVE_H
/* The FMI 2.0 co-simulation adapter: the call sequence, the clock and the log around one core instance. */
#include "fmi2Functions.h"

#include "gp_clock.h"
#include "gp_instance.h"

typedef enum { INSTANTIATED = 1, INITIALISING = 2, STEPPING = 4, TERMINATED = 8 } Phase;

enum { LOG_EVENTS = 1, LOG_ALL = 2 }; /* categories that can be switched; errors are always logged */

typedef struct {
    GpInstance *core;
    GpClock clock;
    Phase phase;
    fmi2Status last_step;        /* of the last doStep */
    int log;                     /* LOG_EVENTS, LOG_ALL */
    fmi2CallbackLogger logger;   /* may be NULL */
    fmi2ComponentEnvironment environment;
    char *name;                  /* of the instance, for the log */
} Fmi2Slave;

/* Logs a sentence about an error and returns fmi2Error. */
fmi2Status fmi2_fail(Fmi2Slave *slave, const char *function, const char *sentence);

/* Hands a message to the importer's logger, which reads it as a printf format. */
void fmi2_log(fmi2CallbackLogger logger, fmi2ComponentEnvironment environment, const char *name,
              fmi2Status status, const char *category, const char *function, const char *sentence);

/* Whether `c` is an instance in one of `phases`; logs what is wrong if it is not. */
int fmi2_allowed(fmi2Component c, int phases, const char *function);

#endif
