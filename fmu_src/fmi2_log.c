#include "fmi2_slave.h"

/* '%' and '#' are special in an FMI 2 message, and doubled stand for themselves (FMI 2.0.4, 2.1.5). */
static void add_escaped(GpText *t, const char *s) {
    char one[3] = {0, 0, 0};
    for (; *s; s++) {
        one[0] = *s;
        one[1] = *s == '%' || *s == '#' ? *s : '\0';
        if (t->length + 3 < GP_TEXT_SIZE) gp_text_add(t, one);
    }
}

void fmi2_log(fmi2CallbackLogger logger, fmi2ComponentEnvironment environment, const char *name,
              fmi2Status status, const char *category, const char *function, const char *sentence) {
    GpText text;
    if (!logger) return;
    gp_text_clear(&text);
    gp_text_add(&text, function);
    gp_text_add(&text, ": ");
    add_escaped(&text, sentence);
    logger(environment, name, status, category, text.text);
}

fmi2Status fmi2_fail(Fmi2Slave *slave, const char *function, const char *sentence) {
    fmi2_log(slave->logger, slave->environment, slave->name, fmi2Error, "logStatusError", function, sentence);
    return fmi2Error;
}

int fmi2_allowed(fmi2Component c, int phases, const char *function) {
    Fmi2Slave *slave = c;
    if (!slave) return 0; /* nobody to tell */
    if ((int)slave->phase & phases) return 1;
    switch (slave->phase) {
    case INSTANTIATED: fmi2_fail(slave, function, "This call is not allowed before initialisation."); break;
    case INITIALISING: fmi2_fail(slave, function, "This call is not allowed in initialisation mode."); break;
    case STEPPING: fmi2_fail(slave, function, "This call is not allowed once the simulation runs."); break;
    default: fmi2_fail(slave, function, "This call is not allowed after fmi2Terminate; call fmi2Reset first.");
    }
    return 0;
}

static int same(const char *a, const char *b) {
    for (; *a && *a == *b; a++, b++) {}
    return *a == *b;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[]) {
    Fmi2Slave *slave = c;
    int log = 0;
    if (!slave) return fmi2Error;
    if (nCategories && !categories) return fmi2_fail(slave, "fmi2SetDebugLogging", "The categories are missing.");
    for (size_t i = 0; i < nCategories; i++) {
        const char *category = categories[i] ? categories[i] : "";
        if (same(category, "logEvents"))
            log |= LOG_EVENTS;
        else if (same(category, "logAll"))
            log |= LOG_ALL;
        else if (!same(category, "logStatusError"))
            return fmi2_fail(slave, "fmi2SetDebugLogging",
                             "Only the categories logStatusError, logEvents and logAll exist.");
    }
    slave->log = !loggingOn ? 0 : nCategories ? log : LOG_ALL;
    return fmi2OK;
}
