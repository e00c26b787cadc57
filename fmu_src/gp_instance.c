#include "gp_instance.h"

#include <stdlib.h>
#include <string.h>

#include "gp_clock.h"
#include "gp_given.h"
#include "gp_linalg.h"
#include "gp_memory.h"
#include "gp_schedule.h"
#include "gp_waves.h"

/* The first receiver velocity that is this row, or `none`. */
static size_t find_receiver(const GpModel *m, const double *row, size_t none) {
    for (size_t k = 0; k < m->rows; k++)
        if (!memcmp(row, m->receiver + k * m->modes, m->modes * sizeof *row)) return m->outputs + m->rows + k;
    return none;
}

/* Where the value of each observed row is found, so that equal rows are computed once: many joints share a receiver, and
   outputs are mostly forces and receiver velocities of joints. */
static void find_places(GpInstance *p) {
    const GpModel *m = &p->model;
    const size_t forces = m->outputs, velocities = m->outputs + m->rows;
    for (size_t i = 0; i < m->outputs; i++) {
        const GpOutput *o = m->output + i;
        p->place[i] = i;
        if (o->quantity == GP_FORCE) p->place[i] = forces + m->joint[o->joint].first + o->dof;
        if (o->quantity == GP_VELOCITY) p->place[i] = find_receiver(m, m->output_rows + i * m->modes, i);
    }
    for (size_t k = 0; k < m->rows; k++) {
        p->place[forces + k] = forces + k;
        p->place[velocities + k] = find_receiver(m, m->receiver + k * m->modes, velocities + k);
    }
}

GpInstance *gp_instance_create(GpModel *model, GpText *message) {
    GpInstance *p = calloc(1, sizeof *p);
    if (p) p->model = *model;
    if (!p || gp_memory_allocate(p)) {
        free(p);
        gp_text_clear(message);
        gp_text_add(message, "There is not enough memory for another instance of this model.");
        return NULL;
    }
    p->kernels = p->expm.kernels = gp_kernels();
    find_places(p);
    gp_instance_reset(p);
    if (p->model.pairs) {
        gp_system_form(&p->system, &p->model, p->zeta, p->K, p->C);
        gp_modes_form(&p->modes, &p->model, &p->system, &p->motion, p->states, p->next, p->total, p->work);
    }
    return p;
}

void gp_instance_free(GpInstance *p) {
    if (!p) return;
    gp_model_free(&p->model);
    free(p->memory);
    free(p);
}

void gp_touch(GpInstance *p) {
    p->total_ready = p->motion_ready = 0;
    p->epoch++;
}

static void forget_discrete(GpInstance *p) {
    for (int i = 0; i < GP_STEP_SIZES; i++) {
        p->discrete[i].h = 0;
        p->discrete[i].ready = 0;
        p->discrete[i].used = 0;
    }
}

static void copy(double *to, const double *from, size_t count) {
    if (count) memcpy(to, from, count * sizeof *to);
}

void gp_instance_reset(GpInstance *p) {
    const GpModel *m = &p->model;
    copy(p->K, m->stiffness, m->blocks);
    copy(p->C, m->damping, m->blocks);
    copy(p->valid_K, m->stiffness, m->blocks);
    copy(p->valid_C, m->damping, m->blocks);
    copy(p->zeta, m->zeta, m->groups);
    copy(p->valid_zeta, m->zeta, m->groups);
    memset(p->changed, 0, m->joints);
    memset(p->input, 0, m->loads * sizeof(double));
    memset(p->slope, 0, m->loads * sizeof(double));
    memset(p->now, 0, m->order * sizeof(double));
    for (size_t i = 0; i < m->tones; i++) {
        p->source.amplitude[i] = m->tone[i].amplitude;
        p->source.phase[i] = m->tone[i].phase;
        p->order_frequency[i] = 0;
    }
    p->source.teeth = m->teeth;
    p->source.speed = m->speed;
    p->source.speed_slope = p->source.turns = p->source.part = p->source.rest = 0;
    p->frequency = m->frequency;
    p->torque = p->used_torque = m->start_torque;
    p->frequency_slope = p->torque_slope = 0;
    p->time = 0;
    p->steps = 0;
    p->begun = p->jumped = 0;
    p->modal = m->pairs != 0;
    p->system_ready = p->states_ready = p->response_ready = 0;
    gp_touch(p);
    gp_text_clear(&p->message);
    forget_discrete(p); /* so that a run repeats itself bit for bit, whatever was run before */
}

