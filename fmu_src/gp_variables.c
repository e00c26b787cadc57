/* Setting and getting the variables of an instance (declared in gp_instance.h). */
#include <string.h>

#include "gp_instance.h"
#include "gp_linalg.h"

static int refuse(GpInstance *p, unsigned int reference, const char *why) {
    gp_text_clear(&p->message);
    gp_text_add(&p->message, "The variable with value reference ");
    gp_text_count(&p->message, reference);
    gp_text_add(&p->message, why);
    return -1;
}

static int is_input(const GpVariable *v) { return v->kind == GP_INPUT || v->kind == GP_FREQUENCY; }

static int check_set(GpInstance *p, unsigned int reference, double value) {
    const GpVariable *v = p->model.variable + reference;
    if (reference >= p->model.variables) return refuse(p, reference, " does not exist.");
    if (!gp_finite(value)) return refuse(p, reference, " must be set to a finite number.");
    switch (v->kind) {
    case GP_INPUT: return 0;
    case GP_FREQUENCY: return value > 0 ? 0 : refuse(p, reference, " is a frequency and must be positive.");
    case GP_STIFFNESS:
    case GP_DAMPING:
        if (v->b == v->c && value < 0)
            return refuse(p, reference, " is on the diagonal of a stiffness or damping matrix and must not be negative.");
        return 0;
    case GP_MODAL_DAMPING:
        return value >= 0 && value < 1 ? 0 : refuse(p, reference, " is a damping ratio and must be at least 0 and less than 1.");
    default: return refuse(p, reference, " is an output and cannot be set.");
    }
}

static void set_entry(GpInstance *p, const GpVariable *v, double *matrix, double value) {
    const GpJoint *joint = p->model.joint + v->a;
    double *block = matrix + joint->block;
    if (block[v->b * joint->size + v->c] == value) return; /* importers may set all parameters at every step */
    block[v->b * joint->size + v->c] = block[v->c * joint->size + v->b] = value;
    p->changed[v->a] = 1;
}

static void apply_set(GpInstance *p, const GpVariable *v, double value) {
    switch (v->kind) {
    case GP_INPUT:
        p->input[v->a] = value;
        p->slope[v->a] = 0;
        p->motion_ready = 0;
        break;
    case GP_FREQUENCY:
        if (p->frequency != value) p->response_ready = 0;
        p->frequency = value;
        p->frequency_slope = 0;
        break;
    case GP_STIFFNESS: set_entry(p, v, p->K, value); break;
    case GP_DAMPING: set_entry(p, v, p->C, value); break;
    default:
        if (p->zeta[v->a] != value) p->system_ready = 0;
        p->zeta[v->a] = value;
    }
}

int gp_set(GpInstance *p, const unsigned int *reference, size_t count, const double *value) {
    for (size_t i = 0; i < count; i++)
        if (check_set(p, reference[i], value[i])) return -1;
    for (size_t i = 0; i < count; i++) apply_set(p, p->model.variable + reference[i], value[i]);
    return 0;
}

int gp_set_slope(GpInstance *p, const unsigned int *reference, size_t count, const int *order,
                 const double *value) {
    for (size_t i = 0; i < count; i++) {
        if (reference[i] >= p->model.variables) return refuse(p, reference[i], " does not exist.");
        if (!is_input(p->model.variable + reference[i]))
            return refuse(p, reference[i], " is not an input, so that it has no input derivative.");
        if (order[i] != 1) return refuse(p, reference[i], " takes an input derivative of order 1 only.");
        if (!gp_finite(value[i])) return refuse(p, reference[i], " must be given a finite input derivative.");
    }
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v = p->model.variable + reference[i];
        if (v->kind == GP_INPUT)
            p->slope[v->a] = value[i];
        else
            p->frequency_slope = value[i];
    }
    return 0;
}

static int is_response(const GpVariable *v) { return v->kind >= GP_ALPHA; }

static double current_value(const GpInstance *p, const GpVariable *v) {
    const GpModel *m = &p->model;
    switch (v->kind) {
    case GP_INPUT: return p->input[v->a];
    case GP_FREQUENCY: return p->frequency;
    case GP_STIFFNESS: return p->K[m->joint[v->a].block + v->b * m->joint[v->a].size + v->c];
    case GP_DAMPING: return p->C[m->joint[v->a].block + v->b * m->joint[v->a].size + v->c];
    case GP_MODAL_DAMPING: return p->zeta[v->a];
    case GP_OUTPUT: return gp_system_output(m, &p->motion, v->a);
    case GP_ALPHA: return p->response.alpha_part[v->a];
    case GP_JOINT_ALPHA: return p->response.alpha[v->a];
    case GP_FRF_REAL: return gp_transfer(&p->response, m, v->a).re;
    default: return gp_transfer(&p->response, m, v->a).im;
    }
}

/* Brings up to date what the variable is computed from. */
static int prepare(GpInstance *p, const GpVariable *v) {
    if (v->kind == GP_OUTPUT && !p->motion_ready) {
        gp_system_motion(&p->system, &p->model, p->x, p->input, &p->motion);
        p->motion_ready = 1;
    }
    if (is_response(v) && !p->response_ready) {
        if (gp_respond(&p->response, &p->system, &p->model, p->K, p->C, p->frequency)) {
            gp_text_add(&p->message, "The frequency response is singular at ");
            gp_text_real(&p->message, p->frequency);
            gp_text_add(&p->message, " Hz (an undamped resonance); add damping or change the frequency.");
            return -1;
        }
        p->response_ready = 1;
    }
    return 0;
}

int gp_get(GpInstance *p, const unsigned int *reference, size_t count, double *value) {
    int outputs = 0;
    gp_text_clear(&p->message);
    for (size_t i = 0; i < count; i++) {
        if (reference[i] >= p->model.variables) return refuse(p, reference[i], " does not exist.");
        outputs |= p->model.variable[reference[i]].kind >= GP_OUTPUT;
    }
    if (outputs && gp_use_parameters(p)) return -1;
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v = p->model.variable + reference[i];
        if (prepare(p, v)) return -1;
        value[i] = current_value(p, v);
        if (!gp_finite(value[i])) return refuse(p, reference[i], " overflows; check the inputs and their units.");
    }
    return 0;
}
