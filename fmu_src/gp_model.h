#ifndef GP_MODEL_H
#define GP_MODEL_H
/* The modal network, or the given linear system (gp_given.h), as read from model.bin (the format is written down in gp_model.c and in fmu/binary.py).
   Read once, checked completely, never changed. All matrices are row-major. */
#include <stdint.h>
#include <stdio.h>

#include "gp_text.h"

enum { GP_NONE = 0xFFFFFFFFu >> 1 }; /* "no such index" */

/* GP_ROW: a row of given matrices C and D */
enum { GP_DISPLACEMENT, GP_VELOCITY, GP_ACCELERATION, GP_FORCE, GP_POWER, GP_ROW, GP_QUANTITIES };

/* Kinds of scalar variables, and what their index a (and b, c) refers to. */
enum {
    GP_INPUT,           /* load a */
    GP_FREQUENCY,       /* - */
    GP_SPEED,           /* shaft speed of the gear mesh source */
    GP_STIFFNESS,       /* entry b, c of joint a */
    GP_DAMPING,         /* entry b, c of joint a */
    GP_MODAL_DAMPING,   /* damping group a */
    GP_TEETH,           /* tooth count of the gear mesh source */
    GP_TONE_AMPLITUDE,  /* tone a */
    GP_TONE_PHASE,      /* tone a */
    GP_OUTPUT,          /* output a in the time domain */
    GP_ALPHA,           /* a = 0: all, 1: forces only, 2: moments only */
    GP_JOINT_ALPHA,     /* joint a */
    GP_FRF_REAL,        /* transfer from the excitation to output a */
    GP_FRF_IMAG,
    GP_ORDER_FREQUENCY, /* tone a, Hz */
    GP_ORDER_ALPHA,     /* tone a: alpha at its frequency */
    GP_ORDER_POWER,     /* tone a: steady power through all paths at its frequency, W */
    GP_PORT_FORCE,      /* joint a, degree of freedom b */
    GP_PORT_VELOCITY,   /* joint a, degree of freedom b, receiver side */
    GP_STATE,           /* state a */
    GP_DERIVATIVE,      /* derivative of state a */
    GP_ENTRY_A,         /* entry b, c of the matrices of the state equations */
    GP_ENTRY_B,
    GP_ENTRY_C,
    GP_ENTRY_D,
    GP_TIME,            /* the independent variable */
    GP_TORQUE,          /* that stiffness is scheduled on */
    GP_SCALAR_KINDS,
    /* kinds of arrays, row-major: elements of the scalar kind in brackets */
    GP_STIFFNESS_MATRIX = 64, /* joint a (GP_STIFFNESS) */
    GP_DAMPING_MATRIX,        /* joint a (GP_DAMPING) */
    GP_PORT_FORCES,           /* joint a (GP_PORT_FORCE) */
    GP_PORT_VELOCITIES,       /* joint a (GP_PORT_VELOCITY) */
    GP_STATES,                /* all (GP_STATE) */
    GP_DERIVATIVES,           /* all (GP_DERIVATIVE) */
    GP_MATRIX_A,
    GP_MATRIX_B,
    GP_MATRIX_C,
    GP_MATRIX_D,
    GP_ARRAY_KINDS
};

enum { /* kinds of mode pairs of the coupled system, see gp_modes.h */
    GP_OSCILLATING, /* two conjugate poles */
    GP_DECAYING,    /* two real poles */
    GP_DRIFTING,    /* a rigid motion that nothing resists: a double pole at 0 with one eigenvector */
    GP_PAIR_KINDS
};

typedef struct {
    uint32_t first; /* its first row in the stacked interface */
    uint32_t size;  /* d, its degrees of freedom */
    uint32_t block; /* where its d x d matrix starts in the packed matrices */
    uint32_t path;  /* 1 where it counts as a power flow path */
    uint32_t name;  /* offset of its name in `text` */
    uint32_t follows; /* what follows the torque, see gp_schedule.h */
} GpJoint;

typedef struct {
    uint32_t quantity; /* GP_DISPLACEMENT ... */
    uint32_t joint;    /* of a force or power, else GP_NONE */
    uint32_t dof;      /* of a force, else 0 */
    uint32_t zero;     /* reserved, 0 */
} GpOutput;

typedef struct {
    uint32_t kind;    /* GP_INPUT ... */
    uint32_t a, b, c; /* see the kinds */
    uint32_t name;    /* offset of its name in `text` */
    uint32_t zero;    /* reserved, 0 */
} GpVariable;

