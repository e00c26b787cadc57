#include "gp_instance.h"

#include <stdlib.h>
#include <string.h>

#include "gp_clock.h"
#include "gp_linalg.h"

/* Hands out doubles from one allocation; with base NULL it only counts them. */
typedef struct {
    double *base; /* the allocation */
    size_t used;  /* doubles handed out */
} Arena;

static double *take(Arena *arena, size_t count) {
    double *start = arena->base ? arena->base + arena->used : NULL;
    arena->used += count;
    return start;
}

static GpComplex *take_complex(Arena *arena, size_t count) { return (GpComplex *)take(arena, 2 * count); }

static void lay_out(GpInstance *p, Arena *arena) {
    const GpModel *m = &p->model;
    const size_t N = m->modes, n = 2 * N, width = n + 2 * m->loads, wide = n * width;
    p->K = take(arena, m->blocks);
    p->C = take(arena, m->blocks);
    p->valid_K = take(arena, m->blocks);
    p->valid_C = take(arena, m->blocks);
    p->zeta = take(arena, m->groups);
    p->changed = (unsigned char *)take(arena, m->joints / sizeof(double) + 1);
    p->definite_work = take(arena, 36);
    p->input = take(arena, m->loads);
    p->slope = take(arena, m->loads);
    p->x = take(arena, n);
    p->next = take(arena, n);
    p->system.X = take(arena, N);
    p->system.P = take(arena, m->rows * N);
    p->system.KP = take(arena, m->rows * N);
    p->system.CP = take(arena, m->rows * N);
    p->system.Xd = take(arena, m->loads * N);
    p->system.push = take(arena, m->loads * N);
    p->motion.q = take(arena, N);
    p->motion.v = take(arena, N);
    p->motion.a = take(arena, N);
    p->motion.g = take(arena, m->rows);
    p->response.h = take_complex(arena, N);
    p->response.v = take_complex(arena, N);
    p->response.g = take_complex(arena, m->rows);
    p->response.work = take_complex(arena, m->rows * (2 * m->rows + 1));
    p->response.alpha = take(arena, m->joints);
    p->expm.n = n;
    p->expm.m = m->loads;
    p->expm.width = width;
    p->expm.M = take(arena, wide);
    p->expm.M2 = take(arena, wide);
    p->expm.M4 = take(arena, wide);
    p->expm.M6 = take(arena, wide);
    p->expm.T1 = take(arena, wide);
    p->expm.T2 = take(arena, wide);
    for (int i = 0; i < GP_STEP_SIZES; i++) p->discrete[i].columns = take(arena, wide);
}

GpInstance *gp_instance_create(GpModel *model, GpText *message) {
    GpInstance *p = calloc(1, sizeof *p);
    Arena arena = {NULL, 0};
    if (p) {
        p->model = *model;
        lay_out(p, &arena);
        p->memory = arena.base = calloc(arena.used, sizeof(double));
        arena.used = 0;
    }
    if (!p || !p->memory) {
        free(p);
        gp_text_clear(message);
        gp_text_add(message, "There is not enough memory for another instance of this model.");
        return NULL;
    }
    lay_out(p, &arena);
    gp_instance_reset(p);
    return p;
}

void gp_instance_free(GpInstance *p) {
    if (!p) return;
    gp_model_free(&p->model);
    free(p->memory);
    free(p);
}

static void forget_discrete(GpInstance *p) {
    for (int i = 0; i < GP_STEP_SIZES; i++) p->discrete[i].h = 0;
}

void gp_instance_reset(GpInstance *p) {
    const GpModel *m = &p->model;
    memcpy(p->K, m->stiffness, m->blocks * sizeof(double));
    memcpy(p->C, m->damping, m->blocks * sizeof(double));
    memcpy(p->valid_K, m->stiffness, m->blocks * sizeof(double));
    memcpy(p->valid_C, m->damping, m->blocks * sizeof(double));
    if (m->groups) memcpy(p->zeta, m->zeta, m->groups * sizeof(double));
    memset(p->changed, 0, m->joints);
    memset(p->input, 0, m->loads * sizeof(double));
    memset(p->slope, 0, m->loads * sizeof(double));
    memset(p->x, 0, 2 * m->modes * sizeof(double));
    p->frequency = m->frequency;
    p->frequency_slope = 0;
    p->steps = 0;
    p->system_ready = p->motion_ready = p->response_ready = 0;
    gp_text_clear(&p->message);
    forget_discrete(p); /* so that a run repeats itself bit for bit, whatever was run before */
}

/* Keeps q' = s + sum X d_k e_k where X is about to change under the present inputs: a velocity cannot jump with a
   damping ratio. Before the first step there is nothing to keep: the instance starts at rest with all inputs 0. */
static void keep_velocity(GpInstance *p) {
    const GpModel *m = &p->model;
    const size_t N = m->modes;
    if (p->steps == 0) return;
    for (size_t r = 0; r < N; r++) {
        const double change = p->system.X[r] - gp_modal_damping(m, p->zeta, r);
        double motion = 0;
        if (change == 0) continue;
        for (size_t k = 0; k < m->loads; k++) motion += m->mesh[k * N + r] * p->input[k]; /* d is 0 for forces */
        p->x[N + r] += change * motion;
    }
}