const double *gp_total(GpInstance *p) {
    const GpModel *m = &p->model;
    if (!p->total_ready) {
        copy(p->total, p->input, m->loads);
        if (m->source_load != GP_NONE) p->total[m->source_load] += gp_source_value(&p->source, m);
        p->total_ready = 1;
    }
    return p->total;
}

const double *gp_states(GpInstance *p) {
    if (!p->modal) return p->now;
    if (!p->states_ready) gp_modes_to_states(&p->model, p->now, p->states);
    p->states_ready = 1;
    return p->states;
}

const GpMotion *gp_motion(GpInstance *p) {
    if (!p->motion_ready) gp_system_motion(&p->system, &p->model, gp_states(p), gp_total(p), &p->motion);
    p->motion_ready = 1;
    return &p->motion;
}

static void to_physical(GpInstance *p) {
    if (!p->modal) return;
    copy(p->now, gp_states(p), p->model.order);
    p->modal = 0;
    forget_discrete(p);
}

static void to_modal(GpInstance *p) {
    gp_modes_from_states(&p->model, &p->system, p->now, p->next, p->work);
    if (!gp_all_finite(p->next, p->model.order)) return; /* stays as it is */
    copy(p->now, p->next, p->model.order);
    p->modal = 1;
    p->states_ready = 0;
    forget_discrete(p);
    gp_touch(p); /* also where the step then fails: what was computed before belongs to the other form */
}

/* Before time passes there is nothing to keep: the instance starts at rest with all inputs 0. */
void gp_set_damping(GpInstance *p, size_t group, double zeta) {
    const GpModel *m = &p->model;
    const size_t N = m->modes;
    const double *total = gp_total(p), old = p->zeta[group];
    if (old == zeta) return;
    if (p->begun) to_physical(p);
    for (size_t r = 0; r < N; r++) {
        double motion = 0, before, after;
        p->zeta[group] = old;
        before = gp_modal_damping(m, p->zeta, r);
        p->zeta[group] = zeta;
        after = gp_modal_damping(m, p->zeta, r);
        if (before == after || !p->begun) continue;
        for (size_t k = 0; k < m->loads; k++) motion += m->mesh[k * N + r] * total[k]; /* d is 0 for forces */
        p->now[N + r] += (before - after) * motion;
        if (motion != 0) p->jumped = 1;
    }
    p->system_ready = 0;
    gp_touch(p);
}

/* Takes over the matrices of joint j, or goes back to the last valid ones with a sentence. What follows the torque is
   positive semidefinite and taken over in any case. */
static int use_joint(GpInstance *p, size_t j) {
    const GpModel *m = &p->model;
    const size_t at = m->joint[j].block, d = m->joint[j].size;
    const uint32_t follows = m->joint[j].follows;
    unsigned char used[6];
    const int stiff = follows & GP_FOLLOWS_STIFFNESS || gp_semidefinite(p->K + at, d, p->work, used);
    const int damped = follows & GP_FOLLOWS_DAMPING || gp_semidefinite(p->C + at, d, p->work, used);
    p->changed[j] = 0;
    if (follows || (stiff && damped)) {
        copy(p->valid_K + at, p->K + at, d * d);
        if (damped) copy(p->valid_C + at, p->C + at, d * d);
        p->system_ready = 0;
    }
    if (stiff && damped) return 0;
    copy(p->K + at, p->valid_K + at, d * d);
    copy(p->C + at, p->valid_C + at, d * d);
    gp_text_add(&p->message, p->message.length ? " " : "");
    gp_text_add(&p->message, "The ");
    gp_text_add(&p->message, stiff ? "damping" : "stiffness");
    gp_text_add(&p->message, " matrix of ");
    gp_text_add(&p->message, gp_joint_name(m, j));
    gp_text_add(&p->message, " is not positive semidefinite; the joint keeps its last valid matrices.");
    return -1;
}

