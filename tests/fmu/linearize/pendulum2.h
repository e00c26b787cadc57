/* The pendulum as FMI 2.0: references 0..2 states, 3..5 derivatives, 6..8 inputs, 9..12 outputs, 13..17 parameters. */
#include "fmi2Functions.h"

static void tell(Model *s, const char *text) {
    const fmi2CallbackFunctions *calls = s->logger;
    calls->logger(calls->componentEnvironment, "pendulum", fmi2Error, "logStatusError", text);
}
fmi2Component fmi2Instantiate(fmi2String n, fmi2Type t, fmi2String g, fmi2String r, const fmi2CallbackFunctions *f,
                              fmi2Boolean v, fmi2Boolean l) {
    return created((void *)f, NULL);
}
void fmi2FreeInstance(fmi2Component c) { free(c); }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean d, fmi2Real t, fmi2Real s, fmi2Boolean e, fmi2Real x) {
    return fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return ready(c); }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2EnterEventMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t) { return fmi2OK; }
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *e) {
    memset(e, 0, sizeof *e);
    e->newDiscreteStatesNeeded = update(c);
    return fmi2OK;
}
fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean n, fmi2Boolean *e, fmi2Boolean *t) {
    *e = lost(c);
    *t = fmi2False;
    return fmi2OK;
}
fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Real values[]) {
    Model *s = c;
    double d[3], y[4];
    rates(s, d);
    outputs(s, y);
    for (size_t i = 0; i < n; i++) {
        const fmi2ValueReference r = v[i];
        values[i] = r < 3 ? s->x[r] : r < 6 ? d[r - 3] : r < 9 ? s->u[r - 6] : r < 13 ? y[r - 9] : s->p[r - 13];
    }
    return fmi2OK;
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Real values[]) {
    Model *s = c;
    for (size_t i = 0; i < n; i++) {
        if (v[i] < 3) s->x[v[i]] = values[i];
        else if (v[i] >= 6 && v[i] < 9 && set_input(s, v[i] - 6, values[i])) return fmi2Error;
        else if (v[i] >= 13 && set_parameter(s, v[i] - 13, values[i])) return fmi2Error;
    }
    return fmi2OK;
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Boolean values[]) {
    ((Model *)c)->on = values[0];
    return fmi2OK;
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Integer values[]) {
    ((Model *)c)->planets = values[0];
    return fmi2OK;
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2String values[]) {
    return set_label(c, values[0]);
}
fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    memcpy(x, ((Model *)c)->x, n * sizeof *x);
    return fmi2OK;
}
fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    memcpy(((Model *)c)->x, x, n * sizeof *x);
    return fmi2OK;
}
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real d[], size_t n) {
    return rates_or_error(c, d);
}
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    for (size_t i = 0; i < n; i++) x[i] = 1.0;
    return fmi2OK;
}
fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) {
    z[0] = ((Model *)c)->x[TH] - 0.5;
    return fmi2OK;
}
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference z[], size_t nz,
                                        const fmi2ValueReference v[], size_t nv, const fmi2Real seed[], fmi2Real out[]) {
    double dx[3] = {0}, du[3] = {0}, d[3], y[4];
    for (size_t i = 0; i < nv; i++) *(v[i] < 3 ? &dx[v[i]] : &du[v[i] - 6]) = seed[i];
    tangent(c, dx, du, d, y);
    for (size_t i = 0; i < nz; i++) {
        if (DERIVATIVES == 3 || z[i] < 3) { /* states are no unknowns */
            tell(c, "no derivatives today");
            return fmi2Error;
        }
        out[i] = z[i] < 6 ? d[z[i] - 3] : y[z[i] - 9];
    }
    return fmi2OK;
}
