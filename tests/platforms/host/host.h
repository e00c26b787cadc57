#ifndef HOST_H
#define HOST_H
/* A host without Python: drives the library of an FMU by a script from standard input, one call a line, and prints what
   each call returned. Numbers go in and out as the 16 hexadecimal digits of their bits, so that nothing is rounded and
   the output of two platforms can be compared as text. commands.c lists the commands. */
#include <stdarg.h>
#include <stddef.h>

enum { OK = 0, ERROR = 3 }; /* statuses, the same in both versions of FMI */

typedef void (*Function)(void);

int host_main(void); /* main.c */

/* platform.c. Paths are UTF-8 everywhere. */
int library_open(const char *path);
Function library_function(const char *name);
void format(char *text, size_t size, const char *message, va_list arguments); /* as printf does */

/* script.c: reading and writing. A word that is missing or no number ends the program with code 2. */
int script_read(void);
int script_line(void);          /* goes to the next line that is not empty; 0 at the end */
const char *script_word(void);
const char *script_rest(void);  /* of the line */
size_t script_count(void);
double script_real(void);
void script_reals(double *value, size_t count);
void script_references(unsigned int *reference, size_t count);
unsigned char *script_bytes(size_t *count); /* the rest of the line as hexadecimal digits; to be freed */
void *script_memory(size_t count, size_t size);
void script_fail(const char *what);

void write_text(const char *text);
void write_count(size_t number);
void write_reals(const double *value, size_t count);
void write_bytes(const unsigned char *byte, size_t count);

/* What the commands need of a version of FMI; fmi2.c and fmi3.c fill it in. Everything returns a status. */
typedef struct {
    const char *name; /* as in the script */
    int (*load)(void); /* looks the functions up in the open library; 0, or -1 where one is missing */
    void *(*instantiate)(int exchange, const char *token, const char *location);
    void (*release)(void *c);
    int (*start)(void *c, double time); /* into initialisation mode */
    int (*initialised)(void *c);
    int (*set)(void *c, const unsigned int *reference, size_t count, const double *value, size_t values);
    int (*get)(void *c, const unsigned int *reference, size_t count, double *value, size_t values);
    /* the course of inputs within the next step: FMI 2 wants slopes, FMI 3 the values at its end */
    int (*ramp)(void *c, const unsigned int *reference, size_t count, const double *value);
    int (*step)(void *c, double time, double size);
    int (*event)(void *c);
    int (*update)(void *c, int *values_changed); /* discrete states, until nothing changes any more */
    int (*continuous)(void *c);
    int (*step_completed)(void *c);
    int (*set_time)(void *c, double time);
    int (*set_states)(void *c, const double *x, size_t count);
    int (*states)(void *c, double *x, size_t count);
    int (*derivatives)(void *c, double *dx, size_t count);
    int (*nominals)(void *c, double *x, size_t count);
    int (*keep)(void *c, void **state);
    int (*restore)(void *c, void *state);
    int (*forget)(void *c, void **state);
    int (*serialised_size)(void *c, void *state, size_t *size);
    int (*serialise)(void *c, void *state, unsigned char *byte, size_t size);
    int (*deserialise)(void *c, const unsigned char *byte, size_t size, void **state);
    int (*directional)(void *c, const unsigned int *unknown, size_t unknowns, const unsigned int *known, size_t knowns,
                       const double *seed, size_t seeds, double *result, size_t results);
    int (*adjoint)(void *c, const unsigned int *unknown, size_t unknowns, const unsigned int *known, size_t knowns,
                   const double *seed, size_t seeds, double *result, size_t results); /* NULL in FMI 2 */
    int (*terminate)(void *c);
    int (*reset)(void *c);
} Interface;

extern const Interface fmi2_interface, fmi3_interface;

/* exchange.c: `steps` steps of the classical Runge-Kutta method, fourth order, with the inputs held. */
int integrate(const Interface *fmi, void *c, double time, double size, size_t steps, size_t states);

/* commands.c */
int command_run(const char *name); /* 0, or -1 where there is no such command */
void commands_end(void);           /* frees the instances that the script left */
#endif