static int has_start_parameters(const GpInstance *p) {
    const GpModel *m = &p->model;
    return !memcmp(p->valid_K, m->stiffness, m->blocks * sizeof(double)) &&
           !memcmp(p->valid_C, m->damping, m->blocks * sizeof(double)) &&
           (!m->groups || !memcmp(p->valid_zeta, m->zeta, m->groups * sizeof(double)));
}

int gp_use_parameters(GpInstance *p) {
    const GpModel *m = &p->model;
    int failed = 0;
    gp_text_clear(&p->message);
    for (size_t j = 0; j < m->joints; j++)
        if (p->changed[j] && use_joint(p, j)) failed = -1;
    p->used_torque = p->torque;
    if (!p->system_ready) {
        copy(p->valid_zeta, p->zeta, m->groups);
        p->as_exported = has_start_parameters(p);
        if (!p->as_exported) to_physical(p);
        gp_system_form(&p->system, m, p->zeta, p->valid_K, p->valid_C);
        forget_discrete(p);
        p->system_ready = 1;
        p->response_ready = 0;
        for (size_t i = 0; i < m->tones; i++) p->order_frequency[i] = 0;
        gp_touch(p);
    }
    return failed;
}

void gp_instance_restored(GpInstance *p, int used) {
    p->as_exported = has_start_parameters(p);
    p->system_ready = used;
    p->states_ready = p->response_ready = p->jumped = 0;
    for (size_t i = 0; i < p->model.tones; i++) p->order_frequency[i] = 0;
    gp_touch(p);
}

int gp_get_states(GpInstance *p, double *states) {
    copy(states, gp_states(p), p->model.order);
    if (p->model.source_load != GP_NONE) states[p->model.order] = gp_source_angle(&p->source);
    return 0;
}

int gp_set_states(GpInstance *p, const double *states) {
    const size_t n = p->model.order;
    if (!gp_all_finite(states, p->model.states)) {
        gp_text_clear(&p->message);
        gp_text_add(&p->message, "A continuous state is not a finite number.");
        return -1;
    }
    if (p->modal) to_physical(p);
    copy(p->now, states, n);
    if (p->model.source_load != GP_NONE) gp_source_turn_to(&p->source, states[n]);
    gp_touch(p);
    return 0;
}

int gp_get_derivatives(GpInstance *p, double *derivatives) {
    const GpModel *m = &p->model;
    if (gp_use_parameters(p)) return -1;
    gp_system_derivative(m, gp_motion(p), derivatives);
    if (m->source_load != GP_NONE) derivatives[m->order] = GP_RAD_PER_REV_MIN * p->source.speed;
    if (gp_all_finite(derivatives, m->states)) return 0;
    gp_text_add(&p->message, "A derivative overflows; check the states and inputs.");
    return -1;
}

void gp_get_nominals(const GpInstance *p, double *nominals) {
    const GpModel *m = &p->model;
    copy(nominals, m->nominal, m->modes); /* of a given system none, and then one of each state */
    copy(nominals + m->modes, m->nominal, m->order - m->modes);
    if (m->source_load != GP_NONE) nominals[m->order] = 1;
}

/* The discretisation for h: a kept one, or a new one in the place of the one not used for longest. */
static GpDiscrete *discretise(GpInstance *p, double time, double h) {
    GpDiscrete *best = NULL, *oldest = p->discrete;
    double nearest = gp_clock_jitter(time, h);
    if (nearest > 1e-6 * h) nearest = 1e-6 * h; /* late times are coarse: steps that differ stay apart */
    for (GpDiscrete *d = p->discrete; d < p->discrete + GP_STEP_SIZES; d++) {
        const double distance = gp_magnitude(d->h - h);
        if (d->h > 0 && distance <= nearest) {
            best = d;
            nearest = distance;
        }
        if (oldest->h > 0 && (d->h == 0 || d->used < oldest->used)) oldest = d;
    }
    if (!best) {
        best = oldest;
        best->h = h;
        best->ready = 0;
    }
    if (!best->ready) {
        const int failed = p->modal ? gp_discretise_modal(best, &p->model, &p->modes)
                                    : gp_discretise_physical(best, &p->expm, &p->rigid, &p->model, &p->system);
        if (failed) {
            best->h = 0;
            return NULL;
        }
        p->formed++;
    }
    best->used = ++p->steps;
    return best;
}

