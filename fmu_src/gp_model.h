#ifndef GP_MODEL_H
#define GP_MODEL_H
/* The modal network as read from model.bin (the format is written down in gp_model.c and in fmu/binary.py).
   Read once, checked completely, never changed. All matrices are row-major. */
#include <stdint.h>
#include <stdio.h>

#include "gp_text.h"

enum { GP_NONE = 0xFFFFFFFFu >> 1 }; /* "no such index" */

enum { GP_DISPLACEMENT, GP_VELOCITY, GP_ACCELERATION, GP_FORCE, GP_POWER, GP_QUANTITIES };

enum { /* kinds of variables, and what their index a (and b, c) refers to */
    GP_INPUT,         /* load a */
    GP_FREQUENCY,     /* - */
    GP_STIFFNESS,     /* entry b, c of joint a */
    GP_DAMPING,       /* entry b, c of joint a */
    GP_MODAL_DAMPING, /* damping group a */
    GP_OUTPUT,        /* output a in the time domain */
    GP_ALPHA,         /* a = 0: all, 1: forces only, 2: moments only */
    GP_JOINT_ALPHA,   /* joint a */
    GP_FRF_REAL,      /* transfer from the excitation to output a */
    GP_FRF_IMAG,
    GP_VARIABLE_KINDS
};

typedef struct {
    uint32_t first; /* its first row in the stacked interface */
    uint32_t size;  /* d, its degrees of freedom */
    uint32_t block; /* where its d x d matrix starts in the packed matrices */
    uint32_t path;  /* 1 where it counts as a power flow path */
    uint32_t name;  /* offset of its name in `text` */
    uint32_t zero;  /* reserved, 0 */
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
} GpVariable;

typedef struct {
    unsigned char *bytes; /* the file, which all pointers below point into */
    char guid[40];        /* of the model description it belongs to */
    size_t modes;         /* N */
    size_t groups;        /* components with a modal damping ratio */
    size_t joints;
    size_t rows;          /* n_p: degrees of freedom of all joints */
    size_t blocks;        /* sum of d^2 over the joints */
    size_t loads;         /* M */
    size_t outputs;
    size_t variables;
    size_t excitation;    /* the load that frequency outputs refer to */
    double frequency;     /* start value of the frequency input, Hz */
    const double *eigenvalues;     /* (N) L, (rad/s)^2, 0 where rigid */
    const double *scale;           /* (N) w: sqrt(L), or a fixed value where rigid, rad/s */
    const double *zeta;            /* (groups) start values of the damping ratios */
    const double *source;          /* (rows, N) */
    const double *receiver;        /* (rows, N) */
    const double *stiffness;       /* (blocks) start values */
    const double *damping;         /* (blocks) start values */
    const double *column;          /* (M, N) generalised force per unit of the load, or M d */
    const double *mesh;            /* (M, N) d where the load is a transmission error, else 0 */
    const double *output_rows;     /* (outputs, N), 0 for forces and powers */
    const uint32_t *group;         /* (N) damping group of each mode, or GP_NONE */
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
const char *gp_joint_name(const GpModel *model, size_t joint);

#endif
