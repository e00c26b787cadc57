/* Setting and getting the variables of an instance (declared in gp_instance.h). */
#include <string.h>

#include "gp_instance.h"
#include "gp_linalg.h"
#include "gp_observe.h"
#include "gp_schedule.h"

int gp_refuse(GpInstance *p, unsigned int reference, const char *rest) {
    GpText *t = &p->message;
    gp_text_clear(t);
    if (reference < p->model.variables) {
        gp_text_add(t, gp_variable_name(&p->model, reference));
        gp_text_add(t, " (value reference ");
        gp_text_count(t, reference);
        gp_text_add(t, ")");
    } else {
        gp_text_add(t, "The variable with value reference ");
        gp_text_count(t, reference);
    }
    gp_text_add(t, rest);
    return -1;
}

GpRole gp_role(const GpModel *m, const GpVariable *v) {
    static const unsigned char role[GP_ARRAY_KINDS] = {
        [GP_INPUT] = GP_IS_INPUT,
        [GP_FREQUENCY] = GP_IS_INPUT,
        [GP_SPEED] = GP_IS_INPUT,
        [GP_TORQUE] = GP_IS_INPUT,
        [GP_STIFFNESS] = GP_IS_PARAMETER,
        [GP_DAMPING] = GP_IS_PARAMETER,
        [GP_STIFFNESS_MATRIX] = GP_IS_PARAMETER,
        [GP_DAMPING_MATRIX] = GP_IS_PARAMETER,
        [GP_MODAL_DAMPING] = GP_IS_PARAMETER,
        [GP_TEETH] = GP_IS_PARAMETER,
        [GP_TONE_AMPLITUDE] = GP_IS_PARAMETER,
        [GP_TONE_PHASE] = GP_IS_PARAMETER,
        [GP_STATE] = GP_IS_STATE,
        [GP_STATES] = GP_IS_STATE,
    };
    return role[v->kind] && !gp_schedule_decides(m, v) ? (GpRole)role[v->kind] : GP_IS_RESULT;
}

static int is_scalar(const GpVariable *v) { return v->kind < GP_SCALAR_KINDS; }

static size_t size_of(const GpModel *m, const GpVariable *v) { return is_scalar(v) ? 1 : gp_variable_size(m, v); }

int gp_count(GpInstance *p, const unsigned int *reference, size_t count, size_t *values) {
    const GpModel *m = &p->model;
    *values = 0;
    for (size_t i = 0; i < count; i++) {
        if (reference[i] >= m->variables) return gp_refuse(p, reference[i], " does not exist.");
        *values += size_of(m, m->variable + reference[i]);
    }
    return 0;
}

/* Whether all variables exist and `values` is the number of their elements; `roles` becomes all their roles. */
static int check_values(GpInstance *p, const unsigned int *reference, size_t count, size_t values, int *roles) {
    const GpModel *m = &p->model;
    size_t wanted = 0;
    *roles = 0;
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v;
        if (reference[i] >= m->variables) return gp_refuse(p, reference[i], " does not exist.");
        v = m->variable + reference[i];
        wanted += size_of(m, v);
        *roles |= (int)gp_role(m, v);
    }
    if (wanted == values) return 0;
    gp_text_clear(&p->message);
    gp_text_add(&p->message, "These variables have ");
    gp_text_count(&p->message, wanted);
    gp_text_add(&p->message, " values in all, but room for ");
    gp_text_count(&p->message, values);
    gp_text_add(&p->message, " is given.");
    return -1;
}

