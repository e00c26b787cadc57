/* One allocation for all arrays of an instance (declared in gp_memory.h). */
#include "gp_memory.h"

#include <stdlib.h>

typedef struct {
    double *base; /* the allocation; NULL while the doubles are only counted */
    size_t used;  /* doubles handed out */
} Arena;

static double *take(Arena *arena, size_t count) {
    double *start = arena->base ? arena->base + arena->used : NULL;
    arena->used += count;
    return start;
}

static GpComplex *take_complex(Arena *arena, size_t count) { return (GpComplex *)(void *)take(arena, 2 * count); }

static void lay_out_system(GpInstance *p, Arena *arena) {
    const GpModel *m = &p->model;
    const size_t N = m->modes, n = 2 * N, observed = m->outputs + 2 * m->rows;
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
    p->modes.force = take(arena, m->loads * n);
    p->modes.observe = take(arena, observed * n);
    p->modes.through = take(arena, observed * m->loads);
    p->place = (size_t *)(void *)take(arena, observed);
    p->seen = take(arena, observed);
    p->seen_in = (unsigned long long *)(void *)take(arena, observed);
}

static void lay_out_response(GpResponse *r, const GpModel *m, Arena *arena) {
    r->h = take_complex(arena, m->modes);
    r->v = take_complex(arena, m->modes);
    r->g = take_complex(arena, m->rows);
    r->work = take_complex(arena, m->rows * (2 * m->rows + 1));
    r->alpha = take(arena, m->joints);
}

static void lay_out_tangent(GpTangent *t, const GpModel *m, Arena *arena) {
    t->states = take(arena, m->states);
    t->input = take(arena, m->loads);
    t->K = take(arena, m->blocks);
    t->C = take(arena, m->blocks);
    t->zeta = take(arena, m->groups);
    t->amplitude = take(arena, m->tones);
    t->phase = take(arena, m->tones);
    t->total = take(arena, m->loads);
    t->motion.q = take(arena, m->modes);
    t->motion.v = take(arena, m->modes);
    t->motion.a = take(arena, m->modes);
    t->motion.g = take(arena, m->rows);
    t->system.X = take(arena, m->modes);
    t->system.KP = take(arena, m->rows * m->modes);
    t->system.CP = take(arena, m->rows * m->modes);
    t->system.Xd = take(arena, m->loads * m->modes);
    t->system.push = take(arena, m->loads * m->modes);
    t->response.v = take_complex(arena, m->modes);
    t->response.g = take_complex(arena, m->rows);
    t->response.alpha = take(arena, m->joints);
}

static void lay_out(GpInstance *p, Arena *arena) {
    const GpModel *m = &p->model;
    const size_t n = m->order, order = gp_propagator_order(m), square = order * order,
                 rigid = gp_rigid_modes(m);
    p->K = take(arena, m->blocks);
    p->C = take(arena, m->blocks);
    p->valid_K = take(arena, m->blocks);
    p->valid_C = take(arena, m->blocks);
    p->zeta = take(arena, m->groups);
    p->valid_zeta = take(arena, m->groups);
    p->changed = (unsigned char *)take(arena, m->joints / sizeof(double) + 1);
    p->input = take(arena, m->loads);
    p->slope = take(arena, m->loads);
    p->source.amplitude = take(arena, m->tones);
    p->source.phase = take(arena, m->tones);
    p->now = take(arena, n);
    p->next = take(arena, n);
    p->spare = take(arena, n);
    p->states = take(arena, n);
    p->held = take(arena, m->loads);
    p->grown = take(arena, m->loads);
    p->total = take(arena, m->loads);
    p->order_alpha = take(arena, m->tones);
    p->order_power = take(arena, m->tones);
    p->order_frequency = take(arena, m->tones);
    p->work = take(arena, 3 * m->modes + m->rows + 36);
    p->state_work = take(arena, 4 * m->blocks + 2 * m->groups);
    lay_out_system(p, arena);
    lay_out_response(&p->response, m, arena);
    lay_out_response(&p->order_response, m, arena);
    lay_out_tangent(&p->tangent, m, arena);
    p->rigid.motion = take(arena, rigid * m->modes);
    p->rigid.square = take(arena, rigid);
    p->rigid.gain = take(arena, rigid * m->loads);
    p->rigid.work = take(arena, rigid * (rigid + 2));
    p->expm.n = order;
    p->expm.M = take(arena, square);
    p->expm.M2 = take(arena, square);
    p->expm.M4 = take(arena, square);
    p->expm.M6 = take(arena, square);
    p->expm.T1 = take(arena, square);
    p->expm.T2 = take(arena, square);
    for (int i = 0; i < GP_STEP_SIZES; i++) {
        p->discrete[i].transition = take(arena, n * n);
        p->discrete[i].columns = take(arena, (order - n) * n);
    }
}

int gp_memory_allocate(GpInstance *p) {
    Arena arena = {NULL, 0};
    lay_out(p, &arena);
    p->memory = arena.base = calloc(arena.used, sizeof(double));
    arena.used = 0;
    if (!p->memory) return -1;
    lay_out(p, &arena);
    return 0;
}
