/* The script's commands. Each prints one line: its name, the status that FMI returned, and the values.

   library fmi2|fmi3 PATH                 opens it; any status but 0 ends the program
   instance N                             the instance that the following lines are about; 0 at first, at most 7
   instantiate cs|me TOKEN LOCATION       3 where none was made
   start T, initialised, event, continuous, terminate, reset, free
   update                                 discrete states; and whether the states changed
   set N M REFERENCES VALUES              N references, M values
   get N M REFERENCES
   ramp N REFERENCES VALUES               slopes (FMI 2) or values at the end (FMI 3) of the next step
   step T H, time T
   integrate T H STEPS STATES             model exchange, with Runge-Kutta steps
   states N, derivatives N, nominals N, setstates N VALUES
   keep, restore, forget                  one state for all instances
   serialise, deserialise BYTES           that state, as hexadecimal digits
   directional U K S R UNKNOWNS KNOWNS SEEDS, adjoint (the same)    U, K references, S seeds, R results */
#include <stdlib.h>
#include <string.h>

#include "host.h"

enum { INSTANCES = 8 };
static const Interface *fmi;
static void *instances[INSTANCES], **current = instances, *kept;

static void report(const char *name, int status) {
    write_text(name);
    write_count((size_t)status);
}

static void library(const char *name) {
    const char *version = script_word();
    const Interface *known[] = {&fmi2_interface, &fmi3_interface};
    for (size_t i = 0; i < 2; i++)
        if (!strcmp(known[i]->name, version)) fmi = known[i];
    if (!fmi) script_fail("the script names an unknown version of FMI");
    if (library_open(script_rest())) script_fail("the library cannot be opened");
    if (fmi->load()) script_fail("the library lacks a function");
    report(name, OK);
}

static void instance(const char *name) {
    size_t k = script_count();
    if (k >= INSTANCES) script_fail("there are not so many instances");
    current = instances + k;
    report(name, OK);
}

static void instantiate(const char *name) {
    const int exchange = !strcmp(script_word(), "me");
    const char *token = script_word();
    *current = fmi->instantiate(exchange, token, script_rest());
    report(name, *current ? OK : ERROR);
}

static void release(const char *name) {
    fmi->release(*current);
    *current = NULL;
    report(name, OK);
}

static void start(const char *name) { report(name, fmi->start(*current, script_real())); }
static void initialised(const char *name) { report(name, fmi->initialised(*current)); }
static void event(const char *name) { report(name, fmi->event(*current)); }
static void continuous(const char *name) { report(name, fmi->continuous(*current)); }
static void terminate(const char *name) { report(name, fmi->terminate(*current)); }
static void reset(const char *name) { report(name, fmi->reset(*current)); }
static void set_time(const char *name) { report(name, fmi->set_time(*current, script_real())); }

static void update(const char *name) {
    int changed = 0;
    report(name, fmi->update(*current, &changed));
    write_count((size_t)changed);
}

static void step(const char *name) {
    const double time = script_real();
    report(name, fmi->step(*current, time, script_real()));
}

static void integrate_steps(const char *name) {
    const double time = script_real(), size = script_real();
    const size_t steps = script_count();
    report(name, integrate(fmi, *current, time, size, steps, script_count()));
}

static unsigned int *references(size_t count) {
    unsigned int *reference = script_memory(count, sizeof *reference);
    script_references(reference, count);
    return reference;
}

static double *reals(size_t count) {
    double *value = script_memory(count, sizeof *value);
    script_reals(value, count);
    return value;
}

static void set(const char *name) {
    const size_t count = script_count(), values = script_count();
    unsigned int *reference = references(count);
    double *value = reals(values);
    report(name, fmi->set(*current, reference, count, value, values));
    free(value);
    free(reference);
}

static void get(const char *name) {
    const size_t count = script_count(), values = script_count();
    unsigned int *reference = references(count);
    double *value = script_memory(values, sizeof *value);
    report(name, fmi->get(*current, reference, count, value, values));
    write_reals(value, values);
    free(value);
    free(reference);
}

static void ramp(const char *name) {
    const size_t count = script_count();
    unsigned int *reference = references(count);
    double *value = reals(count);
    report(name, fmi->ramp(*current, reference, count, value));
    free(value);
    free(reference);
}

static void vector(const char *name, int (*function)(void *, double *, size_t)) {
    const size_t count = script_count();
    double *value = script_memory(count, sizeof *value);
    report(name, function(*current, value, count));
    write_reals(value, count);
    free(value);
}

static void states(const char *name) { vector(name, fmi->states); }
static void derivatives(const char *name) { vector(name, fmi->derivatives); }
static void nominals(const char *name) { vector(name, fmi->nominals); }

static void set_states(const char *name) {
    const size_t count = script_count();
    double *value = reals(count);
    report(name, fmi->set_states(*current, value, count));
    free(value);
}

static void keep(const char *name) { report(name, fmi->keep(*current, &kept)); }
static void restore(const char *name) { report(name, fmi->restore(*current, kept)); }
static void forget(const char *name) { report(name, fmi->forget(*current, &kept)); }

static void serialise(const char *name) {
    size_t size = 0;
    unsigned char *byte;
    int status = fmi->serialised_size(*current, kept, &size);
    byte = script_memory(size, 1);
    if (!status) status = fmi->serialise(*current, kept, byte, size);
    report(name, status);
    write_bytes(byte, size);
    free(byte);
}

static void deserialise(const char *name) {
    size_t size;
    unsigned char *byte = script_bytes(&size);
    report(name, fmi->deserialise(*current, byte, size, &kept));
    free(byte);
}

static void derivative(const char *name) {
    const size_t unknowns = script_count(), knowns = script_count(), seeds = script_count(), results = script_count();
    unsigned int *unknown = references(unknowns), *known = references(knowns);
    double *seed = reals(seeds), *result = script_memory(results, sizeof *result);
    const int adjoint = !strcmp(name, "adjoint");
    if (adjoint && !fmi->adjoint) script_fail("this version of FMI has no adjoint derivatives");
    report(name, (adjoint ? fmi->adjoint : fmi->directional)(*current, unknown, unknowns, known, knowns, seed, seeds,
                                                             result, results));
    write_reals(result, results);
    free(result);
    free(seed);
    free(known);
    free(unknown);
}

static const struct {
    const char *name;
    void (*run)(const char *name);
} commands[] = {
    {"library", library},       {"instance", instance},
    {"instantiate", instantiate}, {"free", release},
    {"start", start},           {"initialised", initialised},
    {"event", event},           {"update", update},
    {"continuous", continuous}, {"terminate", terminate},
    {"reset", reset},           {"time", set_time},
    {"step", step},             {"integrate", integrate_steps},
    {"set", set},               {"get", get},
    {"ramp", ramp},             {"states", states},
    {"derivatives", derivatives}, {"nominals", nominals},
    {"setstates", set_states},  {"keep", keep},
    {"restore", restore},       {"forget", forget},
    {"serialise", serialise},   {"deserialise", deserialise},
    {"directional", derivative}, {"adjoint", derivative},
};

int command_run(const char *name) {
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        if (strcmp(commands[i].name, name) != 0) continue;
        if (!fmi && strcmp(name, "library") != 0) script_fail("the script must open a library first");
        commands[i].run(commands[i].name);
        write_text("\n");
        return 0;
    }
    return -1;
}

void commands_end(void) {
    for (size_t k = 0; k < INSTANCES; k++)
        if (instances[k]) fmi->release(instances[k]);
}