static int check_scalar(GpInstance *p, unsigned int reference, const GpVariable *v, double value) {
    if (!gp_finite(value)) return gp_refuse(p, reference, " must be set to a finite number.");
    switch (v->kind) {
    case GP_INPUT:
    case GP_FREQUENCY:
    case GP_SPEED:
    case GP_TORQUE:
    case GP_TONE_AMPLITUDE:
    case GP_TONE_PHASE:
    case GP_STATE: return 0;
    case GP_STIFFNESS:
    case GP_DAMPING:
        if (v->b != v->c || value >= 0) return 0;
        return gp_refuse(p, reference, " is on the diagonal of a stiffness or damping matrix and must not be negative.");
    case GP_MODAL_DAMPING:
        if (value >= 0 && value < 1) return 0;
        return gp_refuse(p, reference, " is a damping ratio and must be at least 0 and less than 1.");
    case GP_TEETH:
        if (value >= 1 && value <= 1e6 && value == (double)(long)value) return 0;
        return gp_refuse(p, reference, " is a tooth count and must be a whole number from 1 to 1,000,000.");
    default: return gp_refuse(p, reference, " is a result and cannot be set.");
    }
}

/* A matrix that comes as a whole can be judged at once; single entries are when they are taken into use. */
static int check_matrix(GpInstance *p, unsigned int reference, size_t d, const double *value) {
    double lower[36]; /* the half that apply_set writes last */
    unsigned char used[6];
    for (size_t i = 0; i < d; i++)
        for (size_t k = 0; k <= i; k++) {
            const double a = value[i * d + k], b = value[k * d + i];
            if (gp_magnitude(a - b) > 1e-12 * (gp_magnitude(a) + gp_magnitude(b)))
                return gp_refuse(p, reference, " must be a symmetric matrix.");
            lower[i * d + k] = lower[k * d + i] = a;
        }
    return gp_semidefinite(lower, d, p->work, used) ? 0
                                                    : gp_refuse(p, reference, " must be a positive semidefinite matrix.");
}

static int check_set(GpInstance *p, unsigned int reference, const double *value) {
    const GpModel *m = &p->model;
    const GpVariable *v = m->variable + reference;
    size_t size;
    if (gp_schedule_decides(m, v)) return gp_refuse(p, reference, GP_DECIDED);
    if (is_scalar(v)) return check_scalar(p, reference, v, *value);
    size = gp_variable_size(m, v);
    for (size_t i = 0; i < size; i++) {
        const GpVariable element = gp_variable_element(m, v, i);
        if (check_scalar(p, reference, &element, value[i])) return -1;
    }
    if (v->kind != GP_STIFFNESS_MATRIX && v->kind != GP_DAMPING_MATRIX) return 0;
    return check_matrix(p, reference, m->joint[v->a].size, value);
}

static void set_entry(GpInstance *p, const GpVariable *v, double *matrix, double value) {
    const GpJoint *joint = p->model.joint + v->a;
    double *block = matrix + joint->block;
    if (block[v->b * joint->size + v->c] == value) return; /* importers may set all parameters at every step */
    block[v->b * joint->size + v->c] = block[v->c * joint->size + v->b] = value;
    p->changed[v->a] = 1;
}

static void set_state(GpInstance *p, size_t index, double value) {
    const size_t n = p->model.order;
    if (index == n) {
        gp_source_turn_to(&p->source, value);
    } else {
        const double *states = gp_states(p);
        if (p->modal) {
            memcpy(p->now, states, n * sizeof(double));
            p->modal = 0; /* the next step goes back to modal coordinates where it can */
        }
        p->now[index] = value;
    }
    gp_touch(p);
}

static void change(GpInstance *p, double *place, double value) {
    if (*place == value) return;
    *place = value;
    gp_touch(p);
}

static void apply_set(GpInstance *p, const GpVariable *v, double value) {
    switch (v->kind) {
    case GP_INPUT:
        change(p, p->input + v->a, value);
        break;
    case GP_FREQUENCY:
        if (p->frequency != value) p->response_ready = 0;
        p->frequency = value;
        break;
    case GP_SPEED:
        p->source.speed = value;
        break;
    case GP_TORQUE: gp_set_torque(p, value); break;
    case GP_STIFFNESS: set_entry(p, v, p->K, value); break;
    case GP_DAMPING: set_entry(p, v, p->C, value); break;
    case GP_TEETH: change(p, &p->source.teeth, value); break;
    case GP_TONE_AMPLITUDE: change(p, p->source.amplitude + v->a, value); break;
    case GP_TONE_PHASE: change(p, p->source.phase + v->a, value); break;
    case GP_STATE: set_state(p, v->a, value); break;
    default: gp_set_damping(p, v->a, value);
    }
}