typedef struct {
    double harmonic;  /* of the tooth meshing, 1, 2, ... */
    double shift;     /* shaft orders to the side, 0 for the harmonic itself */
    double amplitude; /* m, start value */
    double phase;     /* rad, start value */
} GpTone;

typedef struct {
    double re, im;           /* GP_OSCILLATING: the pole; else two real poles, rad/s */
    double norm_re, norm_im; /* of its left vector (of each of two real poles) */
} GpPole;

typedef struct {
    unsigned char *bytes; /* the file, which all pointers below point into */
    char guid[40];        /* of the model description it belongs to */
    size_t modes;         /* N, 0 where the system is given */
    size_t groups;        /* components with a modal damping ratio */
    size_t joints;
    size_t rows;          /* n_p: degrees of freedom of all joints */
    size_t blocks;        /* sum of d^2 over the joints */
    size_t loads;         /* M */
    size_t outputs;
    size_t variables;
    size_t linear;        /* outputs that are no powers: the rows of C and D */
    size_t excitation;    /* the load that frequency outputs refer to */
    size_t tones;         /* of the gear mesh source */
    size_t source_load;   /* the transmission error that the source adds to, or GP_NONE */
    size_t points;        /* of the schedule over the torque, 0 where there is none */
    size_t pairs;         /* N where the modal form of the coupled system is known, else 0 */
    size_t order;         /* coordinates x of x' = A x + B u: 2 N, or those of a given system */
    size_t states;        /* the same, and one more for the shaft angle of a source */
    double frequency;     /* start value of the frequency input, Hz */
    double speed;         /* start value of the shaft speed, rev/min */
    double teeth;         /* start value of the tooth count */
    double start_torque;  /* start value of the torque, N m */
    const double *eigenvalues;     /* (N) L, (rad/s)^2, 0 where rigid */
    const double *scale;           /* (N) w: sqrt(L), or a fixed value where rigid, rad/s */
    const double *nominal;         /* (N) of the two states of each mode; (order) where the system is given */
    const double *zeta;            /* (groups) start values of the damping ratios */
    const double *share;           /* (groups, N) part of each ratio that a mode takes, not negative */
    const double *source;          /* (rows, N) */
    const double *receiver;        /* (rows, N) */
    const double *stiffness;       /* (blocks) start values */
    const double *damping;         /* (blocks) start values */
    const double *column;          /* (M, N) generalised force per unit of the load, or M d */
    const double *mesh;            /* (M, N) d where the load is a transmission error, else 0 */
    const double *output_rows;     /* (outputs, N), 0 for forces and powers */
    const GpPole *pole;            /* (pairs) */
    const double *shape;           /* (pairs, 2, N) modal displacements: real and imaginary part, or of two real poles */
    const GpTone *tone;            /* (tones) */
    const double *torque;          /* (points) N m, increasing */
    const double *stiffness_at;    /* (points, blocks) at each torque, 0 where a joint does not follow */
    const double *damping_at;      /* (points, blocks) likewise */
    const double *A, *B, *C, *D;   /* of a given system: (order, order), (order, M), (outputs, order), (outputs, M) */
    const double *unit;            /* (order + M) of its states and inputs in balanced equations */
    const uint32_t *pair_kind;     /* (pairs) GP_OSCILLATING ... */
    const uint32_t *is_error;      /* (M) 1 where the load is a transmission error */
    const uint32_t *rotation;      /* (rows) 1 where the degree of freedom is a rotation */
    const GpJoint *joint;          /* (joints) */
    const GpOutput *output;        /* (outputs) */
    const GpVariable *variable;    /* (variables), in order of the value reference */
    const char *text;              /* zero-terminated names */
} GpModel;

/* Reads and checks model.bin. 0, or -1 with a message; the model then owns nothing. */
int gp_model_read(GpModel *model, FILE *stream, GpText *message);
void gp_model_free(GpModel *model);
/* Elements of a variable: 1 for a scalar. */
size_t gp_variable_size(const GpModel *model, const GpVariable *variable);

/* Element i of a variable, as a scalar one. */
GpVariable gp_variable_element(const GpModel *model, const GpVariable *variable, size_t i);

const char *gp_variable_name(const GpModel *model, size_t reference);
const char *gp_joint_name(const GpModel *model, size_t joint);

#endif
