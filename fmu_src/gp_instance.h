#ifndef GP_INSTANCE_H
#define GP_INSTANCE_H
/* One running model: parameters, inputs, state, and what is cached from them. Everything is allocated once, in
   gp_instance_create. Functions that can fail return 0 or -1 and leave a sentence in `message`. */
#include "gp_frequency.h"
#include "gp_model.h"
#include "gp_system.h"
#include "gp_text.h"

enum { GP_STEP_SIZES = 4 }; /* discretisations kept at a time */

typedef struct {
    double h;                 /* step size, s; 0 where unused */
    unsigned long long used;  /* when it was used last, in steps */
    double *columns;          /* ((2N + 2M) x 2N) [Phi - I, Gamma0, Gamma1], column by column */
} GpDiscrete;

typedef struct {
    GpModel model;
    GpText message;           /* why the last call failed */
    double *memory;           /* all arrays below */
    /* parameters */
    double *K, *C;            /* (blocks) as set, perhaps halfway through a change */
    double *valid_K, *valid_C; /* (blocks) as used last; what an indefinite change falls back to */
    double *zeta;             /* (groups) */
    unsigned char *changed;   /* (joints) 1 where K or C differ from the valid ones */
    /* inputs */
    double *input, *slope;    /* (M) value at the current time, and its derivative over the coming step */
    double frequency;         /* Hz */
    double frequency_slope;   /* Hz/s */
    /* state */
    double *x, *next;         /* (2N) */
    /* caches, and whether they belong to the current parameters, inputs and state */
    int system_ready, motion_ready, response_ready;
    GpSystem system;
    GpMotion motion;
    GpResponse response;
    GpExpm expm;
    GpDiscrete discrete[GP_STEP_SIZES];
    unsigned long long steps; /* steps made, for the age of the discretisations */
    unsigned long long formed; /* discretisations made, for the log */
    double *definite_work;    /* (36) for the check of a joint's matrix */
} GpInstance;

/* NULL with a message where there is not enough memory. Takes over the model. */
GpInstance *gp_instance_create(GpModel *model, GpText *message);
void gp_instance_free(GpInstance *p);
void gp_instance_reset(GpInstance *p); /* start values, zero state, no caches */

/* Values by value reference. A failed set changes nothing at all. */
int gp_set(GpInstance *p, const unsigned int *reference, size_t count, const double *value);
int gp_get(GpInstance *p, const unsigned int *reference, size_t count, double *value);
int gp_set_slope(GpInstance *p, const unsigned int *reference, size_t count, const int *order,
                 const double *value);

/* Takes the parameters into use. Where a joint's matrix is indefinite, that joint falls back to its last valid
   matrices, the others are used, and -1 is returned; the next call succeeds. */
int gp_use_parameters(GpInstance *p);

/* Advances the state by h; `time` is the end of the step, for the rounding allowed in h. */
int gp_step(GpInstance *p, double time, double h);

#endif