/* Applies a set to the variables that are inputs, or to those that are not. */
static void apply(GpInstance *p, const unsigned int *reference, size_t count, const double *value, int inputs) {
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v = p->model.variable + reference[i];
        const size_t size = size_of(&p->model, v);
        const int chosen = (gp_role(&p->model, v) == GP_IS_INPUT) == inputs;
        for (size_t k = 0; k < size; k++, value++) {
            const GpVariable element = gp_variable_element(&p->model, v, k);
            if (chosen) apply_set(p, &element, *value);
        }
    }
}

int gp_set(GpInstance *p, const unsigned int *reference, size_t count, const double *value, size_t values) {
    const GpModel *m = &p->model;
    size_t at = 0;
    int roles;
    if (check_values(p, reference, count, values, &roles)) return -1;
    for (size_t i = 0; i < count; i++) {
        if (check_set(p, reference[i], value + at)) return -1;
        at += size_of(m, m->variable + reference[i]);
    }
    if (roles & ~GP_IS_INPUT) apply(p, reference, count, value, 0); /* under the old inputs: the order does not matter */
    if (roles & GP_IS_INPUT) apply(p, reference, count, value, 1);
    return 0;
}

int gp_set_slope(GpInstance *p, const unsigned int *reference, size_t count, const int *order,
                 const double *value) {
    for (size_t i = 0; i < count; i++) {
        if (reference[i] >= p->model.variables) return gp_refuse(p, reference[i], " does not exist.");
        if (gp_role(&p->model, p->model.variable + reference[i]) != GP_IS_INPUT)
            return gp_refuse(p, reference[i], " is not an input, so that it has no input derivative.");
        if (order[i] != 1) return gp_refuse(p, reference[i], " takes an input derivative of order 1 only.");
        if (!gp_finite(value[i])) return gp_refuse(p, reference[i], " must be given a finite input derivative.");
    }
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v = p->model.variable + reference[i];
        if (v->kind == GP_INPUT)
            p->slope[v->a] = value[i];
        else if (v->kind == GP_SPEED)
            p->source.speed_slope = value[i];
        else if (v->kind == GP_TORQUE)
            p->torque_slope = value[i];
        else
            p->frequency_slope = value[i];
    }
    return 0;
}

void gp_hold(GpInstance *p) {
    memset(p->slope, 0, p->model.loads * sizeof *p->slope);
    p->source.speed_slope = p->frequency_slope = p->torque_slope = 0;
}

static double derivative_value(GpInstance *p, size_t state) {
    if (state < p->model.order) return gp_system_rate(&p->model, gp_motion(p), state);
    return GP_RAD_PER_REV_MIN * p->source.speed;
}

static int singular(GpInstance *p, double frequency) {
    gp_text_clear(&p->message);
    gp_text_add(&p->message, "The frequency response is singular at ");
    gp_text_real(&p->message, frequency);
    gp_text_add(&p->message, " Hz (an undamped resonance); add damping or change the frequency.");
    return -1;
}

int gp_response(GpInstance *p) {
    const double frequency = gp_magnitude(p->frequency); /* importers probe inputs around 0 */
    if (p->response_ready) return 0;
    if (gp_respond(&p->response, &p->system, &p->model, p->K, p->C, frequency, p->model.excitation))
        return singular(p, frequency);
    p->response_ready = 1;
    return 0;
}

static double order_frequency(const GpInstance *p, size_t tone) {
    return gp_magnitude(gp_source_order(&p->source, &p->model, tone) * p->source.speed / 60);
}

int gp_order_response(GpInstance *p, size_t tone) {
    const double frequency = order_frequency(p, tone);
    p->order_frequency[tone] = 0;
    if (frequency > 0) {
        GpResponse *r = &p->order_response;
        if (gp_respond(r, &p->system, &p->model, p->K, p->C, frequency, p->model.source_load))
            return singular(p, frequency);
        p->order_alpha[tone] = r->alpha_part[0];
        p->order_power[tone] = r->alpha_part[0] * r->input;
    }
    p->order_frequency[tone] = frequency;
    return 0;
}

