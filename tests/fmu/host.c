/* A C host without Python: right and wrong calls through one FMU, for the sanitizers, and the time of a cycle.
   Usage: host RESOURCES GUID VARIABLES STEPS FIRST_OUTPUT; the first three variables are loads, 5 is an
   off-diagonal stiffness. Prints "cycle N us"; exit code 0 when every call returned what it should. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmi2Functions.h"

static char text[4000]; /* the last message, formatted as an importer does */

static void logger(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...) {
    va_list arguments;
    (void)e, (void)n, (void)s, (void)c;
    va_start(arguments, m);
    vsnprintf(text, sizeof text, m, arguments);
    va_end(arguments);
}

static void expect(fmi2Status wanted, fmi2Status found, int line) {
    if (wanted == found) return;
    printf("line %d: status %d instead of %d: %s\n", line, (int)found, (int)wanted, text);
    exit(1);
}
#define OK(call) expect(fmi2OK, call, __LINE__)
#define ERROR(call) expect(fmi2Error, call, __LINE__)

static fmi2Component start(const char *location, const char *guid, int logging) {
    static const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, NULL};
    fmi2Component c = fmi2Instantiate("host", fmi2CoSimulation, guid, location, &callbacks, 0, logging);
    if (!c) return NULL;
    OK(fmi2SetupExperiment(c, 0, 0, 0, 0, 0));
    OK(fmi2EnterInitializationMode(c));
    return c;
}

static void abuse(const char *location, const char *guid, const unsigned *vr, unsigned count, double *y) {
    const double sizes[6] = {1e-6, 1e-5, 1e-4, 1e-3, 3e-5, 1e-2}, large = 1e12, slopes[3] = {0, 1, 2};
    const int orders[3] = {1, 1, 1};
    fmi2Component c = start(location, guid, 1);
    double t = 0, stiffness;
    OK(fmi2GetReal(c, vr, count, y));
    OK(fmi2ExitInitializationMode(c));
    OK(fmi2GetReal(c, vr + 5, 1, &stiffness));
    for (int i = 0; i < 60; i++) {
        const double u[3] = {1e-6, i, 2};
        OK(fmi2SetReal(c, vr, 3, u));
        OK(fmi2SetRealInputDerivatives(c, vr, 3, orders, slopes));
        OK(fmi2DoStep(c, t, sizes[i % 6], fmi2True));
        t += sizes[i % 6];
        OK(fmi2GetReal(c, vr, count, y));
        OK(fmi2SetReal(c, vr + 5, 1, &large));
        ERROR(fmi2DoStep(c, t, 1e-5, fmi2True)); /* indefinite, rolled back */
        OK(fmi2GetReal(c, vr + 5, 1, y));
        if (y[0] != stiffness) exit(2);
        ERROR(fmi2GetReal(c, &count, 1, y));
        ERROR(fmi2SetReal(c, &count, 1, y));
        ERROR(fmi2DoStep(c, NAN, NAN, fmi2True));
        ERROR(fmi2SetReal(c, NULL, 1, NULL));
    }
    OK(fmi2Reset(c));
    fmi2FreeInstance(c);
}

int main(int argc, char **v) {
    unsigned count, *vr, outputs[8];
    double *y;
    int steps;
    fmi2Component c;
    clock_t begin;
    if (argc != 6) return 3;
    count = (unsigned)atoi(v[3]);
    steps = atoi(v[4]);
    vr = malloc(count * sizeof *vr);
    y = malloc(count * sizeof *y);
    for (unsigned i = 0; i < count; i++) vr[i] = i;
    for (int i = 0; i < 3; i++) abuse(v[1], v[2], vr, count, y);
    if (start("file:///nowhere/%", v[2], 0) || start("file:///nowhere/%f%s%n", v[2], 0)) return 4;
    if (start(v[1], "{other}", 0)) return 5;
    c = start(v[1], v[2], 0);
    OK(fmi2ExitInitializationMode(c));
    OK(fmi2DoStep(c, 0, 1e-5, fmi2True));
    for (unsigned i = 0; i < 8; i++) outputs[i] = (unsigned)atoi(v[5]) + i;
    begin = clock();
    for (int i = 1; i <= steps; i++) {
        const double u[3] = {1e-6, i % 7, 2};
        OK(fmi2SetReal(c, vr, 3, u));
        OK(fmi2DoStep(c, i * 1e-5, 1e-5, fmi2True));
        OK(fmi2GetReal(c, outputs, 8, y));
    }
    printf("cycle %.3f us\n", (double)(clock() - begin) / CLOCKS_PER_SEC / steps * 1e6);
    fmi2FreeInstance(c);
    free(vr);
    free(y);
    return 0;
}
