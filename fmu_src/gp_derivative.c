/* Directional and adjoint derivatives of an instance (declared in gp_instance.h). */
#include "gp_instance.h"
#include "gp_linalg.h"
#include "gp_schedule.h"

/* Adds a seed of entry b, c of a joint's matrix, and of the entry mirrored in the diagonal, which is the same. */
static void add_entry(const GpModel *m, double *packed, const GpVariable *v, double seed) {
    const GpJoint *joint = m->joint + v->a;
    packed[joint->block + v->b * joint->size + v->c] += seed;
    if (v->b != v->c) packed[joint->block + v->c * joint->size + v->b] += seed;
}

/* Adds `seed` of element i of a variable to the direction. */
static int add_seed(GpInstance *p, unsigned int reference, size_t i, double seed) {
    const GpModel *m = &p->model;
    GpTangent *t = &p->tangent;
    const GpVariable *v = m->variable + reference;
    if (gp_schedule_decides(m, v))
        return gp_refuse(p, reference, " follows the input operation.torque: take the derivative by that.");
    switch (v->kind) {
    case GP_INPUT: t->input[v->a] += seed; return 0;
    case GP_FREQUENCY: t->frequency += seed; return 0;
    case GP_SPEED: t->speed += seed; return 0;
    case GP_TEETH: t->teeth += seed; return 0;
    case GP_TONE_AMPLITUDE: t->amplitude[v->a] += seed; return 0;
    case GP_TONE_PHASE: t->phase[v->a] += seed; return 0;
    case GP_STATE: t->states[v->a] += seed; return 0;
    case GP_STATES: t->states[i] += seed; return 0;
    case GP_STIFFNESS: add_entry(m, t->K, v, seed); break;
    case GP_DAMPING: add_entry(m, t->C, v, seed); break;
    /* an element of a matrix is moved alone; the mirrored one has a seed of its own */
    case GP_STIFFNESS_MATRIX: t->K[m->joint[v->a].block + i] += seed; break;
    case GP_DAMPING_MATRIX: t->C[m->joint[v->a].block + i] += seed; break;
    case GP_MODAL_DAMPING: t->zeta[v->a] += seed; break;
    case GP_TORQUE: gp_schedule_tangent(m, p->torque, seed, t->K, t->C); break;
    default: return gp_refuse(p, reference, " is neither an input, a parameter nor a state: no derivative is taken by it.");
    }
    t->of_parameters = 1;
    return 0;
}

/* Brings everything but the frequency responses up to date for the direction. */
static void follow(GpInstance *p) {
    const GpModel *m = &p->model;
    GpTangent *t = &p->tangent;
    for (size_t k = 0; k < m->loads; k++) t->total[k] = t->input[k];
    if (m->source_load != GP_NONE) {
        t->total[m->source_load] += gp_source_rate(&p->source, m) * t->states[m->order];
        t->total[m->source_load] += gp_source_tangent(&p->source, m, t->amplitude, t->phase, t->teeth);
    }
    gp_tangent_system(t, m, &p->system);
    gp_tangent_motion(t, m, &p->system, gp_states(p), gp_total(p), gp_motion(p));
}

static int follow_response(GpInstance *p, GpResponse *r, double frequency) {
    GpTangent *t = &p->tangent;
    if (!gp_respond_tangent(&t->response, r, &p->system, &p->model, p->K, p->C, t->system.X, t->K, t->C, frequency))
        return 0;
    gp_text_clear(&p->message);
    gp_text_add(&p->message, "The frequency response has no derivative here; add damping or change the frequency.");
    return -1;
}

static int order_tangent(GpInstance *p, const GpVariable *v, double *change) {
    const GpModel *m = &p->model;
    const GpTangent *t = &p->tangent;
    const GpSource *s = &p->source;
    const double order = gp_source_order(s, m, v->a), a = s->amplitude[v->a], da = t->amplitude[v->a];
    const double turned = (order * t->speed + m->tone[v->a].harmonic * t->teeth * s->speed) / 60;
    const double moved = order * s->speed < 0 ? -turned : turned;
    const GpResponse *r = &p->order_response;
    double alpha, dalpha;
    *change = v->kind == GP_ORDER_FREQUENCY ? moved : 0;
    if (v->kind == GP_ORDER_FREQUENCY || order * s->speed == 0) return 0;
    if (gp_order_response(p, v->a) || follow_response(p, &p->order_response, moved)) return -1;
    alpha = r->alpha_part[0];
    dalpha = t->response.alpha_part[0];
    *change = dalpha;
    if (v->kind == GP_ORDER_POWER)
        *change = a * a * (dalpha * r->input + alpha * t->response.input) + 2 * a * da * alpha * r->input;
    return 0;
}