static int order_value(GpInstance *p, const GpVariable *v, double *value) {
    const double amplitude = p->source.amplitude[v->a], frequency = order_frequency(p, v->a);
    *value = frequency;
    if (v->kind == GP_ORDER_FREQUENCY) return 0;
    *value = 0;
    if (frequency == 0) return 0;
    if (p->order_frequency[v->a] != frequency && gp_order_response(p, v->a)) return -1;
    *value = v->kind == GP_ORDER_ALPHA ? p->order_alpha[v->a] : p->order_power[v->a] * amplitude * amplitude;
    return 0;
}

static double joint_entry(const GpInstance *p, const double *matrix, const GpVariable *v) {
    const GpJoint *joint = p->model.joint + v->a;
    return matrix[joint->block + v->b * joint->size + v->c];
}

int gp_value(GpInstance *p, const GpVariable *v, double *value) {
    const GpModel *m = &p->model;
    switch (v->kind) {
    case GP_INPUT: *value = p->input[v->a]; return 0;
    case GP_FREQUENCY: *value = p->frequency; return 0;
    case GP_SPEED: *value = p->source.speed; return 0;
    case GP_TORQUE: *value = p->torque; return 0;
    case GP_STIFFNESS: *value = joint_entry(p, p->K, v); return 0;
    case GP_DAMPING: *value = joint_entry(p, p->C, v); return 0;
    case GP_MODAL_DAMPING: *value = p->zeta[v->a]; return 0;
    case GP_TEETH: *value = p->source.teeth; return 0;
    case GP_TONE_AMPLITUDE: *value = p->source.amplitude[v->a]; return 0;
    case GP_TONE_PHASE: *value = p->source.phase[v->a]; return 0;
    case GP_TIME: *value = p->time; return 0;
    case GP_STATE: *value = v->a < m->order ? gp_states(p)[v->a] : gp_source_angle(&p->source); return 0;
    case GP_OUTPUT: *value = gp_observed_output(p, v->a); return 0;
    case GP_PORT_FORCE:
    case GP_PORT_VELOCITY: *value = gp_observed_port(p, v); return 0;
    case GP_DERIVATIVE: *value = derivative_value(p, v->a); return 0;
    case GP_ENTRY_A:
    case GP_ENTRY_B:
    case GP_ENTRY_C:
    case GP_ENTRY_D: *value = gp_system_entry(m, &p->system, v->kind, v->b, v->c); return 0;
    case GP_ORDER_FREQUENCY:
    case GP_ORDER_ALPHA:
    case GP_ORDER_POWER: return order_value(p, v, value);
    default: break;
    }
    if (gp_response(p)) return -1;
    switch (v->kind) {
    case GP_ALPHA: *value = p->response.alpha_part[v->a]; break;
    case GP_JOINT_ALPHA: *value = p->response.alpha[v->a]; break;
    case GP_FRF_REAL: *value = gp_transfer(&p->response, m, v->a).re; break;
    default: *value = gp_transfer(&p->response, m, v->a).im;
    }
    return 0;
}

int gp_get(GpInstance *p, const unsigned int *reference, size_t count, double *value, size_t values) {
    const GpModel *m = &p->model;
    int roles;
    gp_text_clear(&p->message);
    if (check_values(p, reference, count, values, &roles)) return -1;
    if ((roles & GP_IS_RESULT) && gp_use_parameters(p)) return -1;
    if (p->modal) gp_observe(p, reference, count);
    for (size_t i = 0; i < count; i++) {
        const GpVariable *v = m->variable + reference[i];
        const size_t size = size_of(m, v);
        for (size_t k = 0; k < size; k++, value++) {
            GpVariable element;
            if (!is_scalar(v)) element = gp_variable_element(m, v, k);
            if (gp_value(p, is_scalar(v) ? v : &element, value)) return -1;
            if (!gp_finite(*value))
                return gp_refuse(p, reference[i], " overflows; check the inputs and their units.");
        }
    }
    return 0;
}
