/* The pendulum as FMI 3.0 with arrays: 1 state[3], 2 its derivative, 3 load[2] = u, F, 4 q, 5 out[3], 6 flow,
   13..17 parameters, 24 event indicator. */
#include "fmi3Functions.h"

static void tell(Model *s, const char *text) {
    ((fmi3LogMessageCallback)s->logger)(s->environment, fmi3Error, "logStatusError", text);
}
fmi3Instance fmi3InstantiateModelExchange(fmi3String n, fmi3String t, fmi3String r, fmi3Boolean v, fmi3Boolean l,
                                          fmi3InstanceEnvironment e, fmi3LogMessageCallback log) {
    return created((void *)log, e);
}
void fmi3FreeInstance(fmi3Instance c) { free(c); }
fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean d, fmi3Float64 t, fmi3Float64 s, fmi3Boolean e,
                                       fmi3Float64 x) {
    return ready(c);
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3Terminate(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3EnterEventMode(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean n, fmi3Boolean *e, fmi3Boolean *t) {
    *e = lost(c) != 0;
    *t = fmi3False;
    return fmi3OK;
}
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 t) { return fmi3OK; }
fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end, fmi3Boolean *nominals,
                                    fmi3Boolean *values, fmi3Boolean *timed, fmi3Float64 *next) {
    *end = *nominals = *values = *timed = fmi3False;
    *next = 0.0;
    *again = update(c) != 0;
    return fmi3OK;
}
fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference v[], size_t n, fmi3Float64 values[], size_t m) {
    Model *s = c;
    double d[3], y[4];
    rates(s, d);
    outputs(s, y);
    for (size_t i = 0; i < n; i++) {
        const double *from = v[i] == 1 ? s->x : v[i] == 2 ? d : v[i] == 3 ? s->u : v[i] == 4 ? s->u + Q : NULL;
        const double z = s->x[TH] - 0.5;
        from = from ? from : v[i] == 24 ? &z : v[i] == 5 ? y : v[i] == 6 ? y + 3 : s->p + (v[i] - 13);
        const size_t size = v[i] == 3 ? 2 : v[i] == 1 || v[i] == 2 || v[i] == 5 ? 3 : 1;
        memcpy(values, from, size * sizeof *values);
        values += size;
    }
    return fmi3OK;
}
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference v[], size_t n, const fmi3Float64 values[], size_t m) {
    Model *s = c;
    for (size_t i = 0; i < n; i++) {
        int bad = 0;
        if (v[i] == 1) {
            memcpy(s->x, values, 3 * sizeof *values);
            values += 3;
        } else if (v[i] == 3) {
            bad = set_input(s, U, values[0]) || set_input(s, F, values[1]);
            values += 2;
        } else {
            bad = v[i] == 4 ? set_input(s, Q, *values) : set_parameter(s, v[i] - 13, *values);
            values++;
        }
        if (bad) return fmi3Error;
    }
    return fmi3OK;
}
fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference v[], size_t n, const fmi3Boolean values[], size_t m) {
    ((Model *)c)->on = values[0];
    return fmi3OK;
}
fmi3Status fmi3SetInt32(fmi3Instance c, const fmi3ValueReference v[], size_t n, const fmi3Int32 values[], size_t m) {
    ((Model *)c)->planets = values[0];
    return fmi3OK;
}
fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference v[], size_t n, const fmi3String values[], size_t m) {
    return set_label(c, values[0]);
}
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    memcpy(x, ((Model *)c)->x, n * sizeof *x);
    return fmi3OK;
}
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
    memcpy(((Model *)c)->x, x, n * sizeof *x);
    return fmi3OK;
}
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 d[], size_t n) {
    return rates_or_error(c, d);
}
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    for (size_t i = 0; i < n; i++) x[i] = 1.0;
    return fmi3OK;
}
fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n) {
    z[0] = ((Model *)c)->x[TH] - 0.5;
    return fmi3OK;
}
fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference z[], size_t nz,
                                        const fmi3ValueReference v[], size_t nv, const fmi3Float64 seed[], size_t ns,
                                        fmi3Float64 out[], size_t no) {
    double dx[3] = {0}, du[3] = {0}, d[3], y[4];
    if (DERIVATIVES == 3) {
        tell(c, "no derivatives today");
        return fmi3Error;
    }
    for (size_t i = 0; i < nv; i++) {
        const size_t size = v[i] == 1 ? 3 : v[i] == 3 ? 2 : 1;
        memcpy(v[i] == 1 ? dx : v[i] == 3 ? du : du + Q, seed, size * sizeof *seed);
        seed += size;
    }
    tangent(c, dx, du, d, y);
    for (size_t i = 0; i < nz; i++) {
        const size_t size = z[i] == 6 ? 1 : 3;
        memcpy(out, z[i] == 2 ? d : z[i] == 5 ? y : y + 3, size * sizeof *out);
        out += size;
    }
    return fmi3OK;
}