/* The change of a scalar result along the direction; `responded` says whether the response has been followed. */
static int change_of(GpInstance *p, unsigned int reference, const GpVariable *v, int *responded, double *change) {
    const GpModel *m = &p->model;
    const GpTangent *t = &p->tangent;
    size_t row;
    if (gp_schedule_decides(m, v)) { /* an entry that follows the torque */
        const GpJoint *joint = m->joint + v->a;
        *change = (v->kind == GP_STIFFNESS ? t->K : t->C)[joint->block + v->b * joint->size + v->c];
        return 0;
    }
    switch (v->kind) {
    case GP_OUTPUT: *change = gp_tangent_output(t, m, gp_motion(p), v->a); return 0;
    case GP_PORT_FORCE: *change = t->motion.g[m->joint[v->a].first + v->b]; return 0;
    case GP_PORT_VELOCITY:
        row = m->joint[v->a].first + v->b;
        *change = gp_dot(m->receiver + row * m->modes, t->motion.v, m->modes);
        return 0;
    case GP_DERIVATIVE:
        *change = v->a < m->order ? gp_system_rate(m, &t->motion, v->a) : GP_RAD_PER_REV_MIN * t->speed;
        return 0;
    case GP_ENTRY_A:
    case GP_ENTRY_B:
    case GP_ENTRY_C:
    case GP_ENTRY_D: *change = gp_tangent_entry(t, m, &p->system, v->kind, v->b, v->c); return 0;
    case GP_ORDER_FREQUENCY:
    case GP_ORDER_ALPHA:
    case GP_ORDER_POWER:
        *responded = 0; /* its own response takes the place of the other */
        return order_tangent(p, v, change);
    case GP_ALPHA:
    case GP_JOINT_ALPHA:
    case GP_FRF_REAL:
    case GP_FRF_IMAG: break;
    default: return gp_refuse(p, reference, " is neither an output nor a derivative: it has no derivative.");
    }
    if (!*responded) {
        if (gp_response(p)) return -1;
        if (follow_response(p, &p->response, p->frequency < 0 ? -t->frequency : t->frequency))
            return -1;
    }
    *responded = 1;
    switch (v->kind) {
    case GP_ALPHA: *change = t->response.alpha_part[v->a]; break;
    case GP_JOINT_ALPHA: *change = t->response.alpha[v->a]; break;
    case GP_FRF_REAL: *change = gp_transfer_tangent(&t->response, &p->response, m, v->a).re; break;
    default: *change = gp_transfer_tangent(&t->response, &p->response, m, v->a).im;
    }
    return 0;
}

static int check_counts(GpInstance *p, const unsigned int *unknown, size_t unknowns, size_t given_unknowns,
                        const unsigned int *known, size_t knowns, size_t given_knowns) {
    size_t wanted_unknowns, wanted_knowns;
    gp_text_clear(&p->message);
    if (gp_count(p, unknown, unknowns, &wanted_unknowns) || gp_count(p, known, knowns, &wanted_knowns)) return -1;
    if (wanted_unknowns == given_unknowns && wanted_knowns == given_knowns) return 0;
    gp_text_add(&p->message, "The numbers of seeds and results do not match the sizes of these variables.");
    return -1;
}

/* The changes of all unknowns: written to `result`, or summed up with weights to result[0]. */
static int changes(GpInstance *p, const unsigned int *unknown, size_t unknowns, int summed, const double *weight,
                   double *result) {
    const GpModel *m = &p->model;
    int responded = 0;
    size_t at = 0;
    follow(p);
    if (summed) result[0] = 0; /* also without unknowns, when there may be no weights */
    for (size_t i = 0; i < unknowns; i++) {
        const GpVariable *v = m->variable + unknown[i];
        const size_t size = gp_variable_size(m, v);
        for (size_t k = 0; k < size; k++, at++) {
            const GpVariable element = gp_variable_element(m, v, k);
            double change = 0;
            if (summed && weight[at] == 0) continue;
            if (change_of(p, unknown[i], &element, &responded, &change)) return -1;
            if (!gp_finite(change)) return gp_refuse(p, unknown[i], " has a derivative that overflows.");
            if (summed)
                result[0] += weight[at] * change;
            else
                result[at] = change;
        }
    }
    if (!summed || gp_finite(*result)) return 0;
    gp_text_clear(&p->message);
    gp_text_add(&p->message, "The weighted sum of the derivatives overflows; check the seeds.");
    return -1;
}

int gp_directional(GpInstance *p, const unsigned int *unknown, size_t unknowns, const unsigned int *known,
                   size_t knowns, const double *seed, size_t seeds, double *result, size_t results) {
    if (check_counts(p, unknown, unknowns, results, known, knowns, seeds) || gp_use_parameters(p)) return -1;
    gp_tangent_clear(&p->tangent, &p->model);
    for (size_t i = 0; i < knowns; i++) {
        const size_t size = gp_variable_size(&p->model, p->model.variable + known[i]);
        for (size_t k = 0; k < size; k++, seed++)
            if (add_seed(p, known[i], k, *seed)) return -1;
    }
    return changes(p, unknown, unknowns, 0, NULL, result);
}

int gp_adjoint(GpInstance *p, const unsigned int *unknown, size_t unknowns, const unsigned int *known,
               size_t knowns, const double *seed, size_t seeds, double *result, size_t results) {
    if (check_counts(p, unknown, unknowns, seeds, known, knowns, results) || gp_use_parameters(p)) return -1;
    for (size_t i = 0; i < knowns; i++) {
        const size_t size = gp_variable_size(&p->model, p->model.variable + known[i]);
        for (size_t k = 0; k < size; k++, result++) {
            gp_tangent_clear(&p->tangent, &p->model);
            if (add_seed(p, known[i], k, 1) || changes(p, unknown, unknowns, 1, seed, result)) return -1;
        }
    }
    return 0;
}
