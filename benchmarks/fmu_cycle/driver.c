/* One cycle of an FMI 2 co-simulation FMU in a C host (set inputs, step, get outputs), in CPU time beside

   - a dense matrix-vector product of its state dimension, column by column and row by row,
   - the cycle of a dense propagator with as many states, inputs and outputs (x = F x + G u, y = H x + J u),

   all compiled with -O3 -march=native in this file; the FMU is the compiled library as shipped.

       driver LIBRARY RESOURCES GUID STATES STEP CYCLES INPUT,... OUTPUT,... [PARAMETER]

   Prints nanoseconds as "NAME N". With a PARAMETER it is set to a new value in every repetition, and "again" is the time of the
   first step after it (a new discretisation). */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi2FunctionTypes.h"

enum { MOST = 4096, REPEATS = 9 };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void logger(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...) {
    (void)e, (void)n, (void)c;
    if (s > fmi2Warning) fprintf(stderr, "%s\n", m);
}

static void check(int good, const char *what) {
    if (good) return;
    fprintf(stderr, "%s failed\n", what);
    exit(1);
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *times) {
    qsort(times, REPEATS, sizeof *times, by_size);
    return times[REPEATS / 2];
}

static size_t list(char *text, fmi2ValueReference *references) {
    size_t count = 0;
    for (char *part = strtok(text, ","); part && count < MOST; part = strtok(NULL, ","))
        references[count++] = (fmi2ValueReference)strtoul(part, NULL, 10);
    return count;
}

/* y = A x, A column by column: four columns at a time, the fastest plain form of a mid-sized product */
static void by_columns(const double *A, const double *x, double *restrict y, size_t n) {
    memset(y, 0, n * sizeof *y);
    size_t j = 0;
    for (; j + 4 <= n; j += 4) {
        const double *a = A + j * n, *b = a + n, *c = b + n, *d = c + n;
        for (size_t i = 0; i < n; i++) y[i] += (a[i] * x[j] + b[i] * x[j + 1]) + (c[i] * x[j + 2] + d[i] * x[j + 3]);
    }
    for (; j < n; j++)
        for (size_t i = 0; i < n; i++) y[i] += A[j * n + i] * x[j];
}

/* y (+)= A x, A row by row, as one writes it first */
static void by_rows(const double *A, const double *x, double *restrict y, size_t rows, size_t columns, int add) {
    for (size_t i = 0; i < rows; i++) {
        double sum = add ? y[i] : 0;
        for (size_t j = 0; j < columns; j++) sum += A[i * columns + j] * x[j];
        y[i] = sum;
    }
}

static double *filled(size_t count) {
    double *values = malloc((count + 1) * sizeof *values);
    check(values != NULL, "malloc");
    for (size_t i = 0; i < count; i++) values[i] = 1e-3 * (double)(i % 17) / (double)(1 + i % 5);
    return values;
}

typedef struct {
    fmi2Component c;
    fmi2SetRealTYPE *set;
    fmi2GetRealTYPE *get;
    fmi2DoStepTYPE *step;
    fmi2ValueReference inputs[MOST], outputs[MOST];
    size_t n_inputs, n_outputs;
    double h, time;
} Fmu;

static double cycles(Fmu *f, long count, double *u, double *y) {
    const double start = now();
    for (long k = 0; k < count; k++) {
        u[0] = 1e-6 * (double)(k % 7);
        if (f->set(f->c, f->inputs, f->n_inputs, u) != fmi2OK) exit(2);
        if (f->step(f->c, f->time, f->h, fmi2True) != fmi2OK) exit(2);
        if (f->get(f->c, f->outputs, f->n_outputs, y) != fmi2OK) exit(2);
        f->time += f->h;
    }
    return (now() - start) / (double)count;
}