/* One part of a step: from the coordinates `from` at the time t after the communication point to `to`. */
static void propagate(GpInstance *p, const GpDiscrete *d, double t, double h, const double *from, double *to) {
    const GpModel *m = &p->model;
    const size_t n = m->order;
    int sloping = 0;
    gp_transition(d, p->kernels, p->modal, from, to, n);
    for (size_t k = 0; k < m->loads; k++) {
        p->held[k] = p->input[k] + t * p->slope[k];
        p->grown[k] = h * p->slope[k];
        sloping |= p->slope[k] != 0;
    }
    p->kernels->add_columns(to, d->columns, p->held, n, m->loads);
    if (sloping) p->kernels->add_columns(to, d->columns + m->loads * n, p->grown, n, m->loads);
}

static void add_source(GpInstance *p, const GpDiscrete *d, double t, double h, double *to) {
    const size_t n = p->model.order;
    double c[GP_LEGENDRE];
    gp_source_coefficients(&p->source, &p->model, t, h, c);
    for (size_t k = 0; k < GP_LEGENDRE; k++)
        p->kernels->axpy(to, c[k], d->columns + (2 * p->model.loads + k) * n, n);
}

static int fail_step(GpInstance *p, const char *sentence) {
    gp_text_add(&p->message, sentence);
    return -1;
}

/* Ends a step whose new coordinates are `to`. */
static void commit(GpInstance *p, double *to, double h, double frequency) {
    double *other = to == p->next ? p->spare : p->next;
    p->spare = p->now;
    p->next = other;
    p->now = to;
    for (size_t k = 0; k < p->model.loads; k++) {
        p->input[k] += h * p->slope[k];
        p->slope[k] = 0;
    }
    if (p->model.source_load != GP_NONE) gp_source_advance(&p->source, h);
    if (frequency != p->frequency) p->response_ready = 0;
    p->frequency = frequency;
    if (p->torque_slope != 0) gp_set_torque(p, p->torque + h * p->torque_slope);
    p->frequency_slope = p->torque_slope = 0;
    p->states_ready = 0;
    p->begun = 1;
    gp_touch(p);
}

int gp_step(GpInstance *p, double time, double h) {
    const double frequency = p->frequency + h * p->frequency_slope;
    const size_t tones = p->model.source_load == GP_NONE ? 0 : gp_source_substeps(&p->source, &p->model, h);
    const size_t parts = tones ? tones : 1;
    const double part = h / (double)parts;
    const double *from;
    double *to = p->next, check = 0;
    const GpDiscrete *d;
    if (gp_use_parameters(p)) return -1;
    if (!gp_finite(frequency)) return fail_step(p, "The input frequency overflows within this step.");
    if (!gp_finite(p->torque + h * p->torque_slope))
        return fail_step(p, "The input operation.torque overflows within this step.");
    if (tones == GP_NONE)
        return fail_step(p, "The gear mesh makes more than 200,000 cycles within this step; use a smaller step.");
    if (p->model.source_load != GP_NONE && !gp_source_can_advance(&p->source, h))
        return fail_step(p, "The shaft turns on without limit within this step; check its speed.");
    if (!p->modal && p->as_exported && p->model.pairs) to_modal(p);
    d = discretise(p, time, part);
    if (!d) {
        gp_text_add(&p->message, "The system cannot be discretised for the step size ");
        gp_text_real(&p->message, h);
        gp_text_add(&p->message, gp_is_given(&p->model) ? " s: its matrix A" : " s: stiffness or damping");
        return fail_step(p, " is too large for it, so that no digits would be left; use a smaller step.");
    }
    from = p->now;
    for (size_t i = 0; i < parts; i++) {
        to = i % 2 ? p->spare : p->next;
        propagate(p, d, (double)i * part, part, from, to);
        if (tones) add_source(p, d, (double)i * part, part, to);
        from = to;
    }
    for (size_t k = 0; k < p->model.loads; k++) check += 0 * (p->input[k] + h * p->slope[k]);
    if (check != 0 || !gp_all_finite(to, p->model.order)) /* NaN: some number is not finite */
        return fail_step(p, "The step overflows, so it is not made; check the inputs and their units.");
    commit(p, to, h, frequency);
    return 0;
}
