#ifndef GP_INSTANCE_H
#define GP_INSTANCE_H
/* One running model: parameters, inputs, state, and what is cached from them. Everything is allocated once, in
   gp_instance_create. Functions that can fail return 0 or -1 and leave a sentence in `message`. */
#include "gp_frequency.h"
#include "gp_model.h"
#include "gp_modes.h"
#include "gp_propagator.h"
#include "gp_source.h"
#include "gp_system.h"
#include "gp_tangent.h"
#include "gp_text.h"

enum { GP_STEP_SIZES = 4 }; /* discretisations kept at a time */

typedef struct {
    GpModel model;
    const GpKernels *kernels; /* inner loops for this processor */
    GpText message;           /* why the last call failed */
    double *memory;           /* all arrays below */
    /* parameters */
    double *K, *C;            /* (blocks) as set, perhaps halfway through a change */
    double *valid_K, *valid_C; /* (blocks) as used last; what an indefinite change falls back to */
    double *zeta, *valid_zeta; /* (groups) likewise */
    unsigned char *changed;   /* (joints) 1 where K or C differ from the valid ones */
    /* inputs */
    double *input, *slope;    /* (M) value at the current time, and its derivative over the coming step */
    double frequency;         /* Hz */
    double frequency_slope;   /* Hz/s */
    double torque, torque_slope; /* N m as set, K and C of joints that follow it belong to it; N m/s */
    double used_torque;       /* N m, that the valid matrices of these joints belong to */
    GpSource source;          /* with its parameters, its speed and its angle */
    double time;              /* s, as the importer told it; only for the variable `time` */
    /* state, in the form of gp_propagator.h */
    double *now, *next, *spare; /* (order) coordinates, and two places for the next ones */
    int modal;                /* whether they are modal coordinates; else x itself */
    int jumped;               /* whether a change of damping has moved the states; cleared by who asks */
    int begun;                /* whether time has passed, so that velocities must not jump any more */
    /* caches, and whether they belong to the current parameters, inputs and state */
    int system_ready, total_ready, states_ready, motion_ready, response_ready;
    int as_exported;          /* whether all parameters have their start values */
    double *states;           /* (order) x, where `now` is modal */
    double *held, *grown;     /* (M) inputs at the beginning of a part of a step, and what they grow by */
    double *total;            /* (M) inputs with the source added */
    GpSystem system;
    GpMotion motion;
    GpModes modes;
    size_t *place;            /* (rows of `modes.observe`) the row that has the value of each */
    double *seen;             /* (rows of `modes.observe`) values of this epoch */
    unsigned long long *seen_in, epoch; /* the epoch each was computed in; every change begins a new one */
    GpResponse response;      /* at the input `frequency`, of the excitation */
    GpResponse order_response; /* at the frequency of a tone, of the source's load */
    double *order_alpha, *order_power; /* (tones) alpha, and power per squared amplitude, at that frequency */
    double *order_frequency;  /* (tones) the frequency they were computed for, Hz; 0 where unknown */
    GpTangent tangent;        /* directions and derivatives */
    GpExpm expm;
    GpRigid rigid;            /* motions that nothing resists, for the discretisation under way */
    GpDiscrete discrete[GP_STEP_SIZES];
    unsigned long long steps; /* steps made, for the age of the discretisations */
    unsigned long long formed; /* discretisations made, for the log */
    double *work;             /* (3 N + rows, at least 36) */
    double *state_work;       /* (4 blocks + 2 groups) for the check of a serialised state */
} GpInstance;

/* NULL with a message where there is not enough memory. Takes over the model. */
GpInstance *gp_instance_create(GpModel *model, GpText *message);
void gp_instance_free(GpInstance *p);
void gp_instance_reset(GpInstance *p); /* start values, zero state, no caches */

/* Values by value reference; arrays take as many values as they have elements, `values` counts all. A failed set
   changes nothing at all. */
int gp_set(GpInstance *p, const unsigned int *reference, size_t count, const double *value, size_t values);
int gp_get(GpInstance *p, const unsigned int *reference, size_t count, double *value, size_t values);
int gp_set_slope(GpInstance *p, const unsigned int *reference, size_t count, const int *order,
                 const double *value);

void gp_hold(GpInstance *p); /* ends all slopes */

/* Sets a damping ratio and keeps q' = s + sum X d_k e_k under the present inputs: a velocity cannot jump with it. This
   happens at once, not when the ratio is next used: by then the inputs may be others. */
void gp_set_damping(GpInstance *p, size_t group, double zeta);

/* Sets the torque, and K and C of the joints that follow it. */
void gp_set_torque(GpInstance *p, double torque);

/* What may be done with a variable. */
typedef enum { GP_IS_INPUT = 1, GP_IS_PARAMETER = 2, GP_IS_STATE = 4, GP_IS_RESULT = 8 } GpRole;
GpRole gp_role(const GpModel *model, const GpVariable *variable);

/* The value of a scalar variable: 0, or -1 where it cannot be computed. */
int gp_value(GpInstance *p, const GpVariable *v, double *value);

/* Directional derivatives: change of the unknowns along `seed` of the knowns; adjoint: the other way round. Arrays
   take as many values as they have elements, the counts of values are checked. */
int gp_directional(GpInstance *p, const unsigned int *unknown, size_t unknowns, const unsigned int *known,
                   size_t knowns, const double *seed, size_t seeds, double *result, size_t results);
int gp_adjoint(GpInstance *p, const unsigned int *unknown, size_t unknowns, const unsigned int *known,
               size_t knowns, const double *seed, size_t seeds, double *result, size_t results);

/* Elements of some variables in all, or -1 where one does not exist. */
int gp_count(GpInstance *p, const unsigned int *reference, size_t count, size_t *values);

/* Writes a sentence about a variable to `message`: "The variable NAME (value reference R)" and the rest. */
int gp_refuse(GpInstance *p, unsigned int reference, const char *rest);

/* Takes the parameters into use. Where a joint's matrix is indefinite, that joint falls back to its last valid
   matrices, the others are used, and -1 is returned; the next call succeeds. */
int gp_use_parameters(GpInstance *p);

/* Advances the state by h; `time` is the end of the step, for the rounding allowed in h. */
int gp_step(GpInstance *p, double time, double h);

/* The states (order, one more with a source: the shaft angle), their derivatives and their nominal values.
   0, or -1 where a number is not finite. */
int gp_get_states(GpInstance *p, double *states);
int gp_set_states(GpInstance *p, const double *states);
int gp_get_derivatives(GpInstance *p, double *derivatives);
void gp_get_nominals(const GpInstance *p, double *nominals);

/* After parameters, inputs and state were written from outside: forgets the caches. `used` says whether the parameters
   had been taken into use. */
void gp_instance_restored(GpInstance *p, int used);

/* What the caches above hold, brought up to date. */
const double *gp_states(GpInstance *p);
const double *gp_total(GpInstance *p);
const GpMotion *gp_motion(GpInstance *p);
int gp_response(GpInstance *p);
int gp_order_response(GpInstance *p, size_t tone); /* alpha and power of a tone, and `order_response` itself */
void gp_touch(GpInstance *p); /* inputs or state have changed */

#endif