int gp_use_parameters(GpInstance *p) {
    const GpModel *m = &p->model;
    unsigned char used[6];
    int failed = 0;
    gp_text_clear(&p->message);
    for (size_t j = 0; j < m->joints; j++) {
        const size_t at = m->joint[j].block, d = m->joint[j].size, bytes = d * d * sizeof(double);
        int stiff, damped;
        if (!p->changed[j]) continue;
        stiff = gp_semidefinite(p->K + at, d, p->definite_work, used);
        damped = gp_semidefinite(p->C + at, d, p->definite_work, used);
        p->changed[j] = 0;
        if (stiff && damped) {
            memcpy(p->valid_K + at, p->K + at, bytes);
            memcpy(p->valid_C + at, p->C + at, bytes);
            p->system_ready = 0;
            continue;
        }
        memcpy(p->K + at, p->valid_K + at, bytes);
        memcpy(p->C + at, p->valid_C + at, bytes);
        gp_text_add(&p->message, failed ? " " : "");
        gp_text_add(&p->message, "The ");
        gp_text_add(&p->message, stiff ? "damping" : "stiffness");
        gp_text_add(&p->message, " matrix of ");
        gp_text_add(&p->message, gp_joint_name(m, j));
        gp_text_add(&p->message, " is not positive semidefinite; the joint keeps its last valid matrices.");
        failed = -1;
    }
    if (!p->system_ready) {
        keep_velocity(p);
        gp_system_form(&p->system, m, p->zeta, p->K, p->C);
        forget_discrete(p);
        p->system_ready = 1;
        p->motion_ready = p->response_ready = 0;
    }
    return failed;
}

/* The discretisation for h: a kept one, or a new one in the place of the one not used for longest. */
static GpDiscrete *discretise(GpInstance *p, double time, double h) {
    GpDiscrete *best = NULL, *oldest = p->discrete;
    double nearest = gp_clock_jitter(time, h);
    for (GpDiscrete *d = p->discrete; d < p->discrete + GP_STEP_SIZES; d++) {
        const double distance = d->h > h ? d->h - h : h - d->h;
        if (d->h > 0 && distance <= nearest) {
            best = d;
            nearest = distance;
        }
        if (oldest->h > 0 && (d->h == 0 || d->used < oldest->used)) oldest = d;
    }
    if (!best) {
        best = oldest;
        best->h = 0;
        gp_system_matrices(&p->system, &p->model, p->expm.M, p->expm.width);
        if (gp_discretise(&p->expm, h, best->columns)) return NULL;
        best->h = h;
        p->formed++;
    }
    best->used = ++p->steps;
    return best;
}

/* next = x + [Phi - I, Gamma0, Gamma1] [x; u; h du/dt] */
static void propagate(GpInstance *p, const GpDiscrete *d, double h) {
    const size_t n = p->expm.n, m = p->model.loads;
    const double *column = d->columns;
    memset(p->next, 0, n * sizeof(double));
    for (size_t j = 0; j + 4 <= n; j += 4, column += 4 * n) { /* n is even; the rest follows */
        const double x0 = p->x[j], x1 = p->x[j + 1], x2 = p->x[j + 2], x3 = p->x[j + 3];
        const double *restrict c0 = column, *restrict c1 = c0 + n, *restrict c2 = c1 + n, *restrict c3 = c2 + n;
        double *restrict y = p->next;
        for (size_t i = 0; i < n; i++) y[i] += (c0[i] * x0 + c1[i] * x1) + (c2[i] * x2 + c3[i] * x3);
    }
    for (size_t j = n / 4 * 4; j < n; j++, column += n) gp_axpy(p->next, p->x[j], column, n);
    for (size_t k = 0; k < m; k++, column += n)
        if (p->input[k] != 0) gp_axpy(p->next, p->input[k], column, n);
    for (size_t k = 0; k < m; k++, column += n)
        if (p->slope[k] != 0) gp_axpy(p->next, h * p->slope[k], column, n);
    for (size_t i = 0; i < n; i++) p->next[i] += p->x[i];
}

int gp_step(GpInstance *p, double time, double h) {
    const double frequency = p->frequency + h * p->frequency_slope;
    const GpDiscrete *d;
    double check = 0, *swap;
    if (gp_use_parameters(p)) return -1;
    if (!gp_finite(frequency) || frequency <= 0) {
        gp_text_add(&p->message, "The input frequency leaves the positive numbers within this step.");
        return -1;
    }
    d = discretise(p, time, h);
    if (!d) {
        gp_text_add(&p->message, "The system cannot be discretised for the step size ");
        gp_text_real(&p->message, h);
        gp_text_add(&p->message, " s, because the matrix exponential overflows; use a smaller step.");
        return -1;
    }
    propagate(p, d, h);
    for (size_t i = 0; i < 2 * p->model.modes; i++) check += p->next[i] - p->next[i];
    for (size_t k = 0; k < p->model.loads; k++) check += 0 * (p->input[k] + h * p->slope[k]);
    if (check != 0) { /* NaN: some number is not finite */
        gp_text_add(&p->message, "The step overflows, so it is not made; check the inputs and their units.");
        return -1;
    }
    swap = p->x;
    p->x = p->next;
    p->next = swap;
    for (size_t k = 0; k < p->model.loads; k++) {
        p->input[k] += h * p->slope[k];
        p->slope[k] = 0;
    }
    if (frequency != p->frequency) p->response_ready = 0;
    p->frequency = frequency;
    p->frequency_slope = 0;
    p->motion_ready = 0;
    return 0;
}