static void print_dense(size_t n, size_t inputs, size_t outputs, long count, double *u, double *y) {
    double columns[REPEATS], rows[REPEATS], plain[REPEATS], fast[REPEATS];
    double *A = filled(n * n), *G = filled(n * inputs), *H = filled(outputs * n), *J = filled(outputs * inputs);
    double *x = filled(n), *z = filled(n), sink = 0;
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        for (long k = 0; k < count; k++) by_columns(A, k % 2 ? z : x, k % 2 ? x : z, n);
        columns[r] = (now() - start) / (double)count;
        start = now();
        for (long k = 0; k < count; k++) by_rows(A, k % 2 ? z : x, k % 2 ? x : z, n, n, 0);
        rows[r] = (now() - start) / (double)count;
        for (int form = 0; form < 2; form++) {
            start = now();
            for (long k = 0; k < count; k++) {
                double *from = k % 2 ? z : x, *to = k % 2 ? x : z;
                u[0] = 1e-6 * (double)(k % 7);
                if (form) by_columns(A, from, to, n); else by_rows(A, from, to, n, n, 0);
                by_rows(G, u, to, n, inputs, 1);
                by_rows(H, to, y, outputs, n, 0);
                by_rows(J, u, y, outputs, inputs, 1);
                sink += y[0];
            }
            (form ? fast : plain)[r] = (now() - start) / (double)count;
        }
        sink += x[0] + z[0];
        for (size_t i = 0; i < n; i++) x[i] = z[i] = 1e-3; /* no overflow, no denormals */
    }
    printf("product_by_columns %.1f\nproduct_by_rows %.1f\n", median(columns), median(rows));
    printf("dense_cycle %.1f\ndense_cycle_by_rows %.1f\n", median(fast), median(plain));
    if (sink == 12345.678) puts("");
}

int main(int argc, char **argv) {
    static Fmu f;
    static double u[MOST], y[MOST];
    static const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, NULL};
    double times[REPEATS];
    check(argc >= 9, "usage: driver LIBRARY RESOURCES GUID STATES STEP CYCLES INPUTS OUTPUTS [PARAMETER]; it");
    void *library = dlopen(argv[1], RTLD_NOW);
    check(library != NULL, argv[1]);
    fmi2InstantiateTYPE *instantiate = (fmi2InstantiateTYPE *)dlsym(library, "fmi2Instantiate");
    fmi2SetupExperimentTYPE *setup = (fmi2SetupExperimentTYPE *)dlsym(library, "fmi2SetupExperiment");
    fmi2EnterInitializationModeTYPE *enter = (fmi2EnterInitializationModeTYPE *)dlsym(library, "fmi2EnterInitializationMode");
    fmi2ExitInitializationModeTYPE *leave = (fmi2ExitInitializationModeTYPE *)dlsym(library, "fmi2ExitInitializationMode");
    f.set = (fmi2SetRealTYPE *)dlsym(library, "fmi2SetReal");
    f.get = (fmi2GetRealTYPE *)dlsym(library, "fmi2GetReal");
    f.step = (fmi2DoStepTYPE *)dlsym(library, "fmi2DoStep");
    const size_t states = strtoul(argv[4], NULL, 10);
    const long count = strtol(argv[6], NULL, 10);
    f.h = strtod(argv[5], NULL);
    f.n_inputs = list(argv[7], f.inputs);
    f.n_outputs = list(argv[8], f.outputs);
    f.c = instantiate("cycle", fmi2CoSimulation, argv[3], argv[2], &callbacks, fmi2False, fmi2False);
    check(f.c != NULL, "fmi2Instantiate");
    check(setup(f.c, fmi2False, 0, 0, fmi2False, 0) == fmi2OK && enter(f.c) == fmi2OK && leave(f.c) == fmi2OK, "initialisation");
    for (size_t i = 0; i < MOST; i++) u[i] = 1e-6;
    cycles(&f, count / 10 + 1, u, y);
    for (int r = 0; r < REPEATS; r++) times[r] = cycles(&f, count, u, y);
    printf("cycle %.1f\n", median(times));
    if (argc > 9) {
        const fmi2ValueReference parameter = (fmi2ValueReference)strtoul(argv[9], NULL, 10);
        double value;
        check(f.get(f.c, &parameter, 1, &value) == fmi2OK, "getting the parameter");
        for (int r = 0; r < REPEATS; r++) {
            const double changed = value * (1 + 0.01 * (r + 1)), start = now();
            check(f.set(f.c, &parameter, 1, &changed) == fmi2OK, "setting the parameter");
            check(f.step(f.c, f.time, f.h, fmi2True) == fmi2OK, "the step after it");
            times[r] = now() - start;
            f.time += f.h;
        }
        printf("again %.1f\n", median(times));
        for (int r = 0; r < REPEATS; r++) times[r] = cycles(&f, count / 10 + 1, u, y);
        printf("cycle_after_change %.1f\n", median(times));
    }
    if (states) print_dense(states, f.n_inputs, f.n_outputs, count, u, y);
    return 0; /* what pythonfmu's FMUs do at exit is not measured here */
}
